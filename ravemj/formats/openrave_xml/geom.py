"""``<Geom>``: a shape of a link, its pose and its colours."""

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import UNSCALED, ZERO, Floats, Pose, Vec3, rows_from_wxyz, scale, wxyz_from_axis_angle
from ravemj.errors import Diagnostics
from ravemj.formats.meshes import MeshPart
from ravemj.formats.openrave_xml.context import PLACEMENT_TAGS, Context, Placed
from ravemj.formats.openrave_xml.tags import Tag
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import (
    hadamard,
    is_false,
    leading_numbers,
    number,
    vector,
    words,
)
from ravemj.model.scene import (
    SHAPE_TYPES,
    Cylinder,
    Geometry,
    Mesh,
    MeshFile,
    NoShape,
    Rgb,
    Shape,
    Surface,
    TriMesh,
)

CYLINDER_TURN = Pose(ZERO, wxyz_from_axis_angle((1.0, 0.0, 0.0), math.pi / 2))
"""Rotation from the axis of cylinders in memory, z, to that in XML, y."""

_NO_PART = MeshPart(Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int)))
_REDDISH = replace(_NO_PART, diffuse=(1.0, 0.5, 0.5), ambient=(0.1, 0.0, 0.0))


class GeometryScope(NamedTuple):
    """Properties that a ``<Geom>`` inherits from its ancestors.

    Attributes:
        models_folder: Folder to search for meshes first, or None.
        scale: Accumulated ``scalegeometry``; it is applied to meshes only, in the axes of the link.
    """

    models_folder: str | None = None
    scale: Vec3 = (1.0, 1.0, 1.0)


@dataclass(slots=True)
class _Geom(Placed):
    """Reading state of a ``<Geom>``."""

    name: str = ""
    vectors: dict[str, Vec3] = field(default_factory=lambda: {})
    numbers: dict[str, float] = field(default_factory=lambda: {})
    cross_section: tuple[tuple[float, float], ...] = ()
    vertices: Sequence[float] = ()
    collision: MeshFile | None = None
    render: MeshFile | None = None
    diffuse: Rgb | None = None
    ambient: Rgb | None = None
    transparency: float | None = None

    def read_half_extents(self, element: Element) -> None:
        self.vectors["half_extents"] = vector(element, self.context.diagnostics, self.vectors.get("half_extents", ZERO))

    def read_full_extents(self, element: Element) -> None:
        self.read_half_extents(element)
        self.vectors["half_extents"] = scale(self.vectors["half_extents"], 0.5)

    def read_number(self, element: Element) -> None:
        """Store a scalar size under the name of its tag."""
        self.numbers[element.tag] = number(element, self.context.diagnostics, self.numbers.get(element.tag, 0.0))

    def read_vector(self, element: Element) -> None:
        """Store a three-dimensional size under the name of its tag."""
        self.vectors[element.tag] = vector(element, self.context.diagnostics, self.vectors.get(element.tag, ZERO))

    def read_cross_section(self, element: Element) -> None:
        numbers, rest = leading_numbers(element.text)
        if rest or len(numbers) % 2:
            message = f"<{element.spelled}> needs x and y of each corner, and holds {len(numbers)} numbers"
            self.context.diagnostics.warn("number-count", message, element.source)
        self.cross_section = tuple(zip(numbers[::2], numbers[1::2], strict=False))

    def read_vertices(self, element: Element) -> None:
        self.vertices, rest = leading_numbers(element.text)
        if rest or len(self.vertices) % 9:
            message = f"<{element.spelled}> needs nine numbers for each triangle, and holds {len(self.vertices)}"
            self.context.diagnostics.warn("number-count", message, element.source)
        if len(self.vertices) % 9:  # errors-37
            self.vertices = ()

    def read_collision(self, element: Element) -> None:
        self.collision = self._first(self.collision, element)

    def read_render(self, element: Element) -> None:
        self.render = self._first(self.render, element)

    def _first(self, before: MeshFile | None, element: Element) -> MeshFile:
        """Return the first file of the geom: ``before`` (with a warning), or else the file that the element names."""
        self.context.check_attributes(element, {} if element.tag == "data" else MESH_ATTRIBUTES, {})
        if before is None or not before.name:
            return _mesh_file(element, self.context.diagnostics)
        message = f"<{element.spelled}> is left out: the first file, '{before.name}', counts"
        self.context.diagnostics.warn("repeated-tag", message, element.source, "write one")
        return before

    def read_diffuse(self, element: Element) -> None:
        self.diffuse = vector(element, self.context.diagnostics, self.diffuse or UNSCALED)

    def read_ambient(self, element: Element) -> None:
        self.ambient = vector(element, self.context.diagnostics, self.ambient or ZERO)

    def read_transparency(self, element: Element) -> None:
        self.transparency = number(element, self.context.diagnostics, self.transparency or 0.0)

    def read_name(self, element: Element) -> None:
        self.name = element.text.strip()


