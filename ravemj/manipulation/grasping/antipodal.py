"""Grasps for parallel jaws from pairs of antipodal points on the surface of an object.

Two contacts with friction are in force closure in the plane if the line between them lies inside both friction cones.
So two jaws need no simulation: only a pair of points whose distance fits between them, and a free approach. Input and
output are arrays; a function casts the rays.
"""

from collections.abc import Callable, Iterator
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, cross_rows

Cast = Callable[[Floats], tuple[NDArray[np.bool_], Floats]]
"""Function that casts rays: start, and direction times length, shape (n, 6).

It returns the mask of rays that hit the surface, shape (n,), and position and outward normal of the first hit of each
ray, shape (n, 6).
"""

_INSIDE = 1e-5
"""Depth below the surface at which rays through the object start [m]."""

_ROUNDING = 1e-9

_AROUND = 8
"""Number of lines to try around a normal, at each of two angles from it."""

_SAME = 1e-3
"""Tolerance of equal points [m]."""


class Jaws(NamedTuple):
    """Two fingers that slide towards each other, in the frame of the tool.

    Attributes:
        axis: Unit vector of the closing motion, shape (3,).
        approach: Unit vector of the approach, perpendicular to the axis, shape (3,).
        middle: Coordinate along ``axis`` of the middle between the fingers [m].
        width: Largest distance between the fingers [m].
        depth: Coordinate along ``approach`` of the grasp points between the jaws [m].
    """

    axis: Floats
    approach: Floats
    middle: float
    width: float
    depth: float = 0.0


class Pair(NamedTuple):
    """Two surface points, shape (3,) [m], and the reason why jaws cannot hold there; empty if they can."""

    first: Floats
    second: Floats
    reason: Literal["", "too wide", "not closed"]


def pairs(rows: Floats, cast: Cast, friction: float, width: float) -> list[Pair]:
    """Return pairs of a surface point and an opposite point, each with a reason if jaws cannot hold it.

    The opposite points are the nearest along a line into the object and, if it differs, the farthest within ``width``:
    a mug can be held by its wall and from both sides. The first line is the normal. If its opposite point is outside
    the friction cone, other lines in the cone of the first point are tried, and for each the bisector of both normals,
    which finds the grasp of a wedge if there is any.

    Args:
        rows: Points and outward unit normals, shape (n, 6) [m].
        cast: Casts rays against the surface.
        friction: Friction coefficient.
        width: Largest distance of the two points [m].

    Example:
        >>> pairs([[0.02, 0, 0, 1, 0, 0]], cast, friction=0.4, width=0.08)
        [Pair(first=array([0.02, 0., 0.]), second=array([-0.02, 0., 0.]), reason='')]
    """
    rows = np.asarray(rows, dtype=float).reshape(-1, 6)
    candidates: list[Pair] = []
    for near in (True, False):
        fits, opposite = _opposite(rows, -rows[:, 3:], cast, width, near=near)
        good = np.zeros(len(rows), dtype=np.bool_)
        for lines in _lines(-rows[:, 3:], friction):
            rest = np.flatnonzero(~good)
            for _ in range(2):
                leaves, points = _opposite(rows[rest], lines[rest], cast, width, near=near)
                holds = leaves & is_antipodal(rows[rest], points, friction)
                good[rest[holds]], opposite[rest[holds]] = True, points[holds]
                middle = points[:, 3:] - rows[rest, 3:]
                length = np.linalg.norm(middle, axis=1)
                again = leaves & ~holds & (length > _ROUNDING)
                rest = rest[again]
                lines[rest] = middle[again] / length[again, None]
        reasons = np.where(good, "", np.where(fits, "not closed", "too wide"))
        candidates += [
            Pair(row[:3], other[:3], reason)
            for row, other, reason in zip(rows, opposite, reasons.tolist(), strict=True)
        ]
    return _distinct(candidates)


