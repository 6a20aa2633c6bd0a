"""Node types of Inventor 1.0 to 2.1 and VRML 1.0: nodes change the state for subsequent shapes."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.formats.meshes import triangulation
from ravemj.formats.meshes.inventor import primitives
from ravemj.formats.meshes.inventor.nodes import InventorNode
from ravemj.formats.meshes.inventor.traversal import Handler, Traversal, TraversalState, moved, shape, transform
from ravemj.formats.meshes.matrices import rotation, translation
from ravemj.formats.meshes.parts import rgb

_METRES = {
    "METERS": 1.0,
    "CENTIMETERS": 1e-2,
    "MILLIMETERS": 1e-3,
    "MICROMETERS": 1e-6,
    "MICRONS": 1e-6,
    "NANOMETERS": 1e-9,
    "ANGSTROMS": 1e-10,
    "KILOMETERS": 1e3,
    "FEET": 0.3048,
    "INCHES": 0.0254,
    "POINTS": 0.0254 / 72,
    "YARDS": 0.9144,
    "MILES": 1609.344,
    "NAUTICAL_MILES": 1852.0,
}
_AXES = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}


def _separator(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    traversal.visit(node.children, state)
    return state


def _group(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    return traversal.visit(node.children, state)


def _transform_separator(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    return replace(traversal.visit(node.children, state), matrix=state.matrix, metres=state.metres)


def _switch(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    which = node.integer("whichChild", -1)
    if which == -3:  # all
        return traversal.visit(node.children, state)
    # -2 is that of an outer switch, which nobody writes into files
    return traversal.visit(node.children[which : which + 1] if which >= 0 else [], state)


def _first_child(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    after = traversal.visit(node.children[:1], state)
    traversal.collect_materials(node.children[1:], state)
    return after


def _include(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    return traversal.include(node.words("name", ()), node, state, with_materials=False)


def _moving(matrix: Callable[[InventorNode], Floats]) -> Handler:
    """Return the handler of a transform node; ``matrix`` computes the node's 4x4 transform."""
    return lambda _traversal, node, state: moved(state, matrix(node))


def _rotation_xyz(node: InventorNode) -> Floats:
    axis = _AXES.get(node.word("axis", "X"))
    if axis is None:
        node.fail("the axis of a RotationXYZ is X, Y or Z")
    return rotation(np.array([*axis, node.number("angle", 0.0)]))


def _matrix(node: InventorNode) -> Floats:
    return node.floats("matrix", 16, tuple(np.eye(4).ravel().tolist())).reshape(4, 4).T  # written for row vectors


def _reset_transform(_traversal: Traversal, _node: InventorNode, state: TraversalState) -> TraversalState:
    return replace(state, matrix=np.eye(4), metres=1.0)


