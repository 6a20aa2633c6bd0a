"""Controllers of robots."""

import logging
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_flag, checked_kind
from ravemj.core.arrays import checked_indices, checked_numbers, checked_transform, checked_vector
from ravemj.core.locks import StateLock
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.enums import CheckLimitsAction, InterfaceType
from ravemj.rave.interface import Interface, asked_for
from ravemj.rave.report import CollisionReport
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.body_motion import GrabChange, grab_changes
from ravemj.trajectories.groups import joint_indices

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.robot import Robot


_LOG = logging.getLogger("ravemj")

_POLL = 1e-3
"""Polling interval [s] of a waiting controller: short compared with a time step of 10 ms, without noticeable load."""


def wait_until(is_done: Callable[[], bool], timeout: float, lock: StateLock, is_running: Callable[[], bool]) -> bool:
    """Wait until a controller has finished its command; see ``Robot.WaitForController``.

    Args:
        is_done: Returns whether the controller has finished.
        timeout: The longest wait in real time [s]; 0 for no limit.
        lock: The lock of the environment.
        is_running: Returns whether the thread of simulation time runs.

    Returns:
        Whether the controller has finished.

    Raises:
        RavemjError: the wait would never end, because this thread holds the lock.
    """
    if is_done():
        return True
    if lock.is_held:
        message = "WaitForController: time stands still inside 'with env:'; wait outside of it"
        if timeout <= 0:
            raise RavemjError(message, ErrorCode.InvalidState)
        _LOG.warning("%s", message)
        return False
    if not is_running():
        _LOG.warning("WaitForController: time was stopped by StopSimulation; waiting for others to step it")
    deadline = time.monotonic() + timeout
    while not is_done():
        if timeout > 0 and deadline < time.monotonic():
            return False
        time.sleep(_POLL)
    return True


