"""Descriptions of geometries, and their JSON format."""

# JSON and users may put any value into the fields that the functions of forms get.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false
# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector
from ravemj.core.enumerations import NamedInt
from ravemj.core.transforms import Floats, Vec3
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.formats.data_folders import existing
from ravemj.geometry_functions import AABB
from ravemj.model import scene
from ravemj.model.bounds import geometry_bounds
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import GeometryType
from ravemj.rave.infos.base import (
    LENGTHS,
    POSE,
    TEXT,
    Entry,
    Form,
    IdentifiedInfo,
    Json,
    info_class,
    json_field,
    named,
    pose,
    vector,
)
from ravemj.rave.trimesh import TriMesh, checked_mesh, trimesh_of

if TYPE_CHECKING:
    from ravemj.formats.meshes import MeshPart


VECTORS = ("_vGeomData", "_vGeomData2", "_vGeomData3", "_vGeomData4")
"""Fields of ``GeometryInfo`` with the sizes of a shape: one for each vector; all scalars are in the first one."""


class SideWallType(NamedInt):
    """Side of a cage on which a wall stands: negative or positive x or y."""

    NX = 0
    PX = 1
    NY = 2
    PY = 3


@dataclass
class SideWall:
    """Wall of a cage.

    Attributes:
        transf: ``T_cage_wall``, shape (4, 4).
        vExtents: The half extents of the wall [m], shape (3,).
        type: The side of the cage.
    """

    transf: ArrayLike = ((1.0, 0, 0, 0), (0, 1.0, 0, 0), (0, 0, 1.0, 0), (0, 0, 0, 1.0))
    vExtents: ArrayLike = (0.0, 0.0, 0.0)
    type: SideWallType = SideWallType.NX


@dataclass
class AxialSlice:
    """Radius of a shape of revolution at one height.

    Attributes:
        zOffset: The height [m].
        radius: The radius [m].
    """

    zOffset: float = 0.0
    radius: float = 0.0


