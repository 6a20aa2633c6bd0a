"""The parser of mimic equations, in the grammar of fparser 4.5, which OpenRAVE uses.

::

    equation   = { name ":=" expression ";" } expression
    expression = operators between operands, by rising precedence:  |   &   = == != < <= > >=   + -   * / %
    operand    = { "-" | "!" } power
    power      = element [ "^" operand ]            so -2^2 is -4 and 2^-2^2 is 2^(-4)
    element    = number | name | name "(" expression { "," expression } ")" | "(" expression ")"

There is no unary plus, no implicit multiplication, and there are no constants such as pi. Numbers may be hexadecimal,
also with a binary exponent: ``0xA.Bp10``.
"""

import re
from collections.abc import Collection, Mapping
from typing import NamedTuple

from ravemj.model.expressions.functions import FUNCTIONS, NAMED
from ravemj.model.expressions.nodes import Call, ExpressionError, Graph, Node, ordered

MAX_LENGTH = 65_536
MAX_DEPTH = 64
MAX_CANDIDATES = 64

SPACES = "\t\n\v\r \u00a0\u2000-\u200b\u202f\u205f\u3000"  # as character class
_LETTER = rf"(?:[A-Za-z_]|[^\x00-\x7f{SPACES}])"
_TOKEN = re.compile(
    rf"""[{SPACES}]*(?:
    (?P<number>0x(?:[0-9A-Fa-f]+\.?[0-9A-Fa-f]*|\.[0-9A-Fa-f]+)(?:[pP][+-]?[0-9]+)?
              |(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)
    |(?P<name>{_LETTER}(?:{_LETTER}|[0-9])*)
    |(?P<sign>:=|==|!=|<=|>=|[-+*/%^=<>&|!(),;])
    |(?P<end>\Z))""",
    re.VERBOSE,
)
_BINARY = {
    "|": (1, "or"),
    "&": (2, "and"),
    **{"=": (3, "eq"), "==": (3, "eq"), "!=": (3, "ne")},
    **{"<": (3, "lt"), "<=": (3, "le"), ">": (3, "gt"), ">=": (3, "ge")},
    **{"+": (4, "add"), "-": (4, "sub"), "*": (5, "mul"), "/": (5, "div"), "%": (5, "mod")},
}
_UNARY = {"-": "neg", "!": "not"}
_OPERAND = "a number, a joint, a function or '('"


class Token(NamedTuple):
    """Token of the text; it is empty at the end."""

    kind: str
    text: str
    position: int


def parse_nodes(text: str, variables: Collection[str]) -> Node:
    """Parse an equation of some variables; return the root node. Errors are those of ``expression.parse``."""
    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"the equation has {len(text)} characters, more than {MAX_LENGTH}", text, MAX_LENGTH)
    try:
        root = _EquationParser(text, variables).equation()
    except RecursionError:  # the caller's stack may be deep
        raise ExpressionError("the equation is nested too deep", text, 0) from None
    candidates = 1
    for node in ordered(root):
        candidates *= FUNCTIONS[node.function].most_roots if isinstance(node, Call) else 1
        if candidates > MAX_CANDIDATES:
            raise ExpressionError(f"the equation can have more than {MAX_CANDIDATES} values", text, len(text))
    return root


