"""The description of a collision geometry."""

# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Sequence
from dataclasses import field
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers, checked_transform
from ravemj.core.transforms import Floats, Vec3
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.formats.data_folders import existing
from ravemj.geometry_functions import AABB
from ravemj.model import scene
from ravemj.model.bounds import geometry_bounds
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import GeometryType
from ravemj.rave.infos.base import info_class, json_field, pose, vector
from ravemj.rave.infos.geometry_sizes import TYPE_FORM, VECTORS, AxialSlice, GeometrySizes, SideWall
from ravemj.rave.infos.json import POSE, TEXT
from ravemj.rave.trimesh import TriMesh, checked_mesh, trimesh_of

if TYPE_CHECKING:
    from ravemj.formats.meshes import MeshPart

TYPES = {one.shape: GeometryType[one.name] for one in scene.SHAPE_TYPES}
_SHAPES = {GeometryType[one.name]: one.shape for one in scene.SHAPE_TYPES}


@info_class
class GeometryInfo(GeometrySizes):
    """The description of a collision geometry of a link.

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
    _drawn: "tuple[str | None, tuple[scene.Surface, ...] | None]" = field(
        default=(None, None), repr=False, compare=False
    )

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
        """Set the fields of the sizes: each vector of a shape fills a field, and its scalars share the first one."""
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
        """Return the shape with the sizes of the fields, in the order of ``_take``."""
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
        """Return the first numbers of ``_vGeomData``."""
        numbers = checked_numbers(self._vGeomData, "GeometryInfo._vGeomData").ravel()
        if len(numbers) < count or not np.isfinite(numbers[:count]).all():
            found = numbers.tolist()
            raise ArgumentError(f"GeometryInfo._vGeomData: is {found}, and should have {count} finite numbers")
        return numbers[:count].tolist()

    def _mesh(self) -> scene.Mesh:
        """Return the triangles of ``_meshcollision``, else those of the mesh files."""
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
        """Draw a mesh file in place of the shape; an empty name draws the shape itself."""
        self._filenamerender, self._drawn = filename or None, (None, None)

    def _display(self) -> tuple[scene.Surface, ...] | None:
        """Return the surfaces that are drawn in place of the shape, or None if the shape itself is drawn.

        They are those of the geometry that this info was made from, unless another file was set since.
        """
        name, surfaces = self._drawn
        file = _file(self._filenamerender, self._vRenderScale)
        if file is None or name == file.name:
            return surfaces if file is not None or name is None else None
        return tuple(scene.Surface(part.mesh, part.diffuse, part.transparency) for part in _parts(file))


def _four(*numbers: float) -> Floats:
    """Return the numbers as an array of four, with zeros for the rest."""
    return np.array([*numbers, 0.0, 0.0, 0.0, 0.0])[:4]


def _file(name: str | None, scale: ArrayLike) -> scene.MeshFile | None:
    return scene.MeshFile(str(name), vector(scale, "GeometryInfo: scale of a file")) if name else None


def _parts(file: scene.MeshFile) -> "tuple[MeshPart, ...]":
    """Read a mesh file."""
    from ravemj.formats.meshes import read_mesh  # noqa: PLC0415 - slow to import

    return read_mesh(existing(file.name), file.scale)