class GeometrySizes(IdentifiedInfo):
    """Getters and setters of a shape's sizes. As in OpenRAVE, a getter reads its field whatever the type of shape."""

    _type: GeometryType
    _t: ArrayLike
    _vGeomData: ArrayLike
    _vGeomData2: ArrayLike
    _vRenderScale: ArrayLike
    _vCollisionScale: ArrayLike

    def GetBoxHalfExtents(self) -> Floats:
        """Return the half extents of a box [m], shape (3,)."""
        return _first(self._vGeomData)

    def SetBoxHalfExtents(self, halfExtents: ArrayLike) -> None:
        """Set ``halfExtents``, the half extents of a box [m], shape (3,)."""
        self._vGeomData = checked_vector(halfExtents, 3, "SetBoxHalfExtents: halfExtents")

    def GetContainerOuterExtents(self) -> Floats:
        """Return the outer edge lengths of a container [m], shape (3,)."""
        return _first(self._vGeomData)

    def SetContainerOuterExtents(self, outerExtents: ArrayLike) -> None:
        """Set ``outerExtents``, the outer edge lengths of a container [m], shape (3,)."""
        self._vGeomData = checked_vector(outerExtents, 3, "SetContainerOuterExtents: outerExtents")

    def GetContainerInnerExtents(self) -> Floats:
        """Return the edge lengths of a container's interior [m], shape (3,)."""
        return _first(self._vGeomData2)

    def SetContainerInnerExtents(self, innerExtents: ArrayLike) -> None:
        """Set ``innerExtents``, the edge lengths of a container's interior [m], shape (3,)."""
        self._vGeomData2 = checked_vector(innerExtents, 3, "SetContainerInnerExtents: innerExtents")

    def GetCageBaseHalfExtents(self) -> Floats:
        """Return the half extents of a cage's base [m], shape (3,)."""
        return _first(self._vGeomData)

    def SetCageBaseHalfExtents(self, halfExtents: ArrayLike) -> None:
        """Set ``halfExtents``, the half extents of a cage's base [m], shape (3,)."""
        self._vGeomData = checked_vector(halfExtents, 3, "SetCageBaseHalfExtents: halfExtents")

    def GetSphereRadius(self) -> float:
        """Return the radius of a sphere [m]."""
        return float(_first(self._vGeomData)[0])

    def GetCylinderRadius(self) -> float:
        """Return the radius of a cylinder [m]."""
        return float(_first(self._vGeomData)[0])

    def GetCylinderHeight(self) -> float:
        """Return the full height of a cylinder [m]."""
        return float(_first(self._vGeomData)[1])

    def GetCapsuleRadius(self) -> float:
        """Return the radius of a capsule [m]."""
        return float(_first(self._vGeomData)[0])

    def GetCapsuleHeight(self) -> float:
        """Return the height of a capsule's cylindrical part [m]."""
        return float(_first(self._vGeomData)[1])

    def GetConicalFrustumTopRadius(self) -> float:
        """Return the radius of the upper end of a conical frustum [m]."""
        return float(_first(self._vGeomData)[0])

    def GetConicalFrustumBottomRadius(self) -> float:
        """Return the radius of the lower end of a conical frustum [m]."""
        return float(_first(self._vGeomData)[1])

    def GetConicalFrustumHeight(self) -> float:
        """Return the height of a conical frustum [m]."""
        return float(_first(self._vGeomData)[2])

    def GetPrismHeight(self) -> float:
        """Return the full height of a prism [m]."""
        return float(_first(self._vGeomData)[0])

    def ComputeInnerEmptyVolume(self) -> tuple[Floats | None, Floats | None]:
        """Return the empty box inside a container.

        Returns:
            ``T_link_box`` of the box's centre, shape (4, 4), and the half extents [m], shape (3,); None and None for
            other types of shapes.
        """
        if GeometryType(self._type) != GeometryType.Container:
            return None, None
        outer, inner = self.GetContainerOuterExtents(), self.GetContainerInnerExtents()
        T_link_box = np.array(self._t, dtype=float)
        # The origin of a container is at the centre of its bottom, and the empty box extends up to its rim.
        T_link_box[:3, 3] += T_link_box[:3, 2] * (outer[2] - inner[2] / 2)
        return T_link_box, inner / 2

    def ConvertUnitScale(self, unitScale: float) -> None:
        """Multiply all lengths by ``unitScale``."""
        self.DeserializeJSON(self.SerializeJSON(unitScale))
        self._vRenderScale = np.asarray(self._vRenderScale, dtype=float) * unitScale
        self._vCollisionScale = np.asarray(self._vCollisionScale, dtype=float) * unitScale

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        kind = GeometryType(self._type) if obj is None or "type" not in obj else TYPE_FORM.read(obj["type"], 1.0, None)
        return (*self._entries, *_SIZES_JSON.get(kind, ()))


def _first(numbers: ArrayLike) -> Floats:
    """Return the first three numbers; missing ones are 0."""
    return np.array([*np.ravel(np.asarray(numbers, dtype=float)), 0.0, 0.0, 0.0])[:3]


TYPE_FORM = named({kind: kind.name.lower() for kind in GeometryType} | {GeometryType.None_: ""})
"""JSON conversion of shape types."""

_EXTENTS = Form(
    lambda numbers, scale: (_first(numbers) * scale).tolist(),
    lambda value, scale, present: np.array([*value, 0.0], dtype=float) * scale,
)


def _number(place: int) -> Form:
    """Return the JSON conversion of one element of a vector field."""

    def read(value: float, scale: float, present: Any) -> Floats:  # noqa: ANN401 - what users put into the field
        numbers = np.array([*_first(present), 0.0])
        numbers[place] = value * scale
        return numbers

    return Form(lambda numbers, scale: float(_first(numbers)[place] * scale), read)


_MESH = Form(
    lambda mesh, scale: _mesh_json(mesh or TriMesh(), scale),
    lambda value, scale, present: TriMesh(
        np.reshape(value["vertices"], (-1, 3)) * scale, np.reshape(value["indices"], (-1, 3))
    ),
)
_CROSS_SECTION = Form(
    lambda corners, scale: (np.ravel(corners) * scale).tolist(),
    lambda value, scale, present: np.reshape(value, (-1, 2)) * scale,
)
_WALLS = Form(
    lambda walls, scale: [
        {
            "transf": POSE.write(wall.transf, scale),
            "vExtents": LENGTHS.write(wall.vExtents, scale),
            "type": SideWallType(wall.type).name.lower(),
        }
        for wall in walls
    ],
    lambda items, scale, present: [
        SideWall(
            POSE.read(item["transf"], scale, None),
            LENGTHS.read(item["vExtents"], scale, None),
            SideWallType[item["type"].upper()],
        )
        for item in items
    ],
)
_SLICES = Form(
    lambda slices, scale: [number * scale for slice_ in slices for number in (slice_.zOffset, slice_.radius)],
    lambda value, scale, present: [AxialSlice(z * scale, r * scale) for z, r in np.reshape(value, (-1, 2)).tolist()],
)


