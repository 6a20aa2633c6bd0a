"""Blocks of three adjacent joints that form a group of motions: rotations about a point, or planar motions.

The invariant of the group (the point, or the plane) gives equations without its three joints. Once the other joints are
known, so is the required motion of the block, which is passed as functions that move directions and points.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ravemj.ik.families.carrying import CarryPoint
from ravemj.ik.subproblems import turn_between
from ravemj.ik.vectors import Floats, Screw, constant, cross, dot, perpendicular, skew, tile


class RigidMotion(NamedTuple):
    """Rigid motion as two functions that apply it to directions and to points, shape (3, B, N)."""

    turned: Callable[[Floats], Floats]
    moved: Callable[[Floats], Floats]


class Wrist:
    """Three revolute joints whose axes meet in a point: R_a R_b R_c = R.

    The middle one follows from the angle between the outer axes (subproblem 4), the first one from the direction of the
    third axis (subproblem 1), the last one from the remaining rotation. If the outer axes coincide, only the sum of
    their joints matters, and the first one is set to 0.

    Attributes:
        centre: The point, shape (3, 1, 1).
        side: A direction perpendicular to the last axis, shape (3, 1, 1); its rotation determines the last joint.
        phase: Cosine and sine of the middle joint at the smallest angle between the outer axes.
        gaps: 1 - cos of the smallest angle between the outer axes, and 1 + cos of the largest.
    """

    names = ((1, 2),)

    def __init__(self, screws: Sequence[Screw], centre: Floats) -> None:
        self.screws, self.centre = tuple(screws), centre
        a, b, c = (screw.axis.ravel() for screw in screws)
        cosine, sine = a @ c - (a @ b) * (b @ c), a @ skew(b) @ c
        self._size = float(np.hypot(cosine, sine))
        self.phase = float(cosine / self._size), float(sine / self._size)
        gaps = 1 - self._size - (a @ b) * (b @ c), 1 - self._size + (a @ b) * (b @ c)
        self.gaps = [0.0 if abs(gap) < 1e-12 else float(gap) for gap in gaps]
        self.side = constant(perpendicular(c))

    def describe(self, joints: Sequence[int]) -> tuple[str, str]:
        """Return the name of the family and the reason for membership, for the joint indices ``joints``."""
        return "spherical wrist", f"the axes of joints {_numbers(joints)} meet in a point"

    def solve(self, needed: RigidMotion) -> list[Floats]:
        """Return cosines and sines of the three joints, shape (2, B, N) each, with two branches."""
        first, middle, last = self.screws
        tip = needed.turned(last.axis)
        two = self._middle(tip)
        turn = turn_between(first, middle.turned(two, last.axis), tile(tip, two.shape[-2]))
        side = first.turned_back(turn, tile(needed.turned(self.side), two.shape[-2]))
        return [turn, two, turn_between(last, self.side, middle.turned_back(two, side))]

    def _middle(self, tip: Floats) -> Floats:
        """Return both solutions of the wrist's middle joint, as cosine and sine, for the last axis along ``tip``.

        They are computed from distances of unit vectors, since the cosine of the angle would lose half of the digits
        if the outer axes nearly coincide.
        """
        axis = self.screws[0].axis
        least, most = (dot(away, away) / 2 for away in (axis - tip, axis + tip))
        below = np.maximum(least - self.gaps[0], 0.0)  # 1 - cos and 1 + cos of the angle from the phase, in proportion
        above = np.maximum(most - self.gaps[1], 0.0)
        cosine, sine = (above - below) / (above + below), 2 * np.sqrt(below * above) / (above + below)
        c, s = self.phase
        cosines, sines = [c * cosine - s * sine, c * cosine + s * sine], [s * cosine + c * sine, s * cosine - c * sine]
        return np.array([np.concatenate(cosines, axis=-2), np.concatenate(sines, axis=-2)])


class Planar:
    """Three joints of a planar motion: revolute ones with parallel axes, prismatic ones perpendicular to these.

    The two joints before the last revolute one carry a point of its axis; the last one gives the remaining rotation. If
    the last joint is prismatic, the block is solved from its other end.

    Attributes:
        normal: The direction of the revolute axes, shape (3, 1, 1).
        centre: A point on the first revolute axis, shape (3, 1, 1).
        backward: Whether to solve for the inverse of the motion.
    """

    def __init__(self, screws: Sequence[Screw]) -> None:
        """Detect which joints are prismatic, and prepare the solution.

        Raises:
            NoFamilyError: the joints cannot move the plane freely.
        """
        revolute = [screw for screw in screws if not screw.prismatic]
        self.screws, self.normal, self.centre = tuple(screws), revolute[0].axis, revolute[0].point
        self._side = constant(perpendicular(self.normal.ravel()))
        self.backward = screws[2].prismatic and not screws[0].prismatic
        self._between = screws[0].prismatic and screws[2].prismatic
        self._carry: CarryPoint | None = None
        if self.backward:
            self._order = tuple(Screw(-screw.axis, screw.point, screw.prismatic) for screw in reversed(screws))
        else:
            self._order = self.screws
        self._carried = (*self._order[:2], Screw(self.normal, self.centre, prismatic=True))
        if not self._between:
            rng = np.random.default_rng(0)
            places = constant(self._order[2].point.ravel()) + rng.normal(size=(3, 1, 32))
            self._carry = CarryPoint(self._carried, self._order[2].point, places)

    @property
    def names(self) -> tuple[tuple[int, int], ...]:
        """Return the joints with several solutions: index, 0 to 2, and number of solutions."""
        names = self._carry.names if self._carry is not None else []
        return tuple((2 - joint if self.backward else joint, count) for joint, count in names)

    def describe(self, joints: Sequence[int]) -> tuple[str, str]:
        """Return the name of the family and the reason for membership, for the joint indices ``joints``."""
        return "parallel axes", f"joints {_numbers(joints)} move a plane in itself"

    def solve(self, motion: RigidMotion) -> list[Floats]:
        """Return the joint values for a required motion, or its inverse if ``backward``."""
        if self._carry is None:
            return self._solve_between(motion)
        first, middle, last = self._order
        goal = motion.moved(last.point)
        one, two, _ = self._carry.solve(self._carried, last.point, goal)
        side = tile(motion.turned(self._side), one.shape[-2])
        three = turn_between(last, self._side, middle.turned_back(two, first.turned_back(one, side)))
        return [three, two, one] if self.backward else [one, two, three]

    def _solve_between(self, motion: RigidMotion) -> list[Floats]:
        """Solve three planar joints, a revolute one between two prismatic ones: its angle follows from the rotation."""
        first, middle, last = self._order
        turn = turn_between(middle, self._side, motion.turned(self._side))
        way = motion.moved(middle.point) - middle.point
        direction = middle.turned(turn, last.axis)
        area = dot(self.normal, cross(first.axis, direction))
        area = np.where(area == 0, np.inf, area)
        one = dot(self.normal, cross(*np.broadcast_arrays(way, direction))) / area
        return [one[None], turn, (dot(self.normal, cross(first.axis, way)) / area)[None]]


def _numbers(joints: Sequence[int]) -> str:
    names = [f"{joint + 1}" for joint in joints if joint >= 0]
    added = len(joints) - len(names)
    return ", ".join(names) + (f" and {added} added" if added else "")


def common_point(screws: Sequence[Screw], tolerance: float) -> Floats | None:
    """Return the point, shape (3,), where the axes of revolute joints intersect; None if they do not."""
    if any(screw.prismatic for screw in screws):
        return None
    across = [np.eye(3) - np.outer(screw.axis, screw.axis) for screw in screws]
    points = [screw.point.ravel() for screw in screws]
    total: Floats = np.sum(across, axis=0)
    if np.linalg.matrix_rank(total, tol=1e-6) < 3:
        return None
    pulls: Floats = np.sum([part @ point for part, point in zip(across, points, strict=True)], axis=0)
    centre = np.asarray(np.linalg.solve(total, pulls), dtype=float)
    missed = [np.linalg.norm(part @ (centre - point)) for part, point in zip(across, points, strict=True)]
    return centre if max(missed) < tolerance else None


def is_planar(screws: Sequence[Screw], tolerance: float) -> bool:
    """Return whether joints move in a plane, in at least two directions."""
    turning = [screw.axis.ravel() for screw in screws if not screw.prismatic]
    sliding = [screw.axis.ravel() for screw in screws if screw.prismatic]
    if not turning or any(np.linalg.norm(np.cross(turning[0], axis)) > tolerance for axis in turning):
        return False
    if any(abs(turning[0] @ axis) > tolerance for axis in sliding):
        return False
    return len(sliding) < 2 or bool(np.linalg.norm(np.cross(sliding[0], sliding[1])) > tolerance)
