"""``openravepy.planningutils``: reverses, merges and converts trajectories.

OpenRAVE's functions that retime or smooth them raise ``UnsupportedError``, which is a ``NotImplementedError``.
"""

import operator
from collections.abc import Sequence
from functools import reduce

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.rave.enums import PlannerStatus
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.groups import DELTATIME

RETIMING = "retiming of trajectories"
SMOOTHING = "smoothing of trajectories"
_VERIFYING = "verifying of trajectories"
_ODD_DERIVATIVES = ("velocities", "jerks")
_JITTERING = "search for poses without collisions"


def RetimeActiveDOFTrajectory(
    traj: object,
    robot: object,
    hastimestamps: bool = False,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Give a trajectory of the active DOFs times that respect the limits."""
    raise UnsupportedError("planningutils.RetimeActiveDOFTrajectory", RETIMING)


def RetimeAffineTrajectory(
    traj: object,
    maxvelocities: object,
    maxaccelerations: object,
    hastimestamps: bool = False,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Give a trajectory of poses times that respect the limits."""
    raise UnsupportedError("planningutils.RetimeAffineTrajectory", RETIMING)


def RetimeTrajectory(
    traj: object,
    hastimestamps: bool = False,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Give a trajectory of any bodies times that respect the limits."""
    raise UnsupportedError("planningutils.RetimeTrajectory", RETIMING)


def SmoothActiveDOFTrajectory(
    traj: object,
    robot: object,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Shorten and time a trajectory of the active DOFs."""
    raise UnsupportedError("planningutils.SmoothActiveDOFTrajectory", SMOOTHING)


def SmoothAffineTrajectory(
    traj: object, maxvelocities: object, maxaccelerations: object, plannername: str = "", plannerparameters: str = ""
) -> PlannerStatus:
    """Shorten and time a trajectory of poses."""
    raise UnsupportedError("planningutils.SmoothAffineTrajectory", SMOOTHING)


def SmoothTrajectory(
    traj: object,
    maxvelmult: float = 1.0,
    maxaccelmult: float = 1.0,
    plannername: str = "",
    plannerparameters: str = "",
) -> PlannerStatus:
    """Shorten and time a trajectory of any bodies."""
    raise UnsupportedError("planningutils.SmoothTrajectory", SMOOTHING)


def ConvertTrajectorySpecification(traj: Trajectory, spec: ConfigurationSpecification) -> None:
    """Change the layout of a trajectory in place; what the trajectory lacks is taken from the bodies as they are.

    Args:
        traj: The trajectory.
        spec: The new layout.
    """
    rows = traj.GetAllWaypoints2D(spec)
    traj.Init(spec)
    traj.Insert(0, rows.ravel())


def ReverseTrajectory(traj: Trajectory) -> Trajectory:
    """Return the trajectory backwards, in a new one.

    The times between waypoints are kept, and velocities change their sign.

    Example:
        >>> back = planningutils.ReverseTrajectory(traj)
    """
    spec = traj.GetConfigurationSpecification()
    rows = traj.GetAllWaypoints2D()[::-1]
    for group in spec.GetGroups():
        if group.kind == DELTATIME:
            rows[:, group.columns] = np.roll(rows[:, group.columns], 1, axis=0)
            rows[:1, group.columns] = 0
        elif group.kind.endswith(_ODD_DERIVATIVES):
            rows[:, group.columns] *= -1
    return _made(traj, spec, rows)


def MergeTrajectories(listtraj: Sequence[Trajectory]) -> Trajectory:
    """Return one trajectory that runs several at once, with a waypoint wherever one of them has one.

    Args:
        listtraj: Trajectories with times; each stays at its last waypoint when it is over.

    Raises:
        ArgumentError: there are none.
    """
    if not listtraj:
        raise ArgumentError("listtraj: is empty, and should have trajectories")
    spec = reduce(operator.add, (traj.GetConfigurationSpecification() for traj in listtraj))
    times = np.unique(np.concatenate([np.cumsum(_deltas(traj)) for traj in listtraj]))
    rows = np.zeros((len(times), spec.GetDOF()))
    for traj in listtraj:
        samples = np.array([traj.Sample(time) for time in times.tolist()])
        own = traj.GetConfigurationSpecification()
        rows = own.ConvertDataFromPrevious(rows.ravel(), spec, samples.ravel(), len(times), None).reshape(rows.shape)
    rows[:, spec.GetGroupFromName(DELTATIME).offset] = np.diff(times, prepend=0)
    return _made(listtraj[0], spec, rows)


def _deltas(traj: Trajectory) -> Floats:
    """Return the times between waypoints [s]."""
    column = traj.GetConfigurationSpecification().GetGroupFromName(DELTATIME).columns
    return traj.GetAllWaypoints2D()[:, column].ravel()


def _made(like: Trajectory, spec: ConfigurationSpecification, rows: Floats) -> Trajectory:
    made = Trajectory(like.GetEnv(), like.GetXMLId())
    made.Init(spec)
    made.Insert(0, rows.ravel())
    return made


def VerifyTrajectory(parameters: object, traj: object, samplingstep: float = 0.002) -> None:
    """Raise where a trajectory breaks limits or constraints."""
    raise UnsupportedError("planningutils.VerifyTrajectory", _VERIFYING)


def JitterActiveDOF(
    robot: object, maxiterations: int = 5000, maxjitter: float = 0.015, perturbation: float = 1e-5
) -> int:
    """Move the active DOFs a little, out of collision."""
    raise UnsupportedError("planningutils.JitterActiveDOF", _JITTERING)


def JitterTransform(body: object, maxjitter: float, maxiterations: int = 1000) -> bool:
    """Move a body a little, out of collision."""
    raise UnsupportedError("planningutils.JitterTransform", _JITTERING)
