"""Runs the retimers and smoothers that process a path, one after the other."""

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
"""The classes of retimers and smoothers, by their names in lower case."""


def post_process(env: "Environment", values: Values, traj: Trajectory) -> PlannerStatus | None:
    """Run the planners that parameters name on a path, in place. Return the status of the first that fails, or None."""
    name, text = values.postprocessing
    if name and traj.GetNumWaypoints() == 1:
        name, text = "LinearTrajectoryRetimer", ""  # nothing to smooth
    if (name, text) == CHAIN and len(values.coordinates().rotation) > 1:
        name, text = "LinearSmoother", ""  # the chain's parabolic smoother cannot interpolate quaternions
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
