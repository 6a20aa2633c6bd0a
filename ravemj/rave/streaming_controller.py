"""Controller that sends a trajectory to a real robot."""

import math

import numpy as np

from ravemj.core.arrays import checked_number, checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.controllers import Controller
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory
from ravemj.robots.streaming import Feedback, Guard, MotionRows, Send, Stream


class StreamingController(Controller):
    """Controller that calls a user function with the values of a trajectory, in real time.

    The function sends them to the real robot; nothing else does. ``SetPath`` checks the trajectory as
    ``robot.to_joint_trajectory`` does before anything is sent. In simulation time, the robot of the environment follows
    the measured values, else the sent ones.

    The motion stops with a hold at Ctrl-C, when the script ends, when ``send`` or ``feedback`` raises an exception, and
    when the measured state is too far away or too old. A hold sends the last measured values, else the last sent ones,
    with velocities of 0, once a period for 0.5 s; after an exception of ``send`` only one attempt is made. ``IsDone()``
    then raises the error until the next ``SetPath``. A late period delays the rest of the motion: values are never
    skipped, nor sent in a burst. A rate more than 10 % too low is logged as a warning.

    This is no safety device: an emergency stop is hardware.

    Args:
        robot: The robot that moves; ``robot.SetController(controller)`` sets it, too.
        send: Called with the time of the motion [s], the values of ``GetControlDOFIndices()`` [rad or m] and their
            velocities, in a thread of its own. It should return within a period.
        rate: Calls per second [Hz].
        feedback: Returns the time of the measurement (``time.monotonic()``) and the values of
            ``GetControlDOFIndices()``; None if there is no measurement yet.
        tolerance: Largest distance of a measured value from the motion [rad or m].
        stale: Largest age of the measured state [s].

    Raises:
        ArgumentError: ``send`` or ``feedback`` cannot be called, or a number is not positive.

    Example:
        >>> controller = ravemj.StreamingController(robot, lambda time, values, velocities: print(time, values))
        >>> robot.SetController(controller)
        True
        >>> controller.SetPath(trajectory)
        True
        >>> robot.WaitForController(0)
        True
    """

    def __init__(
        self,
        robot: Robot,
        send: Send,
        *,
        rate: float = 100.0,
        feedback: Feedback | None = None,
        tolerance: float = 0.1,
        stale: float = 0.5,
    ) -> None:
        super().__init__(robot.GetEnv(), "StreamingController")
        for name, function in (("send", send), ("feedback", feedback or send)):
            if not callable(function):
                raise ArgumentError(f"{name}: {function!r} cannot be called")
        self._send, self._rate = send, checked_number(rate, "rate", 1e-3, " Hz")
        limits = checked_number(tolerance, "tolerance", 0.0), checked_number(stale, "stale", 0.0, " s")
        self._guard = Guard(feedback, *(limits if feedback else (math.inf, math.inf)))
        self._stream: Stream | None = None

    def SetPath(self, traj: Trajectory | None) -> bool:
        """Send a trajectory to the robot, from now on.

        Args:
            traj: A trajectory of the joints that the controller moves, at rest at both ends. It has to start within
                0.01 rad or m of the measured state, if there is ``feedback``, else of the robot in the environment.

        Returns:
            True.

        Raises:
            openrave_exception: a check fails, nothing is measured yet, or another path is still running. Nothing is
                sent then.
        """
        if traj is None:
            raise RavemjError("SetPath: traj is None; Reset() stops a path")
        if self._stream is not None and not self._is_done and self._stream.is_running:
            raise RavemjError(
                "SetPath: a path is running; wait for IsDone(), or Reset() it first", ErrorCode.InvalidState
            )
        robot, dofs = self._robot, self._robot_dofs()
        state = robot.GetDOFValues()
        if self._guard.feedback is not None:
            measured = self._guard.feedback()
            if measured is None:
                raise RavemjError("SetPath: feedback has no measurement yet", ErrorCode.NotInitialized)
            state[dofs] = checked_vector(measured[1], len(dofs), "feedback")
        rows = self._rows(traj, state)
        if self._stream is not None and self._stream.is_running:
            self._stream.join()  # it holds after a Reset
        self._stream = Stream(rows, self._send, 1 / self._rate, self._guard)
        self._is_done = False
        self._stream.start()
        self._env.clock.wake()
        return True

    def _rows(self, traj: Trajectory, state: Floats) -> MotionRows:
        from ravemj.manipulation.joint_trajectories import Joints  # noqa: PLC0415 - rarely wanted

        robot, dofs = self._robot, self._robot_dofs()
        joints = Joints(robot.simulation_state, dofs.tolist())
        points = robot.to_joint_trajectory(traj, rate=self._rate, start=state)
        others = [name for name in points.joint_names if name not in joints.names]
        if others:
            raise ArgumentError(f"SetPath: the trajectory moves joint '{others[0]}', which the controller does not")
        columns = [joints.names.index(name) for name in points.joint_names]
        assert points.velocities is not None, "only moving motions have none"
        values, velocities = np.tile(state[dofs], (len(points.times), 1)), np.zeros((len(points.times), len(dofs)))
        values[:, columns], velocities[:, columns] = points.positions, points.velocities
        return MotionRows(points.times, values, velocities, joints.names, joints.turn)

    def IsDone(self) -> bool:
        """Return whether all values were sent.

        Raises:
            Exception: the motion was stopped: the exception of ``send`` or ``feedback``, or an ``openrave_exception``.
        """
        if self._is_done or self._stream is None:
            return True
        if not self._stream.is_running and self._stream.failure is not None:
            raise self._stream.failure
        return not self._stream.is_running

    def GetTime(self) -> float:
        """Return the time along the current path [s]."""
        return 0.0 if self._stream is None else self._stream.time

    def Reset(self, options: int = 0) -> None:
        """Stop the motion with a hold of 0.5 s; ``options`` are not used."""
        if self._stream is not None:
            self._stream.stop("Reset()")
        super().Reset(options)

    def SimulationStep(self, timestep: float) -> None:
        """Move the robot of the environment to the measured, else the sent values; ``timestep`` is not used."""
        latest = None if self._stream is None else self._stream.latest
        if latest is not None:
            self._robot.SetDOFValues(latest, self._robot_dofs(), CheckLimitsAction.Nothing)
