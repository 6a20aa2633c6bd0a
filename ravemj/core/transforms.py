"""Rigid transforms as tuples of floats.

A ``Pose`` is a unit quaternion (w, x, y, z) and a translation, as in OpenRAVE. Tuples can be compared, hashed and
printed, as frozen scene data requires, and for single poses they are faster than numpy arrays. ``T_a_b`` maps
coordinates of frame b to frame a, so ``T_a_c = T_a_b @ T_b_c``.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int_]
Vec3 = tuple[float, float, float]
Wxyz = tuple[float, float, float, float]
Rows = tuple[Vec3, Vec3, Vec3]

ZERO: Vec3 = (0.0, 0.0, 0.0)
UNSCALED: Vec3 = (1.0, 1.0, 1.0)
UNIT_WXYZ: Wxyz = (1.0, 0.0, 0.0, 0.0)

_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])  # the axis behind each one, and the one before it


class Pose(NamedTuple):
    """A rigid transform.

    Attributes:
        position: Origin of the inner frame in the outer one [m].
        wxyz: Unit quaternion that rotates from the inner frame to the outer one.
    """

    position: Vec3 = ZERO
    wxyz: Wxyz = UNIT_WXYZ

    def __matmul__(self, other: "Pose") -> "Pose":
        """Compose: the result applies ``other`` first."""
        if self.wxyz == UNIT_WXYZ:
            return Pose(add(self.position, other.position), other.wxyz)
        return Pose(self.apply(other.position), multiply(self.wxyz, other.wxyz))

    def apply(self, point: Vec3) -> Vec3:
        """Map a point from the inner frame to the outer one."""
        return add(self.position, rotate(self.wxyz, point))

    def inverse(self) -> "Pose":
        """Return the transform from the outer frame to the inner one."""
        inverse_wxyz = conjugate(self.wxyz)
        return Pose(rotate(inverse_wxyz, scale(self.position, -1.0)), inverse_wxyz)

    def matrix(self) -> Floats:
        """Return the transform as a 4x4 matrix."""
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rows_from_wxyz(self.wxyz)
        x, y, z = self.position
        return np.array(((xx, xy, xz, x), (yx, yy, yz, y), (zx, zy, zz, z), (0.0, 0.0, 0.0, 1.0)))

    def numbers(self) -> Floats:
        """Return [w, x, y, z, tx, ty, tz], shape (7,)."""
        return np.array([*self.wxyz, *self.position])


UNMOVED = Pose()


def pose_of(matrix: Floats) -> Pose:
    """Return the pose of a 4x4 matrix."""
    x, y, z = matrix[:3, 3].tolist()
    return Pose((x, y, z), wxyz_from_rows(matrix[:3, :3].tolist()))


def inverse(T_a_b: Floats) -> Floats:
    """Return ``T_b_a``, the inverse of a rigid transform, shape (4, 4)."""
    T_b_a = np.eye(4)
    T_b_a[:3, :3] = T_a_b[:3, :3].T
    T_b_a[:3, 3] = -T_a_b[:3, :3].T @ T_a_b[:3, 3]
    return T_b_a


def add(a: Vec3, b: Vec3) -> Vec3:
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def scale(a: Vec3, factor: float) -> Vec3:
    """Return the vector a times a number."""
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def dot(a: Vec3, b: Vec3) -> float:
    """Return the scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vec3, b: Vec3) -> Vec3:
    """Return the cross product of two vectors."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def cross_rows(a: Floats, b: Floats) -> Floats:
    """Return the cross products of vectors along the last axis; faster than ``np.cross`` for few of them."""
    return a.take(_NEXT, -1) * b.take(_LAST, -1) - a.take(_LAST, -1) * b.take(_NEXT, -1)


def multiply(a: Wxyz, b: Wxyz) -> Wxyz:
    """Return the quaternion that rotates by b, then by a."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def conjugate(wxyz: Wxyz) -> Wxyz:
    """Return the inverse of a unit quaternion."""
    w, x, y, z = wxyz
    return (w, -x, -y, -z)


def rotate(wxyz: Wxyz, vector: Vec3) -> Vec3:
    """Rotate a vector by a unit quaternion."""
    if vector == ZERO:
        return ZERO
    x_row, y_row, z_row = rows_from_wxyz(wxyz)
    return (dot(x_row, vector), dot(y_row, vector), dot(z_row, vector))


def normalize(wxyz: Wxyz) -> Wxyz:
    """Return the quaternion with unit length.

    Raises:
        ZeroDivisionError: all four numbers are zero.
    """
    w, x, y, z = wxyz
    length = math.sqrt(w * w + x * x + y * y + z * z)
    return (w / length, x / length, y / length, z / length)


_SHORTEST = 1e-290
"""Length of a vector below which its components may be subnormal."""


def not_subnormal(vector: Vec3) -> Vec3:
    """Return a vector of the same direction and a length whose inverse is finite; 0 stays 0."""
    if math.hypot(*vector) < _SHORTEST:  # subnormal numbers have few digits; a power of two loses none
        return (vector[0] * 2.0**600, vector[1] * 2.0**600, vector[2] * 2.0**600)
    return vector


def wxyz_from_axis_angle(axis: Vec3, angle: float) -> Wxyz:
    """Return the right-handed rotation by an angle [rad] about an axis of any length; a zero axis means no rotation.

    Quarter and half turns are exact, since many models have them.

    Raises:
        OverflowError: the angle is infinite.
    """
    axis = not_subnormal(axis)
    length = math.hypot(*axis)
    if length == 0.0:
        return UNIT_WXYZ
    if math.isinf(angle):
        raise OverflowError("there is no turn by an infinite angle")
    cosine, sine = math.cos(angle / 2), math.sin(angle / 2)
    if abs(abs(cosine) - abs(sine)) < 1e-15:
        cosine, sine = math.copysign(math.sqrt(0.5), cosine), math.copysign(math.sqrt(0.5), sine)
    elif abs(cosine) < 1e-15:
        cosine = 0.0
    return (cosine, axis[0] / length * sine, axis[1] / length * sine, axis[2] / length * sine)


def wxyz_from_rows(rows: Sequence[Sequence[float]]) -> Wxyz:
    """Return the quaternion of a rotation matrix, given as three rows (Shepperd's method)."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rows
    trace = xx + yy + zz
    if trace >= 0:
        wxyz = (trace + 1, zy - yz, xz - zx, yx - xy)
    elif xx >= yy and xx >= zz:
        wxyz = (zy - yz, xx - yy - zz + 1, yx + xy, xz + zx)
    elif yy >= zz:
        wxyz = (xz - zx, yx + xy, yy - zz - xx + 1, zy + yz)
    else:
        wxyz = (yx - xy, xz + zx, zy + yz, zz - xx - yy + 1)
    return normalize(wxyz)


def rows_from_wxyz(wxyz: Wxyz) -> Rows:
    """Return the three rows of the rotation matrix of a unit quaternion."""
    w, x, y, z = wxyz
    xx, yy, zz = x * x, y * y, z * z
    xy, xz, yz = x * y, x * z, y * z
    wx, wy, wz = w * x, w * y, w * z
    return (
        (1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)),
        (2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)),
        (2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)),
    )


def wxyz_jacobian(wxyz: Sequence[float]) -> Floats:
    """Return the Jacobian from angular velocity in the outer axes to the quaternion's rate, shape (4, 3)."""
    w, x, y, z = wxyz
    w, x, y, z = w / 2, x / 2, y / 2, z / 2
    return np.array(((-x, -y, -z), (w, z, -y), (-z, w, x), (y, -x, w)))
