"""Parsed equations: their values, derivatives and text."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.model.expressions.calculus import derivative
from ravemj.model.expressions.functions import FUNCTIONS, NAN
from ravemj.model.expressions.limits import first_within
from ravemj.model.expressions.nodes import Call, Node, Number, Variable, ordered, steps
from ravemj.model.expressions.parser import parse_nodes
from ravemj.model.expressions.polynomials import Affine, affine, coefficients
from ravemj.model.expressions.writer import text_of

Compiled = Callable[[Sequence[float]], float]
MOST_NESTED = 40


def parse(text: str, variables: Collection[str]) -> "Expression":
    """Read an equation in fparser's syntax.

    Args:
        text: The equation; joint names were replaced before (see ``substitute``).
        variables: The names that have a value. Any other name that is not a function is an error.

    Returns:
        The expression, which can be evaluated.

    Raises:
        ExpressionError: If the text is not an equation of these variables, or too long or too deeply nested.
    """
    return Expression(parse_nodes(text, variables))


@dataclass(frozen=True, eq=False)
class Expression:
    """A function of named variables that never raises: where it has no value, it gives nan.

    Some functions have several values, as ``polyroots2`` has two. ``candidates`` gives the value of the equation for
    each choice among them, ``within`` the expression that has the first one within limits, and everything else takes
    the first.

    Attributes:
        root: The last of the nodes.
    """

    root: Node

    @cached_property
    def nodes(self) -> list[Node]:
        """All nodes, each once and after its arguments."""
        return ordered(self.root)

    @cached_property
    def variables(self) -> tuple[str, ...]:
        """The names of the variables that occur, sorted."""
        return tuple(sorted(node.name for node in self.nodes if isinstance(node, Variable)))

    @cached_property
    def is_multivalued(self) -> bool:
        """Whether there can be more than one candidate."""
        return any(isinstance(node, Call) and FUNCTIONS[node.function].most_roots > 1 for node in self.nodes)

    @cached_property
    def _evaluate(self) -> Compiled:
        return self.compiled()

    @cached_property
    def affine(self) -> Affine | None:
        """A constant plus multiples of the variables, if the expression is that, else None."""
        return affine(self.nodes)

    def __str__(self) -> str:
        return text_of(self.nodes)

    def __repr__(self) -> str:
        text = str(self)
        return f"Expression({text if len(text) <= 80 else text[:77] + '...'!r})"

    def evaluate(self, values: Mapping[str, float] | Sequence[float]) -> float:
        """Return the value; of several candidates the first.

        Args:
            values: The variables by name, or in the order of ``variables``.
        """
        if isinstance(values, Mapping):
            values = [values[name] for name in self.variables]
        return self._evaluate(values)

    def compiled(self, order: Sequence[str] | None = None) -> Compiled:
        """Return a fast form of ``evaluate``.

        Args:
            order: The variables in the order in which the function shall take them, which may be more than
                occur; by default that of ``variables``.

        Returns:
            A function of a list, tuple or one-dimensional array. It is made of nested closures: nothing is looked
            up at evaluation but the values.
        """
        names = self.variables if order is None else tuple(order)
        places: dict[Node, int] = {node: names.index(node.name) for node in self.nodes if isinstance(node, Variable)}
        count = len(names)
        parts: list[Compiled] = []
        for step in steps(self.nodes, MOST_NESTED):
            parts.append(_closure(step, places))
            places[step] = count + len(parts) - 1
        if len(parts) == 1:
            return parts[0]

        def evaluate(values: Sequence[float]) -> float:
            slots = [*values[:count]]
            for part in parts:
                slots.append(part(slots))
            return slots[-1]

        return evaluate

    def evaluate_many(self, values: Mapping[str, Floats]) -> Floats:
        """Return the values for many configurations at once.

        Args:
            values: Arrays by variable name, of shapes that broadcast, most often all of shape (N,).

        Returns:
            An array of the common shape.
        """
        shape = np.broadcast_shapes(*(np.shape(array) for array in values.values()))
        found: dict[Node, Floats] = {}
        with np.errstate(all="ignore"):
            for node in self.nodes:
                match node:
                    case Number(value):
                        found[node] = np.asarray(value)
                    case Variable(name):
                        found[node] = np.asarray(values[name], dtype=np.float64)
                    case Call(function, arguments):
                        found[node] = FUNCTIONS[function].array(*(found[argument] for argument in arguments))
        return np.array(np.broadcast_to(found[self.root], shape), dtype=np.float64)

    def candidates(self, values: Mapping[str, float]) -> tuple[float, ...]:
        """Return all values of the equation, those for the first of each function's values first.

        Without multi-valued functions there is one candidate, or none where the equation has no value.
        """
        found: list[float] = []
        choice: list[int] | None = []
        while choice is not None:
            value, taken, available = self._choose(values, choice)
            found += [value] if value == value else []  # noqa: PLR0124 - leaves nan out
            choice = _next_choice(taken, available)
        return tuple(dict.fromkeys(found))

    def _choose(self, values: Mapping[str, float], choice: Sequence[int]) -> tuple[float, list[int], list[int]]:
        """Evaluate with given choices; return also the choices that were made and among how many values each."""
        found: dict[Node, float] = {}
        taken: list[int] = []
        available: list[int] = []
        for node in self.nodes:
            match node:
                case Number(value):
                    found[node] = value
                case Variable(name):
                    found[node] = float(values[name])
                case Call(function, arguments):
                    definition = FUNCTIONS[function]
                    numbers = [found[argument] for argument in arguments]
                    if definition.roots is None:
                        found[node] = definition.scalar(*numbers)
                        continue
                    roots = definition.roots(*numbers)
                    taken.append(choice[len(taken)] if len(taken) < len(choice) else 0)
                    available.append(len(roots))
                    found[node] = roots[taken[-1]] if roots else NAN
        return found[self.root], taken, available

    def derivative(self, variable: str) -> "Expression":
        """Return the partial derivative with respect to a variable.

        Corners and jumps of ``abs``, ``min``, ``if``, ``floor`` and the like are passed over: the derivative is that
        of the piece on which the point lies.
        """
        return Expression(derivative(self.nodes, variable))

    def with_values(self, values: Mapping[str, float]) -> "Expression":
        """Return the expression with numbers in place of some variables."""
        replaced: dict[Node, Node] = {}
        for node in self.nodes:
            match node:
                case Variable(name) if name in values:
                    replaced[node] = Number(values[name])
                case Call(function, arguments):
                    replaced[node] = Call(function, tuple(replaced[argument] for argument in arguments))
                case _:
                    replaced[node] = node
        return Expression(replaced[self.root])

    def within(self, lower: float, upper: float) -> "Expression":
        """Return the expression that has the first candidate within limits, else the first, for the caller to clamp.

        Of an equation that is enormous with all its candidates only the first one counts.

        Args:
            lower: The least value.
            upper: The greatest value.
        """
        found = first_within(self.nodes, lower, upper) if self.is_multivalued else self.root
        return self if found is self.root else Expression(found)

    def polynomial(self, variable: str, max_degree: int = 4) -> tuple[float, ...] | None:
        """Return the coefficients, in ascending order, if this is a polynomial in one variable, else None.

        Args:
            variable: The only variable that may occur.
            max_degree: The highest power that may occur.

        Returns:
            One coefficient more than the degree; the last is not 0 unless it is the only one.
        """
        return coefficients(self.nodes, variable, max_degree)


def _closure(node: Node, places: Mapping[Node, int]) -> Compiled:
    """Return a function that evaluates ``node`` from the values of the nodes that have places."""
    if node in places:
        place = places[node]
        return lambda values: float(values[place])
    if isinstance(node, Number):
        number = node.value
        return lambda values: number
    assert isinstance(node, Call)
    function = FUNCTIONS[node.function].scalar
    parts = [_closure(argument, places) for argument in node.arguments]
    if len(parts) == 1:
        (part,) = parts
        return lambda values: function(part(values))
    if len(parts) == 2:
        left, right = parts
        return lambda values: function(left(values), right(values))
    return lambda values: function(*[part(values) for part in parts])


def _next_choice(taken: Sequence[int], available: Sequence[int]) -> list[int] | None:
    """Count the choices up by one, as digits of which the last runs fastest; None after the last."""
    for index in reversed(range(len(taken))):
        if taken[index] + 1 < available[index]:
            return [*taken[:index], taken[index] + 1]
    return None
