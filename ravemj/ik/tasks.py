"""What can be asked of an arm. The other questions of OpenRAVE have their place here, when they come."""

from collections.abc import Sequence
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from ravemj.ik.chain import Chain, check_poses
from ravemj.ik.vectors import Floats


class Task(Enum):
    """What of the tool's pose is asked for; the value says how many joints fix it.

    Attributes:
        TRANSFORM: All of it.
        PLACE: The place of its origin.
        PLACE_XY: Where its origin is in the plane of the base's x and y.
        PLANAR: That, and where its direction points in this plane.
    """

    TRANSFORM = "Transform6D"
    PLACE = "Translation3D"
    PLACE_XY = "TranslationXY2D"
    PLANAR = "TranslationXYOrientation3D"

    @property
    def rows(self) -> Sequence[int]:
        """Rows of a Jacobian, velocities of the tool's origin and angular velocities, that matter."""
        return {Task.PLACE: (0, 1, 2), Task.PLACE_XY: (0, 1), Task.PLANAR: (0, 1, 5)}.get(self, range(6))

    @property
    def dof(self) -> int:
        """How many joints fix it."""
        return len(self.rows)


def goal_poses(chain: Chain, task: Task, goals: ArrayLike) -> Floats:
    """Return goals as poses of the tool in the base, shape (..., 4, 4); what the task does not ask for is anything.

    Args:
        chain: The arm.
        task: What is asked for.
        goals: Poses (..., 4, 4), places (..., 3), x and y (..., 2), or x, y and angle (..., 3).

    Raises:
        ValueError: wrong shapes, numbers that are not finite, or poses that are no rigid transforms.
    """
    numbers = np.asarray(goals, dtype=float)
    if task is Task.TRANSFORM:
        check_poses(numbers)
        return numbers
    if numbers.shape[-1:] != (task.dof,):
        raise ValueError(f"goals of shape {numbers.shape} for {task.value}: expected (..., {task.dof})")
    if not np.isfinite(numbers).all():
        raise ValueError("a goal is not finite")
    poses = np.broadcast_to(chain.T_base_tool, (*numbers.shape[:-1], 4, 4)).copy()
    if task is Task.PLANAR:
        heading = chain.T_base_tool[:3, :3] @ chain.direction
        turn = numbers[..., 2] - np.arctan2(heading[1], heading[0])
        rotations = np.zeros((*turn.shape, 3, 3))
        rotations[..., 0, 0] = rotations[..., 1, 1] = np.cos(turn)
        rotations[..., 1, 0], rotations[..., 0, 1] = np.sin(turn), -np.sin(turn)
        rotations[..., 2, 2] = 1
        poses[..., :3, :3] = rotations @ chain.T_base_tool[:3, :3]
        poses[..., :2, 3] = numbers[..., :2]
    else:
        poses[..., : task.dof, 3] = numbers
    return poses
