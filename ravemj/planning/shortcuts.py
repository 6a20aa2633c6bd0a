"""Shorter paths: straight lines, or faster ramps, in place of detours."""

from collections.abc import Callable
from itertools import pairwise
from math import ceil
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges, bisection_order
from ravemj.planning.ramps import Ramps, fit_from_rest, fit_ramps, shortest_ramps
from ravemj.planning.retiming.segments import Limits

_WORTH = 3e-3
"""A shortcut has to save this part of the whole path: testing lines is what takes time."""

_MOST_ENDS = 32
"""Number of ends of straight lines from one point that are tried."""


def shorten(
    edges: Edges,
    points: Floats,
    tries: int,
    random: np.random.Generator,
    proceed: Callable[[int], bool] = lambda attempt: True,
) -> Floats:
    """Return a path that is nowhere longer, from the same start to the same goal, shape (k, n).

    Straight lines between points of the path take the place of detours; then two random places at a time are connected
    by one, if it is allowed and shorter. This is tried ``tries`` times, while ``proceed``, asked with the number of the
    try, says so.
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
        # What is left of both lines is tested, too: in steps from its own ends, which are not those of the whole lines.
        if high - low - straight > _WORTH * ends[-1] and all(
            edges.line(one, space.difference(other, one))
            for one, other in ((start, end), (path[first], start), (end, path[second + 1]))
        ):
            path[first + 1 : second + 1] = [start, end]
    return _without_detours(edges, np.array(path))


def _place(start: Floats, step: Floats, length: float, along: float) -> Floats:
    return start + step * (along / length if length > 0 else 0.0)


def _without_detours(edges: Edges, path: Floats) -> Floats:
    """Return a path that goes from each of its points straight to the last one that a line reaches.

    Of many points, ``_MOST_ENDS`` are tried.
    """
    kept, last = [0], len(path) - 1
    while kept[-1] < last:
        start = path[kept[-1]]
        farther = range(last, kept[-1] + 1, -ceil((last - kept[-1]) / _MOST_ENDS))
        reached = (end for end in farther if edges.line(start, edges.space.difference(path[end], start)))
        kept.append(next(reached, kept[-1] + 1))
    return path[kept]


_WORTH_TIME = 1e-3
"""A shortcut has to save this part of the time."""

_SAME_TIME = 1e-9
"""Changes of acceleration this near [s] are at one time."""


class Piece(NamedTuple):
    """A motion with constant accelerations.

    Attributes:
        duration: How long it takes [s].
        values: At its start [rad or m], shape (n,).
        velocities: At its start, shape (n,).
        accelerations: Shape (n,).
        is_corner: Whether it starts where one line or shortcut meets another.
    """

    duration: float
    values: Floats
    velocities: Floats
    accelerations: Floats
    is_corner: bool

    def after(self, time: float) -> tuple[Floats, Floats]:
        """Return values and velocities a time after its start."""
        moved = self.values + self.velocities * time + self.accelerations * (time * time / 2)
        return moved, self.velocities + self.accelerations * time

    def part(self, start: float, end: float, *, is_corner: bool) -> "Piece":
        """Return what is between two times after its start."""
        values, velocities = self.after(start)
        return Piece(end - start, values, velocities, self.accelerations, is_corner)


def lines(points: Floats, limits: Limits) -> list[Piece]:
    """Return the motion along the straight lines of a path, shape (m, n), that stops at each corner."""
    motion: list[Piece] = []
    for start, end in pairwise(points):
        step = limits.coordinates.difference(end, start)
        moving = step != 0
        if not moving.any():
            continue
        way = np.abs(step[moving])
        one, rest = np.ones(1), np.zeros(1)
        speed = np.array([(limits.velocity[moving] / way).min()])
        acceleration = np.array([(limits.acceleration[moving] / way).min()])
        duration = float(shortest_ramps(one, rest, rest, speed, acceleration)[0])
        along = fit_from_rest(one, duration, speed, acceleration) if np.isfinite(duration) else None
        if along is None:
            raise ValueError("a joint moves whose velocity or acceleration limit is 0")
        motion += _pieces(along, lambda numbers, step=step: numbers * step, start)
    return motion


def _pieces(ramps: Ramps, spread: Callable[[Floats], Floats], origin: Floats) -> list[Piece]:
    times = np.concatenate([[0.0], ramps.changes(_SAME_TIME)])
    values, velocities = ramps.states(times)
    found: list[Piece] = []
    for index, duration in enumerate(np.diff(times).tolist()):
        if duration > 0:
            rate = (velocities[index + 1] - velocities[index]) / duration
            state = origin + spread(values[index]), spread(velocities[index]), spread(rate)
            found.append(Piece(duration, *state, is_corner=index == 0))
    return found


def faster(
    edges: Edges,
    motion: list[Piece],
    limits: Limits,
    tries: int,
    random: np.random.Generator,
    proceed: Callable[[int], bool] = lambda attempt: True,
) -> list[Piece]:
    """Return a motion that is nowhere slower, from the same start to the same end.

    It tries ``tries`` shortcuts between random times, while ``proceed``, asked with the number of the try, says so.
    """
    for attempt in range(tries):
        if not motion or not proceed(attempt):
            break
        ends: Floats = np.cumsum([piece.duration for piece in motion])
        low, high = sorted((random.random() * float(ends[-1]), random.random() * float(ends[-1])))
        first, second = (min(int(np.searchsorted(ends, time)), len(motion) - 1) for time in (low, high))
        before = low - (ends[first] - motion[first].duration)
        behind = high - (ends[second] - motion[second].duration)
        start, end = motion[first].after(before), motion[second].after(behind)
        shortcut = _shortcut(edges, start, end, (high - low) * (1 - _WORTH_TIME), limits)
        if shortcut is not None:
            head = [motion[first].part(0.0, before, is_corner=motion[first].is_corner)]
            tail = [motion[second].part(behind, motion[second].duration, is_corner=True)]
            fresh = [piece for piece in [*head, *shortcut, *tail] if piece.duration > _SAME_TIME]
            motion = [*motion[:first], *fresh, *motion[second + 1 :]]
    return motion


def _shortcut(
    edges: Edges, start: tuple[Floats, Floats], end: tuple[Floats, Floats], longest: float, limits: Limits
) -> list[Piece] | None:
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


def _is_allowed(edges: Edges, piece: Piece) -> bool:
    """Return whether a piece is allowed everywhere, its start excluded; no joint moves farther than its resolution."""
    last = np.abs(piece.velocities + piece.accelerations * piece.duration)
    farthest = np.maximum(np.abs(piece.velocities), last) * piece.duration
    steps = edges.space.steps(farthest)
    return all(edges.allowed(piece.after(number / steps * piece.duration)[0]) for number in bisection_order(steps))
