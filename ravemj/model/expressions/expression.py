"""Parsed equations: their values, derivatives and text."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats
from ravemj.model.expressions.calculus import Algebra, derivative
from ravemj.model.expressions.functions import FUNCTIONS, nth
from ravemj.model.expressions.nodes import Call, Graph, Node, Number, Variable, ordered, steps
from ravemj.model.expressions.parser import parse_nodes
from ravemj.model.expressions.polynomials import Affine, affine, coefficients
from ravemj.model.expressions.writer import text_of

Compiled = Callable[[Sequence[float]], float]
MOST_NESTED = 40

_MOST_NODES = 20_000
"""Of an equation with all its values: more than any robot needs, and few enough for hostile text."""


def parse(text: str, variables: Collection[str]) -> "Expression":
    """Read an equation in fparser's syntax.

    Args:
        text: The equation; joint names were replaced before (see ``substitute``).
        variables: The names that have a value. Any other name that is not a function is an error.

    Raises:
        ExpressionError: If the text is not an equation of these variables, or too long or too deeply nested.
    """
    return Expression(parse_nodes(text, variables))


@dataclass(frozen=True, eq=False)
class Expression:
    """A function of named variables that never raises: where it has no value, it gives nan.

    Some functions have several values, as ``polyroots2`` has two. ``within`` gives the expression that has the first
    one within limits; everything else takes the first.

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
        """Return the value, of several the first; variables are given by name, or in the order of ``variables``."""
        if isinstance(values, Mapping):
            values = [values[name] for name in self.variables]
        return self._evaluate(values)

    def compiled(self, order: Sequence[str] | None = None) -> Compiled:
        """Return a fast form of ``evaluate``: a function of a list, tuple or one-dimensional array.

        It is made of nested closures: nothing is looked up at evaluation but the values. They come in the given order,
        which may have more variables than occur; by default in that of ``variables``.
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
        """Return the values for many configurations at once, an array of the common shape.

        The arrays, by the names of variables, have shapes that broadcast, most often all (N,).
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
        """Return the expression that has the first value within limits, else the first, for the caller to clamp.

        Of an equation that is enormous with all its values only the first one counts.
        """
        found = _first_within(self.nodes, lower, upper)
        return self if found is self.root else Expression(found)

    def polynomial(self, variable: str, max_degree: int = 4) -> tuple[float, ...] | None:
        """Return the coefficients, in ascending order, if this is a polynomial in one variable alone, else None.

        There is one more than the degree, which is ``max_degree`` at most; the last is not 0 unless it is the only one.
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


def _first_within(nodes: list[Node], lower: float, upper: float) -> Node:
    """Return a node for the first value of an equation within limits, else for its first value, as ``within`` says.

    A root that the equation uses twice is the same root in both places.
    """
    several = [node for node in nodes if isinstance(node, Call) and FUNCTIONS[node.function].most_roots > 1]
    choices = list(product(*(range(FUNCTIONS[node.function].most_roots) for node in several)))
    if not several or len(choices) * len(nodes) > _MOST_NODES:
        return nodes[-1]
    algebra = Algebra(Graph(nodes))
    values = [_chosen(nodes, dict(zip(several, choice, strict=True)), algebra) for choice in choices]
    limits = algebra.number(lower), algebra.number(upper)
    result = values[0]
    for value in reversed(values):
        is_within = algebra.call("and", algebra.call("le", limits[0], value), algebra.call("le", value, limits[1]))
        result = algebra.choose(is_within, value, result)
    return result


def _chosen(nodes: list[Node], choice: dict[Node, int], algebra: Algebra) -> Node:
    """Return the equation with one value of each function that has several."""
    found: dict[Node, Node] = {}
    for node in nodes:
        found[node] = node
        if isinstance(node, Call):
            function = nth(node.function, choice[node]) if node in choice else node.function
            found[node] = algebra.call(function, *(found[argument] for argument in node.arguments))
    return found[nodes[-1]]
