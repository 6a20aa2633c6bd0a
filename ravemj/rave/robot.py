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
from ravemj.core.arrays import checked_indices
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, RavemjError
from ravemj.geometry_functions import DOFAffine
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.model import hashes
from ravemj.model.mimic import Equations
from ravemj.rave.body.active import ActiveChoice, ActiveDofs
from ravemj.rave.body.affine import default_kinds
from ravemj.rave.body.equipment import Equipment
from ravemj.rave.body.saving import Restorer, StateSaver
from ravemj.rave.connected_body import ConnectedBodies
from ravemj.rave.controllers import Controller, IdealController
from ravemj.rave.controllers.waiting import wait_until
from ravemj.rave.devices import Devices
from ravemj.rave.enums import InterfaceType, SaveParameters
from ravemj.rave.iksolver import IkSolver
from ravemj.rave.infos import (
    AttachedSensorInfo,
    ExtractInfoOptions,
    JointInfo,
    KinBodyInfo,
    LinkInfo,
    ManipulatorInfo,
    RobotBaseInfo,
)
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator

if TYPE_CHECKING:
    from ravemj.ik.arms import ArmSolver
    from ravemj.rave.environment import Environment
    from ravemj.rave.report import CollisionReport

_ACTIVE_DOF, _ACTIVE_MANIPULATOR = int(SaveParameters.ActiveDOF), int(SaveParameters.ActiveManipulator)
_TOOLS, _ACTIVE_TOOL = int(SaveParameters.ManipulatorsToolTransform), int(SaveParameters.ActiveManipulatorToolTransform)


