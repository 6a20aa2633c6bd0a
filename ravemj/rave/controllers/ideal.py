"""A controller that sets the commanded joint values exactly."""

import logging
from collections.abc import Callable
from typing import ClassVar, NamedTuple

import numpy as np

from ravemj.core.arguments import checked_flag, checked_kind
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.controllers.base import Controller
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.report import CollisionReport
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.body_motion import GrabChange, grab_changes
from ravemj.trajectories.groups import joint_indices

_LOG = logging.getLogger("ravemj")

_SLACK = 1e-6
"""How much farther than its speed limit allows a joint may move in a step [rad or m]; the number is OpenRAVE's."""


class _Path(NamedTuple):
    """A trajectory, and the values of it that move the robot.

    Attributes:
        trajectory: A copy of the user's trajectory.
        columns: The columns of its waypoints that hold joint values.
        dofs: The DOF indices of these values.
        moves_base: Whether its waypoints have a pose of the robot's base.
        grabs: The bodies that it has still to grab and to release.
    """

    trajectory: Trajectory
    columns: Ints
    dofs: Ints
    moves_base: bool
    grabs: list[GrabChange]


def _switch(command: str, attribute: str) -> Callable[["IdealController", str], str]:
    """Return what runs a command that switches something on or off."""

    def run(controller: "IdealController", arguments: str) -> str:
        setattr(controller, attribute, checked_flag(arguments, command))
        return ""

    return run


class IdealController(Controller):
    """The controller that robots have from the start: it sets the commanded values at once and exactly.

    ``SetDesired`` moves the robot at once, and is done with the next simulation step. ``SetPath`` plays a trajectory:
    the first step sets its first waypoint, and the path is done one step after its last waypoint. A group
    ``grab ROBOT LINK`` of the trajectory grabs the body whose ``GetEnvironmentBodyIndex()`` is its value with the link
    of this index, and releases it where the value is negative.

    The controller reports joints that exceed their velocity limits or their limits and, after
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
    _desired: "tuple[Floats, Floats | None] | None" = None
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
        with self._robot.simulation_state.simulation.lock:
            path = self._prepared(traj)
            path.trajectory.Sample(0.0)  # raises for a trajectory without times, before anything has changed
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
        """Set the values of the path at the controller's time, then advance that time.

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
        """Put the robot where a path has it at a time [s] from its start; see ``_place``."""
        point = path.trajectory.Sample(time)
        T_world_base = None
        if path.moves_base:
            spec = path.trajectory.GetConfigurationSpecification()
            T_world_base = spec.ExtractTransform(self._robot.GetTransform(), point, self._robot)
        self._place(path.dofs, point[path.columns], T_world_base, elapsed)

    def _place(self, dofs: Ints, values: Floats, T_world_base: Floats | None, elapsed: float = 0.0) -> None:
        """Set joint values and the pose of the base, if there is one, with all velocities zero.

        ``elapsed`` is the duration of the motion, for the velocity limits [s]; 0 allows any speed.
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
        """Log a problem, or raise an error after ``SetThrowExceptions 1``."""
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
