"""Rounding of numbers in files, so that reading and writing again reproduces the same digits.

Readers compose transforms, normalize quaternions and convert degrees to radians, which changes the last digits. Writers
round the results to fewer digits; reading errors are so much smaller that the rounded number is a fixed point. The
rounding error of 1e-13 is a thousandth of what any test can detect.
"""

import math
from collections.abc import Sequence
from typing import cast

from ravemj.core.transforms import Pose, Vec3, Wxyz
from ravemj.model.scene import Joint

_UNIT_DECIMALS = 13
_LENGTH_DECIMALS = 12
_DIGITS = 13

_SQRT_HALF = math.sqrt(0.5)
_TIE = 1e-9  # numbers this near to each other count as equally large


def number(value: float, largest: float | None = None) -> float:
    """Round a number to thirteen significant digits of ``largest``, by default of the number itself."""
    largest = abs(value if largest is None else largest)
    if not math.isfinite(largest) or largest == 0.0:
        return value
    return round(value, _DIGITS - 1 - math.floor(math.log10(largest)))


def numbers(values: Sequence[float]) -> list[float]:
    """Round numbers to the place of the thirteenth significant digit of the largest one."""
    largest = max(map(abs, values), default=0.0)
    return [number(value, largest) for value in values]


def position(point: Vec3) -> Vec3:
    """Round a point [m] to twelve decimals, fewer far from the origin."""
    largest = max(1.0, *map(abs, point))
    if not math.isfinite(largest):
        return point
    decimals = _LENGTH_DECIMALS - math.floor(math.log10(largest))
    return cast(Vec3, tuple(round(part, decimals) for part in point))


def direction(vector: Vec3) -> Vec3:
    """Round a unit vector; its largest component is computed from the others."""
    return cast(Vec3, _unit(vector))


def pose(T: Pose) -> Pose:
    """Round a pose; the largest component of the quaternion becomes positive."""
    wxyz = T.wxyz if T.wxyz[_largest(T.wxyz)] > 0 else tuple(-part for part in T.wxyz)
    return Pose(position(T.position), cast(Wxyz, _unit(wxyz)))


def axis_angle(wxyz: Wxyz) -> tuple[float, ...]:
    """Return axis and angle [deg] of a rounded quaternion: x y z angle."""
    w, x, y, z = wxyz
    sine = math.hypot(x, y, z)
    if sine == 0.0:
        return (1.0, 0.0, 0.0, 0.0)
    return (x / sine, y / sine, z / sine, math.degrees(2 * math.atan2(sine, w)))


def degrees(angle: float) -> float:
    """Return an angle [rad] in degrees."""
    return number(math.degrees(angle))


def values(joint: Joint) -> list[float]:
    """Round the values of a joint, which were measured from poses [rad or m]."""
    return [round(axis.value, _LENGTH_DECIMALS) for axis in joint.axes]


def _largest(parts: Sequence[float]) -> int:
    """Return the index of the largest component in magnitude; of those equal up to rounding, the first."""
    largest = max(map(abs, parts))
    return next(index for index, part in enumerate(parts) if abs(part) >= largest - _TIE)


def _unit(parts: Sequence[float]) -> tuple[float, ...]:
    """Round a unit vector; its largest component is computed from the others, so that normalizing changes nothing."""
    rounded = [_snapped(round(part, _UNIT_DECIMALS)) for part in parts]
    index = _largest(parts)
    rest = sum(part * part for place, part in enumerate(rounded) if place != index)
    rounded[index] = _snapped(math.copysign(math.sqrt(max(0.0, 1.0 - rest)), parts[index]))
    return tuple(part + 0.0 for part in rounded)


def _snapped(part: float) -> float:
    """Return +-sin 45 deg exactly if a number is close to it, since right angles are frequent in quaternions."""
    return math.copysign(_SQRT_HALF, part) if abs(abs(part) - _SQRT_HALF) < 1e-12 else part
