"""Robots: bodies with manipulators and sensors."""

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.geometry_functions import DOFAffine
from ravemj.rave.body.active import ActiveChoice
from ravemj.rave.body.active_motion import ActiveMotion
from ravemj.rave.body.affine import default_kinds
from ravemj.rave.body.manipulators import Manipulators
from ravemj.rave.body.robot_building import RobotBuilding
from ravemj.rave.body.saving import Restorer, StateSaver
from ravemj.rave.enums import InterfaceType, SaveParameters
from ravemj.rave.infos import AttachedSensorInfo, ManipulatorInfo, RobotBaseInfo
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.robot_control import RobotControl
from ravemj.rave.sensors import AttachedSensor

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class Robot(  # pyright: ignore[reportIncompatibleMethodOverride]
    ActiveMotion, Manipulators, RobotBuilding, RobotControl, KinBody
):
    """A body that the file calls ``<Robot>``. ``env.GetRobots()`` makes it."""

    DOFAffine = DOFAffine
    AttachedSensorInfo = AttachedSensorInfo
    Manipulator = Manipulator
    ManipulatorInfo = ManipulatorInfo
    RobotBaseInfo = RobotBaseInfo
    RobotStateSaver = StateSaver

    _interface_type = InterfaceType.robot
    _internal = ("active_choice", "affine_kinds", "powered_sensors", "take_choices")
    default_saved = KinBody.default_saved | SaveParameters.ActiveDOF | SaveParameters.ActiveManipulator

    def __init__(self, env: "Environment", state: BodyState) -> None:
        super().__init__(env, state)
        self.active_choice = ActiveChoice()
        self.affine_kinds = default_kinds()
        self._active_manipulator = None
        self.powered_sensors: set[str] = set()

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the kind of robot."""
        return "GenericRobot"

    def Grab(  # pyright: ignore[reportIncompatibleMethodOverride] - a robot has an arm to grab with
        self,
        body: KinBody,
        grablink: "Link | Iterable[Link | int | str] | None" = None,
        linkstoignore: "Iterable[Link | int | str]" = (),
    ) -> bool:
        """Hold a body: ``Grab(body)``, ``Grab(body, grablink)``, ``Grab(body, linkstoignore)`` or with both.

        Args:
            body: What to hold. See ``KinBody.Grab``.
            grablink: The link of this robot that holds it; left out: the active manipulator's end effector.
            linkstoignore: Further links of this robot that it should not collide with.

        Returns:
            False if there is neither a link nor an active manipulator with an end effector.

        Example:
            >>> robot.Grab(mug)
            True
            >>> robot.SetDOFValues([0.3], [0])  # the mug moves along
        """
        if grablink is not None and not isinstance(grablink, Link):
            grablink, linkstoignore = None, grablink
        active = self.GetActiveManipulator()
        link = grablink or (active.GetEndEffector() if active else None)
        return False if link is None else super().Grab(body, link, linkstoignore)

    def CreateRobotStateSaver(self, options: int | None = None) -> StateSaver:
        """Return what keeps the robot's state; see ``CreateKinBodyStateSaver``.

        Args:
            options: What to save, ``SaveParameters`` combined with ``|``; None: poses, joint values, enabled links,
                active DOFs and the active manipulator.

        Example:
            >>> with robot.CreateRobotStateSaver(Robot.SaveParameters.ActiveDOF):
            ...     robot.SetActiveDOFs([0])
        """
        return StateSaver(self, options)

    def take_choices(self, other: "Robot") -> None:
        """Take over the active DOFs and the active manipulator of another robot like this."""
        self.active_choice = other.active_choice
        self.affine_kinds = {name: replace(kind) for name, kind in other.affine_kinds.items()}
        self._active_manipulator = other._active_manipulator

    def restorers(self, options: SaveParameters) -> list[Restorer]:
        """Return what gives this robot, or one like it, its present state back."""
        found = super().restorers(options)
        if options & SaveParameters.ActiveDOF:
            choice = self.active_choice
            found.append(lambda body: setattr(body, "active_choice", choice))
        if options & SaveParameters.ActiveManipulator:
            name = self._active_manipulator
            found.append(lambda body: setattr(body, "_active_manipulator", name))
        tools = self.GetManipulators() if options & SaveParameters.ManipulatorsToolTransform else []
        active = self.GetActiveManipulator()
        if options & SaveParameters.ActiveManipulatorToolTransform and active is not None:
            tools.append(active)
        for tool, transform in [(tool.GetName(), tool.GetLocalToolTransform()) for tool in tools]:
            found.append(lambda body, tool=tool, transform=transform: _set_tool(body, tool, transform))
        return found

    def active_dofs(self) -> tuple[int, ...]:
        """Return the active joints' DOFs."""
        return tuple(self.GetActiveDOFIndices().tolist())

    def moves_as_a_whole(self) -> bool:
        """Return whether active DOFs move the robot's base."""
        return bool(self.active_choice.affine)

    def GetAttachedSensors(self) -> list[AttachedSensor]:
        """Return the sensors on the robot's links, in the order of the file."""
        return [AttachedSensor(self, self._state, index) for index in range(len(self._state.scene.sensors))]

    def GetAttachedSensor(self, name: str) -> AttachedSensor | None:
        """Return the attached sensor of that name, or None."""
        return next((sensor for sensor in self.GetAttachedSensors() if sensor.GetName() == name), None)


def _set_tool(body: KinBody, name: str, transform: Floats) -> None:
    manipulator = body.GetManipulator(name) if isinstance(body, Robot) else None
    if manipulator is not None:
        manipulator.SetLocalToolTransform(transform)
