"""Kinematic chains: the joints of an arm as axes and points, its limits, and its tool.

All quantities are in the base frame, at joint values of 0 (the product of exponentials: R. W. Brockett, 1983). A chain
is independent of links and file formats.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.caching import cached_property
from ravemj.ik.vectors import Bools, Floats, cross, skew

Turns = Sequence[Floats] | Floats
"""Joint values: cosines and sines (2, …) or, if prismatic, distances (1, …); one array if all joints are revolute."""
_IDENTITY = np.eye(3)
_EXACT, _NEARLY = 1e-12, 1e-3
"""Maximum errors of a rotation: accepted as rounding error, and corrected to the nearest rotation."""
_FEW = 128
"""Number of configurations up to which forward kinematics use the variant with fewer numpy calls."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Chain:
    """Serial chain of joints from the base to the tool. ``Chain.of`` makes and checks it.

    Attributes:
        axes: Unit vectors along the joint axes, shape (n, 3).
        points: A point on each axis [m], shape (n, 3); arbitrary for prismatic joints.
        prismatic: Whether each joint is prismatic, shape (n,).
        lower: Lower limits [rad or m], shape (n,).
        upper: Upper limits, shape (n,).
        circular: Whether each joint rotates without limits, shape (n,).
        T_base_tool: Pose of the tool, shape (4, 4).
        direction: Direction of the tool, a unit vector in its own frame, shape (3,).
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
        """Make a chain from arrays; axes and the direction need not be unit vectors.

        Default limits are ±pi or ±1 m.

        Raises:
            ValueError: wrong shapes, numbers that are not finite, an axis of length 0, a lower limit above the upper
                one, or a tool pose that is not a rigid transform.
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
        """Mask of the revolute joints, shape (n,)."""
        return ~self.prismatic

    @cached_property
    def bounds(self) -> tuple[Floats, Floats]:
        """Limits, both of shape (n,); infinite for circular joints."""
        return np.where(self.circular, -np.inf, self.lower), np.where(self.circular, np.inf, self.upper)

    @cached_property
    def wide(self) -> list[int]:
        """Revolute joints whose range is a full turn or more, so that angles have several equivalents."""
        span = self.upper - self.lower
        several = self.turning & ~self.circular & np.isfinite(span) & (span >= 2 * np.pi - 1e-9)
        return np.nonzero(several)[0].tolist()

    @cached_property
    def reach(self) -> float:
        """Length of the chain [m]: the sum of distances between consecutive points and to the tool; never 0."""
        points = np.vstack([self.points[~self.prismatic], self.T_base_tool[:3, 3]])
        length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        sliding = np.abs(np.stack([self.lower, self.upper]))[:, self.prismatic]
        return float(length + sliding[np.isfinite(sliding)].sum()) or 1.0

    @cached_property
    def _steps(self) -> list[Floats]:
        """Transposed transforms between consecutive joint frames, from the base to the tool; z is along each axis."""
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
        """Return each joint frame before the joint's own motion, then the tool frame: x, y, z, origin (4, 3, M)."""
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
        """Matrices A, B, C of each joint's motion, (n, 3, 16): A + B cos(q) + C sin(q), or A + B q if prismatic."""
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

    def _few_poses(self, turns: Turns) -> Floats:
        """Return products of the first 0 … n joint motions, shape (n + 1, M, 4, 4), with few numpy calls."""
        count = turns[0].shape[-1]
        factors = np.zeros((self.dof, 3, count))
        factors[:, 0] = 1
        if isinstance(turns, np.ndarray):
            factors[:, 1:] = turns
        else:
            for factor, turn in zip(factors, turns, strict=True):
                factor[1 : 1 + len(turn)] = turn
        poses = np.empty((self.dof + 1, count, 4, 4))
        poses[0] = np.eye(4)
        np.matmul(factors.swapaxes(1, 2), self._motions, out=poses[1:].reshape(self.dof, count, 16))
        for before, pose in itertools.pairwise(poses[1:]):
            np.matmul(before, pose, out=pose)
        return poses

    def turns(self, values: Floats) -> Turns:
        """Return joint values, shape (M, n), as cosines and sines (2, M) or distances (1, M)."""
        columns = np.ascontiguousarray(np.moveaxis(values, -1, 0))
        both = np.stack([np.cos(columns), np.sin(columns)], axis=1)
        if self.turning.all():
            return both
        joints = zip(columns, both, self.prismatic.tolist(), strict=True)
        return [column[None] if sliding else turn for column, turn, sliding in joints]

    def tool_columns(self, turns: Turns) -> Floats:
        """Return axes x, y, z and origin of the tool, shape (4, 3, M), for joint values given as ``Turns``."""
        if len(turns) and turns[0].shape[-1] <= _FEW:
            return self._tool_of(self._few_poses(turns))
        return self._frames(turns)[-1]

    def _tool_of(self, poses: Floats) -> Floats:
        """Return the tool's x, y, z and origin, shape (4, 3, M), from the result of ``_few_poses``."""
        return (poses[-1] @ self.T_base_tool)[:, :3].transpose(2, 1, 0)

    def forward(self, values: Floats) -> Floats:
        """Return poses of the tool (..., 4, 4) for joint values (..., n)."""
        flat = values.reshape(-1, self.dof) if self.dof else np.zeros((int(np.prod(values.shape[:-1])), 0))
        columns = self.tool_columns(self.turns(flat))
        poses = np.zeros((len(flat), 4, 4))
        poses[:, :3] = np.broadcast_to(columns, (4, 3, len(flat))).transpose(2, 1, 0)
        poses[:, 3, 3] = 1
        return poses.reshape(*values.shape[:-1], 4, 4)

    def forward_and_jacobian(self, values: Floats) -> tuple[Floats, Floats]:
        """Return ``tool_columns`` (4, 3, M) and Jacobians (M, 6, n) for joint values (M, n).

        The first three rows of a Jacobian are the linear velocity of the tool's origin, the others the angular
        velocity, in base axes.
        """
        turns, jacobians = self.turns(values), np.zeros((len(values), 6, self.dof))
        if not self.dof:
            return self._frames(turns)[-1], jacobians
        if len(values) <= _FEW:
            poses = self._few_poses(turns)
            tool, before = self._tool_of(poses), poses[:-1, :, :3]
            axes, points = (before @ self._lines[:, None]).transpose(3, 2, 0, 1)  # both of shape (3, n, M)
        else:
            frames = self._frames(turns)
            tool, (_, _, axes, points) = frames[-1], np.array(frames[:-1]).transpose(1, 2, 0, 3)
        turning = self.turning[:, None]
        jacobians[:, :3] = np.where(turning, cross(axes, tool[3][:, None] - points), axes).transpose(2, 0, 1)
        jacobians[:, 3:] = np.where(turning, axes, 0.0).transpose(2, 0, 1)
        return tool, jacobians

    @cached_property
    def _lines(self) -> Floats:
        """Homogeneous direction and point of each axis, columns to multiply by ``_few_poses``; shape (n, 4, 2)."""
        lines = np.zeros((self.dof, 4, 2))
        lines[:, :3, 0], lines[:, :3, 1], lines[:, 3, 1] = self.axes, self.points, 1
        return lines

    def placed_axes(self, values: Floats) -> tuple[Floats, Floats]:
        """Return the direction of each joint axis and a point on it, both (n, M, 3), at joint values (M, n)."""
        frames = np.array(self._frames(self.turns(values))[:-1])
        return frames[:, 2].transpose(0, 2, 1), frames[:, 3].transpose(0, 2, 1)

    def differences(self, values: Floats, others: Floats) -> Floats:
        """Return the largest joint difference between configurations (..., n), ignoring whole turns, shape (...).

        Revolute joints are measured by a chord of the unit circle, prismatic ones in units of the reach.
        """
        away = values - others
        return np.abs(np.where(self.prismatic, away / self.reach, 2 * np.sin(away / 2))).max(axis=-1, initial=0.0)

    def locked(self, joint: int, value: float) -> "Chain":
        """Return the chain with one joint fixed at a value and removed."""
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
        """Return the rigid motion of a joint, shape (4, 4) (O. Rodrigues' formula)."""
        motion = np.eye(4)
        axis, point = self.axes[joint], self.points[joint]
        if self.prismatic[joint]:
            motion[:3, 3] = value * axis
        else:
            turning = skew(axis)
            motion[:3, :3] += np.sin(value) * turning + (1 - np.cos(value)) * turning @ turning
            motion[:3, 3] = point - motion[:3, :3] @ point
        return motion