class Controller(Interface):
    """Base class of controllers, which move a robot over time; ``robot.GetController()`` returns the robot's."""

    _interface_type = InterfaceType.controller

    def __init__(self, env: "Environment", xmlid: str) -> None:
        super().__init__(env, xmlid)
        self._attached_robot: Robot | None = None
        self._dofs: Ints | None = None
        self._moves_base = False
        self._is_done = True
        self._time = 0.0

    def Init(self, robot: "Robot", dofindices: ArrayLike | None = None, controltransform: int = 1) -> bool:
        """Set the robot and the DOFs that the controller moves; ``robot.SetController`` calls this.

        Args:
            robot: The robot.
            dofindices: The DOF indices, in the order of the values that the controller takes; None for all.
            controltransform: Whether the controller also moves the robot's base.

        Returns:
            True.
        """
        indices = None if dofindices is None else checked_indices(dofindices, robot.GetDOF(), "dofindices")
        with robot.simulation_state.simulation.lock:
            self._attached_robot, self._dofs, self._moves_base = robot, indices, bool(controltransform)
            self.Reset()
        return True

    @property
    def _robot(self) -> "Robot":
        if self._attached_robot is None:
            message = f"the {type(self).__name__} has no robot yet; call robot.SetController(controller) first"
            raise RavemjError(message, ErrorCode.NotInitialized)
        return self._attached_robot

    def GetRobot(self) -> "Robot | None":
        """Return the robot that the controller moves, or None."""
        return self._attached_robot

    def GetControlDOFIndices(self) -> Ints:
        """Return the DOF indices that the controller moves, in the order of the values that it takes."""
        if self._dofs is not None:
            return self._dofs.copy()
        return np.arange(0 if self._attached_robot is None else self._attached_robot.GetDOF())

    def IsControlTransformation(self) -> int:
        """Return 1 if the controller also moves the robot's base, else 0."""
        return int(self._moves_base)

    def IsDone(self) -> bool:
        """Return whether the controller has finished its last command.

        Example:
            >>> while not robot.GetController().IsDone():
            ...     time.sleep(0.01)
        """
        return self._is_done

    def GetTime(self) -> float:
        """Return the time along the current path [s]."""
        return self._time

    def Reset(self, options: int = 0) -> None:
        """Cancel the current command; the robot stays in place. ``options`` are not used."""
        del options
        self._is_done = True

    def SetDesired(self, values: ArrayLike, transform: ArrayLike | None = None) -> bool:
        """Command a configuration of the robot.

        Args:
            values: One value for each of ``GetControlDOFIndices()`` [rad or m]; for velocity controllers a velocity
                [rad/s or m/s].
            transform: ``T_world_link0``, the pose of the robot's base, if the controller moves it; None leaves the base
                in place.

        Returns:
            True.

        Raises:
            ArgumentError: the number of values is wrong. The robot does not move.
        """
        checked = checked_vector(values, len(self._robot_dofs()), "SetDesired: values")
        T_world_base = None if transform is None else checked_transform(transform, "SetDesired: transform")
        with self._robot.simulation_state.simulation.lock:
            self._desire(checked, T_world_base if self._moves_base else None)
        self._env.clock.wake()
        return True

    def _desire(self, values: Floats, T_world_base: Floats | None) -> None:
        raise self._cannot("take single values")

    def SetPath(self, traj: Trajectory | None) -> bool:
        """Play a copy of the trajectory ``traj`` in simulation time from its first waypoint on, and return True."""
        del traj
        raise self._cannot("play paths")

    def SimulationStep(self, timestep: float) -> None:
        """Advance the controller by ``timestep`` [s]; each step of simulation time calls this."""

    def GetVelocity(self) -> Floats:
        """Return the current velocities of the DOFs that the controller moves [rad/s or m/s], shape (n,)."""
        return self._robot.GetDOFVelocities()[self._robot_dofs()]

    def GetTorque(self) -> Floats:
        """Return the torques that the controller applies [N m or N], shape (n,): zeros, since it sets joint values."""
        return np.zeros(len(self._robot_dofs()))

    def _robot_dofs(self) -> Ints:
        """Return the DOF indices that the controller moves; raise an error if it has no robot."""
        assert self._robot is not None
        return self.GetControlDOFIndices()

    def _cannot(self, what: str) -> RavemjError:
        return RavemjError(f"{type(self).__name__} cannot {what}", ErrorCode.NotImplemented)

    def __repr__(self) -> str:
        robot = self._attached_robot
        if robot is not None and robot.GetController() is self:
            return f"{robot!r}.GetController()"
        return f"RaveCreateController({self._env!r}, {self._xmlid!r})"


_SLACK = 1e-6
"""Tolerance [rad or m] of the check that a joint's motion in a time step keeps its velocity limit; OpenRAVE's value."""


class _Path(NamedTuple):
    """A trajectory, and its columns that move the robot.

    Attributes:
        trajectory: A copy of the user's trajectory.
        columns: The columns of its waypoints that hold joint values.
        dofs: The DOF indices of these values.
        moves_base: Whether its waypoints have a pose of the robot's base.
        grabs: The grabs and releases that are still to be executed, in the order of time.
    """

    trajectory: Trajectory
    columns: Ints
    dofs: Ints
    moves_base: bool
    grabs: list[GrabChange]


def _switch(command: str, attribute: str) -> Callable[["IdealController", str], str]:
    """Return the handler of a command that sets a boolean attribute."""

    def run(controller: "IdealController", arguments: str) -> str:
        setattr(controller, attribute, checked_flag(arguments, command))
        return ""

    return run


