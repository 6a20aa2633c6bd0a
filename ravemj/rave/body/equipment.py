"""The manipulators, grippers and sensors of a robot, and the bodies that can be connected to it."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

from numpy.typing import ArrayLike

from ravemj.core.arguments import also_named, checked_kind
from ravemj.errors import ArgumentError, Diagnostics, ErrorCode, RavemjError, send_warnings
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.model import scene
from ravemj.model.manipulators import check_reach, freeze_manipulator
from ravemj.rave.arm_ik import IkBatch
from ravemj.rave.attached_sensor import AttachedSensor
from ravemj.rave.body.structure import Structure
from ravemj.rave.connected_body import ConnectedBodies, ConnectedBody
from ravemj.rave.devices import Devices
from ravemj.rave.infos import AttachedSensorInfo, ConnectedBodyInfo, GripperInfo, ManipulatorInfo
from ravemj.rave.manipulator import Manipulator

if TYPE_CHECKING:
    from ravemj.rave.iksolver import IkSolver
    from ravemj.rave.robot import Robot


class Equipment(Structure):
    """The manipulators, grippers and sensors of a robot, and the bodies that can be connected to it.

    Methods without a manipulator use the active one, which at first is the first. Descriptions of grippers have no
    effect. Connected bodies are parts of the robot while they are active and it is in an environment.
    """

    devices: Devices
    """The sensors that were used; others are not made."""
    connected: ConnectedBodies
    ik_solvers: "dict[str, IkSolver]"
    """The IK solvers, by the names of their manipulators."""
    _active_manipulator: str | None
    """The name of the active manipulator; None for the first, empty for none."""
    _manipulators: tuple[Manipulator, ...] = ()
    _grippers: tuple[GripperInfo, ...] = ()

    @property
    def _robot(self) -> "Robot":
        return cast("Robot", self)

    def GetManipulators(self, manipname: str | None = None) -> list[Manipulator]:
        """Return the manipulators, in the order of the file, or only the one called ``manipname``."""
        arms = self._state.scene.manipulators
        if len(self._manipulators) != len(arms):  # they are made once, as links are
            known = self._manipulators[: len(arms)]
            new = (Manipulator(self._robot, self._state, index) for index in range(len(known), len(arms)))
            self._manipulators = (*known, *new)
        if manipname is None:
            return list(self._manipulators)
        return [one for one, arm in zip(self._manipulators, arms, strict=True) if arm.name == manipname]

    def GetManipulator(self, manipname: str) -> Manipulator | None:
        """Return the manipulator called ``manipname``, or None."""
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
        index = self._place(made.name, body.manipulators, removeduplicate, "AddManipulator")
        with self._simulation.lock:
            self.ik_solvers.pop(made.name, None)
            self._state.edit(manipulators=(*body.manipulators[:index], made, *body.manipulators[index + 1 :]))
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
        """Return the description of the gripper called ``name``, or None."""
        return next((info for info in self._grippers if info._name == name), None)

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
        name = checked_kind(gripperInfo, GripperInfo, "AddGripperInfo: gripperInfo")._name
        if not name or (self.GetGripperInfo(name) is not None and not removeduplicate):
            problem = f"has a gripper '{name}' already" if name else "needs a name for the gripper"
            raise ArgumentError(f"AddGripperInfo: '{self.GetName()}' {problem}; set another _name")
        self.RemoveGripperInfo(name)
        self._grippers = (*self._grippers, gripperInfo)
        return True

    def RemoveGripperInfo(self, name: str) -> bool:
        """Remove the description of the gripper called ``name``, and return whether the robot had it."""
        gone = self.GetGripperInfo(name)
        self._grippers = tuple(info for info in self._grippers if info is not gone)
        return gone is not None

    def GetAttachedSensors(self) -> list[AttachedSensor]:
        """Return the sensors on the robot's links, in the order of the file."""
        return [AttachedSensor(self._robot, self._state, index) for index in range(len(self._state.scene.sensors))]

    def GetAttachedSensor(self, sensorname: str) -> AttachedSensor | None:
        """Return the attached sensor called ``sensorname``, or None."""
        return next((sensor for sensor in self.GetAttachedSensors() if sensor.GetName() == sensorname), None)

    GetSensors = GetAttachedSensors
    GetSensor = GetAttachedSensor

    def AddAttachedSensor(
        self, attachedsensorinfo: AttachedSensorInfo, removeduplicate: bool = False
    ) -> AttachedSensor:
        """Attach a sensor to a link.

        Args:
            attachedsensorinfo: The description of the sensor.
            removeduplicate: Whether it replaces one of the same name.

        Returns:
            The new attached sensor.

        Raises:
            openrave_exception: the robot has a sensor of that name, or no such link, or the sensor cannot measure with
                these properties. The robot stays as it is.
        """
        body = self._state.scene
        info = checked_kind(attachedsensorinfo, AttachedSensorInfo, "AddAttachedSensor: attachedsensorinfo")
        made = info.sensor([link.name for link in body.links])
        if made.link is None:
            known = ", ".join(link.name for link in body.links)
            message = f"'{body.name}' has no link '{info._linkname}'; it has {known}"
            raise ArgumentError(f"AddAttachedSensor: {message}")
        index = self._place(made.name, body.sensors, removeduplicate, "AddAttachedSensor")
        problem = made.problem()
        if problem is not None:
            raise ArgumentError(f"AddAttachedSensor: '{made.name}' cannot measure: {problem}")
        with self._simulation.lock:
            self.devices.forget(made.name)
            self._state.edit(sensors=(*body.sensors[:index], made, *body.sensors[index + 1 :]))
        return self.GetAttachedSensors()[index]

    def RemoveAttachedSensor(self, attsensor: AttachedSensor) -> bool:
        """Remove a sensor from the robot.

        Args:
            attsensor: The attached sensor.

        Returns:
            Whether the robot had it.
        """
        if attsensor not in self.GetAttachedSensors():
            return False
        with self._simulation.lock:
            name = attsensor.GetName()
            self.devices.forget(name)
            self._state.edit(sensors=tuple(one for one in self._state.scene.sensors if one.name != name))
        return True

    def GetConnectedBodies(self) -> list[ConnectedBody]:
        """Return the bodies that can be connected, active or not."""
        return list(self.connected.bodies)

    def GetConnectedBody(self, bodyname: str) -> ConnectedBody | None:
        """Return the connected body called ``bodyname``, or None."""
        return next((body for body in self.connected.bodies if body.GetName() == bodyname), None)

    def GetConnectedBodyActiveStates(self) -> list[int]:
        """Return for each connected body whether it is active: 1, or 0 for no, -1 for undecided."""
        return [body.IsActive() for body in self.connected.bodies]

    def SetConnectedBodyActiveStates(self, activestates: Sequence[int]) -> None:
        """Set for each connected body whether it is active; see ``ConnectedBody.SetActive``.

        Args:
            activestates: As many states as there are connected bodies.
        """
        bodies = self.connected.bodies
        if len(activestates) != len(bodies):
            raise ArgumentError(f"SetConnectedBodyActiveStates: {len(activestates)} states for {len(bodies)} bodies")
        for body, active in zip(bodies, activestates, strict=True):
            body.SetActive(active)

    def AddConnectedBody(self, connectedbodyinfo: ConnectedBodyInfo, removeduplicate: bool = False) -> ConnectedBody:
        """Add a body that can be connected. If it is active, the next ``env.Add`` makes it a part of the robot.

        Args:
            connectedbodyinfo: The description of the body.
            removeduplicate: Whether it replaces one of the same name.

        Returns:
            The body.

        Raises:
            openrave_exception: the robot is in an environment (``InvalidState``); or the description has no name, has
                the name of another connected body, or names no link of the robot.

        Example:
            >>> env.Remove(robot)
            True
            >>> tool = robot.AddConnectedBody(info)
            >>> tool.SetActive(True)
            True
            >>> env.Add(robot)
        """
        info = checked_kind(connectedbodyinfo, ConnectedBodyInfo, "AddConnectedBody: connectedbodyinfo")
        return self.connected.add(info, removeduplicate)

    def RemoveConnectedBody(self, connectedbody: ConnectedBody) -> bool:
        """Remove ``connectedbody``, and return whether it was one of the bodies that can be connected.

        Raises:
            openrave_exception: the robot is in an environment (``InvalidState``).
        """
        return self.connected.remove(connectedbody)

    def connect(self) -> None:
        """Make the active connected bodies parts of the robot. The environment calls this before it adds the robot."""
        self.connected.connect()

    def disconnect(self) -> None:
        """Remove the parts of connected bodies. The environment calls this after it has removed the robot."""
        self.connected.disconnect()

    def _place(
        self, name: str, parts: Sequence[scene.Manipulator | scene.AttachedSensor], replaces: bool, caller: str
    ) -> int:
        """Return the place of a new part: that of the one of its name, or behind all.

        Raises:
            ArgumentError: there is one of that name, and the new one does not replace it.
        """
        index = next((index for index, part in enumerate(parts) if part.name == name), len(parts))
        if index < len(parts) and not replaces:
            raise ArgumentError(f"{caller}: '{self.GetName()}' already has one called '{name}'")
        return index
