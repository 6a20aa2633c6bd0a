"""Numeric inverse kinematics: damped least squares within limits, from many starts.

A step is that of K. Levenberg and D. Marquardt with damping proportional to the remaining error (T. Sugihara,
"Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method", 2011). If a step would violate limits,
MuJoCo's QP solver computes the best one within them. A start succeeds in 60 to 90 % of cases, so starts follow a
low-discrepancy sequence in joint space (M. Roberts, 2018, after R. Kronecker).
"""

import itertools
from dataclasses import dataclass

import mujoco
import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.following import FollowingChain
from ravemj.ik.limits import nearest_turns
from ravemj.ik.residuals import ToolState, component_rows, residual_and_jacobian, rotation_between
from ravemj.ik.tasks import ANGLES, Task
from ravemj.ik.vectors import Floats

ACCURATE = 1e-9
"""Error below which a configuration is a solution: position divided by the reach, angle in rad."""
_STEPS = 40
_NEAREST_STEPS = 100
_PLAIN = np.ones(6)
DISTINCT = 1e-3
"""Tolerance of equal solutions."""


@dataclass(frozen=True)
class Nearest:
    """Configuration nearest to a pose.

    Attributes:
        values: Joint values, shape (n,).
        error: Norm of the weighted pose error: position divided by the chain's reach, and angle [rad].
        steps: Number of steps.
    """

    values: Floats
    error: float
    steps: int


class NumericSolver:
    """Numeric solver of single poses.

    Attributes:
        chain: The arm.
        task: The constrained components of the pose.
        starts: Maximum number of starts of a search.
    """

    def __init__(
        self,
        chain: Chain,
        task: Task = Task.TRANSFORM,
        *,
        starts: int = 200,
    ) -> None:
        self.chain, self.task, self.starts = chain, task, starts
        self._kinematics = CompiledKinematics(chain)
        self._scale = np.array([1 / chain.reach] * 3 + [1.0] * 3)
        endless = chain.circular | ~(np.isfinite(chain.lower) & np.isfinite(chain.upper))
        span = np.where(chain.prismatic, chain.reach, np.pi)
        self._low = np.where(endless, -span, chain.lower)
        self._high = np.where(endless, span, chain.upper)
        self._lowest = np.where(chain.circular, -np.inf, chain.lower)
        self._highest = np.where(chain.circular, np.inf, chain.upper)
        self._identity = np.eye(chain.dof)

    def descend(self, pose: Floats, start: Floats) -> Nearest:
        """Descend from a start (n,) towards a pose (4, 4), until it is reached or the error stalls."""
        values = np.minimum(np.maximum(start, self._lowest), self._highest)
        best, at, stalled, step = np.inf, values, 0, 0
        for step in range(_STEPS):  # noqa: B007 - it is in the result
            error, jacobian = self._residual(pose, values, self._scale)
            square = float(error @ error)
            stalled = 0 if square < best * 0.98 else stalled + 1
            if square < best:
                best, at = square, values
            if square < 1e-24 or stalled > 6:
                break
            values = self._step(values, error, jacobian, 0.05 * square + 1e-12)
        return Nearest(at, float(np.sqrt(best)), step + 1)

    def shortfall(self, pose: Floats, values: Floats) -> tuple[float, float]:
        """Return distance [m] and angle [rad] of the tool at ``values`` to a pose; free components are ignored."""
        error, _ = self._residual(pose, values, _PLAIN)
        turning = np.array(component_rows(self.task)) > 2
        distance, turn = float(np.linalg.norm(error[~turning])), float(np.linalg.norm(error[turning]))
        if self.task in ANGLES:
            cosine = (pose[:3, :3] @ self.chain.direction)[ANGLES[self.task]]
            turn = float(np.abs(np.subtract(*np.arccos(np.clip([cosine, cosine - error[turning][0]], -1, 1)))))
        elif self.task not in (Task.TRANSFORM, Task.ROTATION, Task.PLANAR):  # chord between two directions
            turn = 2 * float(np.arcsin(min(turn / 2, 1.0)))
        return distance, turn

    def _residual(self, pose: Floats, values: Floats, scale: Floats) -> tuple[Floats, Floats]:
        """Return the error of the tool relative to a pose, and the task's Jacobian, both times ``scale``."""
        rotation, place, jacobian = self._kinematics(values)
        if self.task is not Task.TRANSFORM:
            return residual_and_jacobian(self.chain, self.task, pose, ToolState(rotation, place, jacobian), scale)
        missing = np.empty(6)
        missing[:3] = pose[:3, 3] - place
        missing[3:] = rotation_between(rotation, pose)
        return missing * scale, jacobian * scale[:, None]

    def _step(self, values: Floats, error: Floats, jacobian: Floats, damping: float) -> Floats:
        """Return joint values after a damped least-squares step, the best within the limits."""
        pull = jacobian.T @ error
        matrix = jacobian.T @ jacobian + damping * self._identity
        ahead = values + np.linalg.solve(matrix, pull)
        if ((ahead < self._lowest) | (ahead > self._highest)).any():
            moved, factor = np.zeros(len(values)), np.empty((len(values), len(values) + 7))
            size = float(np.abs(pull).max())  # the QP is solved in this unit, since MuJoCo takes small slopes for none
            room = (self._lowest - values) / size, (self._highest - values) / size
            mujoco.mju_boxQP(moved, factor, None, matrix, -pull / size, *room)
            ahead = np.minimum(np.maximum(values + size * moved, self._lowest), self._highest)
        return ahead

    def start(self, number: int) -> Floats:
        """Return start configuration ``number`` of a low-discrepancy sequence, shape (n,)."""
        return self._low + (self._high - self._low) * _evenly(self.chain.dof, number)

    def solve(self, pose: Floats, seed: Floats | None = None, *, starts: int | None = None) -> Floats | None:
        """Return one solution within the limits, shape (n,), or None if no start finds any.

        The first start is the seed, if given; ``starts`` is the maximum number of starts, by default the attribute of
        that name.
        """
        for number in range(self.starts if starts is None else starts):
            start = seed if seed is not None and number == 0 else self.start(number)
            reached = self.descend(pose, start)
            if reached.error < ACCURATE:
                values, inside = nearest_turns(self.chain, reached.values, 0.0 if seed is None else seed)
                return values if inside else reached.values
        return None

    def solve_all(self, pose: Floats) -> Floats:
        """Return the solutions within the limits found from all starts, shape (K, n); others may exist."""
        rows: list[Floats] = []
        for number in range(self.starts):
            reached = self.descend(pose, self.start(number))
            if reached.error < ACCURATE:
                values, inside = nearest_turns(self.chain, reached.values)
                values = values if inside else reached.values
                if all(self.chain.differences(values, other) > DISTINCT for other in rows):
                    rows.append(values)
        return np.array(rows).reshape(-1, self.chain.dof)

    def nearest(self, pose: Floats, seed: Floats, weights: Floats | None = None) -> Nearest:
        """Return the configuration nearest to a pose, reachable or not, by descent from a seed.

        The damping of each step grows until the error decreases.

        Args:
            pose: The pose, shape (4, 4).
            seed: Joint values of the start, shape (n,); the result is a nearby local minimum.
            weights: Weights of errors along and about x, y, z, shape (6,); by default equal.
        """
        scale = self._scale if weights is None else self._scale * weights
        values = np.minimum(np.maximum(seed, self._lowest), self._highest)
        error, jacobian = self._residual(pose, values, scale)
        square, damping, step = float(error @ error), 1e-3, 0
        for step in range(_NEAREST_STEPS):  # noqa: B007 - it is in the result
            ahead = self._step(values, error, jacobian, damping * (1e-9 + square) + 1e-12)
            error_ahead, jacobian_ahead = self._residual(pose, ahead, scale)
            square_ahead = float(error_ahead @ error_ahead)
            if square_ahead < square:
                gained, damping = square - square_ahead, max(damping / 4, 1e-9)
                values, error, jacobian, square = ahead, error_ahead, jacobian_ahead, square_ahead
                if square < 1e-24 or gained < 1e-10 * square:
                    break
            else:
                damping *= 8
                if damping > 1e9:
                    break
        return Nearest(values, float(np.sqrt(square)), step + 1)


