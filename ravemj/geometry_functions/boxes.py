"""Rays and boxes of the API, which can be pickled, printed and converted."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import also_named
from ravemj.core.transforms import ZERO, Floats, Pose
from ravemj.geometry_functions import arguments


class Ray(ApiObject):
    """Ray; the length of its direction is its range.

    Example:
        >>> ray = Ray([0, 0, 2], [0, 0, -5])  # reaches down to z = -3
    """

    _often_called = ("__init__",)

    def __init__(self, pos: ArrayLike = ZERO, dir: ArrayLike = ZERO) -> None:
        self._pos = arguments.vec3(pos, "pos")
        self._dir = arguments.vec3(dir, "dir")

    def pos(self) -> Floats:
        """Return the start [m], shape (3,)."""
        return np.array(self._pos)

    def dir(self) -> Floats:
        """Return the direction and range [m], shape (3,)."""
        return np.array(self._dir)

    def __repr__(self) -> str:
        return f"<Ray([{_listed(self._pos)}],[{_listed(self._dir)}])>"

    def __str__(self) -> str:
        return f"<{_listed((*self._pos, *self._dir), ' ')}>"


class AABB(ApiObject):
    """Axis-aligned box.

    Example:
        >>> box = robot.ComputeAABB()
        >>> top = box.pos()[2] + box.extents()[2]
    """

    _often_called = ("__init__",)

    def __init__(self, pos: ArrayLike = ZERO, extents: ArrayLike = ZERO) -> None:
        self._pos = arguments.vec3(pos, "pos")
        self._extents = arguments.vec3(extents, "extents")

    def pos(self) -> Floats:
        """Return the centre [m], shape (3,)."""
        return np.array(self._pos)

    def extents(self) -> Floats:
        """Return the half extents [m], shape (3,)."""
        return np.array(self._extents)

    def GetCombined(self, aabb: "AABB") -> "AABB":
        """Return the smallest box that contains this one and ``aabb``."""
        low = np.minimum(self.pos() - self.extents(), aabb.pos() - aabb.extents())
        high = np.maximum(self.pos() + self.extents(), aabb.pos() + aabb.extents())
        return AABB((low + high) / 2, (high - low) / 2)

    def GetTransformed(self, pose: ArrayLike) -> "AABB":
        """Return the smallest axis-aligned box around this one transformed by ``pose``: 7 numbers, or a 4x4 matrix."""
        return AABBFromOrientedBox(OrientedBoxFromAABB(self, pose))

    def toDict(self) -> dict[str, Floats]:
        """Return the box as ``pos`` and ``extents``."""
        return {"pos": self.pos(), "extents": self.extents()}

    def __repr__(self) -> str:
        return f"AABB([{_listed(self._pos)}],[{_listed(self._extents)}])"

    def __str__(self) -> str:
        return f"<{_listed((*self._pos, *self._extents), ' ')}>"


class OrientedBox(ApiObject):
    """Oriented box."""

    @also_named(transform="pose")
    def __init__(self, pose: ArrayLike = (1, 0, 0, 0, 0, 0, 0), extents: ArrayLike = ZERO) -> None:
        self._pose = arguments.pose(pose, "pose")
        self._extents = arguments.vec3(extents, "extents")

    def extents(self) -> Floats:
        """Return the half extents [m], shape (3,)."""
        return np.array(self._extents)

    def transform(self) -> Floats:
        """Return the pose of the centre, shape (4, 4)."""
        return self._pose.matrix()

    def pose(self) -> Floats:
        """Return the pose of the centre, quaternion first, shape (7,)."""
        return self._pose.numbers()

    def toDict(self) -> dict[str, Floats]:
        """Return the box as ``transform``, a pose of 7 numbers, and ``extents``."""
        return {"transform": self.pose(), "extents": self.extents()}

    def __repr__(self) -> str:
        return f"OrientedBox([{_listed(self.pose())}],[{_listed(self._extents)}])"

    def __str__(self) -> str:
        return f"<{self!r}>"


def _listed(numbers: Iterable[float], separator: str = ",") -> str:
    return separator.join(f"{number:.15e}" for number in numbers)


def OrientedBoxFromAABB(aabb: AABB, transform: ArrayLike) -> OrientedBox:
    """Transform an axis-aligned box; return an oriented one.

    Args:
        aabb: The box.
        transform: A matrix 4x4 or 3x4, or a pose [w, x, y, z, tx, ty, tz].
    """
    x, y, z = aabb.pos().tolist()
    moved = arguments.pose(transform, "transform") @ Pose((x, y, z))
    return OrientedBox(moved.numbers(), aabb.extents())


def AABBFromOrientedBox(obb: OrientedBox) -> AABB:
    """Return the smallest axis-aligned box that contains the oriented box ``obb``."""
    transform = obb.transform()
    return AABB(transform[:3, 3], np.abs(transform[:3, :3]) @ obb.extents())


def CheckAABBCollision(aabb1: AABB, aabb2: AABB) -> bool:
    """Return whether two axis-aligned boxes overlap or touch.

    Args:
        aabb1: A box.
        aabb2: The other.
    """
    return bool(np.all(np.abs(aabb1.pos() - aabb2.pos()) <= aabb1.extents() + aabb2.extents()))


def CheckOBBCollision(obb1: OrientedBox, obb2: OrientedBox) -> bool:
    """Return whether two boxes overlap or touch, by the separating axis theorem.

    Args:
        obb1: An oriented box.
        obb2: The other.
    """
    first, second = obb1.transform(), obb2.transform()
    edges1, edges2 = first[:3, :3].T, second[:3, :3].T
    crossed = np.cross(edges1[:, None], edges2[None]).reshape(-1, 3)
    normals = np.vstack([edges1, edges2, crossed[np.linalg.norm(crossed, axis=1) > 1e-9]])
    distances = np.abs(normals @ (second[:3, 3] - first[:3, 3]))
    reaches = np.abs(normals @ edges1.T) @ obb1.extents() + np.abs(normals @ edges2.T) @ obb2.extents()
    return bool(np.all(distances <= reaches))


def CheckAABBAndOBBCollision(aabb: AABB, obb: OrientedBox) -> bool:
    """Return whether an axis-aligned box and an oriented box overlap or touch.

    Args:
        aabb: The box.
        obb: The oriented box.
    """
    return CheckOBBCollision(OrientedBoxFromAABB(aabb, np.eye(4)), obb)


def CheckBoxAtOriginAndOBBCollision(extents: ArrayLike, obb: OrientedBox) -> bool:
    """Return whether an axis-aligned box at the origin and an oriented box overlap or touch.

    Args:
        extents: The half extents of the first box [m], shape (3,).
        obb: The oriented box.
    """
    return CheckAABBAndOBBCollision(AABB(ZERO, extents), obb)
