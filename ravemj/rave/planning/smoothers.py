"""Smoothers: planners that make a motion shorter and faster, and keep it free of collisions."""

from collections.abc import Callable, Mapping
from typing import ClassVar

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges, path_is_allowed
from ravemj.planning.ramp_shortcuts import Piece, faster, lines
from ravemj.planning.retiming.linear import Linear
from ravemj.planning.retiming.parabolic import Parabolic
from ravemj.planning.retiming.polynomials import Cubic, Quintic
from ravemj.planning.retiming.segments import OutsideLimitsError, Profile, RetimingError, Timed, retime
from ravemj.planning.shortcuts import shorten
from ravemj.rave.planning.planner import Planner
from ravemj.rave.planning.retimers import TIMING, fill, flag, lacking_group
from ravemj.rave.planning.status import PlannerStatus
from ravemj.rave.planning.values import Values
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory

_TRIES = 100
"""OpenRAVE's default for the number of attempted shortcuts."""

SMOOTHERS: dict[str, Callable[[], Profile]] = {
    "linearsmoother": Linear,
    "shortcut_linear": Linear,
    "parabolicsmoother": Parabolic,
    "parabolicsmoother2": Parabolic,
    "constraintparabolicsmoother": Parabolic,
    "cubicsmoother": Cubic,
    "quinticsmoother": Quintic,
}
"""The velocity profiles of the results, by the names of planners in lower case. Only parabolic results leave the
straight lines of the path: they round its corners."""


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


class Smoother(Planner):
    """A planner that replaces parts of a path by shortcuts without collisions, and gives the result times."""

    _takes_text: ClassVar[bool] = True
    _defaults: ClassVar[Mapping[str, str]] = {**TIMING, **_CONSTRAINTS}

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Smooth a trajectory in place."""
        spec = ConfigurationSpecification.of(values.groups)
        if (lacking := lacking_group(spec, traj.GetConfigurationSpecification())) is not None:
            return self._failed(f"the trajectory has no group '{lacking}'")
        points = traj.GetAllWaypoints2D(spec)
        if len(points) < 2:
            return self._failed(f"there should be two waypoints at least, and there are {len(points)}")
        profile = SMOOTHERS[self._xmlid.lower()]()
        limits = values.limits()
        try:
            limits.check(points)
            if values.bodies is None:
                return self._smoothed(Edges(values.space(), lambda one: True), values, traj, points, profile)
            with values.bodies.kept():
                edges = Edges(values.space(), values.conditions.allowed())
                if flag(values, "verifyinitialpath", default=True) and not path_is_allowed(edges, points):
                    return self._failed("the path is in collision from the start")
                return self._smoothed(edges, values, traj, points, profile)
        except (OutsideLimitsError, RetimingError, ValueError) as error:
            return self._failed(str(error))

    def _smoothed(
        self, edges: Edges, values: Values, traj: Trajectory, points: Floats, profile: Profile
    ) -> PlannerStatus:
        random = values.random()
        tries = int(values.numbers["_nmaxiterations"]) or _TRIES
        limits, spec = values.limits(), ConfigurationSpecification.of(values.groups)
        coordinates = limits.coordinates
        if isinstance(profile, Parabolic):
            if len(coordinates.rotation) > 1:
                return self._failed("rotations in space can be smoothed by the LinearSmoother only")
        elif not isinstance(profile, Linear) and (coordinates.translation or coordinates.rotation):
            return self._failed("poses of bodies can be smoothed by the LinearSmoother and the ParabolicSmoother only")
        short = shorten(edges, points, tries, random, self._proceed)
        if isinstance(profile, Parabolic):
            motion = faster(edges, lines(short, limits), limits, tries, random, self._proceed)
            timed = _timed(motion, points)
        else:
            timed = retime(profile, short, limits)
        fill(traj, spec, profile, timed, mark=isinstance(profile, Parabolic))
        return self._solved(f"{len(timed.deltas)} waypoints in {timed.deltas.sum():.6g} s")


def _timed(motion: list[Piece], points: Floats) -> Timed:
    """Return a motion as a timed path, which begins and ends exactly at the first and last of the given points."""
    rest = np.zeros_like(points[0])
    values = np.array([*(piece.values for piece in motion), points[-1]])
    values[0] = points[0]
    velocities = np.array([*(piece.velocities for piece in motion), rest])
    deltas = np.array([0.0, *(piece.duration for piece in motion)])
    corners = np.array([*(piece.is_corner for piece in motion), True])
    return Timed(deltas, [values, velocities], corners)