class _EquationParser:
    """Recursive-descent parser of an equation."""

    def __init__(self, text: str, variables: Collection[str]) -> None:
        self._text = text
        self._graph = Graph()
        self._variables = variables
        self._inline: dict[str, Node] = {}
        self._depth = 0
        self._tokens = _tokens(text)
        self._index = 0

    def equation(self) -> Node:
        """Parse definitions of inline variables and the final expression; return the latter."""
        while self._is_definition():
            self._define()
        root = self._expression(1)
        if self._next.kind != "end":
            raise self._unexpected("an operator or the end")
        return root

    def _is_definition(self) -> bool:
        return self._next.kind == "name" and self._tokens[self._index + 1].text == ":="

    def _define(self) -> None:
        name = self._next
        if name.text in NAMED or name.text in self._variables:
            raise ExpressionError(f"{name.text!r} is taken", self._text, name.position, "a new name before ':='")
        self._index += 2
        value = self._expression(1)
        self._take(";")
        self._inline[name.text] = value

    def _expression(self, lowest: int) -> Node:
        """Parse operands and the binary operators between them that have at least the precedence ``lowest``."""
        left = self._operand()
        while True:
            precedence, function = _BINARY.get(self._next.text, (0, ""))
            if precedence < lowest:
                return left
            self._index += 1
            left = self._graph.call(function, left, self._expression(precedence + 1))

    def _operand(self) -> Node:
        """Parse an operand with its unary operators and its power."""
        signs: list[str] = []
        while self._next.text in _UNARY:
            signs.append(_UNARY[self._next.text])
            self._index += 1
        node = self._element()
        if self._next.text == "^":
            self._index += 1
            self._descend()
            node = self._graph.call("pow", node, self._operand())
            self._depth -= 1
        for sign in reversed(signs):
            node = self._graph.call(sign, node)
        return node

    def _element(self) -> Node:
        token = self._next
        if token.text == "(":
            return self._arguments(1, "a parenthesis")[0]
        if token.kind not in {"number", "name"}:
            raise self._unexpected(_OPERAND)
        self._index += 1
        if token.kind == "number":
            return self._graph.number(_number(token.text))
        if token.text in NAMED:
            return self._graph.call(token.text, *self._arguments(NAMED[token.text].arity, f"{token.text}()"))
        return self._named(token)

    def _named(self, token: Token) -> Node:
        if token.text in self._inline:
            return self._inline[token.text]
        if token.text in self._variables:
            return self._graph.variable(token.text)
        raise ExpressionError(f"unknown name {_short(token.text)}", self._text, token.position, _OPERAND)

    def _arguments(self, arity: int, owner: str) -> list[Node]:
        self._take("(")
        self._descend()
        arguments = [self._expression(1)]
        while self._next.text == "," and len(arguments) < arity:
            self._index += 1
            arguments.append(self._expression(1))
        if len(arguments) < arity:
            raise self._unexpected(f"',' as {owner} takes {arity} values")
        self._take(")")
        self._depth -= 1
        return arguments

    @property
    def _next(self) -> Token:
        return self._tokens[self._index]

    def _take(self, text: str) -> None:
        if self._next.text != text:
            raise self._unexpected(repr(text))
        self._index += 1

    def _descend(self) -> None:
        self._depth += 1
        if self._depth > MAX_DEPTH:
            problem = f"the equation is nested more than {MAX_DEPTH} levels deep"
            raise ExpressionError(problem, self._text, self._next.position)

    def _unexpected(self, expected: str) -> ExpressionError:
        token = self._next
        problem = f"unexpected {_short(token.text)}" if token.text else "the equation ends"
        return ExpressionError(problem, self._text, token.position, expected)


def _tokens(text: str) -> list[Token]:
    """Split the text into tokens; the last one is of the kind "end"."""
    tokens: list[Token] = []
    position = 0
    while not tokens or tokens[-1].kind != "end":
        match = _TOKEN.match(text, position)
        if match is None:
            start = re.compile(f"[{SPACES}]*").match(text, position)
            position = start.end() if start else position
            raise ExpressionError(f"unknown character {text[position]!r}", text, position, _OPERAND)
        kind = match.lastgroup or ""
        tokens.append(Token(kind, match[kind], match.start(kind)))
        position = match.end()
    return tokens


def _number(text: str) -> float:
    if not text.startswith("0x"):
        return float(text)
    try:
        return float.fromhex(text)
    except OverflowError:
        return float("inf")


def _short(name: str) -> str:
    return repr(name if len(name) <= 40 else name[:37] + "...")


def operators() -> Mapping[str, tuple[str, int]]:
    """Return the text and the precedence of each binary operator, for writing expressions."""
    return {function: (text, precedence) for text, (precedence, function) in _BINARY.items() if text != "=="}
