"""Retimers: planners that give the waypoints of a trajectory times."""

from collections.abc import Callable, Mapping
from typing import ClassVar

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.planning.retiming.jerk_limited import JerkLimited
from ravemj.planning.retiming.linear import Linear
from ravemj.planning.retiming.parabolic import Parabolic
from ravemj.planning.retiming.polynomials import Cubic, Quintic
from ravemj.planning.retiming.segments import (
    Interpolated,
    Limits,
    OutsideLimitsError,
    Profile,
    RetimingError,
    Timed,
    retime,
)
from ravemj.planning.retiming.topp_ra import ToppRa
from ravemj.rave.planning.planner import Planner
from ravemj.rave.planning.status import PlannerStatus
from ravemj.rave.planning.values import Values
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.groups import DELTATIME


def _parabolic(values: Values) -> Parabolic:
    return Parabolic(with_changes=flag(values, "outputaccelchanges", default=True))


TOPP_RA = ("toppra", "toppratrajectoryretimer")

RETIMERS: dict[str, Callable[[Values], Profile | ToppRa]] = {
    "lineartrajectoryretimer": lambda values: Linear(),
    "parabolictrajectoryretimer": _parabolic,
    "parabolictrajectoryretimer2": _parabolic,
    "cubictrajectoryretimer": lambda values: Cubic(),
    "cubictrajectoryretimer2": lambda values: JerkLimited(),
    "quintictrajectoryretimer": lambda values: Quintic(),
    **dict.fromkeys(TOPP_RA, lambda values: ToppRa()),
}
"""The velocity profiles of the retimers, by their names in lower case."""


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


class Retimer(Planner):
    """A planner that gives waypoints times within the velocity and acceleration limits. It ignores collisions."""

    _takes_text: ClassVar[bool] = True
    _defaults: ClassVar[Mapping[str, str]] = TIMING

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Retime a trajectory in place."""
        profile = RETIMERS[self._xmlid.lower()](values)
        wanted = values.tags.get("interpolation", "")
        if wanted not in {"", profile.interpolation}:
            return self._failed(f"the interpolation is '{profile.interpolation}', and should be '{wanted}'")
        coordinates = values.coordinates()
        if (coordinates.translation or coordinates.rotation) and profile.interpolation != "linear":
            return self._failed("poses of bodies can be retimed by the LinearTrajectoryRetimer only")
        spec = ConfigurationSpecification.of(values.groups)
        source = traj.GetConfigurationSpecification()
        if (lacking := lacking_group(spec, source)) is not None:
            return self._failed(f"the trajectory has no group '{lacking}'")
        deltas = None
        if flag(values, "hastimestamps"):
            group = source.FindCompatibleGroup(DELTATIME, True)
            if group is None:
                return self._failed("the times should be kept, and there are none")
            deltas = traj.GetAllWaypoints2D()[:, group.offset]
        rates = spec.ConvertToDerivativeSpecification(1)
        velocities = traj.GetAllWaypoints2D(rates) if flag(values, "hasvelocities") else None
        points = traj.GetAllWaypoints2D(spec)
        try:
            timed = _timed(profile, points, values.limits(), (deltas, velocities), values.numbers["_fsteplength"])
        except OutsideLimitsError as error:
            raise ArgumentError(f"{self._xmlid}: {error}", ErrorCode.InconsistentConstraints) from None
        except RetimingError as error:
            return self._failed(str(error))
        fill(traj, spec, profile, timed)
        return self._solved(f"{len(timed.deltas)} waypoints in {timed.deltas.sum():.6g} s")


def _timed(
    profile: Profile | ToppRa,
    points: Floats,
    limits: Limits,
    given: tuple[Floats | None, Floats | None],
    time_step: float,
) -> Timed:
    """Return a path with times; ``given`` are the times and velocities to keep, or None."""
    if not isinstance(profile, ToppRa):
        return retime(profile, points, limits, deltas=given[0], velocities=given[1], time_step=time_step)
    if any(one is not None for one in given):
        raise RetimingError("TOPP-RA keeps neither times nor velocities")
    return profile.timed(points, limits, time_step)


def lacking_group(spec: ConfigurationSpecification, source: ConfigurationSpecification) -> str | None:
    """Return the name of the first group of ``spec`` for which ``source`` has no values, or None."""
    names = [group.name for group in spec.GetGroups()]
    return next((name for name in names if source.FindCompatibleGroup(name) is None), None)


def fill(
    traj: Trajectory, spec: ConfigurationSpecification, profile: Interpolated, timed: Timed, *, mark: bool = False
) -> None:
    """Write a timed path into a trajectory, whose layout and waypoints are replaced.

    ``spec`` is the layout of the path's values; ``mark`` adds a group ``iswaypoint``.
    """
    groups = spec.GetGroups()
    for group in groups:
        group.interpolation = profile.interpolation
    result = ConfigurationSpecification.of(groups)
    for order in range(1, profile.order + 1):
        result.AddDerivativeGroups(order)
    time = result.AddDeltaTimeGroup()
    marks = result.AddGroup("iswaypoint", 1, "next") if mark else None
    rows = np.zeros((len(timed.deltas), result.GetDOF()))
    rows[:, time] = timed.deltas
    if marks is not None:
        rows[:, marks] = timed.is_point
    for group in groups:
        target = group
        for numbers in timed.orders:
            assert target is not None, "each group has its derivatives"
            rows[:, target.columns] = numbers[:, group.columns]
            target = result.FindTimeDerivativeGroup(target, True)
    traj.Init(result)
    traj.Insert(0, rows.ravel())


def flag(values: Values, name: str, *, default: bool = False) -> bool:
    """Return whether a tag of the parameters is on: any text but ``0`` and ``false``."""
    text = values.tags.get(name, "").strip().lower()
    return default if not text else text not in {"0", "false"}
