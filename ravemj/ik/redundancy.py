"""Redundancy: joints with free values, and configurations in which two joints rotate about one line.

The default free joints and their sampling steps follow OpenRAVE's rules.
"""

import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.families.blocks import common_point
from ravemj.ik.families.snapping import TOLERANCE, nominal
from ravemj.ik.residuals import ToolState, residual_and_jacobian
from ravemj.ik.tasks import Task
from ravemj.ik.vectors import Floats, Screw, constant

ANGLE_STEP = 0.1
"""Sampling step of a revolute free joint [rad]."""
SLIDE_STEP = 0.01
"""Sampling step of a prismatic free joint, divided by the reach."""
SINGULAR_STEP = np.pi / 8
"""Sampling step of the first of two joints that rotate about one line [rad]."""
MOST = 4096
"""Maximum number of samples of all free joints together."""
_COAXIAL = 1e-9
_ALONG = 1e-6
_CONFIGURATIONS = 4


def rank(chain: Chain, task: Task) -> int:
    """Return the rank of the task's Jacobian, the maximum over a few random configurations."""
    values = np.random.default_rng(7).uniform(-3, 3, (_CONFIGURATIONS, chain.dof)) * np.where(chain.prismatic, 0.1, 1.0)
    return max(int(np.linalg.matrix_rank(jacobian, tol=1e-4)) for jacobian in task_jacobians(chain, task, values))


def task_jacobians(chain: Chain, task: Task, values: Floats, goal: Floats | None = None) -> list[Floats]:
    """Return the Jacobians of a task in configurations (M, n), each of shape (k, n).

    Lengths are divided by the reach. ``goal`` is a pose (4, 4); by default the pose of each configuration.
    """
    tools, jacobians = chain.forward(values), chain.forward_and_jacobian(values)[1]
    scale = np.array([1 / chain.reach] * 3 + [1.0] * 3)
    rows: list[Floats] = []
    for tool, jacobian in zip(tools, jacobians, strict=True):
        wanted = tool.copy() if goal is None else goal
        if goal is None and task is Task.LOOK_AT:
            wanted[:3, 3] += tool[:3, :3] @ chain.direction * chain.reach
        elif goal is None and task is Task.LOCAL_PLACE:
            wanted[3, :3] = 0.3, 0.2, 0.1
        motion = ToolState(tool[:3, :3], tool[:3, 3], jacobian)
        rows.append(residual_and_jacobian(chain, task, wanted, motion, scale)[1])
    return rows


def choices(chain: Chain, task: Task) -> Iterator[tuple[int, ...]]:
    """Yield sets of joints that can be free, each as large as the redundancy of the arm.

    Between a spherical shoulder and a spherical wrist, the third of seven joints comes first, as in OpenRAVE. Otherwise
    the last joint comes first and the first one second: if these are locked, the geometry of the other joints does not
    depend on their values. The others follow from the tool to the base.
    """
    count = chain.dof - rank(chain, task)
    order = [chain.dof - 1, 0, *range(chain.dof - 2, 0, -1)][: chain.dof]
    if task is Task.TRANSFORM and _is_like_a_human_arm(chain):
        order.insert(0, order.pop(order.index(2)))
    for chosen in itertools.combinations(order, count):
        yield tuple(sorted(chosen))


def _is_like_a_human_arm(chain: Chain) -> bool:
    """Return whether an arm has a spherical shoulder, an elbow and a spherical wrist: seven revolute joints."""
    if chain.dof != 7 or chain.prismatic.any():
        return False
    exact = nominal(chain)
    screws = [Screw(constant(axis), constant(point)) for axis, point in zip(exact.axes, exact.points, strict=True)]
    return all(common_point(ends, TOLERANCE) is not None for ends in (screws[:3], screws[4:]))


def free_range(chain: Chain, joint: int) -> tuple[float, float]:
    """Return the range in which a free joint is sampled."""
    low, high = float(chain.lower[joint]), float(chain.upper[joint])
    if chain.circular[joint] or (not chain.prismatic[joint] and high - low > 2 * np.pi):
        return -np.pi, np.pi
    return low, high


