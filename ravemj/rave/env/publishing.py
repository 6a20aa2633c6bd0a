"""The published state of bodies: what those see who do not take the lock."""

from typing import Any

from ravemj.rave.env.simulation import Simulating
from ravemj.rave.kinbody import KinBody
from ravemj.rave.robot import Robot

State = dict[str, Any]


class Publishing(Simulating):
    """Copies of poses and joint values, made by ``UpdatePublishedBodies`` and, always while time runs."""

    def __init__(self) -> None:
        super().__init__()
        self._published: list[State] = []

    def UpdatePublishedBodies(self, timeout: float = 0.0) -> None:
        """Publish the state of the bodies for ``GetPublishedBodies``. Viewers show every change at once anyway.

        Args:
            timeout: Without meaning.
        """
        del timeout
        with self._simulation.lock:
            self._published = [_state(self.wrap(state)) for state in self._simulation.bodies]

    def GetPublishedBodies(self, timeout: float = 0.0) -> list[State]:
        """Return the published state of all bodies.

        While time runs by itself (see ``StopSimulation``), it is the present one; else that of the last
        ``UpdatePublishedBodies``.

        Args:
            timeout: Without meaning.

        Returns:
            For each body a dict: ``body``, ``name``, ``uri``, ``environmentid``, ``updatestamp``, ``jointvalues``
            [rad or m], and ``linktransforms``, a list of ``T_world_link``; of a robot also ``activeManipulatorName``
            and ``activeManipulatorTransform``.
        """
        del timeout
        if self._clock.is_allowed:  # OpenRAVE's thread publishes at each of its steps
            self.UpdatePublishedBodies()
        return [dict(state) for state in self._published]

    def GetPublishedBody(self, name: str, timeout: float = 0.0) -> State | None:
        """Return the published state of one body, as in ``GetPublishedBodies``, or None.

        Args:
            name: Its name.
            timeout: Without meaning.
        """
        return next((state for state in self.GetPublishedBodies(timeout) if state["name"] == name), None)

    def GetPublishedBodyJointValues(self, name: str, timeout: float = 0.0) -> Any:  # noqa: ANN401 - an array or None
        """Return the published joint values of one body [rad or m], shape (dof,), or None.

        Args:
            name: Its name.
            timeout: Without meaning.
        """
        state = self.GetPublishedBody(name, timeout)
        return None if state is None else state["jointvalues"]

    def GetPublishedBodyTransformsMatchingPrefix(self, prefix: str, timeout: float = 0.0) -> dict[str, Any]:
        """Return the published ``T_world_body`` of the bodies whose names start with a text, by their names.

        Args:
            prefix: The text.
            timeout: Without meaning.
        """
        states = (state for state in self.GetPublishedBodies(timeout) if state["name"].startswith(prefix))
        return {state["name"]: state["linktransforms"][0] for state in states if state["linktransforms"]}


def _state(body: KinBody) -> State:
    state: State = {
        "body": body,
        "name": body.GetName(),
        "uri": body.GetURI(),
        "environmentid": body.GetEnvironmentBodyIndex(),
        "updatestamp": body.GetUpdateStamp(),
        "jointvalues": body.GetDOFValues(),
        "linktransforms": body.GetLinkTransformations(),
    }
    arm = body.GetActiveManipulator() if isinstance(body, Robot) else None
    if arm is not None and arm.GetEndEffector() is not None:
        state |= {"activeManipulatorName": arm.GetName(), "activeManipulatorTransform": arm.GetTransform()}
    return state
