"""Retimers and smoothers as planners, and the chain of them that processes a path."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import nullcontext
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

from ravemj.errors import ArgumentError, ErrorCode
from ravemj.manipulation.processing import RETIMERS, SMOOTHERS, Processor
from ravemj.planning.edges import Edges
from ravemj.planning.retiming.segments import OutsideLimitsError, RetimingError
from ravemj.rave.planning.planner import Planner, PlannerStatus
from ravemj.rave.planning.values import CHAIN, Values
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.waypoints import Waypoints

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

TIMING: Mapping[str, str] = {
    "interpolation": "",
    "hastimestamps": "0",
    "hasvelocities": "0",
    "hasaccelerations": "0",
    "pointtolerance": "0.2",
    "outputaccelchanges": "1",
    "multidofinterp": "0",
    "verifyinitialpath": "1",
}
"""The parameters that OpenRAVE's retimers and smoothers share, with its defaults. Of these, ``interpolation``,
``hastimestamps``, ``hasvelocities``, ``outputaccelchanges`` and ``verifyinitialpath`` have an effect here."""

_CONSTRAINTS: Mapping[str, str] = {
    "maxlinkspeed": "0",
    "maxlinkaccel": "0",
    "manipname": "",
    "maxmanipspeed": "0",
    "maxmanipaccel": "0",
    "cosmanipanglethresh": "-1",
    "mingripperdistance": "0",
    "velocitydistancethresh": "0",
    "maxmergeiterations": "1000",
    "minswitchtime": "0.2",
    "nshortcutcycles": "1",
}
"""Further parameters of OpenRAVE's smoothers, with its defaults. They have no effect here."""


class Retimer(Planner):
    """A planner that gives waypoints times within the velocity and acceleration limits. It ignores collisions."""

    _takes_text: ClassVar[bool] = True
    _defaults: ClassVar[Mapping[str, str]] = TIMING

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Process a trajectory in place."""
        try:
            path = _processed(self._env, self._xmlid, values, traj.waypoints, self._proceed)
        except RetimingError as error:
            return self._failed(str(error))
        traj.set_waypoints(path)
        return self._solved(f"{len(path)} waypoints in {path.duration():.6g} s")


class Smoother(Retimer):
    """A planner that replaces parts of a path by shortcuts without collisions, and gives the result times."""

    _defaults: ClassVar[Mapping[str, str]] = {**TIMING, **_CONSTRAINTS}


TRAJECTORY_PLANNERS: Mapping[str, "Callable[[Environment, str], Planner]"] = {
    **dict.fromkeys(RETIMERS, Retimer),
    **dict.fromkeys(SMOOTHERS, Smoother),
}
"""The classes of retimers and smoothers, by their names in lower case."""


def _processed(
    env: "Environment", name: str, values: Values, path: Waypoints, proceed: Callable[[int], bool]
) -> Waypoints:
    """Run a retimer or smoother on a path.

    Raises:
        RetimingError: there is no such motion.
        ArgumentError: a retimer found a waypoint outside of the limits.
    """
    try:
        with values.conditions.kept() if name.lower() in SMOOTHERS else nullcontext():
            numbers = values.numbers
            processor = Processor(
                name.lower(),
                list(values.groups),
                values.limits(),
                values.tags,
                numbers["_fsteplength"],
                int(numbers["_nmaxiterations"]),
                values.random(),
                lambda: Edges(values.space(), values.conditions.allowed()),
                proceed,
            )
            return processor.process(path, env.simulation.body)
    except OutsideLimitsError as error:
        raise ArgumentError(f"{name}: {error}", ErrorCode.InconsistentConstraints) from None


def _chain(values: Values) -> Iterator[tuple[str, Values]]:
    """Yield the retimers and smoothers that parameters name, and the parameters of each."""
    name, text = values.postprocessing
    if (name, text) == CHAIN and len(values.coordinates().rotation) > 1:
        name, text = "LinearSmoother", ""  # the chain's parabolic smoother cannot interpolate quaternions
    numbers = {**values.numbers, "_nmaxiterations": 0.0, "_fsteplength": 0.0}
    while name:
        own = replace(values, numbers=numbers, tags={}, postprocessing=("", "")).with_tags(text)
        yield name, own
        name, text = own.postprocessing


def post_process(env: "Environment", values: Values, traj: Trajectory) -> PlannerStatus | None:
    """Run the planners that parameters name on a path, in place. Return the status of the first that fails, or None."""
    path = traj.waypoints
    if values.postprocessing[0] and len(path) == 1:
        values = replace(values, postprocessing=("LinearTrajectoryRetimer", ""))  # nothing to smooth
    for name, own in _chain(values):
        if name.lower() not in TRAJECTORY_PLANNERS:
            return PlannerStatus(f"there is no planner '{name}' to process the path", errorOrigin=name)
        try:
            path = _processed(env, name, own, path, lambda attempt: True)
        except RetimingError as error:
            return PlannerStatus(str(error), errorOrigin=name)
    traj.set_waypoints(path)
    return None