def _evenly(count: int, number: int) -> Floats:
    """Return point ``number`` of a low-discrepancy sequence in the unit cube, shape (count,)."""
    ratio = 2.0
    for _ in range(30):
        ratio = (1 + ratio) ** (1 / (count + 1))
    return np.mod(0.5 + number * ratio ** -np.arange(1.0, count + 1), 1.0)


class CompiledKinematics:
    """Pose and Jacobian of one configuration by MuJoCo, for one thread; numpy is faster for many configurations."""

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        self._following = chain if isinstance(chain, FollowingChain) else None
        chain = chain.inner if isinstance(chain, FollowingChain) else chain
        self.model = mujoco.MjModel.from_xml_string(_mjcf(chain))
        self.data = mujoco.MjData(self.model)
        self._qpos, self._place = self.data.qpos, self.data.site_xpos[0]
        self._rows = self.data.site_xmat[0].reshape(3, 3)
        self._jacobian = np.zeros((6, chain.dof))
        self._parts = self._jacobian[:3], self._jacobian[3:]

    def __reduce__(self) -> tuple[type["CompiledKinematics"], tuple[Chain]]:
        return CompiledKinematics, (self.chain,)

    def __call__(self, values: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the tool's rotation (3, 3), position (3,) and Jacobian (6, n); the next call overwrites them."""
        following = self._following
        self._qpos[:] = values if following is None else following.expand(values)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_jacSite(self.model, self.data, *self._parts, 0)
        jacobian = self._jacobian if following is None else self._jacobian @ following.rates(values)
        return self._rows, self._place, jacobian


def _mjcf(chain: Chain) -> str:
    """Return a chain as an MJCF model whose body frames are parallel to the base at joint values of 0."""
    points = np.vstack([np.zeros(3), chain.points, chain.T_base_tool[:3, 3]])
    steps = [_text(step) for step in np.diff(points, axis=0)]
    kinds = ("slide" if sliding else "hinge" for sliding in chain.prismatic.tolist())
    bodies = [
        f'<body pos="{step}"><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        f'<joint type="{kind}" axis="{_text(axis)}"/>'
        for step, kind, axis in zip(steps, kinds, chain.axes, strict=False)
    ]
    axes = " ".join(map(_text, chain.T_base_tool[:3, :2].T))
    site = f'<site pos="{steps[-1]}" xyaxes="{axes}"/>'
    inside = "".join(itertools.chain(bodies, [site], ["</body>"] * len(bodies)))
    return f'<mujoco><compiler angle="radian"/><worldbody>{inside}</worldbody></mujoco>'


def _text(numbers: Floats) -> str:
    return " ".join(map(repr, numbers.tolist()))