def affordable(chain: Chain, free: Sequence[int], steps: Sequence[float]) -> tuple[float, ...]:
    """Return steps of free joints, enlarged if several joints together would have more than ``MOST`` samples."""
    if len(free) < 2:
        return tuple(steps)
    ranges = [high - low for low, high in (free_range(chain, joint) for joint in free)]
    wider = list(steps)
    while np.prod([span // step + 1 for span, step in zip(ranges, wider, strict=True)]) > MOST:
        wider = [1.2 * step for step in wider]
    return tuple(wider)


def samples(chain: Chain, free: Sequence[int], steps: Sequence[float], start: Floats | None = None) -> Floats:
    """Return samples of free joints within their limits: the start, or 0, then one step more, one step less, and so on.

    Args:
        chain: The arm.
        free: The free joints, k of them.
        steps: A step for each free joint [rad or m].
        start: Values of the first sample, shape (k,).

    Returns:
        Values, shape (K, k); one empty row if there is no free joint. The last free joint varies fastest.
    """
    columns: list[list[float]] = []
    for index, (joint, step) in enumerate(zip(free, steps, strict=True)):
        low, high = free_range(chain, joint)
        centre = float(np.clip(0.0 if start is None else start[index], low, high))
        up = centre + step * np.arange(1, int((high - centre) / step + 1e-9) + 1)
        down = centre - step * np.arange(1, int((centre - low) / step + 1e-9) + 1)
        both = itertools.zip_longest(up.tolist(), down.tolist())
        columns.append([centre, *(value for pair in both for value in pair if value is not None)])
    rows = list(itertools.product(*columns))
    return np.array(rows, dtype=float).reshape(len(rows), len(columns))


def singular_rows(chain: Chain, rows: Floats) -> list[tuple[Floats, int, int, float]]:
    """Return the configurations among ``rows`` (K, n) in which two joints rotate about one line.

    Each item is the configuration, the two joints, and 1 or -1 for equal or opposite directions.
    """
    axes, points = chain.placed_axes(rows)
    turning = np.nonzero(~chain.prismatic)[0].tolist()
    singular: list[tuple[Floats, int, int, float]] = []
    for first, second in itertools.combinations(turning, 2):
        tilt = np.abs(np.cross(axes[first], axes[second])).max(axis=1)
        if tilt.min() < _COAXIAL:
            away = np.abs(np.cross(axes[first], points[second] - points[first])).max(axis=1) / chain.reach
            for row in np.nonzero((tilt < _COAXIAL) & (away < _COAXIAL))[0]:
                singular.append((rows[row], first, second, float(np.sign(axes[first, row] @ axes[second, row]))))
    return singular


def spread(chain: Chain, singular: tuple[Floats, int, int, float], seed: Floats | None = None) -> Floats:
    """Return other configurations (K, n) with the same tool pose as a singular one, an item of ``singular_rows``.

    If ``seed`` is given, one more result has its value of the first of the two joints, another its value of the second.
    """
    row, first, second, sign = singular
    angles = np.arange(-np.pi + SINGULAR_STEP, np.pi + 1e-9, SINGULAR_STEP)
    if seed is not None:
        angles = np.append(angles, [seed[first], row[first] - sign * (seed[second] - row[second])])
    rows = np.repeat(row[None], len(angles), axis=0)
    rows[:, first] = angles
    rows[:, second] -= sign * (angles - row[first])
    turning = ~chain.prismatic
    rows[:, turning] = np.mod(rows[:, turning] + np.pi, 2 * np.pi) - np.pi
    return rows


def default_free(chain: Chain, name: str, dof: int) -> list[int]:
    """Return the default free joints of an arm with more joints than the ``dof`` values that a goal type constrains.

    By default, the joints nearest to the tool are free. For goals with position and direction, the last joint is free
    if it rotates about the tool's direction; further free joints are those nearest to the base.
    """
    surplus = max(0, chain.dof - dof)
    joints = list(range(chain.dof))
    if name != "TranslationDirection5D":
        return joints[::-1][:surplus]
    pointing = chain.T_base_tool[:3, :3] @ chain.direction
    to_tool = chain.T_base_tool[:3, 3] - chain.points[-1]
    turned = np.abs(np.cross(chain.axes[-1], [pointing, to_tool])).max() < _ALONG and not chain.prismatic[-1]
    last = [joints.pop()] if turned and surplus else []
    return last + joints[: surplus - len(last)]


def default_steps(
    chain: Chain, free: Sequence[int], angle: float = ANGLE_STEP, slide: float = SLIDE_STEP
) -> tuple[float, ...]:
    """Return the default step of each free joint [rad or m].

    Steps of prismatic joints are a fraction of the arm's length. For more than two joints, steps are enlarged if there
    would be too many samples.
    """
    points = np.vstack([chain.points, chain.T_base_tool[:3, 3]])  # also those of prismatic joints, as in OpenRAVE
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) or 1.0
    steps = np.array([slide * length if chain.prismatic[joint] else angle for joint in free])
    if len(free) > 2:
        joints = list(free)
        spans = np.where(chain.circular[joints], 2 * np.pi, (chain.upper - chain.lower)[joints])
        spans = np.where(chain.prismatic[joints], spans, np.minimum(spans, 2 * np.pi))
        steps *= max(1.0, float(np.prod(spans / steps + 1) / MOST) ** (1 / len(free)))
    return tuple(steps.tolist())
