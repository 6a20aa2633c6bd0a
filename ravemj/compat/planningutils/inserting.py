"""Insertion of waypoints at the ends of timed trajectories."""

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
    """Insert a waypoint of the active DOFs before or after a timed trajectory, and retime the segment to it.

    Args:
        index: 0 inserts before, ``trajectory.GetNumWaypoints()`` after it.
        dofvalues: The active values of the waypoint.
        dofvelocities: The velocities at the waypoint.
        trajectory: Changed in place.
        robot: The robot of the active DOFs.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The retimer; empty for that of the trajectory's interpolation.
        plannerparameters: Its parameters as XML text.

    Returns:
        Index after the last inserted waypoint.

    Raises:
        openrave_exception: ``index`` is in the middle (``InvalidArguments``), or retiming fails.
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
    """Replace the first or last waypoint of a timed trajectory by another one, and retime the segment to it.

    Args:
        index: 0 replaces the start; the number of waypoints, or one less, the end.
        dofvalues: Active values of the new end.
        dofvelocities: Its velocities.
        trajectory: Changed in place.
        robot: The robot of the active DOFs.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The retimer; empty for that of the trajectory's interpolation.

    Returns:
        Index after the last inserted waypoint.

    Raises:
        openrave_exception: ``index`` is in the middle (``InvalidArguments``), or retiming fails.
    """
    checked_kind(robot, Robot, "ExtendActiveDOFWaypoint: robot")
    new = EndWaypoint(trajectory, robot.GetActiveConfigurationSpecification(), dofvalues, dofvelocities, index, 1)
    return new.join(new.retimed((maxvelmult, maxaccelmult), plannername, ""))


def ExtendWaypoint(
    index: int, dofvalues: ArrayLike, dofvelocities: ArrayLike, trajectory: Trajectory, planner: Planner
) -> int:
    """Replace the first or last waypoint of a timed trajectory; see ``ExtendActiveDOFWaypoint``.

    Args:
        index: 0 replaces the start; the number of waypoints, or one less, the end.
        dofvalues: Values of the new end.
        dofvelocities: Its velocities.
        trajectory: Changed in place.
        planner: The retimer, of which only the name is used.

    Returns:
        Index after the last inserted waypoint.
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
    """Insert a waypoint before or after a timed trajectory, and smooth the segment to it.

    Args:
        index: 0 inserts before, ``trajectory.GetNumWaypoints()`` after it.
        dofvalues: The values of the waypoint.
        dofvelocities: The velocities at the waypoint, which should be 0.
        trajectory: Changed in place.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
        plannername: The smoother; empty for ``ParabolicSmoother``.

    Returns:
        Index after the last inserted waypoint.

    Raises:
        openrave_exception: ``index`` is in the middle (``InvalidArguments``), or smoothing fails.
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
