"""Links of a body."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_number, checked_transform, checked_vector
from ravemj.core.transforms import Floats, pose_of
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import AABB
from ravemj.model import chains, scene
from ravemj.model.bounds import enclosing_box, link_bounds, links_triangles
from ravemj.model.inertia import inertial_about, principal_frame, principal_moments
from ravemj.model.scene import Inertial, Parameters
from ravemj.rave.enums import GeometryType
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo, LinkInfo
from ravemj.rave.infos.link import geometries_of
from ravemj.rave.member import Member
from ravemj.rave.trimesh import TriMesh, trimesh_of


class Link(Member):
    """Rigid link of a body; ``body.GetLinks()`` returns the links."""

    _often_called = ("SetTransform",)

    _internal = ("scene_with_group",)

    Geometry = Geometry
    GeometryInfo = GeometryInfo
    GeomType = GeometryType
    GeomProperties = Geometry
    LinkInfo = LinkInfo

    def GetIndex(self) -> int:
        """Return the link's index in ``body.GetLinks()``."""
        return self._index

    def GetTransform(self) -> Floats:
        """Return the link's pose in the world.

        Returns:
            ``T_world_link``, shape (4, 4); a copy.
        """
        with self._state.simulation.lock:
            return self._state.link_transform(self._index)

    def GetVelocity(self) -> Floats:
        """Return the velocity of the link in the world.

        Returns:
            The velocity of the link's origin [m/s], then its angular velocity [rad/s], in world axes, shape (6,).
        """
        with self._state.simulation.lock:
            return self._state.link_velocities()[self._index]

    def SetVelocity(self, linear: ArrayLike, angular: ArrayLike) -> None:
        """Set the velocity of this link alone. The velocities of DOFs follow from the differences between links.

        Args:
            linear: The velocity of the link's origin in world axes [m/s], shape (3,).
            angular: The angular velocity in world axes [rad/s], shape (3,).
        """
        moved, turned = checked_vector(linear, 3, "linear"), checked_vector(angular, 3, "angular")
        with self._state.simulation.lock:
            velocities = self._state.link_velocities()
            velocities[self._index] = (*moved, *turned)
            self._state.set_link_velocities(velocities)

    def GetTransformPose(self) -> Floats:
        """Return the link's pose as [w, x, y, z, tx, ty, tz]: unit quaternion and position [m], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def SetTransform(self, transform: ArrayLike) -> None:
        """Move this link only. Its joints then have the values that fit the poses of the links.

        The next ``SetDOFValues`` moves all links back to the poses that the joint values give.

        Args:
            transform: ``T_world_link``: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].

        Raises:
            ArgumentError: the transform is not rigid; the link does not move.
        """
        checked = checked_transform(transform, "SetTransform: transform")
        with self._state.simulation.lock:
            transforms = self._state.link_transforms()
            transforms[self._index] = checked
            self._state.place_links(transforms)

    def IsStatic(self) -> bool:
        """Return whether the link is marked as static, by its file or by ``SetStatic``."""
        return self._scene.static

    def SetStatic(self, bStatic: bool) -> None:
        """Mark the link as static if ``bStatic``, else remove the mark. Joints move the link either way."""
        with self._state.simulation.lock:
            self._state.edit_link(self._index, static=bool(bStatic))

    def GetParentLinks(self) -> "list[Link]":
        """Return the parents of the link: the links that a joint connects it to, one step closer to the root."""
        return [self._other(link) for link in chains.parents(self._state.scene, self._index)]

    def IsParentLink(self, link: "Link") -> bool:
        """Return whether ``link`` is among ``GetParentLinks()``."""
        return link in self.GetParentLinks()

    def GetRigidlyAttachedLinks(self) -> "list[Link]":
        """Return this link, then all links that no joint moves relative to it."""
        return [self._other(link) for link in chains.rigidly_attached(self._state.scene, self._index)]

    def IsRigidlyAttached(self, link: "Link") -> bool:
        """Return whether ``link`` is among ``GetRigidlyAttachedLinks()``."""
        return link in self.GetRigidlyAttachedLinks()

    def _other(self, index: int) -> "Link":
        return Link(self._parent, self._state, index)

    @property
    def _inertial(self) -> Inertial:
        return self._scene.inertial

    def _answer(self, value: ArrayLike) -> Floats:
        """Return a mass, centre of mass or inertia; NaN if OpenRAVE's formulas for it are undefined."""
        return np.where(self._inertial.undefined, np.nan, value)

    def GetMass(self) -> float:
        """Return the mass of the link [kg].

        If the file gives a total mass for shapes that have no volume, mass, centre and inertia are NaN, as in OpenRAVE.
        """
        return math.nan if self._inertial.undefined else self._inertial.mass

    def GetLocalCOM(self) -> Floats:
        """Return the centre of mass in the link frame [m], shape (3,)."""
        return self._answer(self._inertial.com)

    GetCOMOffset = GetLocalCOM

    def GetGlobalCOM(self) -> Floats:
        """Return the centre of mass in the world [m], shape (3,)."""
        return self.GetTransform()[:3] @ (*self.GetLocalCOM(), 1.0)

    def GetLocalInertia(self) -> Floats:
        """Return the inertia about the centre of mass, in link axes [kg m^2], shape (3, 3)."""
        return self._answer(self._inertial.inertia)

    def GetGlobalInertia(self) -> Floats:
        """Return the inertia about the centre of mass, in world axes [kg m^2], shape (3, 3)."""
        rotation = self.GetTransform()[:3, :3]
        return rotation @ self.GetLocalInertia() @ rotation.T

    def GetLocalMassFrame(self) -> Floats:
        """Return the frame of the principal axes of inertia, at the centre of mass.

        Returns:
            ``T_link_mass``, shape (4, 4).
        """
        return principal_frame(self._inertial).matrix()

    def GetGlobalMassFrame(self) -> Floats:
        """Return the frame of the principal axes of inertia in the world.

        Returns:
            ``T_world_mass``, shape (4, 4).
        """
        return self.GetTransform() @ self.GetLocalMassFrame()

    def GetPrincipalMomentsOfInertia(self) -> Floats:
        """Return the moments of inertia about the axes of the mass frame [kg m^2], shape (3,)."""
        return principal_moments(self._inertial)

    def SetMass(self, mass: float) -> None:
        """Set the mass to ``mass`` [kg]. The moments of inertia stay as they are."""
        value = checked_number(mass, "SetMass: mass")
        self._set_inertial(replace(self._inertial, mass=value, undefined=False))

    def SetLocalMassFrame(self, massframe: ArrayLike) -> None:
        """Set the centre of mass and the principal axes of inertia. The moments about these axes stay as they are.

        Args:
            massframe: ``T_link_mass``: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].
        """
        T_link_mass = pose_of(checked_transform(massframe, "SetLocalMassFrame: massframe"))
        self._set_inertial(inertial_about(self._inertial.mass, T_link_mass, principal_moments(self._inertial)))

    def SetPrincipalMomentsOfInertia(self, inertiamoments: ArrayLike) -> None:
        """Set ``inertiamoments``, the moments of inertia about the axes of the mass frame [kg m^2], shape (3,)."""
        moments = checked_vector(inertiamoments, 3, "SetPrincipalMomentsOfInertia: inertiamoments")
        self._set_inertial(inertial_about(self._inertial.mass, principal_frame(self._inertial), moments))

    def _set_inertial(self, inertial: Inertial) -> None:
        with self._state.simulation.lock:
            self._state.edit_link(self._index, inertial=inertial)

    def SetForce(self, force: ArrayLike, pos: ArrayLike, add: bool) -> None:
        """Apply a force to the link during the next simulation step. Without physics it has no effect.

        Args:
            force: The force in world axes [N], shape (3,).
            pos: The point of application in the world [m], shape (3,).
            add: Whether to add to the forces that were set for that step; False replaces them.

        Example:
            >>> env.SetPhysicsEngine("mujoco")
            True
            >>> link.SetForce([0, 0, 20], link.GetTransform()[0:3, 3], False)
            >>> env.StepSimulation(0.01)
        """
        self._parent.GetEnv().GetPhysicsEngine().SetBodyForce(self, force, pos, add)

    def SetTorque(self, torque: ArrayLike, add: bool) -> None:
        """Apply a torque to the link during the next simulation step. Without physics it has no effect.

        Args:
            torque: The torque in world axes [N m], shape (3,).
            add: Whether to add to the torques that were set for that step; False replaces them.
        """
        self._parent.GetEnv().GetPhysicsEngine().SetBodyTorque(self, torque, add)

    def _set_parameters(self, parameters: Parameters) -> None:
        self._state.edit_link(self._index, parameters=parameters)

    def GetInfo(self) -> LinkInfo:
        """Return the description of the link in its current state."""
        with self._state.simulation.lock:
            enabled = self._state.link_enabled[self._index]
            return LinkInfo.of(self._state.scene, self._index, self.GetTransform(), enabled=enabled)

    UpdateAndGetInfo = GetInfo

    def __str__(self) -> str:
        return f"<link:{self.GetName()} ({self._index}), parent={self._parent.GetName()}>"

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
            openrave_exception: a description is invalid; the link stays as it is.
        """
        self._set_own_geometries(geometries_of(geometryinfos))

    def AddGeometry(self, geometryinfo: GeometryInfo, addToGroups: bool = False) -> None:
        """Add a geometry to the link.

        Args:
            geometryinfo: The description of the geometry.
            addToGroups: Whether to add it to all groups as well.

        Raises:
            openrave_exception: the description is invalid, or the link has a geometry of that name; the link stays as
                it is.
        """
        added = geometries_of([geometryinfo])
        if any(geometry.name == added[0].name for geometry in self._scene.geometries if geometry.name):
            raise ArgumentError(f"AddGeometry: link '{self._scene.name}' has a geometry '{added[0].name}' already")
        self._set_own_geometries((*self._scene.geometries, *added))
        if addToGroups:
            self._set_groups({name: (*group, *added) for name, group in self._scene.groups})

    def RemoveGeometryByName(self, geometryname: str, removeFromAllGroups: bool = True) -> bool:
        """Remove the geometries with a name.

        Args:
            geometryname: The name.
            removeFromAllGroups: Whether to remove them from all groups as well.

        Returns:
            Whether the link had such a geometry.
        """

        def without(geometries: tuple[scene.Geometry, ...]) -> tuple[scene.Geometry, ...]:
            return tuple(geometry for geometry in geometries if geometry.name != geometryname)

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
        """Return the link with the geometries of a group instead of its own."""
        return replace(self._scene, geometries=self._group(name))

    @property
    def _groups(self) -> dict[str, tuple[scene.Geometry, ...]]:
        """Return all geometry groups by name, including the link's own geometries."""
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
        """Include the link in collision checks if ``enable``, else exclude it."""
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
