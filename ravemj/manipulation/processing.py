"""Smoothers and retimers by OpenRAVE's names, which turn paths into timed motions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.certificates import Certificate
from ravemj.planning.detours import certified_detour
from ravemj.planning.edges import Edges, path_is_allowed
from ravemj.planning.retiming.polynomials import Cubic, JerkLimited, Linear, MatchedRamps, Parabolic, Quintic
from ravemj.planning.retiming.segments import Interpolated, PathLimits, Profile, RetimingError, Timed, retime
from ravemj.planning.retiming.spline import Spline
from ravemj.planning.retiming.topp_ra import ToppRa
from ravemj.planning.shortcuts import MotionSegment, ShortenedMotion, lines, motion_curves, shorten, straightened
from ravemj.trajectories.conversion import FindBody
from ravemj.trajectories.groups import DELTATIME, Group
from ravemj.trajectories.layout import (
    copied,
    count,
    derived,
    find_compatible,
    find_shifted,
    with_derivatives,
    with_group,
)
from ravemj.trajectories.waypoints import Waypoints

_TRIES = 100
"""OpenRAVE's default for the number of attempted shortcuts."""

_TRIES_PER_LINE = 3
"""Number of additional shortcut attempts for each straight line that the path must keep."""

_DETOURS = 5
"""Maximum number of straight lines replaced by detours because they cannot be certified."""

TOPP_RA = ("toppra", "toppratrajectoryretimer")


def flag(options: Mapping[str, str], name: str, *, default: bool = False) -> bool:
    """Return whether a parameter is set: any text but ``0`` and ``false``."""
    text = options.get(name, "").strip().lower()
    return default if not text else text not in {"0", "false"}


def _parabolic(options: Mapping[str, str]) -> Parabolic:
    profile = MatchedRamps if options.get("multidofinterp", "").strip() == "2" else Parabolic
    return profile(with_changes=flag(options, "outputaccelchanges", default=True))


SPLINE = "splinetrajectoryretimer"

RETIMERS: Mapping[str, Callable[[Mapping[str, str]], Profile | ToppRa | Spline]] = {
    "lineartrajectoryretimer": lambda options: Linear(),
    "parabolictrajectoryretimer": _parabolic,
    "parabolictrajectoryretimer2": _parabolic,
    "cubictrajectoryretimer": lambda options: Cubic(),
    "cubictrajectoryretimer2": lambda options: JerkLimited(),
    "quintictrajectoryretimer": lambda options: Quintic(),
    **dict.fromkeys(TOPP_RA, lambda options: ToppRa()),
    SPLINE: lambda options: Spline(),
}
"""Velocity profiles of the retimers, by lower-case name."""


def profile_of(name: str, options: Mapping[str, str]) -> Profile | ToppRa | Spline:
    """Return the velocity profile of a retimer.

    Raises:
        RetimingError: the option ``interpolation`` is not the retimer's.
    """
    profile, wanted = RETIMERS[name.lower()](options), options.get("interpolation", "")
    if wanted not in {"", profile.interpolation}:
        raise RetimingError(f"the interpolation is '{profile.interpolation}', and should be '{wanted}'")
    return profile


SMOOTHERS: Mapping[str, Callable[[], Profile]] = {
    "linearsmoother": Linear,
    "shortcut_linear": Linear,
    "parabolicsmoother": Parabolic,
    "parabolicsmoother2": Parabolic,
    "constraintparabolicsmoother": Parabolic,
    "cubicsmoother": Cubic,
    "quinticsmoother": Quintic,
}
"""Velocity profiles of smoother results, by lower-case name. Only parabolic results round corners of the path."""


