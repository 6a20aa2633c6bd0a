"""Values between two waypoints: polynomials through their values and derivatives.

Values and derivatives at the two ends determine a polynomial of odd degree (Hermite's). Those of even degree are the
integrals of one for the derivatives, from the first waypoint on; they reach the second one if its values fit. A curve
is an array of coefficients of the powers of the part of the way, from 0 at the first waypoint to 1 at the second,
lowest first.
"""

import math
from collections.abc import Sequence
from functools import cache

import numpy as np

from ravemj.core.transforms import Floats

Ends = tuple[Floats, Floats]
"""Values at the two waypoints."""

ROUNDING = 2.3e-16
"""Closer to a waypoint than this [s, or as a part of the way] is at the waypoint."""

HELD = ("", "previous", "next", "max")
"""Interpolations that take one of the two values."""

DERIVATIVES = {"linear": 0, "quadratic": 1, "cubic": 1, "quartic": 2, "quintic": 2, "sextic": 3}
"""How many derivatives the others need."""


def held(interpolation: str, part: float, ends: Ends) -> Floats:
    """Return one of the two values, by one of the interpolations ``HELD``, at a part of the way."""
    first, second = ends
    if interpolation == "previous":
        return second if part > 1 - ROUNDING else first
    if interpolation == "max":
        return np.maximum(first, second)
    return first if part <= ROUNDING else second


def between(ends: Ends, part: float) -> Floats:
    """Return the values at a part of the straight line; rounding takes them nowhere beyond the ends."""
    first, second = ends
    return np.clip((1.0 - part) * first + part * second, np.minimum(first, second), np.maximum(first, second))


def curve(interpolation: str, ends: Ends, derivatives: Sequence[Ends], duration: float) -> Floats:
    """Return the curve from one waypoint to the next.

    Args:
        interpolation: One of ``DERIVATIVES``.
        ends: The values at both.
        derivatives: Their derivatives at both, the velocities first; as many as are needed. A linear curve may have
            one, too: then it goes as the second waypoint says.
        duration: Time from one to the other [s].
    """
    if interpolation == "linear":
        step = derivatives[0][1] * duration if derivatives else ends[1] - ends[0]
        return np.array([ends[0], step])
    used = derivatives[: DERIVATIVES[interpolation]]
    if interpolation in {"cubic", "quintic"}:
        return _through([ends, *used], duration)
    slope = _through(used, duration)
    powers = np.arange(1, len(slope) + 1)
    return np.vstack([ends[0], duration * slope / powers[:, None]])


def differentiated(coefficients: Floats, duration: float) -> Floats:
    """Return the curve of the derivatives by time."""
    powers = np.arange(1, len(coefficients))
    return coefficients[1:] * powers[:, None] / duration


def value(coefficients: Floats, part: float) -> Floats:
    """Return the values of a curve."""
    return part ** np.arange(len(coefficients)) @ coefficients


def _through(known: Sequence[Ends], duration: float) -> Floats:
    """Return the curve through values, and then derivatives, at both ends."""
    ends = [values[end] * duration**order for end in (0, 1) for order, values in enumerate(known)]
    return _hermite(len(known)) @ np.array(ends)


@cache
def _hermite(count: int) -> Floats:
    """Return the matrix that maps values and scaled derivatives at 0, then at 1, to coefficients."""
    conditions = np.zeros((2 * count, 2 * count))
    for order in range(count):
        conditions[order, order] = math.factorial(order)
        conditions[count + order] = [math.perm(power, order) for power in range(2 * count)]
    return np.round(2 * np.linalg.inv(conditions)) / 2  # whole and half numbers, up to three conditions at each end