class IdealController(Controller):
    """The controller that robots have from the start: it sets the commanded values at once and exactly.

    ``SetDesired`` moves the robot at once, and is done with the next simulation step. ``SetPath`` plays a trajectory:
    the first step sets its first waypoint, and the path is done one step after its last waypoint. A group
    ``grab ROBOT LINK`` of the trajectory has indices of bodies (``GetEnvironmentBodyIndex()``) as values: the link with
    the index LINK grabs the body, and releases it if the value is negative.

    The controller reports joints that exceed their position or velocity limits and, after
    ``SendCommand("SetCheckCollisions 1")``, collisions of the robot. It logs the first problem of each command as a
    warning. After ``SendCommand("SetThrowExceptions 1")``, each problem raises an ``openrave_exception`` (``Assert``)
    in ``SetDesired`` or in the simulation step, and ends the command. ``SendCommand("Pause 1")`` pauses the robot until
    ``Pause 0``; ``SetEnableLogging 1`` logs each path.

    Example:
        >>> controller = robot.GetController()
        >>> controller.SetPath(trajectory)
        True
        >>> robot.WaitForController(0)
        True
    """

    _path: _Path | None = None
    _desired: tuple[Floats, Floats | None] | None = None
    _last_timestep = 0.0
    _has_problem = False
    _throws_exceptions = False
    _checks_collisions = False
    _is_paused = False
    _logs = False

    def Reset(self, options: int = 0) -> None:
        """Cancel the current command; the robot stays in place. ``options`` are not used."""
        with self._env.simulation.lock:
            self._path = self._desired = None
            super().Reset(options)

    def _desire(self, values: Floats, T_world_base: Floats | None) -> None:
        if T_world_base is None and self._moves_base:
            T_world_base = self._robot.GetTransform()
        self._time, self._has_problem = 0.0, False
        self._place(self._robot_dofs(), values, T_world_base)
        self._path, self._desired = None, (values, T_world_base)
        self._is_done = False

    def SetPath(self, traj: Trajectory | None) -> bool:
        """Play a trajectory in simulation time. It replaces the current command.

        The trajectory is copied. Joints that it does not name stay in place; a trajectory of another robot moves
        nothing.

        Args:
            traj: A trajectory with times, for instance from ``planningutils.RetimeActiveDOFTrajectory``.

        Returns:
            True.

        Raises:
            openrave_exception: the trajectory is None, or has no waypoints or no times. The current path goes on.

        Example:
            >>> robot.GetController().SetPath(trajectory)
            True
            >>> robot.WaitForController(0)
            True
        """
        if traj is None:
            raise RavemjError("SetPath: traj is None; Reset() stops a path")
        if not checked_kind(traj, Trajectory, "SetPath: traj").GetNumWaypoints():
            raise ArgumentError("SetPath: traj has no waypoints")
        if not (np.isfinite(traj.GetAllWaypoints2D()).all() and traj.GetDuration() >= 0):
            raise ArgumentError("SetPath: traj should have finite values and a duration of 0 s or more")
        with self._robot.simulation_state.simulation.lock:
            start = traj.Sample(0.0)  # raises for a trajectory without times, before anything has changed
            path = self._prepared(traj)
            if path.moves_base:  # raises for poses that are none
                traj.GetConfigurationSpecification().ExtractTransform(None, start, self._robot)
            if path.grabs:  # grabs need the world's model; compiled in a step it would delay simulation time
                self._env.simulation.collisions()
            self._path, self._desired = path, None
            self._time, self._is_done = 0.0, False
            self._last_timestep, self._has_problem = 0.0, False
        if self._logs:
            _LOG.info("robot '%s' plays a path of %g s", self._robot.GetName(), path.trajectory.GetDuration())
        self._env.clock.wake()
        return True

    def _prepared(self, traj: Trajectory) -> _Path:
        spec = traj.GetConfigurationSpecification()
        name = self._robot.GetName()
        group = spec.FindCompatibleGroup(f"joint_values {name}")
        own = self._robot_dofs().tolist()
        places = [] if group is None else [(group.offset + i, dof) for i, dof in enumerate(joint_indices(group))]
        columns, dofs = np.array([place for place in places if place[1] in own], dtype=int).reshape(-1, 2).T
        has_base = spec.FindCompatibleGroup(f"affine_transform {name}") is not None
        copy = Trajectory(self._env, traj.GetXMLId())
        copy.Clone(traj)
        return _Path(copy, columns, dofs, has_base and self._moves_base, grab_changes(copy.waypoints, name))

    def SimulationStep(self, timestep: float) -> None:
        """Advance the controller by ``timestep`` [s]; each step of simulation time calls this."""
        if self._is_paused:
            return
        if self._path is not None:
            self._play(self._path, timestep)
        elif self._desired is not None:
            self._place(self._robot_dofs(), *self._desired)
            self._desired, self._is_done = None, True

    def _play(self, path: _Path, timestep: float) -> None:
        """Move the robot to the path's point at the controller's time, then advance that time.

        In this order, as in OpenRAVE, the first step sets the first waypoint.
        """
        duration = path.trajectory.GetDuration()
        is_over = self._time > duration
        self._time = min(self._time, duration)
        while path.grabs and path.grabs[0].time <= self._time:
            change = path.grabs.pop(0)
            self._show(path, change.time, 0.0)  # bodies are grabbed where the robot is then, not where the step ends
            self._grab_or_release(change)
        self._show(path, self._time, self._last_timestep or timestep)
        if is_over:
            self._path, self._is_done = None, True
        else:
            self._time += timestep
            self._last_timestep = timestep

    def _grab_or_release(self, change: GrabChange) -> None:
        robot = self._robot
        body = self._env.GetBodyFromEnvironmentId(abs(change.body))
        if body is None or change.link >= len(robot.GetLinks()):
            self._complain(f"cannot grab or release body {abs(change.body)} with link {change.link}")
        elif change.body < 0:
            robot.Release(body)
        elif not robot.IsGrabbing(body):
            robot.Grab(body, robot.GetLinks()[change.link])

    def _show(self, path: _Path, time: float, elapsed: float) -> None:
        """Move the robot to the point of a path at a time [s]; ``elapsed`` is the duration of this motion [s]."""
        point = path.trajectory.Sample(time)
        T_world_base = None
        if path.moves_base:
            spec = path.trajectory.GetConfigurationSpecification()
            T_world_base = spec.ExtractTransform(self._robot.GetTransform(), point, self._robot)
        self._place(path.dofs, point[path.columns], T_world_base, elapsed)

    def _place(self, dofs: Ints, values: Floats, T_world_base: Floats | None, elapsed: float = 0.0) -> None:
        """Set joint values and, unless None, the pose of the base; all velocities become zero.

        ``elapsed`` is the duration of the motion [s], to check the velocity limits; 0 allows any velocity.
        """
        robot = self._robot
        if len(dofs):
            self._check_speed(dofs, values, elapsed)
            self._set_values(dofs, values)
        if T_world_base is not None:
            robot.SetTransform(T_world_base)
        velocities = robot.GetDOFVelocities()
        if velocities[dofs].any():
            velocities[dofs] = 0.0
            robot.SetDOFVelocities(velocities, checklimits=CheckLimitsAction.Nothing)
        if self._checks_collisions:
            report = CollisionReport()
            if self._env.CheckCollision(robot, report) or robot.CheckSelfCollision(report):
                self._complain(f"collides: {report}")

    def _set_values(self, dofs: Ints, values: Floats) -> None:
        if not self._throws_exceptions:
            self._robot.SetDOFValues(values, dofs)  # warns of values outside the limits
            return
        try:
            self._robot.SetDOFValues(values, dofs, CheckLimitsAction.CheckLimitsThrow)
        except ArgumentError as error:
            self._complain(f"cannot go there: {error.message}")

    def _check_speed(self, dofs: Ints, values: Floats, elapsed: float) -> None:
        robot = self._robot
        moved = np.abs(robot.SubtractDOFValues(values, robot.GetDOFValues(dofs), dofs))
        most = elapsed * robot.GetDOFVelocityLimits(dofs) + _SLACK
        if elapsed > 0 and (moved > most).any():
            first = int((moved > most).argmax())
            joint, allowed = robot.GetJointFromDOFIndex(int(dofs[first])), f"{most[first]:.6g} in {elapsed:g} s"
            self._complain(f"moves joint '{joint.GetName()}' by {moved[first]:.6g}; its speed limit is {allowed}")

    def _complain(self, problem: str) -> None:
        """Log the first problem of a path, or raise an error after ``SetThrowExceptions 1``."""
        message = f"robot '{self._robot.GetName()}' {problem} (controller time {self._time:g} s)"
        if self._throws_exceptions:
            self.Reset()
            raise RavemjError(message, ErrorCode.Assert)
        if not self._has_problem:
            _LOG.warning("%s", message)
        self._has_problem = True

    _commands: ClassVar = {
        "Pause": _switch("Pause", "_is_paused"),
        "SetEnableLogging": _switch("SetEnableLogging", "_logs"),
        "SetThrowExceptions": _switch("SetThrowExceptions", "_throws_exceptions"),
        "SetCheckCollisions": _switch("SetCheckCollisions", "_checks_collisions"),
    }


