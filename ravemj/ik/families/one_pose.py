"""Solver of a single pose in Python floats, for six revolute joints with a spherical wrist or shoulder.

The equations are those of ``BlockFamily`` with a ``Wrist``. For one pose, the overhead of a numpy call is fifty times
its arithmetic, so Python floats are twice as fast.
"""

from math import sqrt

from ravemj.ik.families.blocks import Wrist
from ravemj.ik.families.carrying import CarryPoint
from ravemj.ik.families.loops import BlockFamily, Family
from ravemj.ik.subproblems import ON_AXIS
from ravemj.ik.vectors import TINY, Floats, Screw

Vector = tuple[float, float, float]
Turn = tuple[float, float]
"""Cosine and sine of an angle."""
Motion = tuple[Vector, Vector, Vector, Vector]
"""Rotation matrix as three rows, and translation."""


class OnePose:
    """Solver of a single pose; joints and branches are in the family's order. ``for_family`` makes it."""

    def __init__(self, family: BlockFamily, wrist: Wrist, carry: CarryPoint, alone: tuple[int, int]) -> None:
        places, block = family.circle.places, family.circle.block
        self._arm = [_line(family.arm.screws[place]) for place in places]
        self._wrist = [_vector(family.arm.screws[place].axis) for place in block]
        self._motion_first, self._alone = family.circle.motion_first, alone
        self._centre, self._side = _vector(wrist.centre), _vector(wrist.side)
        self._tips = [_vector(part) for part in wrist.screws[1].split(wrist.screws[2].axis)]
        self._phase, self._gaps = wrist.phase, wrist.gaps
        assert carry.measure is not None
        self._measure = _vector(carry.measure.first), _vector(carry.measure.second)

    @classmethod
    def for_family(cls, family: Family) -> "OnePose | None":
        """Return a solver for a family; None if it is not of the kind that the module describes, or needs a quartic."""
        if not isinstance(family, BlockFamily) or not isinstance(family.inside, Wrist) or family.arm.locked:
            return None
        turning = not any(screw.prismatic for screw in family.arm.screws)
        carry = family.carry
        if not turning or not family.shared or not isinstance(carry, CarryPoint) or carry.pair.alone is None:
            return None
        return cls(family, family.inside, carry, carry.pair.alone)

    def solve(self, motion: Motion) -> list[list[Turn]]:
        """Return cosine and sine of the six joints for each branch."""
        first, middle, third = self._arm
        start, goal = self._centre, self._centre
        tip, side = self._wrist[2], self._side
        if self._motion_first:
            goal, tip, side = _moved(motion, goal), _turned(motion, tip), _turned(motion, side)
        else:
            start = _moved_back(motion, start)
        rows: list[list[Turn]] = []
        needs: list[tuple[Vector, Vector]] = []
        for one, three in self._outer(start, goal):
            before = _about(first, one[0], -one[1], goal)
            after = _about(third, *three, start)
            two = _between(middle[0], _minus(after, middle[1]), _minus(before, middle[1]))
            rows.append([one, two, three])
            vectors = tip, side
            for (axis, _), turn in zip(self._arm, rows[-1], strict=True):
                vectors = (
                    _rotated(axis, turn[0], -turn[1], vectors[0]),
                    _rotated(axis, turn[0], -turn[1], vectors[1]),
                )
            if not self._motion_first:
                vectors = _turned(motion, vectors[0]), _turned(motion, vectors[1])
            needs.append(vectors)
        middles = [self._middle(tip) for tip, _ in needs]
        return [
            [*row, *self._ends(two[choice], *need)]
            for choice in (0, 1)
            for row, two, need in zip(rows, middles, needs, strict=True)
        ]

    def _outer(self, start: Vector, goal: Vector) -> list[tuple[Turn, Turn]]:
        """Return, by branch, cosine and sine of the first and third of three joints that move ``start`` to ``goal``."""
        sides = self._numbers(self._arm[0], goal, -1.0), self._numbers(self._arm[2], start, 1.0)
        rest = sides[1][0][0] - sides[0][0][0], sides[1][0][1] - sides[0][0][1]
        side, equation = self._alone
        signs = (1.0, -1.0) if side == 0 else (-1.0, 1.0)
        a, b = sides[side][1][equation]
        known, other = sides[side][1][1 - equation], sides[1 - side][1][1 - equation]
        turns_found: list[tuple[Turn, Turn]] = []
        firsts = _linear(signs[0] * a, signs[0] * b, rest[equation])
        seconds = [
            _linear(
                signs[1] * other[0],
                signs[1] * other[1],
                rest[1 - equation] - signs[0] * (known[0] * cosine + known[1] * sine),
            )
            for cosine, sine in firsts
        ]
        for choice in (0, 1):
            for turn, turns in zip(firsts, seconds, strict=True):
                turns_found.append((turn, turns[choice]) if side == 0 else (turns[choice], turn))
        return turns_found

    def _numbers(self, line: tuple[Vector, Vector], point: Vector, sign: float) -> tuple[Turn, tuple[Turn, Turn]]:
        """Return the two quantities that the middle joint leaves unchanged as functions of the first or third joint.

        They belong to ``point``, which this joint, with the axis ``line``, moves; each is constant + factors · (cos,
        sin) of the angle. If ``sign`` is -1, the joint moves backwards.
        """
        axis, at = line
        one, centre = self._measure
        arm = _minus(point, at)
        height = _dot(axis, arm)
        along = height * axis[0], height * axis[1], height * axis[2]
        across, later = _minus(arm, along), _cross(axis, arm)
        away = _minus(at, centre)
        constants = (
            _dot(one, along) + _dot(one, at),
            _dot(arm, arm) + _dot(away, away) + 2 * height * _dot(away, axis),
        )
        factors = (
            (_dot(one, across), sign * _dot(one, later)),
            (2 * _dot(away, across), 2 * sign * _dot(away, later)),
        )
        return constants, factors

    def _middle(self, tip: Vector) -> tuple[Turn, Turn]:
        """Return both solutions of the wrist's middle joint, as ``Wrist._middle`` does for many poses."""
        less, more = _minus(self._wrist[0], tip), _plus(self._wrist[0], tip)
        below = max(_dot(less, less) / 2 - self._gaps[0], 0.0)
        above = max(_dot(more, more) / 2 - self._gaps[1], 0.0)
        whole = above + below or 1.0
        cosine, sine = (above - below) / whole, 2 * sqrt(below * above) / whole
        c, s = self._phase
        return (c * cosine - s * sine, s * cosine + c * sine), (c * cosine + s * sine, s * cosine - c * sine)

    def _ends(self, two: Turn, tip: Vector, side: Vector) -> tuple[Turn, Turn, Turn]:
        """Return cosine and sine of the three wrist joints, given those of the middle one, ``two``.

        ``tip`` and ``side`` are the directions of the last axis and of ``Wrist.side`` after the rotation of the wrist.
        """
        first, middle, last = self._wrist
        (along, across, later), (cosine, sine) = self._tips, two
        start = (
            along[0] + cosine * across[0] + sine * later[0],
            along[1] + cosine * across[1] + sine * later[1],
            along[2] + cosine * across[2] + sine * later[2],
        )
        one = _between(first, start, tip)
        side = _rotated(middle, two[0], -two[1], _rotated(first, one[0], -one[1], side))
        return one, two, _between(last, self._side, side)


