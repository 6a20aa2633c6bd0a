"""Residuals of all goal types and Jacobians of tasks, for least squares and null spaces.

Positions are divided by the reach, rotations and directions are in radians.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.tasks import ALONG, ANGLES, Task
from ravemj.ik.vectors import Floats, skew


class ToolState(NamedTuple):
    """Pose and Jacobian of the tool.

    Attributes:
        rotation: Its rotation, shape (3, 3).
        position: Its position, shape (3,).
        jacobian: Velocities of its origin and angular velocities, in base axes, shape (6, n).
    """

    rotation: Floats
    position: Floats
    jacobian: Floats


def residual_and_jacobian(
    chain: Chain, task: Task, goal: Floats, tool: ToolState, scale: Floats
) -> tuple[Floats, Floats]:
    """Return the residual of a goal, shape (k,), and the task's Jacobian, shape (k, n).

    The goal is a pose (4, 4), see ``goal_poses``; ``scale`` are the weights of linear and angular components, shape
    (6,).
    """
    residual, jacobian = _RESIDUALS[task](chain, task, goal, tool)
    counts = scale[component_rows(task)]
    return residual * counts, jacobian * counts[:, None]


def component_rows(task: Task) -> list[int]:
    """Return the index of each residual component among the linear and angular velocities x, y, z."""
    if task in ANGLES:
        return [0, 1, 2, 3 + ANGLES[task]]
    if task in (Task.ROTATION, Task.DIRECTION, Task.LOOK_AT):
        return [3, 4, 5]
    return [0, 1, 2] if task is Task.LOCAL_PLACE else list(task.rows)


def _pose(chain: Chain, task: Task, goal: Floats, tool: ToolState) -> tuple[Floats, Floats]:
    away, rows = goal[:3, 3] - tool.position, component_rows(task)
    return np.append(away, rotation_between(tool.rotation, goal))[rows], tool.jacobian[rows]


def _local_place(chain: Chain, task: Task, goal: Floats, tool: ToolState) -> tuple[Floats, Floats]:
    arm = tool.rotation @ goal[3, :3]
    return goal[:3, 3] - tool.position - arm, tool.jacobian[:3] - skew(arm) @ tool.jacobian[3:]


def _direction(chain: Chain, task: Task, goal: Floats, tool: ToolState) -> tuple[Floats, Floats]:
    pointing, wanted = tool.rotation @ chain.direction, goal[:3, :3] @ chain.direction
    return wanted - pointing, -skew(pointing) @ tool.jacobian[3:]


def _place_direction(chain: Chain, task: Task, goal: Floats, tool: ToolState) -> tuple[Floats, Floats]:
    bent, turned = _direction(chain, task, goal, tool)
    rows = [ANGLES[task]] if task in ANGLES else [0, 1, 2]
    away = goal[:3, 3] - tool.position
    return np.append(away, bent[rows]), np.vstack([tool.jacobian[:3], turned[rows]])


def _ray(chain: Chain, task: Task, goal: Floats, tool: ToolState) -> tuple[Floats, Floats]:
    residual, jacobian = _place_direction(chain, task, goal, tool)
    wanted = goal[:3, :3] @ chain.direction
    across = np.eye(3) - np.outer(wanted, wanted)
    return np.append(across @ residual[:3], residual[3:]), np.vstack([across @ jacobian[:3], jacobian[3:]])


def _look_at(chain: Chain, task: Task, goal: Floats, tool: ToolState) -> tuple[Floats, Floats]:
    away, pointing = goal[:3, 3] - tool.position, tool.rotation @ chain.direction
    distance = float(np.linalg.norm(away)) or 1e-12
    wanted, (moves, turns) = away / distance, np.split(tool.jacobian, 2)
    return wanted - pointing, (moves - np.outer(wanted, wanted @ moves)) / distance - skew(pointing) @ turns


def _planar(chain: Chain, task: Task, goal: Floats, tool: ToolState) -> tuple[Floats, Floats]:
    """Return error and Jacobian of a planar task: x, y and the angle in the plane.

    As in OpenRAVE, the angle is that of the tool's direction in the plane or, if this is perpendicular to the plane at
    the goal, that of the tool's rotation about z.
    """
    pointing, wanted = tool.rotation @ chain.direction, goal[:3, :3] @ chain.direction
    moves, turns = np.split(tool.jacobian, 2)
    if np.abs(wanted[:2]).max() < 1e-9:
        turn, heading = rotation_between(tool.rotation, goal)[2], turns[2]
    else:
        turned = -skew(pointing) @ turns
        square = max(float(pointing[:2] @ pointing[:2]), 1e-12)
        turn = np.arctan2(pointing[0] * wanted[1] - pointing[1] * wanted[0], pointing[:2] @ wanted[:2])
        heading = (pointing[0] * turned[1] - pointing[1] * turned[0]) / square
    return np.append((goal[:3, 3] - tool.position)[:2], turn), np.vstack([moves[:2], heading])


_RESIDUALS: dict[Task, Callable[[Chain, Task, Floats, ToolState], tuple[Floats, Floats]]] = {
    **dict.fromkeys((Task.TRANSFORM, Task.ROTATION, Task.PLACE, Task.PLACE_XY), _pose),
    **dict.fromkeys((*ALONG, *ANGLES), _place_direction),
    Task.LOCAL_PLACE: _local_place,
    Task.DIRECTION: _direction,
    Task.RAY: _ray,
    Task.LOOK_AT: _look_at,
    Task.PLANAR: _planar,
}


def rotation_between(rotation: Floats, pose: Floats) -> Floats:
    """Return the rotation vector, in base axes, from ``rotation`` (3, 3) to the rotation of ``pose``."""
    (a, b, c), (d, e, f), (g, h, i) = (pose[:3, :3] @ rotation.T).tolist()
    x, y, z = h - f, c - g, d - b
    sine, cosine = (x * x + y * y + z * z) ** 0.5, a + e + i - 1  # twice both
    if sine > 1e-6:
        factor = float(np.arctan2(sine, cosine)) / sine
    elif cosine > 0:
        factor = 0.5
    else:  # rotation by pi: the axis is in the sum of the matrix and its transpose
        square = np.array([a, e, i]) + 1
        axis = int(np.argmax(square))
        column = np.array([[2 * a + 2, b + d, c + g], [b + d, 2 * e + 2, f + h], [c + g, f + h, 2 * i + 2]])[axis]
        return np.pi * column / np.linalg.norm(column)
    return np.array([x * factor, y * factor, z * factor])
