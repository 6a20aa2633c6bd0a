"""Planners by their names."""

import logging
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, ErrorCode, RavemjError, UnsupportedError
from ravemj.planning.retiming import topp_ra
from ravemj.rave.interface import checked_environment
from ravemj.rave.planning.hand_planners import GraspGradient, WorkspaceTrajectoryTracker
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.path_planners import BasicRrt, BiRrt, ExplorationRrt, RaStar
from ravemj.rave.planning.planner import Planner
from ravemj.rave.planning.processing import TRAJECTORY_PLANNERS
from ravemj.rave.planning.retimers import TOPP_RA
from ravemj.rave.planning.status import PlannerStatus
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.groups import is_position

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

_LOG = logging.getLogger("ravemj")

PLANNERS: Mapping[str, "Callable[[Environment, str], Planner]"] = {
    "birrt": BiRrt,
    "basicrrt": BasicRrt,
    "explorationrrt": ExplorationRrt,
    "ra*": RaStar,
    "rastar": RaStar,
    "workspacetrajectorytracker": WorkspaceTrajectoryTracker,
    "graspgradient": GraspGradient,
    **TRAJECTORY_PLANNERS,
}
"""What plans, by names in lower case."""

MISSING: Mapping[str, str] = {"grasper": "planning of grasps"}
"""Names of OpenRAVE's own planners, in lower case, with what ravemj lacks to have them."""


def RaveCreatePlanner(env: "Environment", name: str) -> Planner | None:
    """Make a planner.

    Args:
        env: The environment.
        name: In any letter case: ``birrt``, ``BasicRRT``, ``ExplorationRRT``, ``RAStar``,
            ``WorkspaceTrajectoryTracker``, ``GraspGradient``; the retimers
            ``LinearTrajectoryRetimer``, ``ParabolicTrajectoryRetimer``, ``CubicTrajectoryRetimer``,
            ``QuinticTrajectoryRetimer``, and with the extra ``retiming`` ``ToppraTrajectoryRetimer``; the smoothers
            ``LinearSmoother``, ``shortcut_linear``, ``ParabolicSmoother``, ``CubicSmoother``, ``QuinticSmoother``;
            with the extra ``planning``, the planners of OMPL: ``OMPL_RRTConnect``, ``OMPL_RRTstar``, ``OMPL_BITstar``,
            ``OMPL_PRM`` and so on.

    Returns:
        The planner; None for a name that OpenRAVE does not know either.

    Raises:
        UnsupportedError: the planner is another one of OpenRAVE's own.

    Example:
        >>> planner = RaveCreatePlanner(env, "birrt")
    """
    checked_environment(env, "RaveCreatePlanner")
    checked_kind(name, str, "RaveCreatePlanner: name", "a text")
    word = next(iter(name.split()), "")
    if word.lower() in MISSING:
        raise UnsupportedError(f"planner '{word}'", MISSING[word.lower()])
    make = _maker(word)
    if make is None:
        _LOG.warning("there is no planner '%s'", name)
        return None
    return make(env, word)


def is_planner(name: str) -> bool:
    """Return whether there is a planner of a name."""
    return _maker(name) is not None


def _maker(name: str) -> "Callable[[Environment, str], Planner] | None":
    if name.lower() in TOPP_RA and not topp_ra.is_installed():
        _LOG.warning("planner '%s' needs toppra; install it: pip install \"ravemj[retiming]\"", name)
        return None
    if not name.lower().startswith("ompl_"):
        return PLANNERS.get(name.lower())
    from ravemj.rave.planning.ompl_planners import OmplPlanner, is_ompl_planner  # noqa: PLC0415 - slow to import

    return OmplPlanner if is_ompl_planner(name) else None


def needed_planner(env: "Environment", name: str) -> Planner:
    """Return a planner.

    Raises:
        RavemjError: there is none of that name.
    """
    planner = RaveCreatePlanner(env, name)
    if planner is None:
        raise RavemjError(f"there is no planner '{name}'", ErrorCode.Assert)
    return planner


def run_planner(traj: Trajectory, params: PlannerParameters, name: str) -> PlannerStatus:
    """Let a planner work on a trajectory.

    Raises:
        RavemjError: there is none of that name.
    """
    planner = needed_planner(traj.GetEnv(), name)
    planner.InitPlan(None, params)
    return planner.PlanPath(traj)


def retimed(traj: Trajectory, name: str, factors: tuple[float, float] = (1.0, 1.0), extra: str = "") -> PlannerStatus:
    """Let a retimer or smoother work on a trajectory of any bodies.

    Args:
        traj: Changed in place.
        name: Which one.
        factors: Of the velocity and of the acceleration limits.
        extra: Its parameters as XML text.
    """
    return run_planner(traj, of_bodies(traj, extra, *factors), name)


def of_bodies(
    traj: Trajectory, extra: str = "", maxvelmult: float = 1.0, maxaccelmult: float = 1.0
) -> PlannerParameters:
    """Return parameters for the joints and poses that a trajectory is about.

    Args:
        traj: The trajectory.
        extra: Further parameters as XML text.
        maxvelmult: Factor of the velocity limits.
        maxaccelmult: Factor of the acceleration limits.
    """
    spec = ConfigurationSpecification.of(traj.GetConfigurationSpecification().GetGroups())
    for group in spec.GetGroups():
        if not is_position(group):
            spec.RemoveGroups(group.name)
    spec.ResetGroupOffsets()
    params = PlannerParameters()
    params.SetConfigurationSpecification(traj.GetEnv(), spec)
    return scaled(params, extra, maxvelmult, maxaccelmult)


def scaled(params: PlannerParameters, extra: str, maxvelmult: float, maxaccelmult: float) -> PlannerParameters:
    """Give parameters for a planner that works alone further text and factors of the limits; return them."""
    for name, factor in (("maxvelmult", maxvelmult), ("maxaccelmult", maxaccelmult)):
        if not (np.isfinite(factor) and factor > 0):
            raise ArgumentError(f"{name}: is {factor}, and should be above 0")
    params.SetConfigVelocityLimit(params.GetConfigVelocityLimit() * maxvelmult)
    params.SetConfigAccelerationLimit(params.GetConfigAccelerationLimit() * maxaccelmult)
    params.SetExtraParameters(alone(extra))
    return params


def alone(extra: str) -> str:
    """Return parameters for a planner that works alone: times are no multiples of anything."""
    return f"<_fsteplength>0</_fsteplength>{extra}"
