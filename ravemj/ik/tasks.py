"""IK tasks: OpenRAVE's goal types."""

from collections.abc import Sequence
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from ravemj.ik.chain import Chain, rigid_poses
from ravemj.ik.vectors import Floats


class Task(Enum):
    """Constrained components of the tool pose.

    The tool's *direction* is that of its manipulator, in the base frame.

    Attributes:
        TRANSFORM: The full pose. Goals: poses (..., 4, 4).
        ROTATION: The rotation. Goals: quaternions wxyz.
        PLACE: The position of the origin. Goals: x, y, z.
        DIRECTION: The direction. Goals: unit vectors.
        RAY: The line along the direction, with the origin anywhere on it. Goals: direction, point.
        LOOK_AT: A point in the direction from the origin. Goals: x, y, z.
        PLACE_DIRECTION: The position of the origin and the direction. Goals: direction, position.
        PLACE_XY: The position of the origin in the base's xy plane. Goals: x, y.
        PLANAR: The same, and the angle of the direction in this plane. Goals: x, y, angle.
        LOCAL_PLACE: The position of a point of the tool. Goals: the point in the tool frame, its position.
        PLACE_X_ANGLE: The position of the origin, and the angle between the direction and x. Goals: angle, position.
        PLACE_Y_ANGLE: The same with y.
        PLACE_Z_ANGLE: The same with z.
        PLACE_XY_HEADING: The position of the origin, and a direction perpendicular to z: its angle from x about z.
            Goals: angle, position.
        PLACE_YZ_HEADING: The same: perpendicular to x, the angle from y about x.
        PLACE_ZX_HEADING: The same: perpendicular to y, the angle from z about y.
    """

    TRANSFORM = "Transform6D"
    ROTATION = "Rotation3D"
    PLACE = "Translation3D"
    DIRECTION = "Direction3D"
    RAY = "Ray4D"
    LOOK_AT = "Lookat3D"
    PLACE_DIRECTION = "TranslationDirection5D"
    PLACE_XY = "TranslationXY2D"
    PLANAR = "TranslationXYOrientation3D"
    LOCAL_PLACE = "TranslationLocalGlobal6D"
    PLACE_X_ANGLE = "TranslationXAxisAngle4D"
    PLACE_Y_ANGLE = "TranslationYAxisAngle4D"
    PLACE_Z_ANGLE = "TranslationZAxisAngle4D"
    PLACE_XY_HEADING = "TranslationXAxisAngleZNorm4D"
    PLACE_YZ_HEADING = "TranslationYAxisAngleXNorm4D"
    PLACE_ZX_HEADING = "TranslationZAxisAngleYNorm4D"

    @property
    def rows(self) -> Sequence[int]:
        """Rows of the tool Jacobian (linear, then angular velocity) that the task constrains."""
        return {Task.PLACE: (0, 1, 2), Task.PLACE_XY: (0, 1), Task.PLANAR: (0, 1, 5)}.get(self, range(6))

    @property
    def dof(self) -> int:
        """Number of constrained degrees of freedom."""
        return _DOF.get(self, len(self.rows))

    @property
    def size(self) -> int:
        """Number of values of a goal; poses are matrices."""
        return _SIZE.get(self, 4 if self in ANGLES or self in HEADINGS else self.dof)


ANGLES = {Task.PLACE_X_ANGLE: 0, Task.PLACE_Y_ANGLE: 1, Task.PLACE_Z_ANGLE: 2}
"""Axis, x, y or z, of each task that constrains the angle between the tool's direction and an axis."""
HEADINGS = {Task.PLACE_XY_HEADING: 0, Task.PLACE_YZ_HEADING: 1, Task.PLACE_ZX_HEADING: 2}
"""Axis from which the angle is measured, for each task that constrains a direction in a plane."""
ALONG = frozenset({Task.PLACE_DIRECTION, *HEADINGS})
"""Tasks that constrain the position and the direction of the tool."""
_DOF = {
    Task.ROTATION: 3,
    Task.DIRECTION: 2,
    Task.RAY: 4,
    Task.LOOK_AT: 2,
    Task.LOCAL_PLACE: 3,
    **dict.fromkeys(ANGLES, 4),
    **dict.fromkeys(ALONG, 5),
}
_SIZE = {
    Task.ROTATION: 4,
    Task.DIRECTION: 3,
    Task.RAY: 6,
    Task.LOOK_AT: 3,
    Task.PLACE_DIRECTION: 6,
    Task.LOCAL_PLACE: 6,
}


