"""Planners that process paths: retimers and smoothers, one after the other."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from ravemj.rave.planning.parameter_text import CHAIN
from ravemj.rave.planning.planner import Planner
from ravemj.rave.planning.retimers import RETIMERS, Retimer
from ravemj.rave.planning.smoothers import SMOOTHERS, Smoother
from ravemj.rave.planning.status import PlannerStatus
from ravemj.rave.planning.values import Values
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

TRAJECTORY_PLANNERS: Mapping[str, "Callable[[Environment, str], Planner]"] = {
    **dict.fromkeys(RETIMERS, Retimer),
    **dict.fromkeys(SMOOTHERS, Smoother),
}
"""By their names in lower case."""


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
    if name and traj.GetNumWaypoints() == 1:
        name, text = "LinearTrajectoryRetimer", ""  # nothing to smooth
    if (name, text) == CHAIN and len(values.coordinates().rotation) > 1:
        name, text = "LinearSmoother", ""  # the other one of the chain knows no rotations in space
    numbers = {**values.numbers, "_nmaxiterations": 0.0, "_fsteplength": 0.0}
    while name:
        make = TRAJECTORY_PLANNERS.get(name.lower())
        if make is None:
            return PlannerStatus(f"there is no planner '{name}' to process the path", errorOrigin=name)
        own = replace(values, numbers=numbers, tags={}, postprocessing=("", "")).with_tags(text)
        status = make(env, name).run(own, traj)
        if not status:
            return status
        name, text = own.postprocessing
    return None