class VelocityController(Controller):
    """A controller of joint velocities: OpenRAVE's ``IdealVelocityController`` and ``odevelocity``.

    It keeps the commanded velocities until the next command. With physics, motors at the joints drive them to the
    velocities, within the torque limits. Without physics, the joints move at the velocities and stop at their limits.
    ``IsDone()`` is always True. ``SendCommand("setvelocity 0.5 0")`` is ``SetDesired([0.5, 0])``.

    Example:
        >>> controller = RaveCreateController(env, "odevelocity")
        >>> robot.SetController(controller, range(robot.GetDOF()), 0)
        True
        >>> controller.SetDesired([0.5, 0])  # [rad/s]
        True
    """

    _velocities: Floats | None = None

    def Reset(self, options: int = 0) -> None:
        """Stop driving the joints. ``options`` are not used."""
        with self._env.simulation.lock:
            super().Reset(options)
            self._drive(None)

    def _desire(self, values: Floats, T_world_base: Floats | None) -> None:
        del T_world_base
        robot, dofs = self._robot, self._robot_dofs()
        limits = robot.GetDOFVelocityLimits()[dofs]
        self._drive(np.clip(values, -limits, limits))

    def _drive(self, velocities: Floats | None) -> None:
        self._velocities = velocities
        if self._attached_robot is not None:
            loads = self._env.GetPhysicsEngine().loads(self._attached_robot.simulation_state)
            if loads is not None:
                from ravemj.engine.physics import Motor  # noqa: PLC0415 - imported with the engine

                loads.motor = None if velocities is None else Motor(self._robot_dofs(), velocities)

    def SimulationStep(self, timestep: float) -> None:
        """Move the joints by ``timestep`` [s], unless physics moves them."""
        if self._velocities is None:
            return
        if self._env.GetPhysicsEngine().dynamics is not None:
            self._drive(self._velocities)
            return
        robot, dofs = self._robot, self._robot_dofs()
        values = robot.GetDOFValues()[dofs] + timestep * self._velocities
        robot.SetDOFValues(values, dofs, CheckLimitsAction.CheckLimitsSilent)
        all_velocities = robot.GetDOFVelocities()
        all_velocities[dofs] = self._velocities
        robot.SetDOFVelocities(all_velocities, checklimits=CheckLimitsAction.Nothing)

    def _set_velocity(self, arguments: str) -> str:
        self.SetDesired(checked_numbers(arguments.split(), "setvelocity"))
        return ""

    _commands: ClassVar = {"setvelocity": _set_velocity}


