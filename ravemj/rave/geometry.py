"""Shapes of a link."""

import numpy as np

from ravemj import scene
from ravemj.errors import RavemjError
from ravemj.rave.enums import GeometryType
from ravemj.rave.trimesh import TriMesh, trimesh_of
from ravemj.transforms import Floats

_TYPES: dict[type[scene.Shape], GeometryType] = {
    scene.Box: GeometryType.Box,
    scene.Sphere: GeometryType.Sphere,
    scene.Cylinder: GeometryType.Cylinder,
    scene.Capsule: GeometryType.Capsule,
    scene.Container: GeometryType.Container,
    scene.Prism: GeometryType.Prism,
    scene.TriMesh: GeometryType.Trimesh,
    scene.NoShape: GeometryType.None_,
}


class Geometry:
    """A shape of a link; ``link.GetGeometries()`` makes it. What it does not have, its getters raise for."""

    def __init__(self, geometry: scene.Geometry) -> None:
        self._scene = geometry

    def GetName(self) -> str:
        """Return the geometry's name; often empty."""
        return self._scene.name

    def GetType(self) -> GeometryType:
        """Return the kind of shape."""
        return _TYPES[type(self._scene.shape)]

    def GetTransform(self) -> Floats:
        """Return the pose in the link.

        Returns:
            ``T_link_geometry``, shape (4, 4).
        """
        return self._scene.T_link_geometry.matrix()

    def GetBoxExtents(self) -> Floats:
        """Return half the edge lengths of a box [m], shape (3,)."""
        return np.array(self._box().half_extents)

    def _box(self) -> scene.Box:
        shape = self._scene.shape
        if not isinstance(shape, scene.Box):
            raise self._has_none("box extents")
        return shape

    def GetSphereRadius(self) -> float:
        """Return the radius of a sphere [m]."""
        shape = self._scene.shape
        if not isinstance(shape, scene.Sphere):
            raise self._has_none("sphere radius")
        return shape.radius

    def _round(self) -> scene.Cylinder | scene.Capsule:
        shape = self._scene.shape
        if not isinstance(shape, scene.Cylinder | scene.Capsule):
            raise self._has_none("radius and height")
        return shape

    def GetCylinderRadius(self) -> float:
        """Return the radius of a cylinder [m]."""
        return self._round().radius

    def GetCylinderHeight(self) -> float:
        """Return the full height of a cylinder along its z axis [m]."""
        return self._round().height

    def GetCapsuleRadius(self) -> float:
        """Return the radius of a capsule [m]."""
        return self._round().radius

    def GetCapsuleHeight(self) -> float:
        """Return the height of a capsule's cylindrical part along its z axis [m]."""
        return self._round().height

    def _container(self) -> scene.Container:
        shape = self._scene.shape
        if not isinstance(shape, scene.Container):
            raise self._has_none("container sizes")
        return shape

    def GetContainerOuterExtents(self) -> Floats:
        """Return the outer edge lengths of a container [m], shape (3,)."""
        return np.array(self._container().outer_extents)

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
        """Return the triangles of a trimesh, in the geometry's frame; copies."""
        shape = self._scene.shape
        if not isinstance(shape, scene.TriMesh):
            raise self._has_none("triangles")
        return trimesh_of(shape.mesh)

    def GetDiffuseColor(self) -> Floats:
        """Return the colour: red, green, blue from 0 to 1, shape (3,)."""
        return np.array(self._scene.diffuse)

    def GetAmbientColor(self) -> Floats:
        """Return the colour in the shade: red, green, blue from 0 to 1, shape (3,)."""
        return np.array(self._scene.ambient)

    def GetTransparency(self) -> float:
        """Return the transparency: 0 is opaque, 1 invisible."""
        return self._scene.transparency

    def IsVisible(self) -> bool:
        """Return whether the geometry is drawn."""
        return self._scene.visible

    def IsModifiable(self) -> bool:
        """Return whether planners may change the geometry."""
        return self._scene.modifiable

    def _has_none(self, what: str) -> RavemjError:
        return RavemjError(f"a geometry of type {self.GetType().name.rstrip('_')} has no {what}")

    def __repr__(self) -> str:
        return f"<geometry:{self.GetName()}, type={self.GetType().name.rstrip('_')}>"
