"""Mass properties that MuJoCo accepts."""

import math

import numpy as np

from ravemj.core.transforms import Vec3
from ravemj.formats.mjcf.lines import Attribute
from ravemj.model.scene import Inertial

SMALLEST = 1e-10
"""Minimum written mass [kg] and moment of inertia [kg m^2], since MuJoCo requires positive values."""


_ROUNDING = 1e-11
"""Relative margin to the triangle inequality of principal moments, since MuJoCo recomputes these from the tensor."""


def is_rounding(legal: Inertial, given: Inertial) -> bool:
    """Return whether two mass properties differ only by rounding."""
    inertia = np.array(given.inertia)
    if not np.isfinite(inertia).all():
        return False
    close = np.allclose(legal.inertia, inertia, rtol=0, atol=10 * _ROUNDING * float(np.abs(inertia).max()))
    return close and (legal.mass, legal.com) == (given.mass, given.com)


def legal_inertial(inertial: Inertial) -> Inertial:
    """Return the nearest mass properties that MuJoCo accepts: positive, and fulfilling the triangle inequality."""
    if _is_legal_diagonal(inertial):
        return inertial
    mass = max(inertial.mass, SMALLEST) if math.isfinite(inertial.mass) else SMALLEST
    finite = np.nan_to_num(np.array(inertial.inertia), nan=0.0, posinf=0.0, neginf=0.0)
    moments, axes = np.linalg.eigh(finite)
    small, middle, large = map(float, moments)
    com = inertial.com if all(map(math.isfinite, inertial.com)) else (0.0, 0.0, 0.0)
    is_legal = small >= SMALLEST and small + middle - large >= _ROUNDING * large
    if mass == inertial.mass and com == inertial.com and is_legal:
        return inertial
    legal = np.maximum(_nearest(small, middle, large), SMALLEST)
    legal += _ROUNDING * legal[2]
    xx, xy, xz, _, yy, yz, _, _, zz = ((axes * legal) @ axes.T).ravel().tolist()
    return Inertial(mass, com, ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))


def _nearest(small: float, middle: float, large: float) -> Vec3:
    """Project sorted principal moments of inertia onto those that satisfy the triangle inequality, by least squares.

    If the given moments violate it, the largest result is the sum of the others. If the smallest would become
    negative, it is 0, and the others are equal.
    """
    excess = (large - small - middle) / 3
    if excess <= 0:
        return small, middle, large
    nearest = (small + excess, middle + excess, large - excess)
    half = max(0.0, (middle + large) / 2)
    return nearest if nearest[0] >= 0 else (0.0, half, half)


def _is_legal_diagonal(inertial: Inertial) -> bool:
    """Return True if the tensor is diagonal, and mass and tensor are valid: the usual case, checked without numpy."""
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertial.inertia
    if xy or xz or yz or not SMALLEST <= inertial.mass < math.inf:
        return False
    small, middle, large = sorted((xx, yy, zz))
    return small >= SMALLEST and large <= small + middle and math.isfinite(large + sum(inertial.com))


def inertia_attributes(inertial: Inertial) -> dict[str, Attribute]:
    """Return the attributes of an ``<inertial>``."""
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertial.inertia
    tensor: dict[str, Attribute] = {"fullinertia": (xx, yy, zz, xy, xz, yz)}
    if xy == xz == yz == 0.0:
        tensor = {"diaginertia": (xx, yy, zz)}
    return {"pos": inertial.com, "mass": inertial.mass, **tensor}
