"""Three joints that carry a point to a point, or a plane to a plane: F1 F2 F3 start = goal."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ravemj.ik.families.pairs import Measure, Pair, Side
from ravemj.ik.subproblems import solve_linear, turn_between
from ravemj.ik.vectors import Floats, Screw, cross, dot, tile

Screws = Sequence[Screw]
_NEAR = 1e-9
"""Length, divided by the reach, or sine of an angle between axes that counts as zero."""


@dataclass(frozen=True)
class Plane:
    """Planes moved by joints: a normal and a point, both of shape (3, B, N)."""

    normal: Floats
    point: Floats


class CarryPoint:
    """Three joints that carry a point to a point: the position part of arms with a spherical wrist or shoulder.

    Attributes:
        pair: Solution method for the first and the third joint.
        foot: The joint, 0 or 2, whose axis intersects that of the revolute middle joint; 1 if none.
        measure: Invariants of the middle joint if they are the same for all poses, else None.
    """

    def __init__(self, screws: Screws, start: Floats, goal: Floats) -> None:
        """Detect the solution method from example starts and goals.

        Raises:
            NoFamilyError: the joints cannot carry points to arbitrary positions.
        """
        self.middle = screws[1]
        self.foot = 1 if self.middle.prismatic else _foot(screws)
        self._crossing = _crossing(screws) if self.middle.prismatic else (None, None)
        self.measure = self._measured(screws) if all(screw.shared for screw in screws) else None
        self._cached: dict[int, Side] = {}
        sides = self._sides(screws, start, goal)
        sphere = not self.middle.prismatic
        pair = Pair.detect(sides, (screws[0].prismatic, screws[2].prismatic), sphere=sphere)
        if pair is None:
            raise NoFamilyError
        self.pair = pair
        if self.measure is not None:
            if start.size == 3:
                self._cached[1] = sides[1]
            if goal.size == 3:
                self._cached[0] = sides[0]

    def _measured(self, screws: Screws) -> Measure:
        first, middle, third = screws
        if not middle.prismatic:
            point = middle.point if self.foot == 1 else _nearest(middle, screws[self.foot])
            return Measure(middle.axis, point, sphere=True)
        by, how = self._crossing
        if by is None:
            seed = np.eye(3)[np.argmin(np.abs(middle.axis).reshape(3, -1).max(axis=1))].reshape(3, 1, 1)
            direction = cross(middle.axis, np.broadcast_to(seed, middle.axis.shape))
        else:
            other = (first, middle, third)[by]
            direction = other.axis if how == "along" else cross(middle.axis, other.axis)
        direction = direction / np.sqrt(dot(direction, direction))
        return Measure(direction, cross(middle.axis, direction), sphere=False)

    def _sides(self, screws: Screws, start: Floats, goal: Floats) -> tuple[Side, Side]:
        measure = self.measure or self._measured(screws)
        one = self._cached.get(0) or measure.side(screws[0], goal, -1.0)
        three = self._cached.get(1) or measure.side(screws[2], start, 1.0)
        return one, three

    @property
    def names(self) -> list[tuple[int, int]]:
        """Return the joints with several solutions: index, 0 to 2, and number of solutions."""
        return _names(self.pair)

    def solve(self, screws: Screws, start: Floats, goal: Floats) -> list[Floats]:
        """Return the joint values, cosine and sine (2, B, N) or distances (1, B, N), that carry points (3, B, N).

        Screws that do not depend on the pose must be the same as in ``__init__``.
        """
        first, middle, third = screws
        one, three = self.pair.solve(*self._sides(screws, start, goal))
        before = first.moved_back(one, tile(goal, one.shape[-2]))
        after = third.moved(three, tile(start, three.shape[-2]))
        if middle.prismatic:
            two = dot(middle.axis, before - after)[None]
        else:
            two = turn_between(middle, after - middle.point, before - middle.point)
        return [one, two, three]


class CarryPlane:
    """Three joints that carry a plane to a plane: the remaining joints of an arm with three parallel axes.

    If one of the three is prismatic, the other two rotate the normal, and the prismatic one corrects the offset.
    """

    def __init__(self, screws: Screws, start: Plane, goal: Plane) -> None:
        """Detect the solution method from example starts and goals.

        Raises:
            NoFamilyError: the joints cannot carry planes to arbitrary positions.
        """
        self.slider = next((index for index, screw in enumerate(screws) if screw.prismatic), None)
        self.pair: Pair | None = None
        if sum(screw.prismatic for screw in screws) > 1:
            raise NoFamilyError
        if self.slider is not None:
            first, second = (screw for screw in screws if not screw.prismatic)
            if np.abs(cross(first.axis, second.axis)).max() < _NEAR:
                raise NoFamilyError
            return
        self.foot = _foot(screws)
        pair = Pair.detect(self._sides(screws, start, goal), (False, False), sphere=False)
        if pair is None:
            raise NoFamilyError
        self.pair = pair

    def _sides(self, screws: Screws, start: Plane, goal: Plane) -> tuple[Side, Side]:
        first, middle, third = screws
        point = middle.point if self.foot == 1 else _nearest(middle, screws[self.foot])
        return (
            _plane_side(first, middle, point, goal, -1.0),
            _plane_side(third, middle, point, start, 1.0),
        )

    @property
    def names(self) -> list[tuple[int, int]]:
        """Return the joints with several solutions: index, 0 to 2, and number of solutions."""
        if self.pair is not None:
            return _names(self.pair)
        return [(2 if self.slider != 2 else 1, 2)]

    def solve(self, screws: Screws, start: Plane, goal: Plane) -> list[Floats]:
        """Return the values of the three joints, cosine and sine (2, B, N) or distances (1, B, N)."""
        if self.pair is None:
            return self._solve_sliding(screws, start, goal)
        first, middle, third = screws
        one, three = self.pair.solve(*self._sides(screws, start, goal))
        before = first.turned_back(one, tile(goal.normal, one.shape[-2]))
        after = third.turned(three, tile(start.normal, three.shape[-2]))
        return [one, turn_between(middle, after, before), three]

    def _solve_sliding(self, screws: Screws, start: Plane, goal: Plane) -> list[Floats]:
        """Turn the normal by the two revolute joints (subproblem 2), then move the plane by the prismatic one."""
        first, second = (screw for screw in screws if not screw.prismatic)
        along, across, later = second.split(start.normal)
        rest = dot(first.axis, goal.normal) - dot(first.axis, along)
        late = solve_linear(dot(first.axis, across), dot(first.axis, later), rest)
        early = turn_between(first, second.turned(late, start.normal), tile(goal.normal, late.shape[-2]))
        turns = iter((early, late))
        values = [np.zeros((1, 1, 1)) if screw.prismatic else next(turns) for screw in screws]
        point, direction = start.point, np.zeros((3, 1, 1))
        for screw, value in zip(reversed(screws), reversed(values), strict=True):
            point = screw.moved(value, point)
            direction = screw.axis if screw.prismatic else screw.turned(value, direction)
        pitch = dot(goal.normal, direction)
        gap = dot(goal.normal, goal.point) - dot(goal.normal, point)
        values[self.slider or 0] = (gap / np.where(pitch == 0, np.inf, pitch))[None]
        return values


class NoFamilyError(Exception):
    """The arm's geometry does not belong to a family."""


