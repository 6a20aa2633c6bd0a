"""Verification of trajectories and lines, and nearby configurations without collisions."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.refusal import refusing
from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Pose, normalize
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.planning.edges import nearby
from ravemj.planning.verification import Samples, flaw
from ravemj.rave.enums import ConstraintFilterOptions, Interval
from ravemj.rave.kinbody import KinBody
from ravemj.rave.planning import PlannerParameters
from ravemj.rave.planning.names import of_bodies
from ravemj.rave.report import CollisionReport
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory

_CHECK = "DynamicsCollisionConstraint"
_LINES = "constraints of accelerations, torques and perturbations along lines"

_MOST_SAMPLES = 10_000_000
"""Maximum number of samples of a trajectory; ten times as many would exhaust the memory."""


def VerifyTrajectory(
    parameters: PlannerParameters | None, trajectory: Trajectory, samplingstep: float = 0.002, releasegil: bool = True
) -> None:
    """Check that a trajectory keeps limits and constraints at all times; the robot does not move.

    It checks values, speeds, accelerations (unless velocities jump) and collisions, in time steps and at all waypoints.

    Args:
        parameters: The planning problem with its limits; by default the bodies of the trajectory with their limits.
        trajectory: A trajectory with times.
        samplingstep: The time step [s].
        releasegil: Not used.

    Raises:
        openrave_exception: the check fails (``InconsistentConstraints``); the text gives the violation and its time.

    Example:
        >>> planningutils.VerifyTrajectory(None, trajectory, 0.01)
    """
    del releasegil
    checked_kind(trajectory, Trajectory, "VerifyTrajectory: trajectory")
    if not samplingstep > 0:
        raise ArgumentError(f"VerifyTrajectory: samplingstep is {samplingstep}, and should be above 0")
    values = (of_bodies(trajectory) if parameters is None else parameters).resolved()
    spec = ConfigurationSpecification.of(values.groups)
    samples = _samples(trajectory, spec, samplingstep)
    if values.bodies is None:
        wrong = flaw(samples, values.limits(), lambda values_: True)
    else:
        with values.bodies.kept():
            wrong = flaw(samples, values.limits(), values.conditions.allowed())
    if wrong is not None:
        raise RavemjError(f"VerifyTrajectory: {wrong}", ErrorCode.InconsistentConstraints)


def _samples(traj: Trajectory, spec: ConfigurationSpecification, step: float) -> Samples:
    own, end = traj.GetConfigurationSpecification(), traj.GetDuration()
    if not abs(end) / step <= _MOST_SAMPLES:
        least = abs(end) / _MOST_SAMPLES
        raise ArgumentError(f"samplingstep: is {step:g} s for {end:g} s, and should be {least:g} s or more")
    stops = np.cumsum([own.ExtractDeltaTime(row) or 0.0 for row in traj.GetAllWaypoints2D()])
    times = np.unique(np.concatenate([np.arange(0.0, end, step), stops]))
    rates: list[Floats | None] = []
    for order in (1, 2):
        wanted = spec.ConvertToDerivativeSpecification(order)
        has_all = all(own.FindCompatibleGroup(group.name, True) for group in wanted.GetGroups())
        rates.append(traj.SamplePoints2D(times, wanted) if has_all else None)
    jumps = any(group.interpolation == "next" for group in own.GetTimeDerivativeSpecification(1).GetGroups())
    return Samples(times, traj.SamplePoints2D(times, spec), rates[0], rates[1], has_jumps=jumps)


class DynamicsCollisionConstraint(ApiObject):
    """Tests straight lines between configurations for collisions.

    Args:
        plannerparameters: The planning problem.
        checkbodies: Not used; the bodies of the parameters are tested.
        filtermask: The tests, ``ConstraintFilterOptions``.
    """

    def __init__(
        self, plannerparameters: PlannerParameters, checkbodies: object = (), filtermask: int = 0xFFFFFFFF
    ) -> None:
        del checkbodies
        self._report = CollisionReport()
        self._mask = int(filtermask)
        self.SetPlannerParameters(plannerparameters)

    def SetPlannerParameters(self, parameters: PlannerParameters) -> None:
        """Set the planning problem.

        Args:
            parameters: The planning problem.
        """
        self._parameters = checked_kind(parameters, PlannerParameters, "parameters")

    def SetFilterMask(self, filtermask: int) -> None:
        """Set the tests.

        Args:
            filtermask: ``ConstraintFilterOptions`` combined with ``|``; ``CheckSelfCollisions`` alone ignores other
                bodies.
        """
        self._mask = int(filtermask)

    SetPerturbation = refusing(f"{_CHECK}.SetPerturbation", _LINES, "self parameters")
    SetTorqueLimitMode = refusing(f"{_CHECK}.SetTorqueLimitMode", _LINES, "self torquelimitmode")
    CheckWithAccelerations = refusing(
        f"{_CHECK}.CheckWithAccelerations",
        _LINES,
        "self q0 q1 dq0 dq1 ddq0 ddq1 timeelapsed interval options filterreturn",
    )

    def GetReport(self) -> CollisionReport:
        """Return the last detected collision."""
        return self._report

    def Check(
        self,
        q0: ArrayLike,
        q1: ArrayLike,
        dq0: ArrayLike,
        dq1: ArrayLike,
        timeelapsed: float,
        interval: int = Interval.Closed,
        options: int = 0xFFFF,
        filterreturn: bool = False,
    ) -> int | dict[str, Any]:
        """Test the line between two configurations, and return the first violation; the robot is moved along it.

        Args:
            q0: Start of the line.
            q1: End of the line.
            dq0: Velocities at the start; not used.
            dq1: Velocities at the end; not used.
            timeelapsed: Duration of the motion [s].
            interval: The end points to include, an ``Interval``.
            options: The tests, ``ConstraintFilterOptions``.
            filterreturn: Whether to return a dictionary that also has the position.

        Returns:
            0 without a violation, else a bit of ``ConstraintFilterOptions``. The dictionary has it as ``returncode``.
        """
        wanted, parameters = int(options) & self._mask, self._parameters
        code = parameters.CheckPathAllConstraints(q0, q1, dq0, dq1, timeelapsed, interval, wanted)
        self._report = CollisionReport()
        invalid = np.zeros(0)
        if code:
            invalid = parameters.GetStateFn()
            collisions = int(ConstraintFilterOptions.CheckEnvCollisions | ConstraintFilterOptions.CheckSelfCollisions)
            if code & collisions:
                self._report = parameters.report(invalid, wanted)
        if not filterreturn:
            return code
        start, end = checked_numbers(q0, "q0"), checked_numbers(q1, "q1")
        line = np.linalg.norm(end - start)
        part = float(np.linalg.norm(invalid - start) / line) if code and line > 0 else 0.0
        return {
            "returncode": code,
            "invalidvalues": invalid,
            "invalidvelocities": np.zeros(len(invalid)),
            "fTimeWhenInvalid": part * float(timeelapsed),
            "configurations": np.zeros(0),
            "configurationtimes": np.zeros(0),
            "reportstr": str(self._report) if code else "",
        }


def JitterCurrentConfiguration(
    plannerparameters: PlannerParameters, maxiterations: int = 5000, jitter: float = 0.015, perturbation: float = 1e-5
) -> bool:
    """Move to a nearby configuration without collisions.

    Args:
        plannerparameters: The planning problem.
        maxiterations: Maximum number of configurations.
        jitter: Maximum change of each value [rad or m].
        perturbation: Clearance: the configuration has to be free also with all values increased, and all decreased, by
            this [rad or m].

    Returns:
        Whether a free configuration was found. If the present configuration is free, nothing moves.
    """
    checked_kind(plannerparameters, PlannerParameters, "plannerparameters")
    values = plannerparameters.resolved()
    if values.bodies is None:
        raise ArgumentError("JitterCurrentConfiguration: nothing moves; call SetRobotActiveJoints(robot) first")
    allowed, bodies = values.conditions.allowed(), values.bodies
    random = np.random.default_rng(int(values.numbers["_nrandomgeneratorseed"]))

    def roomy(configuration: Floats) -> bool:
        return (
            allowed(configuration) and allowed(configuration + perturbation) and allowed(configuration - perturbation)
        )

    with bodies.kept():
        start = bodies.values()
        moved = nearby(values.space(), start, roomy, maxiterations, jitter, random)
    if moved is not None and moved is not start:
        with bodies.lock:
            bodies.move(moved)
    return moved is not None


def JitterActiveDOF(
    robot: Robot, maxiterations: int = 5000, maxjitter: float = 0.015, perturbation: float = 1e-5
) -> int:
    """Move the active DOFs slightly, out of collision; OpenRAVE 0.9's name.

    Args:
        robot: The robot.
        maxiterations: Maximum number of configurations.
        maxjitter: Maximum change of each value [rad or m].
        perturbation: Clearance, as for ``JitterCurrentConfiguration`` [rad or m].

    Returns:
        0 if the robot need not move, 1 if it moved, -1 if no configuration was found.
    """
    params = PlannerParameters()
    params.SetRobotActiveJoints(robot)
    before = robot.GetActiveDOFValues()
    if not JitterCurrentConfiguration(params, maxiterations, maxjitter, perturbation):
        return -1
    return int((robot.GetActiveDOFValues() != before).any())


def JitterTransform(body: KinBody, jitter: float, maxiterations: int = 1000) -> bool:
    """Move a body slightly, out of collision.

    Args:
        body: The body.
        jitter: Maximum translation along each axis [m], and rotation about each [rad].
        maxiterations: Maximum number of poses.

    Returns:
        Whether a free pose was found. If the present one is free, nothing moves.
    """
    checked_kind(body, KinBody, "JitterTransform: body")
    reach = float(checked_numbers(jitter, "JitterTransform: jitter")[0])
    env, random = body.GetEnv(), np.random.default_rng(0)
    with env.simulation.lock:
        if not env.CheckCollision(body):
            return True
        before = body.GetTransform()
        for attempt in range(maxiterations):
            size = reach * (attempt + 1) / maxiterations
            x, y, z = random.uniform(-size, size, 3).tolist()
            half = random.uniform(-size, size, 3) / 2
            a, b, c = half.tolist()
            motion = Pose((x, y, z), normalize((1.0, a, b, c))).matrix()
            moved = before.copy()
            moved[:3, :3] = motion[:3, :3] @ before[:3, :3]
            moved[:3, 3] += motion[:3, 3]
            body.SetTransform(moved)
            if not env.CheckCollision(body):
                return True
        body.SetTransform(before)
    return False
