"""Shortcuts of paths and motions: straight lines, or faster ramps, instead of detours."""

from bisect import bisect_right
from collections.abc import Callable, Iterable, Sequence
from itertools import count, pairwise
from math import ceil, sqrt
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.curves import Curve
from ravemj.planning.detours import AROUND
from ravemj.planning.edges import Edges, bisection_order
from ravemj.planning.ramps import Ramps, fit_from_rest, fit_ramps, shortest_ramps
from ravemj.planning.retiming.segments import PathLimits
from ravemj.planning.space import Space

_WORTH = 3e-3
"""Minimum saving of a shortcut, as a fraction of the path length; smaller ones are not worth their collision checks."""

_MOST_ENDS = 32
"""Maximum number of waypoints to which a straight line from one waypoint is tried."""


def shorten(
    edges: Edges,
    points: Floats,
    tries: int,
    random: np.random.Generator,
    proceed: Callable[[int], bool] = lambda attempt: True,
) -> Floats:
    """Return a shortened path with the same start and goal, shape (k, n).

    Straight lines between waypoints replace detours; then pairs of random points on the path are connected if the line
    is allowed and shorter, in at most ``tries`` attempts. ``proceed`` is called before each attempt with its number;
    returning False stops them.
    """
    space = edges.space
    path = list(_without_detours(edges, points))
    for attempt in range(tries):
        if len(path) < 3 or not proceed(attempt):
            break
        steps = space.difference(np.array(path[1:]), np.array(path[:-1]))
        lengths = np.linalg.norm(space.weights * steps, axis=1)
        ends: Floats = np.cumsum(lengths)
        low, high = sorted((random.random() * float(ends[-1]), random.random() * float(ends[-1])))
        first, second = (min(int(np.searchsorted(ends, place)), len(steps) - 1) for place in (low, high))
        if first == second:
            continue
        start = edges.onto(_place(path[first], steps[first], lengths[first], low - (ends[first] - lengths[first])))
        end = edges.onto(_place(path[second], steps[second], lengths[second], high - (ends[second] - lengths[second])))
        step = space.difference(end, start)
        straight = float(np.linalg.norm(space.weights * step))
        # The remaining parts of both lines are tested again, since their steps differ from those of the whole lines.
        if high - low - straight > _WORTH * ends[-1] and all(
            edges.shortcut(begin, space.difference(other, begin))
            for begin, other in ((start, end), (path[first], start), (end, path[second + 1]))
        ):
            path[first + 1 : second + 1] = [start, end]
    return _without_detours(edges, np.array(path))


def _place(start: Floats, step: Floats, length: float, along: float) -> Floats:
    return start + step * (along / length if length > 0 else 0.0)


def straightened(edges: Edges, points: Floats) -> Floats:
    """Return a path without collinear waypoints; if more than ``_MOST_ENDS`` remain, also without detours."""
    steps = edges.space.difference(points[1:], points[:-1])
    lengths = np.linalg.norm(steps, axis=1)
    products = np.einsum("ij,ij->i", steps[1:], steps[:-1])
    is_corner = lengths[1:] * lengths[:-1] - products > _STRAIGHT * lengths[1:] * lengths[:-1]
    corners = points[[True, *is_corner, True]]
    return corners if len(corners) <= _MOST_ENDS else _without_detours(edges, corners)


def _without_detours(edges: Edges, path: Floats) -> Floats:
    """Return the path in which each waypoint is followed by the last one reachable by a straight line.

    At most ``_MOST_ENDS`` later waypoints are tested.
    """
    kept, last = [0], len(path) - 1
    while kept[-1] < last:
        start = path[kept[-1]]
        farther = range(last, kept[-1] + 1, -ceil((last - kept[-1]) / _MOST_ENDS))
        reached = (end for end in farther if edges.shortcut(start, edges.space.difference(path[end], start)))
        kept.append(next(reached, kept[-1] + 1))
    return path[kept]


