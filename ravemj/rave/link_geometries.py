"""The collision geometries of a link, their groups, and bounding boxes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import AABB
from ravemj.model import scene
from ravemj.model.bounds import enclosing_box, link_bounds, links_triangles
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo
from ravemj.rave.infos.link import geometries_of
from ravemj.rave.member import Member
from ravemj.rave.trimesh import TriMesh, trimesh_of


class LinkGeometries(Member):
    """The methods of links about collision geometries, groups of geometries, and bounding boxes."""

    _internal = ("scene_with_group",)

    @property
    def _scene(self) -> scene.Link:
        try:
            return self._state.scene.links[self._index]
        except IndexError:
            raise self._gone("link") from None

    def GetGeometries(self) -> list[Geometry]:
        """Return the geometries of the link, in the order of the file.

        Example:
            >>> for geometry in robot.GetLink("Arm0").GetGeometries():
            ...     geometry.SetTransparency(0.5)
        """
        return [Geometry(self, self._state, self._index, index) for index in range(len(self._scene.geometries))]

    def GetGeometry(self, index: int) -> Geometry:
        """Return ``GetGeometries()[index]``."""
        return self.GetGeometries()[index]

    def GetCollisionData(self) -> TriMesh:
        """Return the triangles of all geometries of the link, in the link frame."""
        return trimesh_of(links_triangles([self._scene], [np.eye(4)]))

    def InitGeometries(self, geometryinfos: Sequence[GeometryInfo]) -> None:
        """Replace the geometries of the link.

        Args:
            geometryinfos: The descriptions of the new geometries.

        Raises:
            openrave_exception: a description does not make a geometry; the link stays as it is.
        """
        self._set_own_geometries(geometries_of(geometryinfos))

    def AddGeometry(self, geometryinfo: GeometryInfo, addToGroups: bool = False) -> None:
        """Add a geometry to the link.

        Args:
            geometryinfo: The description of the geometry.
            addToGroups: Whether to add it to all groups as well.

        Raises:
            openrave_exception: the description does not make a geometry, or the link has a geometry of that name; the
                link stays as it is.
        """
        added = geometries_of([geometryinfo])
        if any(one.name == added[0].name for one in self._scene.geometries if one.name):
            raise ArgumentError(f"AddGeometry: link '{self._scene.name}' has a geometry '{added[0].name}' already")
        self._set_own_geometries((*self._scene.geometries, *added))
        if addToGroups:
            self._set_groups({name: (*group, *added) for name, group in self._scene.groups})

    def RemoveGeometryByName(self, geometryname: str, removeFromAllGroups: bool = True) -> bool:
        """Remove the geometries of a name.

        Args:
            geometryname: The name.
            removeFromAllGroups: Whether to remove them from all groups as well.

        Returns:
            Whether the link had such a geometry.
        """

        def without(geometries: tuple[scene.Geometry, ...]) -> tuple[scene.Geometry, ...]:
            return tuple(one for one in geometries if one.name != geometryname)

        kept = without(self._scene.geometries)
        removed = kept != self._scene.geometries
        if removed:
            self._set_own_geometries(kept)
        if removeFromAllGroups:
            self._set_groups({name: without(group) for name, group in self._scene.groups})
        return removed

    def SetGroupGeometries(self, name: str, geometryinfos: Sequence[GeometryInfo]) -> None:
        """Store a group of geometries under a name, for ``SetGeometriesFromGroup``.

        Args:
            name: The name of the group.
            geometryinfos: The descriptions of the geometries.
        """
        self._set_groups(dict(self._scene.groups) | {str(name): geometries_of(geometryinfos)})

    def GetGroupNumGeometries(self, name: str) -> int:
        """Return the number of geometries in the group ``name``, or -1 if the link has no such group."""
        groups = self._groups
        return len(groups[name]) if name in groups else -1

    def GetGeometriesFromGroup(self, name: str) -> list[Geometry]:
        """Return the geometries of the group ``name``; ``self`` is the group of the link's own geometries.

        Raises:
            openrave_exception: there is no such group.
        """
        shapes, kept = self._group(name), dict(self._scene.groups)
        group = name if name in kept else None  # the group "self" is what the link has, until another one replaces it
        return [Geometry(self, self._state, self._index, index, group) for index in range(len(shapes))]

    GetGroupGeometries = GetGeometriesFromGroup

    def SetGeometriesFromGroup(self, name: str) -> None:
        """Replace the geometries of the link by those of a group.

        Args:
            name: The name of the group; ``self`` restores the link's own geometries.

        Raises:
            openrave_exception: there is no such group; the link stays as it is.
        """
        shapes, groups = self._group(name), self._groups
        if name == scene.OWN_SHAPES:
            del groups[scene.OWN_SHAPES]
        self._set_groups(groups)
        self._set_geometries(shapes)

    def scene_with_group(self, name: str) -> scene.Link:
        """Return the link with the geometries of a group in place of its own."""
        return replace(self._scene, geometries=self._group(name))

    @property
    def _groups(self) -> dict[str, tuple[scene.Geometry, ...]]:
        """All groups, including the link's own geometries."""
        return {scene.OWN_SHAPES: self._scene.geometries} | dict(self._scene.groups)

    def _group(self, name: str) -> tuple[scene.Geometry, ...]:
        groups = self._groups
        if name not in groups:
            known = ", ".join(groups) or "none"
            raise ArgumentError(f"link '{self._scene.name}' has no group of geometries '{name}'; it has {known}")
        return groups[name]

    def _set_groups(self, groups: dict[str, tuple[scene.Geometry, ...]]) -> None:
        with self._state.simulation.lock:
            self._state.edit_link(self._index, groups=tuple(groups.items()))

    def _set_own_geometries(self, geometries: Sequence[scene.Geometry]) -> None:
        """Replace the geometries of the link, also in the group ``self``."""
        self._set_groups({name: group for name, group in self._scene.groups if name != scene.OWN_SHAPES})
        self._set_geometries(geometries)

    def _set_geometries(self, geometries: Sequence[scene.Geometry]) -> None:
        with self._state.simulation.lock:
            self._state.set_geometries(self._index, geometries)

    def IsVisible(self) -> bool:
        """Return whether any geometry of the link is drawn."""
        return any(geometry.visible for geometry in self._scene.geometries)

    def SetVisible(self, visible: bool) -> bool:
        """Draw all geometries of the link, or none. Collision checks do not depend on it.

        Args:
            visible: Whether to draw them.

        Returns:
            Whether the visibility of any geometry has changed.
        """
        return any([geometry.SetVisible(visible) for geometry in self.GetGeometries()])

    def Enable(self, enable: bool) -> None:
        """Let the link take part in collision checks if ``enable``."""
        with self._state.simulation.lock:
            enabled = list(self._state.link_enabled)
            enabled[self._index] = bool(enable)
            self._state.link_enabled = enabled

    def IsEnabled(self) -> bool:
        """Return whether the link takes part in collision checks."""
        return self._state.link_enabled[self._index]

    def SetIgnoreSelfCollision(self, bIgnore: bool) -> None:
        """Exclude the link from ``body.CheckSelfCollision`` if ``bIgnore``, or include it again."""
        with self._state.simulation.lock:
            self._state.edit_link(self._index, self_collision_ignored=bool(bIgnore))
            self._state.simulation.collision_stamp += 1

    def IsSelfCollisionIgnored(self) -> bool:
        """Return whether ``body.CheckSelfCollision`` excludes the link."""
        return self._scene.self_collision_ignored

    def ComputeAABB(self) -> AABB:
        """Return the axis-aligned bounding box of the link's geometries in the world.

        Returns:
            The box; ``pos()`` is its centre, ``extents()`` its half extents [m]. Without geometries it is a point at
            the link's origin.
        """
        with self._state.simulation.lock:
            T_world_link = self._state.link_transform(self._index)
        return enclosing_box(link_bounds(self._scene, T_world_link), T_world_link)

    def ComputeAABBFromTransform(self, transform: ArrayLike) -> AABB:
        """Return the bounding box of ``ComputeAABB`` for another pose of the link.

        Args:
            transform: ``T_world_link``: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].
        """
        T_a_link = checked_transform(transform, "ComputeAABBFromTransform: transform")
        return enclosing_box(link_bounds(self._scene, T_a_link), T_a_link)

    def ComputeAABBForGeometryGroup(self, geomgroupname: str) -> AABB:
        """Return the box of ``ComputeAABB`` for the group ``geomgroupname``; ``self`` is the link's own geometries."""
        with self._state.simulation.lock:
            transform = self._state.link_transform(self._index)
        return self.ComputeAABBForGeometryGroupFromTransform(geomgroupname, transform)

    def ComputeAABBForGeometryGroupFromTransform(self, geomgroupname: str, transform: ArrayLike) -> AABB:
        """Return the bounding box of ``ComputeAABBForGeometryGroup`` for another pose of the link.

        Args:
            geomgroupname: The name of the group.
            transform: ``T_world_link``: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].
        """
        T_a_link = checked_transform(transform, "ComputeAABBForGeometryGroupFromTransform: transform")
        return enclosing_box(link_bounds(self.scene_with_group(geomgroupname), T_a_link), T_a_link)

    def ComputeLocalAABBForGeometryGroup(self, geomgroupname: str) -> AABB:
        """Return the bounding box of the group ``geomgroupname`` in the link frame."""
        return self.ComputeAABBForGeometryGroupFromTransform(geomgroupname, np.eye(4))

    def ComputeLocalAABB(self) -> AABB:
        """Return the axis-aligned bounding box of the link's geometries in the link frame."""
        return self.ComputeAABBFromTransform(np.eye(4))
