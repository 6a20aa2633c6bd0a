"""Factory of planners by name, and functions that run them."""

import logging
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.manipulation.processing import TOPP_RA
from ravemj.planning.retiming import topp_ra
from ravemj.rave.interface import asked_for
from ravemj.rave.planning.grasper import Grasper
from ravemj.rave.planning.hand_planners import GraspGradient, WorkspaceTrajectoryTracker
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.path_planners import BasicRrt, BiRrt, ExplorationRrt, RaStar
from ravemj.rave.planning.planner import Planner, PlannerStatus
from ravemj.rave.planning.processing import TRAJECTORY_PLANNERS
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
    "grasper": Grasper,
    **TRAJECTORY_PLANNERS,
}
"""Factories of planners by name in lower case."""


def RaveCreatePlanner(env: "Environment", name: str) -> Planner | None:
    """Make a planner.

    Args:
        env: The environment.
        name: The name, in any letter case: ``birrt``, ``BasicRRT``, ``ExplorationRRT``, ``RAStar``,
            ``WorkspaceTrajectoryTracker``, ``GraspGradient``, ``Grasper``; the retimers
            ``LinearTrajectoryRetimer``, ``ParabolicTrajectoryRetimer``, ``CubicTrajectoryRetimer``,
            ``QuinticTrajectoryRetimer``, and with the extra ``retiming`` ``ToppraTrajectoryRetimer``; the smoothers
            ``LinearSmoother``, ``shortcut_linear``, ``ParabolicSmoother``, ``CubicSmoother``, ``QuinticSmoother``;
            with the extra ``planning``, the planners of OMPL: ``OMPL_RRTConnect``, ``OMPL_RRTstar``, ``OMPL_BITstar``,
            ``OMPL_PRM`` and so on.

    Returns:
        The planner; None, with a logged warning, if there is no planner of this name.

    Example:
        >>> planner = RaveCreatePlanner(env, "birrt")
    """
    word = asked_for(env, name, "RaveCreatePlanner")[0]
    make = _maker(word)
    if make is None:
        _LOG.warning("%s", _unknown(name))
        return None
    return make(env, word)


def _unknown(name: str) -> str:
    problem = f"there is no planner '{name}'" if name.strip() else "the name of the planner is empty"
    return f"{problem}; RaveGetLoadedInterfaces()[InterfaceType.planner] lists the names"


def is_planner(name: str) -> bool:
    """Return whether a planner of this name exists."""
    return _maker(name) is not None


def _maker(name: str) -> "Callable[[Environment, str], Planner] | None":
    if name.lower() in TOPP_RA and not topp_ra.is_installed():
        _LOG.warning("planner '%s' needs toppra; install it: pip install \"ravemj[retiming]\"", name)
        return None
    if not name.lower().startswith("ompl_"):
        return PLANNERS.get(name.lower())
    from ravemj.rave.planning.path_planners import OmplPlanner, is_ompl_planner  # noqa: PLC0415 - slow to import

    return OmplPlanner if is_ompl_planner(name) else None


def needed_planner(env: "Environment", name: str) -> Planner:
    """Return a planner by name, or raise an error.

    Raises:
        RavemjError: the planner does not exist.
    """
    planner = RaveCreatePlanner(env, name)
    if planner is None:
        raise RavemjError(_unknown(name), ErrorCode.Assert)
    return planner


def run_planner(traj: Trajectory, params: PlannerParameters, name: str) -> PlannerStatus:
    """Run a planner on a trajectory.

    Raises:
        RavemjError: the planner does not exist.
    """
    planner = needed_planner(traj.GetEnv(), name)
    planner.InitPlan(None, params)
    return planner.PlanPath(traj)


def retimed(traj: Trajectory, name: str, factors: tuple[float, float] = (1.0, 1.0), extra: str = "") -> PlannerStatus:
    """Run a retimer or a smoother on a trajectory of any bodies, in place.

    ``factors`` scale the velocity and acceleration limits; ``extra`` are further parameters as XML text.
    """
    return run_planner(traj, of_bodies(traj, extra, *factors), name)


def of_bodies(
    traj: Trajectory, extra: str = "", maxvelmult: float = 1.0, maxaccelmult: float = 1.0
) -> PlannerParameters:
    """Return planner parameters for the joints and poses in a trajectory, with scaled limits; see ``scaled``."""
    spec = ConfigurationSpecification.of(traj.GetConfigurationSpecification().GetGroups())
    for group in spec.GetGroups():
        if not is_position(group):
            spec.RemoveGroups(group.name)
    spec.ResetGroupOffsets()
    params = PlannerParameters()
    params.SetConfigurationSpecification(traj.GetEnv(), spec)
    return scaled(params, extra, maxvelmult, maxaccelmult)


def scaled(params: PlannerParameters, extra: str, maxvelmult: float, maxaccelmult: float) -> PlannerParameters:
    """Scale the limits of parameters, add further XML text, and return them.

    Raises:
        ArgumentError: a factor is not a positive number.
    """
    for name, factor in (("maxvelmult", maxvelmult), ("maxaccelmult", maxaccelmult)):
        if not (np.isfinite(factor) and factor > 0):
            raise ArgumentError(f"{name}: is {factor}, and should be above 0")
    params.SetConfigVelocityLimit(params.GetConfigVelocityLimit() * maxvelmult)
    params.SetConfigAccelerationLimit(params.GetConfigAccelerationLimit() * maxaccelmult)
    params.SetExtraParameters(alone(extra))
    return params


def alone(extra: str) -> str:
    """Return ``extra`` with the XML parameter that stops a retimer from rounding times to a step length."""
    return f"<_fsteplength>0</_fsteplength>{extra}"
