"""What the topics of a body's API share."""

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
    """Hold the locks of two environments; taken in the same order by all, so that nobody waits for one another."""
    first, second = sorted((one, other), key=id)
    with first.lock, second.lock:
        yield


class BodyPart(ApiObject):
    """Part of the API of a body, about one topic; ``KinBody`` joins the parts."""

    _internal = ("simulation_state",)

    _state: BodyState
    _simulation: Simulation

    def GetName(self) -> str:
        """Return the body's name, unique in its environment.

        Example:
            >>> [body.GetName() for body in env.GetBodies()]
            ['Pendulum']
        """
        return self._state.scene.name

    def GetDOF(self) -> int:
        """Return the number of degrees of freedom: the joint axes that ``SetDOFValues`` sets.

        Passive joints are not counted.

        Example:
            >>> robot.GetDOF()
            2
        """
        return self._state.dof

    @property
    def simulation_state(self) -> BodyState:
        """The body below the OpenRAVE API: its scene and its kinematics."""
        return self._state

    def _checked_link(self, index: int) -> int:
        return checked_index(index, len(self._state.scene.links), "linkindex")

    def _checked_many(self, numbers: ArrayLike, name: str) -> Floats:
        """Return an array of shape (N, dof), which is the given one where that has numbers of the right kind."""
        dof = self.GetDOF()
        try:
            checked = np.asarray(numbers, dtype=np.float64)
        except (TypeError, ValueError):
            raise ArgumentError(f"{name}: should be numbers of shape (N, {dof})") from None
        if checked.ndim != 2 or checked.shape[1] != dof:
            raise ArgumentError(f"{name}: has shape {checked.shape}, and should have (N, {dof})")
        if not np.isfinite(checked.sum()) and not all(np.isfinite(row).all() for row in checked):
            raise ArgumentError(f"{name}: should be finite")
        return checked
