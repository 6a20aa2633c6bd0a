"""Geometries of links: triangles of nodes, and the primitives that OpenRAVE writes in addition."""

import math
from collections.abc import Callable, Container, Iterator

import numpy as np

from ravemj.core.transforms import Floats, Pose, wxyz_from_axis_angle
from ravemj.formats.collada.extras import extras, own_techniques
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.visual import Node, polar_decomposition, read_pose
from ravemj.formats.meshes.collada.document import (
    Element,
    attribute_number,
    child,
    children,
    local_name,
    numbers,
    words,
)
from ravemj.formats.meshes.collada.materials import ColladaMaterial, bindings, read_material
from ravemj.formats.meshes.collada.triangles import triangle_meshes, unread_primitives
from ravemj.formats.meshes.parts import BLACK, WHITE, check_finite, check_size
from ravemj.model.scene import SHAPE_TYPES, CrossSection, Geometry, Mesh, Rgb, Shape, Surface, TriMesh

_DIFFUSE: Rgb = (1.0, 0.5, 0.5)
_AMBIENT: Rgb = (float(np.float32(0.1)), 0.0, 0.0)

_NO_MESH = Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.int_))
_Z_TO_Y = Pose(wxyz=wxyz_from_axis_angle((1.0, 0.0, 0.0), -math.pi / 2))


