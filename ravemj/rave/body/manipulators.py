"""The manipulators of a robot, and which one is active."""

from typing import TYPE_CHECKING, cast

from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, Diagnostics, ErrorCode, RavemjError, send_warnings
from ravemj.model import hashes
from ravemj.model.manipulators import check_reach, freeze_manipulator
from ravemj.rave.body.base import BodyPart
from ravemj.rave.infos import ManipulatorInfo
from ravemj.rave.manipulator import Manipulator

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot


class Manipulators(BodyPart):
    """The arms of a robot. Calls that name none refer to the active one, which is the first until another is set."""

    _active_manipulator: str | None
    """Name of the active one; None: the first."""

    def GetManipulators(self, name: str | None = None) -> list[Manipulator]:
        """Return the manipulators, in the order of the file.

        Args:
            name: Return the one of that name only.
        """
        robot = cast("Robot", self)
        found = [Manipulator(robot, self._state, index) for index in range(len(self._state.scene.manipulators))]
        return found if name is None else [one for one in found if one.GetName() == name]

    def GetManipulator(self, name: str) -> Manipulator | None:
        """Return the manipulator of that name, or None."""
        return next(iter(self.GetManipulators(name)), None)

    def GetActiveManipulator(self) -> Manipulator | None:
        """Return the manipulator that calls without one refer to, or None.

        Example:
            >>> T_world_tool = robot.GetActiveManipulator().GetTransform()
        """
        if self._active_manipulator is None and not self._state.scene.has_active_manipulator:
            return None
        return next(iter(self.GetManipulators(self._active_manipulator)), None)

    def GetRobotStructureHash(self) -> str:
        """Return a text that is the same for robots of the same structure, arms and sensors: 32 hexadecimal digits."""
        return hashes.of_robot(self._state.scene)

    def GetActiveManipulatorIndex(self) -> int:
        """Return the active manipulator's place in ``GetManipulators()``; -1 without one."""
        active = self.GetActiveManipulator()
        return -1 if active is None else self.GetManipulators().index(active)

    def AddManipulator(self, manipinfo: ManipulatorInfo, removeduplicate: bool = False) -> Manipulator:
        """Add an arm; it does not become the active one, unless there was none.

        Args:
            manipinfo: Its description.
            removeduplicate: Whether it replaces one of the same name.

        Returns:
            The new manipulator.

        Raises:
            openrave_exception: there is one of that name, or a joint of the arm does not move the effector. Nothing
                has changed then.

        Example:
            >>> info = robot.GetManipulators()[0].GetInfo()
            >>> info._name = "long"
            >>> info._tLocalTool = ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, 0.3])
            >>> robot.AddManipulator(info).GetTransform()
        """
        body = self._state.scene
        diagnostics = Diagnostics()
        checked_kind(manipinfo, ManipulatorInfo, "AddManipulator: manipinfo")
        made = freeze_manipulator(manipinfo.manipulator(), body, diagnostics)
        check_reach(made, body)
        arms, names = list(body.manipulators), [arm.name for arm in body.manipulators]
        index = names.index(made.name) if made.name in names else len(names)
        if index < len(names) and not removeduplicate:
            raise ArgumentError(f"AddManipulator: '{self.GetName()}' has a manipulator '{made.name}' already")
        with self._simulation.lock:
            self._state.edit(manipulators=(*arms[:index], made, *arms[index + 1 :]))
        send_warnings(diagnostics)
        return self.GetManipulators()[index]

    def RemoveManipulator(self, manip: Manipulator) -> bool:
        """Remove an arm; the ones behind it move up. If it was the active one, none is active then.

        Args:
            manip: The arm.

        Returns:
            Whether it was there.
        """
        if manip not in self.GetManipulators():
            return False
        with self._simulation.lock:
            name, active = manip.GetName(), self.GetActiveManipulator()
            if active is not None:
                self._active_manipulator = "" if active == manip else active.GetName()
            kept = tuple(arm for arm in self._state.scene.manipulators if arm.name != name)
            self._state.edit(manipulators=kept)
        return True

    def SetActiveManipulator(self, manip: Manipulator | str | int | None) -> Manipulator | None:
        """Choose the manipulator that calls without one refer to. The active DOFs stay as they are.

        Args:
            manip: Its name, the manipulator, or its place in ``GetManipulators()``; '' or None: none.

        Returns:
            The active manipulator, or None.

        Raises:
            ArgumentError: there is no such manipulator. Nothing has changed then.

        Example:
            >>> manipulator = robot.SetActiveManipulator("arm")
            >>> robot.SetActiveDOFs(manipulator.GetArmIndices())
        """
        if manip is None:
            raise RavemjError("SetActiveManipulator: is None, and should be a name; '' means none", ErrorCode.Assert)
        names = [one.name for one in self._state.scene.manipulators]
        name = manip.GetName() if isinstance(manip, Manipulator) else manip
        if isinstance(name, int):
            name = names[name] if 0 <= name < len(names) else None if name == -1 else f"number {name}"
        foreign = isinstance(manip, Manipulator) and manip.GetRobot() != self
        if foreign or (name and name not in names):
            known = ", ".join(names) or "none"
            raise ArgumentError(f"SetActiveManipulator: '{self.GetName()}' has no manipulator {name}; it has {known}")
        self._active_manipulator = name or ""
        return self.GetActiveManipulator()
