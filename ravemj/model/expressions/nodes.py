"""Nodes of expressions, their evaluation graph, and expression errors."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from ravemj.errors import ArgumentError
from ravemj.model.expressions.functions import FUNCTIONS

EXCERPT = 20


class ExpressionError(ArgumentError):
    """Invalid equation; a one-line message with the position.

    Attributes:
        problem: The error, without the position.
        position: Index of the character in the text, from 0; its length if the text ends too early.
        expected: The expected text; may be empty.
    """

    def __init__(self, problem: str, text: str, position: int, expected: str = "") -> None:
        before, after = text[max(0, position - EXCERPT) : position], text[position : position + EXCERPT]
        where = " and".join(f" {side} {part!r}" for side, part in (("after", before), ("before", after)) if part)
        wanted = f"; expected {expected}" if expected else ""
        super().__init__(f"{problem} at character {position}{where}{wanted}")
        self.problem = problem
        self.position = position
        self.expected = expected


@dataclass(frozen=True, slots=True, eq=False)
class Number:
    """A constant."""

    value: float


@dataclass(frozen=True, slots=True, eq=False)
class Variable:
    """Value given at evaluation."""

    name: str


@dataclass(frozen=True, slots=True, eq=False)
class Call:
    """Function or operator with its arguments.

    Attributes:
        function: Key in ``FUNCTIONS``.
        arguments: As many nodes as the function takes.
    """

    function: str
    arguments: "tuple[Node, ...]" = field(repr=False)


Node = Number | Variable | Call


class Graph:
    """Factory of nodes with hash consing and constant folding."""

    def __init__(self, nodes: Iterable[Node] = ()) -> None:
        """Start with the nodes of an expression, each after its arguments."""
        self._known = {_key(node): node for node in nodes}

    def number(self, value: float) -> Node:
        """Return the node of a constant."""
        return self._only(Number(value))

    def variable(self, name: str) -> Node:
        """Return the node of a variable."""
        return self._only(Variable(name))

    def call(self, function: str, *arguments: Node) -> Node:
        """Return the node of a call, or its value if all arguments are numbers."""
        definition = FUNCTIONS[function]
        if definition.roots is None:
            numbers = [node.value for node in arguments if isinstance(node, Number)]
            if len(numbers) == len(arguments):
                return self.number(definition.scalar(*numbers))
        return self._only(Call(function, arguments))

    def _only(self, node: Node) -> Node:
        return self._known.setdefault(_key(node), node)


def _key(node: Node) -> tuple[object, ...]:
    """Return a key that equal nodes share; it compares the arguments of a node by identity."""
    match node:
        case Number(value):
            return (Number, repr(value))  # distinguishes -0.0 from 0.0, and treats all nan as equal
        case Variable(name):
            return (Variable, name)
        case Call(function, arguments):
            return (function, *map(id, arguments))


def contents(nodes: Sequence[Node]) -> tuple[object, ...]:
    """Return a key that is equal for equal expressions: for each node its key and the indices of its arguments."""
    places: dict[Node, int] = {}
    entries: list[object] = []
    for node in nodes:
        places[node] = len(entries)
        is_call = isinstance(node, Call)
        entries.append((node.function, *(places[argument] for argument in node.arguments)) if is_call else _key(node))
    return tuple(entries)


def ordered(root: Node) -> list[Node]:
    """Return the nodes of an expression in topological order, each once."""
    nodes_in_order: list[Node] = []
    seen: set[Node] = set()
    waiting: list[tuple[Node, bool]] = [(root, False)]
    while waiting:
        node, are_arguments_done = waiting.pop()
        if are_arguments_done:
            nodes_in_order.append(node)
        elif node not in seen:
            seen.add(node)
            waiting.append((node, True))
            if isinstance(node, Call):
                waiting += [(argument, False) for argument in reversed(node.arguments)]
    return nodes_in_order


def steps(nodes: list[Node], most_nested: int) -> list[Node]:
    """Choose the calls to evaluate in sequence, so that no node is evaluated twice; the last is the root.

    These are the calls that several nodes use, and some within deep nesting. Trees between them have at most
    ``most_nested`` levels, so that recursion is safe. ``nodes`` is the result of ``ordered``.
    """
    users = dict.fromkeys(nodes, 0)
    for node in nodes:
        for argument in node.arguments if isinstance(node, Call) else ():
            users[argument] += 1
    height = dict.fromkeys(nodes, 0)
    chosen: list[Node] = []
    for node in nodes:
        if isinstance(node, Call):
            height[node] = 1 + max(height[argument] for argument in node.arguments)
            if (users[node] > 1 or height[node] >= most_nested) and node is not nodes[-1]:
                chosen.append(node)
                height[node] = 0
    return [*chosen, nodes[-1]]
