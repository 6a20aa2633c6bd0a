"""Parser of Inventor and VRML text.

One grammar covers Inventor 1.0 to 2.1, VRML 1.0 and VRML97: a node is ``Kind { … }``, with fields and, in the older
dialects, child nodes between the braces. The first character of a field value shows its type, so no table of the
hundreds of field types is needed. Arrays of numbers are found by one regular expression and kept as text.
"""

import re
from typing import NoReturn

from ravemj.formats.limits import MOST_NODES
from ravemj.formats.meshes.inventor.nodes import (
    MAX_DEPTH,
    InventorDocument,
    InventorNode,
    Is,
    NumberText,
    Prototype,
    Value,
)

_GAP = r"(?:[\s,]++|#[^\n\r]*+)*+"
_STRING = r'"(?:[^"\\]++|\\.)*+"'
_TOKEN_INVENTOR = re.compile(rf"{_GAP}({_STRING}|[{{}}\[\]()|]|[^\s,{{}}\[\]()|\"#]++|\Z)", re.DOTALL)
_TOKEN_VRML97 = re.compile(rf"{_GAP}({_STRING}|[{{}}\[\]]|[^\s,{{}}\[\]\"#]++|\Z)", re.DOTALL)
_NUMBER_ARRAY = re.compile(r"((?:[\s,0-9+\-.eExXa-fA-F]++|#[^\n\r]*+)*+)\]")
_NUMBER_RUN = re.compile(rf"(?:{_GAP}[+\-.]?+[0-9.][^\s,{{}}\[\]()|\"#]*+)++")
_NUMBER_STARTS = frozenset("0123456789+-.")
_INTERFACE = frozenset({"field", "exposedField", "eventIn", "eventOut"})
_PUNCTUATION = frozenset("{}[]()|")


def parse(document: InventorDocument) -> list[InventorNode]:
    """Read all nodes of a document.

    Raises:
        SourceError: It is malformed, too deep or too large.
    """
    return _AsciiParser(document).statements(end="")