class Robot(ActiveDofs, Equipment, KinBody):
    """A robot: a body with manipulators, sensors and a controller. ``env.GetRobots()`` returns the robots."""

    DOFAffine = DOFAffine
    AttachedSensorInfo = AttachedSensorInfo
    Manipulator = Manipulator
    ManipulatorInfo = ManipulatorInfo
    RobotBaseInfo = RobotBaseInfo
    RobotStateSaver = StateSaver

    _interface_type = InterfaceType.robot
    _controller: "Controller | EllipsisType | None" = ...
    _internal = (
        "active_choice",
        "affine_kinds",
        "arm_solvers",
        "connected",
        "devices",
        "ik_solvers",
        "quaternion_limits",
        "remake",
        "step_controller",
        "take_choices",
    )
    default_saved = KinBody.default_saved | _ACTIVE_DOF | _ACTIVE_MANIPULATOR

    def __init__(self, env: "Environment", state: BodyState) -> None:
        super().__init__(env, state)
        self.active_choice = ActiveChoice()
        self.affine_kinds = default_kinds()
        self.quaternion_limits = np.array([np.pi, 0.0, 0.0, 0.0])
        self._active_manipulator = None
        self.connected = ConnectedBodies(self)
        self.devices = Devices(self)
        self.ik_solvers: dict[str, IkSolver] = {}
        self.arm_solvers: dict[tuple[str, IkParameterizationType], ArmSolver] = {}

    def set_following(self, index: int, equations: Equations) -> None:
        """Make a joint a mimic joint, or an ordinary one. If this changes the number of DOFs, all are active again."""
        before = self.GetDOF()
        super().set_following(index, equations)
        if self.GetDOF() != before:
            self.active_choice = ActiveChoice()  # the indices of the old choice no longer mean the same DOFs

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the kind of robot."""
        return "GenericRobot"

    def Grab(  # pyright: ignore[reportIncompatibleMethodOverride] - a robot has an arm to grab with
        self,
        body: KinBody,
        grablink: Link | None = None,
        linkstoignore: "Iterable[Link | int | str] | EllipsisType" = ...,
        grabbedUserData: object = ...,
    ) -> bool:
        """Grab a body, which then moves with the link that holds it.

        OpenRAVE's forms are ``Grab(body)``, ``Grab(body, grablink)``, and the one with all four arguments.

        Args:
            body: The body to grab. See ``KinBody.Grab``.
            grablink: The link of this robot that holds the body; by default the active manipulator's end effector.
            linkstoignore: Further links of this robot that are not tested against the body.
            grabbedUserData: Not used; OpenRAVE has it together with ``linkstoignore``.

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
        """Return whether one link, moved to another pose, collides with the other links or with held bodies.

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

    def GetController(self) -> Controller | None:
        """Return the robot's controller.

        From the start it is an ``IdealController``; after ``SetController(None)`` it is None.

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
        indices = None if dofs is None else checked_indices(dofs, self.GetDOF())
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
        """Advance the controller by a time step [s]. A robot that never had one does not get one for this."""
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
            openrave_exception: the robot is in an environment, or the descriptions do not make a robot; the robot stays
                as it is.
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
        """Replace the robot, including its name, by the one of a description.

        Args:
            info: The description, for instance a result of ``ExtractInfo``. A ``RobotBaseInfo`` has grippers and
                connected bodies as well.

        Returns:
            True.
        """
        super().InitFromKinBodyInfo(info)
        if isinstance(info, RobotBaseInfo):
            self._grippers = tuple(info._vGripperInfos)
            self.connected = ConnectedBodies(self, info._vConnectedBodyInfos)
        return True

    def remake(self, info: RobotBaseInfo) -> None:
        """Make the robot anew of a description, but for its file, its id and what can be connected to it."""
        super().InitFromKinBodyInfo(replace(info, _uri=self._uri, _id=self._id))
        self._grippers = tuple(info._vGripperInfos)
        self.active_choice = ActiveChoice()

    def InitFromRobotInfo(self, info: RobotBaseInfo) -> bool:
        """Make the robot, including its name, of ``info``, as ``InitFromKinBodyInfo`` does, and return True."""
        return self.InitFromKinBodyInfo(info)

    def GetRobotStructureHash(self) -> str:
        """Return a hash of the robot's structure, manipulators and sensors, 32 hexadecimal digits."""
        return hashes.of_robot(self._state.scene, self.GetKinematicsGeometryHash())

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
            _vConnectedBodyInfos=[body.GetInfo() for body in self.connected.bodies],
        )
        return self.connected.without_their_parts(info)

    def Clone(self, ref: KinBody, cloningoptions: int = 0) -> None:
        """Copy another body, as ``KinBody.Clone`` does, and of a robot also the sensors and the user's choices.

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
        """Copy active DOFs and manipulator, IK solvers and the state of the sensors of a robot of the same kind."""
        self.active_choice = other.active_choice
        self.affine_kinds = {name: replace(kind) for name, kind in other.affine_kinds.items()}
        self.quaternion_limits = other.quaternion_limits.copy()
        self.connected = other.connected.copy_for(self)
        self._active_manipulator = other._active_manipulator
        self.ik_solvers = {name: solver.copy_for(self) for name, solver in other.ik_solvers.items()}
        self.devices.take_over(other.devices)

    def restorers(self, options: int) -> list[Restorer]:
        """Return functions that restore the current state of this robot, on it or on a robot of the same kind."""
        found = super().restorers(options)
        if options & _ACTIVE_DOF:
            choice = self.active_choice
            found.append(lambda body: setattr(body, "active_choice", choice))
        if options & _ACTIVE_MANIPULATOR:
            name = self._active_manipulator
            found.append(lambda body: setattr(body, "_active_manipulator", name))
        tools = self.GetManipulators() if options & _TOOLS else []
        if options & _ACTIVE_TOOL and (active := self.GetActiveManipulator()) is not None:
            tools.append(active)
        for tool, transform in [(tool.GetName(), tool.GetLocalToolTransform()) for tool in tools]:
            found.append(lambda body, tool=tool, transform=transform: _set_tool(body, tool, transform))
        return found


def _set_tool(body: KinBody, name: str, transform: Floats) -> None:
    manipulator = body.GetManipulator(name) if isinstance(body, Robot) else None
    if manipulator is not None:
        manipulator.SetLocalToolTransform(transform)