_STRAIGHT = 1e-12
"""1 minus the cosine of the largest angle between two lines that count as collinear."""

_WORTH_TIME = 1e-3
"""Minimum time saved by a shortcut, as a fraction of the duration of the part that it replaces."""

_SAME_TIME = 1e-9
"""Tolerance of equal times of acceleration changes [s]."""


class MotionSegment(NamedTuple):
    """Segment of a motion with constant accelerations.

    Attributes:
        duration: Duration [s].
        values: Values at its start [rad or m], shape (n,).
        velocities: Velocities at its start, shape (n,).
        accelerations: Shape (n,).
        is_corner: Whether it starts at a junction of lines or shortcuts.
        source: Number of the line or shortcut of which it is a part.
        begins: Time of its start in the source [s].
    """

    duration: float
    values: Floats
    velocities: Floats
    accelerations: Floats
    is_corner: bool
    source: int = 0
    begins: float = 0.0

    def after(self, time: float) -> tuple[Floats, Floats]:
        """Return values and velocities at a time after the start."""
        moved = self.values + self.velocities * time + self.accelerations * (time * time / 2)
        return moved, self.velocities + self.accelerations * time

    def part(self, start: float, end: float, *, is_corner: bool) -> "MotionSegment":
        """Return the part between two times after the start."""
        values, velocities = self.after(start)
        begins = self.begins + start
        return MotionSegment(end - start, values, velocities, self.accelerations, is_corner, self.source, begins)


def lines(points: Floats, limits: PathLimits) -> list[MotionSegment]:
    """Return the motion along the straight lines of a path, shape (m, n), with a stop at each waypoint."""
    motion: list[MotionSegment] = []
    for start, end in pairwise(points):
        step = limits.coordinates.difference(end, start)
        moving = step != 0
        if not moving.any():
            continue
        way = np.abs(step[moving])
        unit, rest = np.ones(1), np.zeros(1)
        speed = np.array([(limits.velocity[moving] / way).min()])
        acceleration = np.array([(limits.acceleration[moving] / way).min()])
        duration = float(shortest_ramps(unit, rest, rest, speed, acceleration)[0])
        along = fit_from_rest(unit, duration, speed, acceleration) if np.isfinite(duration) else None
        if along is None:
            raise ValueError("a joint moves whose velocity or acceleration limit is 0")
        motion += _pieces(along, lambda numbers, step=step: numbers * step, start)
    return motion


def _pieces(ramps: Ramps, spread: Callable[[Floats], Floats], origin: Floats) -> list[MotionSegment]:
    times = np.concatenate([[0.0], ramps.changes(_SAME_TIME)])
    values, velocities = ramps.states(times)
    segments: list[MotionSegment] = []
    for index, duration in enumerate(np.diff(times).tolist()):
        if duration > 0:
            rate = (velocities[index + 1] - velocities[index]) / duration
            state = origin + spread(values[index]), spread(velocities[index]), spread(rate)
            segments.append(MotionSegment(duration, *state, is_corner=index == 0))
    return segments


class _Place(NamedTuple):
    """Point of a motion, at ``time`` [s] from the start of the line or shortcut with the number ``source``."""

    source: int
    time: float


class _Shortcut(NamedTuple):
    """Shortcut between two points of a motion; its segments have the number of the shortcut as ``source``."""

    start: _Place
    end: _Place
    segments: list[MotionSegment]