def _plane_side(joint: Screw, middle: Screw, foot: Floats, plane: Plane, sign: float) -> Side:
    """Return the invariants of a plane moved by ``joint``: tilt against the middle axis, distance from point ``foot``.

    If ``sign`` is -1, the joint moves backwards.
    """
    direction = Screw(joint.axis, np.zeros((3, 1, 1)))
    side = Measure(middle.axis, joint.point - foot, sphere=False).side(direction, plane.normal, sign)
    offset = dot(plane.normal, plane.point - joint.point)
    shape = np.broadcast_shapes(side.constant.shape[1:], offset.shape)
    constant = np.broadcast_to(side.constant, (2, *shape)).copy()
    constant[1] += offset
    return Side(constant, side.factors)


def _names(pair: Pair) -> list[tuple[int, int]]:
    first = (0 if pair.sliding == (False, True) else 2) if pair.alone is None else 2 * pair.alone[0]
    return [(first, pair.choices[0]), (2 - first, pair.choices[1])]


def _foot(screws: Screws) -> int:
    """Return the revolute joint, 0 or 2, whose axis intersects that of the middle joint; 1 if none does."""
    return next((side for side in (0, 2) if not screws[side].prismatic and _meet(screws[1], screws[side])), 1)


def _meet(first: Screw, other: Screw) -> bool:
    """Return whether two axes intersect without being parallel, in all example configurations."""
    normal = cross(*np.broadcast_arrays(first.axis, other.axis))
    if np.sqrt(dot(normal, normal)).min() < _NEAR:
        return False
    return bool(np.abs(dot(normal, other.point - first.point)).max() < _NEAR)


def _nearest(first: Screw, other: Screw) -> Floats:
    """Return the point on the axis of ``first`` nearest to the axis of ``other``."""
    away, cosine = other.point - first.point, dot(first.axis, other.axis)
    distance = (dot(away, first.axis) - cosine * dot(away, other.axis)) / (1 - cosine * cosine)
    return first.point + distance * first.axis


def _crossing(screws: Screws) -> tuple[int | None, str]:
    """Find a direction in which neither the prismatic middle joint nor one of the outer joints moves points.

    Returns:
        The index of that outer joint, 0 or 2, and ``along`` (the direction is that of its axis) or ``across``
        (perpendicular to both axes); None and an empty string if there is no such direction.
    """
    middle = screws[1]
    for index in (0, 2):
        other = screws[index]
        if not other.prismatic and np.abs(dot(middle.axis, other.axis)).max() < _NEAR:
            return index, "along"
        normal = cross(*np.broadcast_arrays(middle.axis, other.axis))
        if other.prismatic and np.sqrt(dot(normal, normal)).min() > _NEAR:
            return index, "across"
    return None, ""
