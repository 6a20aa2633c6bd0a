"""What the topics of a body's API share."""

from collections.abc import Generator
from contextlib import contextmanager

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_index
from ravemj.engine.simulation import BodyState, Simulation


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
