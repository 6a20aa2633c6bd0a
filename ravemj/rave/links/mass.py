"""Mass properties of a link."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, pose_of
from ravemj.model.inertia import inertial_about, principal_frame, principal_moments
from ravemj.model.scene import Inertial
from ravemj.rave.member import LinkPart


class LinkMass(LinkPart):
    """Mass, centre of mass and inertia. Inverse dynamics uses them as they are set."""

    @property
    def _inertial(self) -> Inertial:
        return self._scene.inertial

    def GetMass(self) -> float:
        """Return the link's mass [kg]."""
        return self._inertial.mass

    def GetLocalCOM(self) -> Floats:
        """Return the centre of mass in the link frame [m], shape (3,)."""
        return np.array(self._inertial.com)

    GetCOMOffset = GetLocalCOM

    def GetGlobalCOM(self) -> Floats:
        """Return the centre of mass in the world [m], shape (3,)."""
        return self._T_world_link()[:3] @ (*self._inertial.com, 1.0)

    def GetLocalInertia(self) -> Floats:
        """Return the inertia about the centre of mass, in axes parallel to the link's [kg m^2], shape (3, 3)."""
        return np.array(self._inertial.inertia)

    def GetGlobalInertia(self) -> Floats:
        """Return the inertia about the centre of mass, in axes parallel to the world's [kg m^2], shape (3, 3)."""
        rotation = self._T_world_link()[:3, :3]
        return rotation @ self._inertial.inertia @ rotation.T

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
        return self._T_world_link() @ self.GetLocalMassFrame()

    def GetPrincipalMomentsOfInertia(self) -> Floats:
        """Return the moments of inertia about the axes of the mass frame [kg m^2], shape (3,)."""
        return principal_moments(self._inertial)

    def SetMass(self, mass: float) -> None:
        """Set the mass; the moments of inertia stay as they are.

        Args:
            mass: Mass [kg].
        """
        (value,) = checked_vector([mass], 1, "SetMass: mass").tolist()
        self._set_inertial(replace(self._inertial, mass=value))

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

    def _T_world_link(self) -> Floats:
        with self._state.simulation.lock:
            return self._state.link_transform(self._index)
