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
        """Fill in the pattern with the fields of a node as written, making ``limit`` nodes at most.

        Returns:
            A group of the filled-in node, and how many nodes were made.

        Raises:
            SourceError: More nodes than ``limit`` would be made.
        """
        values = {**self.defaults, **node.fields}
        made: dict[int, Node] = {}  # a node that USE repeats is filled in once

        def filled(pattern: Node) -> Node:
            known = made.get(id(pattern))
            if known is not None:
                return known
            if len(made) >= limit:
                node.fail("the prototypes make too many nodes")
            copy = made[id(pattern)] = Node(pattern.kind, pattern.document, pattern.offset)
            copy.fields = {name: value_of(value) for name, value in pattern.fields.items()}
            copy.children = [filled(child) for child in pattern.children]
            return copy

        def value_of(value: Value) -> Value:
            if isinstance(value, Is):
                return values.get(value.name)
            if isinstance(value, Node):
                return filled(value)
            return [value_of(item) for item in value] if isinstance(value, list) else value

        children = [filled(self.body[0])] if self.body else []
        return Node("Group", node.document, node.offset, {"children": list(children)}), len(made)