class ShortenedMotion:
    """Motion made faster by random shortcuts of constant accelerations, each of which can be removed again.

    Args:
        straight: The motion without shortcuts.

    Attributes:
        segments: The motion.
    """

    def __init__(self, straight: list[MotionSegment]) -> None:
        self._sources = count()
        self._straight = self._with_sources(straight)
        self.segments = self._straight
        self._shortcuts: list[_Shortcut] = []

    def _with_sources(self, line: list[MotionSegment]) -> list[MotionSegment]:
        return [piece._replace(source=next(self._sources)) for piece in line]

    def shorten(
        self,
        edges: Edges,
        limits: PathLimits,
        tries: int,
        random: np.random.Generator,
        proceed: Callable[[int], bool] = lambda attempt: True,
    ) -> None:
        """Add shortcuts between random times; start and end stay.

        There are at most ``tries`` attempts. ``proceed`` is called before each with its number; returning False stops
        them.
        """
        for attempt in range(tries):
            if not self.segments or not proceed(attempt):
                break
            ends = self._ends()
            low, high = sorted((random.random() * float(ends[-1]), random.random() * float(ends[-1])))
            (start, first), (end, second) = self._at(low, ends), self._at(high, ends)
            pieces = _shortcut(edges, first, second, (high - low) * (1 - _WORTH_TIME), limits)
            if pieces is not None:
                shortcut = _Shortcut(start, end, _from_one_source(pieces, next(self._sources)))
                self._shortcuts.append(shortcut)
                self._insert(shortcut)

    def remove_shortcut(self, time: float) -> bool:
        """Remove the shortcut at a time [s], and those that start or end on it; return whether there was one."""
        source = self._at(time, self._ends())[0].source
        others = [shortcut for shortcut in self._shortcuts if shortcut.segments[0].source != source]
        if len(others) == len(self._shortcuts):
            return False
        self._shortcuts = others
        self._insert_all()
        return True

    def replace_line(
        self, time: float, space: Space, limits: PathLimits, detour: Callable[[Floats], Floats | None]
    ) -> bool:
        """Replace the path around a time [s] at which the motion is on a line.

        Args:
            time: The time.
            space: The configuration space.
            limits: The limits of the motion.
            detour: Returns a path from the first to the last of some waypoints, shape (m, n), or None.

        Returns:
            Whether the path was replaced.
        """
        (source, _), (values, _) = self._at(time, self._ends())
        pieces = self._straight
        corners = [*(index for index, piece in enumerate(pieces) if piece.is_corner), len(pieces)]
        end = pieces[-1].after(pieces[-1].duration)[0]
        points = [*(pieces[corner].values for corner in corners[:-1]), end]
        line = bisect_right(corners, [piece.source for piece in pieces].index(source)) - 1
        first, start = _until_around(space, values, points, range(line, -1, -1))
        last, end = _until_around(space, values, points, range(line + 1, len(points)))
        path = detour(np.array([start, *points[first + 1 : last], values, end]))
        if path is None:
            return False
        motion = lines(np.array([points[first], *path, points[last]]), limits)
        self._straight = [*pieces[: corners[first]], *self._with_sources(motion), *pieces[corners[last] :]]
        self._insert_all()
        return True

    def _insert_all(self) -> None:
        """Rebuild the motion from straight lines and shortcuts; drop shortcuts whose start or end no longer exists."""
        self.segments = self._straight
        self._shortcuts = [shortcut for shortcut in self._shortcuts if self._insert(shortcut)]

    def _ends(self) -> Floats:
        return np.cumsum([piece.duration for piece in self.segments])

    def _at(self, time: float, ends: Floats) -> tuple[_Place, tuple[Floats, Floats]]:
        """Return the point of the motion at a time, with values and velocities; ``ends``: end times of the segments."""
        number = min(int(np.searchsorted(ends, time)), len(ends) - 1)
        piece = self.segments[number]
        after = time - (float(ends[number]) - piece.duration)
        return _Place(piece.source, piece.begins + after), piece.after(after)

    def _insert(self, shortcut: _Shortcut) -> bool:
        """Insert a shortcut into the motion; return False if its start or end is no longer on the motion."""
        first, second = self._find(shortcut.start), self._find(shortcut.end)
        if first is None or second is None or first > second:
            return False
        before, behind = self.segments[first], self.segments[second]
        head = before.part(0.0, shortcut.start.time - before.begins, is_corner=before.is_corner)
        tail = behind.part(shortcut.end.time - behind.begins, behind.duration, is_corner=True)
        fresh = [piece for piece in (head, *shortcut.segments, tail) if piece.duration > _SAME_TIME]
        self.segments = [*self.segments[:first], *fresh, *self.segments[second + 1 :]]
        return True

    def _find(self, place: _Place) -> int | None:
        """Return the index of the segment that contains a point of the motion, or None."""
        for number, piece in enumerate(self.segments):
            since = place.time - piece.begins
            if piece.source == place.source and -_SAME_TIME <= since <= piece.duration + _SAME_TIME:
                return number
        return None


