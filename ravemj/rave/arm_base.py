"""What the topics of an arm's API share."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ravemj.core.api_object import ApiObject
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ErrorCode, RavemjError
from ravemj.manipulation.tool import Tool
from ravemj.model import scene

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot


_GONE = 1 << 30
"""The place of a manipulator that was removed; no robot has so many."""


class ArmPart(ApiObject):
    """Part of the API of a manipulator, about one topic; ``Manipulator`` joins the parts."""

    _internal = ("description", "moved_up")

    def __init__(self, robot: "Robot", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._index = index
        self._known: Tool | None = None

    @property
    def _scene(self) -> scene.Manipulator:
        try:
            return self._state.scene.manipulators[self._index]
        except IndexError:
            message = f"'{self._robot.GetName()}' does not have this manipulator any more"
            raise RavemjError(message, ErrorCode.InvalidState) from None

    @property
    def description(self) -> scene.Manipulator:
        """What the model says of the manipulator."""
        return self._scene

    def moved_up(self, removed: int) -> None:
        """Take note that the manipulator at a place was removed, which may be this one."""
        if self._index >= removed:
            self._index = _GONE if self._index == removed else self._index - 1

    def GetName(self) -> str:
        """Return the manipulator's name."""
        return self._scene.name

    def GetTransform(self) -> Floats:
        """Return the pose of the tool in the world.

        Returns:
            ``T_world_tool``, shape (4, 4): that of the effector times the local tool transform.

        Raises:
            openrave_exception: the manipulator has no effector.
        """
        with self._state.simulation.lock:
            return self._tool().pose(self._state)

    GetEndEffectorTransform = GetGraspTransform = GetTransform

    def _tool(self) -> Tool:
        """Return the tool and the joints as arrays, which are made anew when the description is another one."""
        arm = self._scene
        if self._known is None or self._known.arm is not arm:
            self._known = Tool.of(arm)
        return self._known

    def _edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Manipulator
        with self._state.simulation.lock:
            arms = list(self._state.scene.manipulators)
            arms[self._index] = replace(self._scene, **changes)
            self._state.edit(manipulators=tuple(arms))
