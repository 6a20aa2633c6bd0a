"""Poses in URDF's form: positions, and angles about fixed axes.

Numbers are rounded to fourteen decimals. Rounding errors of the computation are far below half of the last decimal, so
reading and writing a file again reproduces it.
"""

import math
from collections.abc import Iterable

from ravemj.core.transforms import UNIT_WXYZ, Pose, Vec3, rows_from_wxyz
from ravemj.formats.xml_text import Content

NOTHING = "0 0 0"
"""Attribute value of a zero position or rotation."""

_DECIMALS = 14
_LOCKED = 1e-10
"""Cosine of the pitch below which roll and yaw are not separable (gimbal lock)."""


def numbers(vector: Iterable[float]) -> str:
    """Return numbers as rounded text; integers have no point."""
    return " ".join(repr(round(part, _DECIMALS) + 0.0).removesuffix(".0") for part in vector)


def origin_attributes(pose: Pose) -> dict[str, Content]:
    """Return ``xyz`` and ``rpy`` of a pose; an identity rotation is omitted."""
    attributes: dict[str, Content] = {"xyz": numbers(pose.position)}
    angles = numbers(roll_pitch_yaw(pose)) if pose.wxyz != UNIT_WXYZ else NOTHING
    return attributes if angles == NOTHING else {**attributes, "rpy": angles}


def roll_pitch_yaw(pose: Pose) -> Vec3:
    """Return the angles about the fixed axes x, y and z, in this order [rad]."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rows_from_wxyz(pose.wxyz)
    cosine = math.hypot(xx, yx)
    pitch = math.atan2(-zx, cosine)
    if cosine < _LOCKED:
        sign = math.copysign(1.0, pitch)
        return math.atan2(sign * xy, sign * xz), sign * math.pi / 2, 0.0
    del yy, yz
    return math.atan2(zy, zz), pitch, math.atan2(yx, xx)