class GeometryReader:
    """Reader of the shapes of nodes, with a cache of the triangles of each ``<geometry>``."""

    def __init__(self, library: Library) -> None:
        self._library = library
        self._meshes: dict[Element, list[tuple[str, Mesh]]] = {}
        self._bound: dict[Element, dict[str, str]] = {}
        self._materials: dict[Element, ColladaMaterial | None] = {}
        self._triangles = 0

    def read(self, node: Node, T_link_node: Callable[[Node], Floats], others: Container[Node] = ()) -> list[Geometry]:
        """Return the shapes of a link's node and of the nodes in it, except ``others``, the nodes of other links.

        ``T_link_node`` returns the pose of a node in the link as OpenRAVE computes it, shape (4, 4).
        """
        shapes: list[Geometry] = []
        for inner in node.nodes:
            if inner not in others:
                shapes += self.read(inner, T_link_node, others)
        return shapes + self.read_instances(node.element, T_link_node(node))

    def read_instances(self, element: Element, T_link_element: Floats) -> list[Geometry]:
        """Return the shapes of the instances in an element, given its pose in the link, shape (4, 4)."""
        shapes: list[Geometry] = []
        for instance in children(element, "instance_geometry"):
            geometry = self._library.follow(instance)
            if geometry is not None:
                shapes += self._shapes(instance, geometry, T_link_element)
        return shapes

    def _shapes(self, instance: Element, geometry: Element, T_link_node: Floats) -> Iterator[Geometry]:
        info = next((technique for _, technique in extras(geometry, "geometry_info")), None)
        source = self._library.source(instance)
        T_link_frame, scaling = polar_decomposition(T_link_node, source)
        visible = True
        if info is not None:
            T_link_frame = T_link_frame @ read_pose(self._library, info)
            visible = words(child(info, "visible", "bool"))[:1] != ["false"]
        primitive = None if info is None else self._primitive(info)
        groups = self._groups(geometry)
        is_empty = primitive is not None or child(info, "trimesh") is not None
        for symbol, mesh in [("", _NO_MESH)] if is_empty and not groups else groups:
            diffuse, ambient, opacity = self._colours(instance, symbol)
            shape, T = primitive or (self._mesh(mesh, scaling, T_link_frame, geometry), Pose())
            display, modifiable = self._own(geometry, T_link_frame)
            yield Geometry(
                shape=shape,
                T_link_geometry=T_link_frame @ T,
                name=geometry.get("name", ""),
                diffuse=diffuse,
                ambient=ambient,
                transparency=opacity,
                visible=visible,
                modifiable=modifiable,
                display=None if display is None else (Surface(display, diffuse, opacity),),
                source=source,
            )
            if primitive is not None:
                return

    def _own(self, geometry: Element, T_link_frame: Pose) -> tuple[Mesh | None, bool]:
        """Read ravemj's extra of a geometry: return its display mesh or None, and its flag ``modifiable``."""
        technique = next(own_techniques(geometry), None)
        render = child(technique, "render")
        target = None if render is None else self._library.follow(render, "geometry")
        modifiable = words(child(technique, "modifiable"))[:1] != ["false"]
        if target is None:
            return None, modifiable
        drawn = Mesh.merged(mesh for _, mesh in self._groups(target))
        return self._mesh(drawn, None, T_link_frame, target).mesh, modifiable

    def _mesh(self, mesh: Mesh, scaling: Floats | None, T_link_frame: Pose, geometry: Element) -> TriMesh:
        """Convert triangles from the link's frame to the geometry's, after ``scaling`` in the link's frame."""
        self._triangles += len(mesh.triangles)
        source = self._library.source(geometry)
        check_size(self._triangles, source)
        inverse = T_link_frame.inverse()
        if scaling is None and inverse == Pose():
            return TriMesh(mesh)
        matrix = inverse.matrix()
        linear = matrix[:3, :3] if scaling is None else matrix[:3, :3] @ scaling
        vertices = mesh.vertices @ linear.T + matrix[:3, 3]
        check_finite(vertices, source)
        return TriMesh(Mesh(vertices, mesh.triangles))

    def _groups(self, geometry: Element) -> list[tuple[str, Mesh]]:
        """Return material symbol and triangles [m] of each primitive element of a geometry."""
        if geometry not in self._meshes:
            document = self._library.document_of(geometry)
            groups = triangle_meshes(document, geometry, self._library.metres(geometry))
            for element, mesh in groups:
                self._check_count(element, len(mesh.triangles))
            for element in unread_primitives(geometry):
                self._library.warn("ignored-tag", "OpenRAVE reads no such primitives; they are left out", element)
            self._meshes[geometry] = [(item.get("material", ""), mesh) for item, mesh in groups if len(mesh.triangles)]
        return self._meshes[geometry]

    def _check_count(self, element: Element, readable: int) -> None:
        """Warn if any declared triangle of ``<triangles>``, or every polygon of another element, is unreadable."""
        count = attribute_number(element, "count", 0)
        if readable < count and (readable == 0 or local_name(element) == "triangles"):
            message = f"only {readable} of {count:.0f} can be read: indices lead nowhere, or numbers are missing"
            self._library.warn("broken-mesh", message, element)

    def _colours(self, instance: Element, symbol: str) -> tuple[Rgb, Rgb, float]:
        """Return diffuse colour, ambient colour and transparency of the primitives with the material ``symbol``."""
        if instance not in self._bound:
            self._bound = {instance: bindings(instance)}  # for all of its groups, which come one after the other
        bound = self._bound[instance]
        url = bound.get(symbol, next(iter(bound.values())) if bound and not symbol else "")
        document = self._library.document_of(instance)
        element = document.find("material", url)
        if element is not None and element not in self._materials:
            self._materials[element] = read_material(document, element)
        material = None if element is None else self._materials[element]
        if material is None:
            if url:
                self._library.warn("broken-reference", f"there is no material '{url}' with an effect", instance)
            return WHITE, BLACK, 0.0
        opacity = material.alpha if material.transparency is None else material.transparency
        transparency = 1.0 - opacity if 0.0 < opacity <= 1.0 else 0.0  # 0 counts as 1
        missing = WHITE if material.is_phong else _DIFFUSE
        return material.diffuse or missing, material.ambient or _AMBIENT, transparency

    def _primitive(self, info: Element) -> tuple[Shape, Pose] | None:
        """Return the primitive that replaces the triangles, and its pose in the geometry's frame; None if none does."""
        for element in children(info, *_PRIMITIVES):
            shape = _shape(element, self._library.metres(element))
            if shape is not None:
                return shape, _Z_TO_Y if local_name(element) == "cylinder" else Pose()
            self._library.warn("bad-number", "a size is missing or not finite; the triangles count", element)
        for element in children(info):
            if local_name(element) not in _KNOWN:
                message = "ravemj knows no such shape; the triangles count"
                self._library.warn("unknown-type", message, element)
        return None


def _shape(element: Element, metres: float) -> Shape | None:
    """Return the primitive shape of an element with one child per size; None if a size is missing or not finite.

    ``metres`` is the length of the file's unit [m].
    """
    kind = _PRIMITIVES[local_name(element)]
    sizes: dict[str, object] = {}
    for name, form, optional in kind.sizes():
        lengths = numbers(child(element, name))
        count = 1 if form is float else len(lengths) // 2 * 2 if form is CrossSection else 3
        values = (lengths[:count] * metres).tolist()
        if len(values) == count and all(map(math.isfinite, values)):
            corners = tuple(zip(values[::2], values[1::2], strict=True)) if form is CrossSection else tuple(values)
            sizes[name] = values[0] if form is float else corners
        elif not optional:
            return None
    return kind.of_sizes(sizes)


_PRIMITIVES = {tag: kind.shape for kind in SHAPE_TYPES for tag in kind.collada if kind.shape is not TriMesh}
_KNOWN = {*_PRIMITIVES, "translate", "rotate", "matrix", "scale", "lookat", "visible", "trimesh"}