class _PathPart(NamedTuple):
    """One controller of a ``MultiController``, and the positions of its DOFs among those of the ``MultiController``."""

    controller: Controller
    places: Ints


class MultiController(Controller):
    """A controller that distributes the DOFs of a robot among several controllers.

    ``RaveCreateMultiController`` makes it.

    Example:
        >>> multi = RaveCreateMultiController(env)
        >>> robot.SetController(multi)
        True
        >>> multi.AttachController(RaveCreateController(env, "IdealController"), arm.GetArmIndices(), 0)
        True
    """

    _parts: tuple[_PathPart, ...] = ()

    def AttachController(self, controller: Controller, dofindices: ArrayLike, controltransform: int) -> bool:
        """Assign DOFs to a controller.

        Args:
            controller: The controller; it is initialised here.
            dofindices: The DOF indices that it moves.
            controltransform: Whether it also moves the robot's base.

        Returns:
            True.

        Raises:
            ArgumentError: a DOF is not among those of the ``MultiController``, or is assigned already; or the base is
                assigned already.
        """
        robot = self._robot
        dofs = checked_indices(dofindices, robot.GetDOF(), "dofindices")
        own = self._robot_dofs().tolist()
        taken = {int(dof) for part in self._parts for dof in part.controller.GetControlDOFIndices()}
        for dof in dofs.tolist():
            if dof not in own or dof in taken:
                reason = "has a controller already" if dof in taken else "is not among those of the MultiController"
                raise ArgumentError(f"AttachController: dofindices: DOF {dof} {reason}")
        if controltransform and any(part.controller.IsControlTransformation() for part in self._parts):
            raise ArgumentError("AttachController: controltransform: the base has a controller already")
        with robot.simulation_state.simulation.lock:
            controller.Init(robot, dofs, controltransform)
            self._parts = (*self._parts, _PathPart(controller, np.array([own.index(dof) for dof in dofs], dtype=int)))
        return True

    def RemoveController(self, controller: Controller) -> None:
        """Remove ``controller``. Its DOFs then have no controller."""
        self._parts = tuple(part for part in self._parts if part.controller is not controller)

    def GetController(self, dof: int) -> Controller | None:
        """Return the controller of the DOF with the index ``dof``, or None."""
        owners = (part.controller for part in self._parts if dof in part.controller.GetControlDOFIndices())
        return next(owners, None)

    def Reset(self, options: int = 0) -> None:
        """Reset all controllers, each with ``options``."""
        for part in self._parts:
            part.controller.Reset(options)

    def SetPath(self, traj: Trajectory | None) -> bool:
        """Have each controller play its part of ``traj``, and return True; see ``IdealController.SetPath``."""
        return all([part.controller.SetPath(traj) for part in self._parts])

    def _desire(self, values: Floats, T_world_base: Floats | None) -> None:
        for part in self._parts:
            part.controller.SetDesired(values[part.places], T_world_base)

    def SimulationStep(self, timestep: float) -> None:
        """Advance all controllers by ``timestep`` [s]."""
        for part in self._parts:
            part.controller.SimulationStep(timestep)

    def IsDone(self) -> bool:
        """Return whether all controllers have finished their last command."""
        return all(part.controller.IsDone() for part in self._parts)

    def GetTime(self) -> float:
        """Return the time along the current path [s]."""
        return max((part.controller.GetTime() for part in self._parts), default=0.0)

    def GetTorque(self) -> Floats:
        """Return the torques that the controllers apply [N m or N], shape (n,)."""
        torques = np.zeros(len(self._robot_dofs()))
        for part in self._parts:
            torques[part.places] = part.controller.GetTorque()
        return torques


