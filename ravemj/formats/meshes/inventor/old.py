"""The node types of Inventor 1.0 to 2.1 and VRML 1.0: nodes change a state that the shapes after them use."""

from dataclasses import replace

import numpy as np

from ravemj.core.transforms import Ints
from ravemj.formats.meshes import triangulation
from ravemj.formats.meshes.inventor import primitives
from ravemj.formats.meshes.inventor.nodes import Node
from ravemj.formats.meshes.inventor.traversal import Handler, Material, State, Traversal, moved, transform
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


def _separator(traversal: Traversal, node: Node, state: State) -> State:
    traversal.visit(node.children, state)
    return state


def _group(traversal: Traversal, node: Node, state: State) -> State:
    return traversal.visit(node.children, state)


def _transform_separator(traversal: Traversal, node: Node, state: State) -> State:
    return replace(traversal.visit(node.children, state), matrix=state.matrix, metres=state.metres)


def _switch(traversal: Traversal, node: Node, state: State) -> State:
    which = node.integer("whichChild", -1)
    if which == -3:  # all
        return traversal.visit(node.children, state)
    which = max(which, -1)  # -2 is that of an outer switch, which nobody writes into files
    return traversal.visit(node.children[which : which + 1] if which >= 0 else [], state)


def _first_child(traversal: Traversal, node: Node, state: State) -> State:
    after = traversal.visit(node.children[:1], state)
    traversal.collect_materials(node.children[1:], state)
    return after


def _include(traversal: Traversal, node: Node, state: State) -> State:
    return traversal.include(node.words("name", ()), node, state, with_materials=False)


def _translation(_traversal: Traversal, node: Node, state: State) -> State:
    return moved(state, translation(node.floats("translation", 3, (0.0, 0.0, 0.0))))


def _rotation(_traversal: Traversal, node: Node, state: State) -> State:
    return moved(state, rotation(node.floats("rotation", 4, (0.0, 0.0, 1.0, 0.0))))


def _rotation_xyz(_traversal: Traversal, node: Node, state: State) -> State:
    axis = {"X": [1.0, 0.0, 0.0], "Y": [0.0, 1.0, 0.0], "Z": [0.0, 0.0, 1.0]}.get(node.word("axis", "X"))
    if axis is None:
        node.fail("the axis of a RotationXYZ is X, Y or Z")
    return moved(state, rotation(np.array([*axis, node.number("angle", 0.0)])))


def _scale(_traversal: Traversal, node: Node, state: State) -> State:
    return moved(state, np.diag([*node.floats("scaleFactor", 3, (1.0, 1.0, 1.0)), 1.0]))


def _transform(_traversal: Traversal, node: Node, state: State) -> State:
    return moved(state, transform(node, "scaleFactor"))


def _matrix_transform(_traversal: Traversal, node: Node, state: State) -> State:
    rows = node.floats("matrix", 16, tuple(np.eye(4).ravel().tolist())).reshape(4, 4)
    return moved(state, rows.T)  # written for row vectors


def _reset_transform(_traversal: Traversal, _node: Node, state: State) -> State:
    return replace(state, matrix=np.eye(4), metres=1.0)


def _units(_traversal: Traversal, node: Node, state: State) -> State:
    metres = _METRES.get(node.word("units", "METERS"))
    if metres is None:
        node.fail(f"unknown unit of length {node.word('units', '')[:40]!r}")
    factor = metres / state.metres
    return replace(moved(state, np.diag([factor, factor, factor, 1.0])), metres=metres)


def _complexity(_traversal: Traversal, node: Node, state: State) -> State:
    return replace(state, complexity=min(max(node.number("value", primitives.DEFAULT_COMPLEXITY), 0.0), 1.0))


def _shape_hints(_traversal: Traversal, node: Node, state: State) -> State:
    return replace(state, concave=node.word("faceType", "CONVEX") == "UNKNOWN_FACE_TYPE")


def _coordinate3(_traversal: Traversal, node: Node, state: State) -> State:
    return replace(state, points=node.vectors("point"))


def _vertex_property(_traversal: Traversal, node: Node, state: State) -> State:
    return replace(state, points=node.vectors("vertex")) if "vertex" in node.fields else state


def _material(traversal: Traversal, node: Node, state: State) -> State:
    gray = node.floats("diffuseColor", 3, (0.8, 0.8, 0.8))
    ambient = node.floats("ambientColor", 3, (0.2, 0.2, 0.2))
    traversal.set_material(Material(rgb(gray), rgb(ambient), node.number("transparency", 0.0)))
    return state


def _face_set(traversal: Traversal, node: Node, state: State) -> State:
    state_of_shape = _with_own_points(traversal, node, state)
    sizes, index = _runs(node, state_of_shape)
    traversal.add_polygons(sizes, index, node, state_of_shape)
    return state


def _indexed_face_set(traversal: Traversal, node: Node, state: State) -> State:
    traversal.add_polygons(
        *triangulation.split(node.integers("coordIndex", (0,))), node, _with_own_points(traversal, node, state)
    )
    return state


