"""Prototypes of VRML97 (PROTO): nodes with parameters, instantiated for each use."""

from collections.abc import Mapping
from dataclasses import dataclass

from ravemj.formats.meshes.inventor.nodes import Is, Node, Value


@dataclass(frozen=True, slots=True)
class Prototype:
    """A named pattern of nodes.

    Attributes:
        defaults: Values of its fields where an instance gives none.
        body: Its nodes; the first is what an instance stands for.
    """

    defaults: Mapping[str, Value]
    body: list[Node]

    def instance(self, node: Node, limit: int) -> tuple[Node, int]:
        """Fill in the pattern.

        Args:
            node: The instance as written, with values for some fields.
            limit: How many nodes may be made at most.

        Returns:
            A group of the filled-in node, and how many nodes were made.

        Raises:
            SourceError: More nodes than ``limit`` would be made.
        """
        filling = _Filling({**self.defaults, **node.fields}, node, limit)
        children = [filling.node(self.body[0])] if self.body else []
        return Node("Group", node.document, node.offset, {"children": list(children)}), limit - filling.left


class _Filling:
    """One pass over a pattern; a node that USE repeats is filled in once."""

    def __init__(self, values: Mapping[str, Value], instance: Node, limit: int) -> None:
        self._values = values
        self._instance = instance
        self._made: dict[int, Node] = {}
        self.left = limit

    def node(self, pattern: Node) -> Node:
        made = self._made.get(id(pattern))
        if made is not None:
            return made
        self.left -= 1
        if self.left < 0:
            self._instance.fail("the prototypes make too many nodes")
        made = self._made[id(pattern)] = Node(pattern.kind, pattern.document, pattern.offset)
        made.fields = {name: self._value(value) for name, value in pattern.fields.items()}
        made.children = [self.node(child) for child in pattern.children]
        return made

    def _value(self, value: Value) -> Value:
        if isinstance(value, Is):
            return self._values.get(value.name)
        if isinstance(value, Node):
            return self.node(value)
        if isinstance(value, list):
            return [self._value(item) for item in value]
        return value