def _until_around(space: Space, values: Floats, points: Sequence[Floats], rows: Iterable[int]) -> tuple[int, Floats]:
    """Follow a path up to the distance ``AROUND`` from its start.

    Args:
        space: The configuration space.
        values: The configuration on the path from which to start, shape (n,).
        points: The waypoints.
        rows: The indices of the next waypoints.

    Returns:
        The index of the first waypoint beyond the distance, and the configuration at the distance on the line to it; if
        all are nearer, index and configuration of the last waypoint.
    """
    row, before = -1, values
    for row in rows:
        if space.distance(points[row], values) > AROUND:
            away, step = space.difference(before, values), space.difference(points[row], before)
            weighted, line = space.weights * away, space.weights * step
            square, middle = float(line.dot(line)), float(line.dot(weighted))
            rest = AROUND**2 - float(weighted.dot(weighted))
            return row, before + step * ((sqrt(middle * middle + square * rest) - middle) / square)
        before = points[row]
    return row, before


def _from_one_source(pieces: list[MotionSegment], source: int) -> list[MotionSegment]:
    begins = np.cumsum([0.0, *(piece.duration for piece in pieces)]).tolist()
    return [piece._replace(source=source, begins=time) for piece, time in zip(pieces, begins[:-1], strict=True)]


def _shortcut(
    edges: Edges, start: tuple[Floats, Floats], end: tuple[Floats, Floats], longest: float, limits: PathLimits
) -> list[MotionSegment] | None:
    step = limits.coordinates.difference(end[0], start[0])
    bounds = limits.velocity, limits.acceleration
    duration = float(shortest_ramps(step, start[1], end[1], *bounds).max(initial=0.0))
    if not _SAME_TIME < duration < longest:
        return None
    ramps = fit_ramps(step, start[1], end[1], duration, *bounds)
    if ramps is None:
        return None
    least, greatest = ramps.reach()
    beyond = (start[0] + least < limits.lower) | (start[0] + greatest > limits.upper)
    if (beyond & ~limits.coordinates.circular).any():
        return None
    pieces = _pieces(ramps, lambda numbers: numbers, start[0])
    return pieces if all(_is_allowed(edges, piece) for piece in pieces) else None


def motion_curves(pieces: list[MotionSegment]) -> list[Curve]:
    """Return segments as curves, of which the first starts at 0 s."""
    curves, time = list[Curve](), 0.0
    for piece in pieces:
        middle = piece.values + piece.velocities * (piece.duration / 2)
        control = np.array([piece.values, middle, piece.after(piece.duration)[0]])
        curves.append(Curve(time, time + piece.duration, control))
        time += piece.duration
    return curves


def _is_allowed(edges: Edges, piece: MotionSegment) -> bool:
    """Return whether a segment is allowed everywhere after its start, tested in steps of the joint resolutions."""
    last = np.abs(piece.velocities + piece.accelerations * piece.duration)
    farthest = np.maximum(np.abs(piece.velocities), last) * piece.duration
    steps = edges.space.steps(farthest)
    test = edges.clear or edges.allowed
    return all(test(piece.after(number / steps * piece.duration)[0]) for number in bisection_order(steps))
