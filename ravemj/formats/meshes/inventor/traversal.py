"""Traversal of the node tree, shared by all dialects of Inventor and VRML: collects triangles."""

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.errors import SourceError
from ravemj.formats.limits import MOST_NODES, MOST_TRIANGLES
from ravemj.formats.meshes import triangulation
from ravemj.formats.meshes.files import FileContent
from ravemj.formats.meshes.inventor import primitives
from ravemj.formats.meshes.inventor.nodes import InventorNode
from ravemj.formats.meshes.matrices import rotation, translation
from ravemj.formats.meshes.parts import BLACK, WHITE
from ravemj.model.scene import Rgb

_log = logging.getLogger(__name__)

_MAX_LEVELS = 200  # of nodes and of files that files include


@dataclass(frozen=True, slots=True)
class TraversalState:
    """Traversal state, set by the nodes before a shape.

    Attributes:
        matrix: From the shape's frame to the file's, 4x4.
        points: Coordinates that shapes refer to.
        metres: Length of the current unit [m].
        concave: Whether faces may be concave.
        complexity: Fineness of round shapes.
    """

    matrix: Floats = field(default_factory=lambda: np.eye(4))
    points: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    metres: float = 1.0
    concave: bool = False
    complexity: float = primitives.DEFAULT_COMPLEXITY


Material = tuple[Rgb, Rgb, float]
"""Diffuse and ambient colour and transparency. If faces have several materials, the first is used, as in OpenRAVE."""


Handler = Callable[["Traversal", InventorNode, TraversalState], TraversalState]
"""Handler of a node; returns the state of subsequent nodes."""

Opener = Callable[["Traversal", FileContent, TraversalState], TraversalState]
"""Traverses an included file; returns the state at its end."""


class Traversal:
    """Triangles collected from a file and the files that it includes.

    Attributes:
        file: The file that is traversed.
        material: The last material so far; initially white.
    """

    def __init__(self, file: FileContent, opener: Opener) -> None:
        self.file: FileContent = file
        self.material: Material = (WHITE, BLACK, 0.0)
        self._opener = opener
        self._handlers: dict[str, Handler] = {}
        self._pieces: list[Floats] = []
        self._count = 0
        self._corners_left = 5 * MOST_TRIANGLES
        self._visits = 0
        self._levels = 0
        self._materials_count = True
        self._shapes_count = True

    def corners(self) -> Floats:
        """Return all triangles, shape (n, 3, 3)."""
        return np.concatenate([np.zeros((0, 3, 3)), *self._pieces])

    def nodes(
        self, nodes: Iterable[InventorNode], handlers: dict[str, Handler], state: TraversalState
    ) -> TraversalState:
        """Traverse the nodes of a file, in the dialect of ``handlers``."""
        self._handlers = handlers
        return self.visit(nodes, state)

    def visit(self, nodes: Iterable[InventorNode], state: TraversalState) -> TraversalState:
        """Traverse nodes in order. For an unknown node, only its children are traversed."""
        self._levels += 1
        for node in nodes:
            self._visits += 1
            if self._levels > _MAX_LEVELS or self._visits > MOST_NODES:
                node.fail("the nodes are nested too deep or repeated too often")
            handler = self._handlers.get(node.kind)
            state = handler(self, node, state) if handler else self.visit(node.children, state)
        self._levels -= 1
        return state

    def collect_materials(self, nodes: Iterable[InventorNode], state: TraversalState) -> None:
        """Traverse nodes for their materials only; OpenRAVE also uses those of hidden levels of detail."""
        before, self._shapes_count = self._shapes_count, False
        self.visit(nodes, state)
        self._shapes_count = before

    def add(self, corners: Floats, node: InventorNode, state: TraversalState) -> TraversalState:
        """Add triangles given in the shape's frame."""
        if not self._shapes_count:
            return state
        self._count += len(corners)
        if self._count > MOST_TRIANGLES:
            node.fail(f"there are {self._count:,} triangles in the mesh, and at most {MOST_TRIANGLES:,} are read")
        self._pieces.append(corners @ state.matrix[:3, :3].T + state.matrix[:3, 3])
        return state

    def add_polygons(self, sizes: Ints, index: Ints, node: InventorNode, state: TraversalState) -> TraversalState:
        """Add the polygons of a shape, given their sizes and their point indices in ``state.points``."""
        self._corners_left -= len(index)
        if self._corners_left < 0:
            node.fail("the mesh has too many corners of polygons")
        return self.add(triangulation.triangles(state.points, sizes, index, state.concave), node, state)

    def include(
        self, names: Iterable[str], node: InventorNode, state: TraversalState, with_materials: bool
    ) -> TraversalState:
        """Traverse the first readable file that a node names, if any, and return the state at its end.

        Its materials are used only ``with_materials``.
        """
        files = (self.file.refer(name) for name in names)
        file = next((candidate for candidate in files if candidate is not None), None)
        if file is None:
            _log.warning("%s: %s: nothing to include", self.file.access.named(node.document.path), node.kind)
            return state
        before = self.file, self._handlers, self._materials_count, self._shapes_count, self._levels
        self.file, self._materials_count, self._levels = (
            file,
            self._materials_count and with_materials,
            self._levels + 1,
        )
        try:
            state = self._opener(self, file, state)
        except SourceError as error:
            _log.warning("%s", file.access.named(str(error)))
        self.file, self._handlers, self._materials_count, self._shapes_count, self._levels = before
        return state

    def set_material(self, material: Material) -> None:
        """Set the material of the file; the last one is used."""
        if self._materials_count:
            self.material = material


def shape(corners: Callable[[InventorNode, TraversalState], Floats]) -> Handler:
    """Return the handler of a shape; ``corners`` returns its triangles in its own frame, shape (n, 3, 3)."""
    return lambda traversal, node, state: traversal.add(corners(node, state), node, state)


def moved(state: TraversalState, step: Floats) -> TraversalState:
    """Return the state after one more transform, a 4x4 matrix."""
    return replace(state, matrix=state.matrix @ step)


def transform(node: InventorNode, scale_field: str) -> Floats:
    """Return the matrix of a Transform: translation, centre, rotation, scale along its own axes.

    ``scale_field`` is ``scale`` in VRML97, ``scaleFactor`` in older dialects.
    """
    still = (0.0, 0.0, 1.0, 0.0)
    zero = (0.0, 0.0, 0.0)
    center = node.floats("center", 3, zero)
    turn = rotation(node.floats("rotation", 4, still))
    slant = rotation(node.floats("scaleOrientation", 4, still))
    stretch = np.diag([*node.floats(scale_field, 3, (1.0, 1.0, 1.0)), 1.0])
    start = translation(node.floats("translation", 3, zero) + center)
    return start @ turn @ slant @ stretch @ slant.T @ translation(-center)
