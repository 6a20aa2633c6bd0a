"""Conversion of geoms to geometries of links."""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Pose, Vec3, rows_from_wxyz
from ravemj.engine.mjcf_reading.compiling import CompiledModel
from ravemj.engine.mjcf_reading.document import base_name
from ravemj.engine.mjcf_reading.numbers import as_written, pose, quaternion, vector
from ravemj.errors import Source
from ravemj.formats.meshes.obj import read_written
from ravemj.model.builder import LinkBuilder
from ravemj.model.scene import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Mesh,
    MeshFile,
    NoShape,
    Shape,
    Sphere,
    Surface,
    TriMesh,
)
from ravemj.model.scene.tessellation import solid_mesh

VISUAL_GROUP = "visual"
"""Group of shapes for non-colliding geoms, as in URDF."""

_GRAY = (0.5, 0.5, 0.5, 1.0)
"""MuJoCo's default colour of geoms."""

_FIRST_HIDDEN_GROUP = 3
_THICKNESS, _REACH = 0.005, 5.0
"""Half extents of the box that replaces an infinite plane [m]: along its normal, and along its sides."""

_Type = mujoco.mjtGeom

_SHAPES: dict[int, Callable[[Vec3], Shape]] = {
    _Type.mjGEOM_SPHERE: lambda size: Sphere(size[0]),
    _Type.mjGEOM_BOX: Box,
    _Type.mjGEOM_CYLINDER: lambda size: Cylinder(size[0], 2 * size[1]),
    _Type.mjGEOM_CAPSULE: lambda size: Capsule(size[0], 2 * size[1]),
    _Type.mjGEOM_ELLIPSOID: lambda size: TriMesh(_ellipsoid(size)),
    _Type.mjGEOM_PLANE: lambda size: Box((size[0] or _REACH, size[1] or _REACH, _THICKNESS)),
}


class _GeomRole(NamedTuple):
    """Properties that determine whether a geom is drawn and collides."""

    number: int
    collides: bool
    group: int
    is_seen: bool