def _units(_traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    metres = _METRES.get(node.word("units", "METERS"))
    if metres is None:
        node.fail(f"unknown unit of length {node.word('units', '')[:40]!r}")
    factor = metres / state.metres
    return replace(moved(state, np.diag([factor, factor, factor, 1.0])), metres=metres)


def _complexity(_traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    return replace(state, complexity=min(max(node.number("value", primitives.DEFAULT_COMPLEXITY), 0.0), 1.0))


def _shape_hints(_traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    return replace(state, concave=node.word("faceType", "CONVEX") == "UNKNOWN_FACE_TYPE")


def _coordinate3(_traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    return replace(state, points=node.vectors("point"))


def _vertex_property(_traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    return replace(state, points=node.vectors("vertex")) if "vertex" in node.fields else state


def _material(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    diffuse = node.floats("diffuseColor", 3, (0.8, 0.8, 0.8))
    ambient = node.floats("ambientColor", 3, (0.2, 0.2, 0.2))
    traversal.set_material((rgb(diffuse), rgb(ambient), node.number("transparency", 0.0)))
    return state


def _faces(polygons: Callable[[InventorNode, int], tuple[Ints, Ints]], are_strips: bool = False) -> Handler:
    """Return the handler of a shape of polygons or strips; ``polygons`` returns their sizes and point indices."""

    def add(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
        own = node.node("vertexProperty")
        state_of_shape = state if own is None else _vertex_property(traversal, own, state)
        sizes, index = polygons(node, len(state_of_shape.points))
        if are_strips:
            triangles = triangulation.strips(sizes, index)
            sizes, index = np.full(len(triangles), 3), triangles.ravel()
        traversal.add_polygons(sizes, index, node, state_of_shape)
        return state

    return add


def _indexed(node: InventorNode, _count: int) -> tuple[Ints, Ints]:
    return triangulation.split(node.integers("coordIndex", (0,)))


def _runs(node: InventorNode, count: int) -> tuple[Ints, Ints]:
    """Return sizes and point indices of faces that use consecutive points; a size of -1 takes all remaining points."""
    start = node.integer("startIndex", 0)
    there = max(count - start, 0) if start >= 0 else 0
    sizes = node.integers("numVertices", (-1,)).clip(-1, there + 1)
    if len(sizes) and sizes[-1] < 0:
        sizes[-1] = max(there - int(sizes[:-1].clip(0).sum()), 0)
    sizes = sizes.clip(0)
    sizes = sizes[np.cumsum(sizes) <= there]
    return sizes, start + np.arange(int(sizes.sum()))


def _quad_mesh(node: InventorNode, count: int) -> tuple[Ints, Ints]:
    rows, columns = (node.integer(name, 1) for name in ("verticesPerColumn", "verticesPerRow"))
    start = node.integer("startIndex", 0)
    if rows < 1 or columns < 1 or start < 0 or start + rows * columns > count:
        node.fail("a QuadMesh with fewer points than it says")
    grid = start + np.arange(rows * columns).reshape(rows, columns)
    quads = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=-1)
    return np.full(quads.size // 4, 4), quads.ravel()


def _cube(node: InventorNode, _state: TraversalState) -> Floats:
    return primitives.box(np.array([node.number(name, 2.0) for name in ("width", "height", "depth")]))


def _sphere(node: InventorNode, state: TraversalState) -> Floats:
    return primitives.sphere(node.number("radius", 1.0), state.complexity)


def _cylinder(node: InventorNode, state: TraversalState) -> Floats:
    radius, height = node.number("radius", 1.0), node.number("height", 2.0)
    return primitives.cylinder(radius, height, _parts(node), state.complexity)


def _cone(node: InventorNode, state: TraversalState) -> Floats:
    radius, height = node.number("bottomRadius", 1.0), node.number("height", 2.0)
    return primitives.cone(radius, height, _parts(node), state.complexity)


def _parts(node: InventorNode) -> set[str]:
    parts = set(node.words("parts", ("ALL",)))
    return {"SIDES", "TOP", "BOTTOM"} if "ALL" in parts else parts


HANDLERS: dict[str, Handler] = {
    **dict.fromkeys(("Separator", "Annotation", "Selection", "WWWAnchor"), _separator),
    "Group": _group,
    "TransformSeparator": _transform_separator,
    "Switch": _switch,
    **dict.fromkeys(("LOD", "LevelOfDetail"), _first_child),
    **dict.fromkeys(("File", "WWWInline"), _include),
    "Translation": _moving(lambda node: translation(node.floats("translation", 3, (0.0, 0.0, 0.0)))),
    "Rotation": _moving(lambda node: rotation(node.floats("rotation", 4, (0.0, 0.0, 1.0, 0.0)))),
    "RotationXYZ": _moving(_rotation_xyz),
    "Scale": _moving(lambda node: np.diag([*node.floats("scaleFactor", 3, (1.0, 1.0, 1.0)), 1.0])),
    "Transform": _moving(lambda node: transform(node, "scaleFactor")),
    "MatrixTransform": _moving(_matrix),
    "ResetTransform": _reset_transform,
    "Units": _units,
    "Complexity": _complexity,
    "ShapeHints": _shape_hints,
    "Coordinate3": _coordinate3,
    "VertexProperty": _vertex_property,
    "Material": _material,
    "FaceSet": _faces(_runs),
    "IndexedFaceSet": _faces(_indexed),
    "TriangleStripSet": _faces(_runs, are_strips=True),
    "IndexedTriangleStripSet": _faces(_indexed, are_strips=True),
    "QuadMesh": _faces(_quad_mesh),
    "Cube": shape(_cube),
    "Sphere": shape(_sphere),
    "Cylinder": shape(_cylinder),
    "Cone": shape(_cone),
}
"""Handler of each node type; lights, cameras, textures, lines and text are ignored."""
