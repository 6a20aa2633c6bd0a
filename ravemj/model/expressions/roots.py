"""OpenRAVE's functions that can have several values: roots of polynomials, and triangles for linkages.

The values of each come best first; where there is none the tuple is empty. In the names of the triangle functions
S is a side and A an angle, in the order in which one meets them on a walk around the triangle; the last letter is
what the function finds. Only their names are known for certain; arguments and order follow from the geometry.
"""

import functools
import math

import numpy as np

IMAGINARY_NOISE = 1e-6  # double roots come back with a small imaginary part


@functools.lru_cache(maxsize=4096)  # each root is asked for by itself
def real_roots(*coefficients: float) -> tuple[float, ...]:
    """Return the real roots of a polynomial in ascending order.

    Args:
        coefficients: The highest power first: ``polyroots2(1, -3, 2)`` has the roots 1 and 2.
    """
    if not all(map(math.isfinite, coefficients)):
        return ()
    with np.errstate(all="ignore"):
        try:
            roots = np.roots(coefficients)
        except np.linalg.LinAlgError:
            return ()  # the leading coefficient is too small beside the others
        is_real = np.abs(roots.imag) <= IMAGINARY_NOISE * np.maximum(1.0, np.abs(roots))
        found = _polished(np.array(coefficients), roots.real[is_real])
    return tuple(sorted(found))


def _polished(coefficients: np.ndarray[tuple[int], np.dtype[np.float64]], roots: object) -> list[float]:
    """Improve roots by two of Newton's steps, which repairs what the eigenvalues behind ``np.roots`` lost."""
    slope = np.polyder(coefficients)
    found: list[float] = []
    for root in np.asarray(roots, dtype=np.float64).tolist():
        x = float(root)
        for _ in range(2):
            step = float(np.polyval(coefficients, x)) / (float(np.polyval(slope, x)) or math.inf)
            x -= step if abs(step) < IMAGINARY_NOISE * max(1.0, abs(x)) else 0.0
        found.append(x)
    return found


def enclosed_angle(a: float, b: float, c: float) -> tuple[float, ...]:
    """Return the angle between the sides a and b, opposite to c, turned both ways [rad] (``SSSA``)."""
    try:
        angle = math.acos((a * a + b * b - c * c) / (2 * a * b))
    except (ValueError, ZeroDivisionError):
        return ()
    return () if math.isnan(angle) else (angle, -angle)


def next_angle(a: float, gamma: float, b: float) -> tuple[float, ...]:
    """Return the angle opposite to side a, of a triangle whose sides a and b enclose ``gamma`` [rad] (``SASA``)."""
    if not (math.isfinite(gamma) and math.isfinite(a) and math.isfinite(b)):
        return ()
    return (math.atan2(a * math.sin(gamma), b - a * math.cos(gamma)),)


def third_side(a: float, gamma: float, b: float) -> tuple[float, ...]:
    """Return the side opposite to the angle ``gamma`` that the sides a and b enclose (``SASS``)."""
    if not math.isfinite(gamma):
        return ()
    square = a * a + b * b - 2 * a * b * math.cos(gamma)
    return () if math.isnan(square) else (math.sqrt(max(square, 0.0)),)