def _of_sizes(shape: type[scene.Shape]) -> Iterator[Entry]:
    """Yield the JSON keys of a shape's sizes; see ``GeometryInfo`` for the fields that store them."""
    vectors, places = iter(VECTORS), itertools.count()
    for name, kind, optional in shape.sizes():
        first, *others = name.split("_")
        key = first + "".join(map(str.title, others))
        if kind is float:
            yield Entry(key, VECTORS[0], _number(next(places)), optional)
        elif kind is scene.Mesh:
            yield Entry(key, "_meshcollision", _MESH, optional)
        elif kind == scene.CrossSection:
            yield Entry(key, "_vCrossSection", _CROSS_SECTION, optional)
        else:
            yield Entry(key, next(vectors), _EXTENTS, optional)


_SIZES_JSON = {
    GeometryType[shape_type.name]: tuple(_of_sizes(shape_type.shape)) for shape_type in scene.SHAPE_TYPES
} | {
    GeometryType.ConicalFrustum: (
        Entry("topRadius", "_vGeomData", _number(0)),
        Entry("bottomRadius", "_vGeomData", _number(1)),
        Entry("height", "_vGeomData", _number(2)),
    ),
    GeometryType.Axial: (Entry("axial", "_vAxialSlices", _SLICES),),
    GeometryType.Cage: (
        Entry("baseExtents", "_vGeomData", _EXTENTS),
        Entry("innerSizeX", "_vGeomData2", _number(0)),
        Entry("innerSizeY", "_vGeomData2", _number(1)),
        Entry("innerSizeZ", "_vGeomData2", _number(2)),
        Entry("sideWalls", "_vSideWalls", _WALLS, optional=True),
    ),
}
"""JSON keys of the sizes by geometry type. The last three types exist only in infos, not in scenes."""


def _mesh_json(mesh: TriMesh, scale: float) -> Json:
    vertices, indices = (np.zeros(0) if part is None else np.asarray(part) for part in (mesh.vertices, mesh.indices))
    return {"vertices": (vertices.ravel() * scale).tolist(), "indices": indices.ravel().astype(int).tolist()}


TYPES = {shape_type.shape: GeometryType[shape_type.name] for shape_type in scene.SHAPE_TYPES}
_SHAPES = {GeometryType[shape_type.name]: shape_type.shape for shape_type in scene.SHAPE_TYPES}


