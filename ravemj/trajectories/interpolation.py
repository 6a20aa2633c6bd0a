"""Interpolation between two waypoints: polynomials through values and derivatives.

Values and derivatives at both ends determine a Hermite polynomial of odd degree. A polynomial of even degree is the
integral of such a polynomial for the derivatives, starting at the first waypoint; it reaches the second one if the
values are consistent. A curve is an array of coefficients, lowest power first, of the fraction t from 0 at the first
waypoint to 1 at the second.
"""

import math
from collections.abc import Sequence
from functools import cache

import numpy as np

from ravemj.core.transforms import Floats

Ends = tuple[Floats, Floats]
"""Values at the two waypoints of a segment."""

ROUNDING = 2.3e-16
"""Tolerance within which a time counts as that of a waypoint [s, or fraction of the segment]."""

HELD = ("", "previous", "next", "max")
"""Piecewise-constant interpolations, which use the value of one waypoint."""

DERIVATIVES = {"linear": 0, "quadratic": 1, "cubic": 1, "quartic": 2, "quintic": 2, "sextic": 3}
"""Number of derivatives that each interpolation needs."""


def held(interpolation: str, part: float, ends: Ends) -> Floats:
    """Return the value of one waypoint, at fraction ``part`` of a segment, by a piecewise-constant interpolation."""
    first, second = ends
    if interpolation == "previous":
        return second if part > 1 - ROUNDING else first
    if interpolation == "max":
        return np.maximum(first, second)
    return first if part <= ROUNDING else second


def between(ends: Ends, part: float) -> Floats:
    """Interpolate linearly at fraction ``part`` of a segment; the result is clipped against rounding errors."""
    first, second = ends
    return np.clip((1.0 - part) * first + part * second, np.minimum(first, second), np.maximum(first, second))


def curve(interpolation: str, ends: Ends, derivatives: Sequence[Ends], duration: float) -> Floats:
    """Return the interpolating curve between two waypoints.

    Args:
        interpolation: One of ``DERIVATIVES``.
        ends: The values at both waypoints.
        derivatives: The necessary derivatives at both waypoints, velocities first. If a linear curve has velocities, it
            uses that of the second waypoint.
        duration: Duration of the segment [s].
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
    """Return the time derivative of a curve."""
    powers = np.arange(1, len(coefficients))
    return coefficients[1:] * powers[:, None] / duration


def value(coefficients: Floats, part: float) -> Floats:
    """Evaluate a curve at fraction ``part``."""
    return part ** np.arange(len(coefficients)) @ coefficients


def _through(known: Sequence[Ends], duration: float) -> Floats:
    """Return the coefficients of the polynomial with the values and derivatives ``known`` at both ends."""
    ends = [values[end] * duration**order for end in (0, 1) for order, values in enumerate(known)]
    return _hermite(len(known)) @ np.array(ends)


@cache
def _hermite(count: int) -> Floats:
    """Return the matrix from ``count`` values and scaled derivatives at 0, then at 1, to polynomial coefficients."""
    conditions = np.zeros((2 * count, 2 * count))
    for order in range(count):
        conditions[order, order] = math.factorial(order)
        conditions[count + order] = [math.perm(power, order) for power in range(2 * count)]
    return np.round(2 * np.linalg.inv(conditions)) / 2  # integers and halves, for up to three conditions at each end