GEOM_TAGS: dict[str, Tag[_Geom]] = {
    **PLACEMENT_TAGS,
    "extents": Tag(_Geom.read_half_extents, "of a box: half sizes x y z [m]"),
    "halfextents": Tag(_Geom.read_half_extents, "of a box: half sizes x y z [m]"),
    "fullextents": Tag(_Geom.read_full_extents, "of a box: sizes x y z [m]"),
    "radius": Tag(_Geom.read_number, "of a sphere, cylinder or capsule [m]", once="radius"),
    "height": Tag(_Geom.read_number, "of a cylinder, along y, and of a capsule or prism, along z [m]", once="height"),
    "outer_extents": Tag(_Geom.read_vector, "of a container: sizes x y z [m]"),
    "inner_extents": Tag(_Geom.read_vector, "of a container: sizes of the inside [m]"),
    "bottom_cross": Tag(_Geom.read_vector, "of a container: sizes of a cross on the bottom [m]"),
    "bottom": Tag(_Geom.read_vector, "of a container: sizes of a plate on the bottom [m]"),
    "crosssection": Tag(
        _Geom.read_cross_section, "of a prism: x y of its corners [m]; it has walls, and no top and bottom"
    ),
    "vertices": Tag(_Geom.read_vertices, "of a trimesh: nine numbers a triangle [m]", once=True),
    "data": Tag(_Geom.read_collision, "mesh file that collides, and scale"),
    "collision": Tag(_Geom.read_collision, "the same as Data, also as attributes file and scale"),
    "render": Tag(_Geom.read_render, "mesh file that is drawn, and scale"),
    "diffusecolor": Tag(_Geom.read_diffuse, "red green blue, from 0 to 1", once=True),
    "ambientcolor": Tag(_Geom.read_ambient, "red green blue, from 0 to 1", once=True),
    "transparency": Tag(_Geom.read_transparency, "from 0 to 1", once=True),
    "name": Tag(_Geom.read_name, "name of the shape", once=True),
}
GEOM_IGNORED = {"sidewall": "OpenRAVE itself cannot make a cage from XML"}
GEOM_ATTRIBUTES = {
    "type": f"{', '.join(kind.xml for kind in SHAPE_TYPES if kind.xml)}; others have no shape here",
    "name": "name of the shape",
    "render": "false: collides and is not drawn",
    "modifiable": "false: planners leave it alone",
    "group": "other than `self`: no shape of the link, but one of a set that scripts can swap in",
}

MESH_ATTRIBUTES = {"file": "the mesh file", "scale": "one to three factors"}
"""Attributes of ``<Collision>`` and ``<Render>``."""

SIZE_TAGS = {"half_extents": "extents", "cross_section": "crosssection"}
"""Tags whose size parameter has another name."""

_SHAPES = {kind.xml: kind.shape for kind in SHAPE_TYPES}
_VECTORS = ("half_extents", "outer_extents", "inner_extents", "bottom_cross", "bottom")
_NO_SIZES = {**dict.fromkeys(_VECTORS, ZERO), "radius": 0.0, "height": 0.0}


def read_geometries(element: Element, scope: GeometryScope, context: Context) -> list[Geometry]:
    """Read a ``<Geom>``: one geometry, or one for each part of its mesh file."""
    context.check_attributes(element, GEOM_ATTRIBUTES, {})
    kind = element.attributes.get("type", "").lower() or "box"  # gap-31
    geom = _Geom(context, name=element.attributes.get("name", ""))
    context.walk(element, GEOM_TAGS, GEOM_IGNORED, geom)
    shape = _SHAPES.get(kind)
    if shape is TriMesh:
        return _trimesh(geom, element, scope)
    if shape is None:  # geom-26
        message = f"a geometry of type '{kind}' has no shape here"
        context.diagnostics.warn("unsupported-geometry", message, element.source)
    display = _surfaces(geom, geom.render, element, scope)
    sizes = {**_NO_SIZES, **geom.vectors, **geom.numbers, "cross_section": geom.cross_section}
    return [_geometry(geom, element, (shape or NoShape).of_sizes(sizes), scope, _NO_PART, display)]


def _trimesh(geom: _Geom, element: Element, scope: GeometryScope) -> list[Geometry]:
    """Return the geometries of a trimesh: of the collision file, else of the render file, else of its vertices."""
    geometries: list[Geometry] = []
    for file in (geom.collision, geom.render):
        parts = _parts(geom, file, element, scope)
        drawn = geom.render if parts and file is geom.collision else None
        surfaces = _surfaces(geom, drawn, element, scope)
        displays = [surfaces, *[None if surfaces is None else ()] * (len(parts) - 1)]
        geometries += [
            _geometry(geom, element, TriMesh(_scaled(part.mesh, geom, scope)), scope, part, display)
            for part, display in zip(parts or _lost(file), displays, strict=False)
        ]
        if parts:
            break
    if geometries:  # the name is that of the first part alone (gap-69)
        return [geometries[0], *(replace(geometry, name="") for geometry in geometries[1:])]
    corners = np.array(geom.vertices).reshape(-1, 3)
    mesh = Mesh(corners, np.arange(len(corners)).reshape(-1, 3))
    return [_geometry(geom, element, TriMesh(_scaled(mesh, geom, scope)), scope, MeshPart(mesh), None)]


