"""Shapes of a link."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arrays import checked_number, checked_numbers, checked_transform
from ravemj.core.transforms import Floats, Vec3, pose_of
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import AABB
from ravemj.model import scene
from ravemj.model.bounds import geometry_bounds
from ravemj.rave.enums import GeometryType
from ravemj.rave.infos.geometry import TYPES, GeometryInfo
from ravemj.rave.trimesh import TriMesh, checked_mesh, trimesh_of


class Geometry(ApiObject):
    """A shape of a link; ``link.GetGeometries()`` returns the shapes.

    As in OpenRAVE, boxes and round shapes store their sizes in the same three numbers (half extents; radius; radius and
    height), and each size getter reads these numbers, whatever the shape. For other types, getters of sizes that the
    type lacks raise an error. Setters take effect at once, also in viewers and pictures.

    Example:
        >>> for geometry in link.GetGeometries():
        ...     geometry.SetDiffuseColor([1, 0, 0])
    """

    _often_called = ("__init__",)

    Type = GeometryType

    def __init__(self, parent: object, state: BodyState, link: int, index: int, group: str | None = None) -> None:
        self._parent = parent  # the link; only its text is wanted
        self._state = state
        self._link = link
        self._index = index
        self._group = group

    @property
    def _scene(self) -> scene.Geometry:
        try:
            link = self._state.scene.links[self._link]
            return (link.geometries if self._group is None else dict(link.groups)[self._group])[self._index]
        except LookupError:
            raise RavemjError(f"{self!r} is not there any more", ErrorCode.InvalidState) from None

    def _edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Geometry
        with self._state.simulation.lock:
            present = self._scene
            if self._group is None:
                self._state.edit_geometry(self._link, self._index, **changes)
                return
            groups = dict(self._state.scene.links[self._link].groups)
            members = list(groups[self._group])
            members[self._index] = replace(present, **changes)
            groups[self._group] = tuple(members)
            self._state.edit_link(self._link, groups=tuple(groups.items()))

    def GetName(self) -> str:
        """Return the geometry's name; often empty."""
        return self._scene.name

    def SetName(self, name: str) -> None:
        """Set the ``name``."""
        self._edit(name=str(name))

    def GetType(self) -> GeometryType:
        """Return the kind of shape."""
        return TYPES[type(self._scene.shape)]

    def GetTransform(self) -> Floats:
        """Return the pose in the link frame.

        Returns:
            ``T_link_geometry``, shape (4, 4).
        """
        return self._scene.T_link_geometry.matrix()

    def GetTransformPose(self) -> Floats:
        """Return the pose in the link frame as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def GetBoxExtents(self) -> Floats:
        """Return the half extents of a box [m], shape (3,)."""
        return np.array(self._sizes())

    def _sizes(self) -> Vec3:
        """Return OpenRAVE's three size numbers of a box or round shape; the size getters return parts of these."""
        shape = self._scene.shape
        if isinstance(shape, scene.Box):
            return shape.half_extents
        sizes = shape.sizes()
        if not sizes or any(size.type is not float for size in sizes):
            raise self._has_none("radius, height or box extents")
        x, y, z, *_ = *(getattr(shape, size.name) for size in sizes), 0.0, 0.0
        return x, y, z

    def GetSphereRadius(self) -> float:
        """Return the radius of a sphere [m]."""
        return self._sizes()[0]

    def GetCylinderRadius(self) -> float:
        """Return the radius of a cylinder [m]."""
        return self._sizes()[0]

    def GetCylinderHeight(self) -> float:
        """Return the full height of a cylinder along its z axis [m]."""
        return self._sizes()[1]

    def GetCapsuleRadius(self) -> float:
        """Return the radius of a capsule [m]."""
        return self._sizes()[0]

    def GetCapsuleHeight(self) -> float:
        """Return the height of a capsule's cylindrical part along its z axis [m]."""
        return self._sizes()[1]

    def _container(self) -> scene.Container:
        shape = self._scene.shape
        if not isinstance(shape, scene.Container):
            raise self._has_none("container sizes")
        return shape

    def GetContainerOuterExtents(self) -> Floats:
        """Return the outer edge lengths of a container [m], shape (3,).

        For boxes and round shapes, return their three size numbers, as in OpenRAVE.
        """
        shape = self._scene.shape
        return np.array(shape.outer_extents if isinstance(shape, scene.Container) else self._sizes())

    def GetContainerInnerExtents(self) -> Floats:
        """Return the edge lengths of a container's interior [m], shape (3,)."""
        return np.array(self._container().inner_extents)

    def GetContainerBottomCross(self) -> Floats:
        """Return the edge lengths of the cross on a container's bottom [m], shape (3,)."""
        return np.array(self._container().bottom_cross)

    def GetContainerBottom(self) -> Floats:
        """Return the edge lengths of the plate on a container's bottom [m], shape (3,)."""
        return np.array(self._container().bottom)

    def GetCollisionMesh(self) -> TriMesh:
        """Return the shape as triangles in the geometry frame, counter-clockwise seen from outside; a copy.

        A mesh of ``SetCollisionMesh`` takes precedence. A trimesh has the triangles of its file; round shapes have
        their vertices on the surface.
        """
        return trimesh_of(self._scene.triangulated())

    def InitCollisionMesh(self, fTessellation: float = 1.0) -> bool:
        """Reset ``GetCollisionMesh`` to the shape's own triangles; return True. ``fTessellation`` has no effect."""
        del fTessellation
        if self._scene.collision_mesh is not None:
            self._edit(collision_mesh=None)
        return True

    def SetCollisionMesh(self, mesh: TriMesh) -> None:
        """Set the triangles of ``GetCollisionMesh``. For a trimesh, they are also the shape that collides and is drawn.

        Other shapes still collide and are drawn as before, as in OpenRAVE: a box stays a box.

        Args:
            mesh: The triangles, in the geometry's frame [m].

        Raises:
            openrave_exception: the geometry is not modifiable, or a vertex index is out of range. Nothing changes then.
        """
        if not self._scene.modifiable:
            raise RavemjError(f"geometry '{self.GetName()}' is not modifiable")
        triangles = checked_mesh(mesh, "SetCollisionMesh: mesh")
        if isinstance(self._scene.shape, scene.TriMesh):
            self._edit(shape=scene.TriMesh(triangles))
        else:
            self._edit(collision_mesh=triangles)

    def ComputeAABB(self, transform: ArrayLike) -> AABB:
        """Return the axis-aligned bounding box of the geometry for a pose of its link.

        Args:
            transform: ``T_a_link``: 4x4, 3x4 or 7 numbers.

        Returns:
            The box in frame a, with methods ``pos()`` and ``extents()``.
        """
        low, high = geometry_bounds(self._scene, checked_transform(transform, "ComputeAABB: transform"))
        return AABB((low + high) / 2, (high - low) / 2)

    def GetDiffuseColor(self) -> Floats:
        """Return the colour: red, green, blue from 0 to 1, shape (3,)."""
        return np.array(self._scene.diffuse)

    def SetDiffuseColor(self, color: ArrayLike) -> None:
        """Set ``color``: red, green, blue from 0 to 1. A render file keeps its own colours."""
        self._edit(diffuse=_checked_colour(color, "SetDiffuseColor"))

    def GetAmbientColor(self) -> Floats:
        """Return the ambient colour: red, green, blue from 0 to 1, shape (3,)."""
        return np.array(self._scene.ambient)

    def SetAmbientColor(self, color: ArrayLike) -> None:
        """Set the ambient colour ``color``: red, green, blue from 0 to 1. Pictures do not use it."""
        self._edit(ambient=_checked_colour(color, "SetAmbientColor"))

    def GetTransparency(self) -> float:
        """Return the transparency: 0 is opaque, 1 invisible."""
        return self._scene.transparency

    def SetTransparency(self, transparency: float) -> None:
        """Set the transparency: 0 is opaque, 1 invisible."""
        value = checked_number(transparency, "SetTransparency: transparency")
        self._edit(transparency=value)

    def IsVisible(self) -> bool:
        """Return whether the geometry is drawn."""
        return self._scene.visible

    IsDraw = IsVisible

    def SetVisible(self, visible: bool) -> bool:
        """Draw the geometry if ``visible``; collisions do not depend on it. Return whether the visibility changed."""
        changed = self._scene.visible != bool(visible)
        if changed:
            self._edit(visible=bool(visible))
        return changed

    def SetDraw(self, draw: bool) -> None:
        """Draw the geometry if ``draw``; older name of ``SetVisible``."""
        self.SetVisible(draw)

    def IsModifiable(self) -> bool:
        """Return whether planners may change the geometry."""
        return self._scene.modifiable

    def GetRenderFilename(self) -> str:
        """Return the path of the mesh file that is drawn in place of the shape; empty without one."""
        file = self._scene.render_file
        return "" if file is None else file.name

    def GetRenderScale(self) -> Floats:
        """Return the scale factors of the render file along x, y and z, shape (3,)."""
        file = self._scene.render_file
        return np.array((1.0, 1.0, 1.0) if file is None else file.scale)

    def SetRenderFilename(self, filename: str) -> None:
        """Draw a mesh file in place of the shape.

        Args:
            filename: The file; '' draws the shape itself.

        Raises:
            SourceError: the file is missing or broken. Nothing changes then.
        """
        info = self.GetInfo()
        info.draw(filename)
        changed = info.geometry()
        self._edit(render_file=changed.render_file, display=changed.display)

    def GetInfo(self) -> GeometryInfo:
        """Return a copy of the description of the shape."""
        return GeometryInfo.of(self._scene)

    UpdateAndGetInfo = GetInfo

    def _has_none(self, what: str) -> RavemjError:
        return RavemjError(f"a geometry of type {self.GetType().name} has no {what}")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Geometry) and self._place == other._place and self._state is other._state

    def __hash__(self) -> int:
        return hash((id(self._state), *self._place))

    @property
    def _place(self) -> tuple[int, int, str | None]:
        return self._link, self._index, self._group

    def __repr__(self) -> str:
        chosen = "GetGeometries()" if self._group is None else f"GetGeometriesFromGroup({self._group!r})"
        return f"{self._parent!r}.{chosen}[{self._index}]"

    def __str__(self) -> str:
        return f"<geometry:{self.GetName()}, type={self.GetType().name}>"


def _checked_colour(color: ArrayLike, caller: str) -> scene.Rgb:
    numbers = checked_numbers(color, caller)
    if numbers.shape not in {(3,), (4,)} or not np.isfinite(numbers).all():
        raise ArgumentError(f"{caller}: color is {numbers.tolist()}, and should be three numbers from 0 to 1")
    red, green, blue = numbers.tolist()[:3]
    return (red, green, blue)
