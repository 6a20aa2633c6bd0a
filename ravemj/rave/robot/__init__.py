"""Robots: bodies with manipulators and sensors."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Iterable, Sequence
from dataclasses import replace
from types import EllipsisType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_indices, checked_number, checked_vector
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.engine.snapshot import snapshot
from ravemj.errors import ArgumentError, Diagnostic, Diagnostics, ErrorCode, RavemjError, send_warning, send_warnings
from ravemj.geometry_functions import DOFAffine
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.model import hashes, scene
from ravemj.model.gains import Gains
from ravemj.model.manipulators import check_reach, freeze_manipulator
from ravemj.model.mimic import Equations
from ravemj.rave.controllers import Controller, IdealController, wait_until
from ravemj.rave.enums import InterfaceType, SaveParameters
from ravemj.rave.iksolver import IkSolver
from ravemj.rave.infos import (
    AttachedSensorInfo,
    ConnectedBodyInfo,
    ExtractInfoOptions,
    GripperInfo,
    JointInfo,
    KinBodyInfo,
    LinkInfo,
    ManipulatorInfo,
    RobotBaseInfo,
)
from ravemj.rave.kinbody import KinBody
from ravemj.rave.kinbody.state_saver import Restorer, StateSaver
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.manipulator.arm_ik import IkBatch
from ravemj.rave.robot.active import ActiveChoice, ActiveDofs, default_kinds
from ravemj.rave.robot.equipment import AttachedSensor, ConnectedBodies, ConnectedBody, Devices
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.joint_trajectory import JointTrajectory
from ravemj.trajectories.motion import Motion

if TYPE_CHECKING:
    from ravemj.ik.arms import ArmSolver
    from ravemj.rave.environment import Environment
    from ravemj.rave.report import CollisionReport


_ACTIVE_DOF, _ACTIVE_MANIPULATOR = int(SaveParameters.ActiveDOF), int(SaveParameters.ActiveManipulator)
_TOOLS, _ACTIVE_TOOL = int(SaveParameters.ManipulatorsToolTransform), int(SaveParameters.ActiveManipulatorToolTransform)


class Robot(ActiveDofs):
    """Robot: a body with manipulators, sensors and a controller; ``env.GetRobots()`` returns the robots."""

    _internal = (
        "active_choice",
        "affine_kinds",
        "arm_solvers",
        "devices",
        "ik_solvers",
        "quaternion_limits",
        "remake",
        "step_controller",
        "take_choices",
    )

    DOFAffine = DOFAffine
    AttachedSensorInfo = AttachedSensorInfo
    Manipulator = Manipulator
    ManipulatorInfo = ManipulatorInfo
    RobotBaseInfo = RobotBaseInfo
    RobotStateSaver = StateSaver

    _interface_type = InterfaceType.robot
    _controller: "Controller | EllipsisType | None" = ...
    default_saved = KinBody.default_saved | _ACTIVE_DOF | _ACTIVE_MANIPULATOR

    def __init__(self, env: "Environment", state: BodyState) -> None:
        super().__init__(env, state)
        self.active_choice = ActiveChoice()
        self.affine_kinds = default_kinds()
        self.quaternion_limits = np.array([np.pi, 0.0, 0.0, 0.0])
        self._active_manipulator = None
        self._connected = ConnectedBodies(self)
        self.devices = Devices(self)
        self.ik_solvers: dict[str, IkSolver] = {}
        self.arm_solvers: dict[tuple[str, IkParameterizationType], ArmSolver] = {}

    def set_following(self, index: int, equations: Equations) -> None:
        """Make a joint a mimic joint, or an ordinary one. If the number of DOFs changes, all DOFs become active."""
        before = self.GetDOF()
        super().set_following(index, equations)
        if self.GetDOF() != before:
            self.active_choice = ActiveChoice()  # the indices of the old choice no longer mean the same DOFs

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the robot type, always ``GenericRobot``."""
        return "GenericRobot"

    def Grab(  # pyright: ignore[reportIncompatibleMethodOverride] - a robot has an arm to grab with
        self,
        body: KinBody,
        grablink: Link | None = None,
        linkstoignore: "Iterable[Link | int | str] | EllipsisType" = ...,
        grabbedUserData: object = ...,
    ) -> bool:
        """Grab a body, which then moves with the grabbing link.

        OpenRAVE's forms are ``Grab(body)``, ``Grab(body, grablink)``, and the one with all four arguments.

        Args:
            body: The body to grab. See ``KinBody.Grab``.
            grablink: The link of this robot that grabs the body; by default the active manipulator's end effector.
            linkstoignore: Further links of this robot whose collisions with the body are ignored.
            grabbedUserData: Not used; in OpenRAVE it comes with ``linkstoignore``.

        Returns:
            False if no link is given and the robot has no active manipulator with an end effector.

        Example:
            >>> robot.Grab(mug)
            True
            >>> robot.SetDOFValues([0.3], [0])  # the mug moves along
        """
        active = self.GetActiveManipulator()
        link = grablink or (active.GetEndEffector() if active else None)
        return False if link is None else super().Grab(body, link, linkstoignore, grabbedUserData)

    def CreateRobotStateSaver(self, options: int | None = None) -> StateSaver:
        """Return an object that saves the robot's state and restores it; see ``CreateKinBodyStateSaver``.

        Args:
            options: The state to save, ``SaveParameters`` combined with ``|``. By default: poses, joint values, enabled
                links, active DOFs and the active manipulator.

        Example:
            >>> with robot.CreateRobotStateSaver(Robot.SaveParameters.ActiveDOF):
            ...     robot.SetActiveDOFs([0])
        """
        return StateSaver(self, options)

    def CheckLinkSelfCollision(
        self, linkindex: int, linktrans: ArrayLike, report: "CollisionReport | None" = None
    ) -> bool:
        """Return whether a link at another pose collides with the other links or with grabbed bodies.

        Args:
            linkindex: The index of the link.
            linktrans: ``T_world_link``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]. All other links stay in place, including
                the children of this one.
            report: Receives the collision.
        """
        link = self.GetLinks()[self._checked_link(linkindex)]
        with self._simulation.lock, self.CreateKinBodyStateSaver(SaveParameters.LinkTransformation):
            link.SetTransform(linktrans)
            return (self._self_checker or self._env.GetCollisionChecker()).CheckSelfCollision(link, report)

    def to_joint_trajectory(
        self,
        trajectory: Trajectory | Motion,
        *,
        rate: float | None = 100.0,
        moving: bool = False,
        start: ArrayLike | None = None,
    ) -> JointTrajectory:
        """Return a motion as checked waypoints for the controller of a real robot.

        Every point is within the limits of values, velocities and accelerations, and the motion starts and ends at
        rest. It does not check collisions. A grabbed body causes a warning, since waypoints do not contain it.

        Args:
            trajectory: A trajectory of joints of this robot, which keeps its own times and derivatives; or a ``Motion``
                of all DOFs, of which the active ones are written. Straight segments have corners, so a ``Motion`` and a
                trajectory with linear interpolation are retimed: corners are rounded within 0.01 rad or m; if that is
                not possible, the motion stops at each waypoint.
            rate: Points per second [Hz], and one at the end; None: a point at each waypoint, with the derivatives
                that determine the motion between them.
            moving: Whether the motion may start and end with nonzero velocity. A motion with linear interpolation then
                keeps its times, and its points have no velocities.
            start: The measured joint values, shape (dof,) [rad or m]: the first point has to be within 0.01 of them.
                Continuous joints are shifted by whole turns to them.

        Raises:
            ArgumentError: a check fails, and names joint, time, value and limit; or the trajectory moves the base,
                another robot or no joint.

        Example:
            >>> points = robot.to_joint_trajectory(trajectory)
            >>> ravemj.write_joint_trajectory("motion.json", points)
            PosixPath('motion.json')
        """
        from ravemj.manipulation.joint_trajectories import Joints, checked_points  # noqa: PLC0415 - rarely wanted

        body = self.simulation_state
        if not isinstance(trajectory, Motion):
            trajectory = checked_kind(trajectory, Trajectory, "to_joint_trajectory: trajectory")
        motion = trajectory if isinstance(trajectory, Motion) else trajectory.waypoints
        state = None if start is None else checked_vector(start, body.dof, "start")
        hertz = None if rate is None else checked_number(rate, "rate", 1e-3, " Hz")
        active = Joints(body, self.GetActiveDOFIndices().tolist())
        points = checked_points(active, motion, hertz, state, moving=moving)
        for held in self.GetGrabbed():
            message = f"the points do not say that '{self.GetName()}' holds '{held.GetName()}', its load included"
            send_warning(Diagnostic("warning", "grabbed-body", message, body.scene.source))
        return points

    def from_joint_trajectory(self, points: JointTrajectory) -> Trajectory:
        """Return a trajectory with the interpolation of ROS controllers between points; limits are not checked.

        Args:
            points: The points. The interpolation is quintic if they have accelerations, cubic if they have velocities
                only, else linear.

        Raises:
            ArgumentError: the points name a joint that the robot does not have.

        Example:
            >>> trajectory = robot.from_joint_trajectory(ravemj.read_joint_trajectory("motion.json"))
        """
        made = Trajectory(self.GetEnv(), "")
        made.set_waypoints(points.waypoints(self.GetName(), self.simulation_state.scene.dof_names))
        return made

    def GetController(self) -> Controller | None:
        """Return the robot's controller.

        The default is an ``IdealController``; after ``SetController(None)`` it is None.

        Example:
            >>> robot.GetController().SetDesired([0.5, -0.5])
            True
        """
        if self._controller is ...:
            self.SetController(IdealController(self._env, "IdealController"))
        assert self._controller is not ...
        return self._controller

    @also_named(robot="controller")
    def SetController(
        self,
        controller: Controller | None,
        dofindices: "ArrayLike | str | EllipsisType" = ...,
        controltransform: int = 1,
    ) -> bool:
        """Replace the robot's controller.

        Args:
            controller: A controller from ``RaveCreateController``; None leaves the robot without one.
            dofindices: The DOFs that it moves; by default all. A text, as in OpenRAVE's older form, also selects all.
            controltransform: Whether it also moves the robot's base.

        Returns:
            True.

        Raises:
            openrave_exception: ``controller`` is None, and DOFs are given.
            ArgumentError: the controller belongs to another environment.
            IndexError: the robot does not have such a DOF.
        """
        dofs = None if dofindices is ... or isinstance(dofindices, str) else dofindices
        if controller is None and dofs is not None:
            raise RavemjError("SetController: controller is None, and can have no DOFs")
        if controller is not None:
            checked_kind(controller, Controller, "SetController: controller")
        if controller is not None and controller.GetEnv() is not self._env:
            raise ArgumentError("SetController: controller was made for another environment")
        indices = None if dofs is None else checked_indices(dofs, self.GetDOF(), "dofindices")
        with self._simulation.lock:
            if isinstance(self._controller, Controller):
                self._controller.Reset()
            if controller is not None:
                controller.Init(self, indices, controltransform)
            self._controller = controller
        return True

    def WaitForController(self, timeout: float = 0.0) -> bool:
        """Wait until the controller has finished its command.

        Args:
            timeout: The longest time to wait, in real time [s]; 0 sets no limit.

        Returns:
            Whether the controller has finished; False for a robot without a controller.

        Raises:
            openrave_exception: the wait would never end, since this thread locks the environment (``with env:``), and
                simulation time stands still. With a timeout, the result is False at once.

        Example:
            >>> robot.GetController().SetPath(trajectory)
            True
            >>> robot.WaitForController(0)
            True
        """
        controller = self.GetController()
        if controller is None:
            return False
        return wait_until(controller.IsDone, timeout, self._simulation.lock, self._env.IsSimulationRunning)

    def step_controller(self, timestep: float) -> None:
        """Advance the controller by a time step [s]; a default controller that was never used is not created."""
        if isinstance(self._controller, Controller):
            self._controller.SimulationStep(timestep)

    def Init(  # pyright: ignore[reportIncompatibleMethodOverride] - OpenRAVE's arguments
        self,
        linkinfos: Sequence[LinkInfo],
        jointinfos: Sequence[JointInfo],
        manipinfos: Sequence[ManipulatorInfo] = (),
        attachedsensorinfos: Sequence[AttachedSensorInfo] = (),
        uri: str = "",
    ) -> bool:
        """Make the robot from descriptions of links, joints, manipulators and sensors.

        Args:
            linkinfos: The descriptions of the links; the first one is the root.
            jointinfos: The descriptions of the joints; joints with DOFs stand in DOF order.
            manipinfos: The descriptions of the manipulators; the first one is active.
            attachedsensorinfos: The descriptions of the sensors on the links.
            uri: Not used.

        Returns:
            True.

        Raises:
            openrave_exception: the robot is in an environment, or the descriptions are invalid; the robot stays as it
                is.
        """
        del uri
        info = RobotBaseInfo(
            _vLinkInfos=linkinfos,
            _vJointInfos=jointinfos,
            _vManipInfos=manipinfos,
            _vAttachedSensorInfos=attachedsensorinfos,
        )
        return self.InitFromKinBodyInfo(info)

    def InitFromKinBodyInfo(self, info: KinBodyInfo) -> bool:
        """Rebuild the robot, including its name, from a description.

        Args:
            info: The description, for instance a result of ``ExtractInfo``. A ``RobotBaseInfo`` has grippers and
                connected bodies as well.

        Returns:
            True.
        """
        super().InitFromKinBodyInfo(info)
        if isinstance(info, RobotBaseInfo):
            self._grippers = tuple(info._vGripperInfos)
            self._connected = ConnectedBodies(self, info._vConnectedBodyInfos)
        return True

    def remake(self, info: RobotBaseInfo) -> None:
        """Rebuild the robot from a description; keep its file, its id and its connected bodies."""
        super().InitFromKinBodyInfo(replace(info, _uri=self._uri, _id=self._id))
        self._grippers = tuple(info._vGripperInfos)
        self.active_choice = ActiveChoice()

    def InitFromRobotInfo(self, info: RobotBaseInfo) -> bool:
        """Rebuild the robot, including its name, from ``info``, as ``InitFromKinBodyInfo`` does, and return True."""
        return self.InitFromKinBodyInfo(info)

    def GetRobotStructureHash(self) -> str:
        """Return a hash of the robot's structure, manipulators and sensors, 32 hexadecimal digits."""
        return hashes.of_robot(self._state.scene)

    def ExtractInfo(self, options: int = ExtractInfoOptions.Everything) -> RobotBaseInfo:
        """Return the description of the robot in its current state.

        Args:
            options: What to include, ``ExtractInfoOptions``.

        Returns:
            A ``RobotBaseInfo``. Connected bodies have their own list in it, whether they are active or not.
        """
        body = self._state.scene
        info = RobotBaseInfo(
            **self.extracted(options),
            _vManipInfos=[ManipulatorInfo.of(body, arm) for arm in body.manipulators],
            _vAttachedSensorInfos=[AttachedSensorInfo.of(body, sensor) for sensor in body.sensors],
            _vGripperInfos=self.GetGripperInfos(),
            _vConnectedBodyInfos=[body.GetInfo() for body in self._connected.bodies],
        )
        return self._connected.without_their_parts(info)

    def Clone(self, ref: KinBody, cloningoptions: int = 0) -> None:
        """Copy another body, as ``KinBody.Clone`` does; from a robot, also copy the sensors and the user's choices.

        These choices are the active DOFs, the active manipulator and the IK solvers.

        Args:
            ref: The body to copy. Grabbed bodies are not copied.
            cloningoptions: Not used.

        Raises:
            openrave_exception: this robot is in an environment.
        """
        super().Clone(ref, cloningoptions)
        self.devices.forget()
        if isinstance(ref, Robot):
            self.take_choices(ref)

    def take_choices(self, other: "Robot") -> None:
        """Copy active DOFs, active manipulator, IK solvers and sensor states from a robot of the same structure."""
        self.active_choice = other.active_choice
        self.affine_kinds = {name: replace(kind) for name, kind in other.affine_kinds.items()}
        self.quaternion_limits = other.quaternion_limits.copy()
        self._connected = other._connected.copy_for(self)
        self._active_manipulator = other._active_manipulator
        self.ik_solvers = {name: solver.copy_for(self) for name, solver in other.ik_solvers.items()}
        self.devices.take_over(other.devices)

    def restorers(self, options: int) -> list[Restorer]:
        """Return functions that restore the current state, on this robot or on another robot of the same structure.

        ``options`` are the parts of the state, ``SaveParameters`` combined.
        """
        restorers = super().restorers(options)
        if options & _ACTIVE_DOF:
            choice = self.active_choice
            restorers.append(lambda body: setattr(body, "active_choice", choice))
        if options & _ACTIVE_MANIPULATOR:
            name = self._active_manipulator
            restorers.append(lambda body: setattr(body, "_active_manipulator", name))
        tools = self.GetManipulators() if options & _TOOLS else []
        if options & _ACTIVE_TOOL and (active := self.GetActiveManipulator()) is not None:
            tools.append(active)
        for tool, transform in [(tool.GetName(), tool.GetLocalToolTransform()) for tool in tools]:
            restorers.append(lambda body, tool=tool, transform=transform: _set_tool(body, tool, transform))
        return restorers

    devices: Devices
    """Sensor objects of the attached sensors, created on first use."""
    _connected: ConnectedBodies
    ik_solvers: dict[str, IkSolver]
    """The IK solvers, by the names of their manipulators."""
    _active_manipulator: str | None
    """Name of the active manipulator; None means the first, an empty string none."""
    _manipulators: tuple[Manipulator, ...] = ()
    _grippers: tuple[GripperInfo, ...] = ()

    def GetManipulators(self, manipname: str | None = None) -> list[Manipulator]:
        """Return the manipulators, in the order of the file, or only the one called ``manipname``."""
        arms = self._state.scene.manipulators
        if len(self._manipulators) != len(arms):  # created once, like links
            known = self._manipulators[: len(arms)]
            new = (Manipulator(self, self._state, index) for index in range(len(known), len(arms)))
            self._manipulators = (*known, *new)
        if manipname is None:
            return list(self._manipulators)
        return [manipulator for manipulator, arm in zip(self._manipulators, arms, strict=True) if arm.name == manipname]

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

    def servo_gains(self, timestep: float = 0.002, stands: bool = False) -> Gains:
        """Return gains with which position servos hold the robot and follow steps of their targets.

        They are computed from the inertias and gravity torques at the present joint values and in 32 random
        configurations, and from the effort limits; ``ravemj convert --actuators position`` writes the same. A
        controller gives each DOF the torque ``kp * (target - value) - kv * velocity``. Add the armature to that of each
        joint in the simulated model.

        Args:
            timestep: Time step of the simulation [s].
            stands: Whether the base is free, so that the feet support the weight of the robot.

        Returns:
            ``kp`` [N m/rad or N/m], ``kv`` [N m s/rad or N s/m] and ``armature`` [kg m^2 or kg], each of shape (dof,).

        Raises:
            ArgumentError: the time step is not a positive number.

        Example:
            >>> robot = ravemj.load(ravemj.model_path("puma560")).GetRobots()[0]
            >>> robot.servo_gains().kp.shape
            (6,)
        """
        from ravemj.engine.servo_gains import loads_of, servo_gains  # noqa: PLC0415 - rarely wanted

        step = checked_number(timestep, "servo_gains: timestep")
        if step <= 0.0:
            raise ArgumentError(f"servo_gains: timestep is {step:g}, not above 0")
        state = self.simulation_state
        with state.simulation.lock:
            gravity = state.simulation.gravity
            loads = loads_of(snapshot(state), state.kinematics.values(), gravity, stands=stands)
        return servo_gains(loads, step)

    def ik(
        self,
        goals: ArrayLike,
        iktype: IkParameterizationType = IkParameterizationType.Transform6D,
        *,
        limits: bool = True,
    ) -> IkBatch:
        """Return all IK solutions of the active manipulator for many goals; see ``Manipulator.ik``.

        Args:
            goals: ``T_world_tool``, shape (N, 4, 4) or (4, 4); for other types the values of the goals, shape (N, k).
            iktype: The type of the goals.
            limits: Whether only solutions within the limits are valid.

        Raises:
            openrave_exception: no manipulator is active, or its arm cannot be solved.
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
            removeduplicate: Whether to replace an existing manipulator of the same name.

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
        """Set the active manipulator. The active DOFs do not change.

        Args:
            manipname: The name, the manipulator, or its index in ``GetManipulators()``; '' for none.

        Returns:
            The active manipulator, or None.

        Raises:
            ArgumentError: the robot has no such manipulator. The active one does not change.
            openrave_exception: the name is None.

        Example:
            >>> manipulator = robot.SetActiveManipulator("arm")
            >>> robot.SetActiveDOFs(manipulator.GetArmIndices())
        """
        if manipname is None:
            raise RavemjError("SetActiveManipulator: is None, and should be a name; '' means none", ErrorCode.Assert)
        names = [manipulator.name for manipulator in self._state.scene.manipulators]
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
            removeduplicate: Whether to replace an existing description of the same name.

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
        return [AttachedSensor(self, self._state, index) for index in range(len(self._state.scene.sensors))]

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
            removeduplicate: Whether to replace an existing sensor of the same name.

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
            self._state.edit(sensors=tuple(sensor for sensor in self._state.scene.sensors if sensor.name != name))
        return True

    def GetConnectedBodies(self) -> list[ConnectedBody]:
        """Return the connected bodies, active or not."""
        return list(self._connected.bodies)

    def GetConnectedBody(self, bodyname: str) -> ConnectedBody | None:
        """Return the connected body called ``bodyname``, or None."""
        return next((body for body in self._connected.bodies if body.GetName() == bodyname), None)

    def GetConnectedBodyActiveStates(self) -> list[int]:
        """Return the active state of each connected body: 1 for active, 0 for inactive, -1 for undecided."""
        return [body.IsActive() for body in self._connected.bodies]

    def SetConnectedBodyActiveStates(self, activestates: Sequence[int]) -> None:
        """Set the active state of each connected body; see ``ConnectedBody.SetActive``.

        Args:
            activestates: As many states as there are connected bodies.
        """
        bodies = self._connected.bodies
        if len(activestates) != len(bodies):
            raise ArgumentError(f"SetConnectedBodyActiveStates: {len(activestates)} states for {len(bodies)} bodies")
        for body, active in zip(bodies, activestates, strict=True):
            body.SetActive(active)

    def AddConnectedBody(self, connectedbodyinfo: ConnectedBodyInfo, removeduplicate: bool = False) -> ConnectedBody:
        """Add a connected body. If it is active, the next ``env.Add`` makes it a part of the robot.

        Args:
            connectedbodyinfo: The description of the body.
            removeduplicate: Whether to replace an existing connected body of the same name.

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
        return self._connected.add(info, removeduplicate)

    def RemoveConnectedBody(self, connectedbody: ConnectedBody) -> bool:
        """Remove ``connectedbody``, and return whether the robot had it.

        Raises:
            openrave_exception: the robot is in an environment (``InvalidState``).
        """
        return self._connected.remove(connectedbody)

    def connect(self) -> None:
        """Merge active connected bodies into the robot. The environment calls this before it adds the robot."""
        self._connected.connect()

    def disconnect(self) -> None:
        """Remove the parts of connected bodies. The environment calls this after it has removed the robot."""
        self._connected.disconnect()

    def _place(
        self, name: str, parts: Sequence[scene.Manipulator | scene.AttachedSensor], replaces: bool, caller: str
    ) -> int:
        """Return the list index for a new part: that of the part with the same name, else the length of the list.

        Raises:
            ArgumentError: the name is taken, and ``replaces`` is False.
        """
        index = next((index for index, part in enumerate(parts) if part.name == name), len(parts))
        if index < len(parts) and not replaces:
            raise ArgumentError(f"{caller}: '{self.GetName()}' already has one called '{name}'")
        return index


def _set_tool(body: KinBody, name: str, transform: Floats) -> None:
    manipulator = body.GetManipulator(name) if isinstance(body, Robot) else None
    if manipulator is not None:
        manipulator.SetLocalToolTransform(transform)
