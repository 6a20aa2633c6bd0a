"""``openravepy.planningutils``: times and smooths trajectories in OpenRAVE; ravemj does not yet.

Every function raises ``UnsupportedError``, which is a ``NotImplementedError``.
"""

from ravemj.errors import UnsupportedError
from ravemj.rave.enums import PlannerStatus

RETIMING = "retiming of trajectories"
SMOOTHING = "smoothing of trajectories"
_VERIFYING = "verifying of trajectories"
_EDITING = "conversion of trajectories"
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


def ConvertTrajectorySpecification(traj: object, spec: object) -> None:
    """Change the layout of a trajectory in place."""
    raise UnsupportedError("planningutils.ConvertTrajectorySpecification", _EDITING)


def ReverseTrajectory(traj: object) -> object:
    """Return the trajectory backwards."""
    raise UnsupportedError("planningutils.ReverseTrajectory", _EDITING)


def MergeTrajectories(listtraj: object) -> object:
    """Return one trajectory that runs several at once."""
    raise UnsupportedError("planningutils.MergeTrajectories", _EDITING)


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
