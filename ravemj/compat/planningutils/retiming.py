"""Retiming and smoothing of trajectories."""

from collections.abc import Callable, Sequence
from typing import ClassVar

from numpy.typing import ArrayLike

from ravemj.compat.planningutils.editing import ConvertTrajectorySpecification
from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.planning import PlannerParameters, PlannerStatus
from ravemj.rave.planning.names import alone, needed_planner, of_bodies, run_planner, scaled
from ravemj.rave.planning.planner import PlannerStatusCode
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory

_SMOOTHER = "ParabolicSmoother"


def RetimeActiveDOFTrajectory(
    trajectory: Trajectory,
    robot: Robot,
    hastimestamps: bool = False,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Time a trajectory of the active DOFs within their limits; collisions are ignored.

    A single waypoint keeps all its groups and gets the time 0, whatever the retimer, as in OpenRAVE.

    Args:
        trajectory: Changed in place; inactive DOFs are removed.
        robot: The robot of the active DOFs and limits.
        hastimestamps: Whether to keep existing times if the limits allow.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The retimer; empty selects ``ParabolicTrajectoryRetimer`` if the interpolation is quadratic, else
            ``LinearTrajectoryRetimer``.
        plannerparameters: Its parameters as XML text.

    Returns:
        The status; after a failure the trajectory is unchanged.

    Raises:
        openrave_exception: the retimer is unknown (``Assert``), or a waypoint is outside the limits
            (``InconsistentConstraints``).

    Example:
        >>> trajectory = RaveCreateTrajectory(env, "")
        >>> trajectory.Init(robot.GetActiveConfigurationSpecification())
        >>> trajectory.Insert(0, [0, 0, 1, 0.5])
        >>> planningutils.RetimeActiveDOFTrajectory(trajectory, robot) == PlannerStatus.HasSolution
        True
        >>> trajectory.GetDuration()
        0.1
    """
    extra = stamped(hastimestamps, plannerparameters)
    return _planned(
        trajectory, lambda: _active(robot, extra, maxvelmult, maxaccelmult), plannername or _retimer(trajectory)
    )


def RetimeTrajectory(
    trajectory: Trajectory,
    hastimestamps: bool = False,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Time a trajectory of any bodies within their limits; see ``RetimeActiveDOFTrajectory``.

    Args:
        trajectory: Changed in place.
        hastimestamps: Whether to keep existing times if the limits allow.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The retimer; empty for the default of ``RetimeActiveDOFTrajectory``.
        plannerparameters: Its parameters as XML text.
    """
    extra = stamped(hastimestamps, plannerparameters)
    return _planned(
        trajectory,
        lambda: of_bodies(trajectory, extra, maxvelmult, maxaccelmult),
        plannername or _retimer(trajectory),
    )


def RetimeAffineTrajectory(
    trajectory: Trajectory,
    maxvelocities: ArrayLike,
    maxaccelerations: ArrayLike,
    hastimestamps: bool = False,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Time a trajectory of poses within limits.

    Translations are straight, with a speed of at most the smallest velocity limit of their coordinates.

    Args:
        trajectory: Changed in place.
        maxvelocities: A velocity limit for each value.
        maxaccelerations: An acceleration limit for each value.
        hastimestamps: Whether to keep existing times if the limits allow.
        plannername: The retimer; empty for ``LinearTrajectoryRetimer``, the only one for poses.
        plannerparameters: Its parameters as XML text.

    Raises:
        openrave_exception: the number of limits is wrong (``InvalidArguments``).
    """
    extra = stamped(hastimestamps, plannerparameters)
    return _planned(
        trajectory,
        lambda: _affine(trajectory, maxvelocities, maxaccelerations, extra),
        plannername or _retimer(trajectory),
    )


def SmoothActiveDOFTrajectory(
    trajectory: Trajectory,
    robot: Robot,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Shorten and time a trajectory of the active DOFs; the result is free of collisions.

    Args:
        trajectory: Changed in place; its ends are kept.
        robot: The robot of the active DOFs and limits.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The smoother; empty for ``ParabolicSmoother``.
        plannerparameters: Its parameters as XML text.

    Returns:
        The status; after a failure the trajectory is unchanged.
    """
    return _planned(
        trajectory, lambda: _active(robot, plannerparameters, maxvelmult, maxaccelmult), plannername or _SMOOTHER
    )


def SmoothTrajectory(
    trajectory: Trajectory,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Shorten and time a trajectory of any bodies; see ``SmoothActiveDOFTrajectory``.

    Args:
        trajectory: Changed in place.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The smoother; empty for ``ParabolicSmoother``.
        plannerparameters: Its parameters as XML text.
    """
    return _planned(
        trajectory,
        lambda: of_bodies(trajectory, plannerparameters, maxvelmult, maxaccelmult),
        plannername or _SMOOTHER,
    )


def SmoothAffineTrajectory(
    trajectory: Trajectory,
    maxvelocities: ArrayLike,
    maxaccelerations: ArrayLike,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Shorten and time a trajectory of poses.

    Args:
        trajectory: Changed in place.
        maxvelocities: A velocity limit for each value.
        maxaccelerations: An acceleration limit for each value.
        plannername: The smoother; empty for ``LinearSmoother``, the only one for poses.
        plannerparameters: Its parameters as XML text.
    """
    return _planned(
        trajectory,
        lambda: _affine(trajectory, maxvelocities, maxaccelerations, plannerparameters),
        plannername or "LinearSmoother",
    )


class ActiveDOFTrajectoryRetimer(ApiObject):
    """Retimer of trajectories of the DOFs that are active at its construction.

    Args:
        robot: The robot; each call uses its current limits.
        plannername: The retimer. If it is empty, ``PlanPath`` raises an error, as in OpenRAVE.
        plannerparameters: Its parameters as XML text.

    Raises:
        openrave_exception: the retimer is unknown (``Assert``), or does not take the parameters (``InvalidArguments``).
    """

    _default: ClassVar[str] = ""

    def __init__(self, robot: Robot, plannername: str = "", plannerparameters: str = "") -> None:
        self._robot = checked_kind(robot, Robot, "robot")
        self._spec = robot.GetActiveConfigurationSpecification()
        name = plannername or self._default
        self._planner = needed_planner(robot.GetEnv(), name) if name else None
        self._extra = plannerparameters
        if self._planner is not None and not self._planner.InitPlan(robot, self._parameters(plannerparameters)):
            raise ArgumentError(f"plannerparameters: {name} does not take '{plannerparameters}'")

    def PlanPath(self, traj: Trajectory, hastimestamps: bool = False, releasegil: bool = True) -> PlannerStatus:
        """Retime a trajectory in place; see ``RetimeActiveDOFTrajectory``.

        Args:
            traj: The trajectory.
            hastimestamps: Whether to keep existing times.
            releasegil: Not used.
        """
        del releasegil
        return self._run(traj, stamped(hastimestamps, self._extra))

    def _run(self, traj: Trajectory, extra: str) -> PlannerStatus:
        if traj.GetNumWaypoints() == 1:
            return _of_one_waypoint(traj)
        if self._planner is None:
            message = "ActiveDOFTrajectoryRetimer: plannername is empty; name one, such as ParabolicTrajectoryRetimer"
            raise RavemjError(message, ErrorCode.Assert)
        self._planner.InitPlan(self._robot, self._parameters(extra))
        return self._planner.PlanPath(traj)

    def _parameters(self, extra: str) -> PlannerParameters:
        params = PlannerParameters()
        params.SetConfigurationSpecification(self._robot.GetEnv(), self._spec)
        params.SetExtraParameters(alone(extra))
        return params


class ActiveDOFTrajectorySmoother(ActiveDOFTrajectoryRetimer):
    """Smoother of trajectories of the DOFs that are active at its construction.

    The arguments are those of ``ActiveDOFTrajectoryRetimer``; an empty ``plannername`` selects ``ParabolicSmoother``.
    """

    _default = _SMOOTHER

    def PlanPath(  # pyright: ignore[reportIncompatibleMethodOverride] - OpenRAVE's arguments
        self, traj: Trajectory, releasegil: bool = True
    ) -> PlannerStatus:
        """Smooth a trajectory in place; see ``SmoothActiveDOFTrajectory``.

        Args:
            traj: The trajectory.
            releasegil: Not used.
        """
        del releasegil
        return self._run(traj, self._extra)


class AffineTrajectoryRetimer(ApiObject):
    """Retimer of several trajectories of poses.

    Args:
        plannername: The retimer; empty for ``parabolictrajectoryretimer``, which fails, as in OpenRAVE.
        plannerparameters: Its parameters as XML text.
    """

    def __init__(self, plannername: str, plannerparameters: str = "") -> None:
        self._name = plannername or "parabolictrajectoryretimer"
        self._extra = plannerparameters

    def GetPlannerName(self) -> str:
        """Return the name of the retimer."""
        return self._name

    def PlanPath(
        self,
        traj: Trajectory,
        maxvelocities: ArrayLike,
        maxaccelerations: ArrayLike,
        maxjerks: ArrayLike | bool = False,
        hastimestamps: bool = False,
        releasegil: bool = True,
    ) -> PlannerStatus:
        """Retime a trajectory in place; see ``RetimeAffineTrajectory``.

        Args:
            traj: The trajectory.
            maxvelocities: A velocity limit for each value.
            maxaccelerations: An acceleration limit for each value.
            maxjerks: Not used; a bool in its place is taken as ``hastimestamps``.
            hastimestamps: Whether to keep existing times.
            releasegil: Not used.
        """
        del releasegil
        keeps = maxjerks if isinstance(maxjerks, bool) else hastimestamps
        return RetimeAffineTrajectory(traj, maxvelocities, maxaccelerations, keeps, self._name, self._extra)


def _planned(traj: Trajectory, params: Callable[[], PlannerParameters], name: str) -> PlannerStatus:
    return _of_one_waypoint(traj) if traj.GetNumWaypoints() == 1 else run_planner(traj, params(), name)


def _of_one_waypoint(traj: Trajectory) -> PlannerStatus:
    """Add the time to a trajectory with a single waypoint, for which OpenRAVE runs no planner."""
    spec = traj.GetConfigurationSpecification()
    spec.AddDeltaTimeGroup()
    ConvertTrajectorySpecification(traj, spec)
    return PlannerStatus("there is nothing to do with one waypoint", PlannerStatusCode.HasSolution)


def _retimer(traj: Trajectory) -> str:
    """Return OpenRAVE's default retimer for the interpolation of the joint values or, without these, of the poses."""
    groups = checked_kind(traj, Trajectory, "trajectory").GetConfigurationSpecification().GetGroups()
    of_joints = [group.interpolation for group in groups if group.name.startswith("joint_values")]
    of_poses = [
        group.interpolation for group in groups if group.name.startswith(("affine_transform", "ikparam_values"))
    ]
    is_quadratic = [*of_joints[:1], *of_poses[-1:]][:1] == ["quadratic"]
    return "ParabolicTrajectoryRetimer" if is_quadratic else "LinearTrajectoryRetimer"


def _active(robot: Robot, extra: str, maxvelmult: float, maxaccelmult: float) -> PlannerParameters:
    params = PlannerParameters()
    params.SetRobotActiveJoints(robot)
    return scaled(params, extra, maxvelmult, maxaccelmult)


def _affine(traj: Trajectory, maxvelocities: ArrayLike, maxaccelerations: ArrayLike, extra: str) -> PlannerParameters:
    params = of_bodies(traj, extra)
    dof = params.GetDOF()
    given: Sequence[tuple[str, ArrayLike]] = (("maxvelocities", maxvelocities), ("maxaccelerations", maxaccelerations))
    velocities, accelerations = (checked_numbers(numbers, name).ravel() for name, numbers in given)
    for (name, _), numbers in zip(given, (velocities, accelerations), strict=True):
        if len(numbers) != dof or not (numbers >= 0).all():
            raise ArgumentError(f"{name}: are {numbers.tolist()}, and should be {dof} numbers, none below 0")
    params.SetConfigVelocityLimit(velocities)
    params.SetConfigAccelerationLimit(accelerations)
    return params


def stamped(hastimestamps: bool, extra: str) -> str:
    """Return the planner parameters ``extra`` with the option to keep times if ``hastimestamps``."""
    return f"<hastimestamps>1</hastimestamps>{extra}" if hastimestamps else extra
