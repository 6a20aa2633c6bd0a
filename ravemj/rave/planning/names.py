"""Planners by their names."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from ravemj.core.arguments import checked_kind
from ravemj.errors import UnsupportedError
from ravemj.rave.interface import checked_environment
from ravemj.rave.planning.parameters import Values
from ravemj.rave.planning.path_planners import BasicRrt, BiRrt, ExplorationRrt
from ravemj.rave.planning.planner import Planner
from ravemj.rave.planning.retimers import RETIMERS, Retimer
from ravemj.rave.planning.smoothers import SMOOTHERS, Smoother
from ravemj.rave.planning.status import PlannerStatus
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

_LOG = logging.getLogger("ravemj")

PLANNERS: Mapping[str, "Callable[[Environment, str], Planner]"] = {
    "birrt": BiRrt,
    "basicrrt": BasicRrt,
    "explorationrrt": ExplorationRrt,
    **dict.fromkeys(RETIMERS, Retimer),
    **dict.fromkeys(SMOOTHERS, Smoother),
}
"""What plans, by names in lower case."""

MISSING: Mapping[str, str] = {
    "graspgradient": "planning of grasps",
    "grasper": "planning of grasps",
    "ra*": "search on a lattice",
    "rastar": "search on a lattice",
    "workspacetrajectorytracker": "tracking of motions of the tool",
}
"""Names of OpenRAVE's own planners, in lower case, with what ravemj lacks to have them."""


def RaveCreatePlanner(env: "Environment", name: str) -> Planner | None:
    """Make a planner.

    Args:
        env: The environment.
        name: In any letter case: ``birrt``, ``BasicRRT``, ``ExplorationRRT``; the retimers
            ``LinearTrajectoryRetimer``, ``ParabolicTrajectoryRetimer``, ``CubicTrajectoryRetimer``,
            ``QuinticTrajectoryRetimer``; the smoothers ``LinearSmoother``, ``shortcut_linear``,
            ``ParabolicSmoother``, ``CubicSmoother``, ``QuinticSmoother``.

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
    make = PLANNERS.get(word.lower())
    if make is None:
        _LOG.warning("there is no planner '%s'", name)
        return None
    return make(env, word)


def post_process(env: "Environment", values: Values, traj: Trajectory) -> PlannerStatus | None:
    """Let the planners that parameters name for it work on a path, one after the other.

    Args:
        env: The environment.
        values: The parameters of the planner that found the path.
        traj: The path, which is processed in place.

    Returns:
        How a planner failed, or None.
    """
    name, text = values.postprocessing
    numbers = {**values.numbers, "_nmaxiterations": 0.0, "_fsteplength": 0.0}
    while name:
        planner = RaveCreatePlanner(env, name)
        if planner is None:
            return PlannerStatus(f"there is no planner '{name}' to process the path", errorOrigin=name)
        own = replace(values, numbers=numbers, tags={}, postprocessing=("", "")).with_tags(text)
        status = planner.run(own, traj)
        if not status:
            return status
        name, text = own.postprocessing
    return None
