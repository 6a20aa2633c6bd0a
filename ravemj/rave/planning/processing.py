"""Retimers and smoothers as planners, and their sequence in the post-processing of a path."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ravemj.errors import ArgumentError, ErrorCode
from ravemj.manipulation.processing import RETIMERS, SMOOTHERS, SPLINE, Processor, profile_of
from ravemj.planning.certificates import Certificate
from ravemj.planning.retiming.segments import OutsideLimitsError, RetimingError
from ravemj.rave.planning.planner import Planner, PlannerStatus
from ravemj.rave.planning.values import CERTIFIED_CHAIN, CHAIN, Values
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.conversion import FindBody
from ravemj.trajectories.layout import derived
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
"""Common parameters of OpenRAVE's retimers and smoothers, with its defaults.

Of these, only ``interpolation``, ``hastimestamps``, ``hasvelocities``, ``outputaccelchanges``, ``multidofinterp`` 2
(all joints change their accelerations at the same times) and ``verifyinitialpath`` have an effect.
"""

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
    """Planner that times waypoints within the velocity and acceleration limits. It ignores collisions."""

    _takes_text: ClassVar[bool] = True
    _defaults: ClassVar[Mapping[str, str]] = TIMING

    def _prepare(self, values: Values) -> PlannerStatus | None:
        """Return a failure status if the requested interpolation is not the retimer's, else None."""
        try:
            profile_of(self._xmlid, values.tags)
        except RetimingError as error:
            return self._failed(str(error))
        return None

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Process a trajectory in place."""
        try:
            path, certificate = _processed(self._env, self._xmlid, values, traj.waypoints, self._proceed)
        except RetimingError as error:
            return self._failed(str(error))
        traj.set_waypoints(path, certificate)
        return self._solved(f"{len(path)} waypoints in {path.duration():.6g} s")


class Smoother(Retimer):
    """Planner that replaces parts of a path by collision-free shortcuts, and times the result."""

    _defaults: ClassVar[Mapping[str, str]] = {**TIMING, **_CONSTRAINTS}

    def _prepare(self, values: Values) -> None:
        """Accept all parameters."""


TRAJECTORY_PLANNERS: Mapping[str, "Callable[[Environment, str], Planner]"] = {
    **dict.fromkeys(RETIMERS, Retimer),
    **dict.fromkeys(SMOOTHERS, Smoother),
}
"""Retimers and smoothers by name in lower case."""


def _processed(
    env: "Environment", name: str, values: Values, path: Waypoints, proceed: Callable[[int], bool]
) -> tuple[Waypoints, Certificate | None]:
    """Run a retimer or smoother on a path; return the motion, and its certificate if a smoother made one.

    Raises:
        RetimingError: the path cannot be retimed.
        ArgumentError: a waypoint is outside the limits.
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
                lambda points: values.conditions.straight_edges(
                    values.space(), [points[0], points[-1]], certifies=bool(values.certify)
                ),
                bool(values.certify),
                proceed,
            )
            return processor.process(path, env.simulation.body)
    except OutsideLimitsError as error:
        raise ArgumentError(f"{name}: {error}", ErrorCode.InconsistentConstraints) from None


def _chain(values: Values) -> Iterator[tuple[str, Values]]:
    """Yield the configured retimers and smoothers, with the parameters of each."""
    name, text = values.postprocessing
    if (name, text) == CHAIN and len(values.coordinates().rotation) > 1:
        name, text = "LinearSmoother", ""  # the chain's parabolic smoother cannot interpolate quaternions
    elif (name, text) == CHAIN and values.certify:
        name, text = CERTIFIED_CHAIN
    numbers = {**values.numbers, "_nmaxiterations": 0.0, "_fsteplength": 0.0}
    while name:
        own = replace(values, numbers=numbers, tags={}, postprocessing=("", "")).with_tags(text)
        yield name, own
        name, text = own.postprocessing


def _curved(
    run: Callable[[str], tuple[Waypoints, Certificate | None]], values: Values, find_body: FindBody
) -> tuple[Waypoints, Certificate | None]:
    """Return a smooth motion along a constrained path, or one with stops if a smooth one violates the constraint.

    ``run`` retimes the path with the named retimer.
    """
    try:
        curve, _ = run(SPLINE)
        if _is_allowed(curve, values, find_body):
            return curve, None
    except RetimingError:
        pass  # there are too few waypoints, or a base moves
    return run("LinearTrajectoryRetimer")


def _is_allowed(curve: Waypoints, values: Values, find_body: FindBody) -> bool:
    """Return whether a motion's cubic segments keep the constraint at their middles, where the deviation is largest."""
    groups = list(values.groups)
    points, rates = (curve.as_layout(curve.data, some, find_body) for some in (groups, derived(groups, 1)))
    deltas = np.diff(curve.times())[:, None]
    middles = (points[1:] + points[:-1]) / 2 + (rates[:-1] - rates[1:]) * deltas / 8
    with values.conditions.kept():
        return all(map(values.conditions.allowed(), middles))


def post_process(env: "Environment", values: Values, traj: Trajectory) -> PlannerStatus | None:
    """Run the configured post-processing on a path in place; return the status of the first failure, or None."""
    path, certificate = traj.waypoints, None
    if values.postprocessing[0] and len(path) == 1:
        values = replace(values, postprocessing=("LinearTrajectoryRetimer", ""))  # nothing to smooth
    for name, own in _chain(values):
        if name.lower() not in TRAJECTORY_PLANNERS:
            return PlannerStatus(f"there is no planner '{name}' to process the path", errorOrigin=name)
        try:
            run = partial(_processed, env, values=own, path=path, proceed=lambda attempt: True)
            is_spline = name.lower() == SPLINE
            path, certificate = _curved(run, own, env.simulation.body) if is_spline else run(name)
        except RetimingError as error:
            return PlannerStatus(str(error), errorOrigin=name)
    traj.set_waypoints(path, certificate)
    return None
