"""Parsed equations: their values, derivatives and text."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Self

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats
from ravemj.model.expressions.calculus import Algebra, derivative
from ravemj.model.expressions.functions import FUNCTIONS, nth
from ravemj.model.expressions.nodes import Call, Graph, Node, Number, Variable, contents, ordered, steps
from ravemj.model.expressions.parser import parse_nodes
from ravemj.model.expressions.polynomials import Affine, affine, coefficients
from ravemj.model.expressions.writer import text_of

Compiled = Callable[[Sequence[float]], float]
MOST_NESTED = 40

_MOST_NODES = 20_000
"""Maximum number of nodes times values of a multivalued equation; above it, only the first value is considered.

Robots need less; it is a limit for malicious files.
"""


def parse(text: str, variables: Collection[str]) -> "Expression":
    """Parse an equation in fparser's syntax.

    Args:
        text: The equation, with joint names replaced (see ``substitute``).
        variables: The names of variables. Any other name that is not a function is an error.

    Raises:
        ExpressionError: If the text is not an equation of these variables, or too long or too deeply nested.
    """
    return Expression(parse_nodes(text, variables))


@dataclass(frozen=True, eq=False)
class Expression:
    """Function of named variables; undefined values are nan, never exceptions.

    Some functions have several values, for instance two in ``polyroots2``. ``within`` returns the expression that
    selects the first value within limits; all other methods use the first value.

    Attributes:
        root: The last of the nodes.
    """

    root: Node

    @cached_property
    def nodes(self) -> list[Node]:
        """All nodes in topological order."""
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
        """A constant plus multiples of the variables, if the expression is affine, else None."""
        return affine(self.nodes)

    @cached_property
    def _content(self) -> tuple[object, ...]:
        """Nodes with the indices of their arguments, for comparison by value."""
        return contents(self.nodes)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Expression) and (self.root is other.root or self._content == other._content)

    def __hash__(self) -> int:
        return hash(self._content)

    def __reduce__(self) -> tuple[type[Self], tuple[Node]]:
        return type(self), (self.root,)  # without the closures

    def __str__(self) -> str:
        return text_of(self.nodes)

    def __repr__(self) -> str:
        text = str(self)
        return f"Expression({text if len(text) <= 80 else text[:77] + '...'!r})"

    def evaluate(self, values: Mapping[str, float] | Sequence[float]) -> float:
        """Return the (first) value; variables are given by name, or in the order of ``variables``."""
        if isinstance(values, Mapping):
            values = [values[name] for name in self.variables]
        return self._evaluate(values)

    def compiled(self, order: Sequence[str] | None = None) -> Compiled:
        """Return a fast form of ``evaluate``: a function of a list, tuple or one-dimensional array.

        It consists of nested closures without look-ups. Values are in the order ``order``, which may include unused
        variables; by default in that of ``variables``.
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

        The arrays, by variable name, must broadcast; mostly all have shape (N,).
        """
        shape = np.broadcast_shapes(*(np.shape(array) for array in values.values()))
        results: dict[Node, Floats] = {}
        with np.errstate(all="ignore"):
            for node in self.nodes:
                match node:
                    case Number(value):
                        results[node] = np.asarray(value)
                    case Variable(name):
                        results[node] = np.asarray(values[name], dtype=np.float64)
                    case Call(function, arguments):
                        results[node] = FUNCTIONS[function].array(*(results[argument] for argument in arguments))
        return np.array(np.broadcast_to(results[self.root], shape), dtype=np.float64)

    def derivative(self, variable: str) -> "Expression":
        """Return the partial derivative with respect to a variable.

        Corners and jumps of ``abs``, ``min``, ``if``, ``floor`` and so on are ignored: the derivative is that of the
        piece at the point.
        """
        return Expression(derivative(self.nodes, variable))

    def with_values(self, values: Mapping[str, float]) -> "Expression":
        """Return the expression with numbers substituted for some variables."""
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
        """Return the expression that selects the first value within limits, else the first, which the caller clamps.

        If the equation with all its values is too large, only the first value is considered.
        """
        root = _first_within(self.nodes, lower, upper)
        return self if root is self.root else Expression(root)

    def polynomial(self, variable: str, max_degree: int = 4) -> tuple[float, ...] | None:
        """Return the coefficients, in ascending order, of a polynomial in a single variable, else None.

        The degree is at most ``max_degree``; the last coefficient is not 0 unless it is the only one.
        """
        return coefficients(self.nodes, variable, max_degree)


def _closure(node: Node, places: Mapping[Node, int]) -> Compiled:
    """Return a function that computes ``node`` from a list of values; ``places`` are indices of nodes in the list."""
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
    """Return a node for the first value of a multivalued equation that is within limits, else for its first value.

    If a multivalued function occurs twice with the same arguments, both occurrences have the same value.
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
    """Return the equation with each multivalued function replaced by one of its values, by index."""
    replaced: dict[Node, Node] = {}
    for node in nodes:
        replaced[node] = node
        if isinstance(node, Call):
            function = nth(node.function, choice[node]) if node in choice else node.function
            replaced[node] = algebra.call(function, *(replaced[argument] for argument in node.arguments))
    return replaced[nodes[-1]]