@dataclass(frozen=True)
class Processor:
    """Smoother or retimer with its parameters.

    Attributes:
        name: The name, in lower case.
        groups: The layout of a configuration.
        limits: The limits of the motion.
        options: Further parameters by name, as texts.
        time_step: Retimers round all times up to multiples of it [s]; 0 means no rounding.
        iterations: The number of attempted shortcuts; 0 for OpenRAVE's.
        random: The random numbers.
        edges: For smoothers: returns the tests of edges, given the path.
        certifies: Whether smoothers certify motions, and remove shortcuts that prevent it.
        proceed: Callback before each attempt; returning False ends them.
    """

    name: str
    groups: list[Group]
    limits: PathLimits
    options: Mapping[str, str]
    time_step: float
    iterations: int
    random: np.random.Generator
    edges: Callable[[Floats], Edges]
    certifies: bool = False
    proceed: Callable[[int], bool] = lambda attempt: True

    def process(self, path: Waypoints, find_body: FindBody) -> tuple[Waypoints, Certificate | None]:
        """Return the timed path, and its certificate; None without certification, or if spans remain undecided.

        ``find_body`` finds the bodies, whose present state supplies missing joints.

        Raises:
            RetimingError: the path cannot be timed.
            OutsideLimitsError: a waypoint is outside the limits.
        """
        run = self._retimed if self.name in RETIMERS else self._smoothed
        return run(path, lambda groups: path.as_layout(path.data, groups, find_body))

    def _check_layout(self, path: Waypoints) -> None:
        for group in self.groups:
            if find_compatible(path.groups, group.name) is None:
                raise RetimingError(f"the trajectory has no group '{group.name}'")

    def _is_of_goals(self) -> bool:
        """Return whether the path consists of IK goals; OpenRAVE retimes their numbers like joint values."""
        return all(group.name.startswith("ikparam_values") for group in self.groups)

    # Retimers

    def _retimed(self, path: Waypoints, rows: Callable[[list[Group]], Floats]) -> tuple[Waypoints, None]:
        """Time waypoints within the limits, ignoring collisions; ``rows`` returns the path's values of given groups."""
        profile, options, coordinates = profile_of(self.name, self.options), self.options, self.limits.coordinates
        is_base = bool(coordinates.translation or coordinates.rotation) and not self._is_of_goals()
        if is_base and profile.interpolation != "linear":
            raise RetimingError("poses of bodies can be retimed by the LinearTrajectoryRetimer only")
        self._check_layout(path)
        deltas = None
        if flag(options, "hastimestamps"):
            group = find_compatible(path.groups, DELTATIME, exact=True)
            if group is None:
                raise RetimingError("the times should be kept, and there are none")
            deltas = path.data[:, group.offset]
        velocities = None
        if flag(options, "hasvelocities") and profile.interpolation != "linear":  # OpenRAVE's linear one has its own
            rates = derived(self.groups, 1)
            for group in rates:
                if find_compatible(path.groups, group.name, exact=True) is None:
                    raise RetimingError(f"the velocities should be kept, and there is no group '{group.name}'")
            velocities = rows(rates)
        return self._written(profile, self._timed(profile, rows(self.groups), deltas, velocities)), None

    def _timed(
        self, profile: Profile | ToppRa | Spline, points: Floats, deltas: Floats | None, velocities: Floats | None
    ) -> Timed:
        if not isinstance(profile, ToppRa | Spline):
            time_step = self.time_step
            return retime(profile, points, self.limits, deltas=deltas, velocities=velocities, time_step=time_step)
        if deltas is not None or velocities is not None:
            name = "TOPP-RA" if isinstance(profile, ToppRa) else "a curve without stops"
            raise RetimingError(f"{name} keeps neither times nor velocities")
        return profile.timed(points, self.limits, self.time_step)

    # Smoothers

    def _smoothed(self, path: Waypoints, rows: Callable[[list[Group]], Floats]) -> tuple[Waypoints, Certificate | None]:
        """Shorten a path by collision-free shortcuts and time it; ``rows`` returns the path's values of some groups."""
        self._check_layout(path)
        points, coordinates = rows(self.groups), self.limits.coordinates
        if len(points) < 2:
            raise RetimingError(f"there should be two waypoints at least, and there are {len(points)}")
        profile, edges = SMOOTHERS[self.name](), self.edges(points)
        try:
            self.limits.check(points)
            if flag(self.options, "verifyinitialpath", default=True) and not path_is_allowed(edges, points):
                raise RetimingError("the path is in collision from the start")
            if isinstance(profile, Parabolic) and len(coordinates.rotation) > 1:
                raise RetimingError("rotations in space can be smoothed by the LinearSmoother only")
            if not isinstance(profile, Parabolic | Linear) and (coordinates.translation or coordinates.rotation):
                smoothers = "the LinearSmoother and the ParabolicSmoother"
                raise RetimingError(f"poses of bodies can be smoothed by {smoothers} only")
            tries = self.iterations or _TRIES
            keeps_lines = self.certifies and isinstance(profile, Parabolic)  # shortcuts of motions can be removed again
            short = (
                straightened(edges, points) if keeps_lines else shorten(edges, points, tries, self.random, self.proceed)
            )
            if not isinstance(profile, Parabolic):
                return self._written(profile, retime(profile, short, self.limits)), None
            if keeps_lines:
                tries = min(tries + _TRIES_PER_LINE * len(short), 2 * tries)
            motion = ShortenedMotion(lines(short, self.limits))
            motion.shorten(edges, self.limits, tries, self.random, self.proceed)
            certificate = self._certified(motion, edges, tries) if self.certifies else None
            return self._written(profile, _timed(motion.segments, points), marks=True), certificate
        except (RetimingError, ValueError) as error:
            raise RetimingError(str(error)) from None

    def _certified(self, motion: ShortenedMotion, edges: Edges, tries: int) -> Certificate | None:
        """Certify a motion, without the shortcuts and lines that cannot be certified; return None if that fails.

        A line is replaced by a detour. Shortcuts that start or end on it are removed, too, and new ones are attempted.
        """
        certifier = edges.certifier()
        if certifier is None or not motion.segments:
            return None

        def detour(part: Floats) -> Floats | None:
            return certified_detour(edges, certifier.proves, part, self.random)

        detours = 0
        while True:
            certificate = certifier.certificate(motion_curves(motion.segments), whole=False)
            if not certificate.undecided:
                return certificate
            time = (certificate.undecided[0].start + certificate.undecided[0].end) / 2
            if motion.remove_shortcut(time):
                continue
            if detours == _DETOURS or not motion.replace_line(time, edges.space, self.limits, detour):
                return None
            detours += 1
            motion.shorten(edges, self.limits, tries, self.random, self.proceed)

    def _written(self, profile: Interpolated, timed: Timed, *, marks: bool = False) -> Waypoints:
        """Convert a timed path to waypoints; ``marks`` adds a group ``iswaypoint``."""
        groups = copied(self.groups)
        for group in groups:
            group.interpolation = profile.interpolation
        result = groups
        for order in range(1, profile.order + 1):
            result = with_derivatives(result, order, deltatime=False)
        result = with_group(result, Group(DELTATIME, 0, 1))
        time = result[-1].offset
        if marks:
            result = with_group(result, Group("iswaypoint", 0, 1, "next"))
        rows = np.zeros((len(timed.deltas), count(result)))
        rows[:, time] = timed.deltas
        if marks:
            rows[:, -1] = timed.is_point
        for group in groups:
            target = group
            for numbers in timed.orders:
                assert target is not None, "each group has its derivatives"
                rows[:, target.columns] = numbers[:, group.columns]
                target = find_shifted(result, target.name, 1, exact=True)
        return Waypoints(result, rows)


def _timed(motion: list[MotionSegment], points: Floats) -> Timed:
    """Return a motion as a timed path, which starts and ends exactly at the first and last of the given points."""
    rest = np.zeros_like(points[0])
    values = np.array([*(piece.values for piece in motion), points[-1]])
    values[0] = points[0]
    velocities = np.array([*(piece.velocities for piece in motion), rest])
    deltas = np.array([0.0, *(piece.duration for piece in motion)])
    corners = np.array([*(piece.is_corner for piece in motion), True])
    return Timed(deltas, [values, velocities], corners)
