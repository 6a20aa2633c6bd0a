"""The manipulators of a robot, the active one among them, and the descriptions of its grippers."""

from typing import TYPE_CHECKING, cast

from numpy.typing import ArrayLike

from ravemj.core.arguments import also_named, checked_kind
from ravemj.errors import ArgumentError, Diagnostics, ErrorCode, RavemjError, send_warnings
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.model import hashes
from ravemj.model.manipulators import check_reach, freeze_manipulator
from ravemj.rave.arm_ik import IkBatch
from ravemj.rave.body.base import BodyPart
from ravemj.rave.infos import GripperInfo, ManipulatorInfo
from ravemj.rave.manipulator import Manipulator

if TYPE_CHECKING:
    from ravemj.rave.iksolver import IkSolver
    from ravemj.rave.robot import Robot


class Manipulators(BodyPart):
    """The manipulators of a robot. Methods without a manipulator use the active one, which at first is the first.

    Robots also store descriptions of grippers, which have no effect.
    """

    _active_manipulator: str | None
    """The name of the active manipulator; None for the first, empty for none."""
    ik_solvers: "dict[str, IkSolver]"
    """The IK solvers, by the names of their manipulators."""

    _manipulators: tuple[Manipulator, ...] = ()

    _grippers: tuple[GripperInfo, ...] = ()

    def GetManipulators(self, manipname: str | None = None) -> list[Manipulator]:
        """Return the manipulators, in the order of the file.

        Args:
            manipname: A name; the result then has only the manipulator of this name.
        """
        arms = self._state.scene.manipulators
        if len(self._manipulators) != len(arms):  # they are made once, as links are
            robot, known = cast("Robot", self), self._manipulators[: len(arms)]
            new = (Manipulator(robot, self._state, index) for index in range(len(known), len(arms)))
            self._manipulators = (*known, *new)
        if manipname is None:
            return list(self._manipulators)
        return [one for one, arm in zip(self._manipulators, arms, strict=True) if arm.name == manipname]

    def GetManipulator(self, manipname: str) -> Manipulator | None:
        """Return the manipulator of a name, or None.

        Args:
            manipname: The name.
        """
        return next(iter(self.GetManipulators(manipname)), None)

    def GetActiveManipulator(self) -> Manipulator | None:
        """Return the active manipulator, or None.

        Example:
            >>> T_world_tool = robot.GetActiveManipulator().GetTransform()
        """
        if self._active_manipulator is None and not self._state.scene.has_active_manipulator:
            return None
        return next(iter(self.GetManipulators(self._active_manipulator)), None)

    def ik(
        self,
        goals: ArrayLike,
        iktype: IkParameterizationType = IkParameterizationType.Transform6D,
        *,
        limits: bool = True,
    ) -> IkBatch:
        """Return all solutions of inverse kinematics of the active manipulator for many goals; see ``Manipulator.ik``.

        Args:
            goals: ``T_world_tool``, shape (N, 4, 4) or (4, 4); for other types the values of the goals, shape (N, k).
            iktype: The type of the goals.
            limits: Whether only solutions within the limits are valid.

        Raises:
            openrave_exception: no manipulator is active, or it has no inverse kinematics.
        """
        arm = self.GetActiveManipulator()
        if arm is None:
            raise RavemjError(f"ik: '{self.GetName()}' has no active manipulator; SetActiveManipulator chooses one")
        return arm.ik(goals, iktype, limits=limits)

    def GetRobotStructureHash(self) -> str:
        """Return a hash of the robot's structure, manipulators and sensors, 32 hexadecimal digits."""
        return hashes.of_robot(self._state.scene)

    def GetActiveManipulatorIndex(self) -> int:
        """Return the index of the active manipulator in ``GetManipulators()``; -1 without one."""
        active = self.GetActiveManipulator()
        return -1 if active is None else self.GetManipulators().index(active)

    def AddManipulator(self, manipinfo: ManipulatorInfo, removeduplicate: bool = False) -> Manipulator:
        """Add a manipulator. It becomes the active one only if the robot had none.

        Args:
            manipinfo: The description of the manipulator.
            removeduplicate: Whether it replaces a manipulator of the same name.

        Returns:
            The new manipulator.

        Raises:
            openrave_exception: the robot has a manipulator of that name, or a joint of the arm does not move the end
                effector. The robot stays as it is.

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
            self.ik_solvers.pop(made.name, None)
            self._state.edit(manipulators=(*arms[:index], made, *arms[index + 1 :]))
        send_warnings(diagnostics)
        return self.GetManipulators()[index]

    def RemoveManipulator(self, manip: Manipulator) -> bool:
        """Remove a manipulator. If it was the active one, none is active afterwards.

        Args:
            manip: The manipulator.

        Returns:
            Whether the robot had it.
        """
        arms = self.GetManipulators()
        if manip not in arms:
            return False
        with self._simulation.lock:
            name, active = manip.GetName(), self.GetActiveManipulator()
            if active is not None:
                self._active_manipulator = "" if active == manip else active.GetName()
            self.ik_solvers.pop(name, None)
            kept = tuple(arm for arm in self._state.scene.manipulators if arm.name != name)
            self._state.edit(manipulators=kept)
            place = arms.index(manip)
            self._manipulators = tuple(arm for index, arm in enumerate(arms) if index != place)
            for arm in arms:
                arm.moved_up(place)
        return True

    @also_named(manip="manipname")
    def SetActiveManipulator(self, manipname: Manipulator | str | int | None) -> Manipulator | None:
        """Choose the active manipulator. The active DOFs stay as they are.

        Args:
            manipname: The name, the manipulator, or its index in ``GetManipulators()``; '' for none.

        Returns:
            The active manipulator, or None.

        Raises:
            ArgumentError: the robot has no such manipulator. The active one stays as it was.
            openrave_exception: the name is None.

        Example:
            >>> manipulator = robot.SetActiveManipulator("arm")
            >>> robot.SetActiveDOFs(manipulator.GetArmIndices())
        """
        if manipname is None:
            raise RavemjError("SetActiveManipulator: is None, and should be a name; '' means none", ErrorCode.Assert)
        names = [one.name for one in self._state.scene.manipulators]
        name = manipname.GetName() if isinstance(manipname, Manipulator) else manipname
        if isinstance(name, int):
            name = names[name] if 0 <= name < len(names) else None if name == -1 else f"number {name}"
        foreign = isinstance(manipname, Manipulator) and manipname.GetRobot() != self
        if foreign or (name and name not in names):
            known = ", ".join(names) or "none"
            raise ArgumentError(f"SetActiveManipulator: '{self.GetName()}' has no manipulator {name}; it has {known}")
        self._active_manipulator = name or ""
        return self.GetActiveManipulator()

    def GetGripperInfos(self) -> list[GripperInfo]:
        """Return the descriptions of the grippers."""
        return list(self._grippers)

    def GetGripperInfo(self, name: str) -> GripperInfo | None:
        """Return the description of a gripper, or None.

        Args:
            name: The name of the gripper.
        """
        return next((info for info in self._grippers if info._name == name), None)  # pyright: ignore[reportPrivateUsage] - OpenRAVE's field

    def AddGripperInfo(self, gripperInfo: GripperInfo, removeduplicate: bool = False) -> bool:
        """Add the description of a gripper.

        Args:
            gripperInfo: The description.
            removeduplicate: Whether it replaces a description of the same name.

        Returns:
            True.

        Raises:
            openrave_exception: the description has no name, or that of another gripper.
        """
        name = checked_kind(gripperInfo, GripperInfo, "AddGripperInfo: gripperInfo")._name  # pyright: ignore[reportPrivateUsage] - as above
        if not name or (self.GetGripperInfo(name) is not None and not removeduplicate):
            problem = f"has a gripper '{name}' already" if name else "needs a name for the gripper"
            raise ArgumentError(f"AddGripperInfo: '{self.GetName()}' {problem}; set another _name")
        self.RemoveGripperInfo(name)
        self._grippers = (*self._grippers, gripperInfo)
        return True

    def RemoveGripperInfo(self, name: str) -> bool:
        """Remove the description of a gripper, and return whether the robot had it.

        Args:
            name: The name of the gripper.
        """
        gone = self.GetGripperInfo(name)
        self._grippers = tuple(info for info in self._grippers if info is not gone)
        return gone is not None