class _AsciiParser:
    """Recursive-descent parser; ``_at`` is the end of the parsed text."""

    def __init__(self, document: InventorDocument) -> None:
        self._document = document
        self._text = document.text
        self._at = 0
        self._depth = 0
        self._nodes_left = MOST_NODES
        self._named: dict[str, InventorNode] = {}
        self._prototypes: dict[str, Prototype] = {}
        vrml97 = self._text.startswith("#VRML V2")
        self._token = _TOKEN_VRML97 if vrml97 else _TOKEN_INVENTOR

    def statements(self, end: str) -> list[InventorNode]:
        """Read statements up to the token ``end``; return their nodes. Prototypes and routes give none."""
        nodes: list[InventorNode] = []
        while (token := self._next()) != end:
            node = self._statement(token)
            if node is not None:
                nodes.append(node)
        return nodes

    def _statement(self, token: str) -> InventorNode | None:
        if token in ("PROTO", "EXTERNPROTO"):
            self._prototype(external=token == "EXTERNPROTO")
        elif token == "ROUTE":
            for _ in range(3):
                self._next()
        elif token != "NULL":
            return self._node(token)
        return None

    def _next(self) -> str:
        """Return the next token; the empty string at the end."""
        match = self._token.match(self._text, self._at)
        if match is None:
            self._fail("a string without an end")
        self._at = match.end()
        return match[1]

    def _peek(self) -> str:
        at = self._at
        token = self._next()
        self._at = at
        return token

    def _expect(self, wanted: str) -> None:
        token = self._next()
        if token != wanted:
            self._fail(
                f"found {token[:40]!r} where {wanted!r} belongs" if token else f"the file ends before {wanted!r}"
            )

    def _node(self, token: str) -> InventorNode:
        """Parse a node whose first token, such as DEF, USE or its type, is ``token``."""
        if token == "USE":
            name = self._next()
            node = self._named.get(name)
            if node is None:
                self._fail(f"USE of {name[:40]!r}, which no DEF before it names")
            return node
        if token == "DEF":
            name, token = self._next(), self._next()
            if token == "DEF":
                self._fail("DEF of DEF")
            node = self._named[name] = self._node(token)
            return node
        if not token or token in _PUNCTUATION or token[0] == '"' or token[0] in _NUMBER_STARTS:
            self._fail(f"found {token[:40]!r} where a node belongs" if token else "the file ends inside a node")
        return self._body(token)

    def _body(self, kind: str) -> InventorNode:
        node = InventorNode(kind, self._document, self._at - len(kind))
        self._expect("{")
        self._depth += 1
        self._nodes_left -= 1
        if self._depth > MAX_DEPTH or self._nodes_left < 0:
            self._fail("the nodes are nested too deep" if self._nodes_left >= 0 else "there are too many nodes")
        while (token := self._next()) != "}":
            self._item(node, token)
        self._depth -= 1
        if kind in self._prototypes:
            node, made = self._prototypes[kind].instance(node, self._nodes_left)
            self._nodes_left -= made
        return node

    def _item(self, node: InventorNode, token: str) -> None:
        """Parse a field, child, interface or route whose first token is ``token``, and add it to the node."""
        if token in _INTERFACE and node.kind == "Script":
            self._interface(token)
        elif token in ("DEF", "USE", "PROTO", "EXTERNPROTO", "ROUTE", "NULL") or self._peek() == "{":
            child = self._statement(token)
            if child is not None:
                node.children.append(child)
        elif not token:
            self._fail(f"the file ends inside {node.kind}", node.offset)
        elif token == "~":  # Inventor's mark for a field that is ignored
            pass
        elif token == "=":  # a connection: node, dot, field
            self._next()
        elif token in _PUNCTUATION or token[0] == '"' or token[0] in _NUMBER_STARTS:
            self._fail(f"found {token[:40]!r} where a field of {node.kind} belongs")
        else:
            node.fields[token] = self._value()

    def _value(self) -> Value:
        start = self._at
        token = self._next()
        if token == "[":
            return self._array()
        if token and token[0] in _NUMBER_STARTS:
            run = _NUMBER_RUN.match(self._text, start)
            if run is None:
                self._fail(f"{token[:40]!r} is not a number")
            self._at = run.end()
            return NumberText(run[0])
        if token == "(":
            return self._bitmask()
        if token == "IS":
            return Is(self._next())
        return self._word_or_node(token)

    def _word_or_node(self, token: str) -> Value:
        if token[:1] == '"':
            return re.sub(r"\\(.)", r"\1", token[1:-1], flags=re.DOTALL)
        if not token or token in _PUNCTUATION:
            self._fail(f"found {token!r} where a value belongs" if token else "the file ends inside a field")
        if token == "NULL":
            return None
        if token in ("DEF", "USE") or self._peek() == "{":
            return self._node(token)
        return token

    def _array(self) -> Value:
        numbers = _NUMBER_ARRAY.match(self._text, self._at)
        if numbers is not None:
            self._at = numbers.end()
            return NumberText(numbers[1])
        values: list[Value] = []
        while (token := self._next()) != "]":
            if token in ("PROTO", "EXTERNPROTO", "ROUTE"):
                self._statement(token)
            else:
                values.append(self._word_or_node(token))
        return values

    def _bitmask(self) -> Value:
        words: list[Value] = []
        while (token := self._next()) != ")":
            if not token:
                self._fail("the file ends inside parentheses")
            if token != "|":
                words.append(token)
        return words

    def _interface(self, token: str) -> tuple[str, Value]:
        """Parse an interface field of a prototype or script; return its name and value, which is None for events."""
        self._next()  # its type
        name = self._next()
        if self._peek() == "IS":
            self._next()
            return name, Is(self._next())
        return name, (self._value() if token in ("field", "exposedField") else None)

    def _prototype(self, external: bool) -> None:
        kind = self._next()
        self._expect("[")
        defaults: dict[str, Value] = {}
        while (token := self._next()) != "]":
            if token not in _INTERFACE:
                self._fail(f"found {token[:40]!r} in the interface of {kind[:40]}")
            name, value = self._interface("eventIn" if external else token)
            defaults[name] = value
        if external:
            self._value()  # where its definition lies; such nodes are not drawn
            return
        self._expect("{")
        outer, self._named = self._named, {}
        self._depth += 1
        if self._depth > MAX_DEPTH:
            self._fail("the prototypes are nested too deep")
        body = self.statements(end="}")
        self._depth -= 1
        self._named = outer
        self._prototypes[kind] = Prototype(defaults, body)

    def _fail(self, message: str, offset: int | None = None) -> NoReturn:
        self._document.fail(message, self._at if offset is None else offset)
