"""Subproblems of inverse kinematics, for many poses and branches at once.

Rotations about lines that carry points to points, spheres, planes and other circles were named and solved by B. Paden
(*Kinematics and control of robot manipulators*, 1985) and W. Kahan; A. J. Elias and J. T. Wen ("IK-Geo: Unified robot
inverse kinematics using subproblem decomposition", 2022) define six of them, with their least-squares cases. Fewer
functions suffice: subproblem 1 is ``turn_between``; 3 (point to sphere) and 4 (point to plane) are the linear equation
of ``solve_linear``, 2 is 4 followed by 1; 5 and 6 are the quadratic equation of ``solve_quadratic``.

If there is no solution, the result is the least-squares rotation, and forward kinematics detects the error.
"""

import numpy as np

from ravemj.ik.vectors import TINY, Floats, Screw, dot

ON_AXIS = 2e-11
"""Distance from an axis below which a unit vector counts as parallel to it: then any rotation is accurate."""
_SHIFTS = 2 * np.pi / 5 * np.arange(5).reshape(5, 1, 1)


def normalized(turn: Floats, least: float = TINY) -> Floats:
    """Normalize (cosine, sine) to unit length; vectors shorter than ``least`` become (1, 0), the angle 0."""
    length = np.sqrt(turn[0] * turn[0] + turn[1] * turn[1])
    if length.min(initial=np.inf) < least:
        none = length < least
        turn = np.array([np.where(none, 1.0, turn[0]), np.where(none, 0.0, turn[1])])
        length = np.where(none, 1.0, length)
    return turn / length


def turn_between(joint: Screw, start: Floats, end: Floats) -> Floats:
    """Return cosine and sine (2, B, N) of the angle that carries ``start`` (3, B, N) nearest to ``end`` (subproblem 1).

    Directions are relative to the joint's point. If one is along the axis, the angle is 0.
    """
    _, across, later = joint.split(end)
    start = joint.across(start)  # otherwise rounding errors of directions along the axis dominate
    return normalized(np.array([dot(start, across), -dot(start, later)]), ON_AXIS**2)


def solve_linear(a: Floats, b: Floats, d: Floats) -> Floats:
    """Solve a cos(q) + b sin(q) = d (subproblems 3 and 4).

    Returns:
        Cosine and sine of both solutions, shape (2, 2 B, N): the first solutions, then the second ones. Without
            solution, both are the angle with the least error.
    """
    length = np.sqrt(a * a + b * b)
    if length.min(initial=np.inf) < TINY:
        length = np.where(length < TINY, np.inf, length)
        a = np.where(np.isinf(length), 1.0, a / length)
        b, d = b / length, np.where(np.isinf(length), 1.0, d / length)
    else:
        a, b, d = a / length, b / length, d / length
    d = np.clip(d, -1.0, 1.0)
    root = np.sqrt(1 - d * d)
    ad, bd, ar, br = a * d, b * d, a * root, b * root
    return np.array([np.concatenate([ad - br, ad + br], axis=-2), np.concatenate([bd + ar, bd - ar], axis=-2)])


def solve_parabola(a: Floats, b: Floats, d: Floats) -> Floats:
    """Solve a x + b x² = d with b != 0 for both x, shape (1, 2 B, N); without solution, return the real part."""
    half = -a / (2 * b)
    root = np.sqrt(np.maximum(half * half + d / b, 0.0))
    return np.concatenate([half + root, half - root], axis=-2)[None]