def _line(screw: Screw) -> tuple[Vector, Vector]:
    return _vector(screw.axis), _vector(screw.point)


def _vector(numbers: Floats) -> Vector:
    x, y, z = numbers.ravel().tolist()
    return x, y, z


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _plus(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _cross(a: Vector, b: Vector) -> Vector:
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def _turned(motion: Motion, v: Vector) -> Vector:
    return _dot(motion[0], v), _dot(motion[1], v), _dot(motion[2], v)


def _moved(motion: Motion, v: Vector) -> Vector:
    return _plus(_turned(motion, v), motion[3])


def _moved_back(motion: Motion, v: Vector) -> Vector:
    (a, b, c), (d, e, f), (g, h, i), place = motion
    x, y, z = _minus(v, place)
    return a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z


def _rotated(axis: Vector, cosine: float, sine: float, v: Vector) -> Vector:
    """Rotate ``v`` about a unit axis (O. Rodrigues' formula)."""
    x, y, z = v
    hx, hy, hz = axis
    along = (1 - cosine) * (hx * x + hy * y + hz * z)
    return (
        cosine * x + sine * (hy * z - hz * y) + along * hx,
        cosine * y + sine * (hz * x - hx * z) + along * hy,
        cosine * z + sine * (hx * y - hy * x) + along * hz,
    )


def _about(line: tuple[Vector, Vector], cosine: float, sine: float, point: Vector) -> Vector:
    axis, at = line
    return _plus(_rotated(axis, cosine, sine, _minus(point, at)), at)


def _between(axis: Vector, start: Vector, end: Vector) -> Turn:
    """Return the turn about an axis that carries ``start`` nearest to ``end`` (``subproblems.turn_between``)."""
    hx, hy, hz = axis
    height = _dot(axis, start)
    x, y, z = start[0] - height * hx, start[1] - height * hy, start[2] - height * hz
    height = _dot(axis, end)
    u, v, w = end[0] - height * hx, end[1] - height * hy, end[2] - height * hz
    cosine = x * u + y * v + z * w
    sine = hx * (y * w - z * v) + hy * (z * u - x * w) + hz * (x * v - y * u)
    length = sqrt(cosine * cosine + sine * sine)
    return (cosine / length, sine / length) if length >= ON_AXIS**2 else (1.0, 0.0)


def _linear(a: float, b: float, d: float) -> tuple[Turn, Turn]:
    """Solve a cos(q) + b sin(q) = d for the cosines and sines, as ``subproblems.solve_linear``."""
    length = sqrt(a * a + b * b)
    a, b, d = (a / length, b / length, d / length) if length >= TINY else (1.0, 0.0, 0.0)
    d = max(-1.0, min(1.0, d))
    root = sqrt(1 - d * d)
    return (a * d - b * root, b * d + a * root), (a * d + b * root, b * d - a * root)
