"""Six revolute joints of general geometry: up to sixteen solutions by an eigenvalue problem.

M. Raghavan and B. Roth ("Inverse kinematics of the general 6R manipulator and related linkages", 1993) write
E3 E4 E5 = E2⁻¹ E1⁻¹ X E6⁻¹ for a direction l and a point p of the sixth axis. Both sides of l, p, p·p, p·l, p x l and
(p·p) l - 2 (p·l) p are linear in products of cosines and sines, of joints 3, 4 and 5 on the left and of 1 and 2 on the
right. Of these fourteen equations six are left when the eight products on the right are eliminated. With half-angle
tangents they are polynomials in those of joints 4 and 5; with each multiplied by the tangent of joint 4 there are
twelve equations in twelve monomials, and D. Manocha and J. F. Canny (1994) find the tangent of joint 3 as an eigenvalue
of a matrix of 24 rows, and the others in its eigenvector.

The coefficients are fitted to values at three angles of each joint, which needs neither symbolic algebra nor
Denavit-Hartenberg frames. Half angles are measured from generic angles.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ravemj.ik.families.carrying import NoFamilyError
from ravemj.ik.families.loops import Arm, Locked
from ravemj.ik.subproblems import normalized, turn_between
from ravemj.ik.vectors import Floats, Screw, Transform, constant, cross, dot, perpendicular, turn_of

_GRID: Floats = np.array([0.0, 2 * np.pi / 3, 4 * np.pi / 3])
_FIT = np.linalg.inv(np.stack([np.ones(3), np.cos(_GRID), np.sin(_GRID)], axis=1))
"""Matrix that fits the coefficients of 1, cos and sin to a function's values at the three angles of ``_GRID``."""
_HALF = np.array([[1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [0.0, 2.0, 0.0]])
"""1, cos and sin as quadratic polynomials of the half-angle tangent t, multiplied by 1 + t²; one per row."""
_ORIGINS = (0.731, -1.173, 2.517)
"""Zeros of the half-angle tangents of joints 3, 4 and 5 [rad]; generic, to avoid infinite tangents."""
_BRANCHES = 16
_UNIT = np.einsum("x,y,z->xyz", *[_HALF[0]] * 3).reshape(3, 9)


class General:
    """General six-revolute arm as a closed loop, which can start at any joint, in either direction.

    If axes intersect or are parallel, the elimination fails for some of these choices, so all are tried.
    """

    name, why = "general 6R", "the arm has six revolute joints, with added ones, whatever their axes"
    coupled, shared, equations = True, False, "an eigenvalue problem of 24 rows"

    def __init__(self, arm: Arm, shift: int, *, backward: bool) -> None:
        """Arrange the joints in a loop that starts at joint ``shift``; ``backward`` reverses it, from tool to base.

        Raises:
            NoFamilyError: the joints are not six revolute ones, or there are locked ones between them.
        """
        self.arm, self.shift, self.backward = arm, shift, backward
        places = arm.inner
        if len(places) != 6 or set(places) & arm.locked or any(arm.screws[place].prismatic for place in places):
            raise NoFamilyError
        places = places[::-1] if backward else places
        self.order = [*places[shift:], *places[:shift]]
        sign = -1.0 if backward else 1.0
        self._screws = [Screw(sign * arm.screws[place].axis, arm.screws[place].point) for place in self.order]
        self._shared_left = None if shift else _left(self._screws)

    def names(self) -> list[tuple[int, int]]:
        """Return the joint with several solutions: index, number of solutions."""
        return [(self.order[2], _BRANCHES)]

    def solve(self, motion: Transform, locked: Locked) -> list[Floats]:
        """Return cosines and sines of the joints in ``order``, with 16 branches."""
        needed, back = (motion.inverse(), motion) if self.backward else (motion, motion.inverse())
        count = 6 - self.shift
        screws = [*self._screws[:count], *(screw.carried(back) for screw in self._screws[count:])]
        left = _left(screws) if self._shared_left is None else self._shared_left
        right = _right(screws, needed)
        u, s, vt = np.linalg.svd(right[:, :, 1:])
        kept = u[:, :, 8:].swapaxes(1, 2)
        offset = kept @ right[:, :, :1]
        matrix = (kept @ left).reshape(-1, 6, 3, 9).swapaxes(1, 2) - offset[:, None] * _UNIT[:, None]
        turns = [_turn(tangent, origin) for tangent, origin in zip(_eigen(matrix), _ORIGINS, strict=True)]
        inner = u[:, :, :8].swapaxes(1, 2) @ (_carried(screws, turns).transpose(2, 0, 1) - right[:, :, :1])
        products = (vt.swapaxes(1, 2) @ (inner / np.maximum(s, 1e-12)[:, :, None])).transpose(1, 2, 0)
        turns = [normalized(products[[2, 5]]), normalized(products[[0, 1]]), *turns]
        side = constant(perpendicular(self._screws[5].axis.ravel()))
        if self.shift:
            side = back.turned(side)
        end = needed.turned(side)
        for screw, turn in zip(screws, turns, strict=False):
            end = screw.turned_back(turn, end)
        return [*turns, turn_between(screws[5], side, end)]


def _left(screws: Sequence[Screw]) -> Floats:
    """Return the left sides of the 14 loop equations as polynomials in three half-angle tangents, shape (N, 14, 27)."""
    turns = [turn_of((_GRID + origin).reshape(3, 1)) for origin in _ORIGINS]
    places = np.indices((3, 3, 3)).reshape(3, 27)
    values = _carried(screws, [turn[:, place] for turn, place in zip(turns, places, strict=True)])
    polynomials = _FIT.T @ _HALF
    factors = np.einsum("ax,by,cz,eabcn->nexyz", *[polynomials] * 3, values.reshape(14, 3, 3, 3, -1))
    return factors.reshape(-1, 14, 27)


def _carried(screws: Sequence[Screw], turns: Sequence[Floats]) -> Floats:
    """Return the left sides of the 14 loop equations, (14, B, N), for cosines and sines of joints 3, 4 and 5."""
    line, point = screws[5].axis, screws[5].point
    for screw, turn in zip(screws[4:1:-1], turns[::-1], strict=True):
        line, point = screw.turned(turn, line), screw.moved(turn, point)
    return _numbers(line, point - screws[2].point)


def _right(screws: Sequence[Screw], motion: Transform) -> Floats:
    """Return the right sides' coefficients of 1, c2, s2, c1, c1 c2, c1 s2, s1, s1 c2, s1 s2, shape (N, 14, 9)."""
    first, second = (turn_of(_GRID.reshape(3, 1))[:, place] for place in np.indices((3, 3)).reshape(2, 9))
    line, point = motion.turned(screws[5].axis), motion.moved(screws[5].point)
    line = screws[1].turned_back(second, screws[0].turned_back(first, line))
    point = screws[1].moved_back(second, screws[0].moved_back(first, point))
    values = _numbers(line, point - screws[2].point)
    return np.einsum("ax,by,exyn->neab", _FIT, _FIT, values.reshape(14, 3, 3, -1)).reshape(-1, 14, 9)


def _numbers(line: Floats, point: Floats) -> Floats:
    """Stack l, p, p·p, p·l, p x l and (p·p) l - 2 (p·l) p for directions l and points p: 14 rows."""
    line, point = np.broadcast_arrays(line, point)
    square, along = dot(point, point), dot(point, line)
    return np.concatenate(
        [line, point, square[None], along[None], cross(point, line), square * line - 2 * along * point]
    )


def _eigen(matrix: Floats) -> list[Floats]:
    """Return the half-angle tangents of joints 3, 4 and 5, each (16, N), by an eigenvalue problem.

    ``matrix`` has shape (N, 3, 6, 9): for powers 0, 1, 2 of the first tangent, six equations in the monomials x^i y^j
    of the others, i and j up to 2. With the same equations times x, they form a square matrix polynomial in the first
    tangent; at a solution it is singular, and the monomials are in its null space.
    """
    count = len(matrix)
    whole = np.zeros((count, 3, 12, 12))
    whole[:, :, :6, :9], whole[:, :, 6:, 3:] = matrix, matrix
    companion = np.zeros((count, 24, 24))
    companion[:, :12, 12:] = np.eye(12)
    try:
        companion[:, 12:] = -np.linalg.solve(whole[:, 2], np.concatenate([whole[:, 0], whole[:, 1]], axis=2))
    except np.linalg.LinAlgError:  # some roots are infinite, or nearly so
        noise = np.random.default_rng(12).normal(size=(12, 12))
        lead = whole[:, 2] + 1e-13 * np.abs(whole[:, 2]).max() * noise
        companion[:, 12:] = -np.linalg.solve(lead, np.concatenate([whole[:, 0], whole[:, 1]], axis=2))
    roots: NDArray[np.complex128]
    vectors: NDArray[np.complex128]
    roots, vectors = np.linalg.eig(companion)
    order = np.argsort(np.abs(roots.imag) / (1 + np.abs(roots) ** 2), axis=1, kind="stable")[:, :_BRANCHES]
    roots = np.take_along_axis(roots, order, axis=1)
    vectors = np.take_along_axis(vectors, order[:, None], axis=2)
    large = np.where(np.abs(roots)[:, None] > 1, vectors[:, 12:], vectors[:, :12]).reshape(count, 4, 3, -1)
    return [roots.real.T, _ratio(large[:, :-1], large[:, 1:]), _ratio(large[:, :, :-1], large[:, :, 1:])]


def _ratio(low: NDArray[np.complex128], high: NDArray[np.complex128]) -> Floats:
    """Return a tangent, (16, N), as ``high / low``, monomials that differ by one power of it.

    The largest of these pairs is used, which is the most accurate.
    """
    low, high = (part.reshape(len(part), -1, part.shape[-1]) for part in (low, high))
    best = np.argmax(np.abs(low) + np.abs(high), axis=1)[:, None]
    below, above = np.take_along_axis(low, best, axis=1)[:, 0], np.take_along_axis(high, best, axis=1)[:, 0]
    return (above / np.where(below == 0, 1e-300, below)).real.T


def _turn(tangent: Floats, origin: float) -> Floats:
    return turn_of(2 * np.arctan(tangent) + origin)
