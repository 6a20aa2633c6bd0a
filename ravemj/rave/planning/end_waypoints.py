"""Extension of a timed trajectory by a waypoint before its start or after its end."""

from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_vector
from ravemj.errors import RavemjError
from ravemj.rave.planning.names import retimed
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.extension import Extension

_RETIMERS = {  # by the interpolation of the trajectory, so that the new segment continues it in the same way
    "": "ParabolicTrajectoryRetimer",
    "linear": "LinearTrajectoryRetimer",
    "quadratic": "ParabolicTrajectoryRetimer",
    "cubic": "CubicTrajectoryRetimer",
    "quintic": "QuinticTrajectoryRetimer",
}


class EndWaypoint:
    """Waypoint to connect to one end of a timed trajectory.

    Args:
        traj: The trajectory, with times.
        spec: The layout of ``values``.
        values: The new waypoint, shape (dof,).
        velocities: The velocities at the new waypoint, shape (dof,).
        index: The index of the new waypoint: 0, or the number of waypoints.
        replaced: The number of existing waypoints at that end that the new one replaces.

    Raises:
        ArgumentError: the trajectory has no times or too few waypoints, the shape of the values is wrong, or the index
            is not an end.
    """

    def __init__(
        self,
        traj: Trajectory,
        spec: ConfigurationSpecification,
        values: ArrayLike,
        velocities: ArrayLike,
        index: int,
        replaced: int = 0,
    ) -> None:
        self._traj = checked_kind(traj, Trajectory, "trajectory")
        new = checked_vector(values, spec.GetDOF(), "dofvalues")
        rates = checked_vector(velocities, spec.GetDOF(), "dofvelocities")
        find_body = traj.GetEnv().simulation.body
        self._extension = Extension(traj.waypoints, spec.GetGroups(), new, rates, index, replaced, find_body)

    def line(self) -> Trajectory:
        """Return an untimed trajectory of the adjacent old waypoint and the new one, with velocities."""
        way = Trajectory(self._traj.GetEnv(), "")
        way.set_waypoints(self._extension.segment())
        return way

    def retimed(self, factors: tuple[float, float], plannername: str, extra: str) -> Trajectory:
        """Return the timed segment between the adjacent old waypoint and the new one.

        ``factors`` scale the velocity and acceleration limits. ``plannername`` selects the retimer; if it is empty, the
        retimer matches the trajectory's interpolation. ``extra`` is XML of further planner parameters.

        Raises:
            RavemjError: the retimer fails.
        """
        name = plannername or _RETIMERS.get(self._extension.interpolation, _RETIMERS["linear"])
        way = self.line()
        status = retimed(way, name, factors, f"<hasvelocities>1</hasvelocities>{extra}")
        if not status:
            raise RavemjError(f"the way to the new waypoint has no times: {status.description}")
        return way

    def join(self, way: Trajectory) -> int:
        """Insert the timed segment ``way`` into the trajectory; return the index after the last inserted waypoint."""
        joined, behind = self._extension.joined(way.waypoints)
        self._traj.set_waypoints(joined)
        return behind
