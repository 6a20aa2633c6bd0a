"""Syntax tree of Inventor and VRML files, created by both parsers."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NoReturn, Union

import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.errors import Source, SourceError
from ravemj.formats.meshes.number_lists import parse_list

MAX_DEPTH = 100
"""Maximum nesting depth of nodes."""


@dataclass(frozen=True, slots=True)
class InventorDocument:
    """The file that contains the nodes.

    Attributes:
        path: Its path.
        text: Its content, one character per byte; empty for a binary file.
    """

    path: str
    text: str = ""

    def fail(self, message: str, offset: int) -> NoReturn:
        """Raise a ``SourceError`` about the line of a character."""
        raise SourceError(message, Source(self.path, self.text.count("\n", 0, offset) + 1 if self.text else 0))


@dataclass(frozen=True, slots=True)
class NumberText:
    """Unparsed numbers, separated by commas or white space. Most of them, such as normals, are never used."""

    text: str


@dataclass(frozen=True, slots=True)
class Is:
    """Field in a PROTO whose value is taken from the prototype's field ``name``."""

    name: str


Value = Union[NumberText, Floats, str, "InventorNode", Is, None, list["Value"]]


@dataclass(slots=True, eq=False)
class InventorNode:
    """A node with its fields, whose values are parsed on demand.

    Attributes:
        kind: Its class, for instance ``Separator``.
        document: The file that contains it.
        offset: Its start in the file.
        fields: Values by field name.
        children: Child nodes outside fields, as in Inventor's groups.
    """

    kind: str
    document: InventorDocument
    offset: int
    fields: dict[str, Value] = field(default_factory=dict[str, Value])
    children: list["InventorNode"] = field(default_factory=list["InventorNode"])

    def floats(self, name: str, width: int, default: tuple[float, ...]) -> Floats:
        """Return a field of ``width`` numbers (the first of several such values), or the standard's default.

        Raises:
            SourceError: There are fewer numbers, or the value is of another type.
        """
        value = self.fields.get(name)
        numbers = np.array(default) if value is None else self._numbers(name, value)[:width]
        if len(numbers) < width or not np.isfinite(numbers).all():
            self.fail(f"{self.kind}.{name} needs {width} numbers")
        return numbers

    def number(self, name: str, default: float) -> float:
        """Return a field of one number."""
        return float(self.floats(name, 1, (default,))[0])

    def integer(self, name: str, default: int) -> int:
        """Return a field of one integer."""
        return int(self.integers(name, (default,))[:1].sum())

    def vectors(self, name: str) -> Floats:
        """Return a field of points, shape (n, 3), without an incomplete last one."""
        value = self.fields.get(name)
        if value is None:
            return np.zeros((0, 3))
        numbers = self._numbers(name, value)
        return numbers[: len(numbers) // 3 * 3].reshape(-1, 3)

    def integers(self, name: str, default: tuple[int, ...] = ()) -> Ints:
        """Return a field of integers."""
        value = self.fields.get(name)
        numbers = np.array(default, np.float64) if value is None else self._numbers(name, value)
        if not (np.abs(numbers) < 2.0**53).all():
            self.fail(f"{self.kind}.{name} holds a number that is not an index")
        return numbers.astype(np.int_)

    def words(self, name: str, default: tuple[str, ...]) -> list[str]:
        """Return a field of words or strings: one, or several in parentheses or brackets."""
        value = self.fields.get(name)
        if value is None:
            return list(default)
        return [word for word in (value if isinstance(value, list) else [value]) if isinstance(word, str)]

    def word(self, name: str, default: str) -> str:
        """Return a field of one word or string, the first if there are several."""
        return next(iter(self.words(name, (default,))), default)

    def flag(self, name: str, default: bool) -> bool:
        """Return a field that is TRUE or FALSE, in Inventor also 1 or 0."""
        value = self.fields.get(name)
        if isinstance(value, (NumberText, np.ndarray)):
            return bool(self.number(name, float(default)))
        return self.word(name, "TRUE" if default else "FALSE") == "TRUE"

    def node(self, name: str) -> "InventorNode | None":
        """Return a field of one node, or None."""
        return next(iter(self.nodes(name)), None)

    def nodes(self, name: str) -> list["InventorNode"]:
        """Return a field of nodes."""
        value = self.fields.get(name)
        return [node for node in (value if isinstance(value, list) else [value]) if isinstance(node, InventorNode)]

    def fail(self, message: str) -> NoReturn:
        """Raise a ``SourceError`` about this node."""
        self.document.fail(message, self.offset)

    def _numbers(self, name: str, value: Value) -> Floats:
        if isinstance(value, NumberText):
            try:
                value = self.fields[name] = parse_numbers(value.text)  # a node may be used many times
            except ValueError:
                self.fail(f"{self.kind}.{name} holds something that is not a number")
        if isinstance(value, np.ndarray):
            return value
        if value != []:
            self.fail(f"{self.kind}.{name} holds something that is not a number")
        return np.zeros(0)


@dataclass(frozen=True, slots=True)
class Prototype:
    """Node template, a PROTO in VRML97.

    Attributes:
        defaults: Default values of its fields.
        body: Its nodes; the first one replaces an instance.
    """

    defaults: Mapping[str, Value]
    body: list[InventorNode]

    def instance(self, node: InventorNode, limit: int) -> tuple[InventorNode, int]:
        """Instantiate the template with the fields of a node as written, creating at most ``limit`` nodes.

        Returns:
            A group with the created node, and the number of created nodes.

        Raises:
            SourceError: More than ``limit`` nodes would be created.
        """
        values = {**self.defaults, **node.fields}
        made: dict[int, InventorNode] = {}  # a node that USE repeats is filled in once

        def filled(pattern: InventorNode) -> InventorNode:
            known = made.get(id(pattern))
            if known is not None:
                return known
            if len(made) >= limit:
                node.fail("the prototypes make too many nodes")
            copy = made[id(pattern)] = InventorNode(pattern.kind, pattern.document, pattern.offset)
            copy.fields = {name: value_of(value) for name, value in pattern.fields.items()}
            copy.children = [filled(child) for child in pattern.children]
            return copy

        def value_of(value: Value) -> Value:
            if isinstance(value, Is):
                return values.get(value.name)
            if isinstance(value, InventorNode):
                return filled(value)
            return [value_of(item) for item in value] if isinstance(value, list) else value

        children = [filled(self.body[0])] if self.body else []
        return InventorNode("Group", node.document, node.offset, {"children": list(children)}), len(made)


def parse_numbers(text: str) -> Floats:
    """Parse numbers separated by white space, commas and comments.

    Raises:
        ValueError: A word is not a number.
    """
    if "#" in text:
        text = "\n".join(line.partition("#")[0] for line in text.splitlines())
    text = text.replace(",", " ")
    try:
        return parse_list(text, float)
    except ValueError:
        return parse_list(text, lambda word: float(int(word, 0)) if "x" in word.lower() else float(word))