@info_class
class GeometryInfo(GeometrySizes):
    """Description of a collision geometry of a link.

    Attributes:
        _type: The type of the shape, a ``GeometryType``.
        _t: ``T_link_geometry``, shape (4, 4).
        _vGeomData: The sizes [m]: half extents of a box; radius of a sphere; radius and height along z of a cylinder or
            capsule; outer extents of a container; height of a prism.
        _vGeomData2: The inner extents of a container [m].
        _vGeomData3: The size of the cross on a container's bottom [m].
        _vGeomData4: The size of the plate on a container's bottom [m].
        _vCrossSection: The corners (x, y) of a prism [m], shape (n, 2).
        _vSideWalls: The walls of a cage, and ``_vAxialSlices`` the radii of a shape of revolution. They are stored, but
            ravemj cannot make bodies with these shapes.
        _meshcollision: The triangles of a trimesh, a ``TriMesh``. For another shape, the triangles that
            ``SetCollisionMesh`` set.
        _vDiffuseColor: The diffuse colour, red, green, blue from 0 to 1.
        _vAmbientColor: The ambient colour, likewise.
        _fTransparency: The transparency: 0 is opaque, 1 invisible.
        _bVisible: Whether the shape is drawn.
        _bModifiable: Whether planners may change the geometry.
        _name: The name, or None.
        _filenamerender: A mesh file that is drawn in place of the shape, or None.
        _filenamecollision: The mesh file of a trimesh without ``_meshcollision``, or None.
        _vRenderScale: Factors along x, y, z for the drawn mesh.
        _vCollisionScale: Factors along x, y, z for the collision mesh.

    Example:
        >>> info = ravemj.KinBody.GeometryInfo()
        >>> info._type = ravemj.GeometryType.Box
        >>> info._vGeomData = [0.1, 0.2, 0.3]
        >>> body.InitFromGeometries([info])
        True
    """

    _called = "KinBody.GeometryInfo"

    _type: GeometryType = json_field("type", TYPE_FORM, default=GeometryType.None_)
    _t: ArrayLike = json_field("transform", POSE, default=np.eye(4))
    _vGeomData: ArrayLike = json_field("", default=np.zeros(4))
    _vGeomData2: ArrayLike = json_field("", default=np.zeros(4))
    _vGeomData3: ArrayLike = json_field("", default=np.zeros(4))
    _vGeomData4: ArrayLike = json_field("", default=np.zeros(4))
    _vCrossSection: ArrayLike = json_field("", default=np.zeros((0, 2)))
    _vSideWalls: Sequence[SideWall] = json_field("", default=[])
    _vAxialSlices: Sequence[AxialSlice] = json_field("", default=[])
    _meshcollision: TriMesh | None = None
    _vDiffuseColor: ArrayLike = json_field("diffuseColor", default=np.ones(3), optional=True)
    _vAmbientColor: ArrayLike = json_field("ambientColor", default=np.zeros(3), optional=True)
    _fTransparency: float = json_field("transparency", default=0.0, optional=True)
    _bVisible: bool = json_field("visible", default=True, optional=True)
    _bModifiable: bool = json_field("modifiable", default=True, optional=True)
    _name: str | None = json_field("name", TEXT, default=None)
    _filenamerender: str | None = None
    _filenamecollision: str | None = None
    _vRenderScale: ArrayLike = json_field("", default=np.ones(3))
    _vCollisionScale: ArrayLike = json_field("", default=np.ones(3))
    _drawn: tuple[str | None, tuple[scene.Surface, ...] | None] = field(default=(None, None), repr=False, compare=False)

    @classmethod
    def of(cls, geometry: scene.Geometry) -> Self:
        """Return the description of an existing geometry."""
        render, collision = geometry.render_file, geometry.collision_file
        info = cls(
            _type=TYPES[type(geometry.shape)],
            _t=geometry.T_link_geometry.matrix(),
            _vDiffuseColor=np.array(geometry.diffuse),
            _vAmbientColor=np.array(geometry.ambient),
            _fTransparency=geometry.transparency,
            _bVisible=geometry.visible,
            _bModifiable=geometry.modifiable,
            _name=geometry.name,
            _filenamerender=render.name if render else None,
            _filenamecollision=collision.name if collision else None,
            _vRenderScale=np.array(render.scale if render else (1.0, 1.0, 1.0)),
            _vCollisionScale=np.array(collision.scale if collision else (1.0, 1.0, 1.0)),
            _meshcollision=None if geometry.collision_mesh is None else trimesh_of(geometry.collision_mesh),
            _drawn=(render.name if render else None, geometry.display),
        )
        info._take(geometry.shape)
        return info

    def _take(self, shape: scene.Shape) -> None:
        """Set the size fields from a shape: one for each vector size; all scalar sizes are in ``_vGeomData``."""
        vectors, numbers = iter(VECTORS), list[float]()
        for size in shape.sizes():
            value = getattr(shape, size.name)
            if size.type is scene.Mesh:
                self._meshcollision = trimesh_of(value)
            elif size.type == scene.CrossSection:
                self._vCrossSection = np.array(value).reshape(-1, 2)
            elif size.type is float:
                numbers.append(value)
            else:
                setattr(self, next(vectors), _four(*value))
        if numbers:
            self._vGeomData = _four(*numbers)

    def geometry(self, *, visible: bool = True) -> scene.Geometry:
        """Make the geometry that the fields describe.

        Args:
            visible: False hides the geometry, whatever its field says.

        Raises:
            RavemjError: a field has wrong numbers, a mesh file cannot be read, or ravemj lacks the type of shape.
        """
        shape = self._shape()
        own_mesh = None if isinstance(shape, scene.TriMesh) else self._meshcollision
        return scene.Geometry(
            shape=shape,
            T_link_geometry=pose(self._t, "GeometryInfo._t"),
            name=self._name or "",
            diffuse=vector(self._vDiffuseColor, "GeometryInfo._vDiffuseColor"),
            ambient=vector(self._vAmbientColor, "GeometryInfo._vAmbientColor"),
            transparency=float(self._fTransparency),
            visible=visible and bool(self._bVisible),
            modifiable=bool(self._bModifiable),
            display=self._display(),
            render_file=_file(self._filenamerender, self._vRenderScale),
            collision_file=_file(self._filenamecollision, self._vCollisionScale),
            collision_mesh=None if own_mesh is None else checked_mesh(own_mesh, "GeometryInfo._meshcollision"),
            source=FROM_SCRIPT,
        )

    def _shape(self) -> scene.Shape:
        """Return the shape described by the size fields, which ``_take`` fills."""
        kind = _SHAPES.get(GeometryType(self._type))
        if kind is None:
            message = f"GeometryInfo: a shape of type {GeometryType(self._type).name} cannot be made here"
            raise RavemjError(message, ErrorCode.NotImplemented)
        sizes, vectors = dict[str, object](), iter(VECTORS)
        for name, form, _ in kind.sizes():
            if form is scene.Mesh:
                sizes[name] = self._mesh()
            elif form == scene.CrossSection:
                corners = checked_numbers(self._vCrossSection, "GeometryInfo._vCrossSection").reshape(-1, 2)
                sizes[name] = tuple((x, y) for x, y in corners.tolist())
            elif form == Vec3:
                sizes[name] = vector(getattr(self, next(vectors)), "GeometryInfo._vGeomData")
        names = [size.name for size in kind.sizes() if size.type is float]
        if names:
            sizes.update(zip(names, self._numbers(len(names)), strict=True))
        return kind.of_sizes(sizes)

    def _numbers(self, count: int) -> list[float]:
        numbers = checked_numbers(self._vGeomData, "GeometryInfo._vGeomData").ravel()
        if len(numbers) < count or not np.isfinite(numbers[:count]).all():
            given = numbers.tolist()
            raise ArgumentError(f"GeometryInfo._vGeomData: is {given}, and should have {count} finite numbers")
        return numbers[:count].tolist()

    def _mesh(self) -> scene.Mesh:
        """Return the mesh ``_meshcollision``; if that is None, the collision file's, else the render file's mesh."""
        if self._meshcollision is not None:
            return checked_mesh(self._meshcollision, "GeometryInfo._meshcollision")
        collision = _file(self._filenamecollision, self._vCollisionScale)
        file = collision or _file(self._filenamerender, self._vRenderScale)
        return scene.Mesh.merged(part.mesh for part in _parts(file)) if file else scene.Mesh.merged([])

    def ComputeAABB(self, transform: ArrayLike) -> AABB:
        """Return the axis-aligned bounding box of the shape, for a pose of its link.

        Args:
            transform: ``T_a_link``, the pose of the link in the frame of the box: 4x4, 3x4 or
                [w, x, y, z, tx, ty, tz].
        """
        low, high = geometry_bounds(self.geometry(), checked_transform(transform, "ComputeAABB: transform"))
        return AABB((low + high) / 2, (high - low) / 2)

    def GetCollisionMesh(self) -> TriMesh:
        """Return the shape as triangles, in its own frame."""
        return trimesh_of(self.geometry().triangulated())

    def draw(self, filename: str) -> None:
        """Set a mesh file to draw instead of the shape; an empty name draws the shape itself."""
        self._filenamerender, self._drawn = filename or None, (None, None)

    def _display(self) -> tuple[scene.Surface, ...] | None:
        """Return the surfaces drawn instead of the shape; None if the shape itself is drawn.

        They are those of the geometry that this info was made from, unless the render file has been changed.
        """
        name, surfaces = self._drawn
        file = _file(self._filenamerender, self._vRenderScale)
        if file is None or name == file.name:
            return surfaces if file is not None or name is None else None
        return tuple(scene.Surface(part.mesh, part.diffuse, part.transparency) for part in _parts(file))


def _four(*numbers: float) -> Floats:
    return np.array([*numbers, 0.0, 0.0, 0.0, 0.0])[:4]


def _file(name: str | None, scale: ArrayLike) -> scene.MeshFile | None:
    return scene.MeshFile(str(name), vector(scale, "GeometryInfo: scale of a file")) if name else None


def _parts(file: scene.MeshFile) -> "tuple[MeshPart, ...]":
    from ravemj.formats.meshes import read_mesh  # noqa: PLC0415 - slow to import

    return read_mesh(existing(file.name), file.scale)