def goal_poses(chain: Chain, task: Task, goals: ArrayLike) -> Floats:
    """Return goals as tool poses in the base, shape (..., 4, 4), with arbitrary unconstrained components.

    Rotations with errors up to 1e-3 are replaced by the nearest rotations. For ``LOCAL_PLACE``, the last row of a pose
    contains the point of the tool.

    Args:
        chain: The arm.
        task: The task.
        goals: Goals of the task, with any leading axes.

    Raises:
        ValueError: wrong shapes, numbers that are not finite, directions or quaternions of length 0, or poses that are
            not rigid transforms.
    """
    numbers = np.asarray(goals, dtype=float)
    if task is Task.TRANSFORM:
        return rigid_poses(numbers)
    if numbers.shape[-1:] != (task.size,):
        raise ValueError(f"goals of shape {numbers.shape} for {task.value}: expected (..., {task.size})")
    if not np.isfinite(numbers).all():
        raise ValueError("a goal is not finite")
    poses = np.broadcast_to(chain.T_base_tool, (*numbers.shape[:-1], 4, 4)).copy()
    poses[..., :3, 3] = 0
    _FILL.get(task, _fill_place)(chain, task, numbers, poses)
    return poses


def _fill_place(chain: Chain, task: Task, numbers: Floats, poses: Floats) -> None:
    poses[..., : task.dof, 3] = numbers


def _fill_looked_at(chain: Chain, task: Task, numbers: Floats, poses: Floats) -> None:
    poses[..., :3, 3] = numbers


def _fill_local(chain: Chain, task: Task, numbers: Floats, poses: Floats) -> None:
    poses[..., 3, :3], poses[..., :3, 3] = numbers[..., :3], numbers[..., 3:]


def _fill_planar(chain: Chain, task: Task, numbers: Floats, poses: Floats) -> None:
    heading = chain.T_base_tool[:3, :3] @ chain.direction
    poses[..., :2, 3], poses[..., 2, 3] = numbers[..., :2], chain.T_base_tool[2, 3]
    upright = np.abs(chain.axes[chain.turning, 2]) > 1 - 1e-9
    if np.abs(heading[:2]).max() < 1e-9 and not upright.all():
        angle = numbers[..., 2]
        poses[..., :3, :3] = _pointing(chain, np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1))
        return
    turn = numbers[..., 2] - np.arctan2(heading[1], heading[0])
    rotations = np.zeros((*turn.shape, 3, 3))
    rotations[..., 0, 0] = rotations[..., 1, 1] = np.cos(turn)
    rotations[..., 1, 0], rotations[..., 0, 1] = np.sin(turn), -np.sin(turn)
    rotations[..., 2, 2] = 1
    poses[..., :3, :3] = rotations @ chain.T_base_tool[:3, :3]


def _fill_rotation(chain: Chain, task: Task, numbers: Floats, poses: Floats) -> None:
    w, x, y, z = np.moveaxis(_units(numbers, "quaternion"), -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    for index, row in enumerate(rows):
        for column, number in enumerate(row):
            poses[..., index, column] = number


def _fill_ray(chain: Chain, task: Task, numbers: Floats, poses: Floats) -> None:
    poses[..., :3, :3] = _pointing(chain, _units(numbers[..., :3], "direction"))
    poses[..., :3, 3] = numbers[..., 3:] if task.size == 6 else 0


def _fill_angle(chain: Chain, task: Task, numbers: Floats, poses: Floats) -> None:
    first = ANGLES[task] if task in ANGLES else HEADINGS[task]
    directions = np.zeros((*numbers.shape[:-1], 3))
    directions[..., first] = np.cos(numbers[..., 0])
    directions[..., (first + 1) % 3] = np.sin(numbers[..., 0])
    poses[..., :3, :3] = _pointing(chain, directions)
    poses[..., :3, 3] = numbers[..., 1:]


_FILL = {
    Task.LOOK_AT: _fill_looked_at,
    Task.LOCAL_PLACE: _fill_local,
    Task.PLANAR: _fill_planar,
    Task.ROTATION: _fill_rotation,
    **dict.fromkeys((Task.DIRECTION, Task.RAY, Task.PLACE_DIRECTION), _fill_ray),
    **dict.fromkeys((*ANGLES, *HEADINGS), _fill_angle),
}


def _units(vectors: Floats, what: str) -> Floats:
    lengths = np.sqrt((vectors * vectors).sum(axis=-1, keepdims=True))
    if lengths.size and lengths.min() == 0:
        raise ValueError(f"a {what} of a goal is 0")
    return vectors / lengths


def _pointing(chain: Chain, directions: Floats) -> Floats:
    """Return tool rotations, shape (..., 3, 3), that turn the tool's direction to ``directions`` (..., 3)."""
    return _frames(directions) @ _frames(chain.direction).T


def _frames(directions: Floats) -> Floats:
    """Return rotations (..., 3, 3) whose first columns are given unit vectors (..., 3)."""
    sides = np.asarray(np.cross(directions, np.eye(3)[np.abs(directions).argmin(axis=-1)]), dtype=float)
    sides /= np.sqrt((sides * sides).sum(axis=-1, keepdims=True))
    others = np.asarray(np.cross(directions, sides), dtype=float)
    return np.stack([directions, sides, others], axis=-1)