def _lost(file: MeshFile | None) -> tuple[MeshPart, ...]:
    """Return the mesh parts that OpenRAVE creates for a missing file.

    For most absolute paths, this is a reddish part (test gap-72), else there is none (test gap-71).
    """
    if file is None or not os.path.isabs(file.name) or file.name.lower().endswith(".stl") or os.path.isfile(file.name):
        return ()
    return (_REDDISH,)


def _geometry(
    geom: _Geom,
    element: Element,
    shape: Shape,
    scope: GeometryScope,
    part: MeshPart,
    display: tuple[Surface, ...] | None,
) -> Geometry:
    pose = geom.placement.pose
    if isinstance(shape, Cylinder):
        pose = pose @ CYLINDER_TURN
    elif isinstance(shape, TriMesh):
        pose = pose._replace(position=hadamard(scope.scale, pose.position))
    return Geometry(
        shape=shape,
        T_link_geometry=pose,
        name=geom.name,
        diffuse=geom.diffuse or part.diffuse,
        ambient=geom.ambient or part.ambient,
        transparency=part.transparency if geom.transparency is None else geom.transparency,
        visible=not is_false(element.attributes.get("render", "true")),
        modifiable=not is_false(element.attributes.get("modifiable", "true")),
        display=display,
        render_file=_found(geom, geom.render, element, scope),
        collision_file=_found(geom, geom.collision, element, scope),
        source=element.source,
    )


def _surfaces(geom: _Geom, file: MeshFile | None, element: Element, scope: GeometryScope) -> tuple[Surface, ...] | None:
    """Return the display surfaces in a render file; None if the file has no parts."""
    parts = _parts(geom, file, element, scope)
    if not parts:
        return None
    return tuple(
        Surface(
            _scaled(part.mesh, geom, scope),
            geom.diffuse or part.diffuse,
            part.transparency if geom.transparency is None else geom.transparency,
        )
        for part in parts
    )


def _parts(geom: _Geom, file: MeshFile | None, element: Element, scope: GeometryScope) -> tuple[MeshPart, ...]:
    """Return the parts of a mesh file, scaled as its element says; empty if there is no file."""
    if file is None or not file.name:
        return ()
    return geom.context.mesh(file.name, element.source, *_folders(element, scope), scale=file.scale)


def _found(geom: _Geom, file: MeshFile | None, element: Element, scope: GeometryScope) -> MeshFile | None:
    """Return a mesh file with its full path; None if the file contains no mesh."""
    if file is None or not _parts(geom, file, element, scope):
        return None
    return file._replace(name=geom.context.find(file.name, element.source, *_folders(element, scope)) or file.name)


def _folders(element: Element, scope: GeometryScope) -> list[str]:
    """Return the folders to search for meshes first."""
    folder = scope.models_folder
    return [] if folder is None else [os.path.join(os.path.dirname(element.source.file), folder)]


def _scaled(mesh: Mesh, geom: _Geom, scope: GeometryScope) -> Mesh:
    """Scale a mesh by the scope's factors along the axes of the link."""
    if scope.scale == (1.0, 1.0, 1.0):
        return mesh
    R_link_geometry: Floats = np.array(rows_from_wxyz(geom.placement.pose.wxyz))
    in_geometry = R_link_geometry.T @ np.diag(scope.scale) @ R_link_geometry
    return Mesh(mesh.vertices @ in_geometry.T, mesh.triangles)


def _mesh_file(element: Element, diagnostics: Diagnostics) -> MeshFile:
    """Read ``file [sx [sy [sz]]]``: a single number scales all axes, a missing sz equals sx."""
    name = next(iter(words(element.text)), "")
    numbers = element.text[element.text.find(name) + len(name) :]
    if element.tag != "data":
        name = element.attributes.get("file", name)
        numbers = element.attributes.get("scale", numbers)
    values, rest = leading_numbers(numbers)
    if rest or len(values) > 3:
        message = f"<{element.spelled}> holds '{numbers.strip()}' where a scale of one to three numbers should stand"
        hint = "names of files cannot hold spaces"
        diagnostics.warn("bad-number" if rest else "number-count", message, element.source, hint)
    if len(values) < 2:
        uniform = values[0] if values else 1.0
        return MeshFile(name, (uniform, uniform, uniform))
    return MeshFile(name, (values[0], values[1], values[2] if len(values) > 2 else values[0]))
