"""Links of a body."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, pose_of
from ravemj.model import chains
from ravemj.model.inertia import inertial_about, principal_frame, principal_moments
from ravemj.model.scene import Inertial, Parameters
from ravemj.rave.enums import GeometryType
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo, LinkInfo
from ravemj.rave.link_geometries import LinkGeometries


class Link(LinkGeometries):
    """A rigid part of a body; ``body.GetLinks()`` makes it."""

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
        """Return the link's velocity, in world axes.

        Returns:
            That of its origin [m/s] and the angular one [rad/s], shape (6,); a copy.
        """
        with self._state.simulation.lock:
            return self._state.link_velocities()[self._index]

    def SetVelocity(self, linear: ArrayLike, angular: ArrayLike) -> None:
        """Set the velocity of this link alone; those of the DOFs are read off the differences between links.

        Args:
            linear: Velocity of its origin in the world [m/s], shape (3,).
            angular: Angular velocity in the world [rad/s], shape (3,).
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
        """Move this link only; the joints at it get the values that the poses of the links show.

        The next ``SetDOFValues`` puts all links where the joint values say.

        Args:
            transform: ``T_world_link``: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].

        Raises:
            ArgumentError: this is no rigid transform. Nothing has moved then.
        """
        checked = checked_transform(transform, "SetTransform: transform")
        with self._state.simulation.lock:
            transforms = self._state.link_transforms()
            transforms[self._index] = checked
            self._state.place_links(transforms)

    def IsStatic(self) -> bool:
        """Return whether the link is declared static, by its file or by ``SetStatic``."""
        return self._scene.static

    def SetStatic(self, bStatic: bool) -> None:
        """Declare the link static or not; its joints move it all the same.

        Args:
            bStatic: Whether it is static.
        """
        with self._state.simulation.lock:
            self._state.edit_link(self._index, static=bool(bStatic))

    def GetParentLinks(self) -> "list[Link]":
        """Return the links that joints hang this one on."""
        return [self._other(link) for link in chains.parents(self._state.scene, self._index)]

    def IsParentLink(self, link: "Link") -> bool:
        """Return whether a joint hangs this link on another one.

        Args:
            link: The other link.
        """
        return link in self.GetParentLinks()

    def GetRigidlyAttachedLinks(self) -> "list[Link]":
        """Return the links that never move against this one; this one is the first."""
        return [self._other(link) for link in chains.rigidly_attached(self._state.scene, self._index)]

    def IsRigidlyAttached(self, link: "Link") -> bool:
        """Return whether another link never moves against this one.

        Args:
            link: The other link.
        """
        return link in self.GetRigidlyAttachedLinks()

    def _other(self, index: int) -> "Link":
        return Link(self._parent, self._state, index)

    @property
    def _inertial(self) -> Inertial:
        return self._scene.inertial

    def _answer(self, value: ArrayLike) -> Floats:
        """Return mass, centre or inertia; NaN where OpenRAVE finds no number."""
        return np.where(self._inertial.undefined, np.nan, value)

    def GetMass(self) -> float:
        """Return the link's mass [kg]; NaN, as its centre and inertia, for a total over shapes without a volume."""
        return math.nan if self._inertial.undefined else self._inertial.mass

    def GetLocalCOM(self) -> Floats:
        """Return the centre of mass in the link frame [m], shape (3,)."""
        return self._answer(self._inertial.com)

    GetCOMOffset = GetLocalCOM

    def GetGlobalCOM(self) -> Floats:
        """Return the centre of mass in the world [m], shape (3,)."""
        return self.GetTransform()[:3] @ (*self.GetLocalCOM(), 1.0)

    def GetLocalInertia(self) -> Floats:
        """Return the inertia about the centre of mass, in axes parallel to the link's [kg m^2], shape (3, 3)."""
        return self._answer(self._inertial.inertia)

    def GetGlobalInertia(self) -> Floats:
        """Return the inertia about the centre of mass, in axes parallel to the world's [kg m^2], shape (3, 3)."""
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
        """Set the mass; the moments of inertia stay as they are.

        Args:
            mass: Mass [kg].
        """
        (value,) = checked_vector([mass], 1, "SetMass: mass").tolist()
        self._set_inertial(replace(self._inertial, mass=value, undefined=False))

    def SetLocalMassFrame(self, massframe: ArrayLike) -> None:
        """Set where the centre of mass is, and how the principal axes lie; the moments about these stay.

        Args:
            massframe: ``T_link_mass``: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].
        """
        T_link_mass = pose_of(checked_transform(massframe, "SetLocalMassFrame: massframe"))
        self._set_inertial(inertial_about(self._inertial.mass, T_link_mass, principal_moments(self._inertial)))

    def SetPrincipalMomentsOfInertia(self, inertiamoments: ArrayLike) -> None:
        """Set the moments of inertia about the axes of the mass frame.

        Args:
            inertiamoments: Moments [kg m^2], shape (3,).
        """
        moments = checked_vector(inertiamoments, 3, "SetPrincipalMomentsOfInertia: inertiamoments")
        self._set_inertial(inertial_about(self._inertial.mass, principal_frame(self._inertial), moments))

    def _set_inertial(self, inertial: Inertial) -> None:
        with self._state.simulation.lock:
            self._state.set_inertial(self._index, inertial)

    def SetForce(self, force: ArrayLike, pos: ArrayLike, add: bool) -> None:
        """Let a force act on the link during the next step of simulation time; without physics it does nothing.

        Args:
            force: In the world [N], shape (3,).
            pos: Where it acts, in the world [m], shape (3,).
            add: Whether forces that were set for that step stay.

        Example:
            >>> env.SetPhysicsEngine("mujoco")
            True
            >>> link.SetForce([0, 0, 20], link.GetTransform()[0:3, 3], False)
            >>> env.StepSimulation(0.01)
        """
        self._parent.GetEnv().GetPhysicsEngine().SetBodyForce(self, force, pos, add)

    def SetTorque(self, torque: ArrayLike, add: bool) -> None:
        """Let a torque act on the link during the next step of simulation time; without physics it does nothing.

        Args:
            torque: In world axes [N m], shape (3,).
            add: Whether torques that were set for that step stay.
        """
        self._parent.GetEnv().GetPhysicsEngine().SetBodyTorque(self, torque, add)

    def _set_parameters(self, parameters: Parameters) -> None:
        self._state.edit_link(self._index, parameters=parameters)

    def GetInfo(self) -> LinkInfo:
        """Return the description of the link as it stands, a copy."""
        with self._state.simulation.lock:
            enabled = self._state.link_enabled[self._index]
            return LinkInfo.of(self._state.scene, self._index, self.GetTransform(), enabled=enabled)

    UpdateAndGetInfo = GetInfo

    def __str__(self) -> str:
        return f"<link:{self.GetName()} ({self._index}), parent={self._parent.GetName()}>"