def _triangle_strips(traversal: Traversal, node: Node, state: State) -> State:
    state_of_shape = _with_own_points(traversal, node, state)
    sizes, index = _runs(node, state_of_shape)
    triangles = triangulation.strips(sizes, index)
    traversal.add_polygons(np.full(len(triangles), 3), triangles.ravel(), node, state_of_shape)
    return state


def _indexed_triangle_strips(traversal: Traversal, node: Node, state: State) -> State:
    triangles = triangulation.strips(*triangulation.split(node.integers("coordIndex", (0,))))
    points = _with_own_points(traversal, node, state)
    traversal.add_polygons(np.full(len(triangles), 3), triangles.ravel(), node, points)
    return state


def _quad_mesh(traversal: Traversal, node: Node, state: State) -> State:
    state_of_shape = _with_own_points(traversal, node, state)
    rows, columns = (node.integer(name, 1) for name in ("verticesPerColumn", "verticesPerRow"))
    start = node.integer("startIndex", 0)
    if rows < 1 or columns < 1 or start < 0 or start + rows * columns > len(state_of_shape.points):
        node.fail("a QuadMesh with fewer points than it says")
    grid = start + np.arange(rows * columns).reshape(rows, columns)
    quads = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=-1).reshape(-1, 4)
    traversal.add_polygons(np.full(len(quads), 4), quads.ravel(), node, state_of_shape)
    return state


def _with_own_points(traversal: Traversal, node: Node, state: State) -> State:
    """Return the state with the points of the shape's ``vertexProperty``, if it has one."""
    own = node.node("vertexProperty")
    return state if own is None else _vertex_property(traversal, own, state)


def _runs(node: Node, state: State) -> tuple[Ints, Ints]:
    """Return sizes and corners of a shape that uses points in their order; a size of -1 takes all that are left."""
    start = node.integer("startIndex", 0)
    there = max(len(state.points) - start, 0) if start >= 0 else 0
    sizes = node.integers("numVertices", (-1,)).clip(-1, there + 1)
    if len(sizes) and sizes[-1] < 0:
        sizes[-1] = max(there - int(sizes[:-1].clip(0).sum()), 0)
    sizes = sizes.clip(0)
    sizes = sizes[np.cumsum(sizes) <= there]
    return sizes, start + np.arange(int(sizes.sum()))


def _cube(traversal: Traversal, node: Node, state: State) -> State:
    size = np.array([node.number(name, 2.0) for name in ("width", "height", "depth")])
    return traversal.add(primitives.box(size), node, state)


def _sphere(traversal: Traversal, node: Node, state: State) -> State:
    return traversal.add(primitives.sphere(node.number("radius", 1.0), state.complexity), node, state)


def _cylinder(traversal: Traversal, node: Node, state: State) -> State:
    radius, height = node.number("radius", 1.0), node.number("height", 2.0)
    parts = _parts(node, {"SIDES", "TOP", "BOTTOM"})
    return traversal.add(primitives.cylinder(radius, height, parts, state.complexity), node, state)


def _cone(traversal: Traversal, node: Node, state: State) -> State:
    radius, height = node.number("bottomRadius", 1.0), node.number("height", 2.0)
    parts = _parts(node, {"SIDES", "BOTTOM"})
    return traversal.add(primitives.cone(radius, height, parts, state.complexity), node, state)


def _parts(node: Node, everything: set[str]) -> set[str]:
    parts = set(node.words("parts", ("ALL",)))
    return everything if "ALL" in parts else parts


HANDLERS: dict[str, Handler] = {
    "Separator": _separator,
    "Annotation": _separator,
    "Selection": _separator,
    "WWWAnchor": _separator,
    "Group": _group,
    "TransformSeparator": _transform_separator,
    "Switch": _switch,
    "LOD": _first_child,
    "LevelOfDetail": _first_child,
    "File": _include,
    "WWWInline": _include,
    "Translation": _translation,
    "Rotation": _rotation,
    "RotationXYZ": _rotation_xyz,
    "Scale": _scale,
    "Transform": _transform,
    "MatrixTransform": _matrix_transform,
    "ResetTransform": _reset_transform,
    "Units": _units,
    "Complexity": _complexity,
    "ShapeHints": _shape_hints,
    "Coordinate3": _coordinate3,
    "VertexProperty": _vertex_property,
    "Material": _material,
    "FaceSet": _face_set,
    "IndexedFaceSet": _indexed_face_set,
    "TriangleStripSet": _triangle_strips,
    "IndexedTriangleStripSet": _indexed_triangle_strips,
    "QuadMesh": _quad_mesh,
    "Cube": _cube,
    "Sphere": _sphere,
    "Cylinder": _cylinder,
    "Cone": _cone,
}
"""What to do at each kind of node; lights, cameras, textures, lines and text draw nothing here."""