class GeomReader:
    """Reader of one model's geoms.

    Attributes:
        colliding: Indices of the geoms that can collide.
    """

    def __init__(self, compiled: CompiledModel) -> None:
        self._compiled = compiled
        self._model = compiled.model
        self._written = {geom.id: geom for geom in compiled.spec.geoms}
        self._meshes: dict[int, tuple[Mesh, MeshFile | None]] = {}
        model = compiled.model
        masks = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
        pairs = {*model.pair_geom1.tolist(), *model.pair_geom2.tolist()}
        self.colliding = {index for index in range(model.ngeom) if masks[index] or index in pairs}

    def add(self, link: LinkBuilder, body: int) -> None:
        """Add the geoms of a body to a link. Non-colliding geoms are drawn, and form the group ``visual``."""
        first, model = int(self._model.body_geomadr[body]), self._model
        geoms = [self._geom(index) for index in range(first, first + int(model.body_geomnum[body]))]
        visual = {geom.group for geom in geoms if not geom.collides}
        shaped: list[Geometry] = []
        for geom in geoms:
            geometry = self._geometry(geom.number, link.source)
            if geometry is None:
                continue
            if geom.collides:
                is_doubled = bool(visual - {geom.group})
                link.geometries.append(replace(geometry, visible=geom.is_seen and not is_doubled))
                continue
            if geom.is_seen:
                surface = Surface(geometry.triangulated(), geometry.diffuse, geometry.transparency)
                link.geometries.append(replace(geometry, shape=NoShape(), display=(surface,)))
            shaped.append(replace(geometry, visible=geom.is_seen))
        if shaped:
            link.add_to_group(VISUAL_GROUP, shaped)

    def kind(self, index: int) -> str:
        """Return the MJCF type of a geom."""
        return _Type(int(self._model.geom_type[index])).name.removeprefix("mjGEOM_").lower()

    def mesh_name(self, index: int) -> str | None:
        """Return the name of the mesh of a geom, or None."""
        number = int(self._model.geom_dataid[index])
        return self._model.mesh(number).name if self.kind(index) == "mesh" and number >= 0 else None

    def pose_of(self, index: int) -> Pose:
        """Return the pose of a geom in its body; for a mesh, the pose of the mesh file's frame."""
        return self._shape(index)[1]

    def mesh_of_name(self, name: str) -> Mesh:
        """Return a mesh.

        Raises:
            ValueError: there is no mesh of that name.
        """
        for number in range(self._model.nmesh):
            if self._model.mesh(number).name == name:
                return self._mesh_of_number(number)[0]
        raise ValueError(f"there is no mesh '{name}'")

    def _mesh_of_number(self, number: int) -> tuple[Mesh, MeshFile | None]:
        if number not in self._meshes:
            self._meshes[number] = self._read_mesh(number, self._mesh_frame(number))
        return self._meshes[number]

    def _geom(self, index: int) -> _GeomRole:
        """Return how a geom is used. World floors are not drawn, since viewers draw their own."""
        group = int(self._model.geom_group[index])
        is_floor = self._model.geom_type[index] == _Type.mjGEOM_PLANE and self._model.geom_bodyid[index] == 0
        is_seen = group < _FIRST_HIDDEN_GROUP and self._rgba(index)[3] > 0 and not is_floor
        return _GeomRole(index, index in self.colliding, group, is_seen)

    def _geometry(self, index: int, body: Source) -> Geometry | None:
        """Return the shape of a geom; None if it has no surface."""
        shape, T_link_geometry, file = self._shape(index)
        if shape is None:
            return None
        red, green, blue, opacity = self._rgba(index)
        name = self._model.geom(index).name
        return Geometry(
            shape=shape,
            T_link_geometry=T_link_geometry,
            name=name,
            diffuse=(red, green, blue),
            ambient=(red, green, blue),
            transparency=1.0 - opacity,
            visible=True,
            collision_file=file,
            source=self._compiled.document.source(name, "geom") if name else body,
        )

    def _rgba(self, index: int) -> tuple[float, float, float, float]:
        """Return colour and opacity of a geom, rounded to the decimals in the file."""
        rgba, material = self._model.geom_rgba[index], int(self._model.geom_matid[index])
        if material >= 0 and tuple(rgba.tolist()) == _GRAY:
            rgba = self._model.mat_rgba[material]
        red, green, blue, opacity = (float(str(part)) for part in rgba)
        return red, green, blue, opacity

    def _shape(self, index: int) -> tuple[Shape | None, Pose, MeshFile | None]:
        """Return the shape of a geom (None if unsupported), its pose in the link, and its mesh file."""
        model, written = self._model, self._written[index]
        compiled = model.geom_pos[index], model.geom_quat[index]
        kind, size = int(model.geom_type[index]), vector(model.geom_size[index])
        if kind in {_Type.mjGEOM_MESH, _Type.mjGEOM_SDF}:
            return self._mesh(index, Pose(vector(compiled[0]), quaternion(compiled[1])))
        T_link_geom = pose((written.pos, written.quat), compiled)
        if kind == _Type.mjGEOM_PLANE:
            T_link_geom @= Pose((0.0, 0.0, -_THICKNESS))
        if kind == _Type.mjGEOM_HFIELD:
            return TriMesh(self._terrain(int(model.geom_dataid[index]))), T_link_geom, None
        return _SHAPES[kind](size) if kind in _SHAPES else None, T_link_geom, None

    def _mesh(self, index: int, T_link_geom: Pose) -> tuple[Shape | None, Pose, MeshFile | None]:
        """Return a mesh with its pose and file, in the file's frame, although MuJoCo has moved it to its centre."""
        number, written = int(self._model.geom_dataid[index]), self._written[index]
        if number < 0:
            return None, T_link_geom, None
        T_file_mesh = self._mesh_frame(number)
        T_link_file = T_link_geom @ T_file_mesh.inverse()
        position, wxyz = as_written(written.pos, T_link_file.position), as_written(written.quat, T_link_file.wxyz)
        mesh, file = self._mesh_of_number(number)
        return TriMesh(mesh), Pose(vector(position), quaternion(wxyz)), file

    def _mesh_frame(self, number: int) -> Pose:
        return Pose(vector(self._model.mesh_pos[number]), quaternion(self._model.mesh_quat[number]))

    def _read_mesh(self, number: int, T_file_mesh: Pose) -> tuple[Mesh, MeshFile | None]:
        """Return a mesh and its file; a file written by ravemj is read, since it has more digits than MuJoCo's mesh."""
        model, written = self._model, self._compiled.spec.meshes[number]
        path = self._compiled.document.paths.get(base_name(written.file))
        own = None if path is None else read_written(path)
        file = None if path is None else MeshFile(path, vector(written.scale))
        if own is not None:
            return own, None
        first, count = int(model.mesh_vertadr[number]), int(model.mesh_vertnum[number])
        vertices = _placed(model.mesh_vert[first : first + count].astype(np.float64), T_file_mesh)
        first, count = int(model.mesh_faceadr[number]), int(model.mesh_facenum[number])
        return Mesh(vertices, model.mesh_face[first : first + count].astype(np.int_)), file

    def _terrain(self, number: int) -> Mesh:
        """Return a height field, upper surface and base, as a triangle mesh."""
        model = self._model
        rows, columns = int(model.hfield_nrow[number]), int(model.hfield_ncol[number])
        first = int(model.hfield_adr[number])
        x, y, top, base = (float(part) for part in model.hfield_size[number])
        heights = model.hfield_data[first : first + rows * columns].astype(np.float64) * top
        xs, ys = np.meshgrid(np.linspace(-x, x, columns), np.linspace(-y, y, rows))
        upper = np.column_stack([xs.ravel(), ys.ravel(), heights])
        corners = [(-x, -y, -base), (x, -y, -base), (x, y, -base), (-x, y, -base)]
        grid = np.arange(rows * columns).reshape(rows, columns)
        a, b, c, d = grid[:-1, :-1].ravel(), grid[:-1, 1:].ravel(), grid[1:, 1:].ravel(), grid[1:, :-1].ravel()
        last = rows * columns + np.array([[0, 2, 1], [0, 3, 2]])
        triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d]), last])
        return Mesh(np.concatenate([upper, np.array(corners)]), triangles)


def _placed(points: Floats, T_a_b: Pose) -> Floats:
    return points @ np.array(rows_from_wxyz(T_a_b.wxyz)).T + T_a_b.position


def _ellipsoid(size: Vec3) -> Mesh:
    ball = solid_mesh("sphere", (1.0,))
    return Mesh(ball.vertices * size, ball.triangles)
