"""Extends a timed trajectory by a waypoint before its first or after its last one."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, RavemjError
from ravemj.rave.planning.names import retimed
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.groups import DELTATIME, is_position

_RETIMERS = {  # by the interpolation of the trajectory, so that the new segment continues it in the same way
    "linear": "LinearTrajectoryRetimer",
    "quadratic": "ParabolicTrajectoryRetimer",
    "cubic": "CubicTrajectoryRetimer",
    "quintic": "QuinticTrajectoryRetimer",
}


class EndWaypoint:
    """A waypoint to be connected with one end of a timed trajectory.

    Args:
        traj: The trajectory, with times.
        spec: The layout of ``values``.
        values: The new waypoint, shape (dof,).
        velocities: The velocities at the new waypoint, shape (dof,).
        index: The place of the new waypoint: 0, or the number of waypoints.
        replaced: How many existing waypoints at that end the new one replaces.

    Raises:
        ArgumentError: the trajectory has no times or too few waypoints, the values have another shape, or the index is
            not an end.
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
        checked_kind(traj, Trajectory, "trajectory")
        self._traj = traj
        self._layout = traj.GetConfigurationSpecification()
        if self._layout.FindCompatibleGroup(DELTATIME, True) is None or not traj.GetNumWaypoints():
            raise ArgumentError("trajectory: should have waypoints with times")
        spec.ResetGroupOffsets()
        self._spec = spec
        dof = spec.GetDOF()
        self._values = checked_vector(values, dof, "dofvalues")
        self._velocities = checked_vector(velocities, dof, "dofvelocities")
        count = traj.GetNumWaypoints()
        self._is_first = index == 0
        if index not in {0, count, count - replaced}:
            raise ArgumentError(f"index: is {index}, and should be 0 or {count}: only the ends can be changed")
        self._anchor = replaced if self._is_first else count - 1 - replaced  # the waypoint to connect with
        if not 0 <= self._anchor < count:
            raise ArgumentError(f"trajectory: has {count} waypoints, which are too few")

    def _ends(self) -> tuple[Floats, Floats]:
        rates = self._spec.ConvertToDerivativeSpecification(1)
        known = np.stack(
            [self._traj.GetWaypoint(self._anchor, self._spec), self._traj.GetWaypoint(self._anchor, rates)]
        )
        new = np.stack([self._values, self._velocities])
        first, second = (new, known) if self._is_first else (known, new)
        return np.stack([first[0], second[0]]), np.stack([first[1], second[1]])

    def line(self) -> Trajectory:
        """Return a trajectory of the two waypoints, with velocities and without times."""
        points, velocities = self._ends()
        layout = ConfigurationSpecification.of(self._spec.GetGroups())
        layout.AddDerivativeGroups(1)
        way = Trajectory(self._traj.GetEnv(), "")
        way.Init(layout)
        dof = self._spec.GetDOF()
        rows = np.zeros((2, layout.GetDOF()))
        rows[:, :dof] = points
        rows[:, dof:] = velocities
        way.Insert(0, rows.ravel())
        return way

    def retimed(self, factors: tuple[float, float], plannername: str, extra: str) -> Trajectory:
        """Return the timed segment between the two waypoints, with factors of the velocity and acceleration limits.

        An empty name selects the retimer that fits the interpolation of the trajectory.

        Raises:
            RavemjError: the retimer finds no times.
        """
        groups = [group for group in self._layout.GetGroups() if is_position(group)]
        name = plannername or _RETIMERS.get(groups[0].interpolation if groups else "", _RETIMERS["linear"])
        way = self.line()
        status = retimed(way, name, factors, f"<hasvelocities>1</hasvelocities>{extra}")
        if not status:
            raise RavemjError(f"the way to the new waypoint has no times: {status.description}")
        return way

    def join(self, way: Trajectory) -> int:
        """Insert the segment into the trajectory, and return the index after the last inserted waypoint."""
        traj, column = self._traj, self._layout.GetGroupFromName(DELTATIME).offset
        rows = way.GetAllWaypoints2D(self._layout)
        if self._is_first:
            kept = traj.GetWaypoints2D(self._anchor, traj.GetNumWaypoints())
            kept[0, column] = rows[-1, column]  # the old first waypoint now comes after a segment that takes time
            joined = np.vstack([rows[:-1], kept])
            behind = len(rows) - 1
        else:
            joined = np.vstack([traj.GetWaypoints2D(0, self._anchor + 1), rows[1:]])
            behind = len(joined)
        traj.Remove(0, traj.GetNumWaypoints())
        traj.Insert(0, joined.ravel())
        return behind