def rigid_poses(poses: Floats) -> Floats:
    """Return poses, shape (..., 4, 4), with slightly inaccurate rotations replaced by the nearest rotations.

    The nearest rotation is the orthogonal factor of the polar decomposition (N. J. Higham, 1986).

    Raises:
        ValueError: wrong shape, numbers that are not finite, a rotation R with |R^T R - I| above 1e-3, or a reflection.
    """
    error = check_poses(poses, _NEARLY)
    if error <= _EXACT:
        return poses
    left, _, right = np.linalg.svd(poses[..., :3, :3])
    rigid = poses.copy()
    rigid[..., :3, :3] = left @ right
    return rigid


def check_poses(poses: Floats, most: float = 1e-6) -> float:
    """Check that poses, shape (..., 4, 4), are rigid transforms, and return their error.

    Args:
        poses: The poses.
        most: Maximum entry of R^T R - I of a rotation R.

    Returns:
        The largest entry of R^T R - I.

    Raises:
        ValueError: wrong shape, numbers that are not finite, a rotation with a larger error, or a reflection.
    """
    if poses.shape[-2:] != (4, 4):
        raise ValueError(f"poses of shape {poses.shape}: expected (..., 4, 4)")
    if not np.isfinite(poses).all():
        raise ValueError("a pose is not finite")
    rotations = poses[..., :3, :3]
    error = float(np.abs(np.swapaxes(rotations, -1, -2) @ rotations - _IDENTITY).max(initial=0.0))
    wrong = ""
    if (poses[..., 3, :] != (0.0, 0.0, 0.0, 1.0)).any():
        wrong = "its last row is not 0 0 0 1"
    elif (np.linalg.det(rotations) < 0).any():
        wrong = "its rotation has a mirror in it"
    elif error > most:
        wrong = f"its rotation has scale or shear in it: R^T R differs from I by {error:.2g}, more than {most:g}"
    if wrong:
        raise ValueError(f"a pose is not a rigid transform: {wrong}")
    return error
