"""Links of a body."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_number, checked_transform, checked_vector
from ravemj.core.transforms import Floats, pose_of
from ravemj.model import chains
from ravemj.model.inertia import inertial_about, principal_frame, principal_moments
from ravemj.model.scene import Inertial, Parameters
from ravemj.rave.enums import GeometryType
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo, LinkInfo
from ravemj.rave.link_geometries import LinkGeometries


class Link(LinkGeometries):
    """A link: one rigid part of a body. ``body.GetLinks()`` returns the links."""

    Geometry = Geometry
    GeometryInfo = GeometryInfo
    GeomType = GeometryType
    GeomProperties = Geometry
    LinkInfo = LinkInfo

    def GetIndex(self) -> int:
        """Return the link's position in ``body.GetLinks()``."""
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
        """Mark the link as static or not, as ``bStatic`` says. Its joints move it either way."""
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
        """Return a mass, a centre or an inertia; NaN where OpenRAVE's formulas give no number."""
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
