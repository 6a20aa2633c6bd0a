"""Chains: the joints of an arm as axes and points, its limits, and where its tool is.

All is given in the frame of the base, where every joint value is 0 (the product of exponentials: R. W. Brockett, 1983).
A chain knows no links and no file format.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.caching import cached_property
from ravemj.ik.vectors import Bools, Floats, skew

Turns = Sequence[Floats] | Floats
"""For each joint cosines and sines, shape (2, …), or distances, (1, …); one array where all joints are revolute."""
_IDENTITY = np.eye(3)
_FEW = 128
"""Number of configurations up to which calls of numpy take longer than its arithmetic."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Chain:
    """Joints in series, from the base to the tool. Made by ``Chain.of``, which checks.

    Attributes:
        axes: Unit vectors that the joints turn about or move along, shape (n, 3).
        points: A point on each axis [m], shape (n, 3); those of prismatic joints mean nothing.
        prismatic: Which joints move along their axis instead of turning about it, shape (n,).
        lower: Lower limits [rad or m], shape (n,).
        upper: Upper limits, shape (n,).
        circular: Which joints turn without end, whatever their limits say, shape (n,).
        T_base_tool: Pose of the tool, shape (4, 4).
        direction: Unit vector that the tool points along, in its own frame, shape (3,).
    """

    axes: Floats
    points: Floats
    prismatic: Bools
    lower: Floats
    upper: Floats
    circular: Bools
    T_base_tool: Floats
    direction: Floats

    @classmethod
    def of(  # noqa: PLR0913 - one for each attribute
        cls,
        axes: ArrayLike,
        points: ArrayLike,
        *,
        prismatic: Sequence[bool] | Bools | None = None,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        circular: Sequence[bool] | Bools | None = None,
        T_base_tool: ArrayLike | None = None,
        direction: ArrayLike = (0.0, 0.0, 1.0),
    ) -> "Chain":
        """Make a chain of plain numbers; axes and the direction need not be unit vectors.

        Without limits, joints turn by ±pi or move by ±1 m.

        Raises:
            ValueError: wrong shapes, numbers that are not finite, an axis of length 0, a lower limit above the upper
                one, or a tool pose that is no rigid transform.
        """
        directions = np.array(axes, dtype=float).reshape(-1, 3)
        count = len(directions)
        sliding = np.zeros(count, dtype=bool) if prismatic is None else np.array(prismatic, dtype=bool)
        span = np.where(sliding, 1.0, np.pi)
        chain = cls(
            axes=directions,
            points=np.array(points, dtype=float).reshape(-1, 3),
            prismatic=sliding,
            lower=-span if lower is None else np.array(lower, dtype=float),
            upper=span if upper is None else np.array(upper, dtype=float),
            circular=np.zeros(count, dtype=bool) if circular is None else np.array(circular, dtype=bool),
            T_base_tool=np.eye(4) if T_base_tool is None else np.array(T_base_tool, dtype=float),
            direction=np.array(direction, dtype=float),
        )
        chain._check()
        pointing = chain.direction / (np.linalg.norm(chain.direction) or 1.0)
        return replace(chain, axes=directions / np.linalg.norm(directions, axis=1, keepdims=True), direction=pointing)

    def _check(self) -> None:
        count = len(self.axes)
        if self.points.shape != (count, 3):
            raise ValueError(f"points of shape {self.points.shape} for {count} axes: expected ({count}, 3)")
        for name in ("prismatic", "lower", "upper", "circular"):
            shape = getattr(self, name).shape
            if shape != (count,):
                raise ValueError(f"{name} of shape {shape} for {count} axes: expected ({count},)")
        if not (np.isfinite(self.axes).all() and np.isfinite(self.points).all()):
            raise ValueError("an axis or a point of the chain is not finite")
        if count and np.linalg.norm(self.axes, axis=1).min() == 0:
            raise ValueError("an axis of the chain is 0 0 0, which is not a direction")
        if not (self.lower <= self.upper).all():
            raise ValueError("a lower limit of the chain is above the upper one, or not a number")
        check_poses(self.T_base_tool)

    @property
    def dof(self) -> int:
        """Number of joints."""
        return len(self.axes)

    @cached_property
    def turning(self) -> Bools:
        """Which joints turn, shape (n,)."""
        return ~self.prismatic

    @cached_property
    def bounds(self) -> tuple[Floats, Floats]:
        """Limits, both of shape (n,), which circular joints do not have."""
        return np.where(self.circular, -np.inf, self.lower), np.where(self.circular, np.inf, self.upper)

    @cached_property
    def wide(self) -> list[int]:
        """Joints with limits that can show a configuration in several turns."""
        span = self.upper - self.lower
        several = self.turning & ~self.circular & np.isfinite(span) & (span >= 2 * np.pi - 1e-9)
        return np.nonzero(several)[0].tolist()

    @cached_property
    def reach(self) -> float:
        """Length of the chain [m]: the sum of distances from point to point and on to the tool; never 0."""
        points = np.vstack([self.points[~self.prismatic], self.T_base_tool[:3, 3]])
        length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        sliding = np.abs(np.stack([self.lower, self.upper]))[:, self.prismatic]
        return float(length + sliding[np.isfinite(sliding)].sum()) or 1.0

    @cached_property
    def _steps(self) -> list[Floats]:
        """From the frame of each joint, whose z is its axis, to the next, transposed; the first starts at the base."""
        frames = [np.eye(4)]
        for axis, point in zip(self.axes, self.points, strict=True):
            side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
            side /= np.linalg.norm(side)
            frame = np.eye(4)
            frame[:3] = np.column_stack([side, np.cross(axis, side), axis, point])
            frames.append(frame)
        frames.append(self.T_base_tool)
        steps = [np.linalg.inv(first) @ second for first, second in itertools.pairwise(frames)]
        return [np.array(step.T, dtype=float, order="C") for step in steps]

    def _frames(self, turns: Turns) -> list[Floats]:
        """Return the frames of the joints before their motions, and the tool: x, y, z and origin (4, 3, M)."""
        count = turns[0].shape[-1] if len(turns) else 1
        frame = np.repeat(self._steps[0][:, :3, None], count, axis=2)
        frames = [frame]
        for value, step, sliding in zip(turns, self._steps[1:], self.prismatic.tolist(), strict=True):
            moved = np.empty_like(frame)
            if sliding:
                moved[:3] = frame[:3]
                moved[3] = frame[3] + value[0] * frame[2]
            else:
                np.multiply(frame[:2], value[0], out=moved[:2])
                moved[0] += value[1] * frame[1]
                moved[1] -= value[1] * frame[0]
                moved[2:] = frame[2:]
            frame = (step @ moved.reshape(4, -1)).reshape(4, 3, -1)
            frames.append(frame)
        return frames

    @cached_property
    def _motions(self) -> Floats:
        """For each joint its motion as matrices times 1, cosine and sine, or 1, value and 0, shape (n, 3, 16)."""
        motions = np.zeros((self.dof, 3, 4, 4))
        for motion, axis, point, sliding in zip(motions, self.axes, self.points, self.prismatic.tolist(), strict=True):
            motion[0, 3, 3] = 1
            if sliding:
                motion[0, :3, :3], motion[1, :3, 3] = np.eye(3), axis
            else:
                along = np.outer(axis, axis)
                motion[:, :3, :3] = along, np.eye(3) - along, skew(axis)
                motion[:, :3, 3] = -motion[:, :3, :3] @ point
                motion[0, :3, 3] += point
        return motions.reshape(self.dof, 3, 16)

    def _few_tool_columns(self, turns: Turns) -> Floats:
        """As ``tool_columns``, in fewer calls of numpy, with more arithmetic."""
        count = turns[0].shape[-1]
        factors = np.zeros((self.dof, 3, count))
        factors[:, 0] = 1
        if isinstance(turns, np.ndarray):
            factors[:, 1:] = turns
        else:
            for factor, turn in zip(factors, turns, strict=True):
                factor[1 : 1 + len(turn)] = turn
        steps = (factors.swapaxes(1, 2) @ self._motions).reshape(self.dof, count, 4, 4)
        poses = steps[0]
        for step in steps[1:]:
            poses = poses @ step
        return (poses @ self.T_base_tool)[:, :3].transpose(2, 1, 0)

    def turns(self, values: Floats) -> list[Floats]:
        """Return joint values, shape (M, n), as cosines and sines (2, M) or distances (1, M)."""
        return [
            column[None] if sliding else np.stack([np.cos(column), np.sin(column)])
            for column, sliding in zip(np.moveaxis(values, -1, 0), self.prismatic.tolist(), strict=True)
        ]

    def tool_columns(self, turns: Turns) -> Floats:
        """Return the tool's x, y, z and origin, shape (4, 3, M), for cosines and sines; see ``turns``."""
        if len(turns) and turns[0].shape[-1] <= _FEW:
            return self._few_tool_columns(turns)
        return self._frames(turns)[-1]

    def forward(self, values: Floats) -> Floats:
        """Return poses of the tool (..., 4, 4) for joint values (..., n)."""
        flat = values.reshape(-1, self.dof) if self.dof else np.zeros((int(np.prod(values.shape[:-1])), 0))
        columns = self.tool_columns(self.turns(flat))
        poses = np.zeros((len(flat), 4, 4))
        poses[:, :3] = np.broadcast_to(columns, (4, 3, len(flat))).transpose(2, 1, 0)
        poses[:, 3, 3] = 1
        return poses.reshape(*values.shape[:-1], 4, 4)

    def forward_and_jacobian(self, values: Floats) -> tuple[Floats, Floats]:
        """Return tool columns (4, 3, M) and Jacobians (M, 6, n) for joint values (M, n).

        A Jacobian's first rows are the velocity of the tool's origin, its last the angular velocity, in base axes.
        """
        frames = self._frames(self.turns(values))
        tool = frames[-1]
        jacobians = np.zeros((len(values), 6, self.dof))
        for joint, sliding in enumerate(self.prismatic.tolist()):
            axis = frames[joint][2]
            if sliding:
                jacobians[:, :3, joint] = axis.T
            else:
                arm = tool[3] - frames[joint][3]
                jacobians[:, :3, joint] = np.cross(axis, arm, axis=0).T
                jacobians[:, 3:, joint] = axis.T
        return tool, jacobians

    def placed_axes(self, values: Floats) -> tuple[Floats, Floats]:
        """Return the axes and a point on each, both (n, M, 3), in the configurations of joint values (M, n)."""
        frames = np.array(self._frames(self.turns(values))[:-1])
        return frames[:, 2].transpose(0, 2, 1), frames[:, 3].transpose(0, 2, 1)

    def locked(self, joint: int, value: float) -> "Chain":
        """Return the chain without a joint, which stays at a value."""
        motion = self.motion(joint, value)
        rest = np.arange(self.dof) != joint
        beyond = np.arange(self.dof) > joint
        axes, points = self.axes.copy(), self.points.copy()
        axes[beyond] = axes[beyond] @ motion[:3, :3].T
        points[beyond] = points[beyond] @ motion[:3, :3].T + motion[:3, 3]
        return Chain(
            axes=axes[rest],
            points=points[rest],
            prismatic=self.prismatic[rest],
            lower=self.lower[rest],
            upper=self.upper[rest],
            circular=self.circular[rest],
            T_base_tool=motion @ self.T_base_tool,
            direction=self.direction,
        )

    def motion(self, joint: int, value: float) -> Floats:
        """Return the rigid motion, shape (4, 4), that a joint makes (O. Rodrigues' formula)."""
        motion = np.eye(4)
        axis, point = self.axes[joint], self.points[joint]
        if self.prismatic[joint]:
            motion[:3, 3] = value * axis
        else:
            turning = skew(axis)
            motion[:3, :3] += np.sin(value) * turning + (1 - np.cos(value)) * turning @ turning
            motion[:3, 3] = point - motion[:3, :3] @ point
        return motion


def check_poses(poses: Floats) -> None:
    """Check that poses, shape (..., 4, 4), are rigid transforms.

    Raises:
        ValueError: wrong shape, numbers that are not finite, a rotation off by more than 1e-6, or a mirror.
    """
    if poses.shape[-2:] != (4, 4):
        raise ValueError(f"poses of shape {poses.shape}: expected (..., 4, 4)")
    if not np.isfinite(poses).all():
        raise ValueError("a pose is not finite")
    rotations = poses[..., :3, :3]
    error = np.abs(np.swapaxes(rotations, -1, -2) @ rotations - _IDENTITY).max(initial=0.0)
    if error > 1e-6 or (np.linalg.det(rotations) < 0).any() or (poses[..., 3, :] != (0.0, 0.0, 0.0, 1.0)).any():
        raise ValueError("a pose is not a rigid transform: its rotation has scale, shear or a mirror in it")
