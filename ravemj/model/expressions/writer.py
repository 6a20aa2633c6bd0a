"""Text form of expressions, with a minimum of parentheses."""

import math
from collections.abc import Mapping, Sequence

from ravemj.model.expressions.functions import NAMED
from ravemj.model.expressions.nodes import Call, Node, Number, Variable, steps
from ravemj.model.expressions.parser import operators

UNARY, POWER, ELEMENT = 6, 7, 8  # precedences above those of the binary operators
MOST_NESTED = 24  # the parser allows two levels for each
_SIGNS = {"neg": "-", "not": "!"}
_OPERATORS = operators()


def text_of(nodes: list[Node]) -> str:
    """Return text that parses to the same nodes; shared nodes become inline variables."""
    names = {node.name for node in nodes if isinstance(node, Variable)} | set(NAMED)
    prefix = "t"
    while any(name.startswith(prefix) for name in names if name not in NAMED):
        prefix += "_"
    written: dict[Node, str] = {}
    text = ""
    *shared, root = steps(nodes, MOST_NESTED)
    for node in shared:
        name = f"{prefix}{len(written)}"
        text += f"{name} := {_write(node, written, 0)}; "
        written[node] = name
    return text + _write(root, written, 0)


def _write(node: Node, written: Mapping[Node, str], lowest: int) -> str:
    """Return the text of a node, in parentheses if it binds less tightly than ``lowest``."""
    if node in written:
        return written[node]
    precedence, text = _parts(node, written)
    return text if precedence >= lowest else f"({text})"


def _parts(node: Node, written: Mapping[Node, str]) -> tuple[int, str]:
    """Return the precedence and the text of a node."""
    match node:
        case Number(value):
            return _number(value)
        case Variable(name):
            return ELEMENT, name
        case Call("pow", (base, exponent)):
            return POWER, f"{_write(base, written, ELEMENT)}^{_write(exponent, written, UNARY)}"
        case Call(function, (argument,)) if function in _SIGNS:
            return UNARY, _SIGNS[function] + _write(argument, written, UNARY)
        case Call(function, (left, right)) if function in _OPERATORS:
            sign, precedence = _OPERATORS[function]
            return precedence, f"{_write(left, written, precedence)}{sign}{_write(right, written, precedence + 1)}"
        case Call(function, arguments):
            return ELEMENT, f"{function}({_list(arguments, written)})"


def _list(arguments: Sequence[Node], written: Mapping[Node, str]) -> str:
    return ", ".join(_write(argument, written, 0) for argument in arguments)


def _number(value: float) -> tuple[int, str]:
    if math.isnan(value):
        return ELEMENT, "(0/0)"
    digits = "1e999" if math.isinf(value) else repr(abs(value)).removesuffix(".0")
    return (UNARY, f"-{digits}") if math.copysign(1.0, value) < 0 else (ELEMENT, digits)
