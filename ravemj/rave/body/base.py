"""The base class of the topics of ``KinBody`` and ``Robot``."""

from collections.abc import Generator
from contextlib import contextmanager

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_index
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError


@contextmanager
def both_locks(one: Simulation, other: Simulation) -> Generator[None]:
    """Hold the locks of two environments. All callers take them in the same order, which prevents deadlocks."""
    first, second = sorted((one, other), key=id)
    with first.lock, second.lock:
        yield


class BodyPart(ApiObject):
    """The base class of the topics of ``KinBody`` and ``Robot``."""

    _internal = ("simulation_state",)

    _state: BodyState
    _simulation: Simulation

    def GetName(self) -> str:
        """Return the name of the body, which is unique in its environment.

        Example:
            >>> [body.GetName() for body in env.GetBodies()]
            ['Pendulum']
        """
        return self._state.scene.name

    def GetDOF(self) -> int:
        """Return the number of degrees of freedom: the axes of all joints that are not passive.

        Example:
            >>> robot.GetDOF()
            2
        """
        return self._state.dof

    @property
    def simulation_state(self) -> BodyState:
        """The state of the body below OpenRAVE's API: its scene and its kinematics."""
        return self._state

    def _checked_link(self, index: int) -> int:
        return checked_index(index, len(self._state.scene.links), "linkindex")

    def _checked_many(self, numbers: ArrayLike, name: str) -> Floats:
        """Return finite numbers as an array of shape (N, dof); an array of float64 is not copied."""
        dof = self.GetDOF()
        try:
            checked = np.asarray(numbers, dtype=np.float64)
        except (TypeError, ValueError):
            raise ArgumentError(f"{name}: should be numbers of shape (N, {dof})") from None
        if checked.ndim != 2 or checked.shape[1] != dof:
            raise ArgumentError(f"{name}: has shape {checked.shape}, and should have (N, {dof})")
        # The sum needs no memory and tells nearly always; finite numbers whose sum overflows are looked at one by one.
        if not np.isfinite(checked.sum()) and not all(np.isfinite(row).all() for row in checked):
            raise ArgumentError(f"{name}: should be finite")
        return checked