def is_antipodal(first: Floats, second: Floats, friction: float) -> NDArray[np.bool_]:
    """Return whether the lines between pairs of points lie inside both friction cones, shape (n,).

    Args:
        first: Points and outward unit normals, shape (n, 6) [m].
        second: The opposite points and normals, shape (n, 6) [m].
        friction: Friction coefficient.
    """
    lines = second[:, :3] - first[:, :3]
    lengths = np.linalg.norm(lines, axis=1)
    lowest = (1 / np.hypot(1.0, friction) - _ROUNDING) * lengths  # cosine of the angle of the cone
    inward = -(first[:, 3:] * lines).sum(axis=1)
    outward = (second[:, 3:] * lines).sum(axis=1)
    return (lengths > _ROUNDING) & (inward >= lowest) & (outward >= lowest)


def tool_poses(pair: Pair, jaws: Jaws, rolls: int = 8) -> list[Floats]:
    """Return tool poses in the frame of the points, shape (4, 4) each, with a pair centred between the jaws.

    The poses differ by ``rolls`` rotations about the line through the pair.
    """
    line = (pair.second - pair.first) / np.linalg.norm(pair.second - pair.first)
    side = np.zeros(3)
    side[int(np.abs(line).argmin())] = 1.0
    side -= line * (line @ side)
    side /= np.linalg.norm(side)
    third = np.cross(line, side)
    R_tool_jaws = np.column_stack([jaws.axis, jaws.approach, np.cross(jaws.axis, jaws.approach)])
    poses: list[Floats] = []
    for angle in 2 * np.pi * np.arange(rolls) / rolls:
        approach = np.cos(angle) * side + np.sin(angle) * third
        T = np.eye(4)
        T[:3, :3] = np.column_stack([line, approach, np.cross(line, approach)]) @ R_tool_jaws.T
        T[:3, 3] = (pair.first + pair.second) / 2 - jaws.middle * line - jaws.depth * approach
        poses.append(T)
    return poses


def _lines(inward: Floats, friction: float) -> Iterator[Floats]:
    """Yield lines into the object, unit vectors (n, 3): inward normals, then others in their friction cones."""
    yield inward.copy()
    side = np.eye(3)[np.abs(inward).argmin(axis=1)]
    side -= inward * (inward * side).sum(axis=1, keepdims=True)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    third = cross_rows(inward, side)
    for share in (0.95, 0.5):
        for angle in 2 * np.pi * np.arange(_AROUND) / _AROUND:
            lines = inward + share * friction * (np.cos(angle) * side + np.sin(angle) * third)
            yield lines / np.linalg.norm(lines, axis=1, keepdims=True)


def _opposite(rows: Floats, lines: Floats, cast: Cast, width: float, *, near: bool) -> tuple[NDArray[np.bool_], Floats]:
    """Return the mask of lines that leave the object within ``width``, and their exit points.

    These are the nearest ones if ``near`` is True, else the farthest ones.
    """
    if near:
        return cast(np.hstack([rows[:, :3] + _INSIDE * lines, (width - _INSIDE) * lines]))
    hit, points = cast(np.hstack([rows[:, :3] + width * lines, -width * lines]))
    # a ray that begins inside the object meets the surface from within: the object is wider than the jaws
    return hit & ((points[:, 3:] * lines).sum(axis=1) > 0), points


def _distinct(candidates: list[Pair]) -> list[Pair]:
    """Return pairs without duplicates: (a, b) equals (b, a); rejected pairs are equal if their first points are."""
    seen: set[tuple[tuple[int, ...], ...]] = set()
    distinct: list[Pair] = []
    for pair in candidates:
        ends = [tuple(np.round(point / _SAME).astype(int).tolist()) for point in (pair.first, pair.second)]
        key = tuple(sorted(ends)) if not pair.reason else (*ends[:1],)
        if key not in seen:
            seen.add(key)
            distinct.append(pair)
    return distinct
