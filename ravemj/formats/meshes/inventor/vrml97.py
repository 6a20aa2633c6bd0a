"""Node types of VRML97."""

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.formats.meshes import triangulation
from ravemj.formats.meshes.inventor import primitives
from ravemj.formats.meshes.inventor.nodes import InventorNode
from ravemj.formats.meshes.inventor.traversal import Handler, Traversal, TraversalState, moved, shape, transform
from ravemj.formats.meshes.parts import rgb


def _group(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    traversal.visit([*node.nodes("children"), *node.children], state)
    return state


def _transform(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    _group(traversal, node, moved(state, transform(node, "scale")))
    return state


def _switch(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    which = node.integer("whichChoice", -1)
    choice = node.nodes("choice") or node.nodes("children")  # the latter is X3D's name
    traversal.visit(choice[which : which + 1] if which >= 0 else [], state)
    return state


def _level_of_detail(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    levels = node.nodes("level") or node.nodes("children")
    traversal.visit(levels[:1], state)
    traversal.collect_materials(levels[1:], state)
    return state


def _inline(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    traversal.include(node.words("url", ()), node, state, with_materials=True)
    return state


def _shape(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    traversal.visit(node.nodes("appearance"), state)
    traversal.visit(node.nodes("geometry"), state)
    return state


def _appearance(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    traversal.visit(node.nodes("material"), state)
    return state


def _material(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    diffuse = node.floats("diffuseColor", 3, (0.8, 0.8, 0.8))
    ambient = np.repeat(node.number("ambientIntensity", 0.2), 3)
    traversal.set_material((rgb(diffuse), rgb(ambient), node.number("transparency", 0.0)))
    return state


def _indexed_face_set(traversal: Traversal, node: InventorNode, state: TraversalState) -> TraversalState:
    coordinates = node.node("coord")
    if coordinates is None:
        return state
    own = TraversalState(state.matrix, coordinates.vectors("point"), concave=not node.flag("convex", True))
    traversal.add_polygons(*triangulation.split(node.integers("coordIndex")), node, own)
    return state


def _cylinder(node: InventorNode, _state: TraversalState) -> Floats:
    return primitives.cylinder(node.number("radius", 1.0), node.number("height", 2.0), _parts(node))


def _cone(node: InventorNode, _state: TraversalState) -> Floats:
    return primitives.cone(node.number("bottomRadius", 1.0), node.number("height", 2.0), _parts(node))


def _parts(node: InventorNode) -> set[str]:
    fields = {"SIDES": "side", "TOP": "top", "BOTTOM": "bottom"}
    return {part for part, field in fields.items() if node.flag(field, True)}


HANDLERS: dict[str, Handler] = {
    **dict.fromkeys(("Group", "Anchor", "Billboard", "Collision"), _group),
    "Transform": _transform,
    "Switch": _switch,
    "LOD": _level_of_detail,
    "Inline": _inline,
    "Shape": _shape,
    "Appearance": _appearance,
    "Material": _material,
    "IndexedFaceSet": _indexed_face_set,
    "Box": shape(lambda node, _state: primitives.box(node.floats("size", 3, (2.0, 2.0, 2.0)))),
    "Sphere": shape(lambda node, _state: primitives.sphere(node.number("radius", 1.0))),
    "Cylinder": shape(_cylinder),
    "Cone": shape(_cone),
}
"""Handler of each node type; lights, sensors, lines, points and text are ignored."""
