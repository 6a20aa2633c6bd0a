"""Links of a body."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj import scene
from ravemj.arrays import checked_vector
from ravemj.rave.geometry import Geometry
from ravemj.simulation import BodyState
from ravemj.transforms import Floats

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Link:
    """A rigid part of a body; ``body.GetLinks()`` makes it."""

    def __init__(self, parent: "KinBody", state: BodyState, index: int) -> None:
        self._parent = parent
        self._state = state
        self._index = index

    @property
    def _scene(self) -> scene.Link:
        return self._state.scene.links[self._index]

    def GetName(self) -> str:
        """Return the link's name."""
        return self._scene.name

    def GetIndex(self) -> int:
        """Return the link's position in ``body.GetLinks()``."""
        return self._index

    def GetParent(self) -> "KinBody":
        """Return the body that the link belongs to."""
        return self._parent

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

    def GetMass(self) -> float:
        """Return the link's mass [kg]."""
        return self._scene.inertial.mass

    def GetLocalCOM(self) -> Floats:
        """Return the centre of mass in the link frame [m], shape (3,)."""
        return np.array(self._scene.inertial.com)

    def GetGlobalCOM(self) -> Floats:
        """Return the centre of mass in the world [m], shape (3,)."""
        return self.GetTransform()[:3] @ (*self._scene.inertial.com, 1.0)

    def GetLocalInertia(self) -> Floats:
        """Return the inertia about the centre of mass, in axes parallel to the link's [kg m^2], shape (3, 3)."""
        return np.array(self._scene.inertial.inertia)

    def IsStatic(self) -> bool:
        """Return whether the file calls the link static."""
        return self._scene.static

    def IsEnabled(self) -> bool:
        """Return whether collision checking looks at the link."""
        return self._scene.enabled

    def GetGeometries(self) -> list[Geometry]:
        """Return the link's shapes, in the order of the file."""
        return [Geometry(geometry) for geometry in self._scene.geometries]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Link) and self._state is other._state and self._index == other._index

    def __hash__(self) -> int:
        return hash((id(self._state), self._index))

    def __repr__(self) -> str:
        return f"{self._parent!r}.GetLink('{self.GetName()}')"

    def __str__(self) -> str:
        return f"<link:{self.GetName()} ({self._index}), parent={self._parent.GetName()}>"
