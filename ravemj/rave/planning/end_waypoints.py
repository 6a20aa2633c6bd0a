"""Further waypoints at the ends of trajectories with times."""

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

_RETIMERS = {
    "linear": "LinearTrajectoryRetimer",
    "quadratic": "ParabolicTrajectoryRetimer",
    "cubic": "CubicTrajectoryRetimer",
    "quintic": "QuinticTrajectoryRetimer",
}


class EndWaypoint:
    """A waypoint that is connected to an end of a trajectory."""

    def __init__(
        self, traj: Trajectory, spec: ConfigurationSpecification, values: ArrayLike, velocities: ArrayLike
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

    def anchor(self, index: int, replaced: int) -> int:
        """Return the waypoint that the new one is connected to, when some at the end are replaced."""
        count = self._traj.GetNumWaypoints()
        self._is_first = index == 0
        if index not in {0, count, count - replaced}:
            raise ArgumentError(f"index: is {index}, and should be 0 or {count}: only the ends can be changed")
        anchor = replaced if self._is_first else count - 1 - replaced
        if not 0 <= anchor < count:
            raise ArgumentError(f"trajectory: has {count} waypoints, which are too few")
        return anchor

    def _ends(self, anchor: int) -> tuple[Floats, Floats]:
        rates = self._spec.ConvertToDerivativeSpecification(1)
        known = np.stack([self._traj.GetWaypoint(anchor, self._spec), self._traj.GetWaypoint(anchor, rates)])
        new = np.stack([self._values, self._velocities])
        first, second = (new, known) if self._is_first else (known, new)
        return np.stack([first[0], second[0]]), np.stack([first[1], second[1]])

    def line(self, anchor: int) -> Trajectory:
        """Return the trajectory of the two points, with velocities and without times."""
        points, velocities = self._ends(anchor)
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

    def retimed(self, anchor: int, factors: tuple[float, float], plannername: str, extra: str) -> Trajectory:
        """Return the way between both points with times."""
        groups = [group for group in self._layout.GetGroups() if is_position(group)]
        name = plannername or _RETIMERS.get(groups[0].interpolation if groups else "", _RETIMERS["linear"])
        way = self.line(anchor)
        status = retimed(way, name, factors, f"<hasvelocities>1</hasvelocities>{extra}")
        if not status:
            raise RavemjError(f"the way to the new waypoint has no times: {status.description}")
        return way

    def join(self, way: Trajectory, anchor: int) -> int:
        """Put the way into the trajectory; return the index behind the last waypoint that was put in."""
        traj, column = self._traj, self._layout.GetGroupFromName(DELTATIME).offset
        rows = way.GetAllWaypoints2D(self._layout)
        if self._is_first:
            kept = traj.GetWaypoints2D(anchor, traj.GetNumWaypoints())
            kept[0, column] = rows[-1, column]
            joined = np.vstack([rows[:-1], kept])
            behind = len(rows) - 1
        else:
            joined = np.vstack([traj.GetWaypoints2D(0, anchor + 1), rows[1:]])
            behind = len(joined)
        traj.Remove(0, traj.GetNumWaypoints())
        traj.Insert(0, joined.ravel())
        return behind
