"""Arrays of vectors, turns and rigid transforms, for many poses and solution branches at once.

The first axes are components, the last two are branches and poses: a vector is (3, B, N), a scalar (B, N), and B or N
is 1 if all branches or poses share a value. A *turn* is the cosine and sine of an angle, shape (2, B, N), which avoids
trigonometric functions until the end.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.caching import cached_property

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int_]

TINY = 1e-14
"""Relative length below which the direction of a vector is only rounding errors."""


def dot(a: Floats, b: Floats) -> Floats:
    """Return the dot products of vectors along their first axis."""
    return np.add.reduce(a * b, axis=0)


def cross(a: Floats, b: Floats) -> Floats:
    """Return the cross products of vectors along their first axis."""
    ax, ay, az = a
    bx, by, bz = b
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def constant(vector: Floats) -> Floats:
    """Return a vector of shape (3,) as a constant for all branches and poses."""
    return vector.reshape(3, 1, 1)


def skew(h: Floats) -> Floats:
    """Return the matrix of the cross product with a vector of shape (3,)."""
    return np.array([[0.0, -h[2], h[1]], [h[2], 0.0, -h[0]], [-h[1], h[0], 0.0]])


def perpendicular(h: Floats) -> Floats:
    """Return a unit vector perpendicular to a vector, shape (3,)."""
    other = np.cross(h, np.eye(3)[np.argmin(np.abs(h))])
    return np.array(other / np.linalg.norm(other), dtype=float)


def apply_matrix(matrix: Floats, vectors: Floats) -> Floats:
    """Multiply a constant matrix (K, 3), or one for each pose (K, 3, B, N), with vectors (3, B, N)."""
    if matrix.ndim == 2:
        return (matrix @ vectors.reshape(3, -1)).reshape(len(matrix), *vectors.shape[1:])
    return np.add.reduce(matrix * vectors, axis=1)


def tile(values: Floats, branches: int) -> Floats:
    """Repeat values (..., B, N) to a number of branches; a single branch is left to broadcasting."""
    count = values.shape[-2]
    if count in (1, branches):
        return values
    repeated: Floats = np.concatenate([values] * (branches // count), axis=-2)
    return repeated


def angle(turn: Floats) -> Floats:
    """Return the angles, in [-pi, pi], of turns (cosine, sine)."""
    return np.arctan2(turn[1], turn[0])


def turn_of(angles: Floats) -> Floats:
    """Return cosines and sines of angles of shape (B, N)."""
    return np.stack([np.cos(angles), np.sin(angles)])


class Transform(NamedTuple):
    """Rigid transforms: rotations (3, 3, B, N) and translations (3, B, N)."""

    rotation: Floats
    translation: Floats

    def turned(self, vectors: Floats) -> Floats:
        """Return rotated directions."""
        return apply_matrix(self.rotation, vectors)

    def moved(self, points: Floats) -> Floats:
        """Return moved points."""
        return apply_matrix(self.rotation, points) + self.translation

    def inverse(self) -> "Transform":
        """Return the inverse transforms."""
        back = self.rotation.swapaxes(0, 1)
        return Transform(back, -apply_matrix(back, self.translation))

    def __matmul__(self, other: "Transform") -> "Transform":
        columns = [apply_matrix(self.rotation, other.rotation[:, column]) for column in range(3)]
        return Transform(np.stack(columns, axis=1), self.moved(other.translation))


@dataclass(frozen=True, eq=False)
class Screw:
    """Joint as a screw motion: a rotation about a line, or a translation along a direction.

    Attributes:
        axis: Unit vector, (3, 1, 1), or (3, B, N) if it differs between poses.
        point: A point on the line, of the same shape.
        prismatic: Whether it translates. Joint values are then distances, shape (1, B, N), otherwise turns.
    """

    axis: Floats
    point: Floats
    prismatic: bool = False

    @cached_property
    def shared(self) -> bool:
        """Whether axis and point are the same for all poses."""
        return self.axis.size == 3 and self.point.size == 3

    @cached_property
    def parts(self) -> Floats:
        """Matrix (9, 3[, B, N]) that computes the result of ``split``."""
        h = self.axis
        if self.shared:
            along = np.outer(h, h)
            return np.concatenate([along, np.eye(3) - along, skew(h.ravel())])
        along = h[:, None] * h[None]
        zero = np.zeros(h.shape[1:])
        turned = np.array([[zero, -h[2], h[1]], [h[2], zero, -h[0]], [-h[1], h[0], zero]])
        return np.concatenate([along, np.eye(3)[..., None, None] - along, turned])

    def turned(self, value: Floats, directions: Floats) -> Floats:
        """Return directions after the motion."""
        if self.prismatic:
            return directions
        along, across, later = self.split(directions)
        return along + value[0] * across + value[1] * later

    def turned_back(self, value: Floats, directions: Floats) -> Floats:
        """Return directions after the opposite motion."""
        if self.prismatic:
            return directions
        along, across, later = self.split(directions)
        return along + value[0] * across - value[1] * later

    def split(self, vectors: Floats) -> Floats:
        """Return components of vectors along and across the axis, and the latter turned by 90°, (3, 3, B, N)."""
        parts = apply_matrix(self.parts, vectors)
        return parts.reshape(3, 3, *parts.shape[1:])

    def across(self, vectors: Floats) -> Floats:
        """Return the components of vectors perpendicular to the axis."""
        return apply_matrix(self.parts[3:6], vectors)

    def moved(self, value: Floats, points: Floats) -> Floats:
        """Return points after the motion."""
        if self.prismatic:
            return points + value * self.axis
        return self.turned(value, points - self.point) + self.point

    def moved_back(self, value: Floats, points: Floats) -> Floats:
        """Return points after the opposite motion."""
        if self.prismatic:
            return points - value * self.axis
        return self.turned_back(value, points - self.point) + self.point

    def carried(self, transform: Transform) -> "Screw":
        """Return the joint with axis and point moved by ``transform``.

        With the transform W, the motion E of this joint and E' of the moved one at the same value: W E = E' W.
        """
        return Screw(transform.turned(self.axis), transform.moved(self.point), self.prismatic)

    def transform(self, value: Floats) -> Transform:
        """Return the motions as transforms."""
        if self.shared and not self.prismatic:
            along, across, later = self.parts.reshape(3, 3, 3, 1, 1)
            rotation = along + value[0] * across + value[1] * later
            return Transform(rotation, self.point - apply_matrix(rotation, self.point))
        columns = [self.turned(value, constant(column)) for column in np.eye(3)]
        columns = [np.broadcast_to(column, (3, *value.shape[1:])) for column in columns]
        origin = self.moved(value, np.zeros((3, 1, 1)))
        return Transform(np.stack(columns, axis=1), np.broadcast_to(origin, (3, *value.shape[1:])))
