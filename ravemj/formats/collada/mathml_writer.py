"""Translation of mimic equations to MathML, which ``formulas`` reads."""

from collections.abc import Callable, Sequence

from ravemj.formats.collada.formulas import CALLS
from ravemj.formats.xml_text import XmlText
from ravemj.model.expressions import Expression
from ravemj.model.expressions.nodes import Call, Node, Number, Variable

NAMESPACE = "http://www.w3.org/1998/Math/MathML"
MOST_NESTED = 60
"""Maximum nesting depth; the limit of the reader is slightly higher."""

_OPERATORS = {
    "add": "plus", "sub": "minus", "neg": "minus", "mul": "times", "div": "divide", "mod": "rem", "eq": "eq",
    "ne": "neq", "lt": "lt", "le": "leq", "gt": "gt", "ge": "geq", "and": "and", "or": "or",
}  # fmt: skip
_FUNCTIONS = {name: tag for tag, name in reversed(CALLS.items())}


_READ_AS_0 = {"sqrt", "atan2", "int", "SASA", "SASS", "cbrt", "hypot", "not"}


def read_as_0(node: Node) -> set[str]:
    """Return the functions in an equation that OpenRAVE's COLLADA reader evaluates to 0."""
    if not isinstance(node, Call):
        return set()
    name = node.function
    inner = set[str]().union(*map(read_as_0, node.arguments))
    is_power = name == "pow" and not isinstance(node.arguments[1], Number)
    return inner | {name} if is_power or name in _READ_AS_0 or name.startswith("polyroots") else inner


class TooDeepError(Exception):
    """An equation nested too deep for readers."""


def math_of(expression: Expression, path_of: Callable[[str], str]) -> XmlText:
    """Return an equation as a ``<math>``; ``path_of`` returns the path of a joint by its variable.

    Raises:
        TooDeepError: The equation is nested too deep.
    """
    writer = _Math(path_of)
    with writer.out.inside("math", xmlns=NAMESPACE):
        writer.write(expression.root, 0)
    return writer.out


class _Math:
    def __init__(self, path_of: Callable[[str], str]) -> None:
        self.out = XmlText(7)
        self._path_of = path_of

    def write(self, node: Node, depth: int) -> None:
        if depth > MOST_NESTED:
            raise TooDeepError
        match node:
            case Number(value):
                self.out.element("cn", value)
            case Variable(name):
                self.out.element("csymbol", self._path_of(name), encoding="COLLADA")
            case Call("if", (condition, first, second)):
                self._choice(condition, first, second, depth + 1)
            case Call("not", (condition,)):
                self._choice(condition, Number(0.0), Number(1.0), depth + 1)
            case Call(function, arguments):
                self._apply(function, arguments, depth + 1)

    def _apply(self, function: str, arguments: Sequence[Node], depth: int) -> None:
        tag = _OPERATORS.get(function, _FUNCTIONS.get(function))
        with self.out.inside("apply"):
            if tag is None:
                self.out.element("csymbol", function, encoding="text/xml", type="function")
            else:
                self.out.element(tag)
            if tag == "root":
                self.out.element_inside("degree", "cn", 2)
            for argument in _operands(function, arguments):
                self.write(argument, depth)

    def _choice(self, condition: Node, first: Node, second: Node, depth: int) -> None:
        with self.out.inside("piecewise"):
            with self.out.inside("piece"):
                self.write(first, depth)
                self.write(condition, depth)
            with self.out.inside("otherwise"):
                self.write(second, depth)


def _operands(function: str, arguments: Sequence[Node]) -> list[Node]:
    """Return all terms of a nested sum, or factors of a nested product; for other functions the arguments."""
    rest: list[Node] = []
    while function in {"add", "mul"} and isinstance(arguments[0], Call) and arguments[0].function == function:
        rest.append(arguments[1])
        arguments = arguments[0].arguments
    return [*arguments, *reversed(rest)]