__all__ = [
    "Controller",
    "IdealController",
    "MultiController",
    "RaveCreateController",
    "RaveCreateMultiController",
    "VelocityController",
]

_KINDS: dict[str, type[Controller]] = {
    "IdealController": IdealController,
    "IdealVelocityController": VelocityController,
    "odevelocity": VelocityController,
    "GenericMultiController": MultiController,
}
CONTROLLERS = tuple(_KINDS)


def _kind_of(name: str) -> type[Controller] | None:
    return next((kind for known, kind in _KINDS.items() if known.lower() == name.lower()), None)


def RaveCreateController(env: "Environment", name: str) -> Controller | None:
    """Make a controller for ``robot.SetController``.

    Args:
        env: The environment of the robot.
        name: ``IdealController``, ``IdealVelocityController`` or ``odevelocity``; letter case does not matter.
            Arguments after a space are ignored.

    Returns:
        The controller; None for an unknown name.

    Example:
        >>> controller = RaveCreateController(env, "IdealController")
        >>> robot.SetController(controller, [0, 1], 0)
        True
    """
    word = asked_for(env, name, "RaveCreateController")[0]
    kind = _kind_of(word)
    return None if kind is None else kind(env, word)


def RaveCreateMultiController(env: "Environment", name: str = "") -> MultiController | None:
    """Make a controller that distributes the DOFs of a robot among other controllers.

    Args:
        env: The environment of the robot.
        name: ``GenericMultiController``, or empty.

    Returns:
        The controller; None for an unknown name.
    """
    word = asked_for(env, name, "RaveCreateMultiController")[0] or "GenericMultiController"
    return MultiController(env, word) if _kind_of(word) is MultiController else None
