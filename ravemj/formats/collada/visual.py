"""The visual scene with all instances of nodes expanded, and poses of elements."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ravemj.core.transforms import Floats, Pose, pose_of
from ravemj.errors import Source, SourceError
from ravemj.formats.collada.library import Library
from ravemj.formats.limits import MOST_NODES
from ravemj.formats.meshes.collada.document import Element, children, local_name, words
from ravemj.formats.meshes.collada.node_transforms import LENGTHS, local_transform

_MAX_DEPTH = 150
_TRANSFORMS = (*LENGTHS, "skew")


@dataclass(eq=False, slots=True)
class Node:
    """A node of the expanded scene.

    Attributes:
        element: The ``<node>``; for the scene itself the ``<visual_scene>``.
        parent: The parent node.
        names: Its id and sid, and those of the instances on its path.
        transform: Its pose in its parent [m], with scale, shape (4, 4).
        nodes: The child nodes.
        named: The nodes below it by name, cached on first use.
    """

    element: Element
    parent: "Node | None" = None
    names: set[str] = field(default_factory=set[str])
    transform: Floats = field(default_factory=lambda: np.eye(4))
    nodes: list["Node"] = field(default_factory=list["Node"])
    named: dict[str, "Node"] | None = None

    @property
    def name(self) -> str:
        """Name of the node, else its id, else its sid."""
        return self.element.get("name") or self.element.get("id") or self.element.get("sid") or ""

    @property
    def world(self) -> Floats:
        """Pose of the node in the scene, shape (4, 4)."""
        return self.transform if self.parent is None else self.parent.world @ self.transform

    def around(self) -> Iterator["Node"]:
        """Yield this node and its ancestors, the nearest first."""
        node: Node | None = self
        while node is not None:
            yield node
            node = node.parent

    def find(self, path: str) -> "Node | None":
        """Return the node at a path of names; the last name may name a transform in the node."""
        node: Node | None = self
        for name in path.strip().removeprefix("#").split("/"):
            node = None if node is None else node._below().get(name)
        return node

    def _below(self) -> dict[str, "Node"]:
        """Return this node and its descendants by name or by a transform's sid; of equal names, the nearest node."""
        if self.named is None:
            self.named = {}
            queue: deque[Node] = deque([self])
            while queue:
                node = queue.popleft()
                transforms = children(node.element, *_TRANSFORMS) if node.parent else ()
                for name in (*node.names, *(item.get("sid") for item in transforms)):
                    if name is not None:
                        self.named.setdefault(name, node)
                queue.extend(node.nodes)
        return self.named


def transform_of(library: Library, element: Element) -> Floats:
    """Return the product of the transforms in an element, in order, with lengths in metres, shape (4, 4)."""
    product = np.eye(4)
    for item in children(element):
        step = local_transform(item)
        if step is not None:
            metres = library.metres(item)
            if metres != 1.0:
                step[:3, 3] *= metres
            product = product @ step
        elif local_name(item) == "skew":
            library.warn("ignored-tag", "OpenRAVE leaves it out", item)
        elif local_name(item) in LENGTHS:
            message = f"it does not count: it needs {LENGTHS[local_name(item)]} numbers, and has {len(words(item))}"
            library.warn("bad-number", message, item)
    return product


def expand(library: Library, scene: Element) -> Node:
    """Return the expanded tree of a visual scene: every instance of a node becomes a separate copy.

    Raises:
        SourceError: The nodes are nested too deep or repeated too often.
    """
    root = Node(scene)
    count = 0

    def fill(node: Node, depth: int, suffix: str) -> None:
        nonlocal count
        count += 1
        if depth > _MAX_DEPTH or count > MOST_NODES:
            raise library.error("the nodes are nested too deep or repeated too often", node.element)
        for element in children(node.element, "node", "instance_node"):
            target: Element | None = element
            names: list[str | None] = []
            ending = suffix
            if local_name(element) == "instance_node":
                target, names = library.follow(element), [element.get("sid"), element.get("id")]
                suffixes = (item.get("name") for item in children(element, "extra") if item.get("type") == "idsuffix")
                ending = next(suffixes, None) or suffix
            if target is None:
                continue
            identity = target.get("id")
            names += [target.get("sid"), identity + ending if identity else None]
            inner = Node(target, node, {name for name in names if name}, transform_of(library, target))
            node.nodes.append(inner)
            fill(inner, depth + 1, ending)

    fill(root, 0, "")
    return root


def find_node(library: Library, root: Node | None, path: str, element: Element) -> Node | None:
    """Return the node at a path of the visual scene; None, with a warning about ``element``, if it does not exist."""
    node = None if root is None else root.find(path.rpartition("#")[2])
    if node is None:
        library.warn("broken-reference", f"there is no node '{path}' in the visual scene", element)
    return node


def read_pose(library: Library, element: Element) -> Pose:
    """Return the pose of an element's transforms, without stretch.

    Raises:
        SourceError: A number in them is not finite.
    """
    return rigid_part(transform_of(library, element), library.source(element))


def polar_decomposition(matrix: Floats, source: Source) -> tuple[Pose, Floats | None]:
    """Decompose a 4x4 matrix into a pose and a 3x3 stretch (None if rigid), ``matrix = pose @ stretch``.

    Raises:
        SourceError: A number in it is not finite.
    """
    linear = matrix[:3, :3]
    if not np.isfinite(matrix).all() or np.abs(matrix).max() > 1e100:
        raise SourceError("a transform has a number that is not finite", source)
    if np.abs(linear.T @ linear - np.eye(3)).max() < 1e-7 and np.linalg.det(linear) > 0:
        return pose_of(matrix), None
    u, _, vt = np.linalg.svd(linear)
    rigid = matrix.copy()
    rigid[:3, :3] = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    return pose_of(rigid), rigid[:3, :3].T @ linear


def rigid_part(matrix: Floats, source: Source) -> Pose:
    """Return the pose of a matrix, without stretch.

    Raises:
        SourceError: A number in it is not finite.
    """
    return polar_decomposition(matrix, source)[0]