def solve_quadratic(k: Floats, linear: Floats, square: Floats) -> Floats:
    """Solve k + l·x + x·S x = 0 for unit vectors x = (cos(q), sin(q)) (subproblems 5 and 6).

    The half-angle tangent t gives a quartic. The origin of the angle is chosen so that the equation is far from 0 on
    the opposite side and no solution is infinite; two Newton steps refine the angle.

    Args:
        k: The constants, shape (B, N).
        linear: The vectors l, shape (2, B, N).
        square: The entries S00, S01 = S10, S11, shape (3, B, N).

    Returns:
        Cosine and sine of four solutions, shape (2, 4 B, N); a complex pair is replaced by its real part, twice.
    """
    a0, a1, b1 = k + (square[0] + square[2]) / 2, linear[0], linear[1]
    a2, b2 = (square[0] - square[2]) / 2, square[1]
    opposite = a0[None] - a1 * np.cos(_SHIFTS[..., None]).reshape(5, 1, 1) - b1 * np.sin(_SHIFTS)
    opposite = opposite + a2 * np.cos(2 * _SHIFTS) + b2 * np.sin(2 * _SHIFTS)
    shift = _SHIFTS.ravel()[np.argmax(np.abs(opposite), axis=0)]
    c1, s1, c2, s2 = np.cos(shift), np.sin(shift), np.cos(2 * shift), np.sin(2 * shift)
    u1, v1, u2, v2 = a1 * c1 + b1 * s1, b1 * c1 - a1 * s1, a2 * c2 + b2 * s2, b2 * c2 - a2 * s2
    tangents = _quartic(a0 - u1 + u2, 2 * v1 - 4 * v2, 2 * a0 - 6 * u2, 2 * v1 + 4 * v2, a0 + u1 + u2)
    angles = (2 * np.arctan(tangents) + shift).reshape(-1, *shift.shape[-1:])
    a0, a1, b1, a2, b2 = (np.concatenate([coefficient] * 4, axis=-2) for coefficient in (a0, a1, b1, a2, b2))
    for _ in range(2):
        c1, s1, c2, s2 = np.cos(angles), np.sin(angles), np.cos(2 * angles), np.sin(2 * angles)
        value = a0 + a1 * c1 + b1 * s1 + a2 * c2 + b2 * s2
        slope = b1 * c1 - a1 * s1 + 2 * (b2 * c2 - a2 * s2)
        slope = np.where(slope == 0, np.inf, slope)
        angles = angles - np.clip(value / slope, -1e-2, 1e-2)
    return np.array([np.cos(angles), np.sin(angles)])


def _quartic(a: Floats, b: Floats, c: Floats, d: Floats, e: Floats) -> Floats:
    """Return the real parts of the roots of a x⁴ + b x³ + c x² + d x + e, shape (4, B, N) (L. Ferrari's method)."""
    a = np.where(np.abs(a) < TINY, TINY, a)
    b, c, d, e = b / a, c / a, d / a, e / a
    p = c - 3 * b * b / 8
    q = d - b * c / 2 + b * b * b / 8
    r = e - b * d / 4 + b * b * c / 16 - 3 * b**4 / 256
    m = np.maximum(_largest_root(p, p * p / 4 - r, -q * q / 8), 0.0)
    s = np.sqrt(2 * m)
    small = s < 1e-7 * (1 + np.abs(p) + np.abs(r))
    half = q / (2 * np.where(small, 1.0, s))
    spread = np.sqrt(np.maximum(p * p / 4 - r, 0.0))  # of the biquadratic, if q is 0
    first = np.where(small, p / 2 - spread, p / 2 + m + half)
    second = np.where(small, p / 2 + spread, p / 2 + m - half)
    s = np.where(small, 0.0, s)
    one = np.sqrt(np.maximum(s * s / 4 - first, 0.0))
    two = np.sqrt(np.maximum(s * s / 4 - second, 0.0))
    return np.array([s / 2 + one, s / 2 - one, -s / 2 + two, -s / 2 - two]) - b / 4


def _largest_root(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return the largest real root of x³ + a x² + b x + c (F. Viète's and G. Cardano's method)."""
    q = (a * a - 3 * b) / 9
    r = (2 * a**3 - 9 * a * b + 27 * c) / 54
    rest = r * r - q**3
    root = np.sqrt(np.maximum(q, 0.0))
    three = np.arccos(np.clip(r / np.where(root > 0, root**3, 1.0), -1.0, 1.0))
    first = -np.sign(r) * np.cbrt(np.abs(r) + np.sqrt(np.maximum(rest, 0.0)))
    second = q / np.where(first == 0, 1.0, first)
    return np.where(rest < 0, -2 * root * np.cos((three + 2 * np.pi) / 3), first + second) - a / 3
