"""Further waypoints at the ends of trajectories with times."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.errors import RavemjError
from ravemj.rave.planning.end_waypoints import EndWaypoint
from ravemj.rave.planning.names import retimed
from ravemj.rave.planning.planner import Planner
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory


def InsertActiveDOFWaypointWithRetiming(
    index: int,
    dofvalues: ArrayLike,
    dofvelocities: ArrayLike,
    trajectory: Trajectory,
    robot: Robot,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> int:
    """Put a waypoint of the active DOFs before or behind a trajectory with times, and retime the way to it.

    Args:
        index: 0: before; ``trajectory.GetNumWaypoints()``: behind.
        dofvalues: Its active values.
        dofvelocities: Its velocities.
        trajectory: Changed in place.
        robot: Whose active DOFs.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The retimer; empty: the one for the trajectory's interpolation.
        plannerparameters: Its parameters as XML text.

    Returns:
        Index behind the last waypoint that was put in.

    Raises:
        openrave_exception: ``index`` is in the middle (``InvalidArguments``), or there are no such times.
    """
    checked_kind(robot, Robot, "InsertActiveDOFWaypointWithRetiming: robot")
    new = EndWaypoint(trajectory, robot.GetActiveConfigurationSpecification(), dofvalues, dofvelocities, index)
    return new.join(new.retimed((maxvelmult, maxaccelmult), plannername, plannerparameters))


def ExtendActiveDOFWaypoint(
    index: int,
    dofvalues: ArrayLike,
    dofvelocities: ArrayLike,
    trajectory: Trajectory,
    robot: Robot,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
) -> int:
    """Let a trajectory with times start or end elsewhere: its first or last waypoint is replaced by another one.

    Args:
        index: 0: the start; the number of waypoints, or one less: the end.
        dofvalues: Active values of the new end.
        dofvelocities: Its velocities.
        trajectory: Changed in place.
        robot: Whose active DOFs.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The retimer; empty: the one for the trajectory's interpolation.

    Returns:
        Index behind the last waypoint that was put in.

    Raises:
        openrave_exception: ``index`` is in the middle (``InvalidArguments``), or there are no such times.
    """
    checked_kind(robot, Robot, "ExtendActiveDOFWaypoint: robot")
    new = EndWaypoint(trajectory, robot.GetActiveConfigurationSpecification(), dofvalues, dofvelocities, index, 1)
    return new.join(new.retimed((maxvelmult, maxaccelmult), plannername, ""))


def ExtendWaypoint(
    index: int, dofvalues: ArrayLike, dofvelocities: ArrayLike, trajectory: Trajectory, planner: Planner
) -> int:
    """Let a trajectory with times start or end elsewhere; see ``ExtendActiveDOFWaypoint``.

    Args:
        index: 0: the start; the number of waypoints, or one less: the end.
        dofvalues: Values of the new end.
        dofvelocities: Its velocities.
        trajectory: Changed in place.
        planner: The retimer, whose name counts.

    Returns:
        Index behind the last waypoint that was put in.
    """
    name = checked_kind(planner, Planner, "ExtendWaypoint: planner").GetXMLId()
    new = EndWaypoint(trajectory, _positions(trajectory), dofvalues, dofvelocities, index, 1)
    return new.join(new.retimed((1.0, 1.0), name, ""))


def InsertWaypointWithSmoothing(
    index: int,
    dofvalues: ArrayLike,
    dofvelocities: ArrayLike,
    trajectory: Trajectory,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
) -> int:
    """Put a waypoint before or behind a trajectory with times, and smooth the way to it.

    Args:
        index: 0: before; ``trajectory.GetNumWaypoints()``: behind.
        dofvalues: Its values.
        dofvelocities: Its velocities, which should be 0.
        trajectory: Changed in place.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The smoother; empty: ``ParabolicSmoother``.

    Returns:
        Index behind the last waypoint that was put in.

    Raises:
        openrave_exception: ``index`` is in the middle (``InvalidArguments``), or there is no such way.
    """
    new = EndWaypoint(trajectory, _positions(trajectory), dofvalues, dofvelocities, index)
    way = new.line()
    status = retimed(way, plannername or "ParabolicSmoother", (maxvelmult, maxaccelmult), "")
    if not status:
        raise RavemjError(f"InsertWaypointWithSmoothing: {status.description}")
    return new.join(way)


def _positions(traj: Trajectory) -> ConfigurationSpecification:
    checked_kind(traj, Trajectory, "trajectory")
    return traj.GetConfigurationSpecification().GetTimeDerivativeSpecification(0)
