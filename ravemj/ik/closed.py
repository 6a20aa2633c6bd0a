"""Closed-form solvers: solutions of a family, checked by forward kinematics of the true arm, and refined."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from string import ascii_lowercase

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.ik.chain import Chain, Turns
from ravemj.ik.families.loops import Family
from ravemj.ik.families.one_pose import OnePose
from ravemj.ik.limits import nearest_turns
from ravemj.ik.tasks import Task
from ravemj.ik.vectors import Bools, Floats, Ints, Transform, cross, tile

EXACT = 1e-10
"""Error above which a solution is refined by Newton's method."""
ACCURATE = 1e-9
"""Error above which a refined candidate is rejected."""
_CHUNK = 1536
"""Maximum number of poses per batch, so that the arrays fit into the processor's cache."""
_MARGIN = 0.05
"""Distance beyond the limits [rad or m] up to which solutions are refined; Newton steps change them less than this."""
_SAME = 1e-5
"""Largest difference of equal solutions, in cosines, sines and distances."""
_STEPS = 12
"""Maximum number of Newton steps."""
_MOST_GROWTH = 2.0
"""Ratio of the error to the initial one above which Newton's method stops, if the closed form is accurate.

A larger growth means that the pose is just out of reach, where the closed form returns an inexact double solution.
"""
_SETTLED, _SLOWEST = 3, 0.5
"""Number of Newton steps before convergence is checked; maximum ratio of the errors after and before a later step.

At double solutions, this ratio is 0.25.
"""


@dataclass(frozen=True, eq=False)
class Solutions:
    """Solutions of N poses in B branches.

    Attributes:
        values: Joint values, shape (N, B, n), angles in [-pi, pi]; invalid rows have arbitrary values.
        valid: Whether each row is a solution, shape (N, B).
        merged: Whether equal solutions of a pose were merged, shape (N,), as in singular configurations.
        errors: Error before refinement, positions divided by the reach and angles in rad, shape (N, B).
    """

    values: Floats
    valid: Bools
    merged: Bools
    errors: Floats

    def __len__(self) -> int:
        return len(self.values)

    def of(self, pose: int) -> Floats:
        """Return the solutions of one pose, shape (K, n)."""
        return self.values[pose][self.valid[pose]]

    def only(self, pose: int) -> "Solutions":
        """Return the solutions of one pose as an object with N = 1."""
        row = slice(pose, pose + 1)
        return Solutions(self.values[row], self.valid[row], self.merged[row], self.errors[row])

    @classmethod
    def joined(cls, parts: Sequence["Solutions"]) -> "Solutions":
        """Concatenate the solutions of several batches of poses."""
        return cls(
            np.concatenate([part.values for part in parts]),
            np.concatenate([part.valid for part in parts]),
            np.concatenate([part.merged for part in parts]),
            np.concatenate([part.errors for part in parts]),
        )

    @property
    def rows(self) -> tuple[Floats, Ints, Ints]:
        """All solutions, shape (K, n), with their pose and branch indices, shape (K,)."""
        pose, branch = np.nonzero(self.valid)
        return self.values[pose, branch], pose, branch


class ClosedForm:
    """Closed-form solver of a family; the values of locked joints are given with each goal.

    Attributes:
        chain: The true arm.
        task: The constrained components of the pose.
        family: The family.
        near: Maximum error up to which a solution of the family is refined.
    """

    def __init__(self, chain: Chain, task: Task, family: Family, *, snapped: bool) -> None:
        self.chain, self.task, self.family = chain, task, family
        # snapped geometry and quartics give inaccurate solutions, other families only rounding errors
        self._is_accurate = not (snapped or family.coupled)
        self.near = 1e-4 if self._is_accurate else 0.03
        self._tool = np.linalg.inv(chain.T_base_tool)
        joints = family.arm.joints
        self._answers = [(index, joints[place]) for index, place in enumerate(family.order) if joints[place] >= 0]
        self._locked = {joints[place]: place for place in family.arm.locked}
        self._scale = np.array([1 / chain.reach] * 3 + [1.0] * 3)
        self._rows = np.array(task.rows)
        places = [(row in task.rows) / chain.reach**2 for row in range(3)]
        # half of the squared differences of three axes is the squared angle; positions alone leave rotations out
        self._counts = np.array([0.5 * (max(task.rows) > 2)] * 9 + places)
        self._order = [index for index, _ in sorted(self._answers, key=lambda answer: answer[1])]
        self._one_pose = OnePose.for_family(family)

    @property
    def locked(self) -> list[int]:
        """The locked joints, whose values are given."""
        return sorted(self._locked)

    @cached_property
    def branch_names(self) -> list[str]:
        """A name for each branch: the joints with several solutions, counted from 1, each with a sign or letter."""
        names = [""]
        for place, count in self.family.names():
            joint = self.family.arm.joints[place]
            label = f"j{joint + 1}" if joint >= 0 else "added"
            if count > 1:
                signs = "+-" if count == 2 else ascii_lowercase[:count]
                names = [f"{before} {label}{sign}".lstrip() for sign in signs for before in names]
        return names

    def solve(self, poses: Floats, locked: Floats | None = None, *, limits: bool = False) -> Solutions:
        """Return all solutions; with ``limits``, solutions outside of the limits may be missing.

        Args:
            poses: Poses of the tool in the base, shape (N, 4, 4).
            locked: Values of the locked joints, shape (N, k).
            limits: Whether to skip the refinement of solutions far outside the limits.
        """
        given = np.zeros((len(poses), 0)) if locked is None else locked
        branches = len(self.branch_names)
        values = np.zeros((self.chain.dof, branches, len(poses)))
        valid = np.zeros((branches, len(poses)), dtype=bool)
        merged, errors = np.zeros(len(poses), dtype=bool), np.zeros(valid.shape)
        with np.errstate(all="ignore"):
            for first in range(0, len(poses), _CHUNK):
                part = slice(first, first + _CHUNK)
                turns = self._turns(poses[part], given[part], valid[:, part].shape)
                parts = values[..., part], valid[:, part], merged[part]
                errors[:, part] = self._check(poses[part], turns, *parts, limits=limits)
        return Solutions(values.transpose(2, 1, 0), valid.T, merged, errors.T)

    def _check(
        self, poses: Floats, turns: Turns, values: Floats, valid: Bools, merged: Bools, *, limits: bool
    ) -> Floats:
        """Check the solutions ``turns`` of the closed form.

        The joint values, ``valid`` and ``merged`` are written into the given arrays.

        Returns:
            The pose errors.
        """
        if isinstance(turns, np.ndarray):
            np.arctan2(turns[:, 1], turns[:, 0], out=values)
        else:
            for joint, turn in enumerate(turns):
                values[joint] = np.arctan2(turn[1], turn[0]) if len(turn) > 1 else turn[0]
        goal = np.ascontiguousarray(poses[:, :3].transpose(2, 1, 0))
        tool = self.chain.tool_columns(_flat(turns))
        error = self._error(tool.reshape(4, 3, *valid.shape), goal[:, :, None])
        np.less_equal(error, EXACT, out=valid)
        doubtful = (error <= self.near) & ~valid
        if limits and doubtful.any():
            doubtful &= nearest_turns(self.chain, np.moveaxis(values, 0, -1), tolerance=_MARGIN)[1]
        if doubtful.any() and self._refine(doubtful, goal, values, valid):
            turns = self.chain_turns(values)
        _merge(np.concatenate(turns), valid, merged)
        return error

    def chain_turns(self, values: Floats) -> list[Floats]:
        """Convert joint values of shape (n, B, N) to cosines and sines (2, B, N) and distances (1, B, N)."""
        flat = self.chain.turns(values.reshape(len(values), -1).T)
        return [turn.reshape(len(turn), *values.shape[1:]) for turn in flat]

    def _turns(self, poses: Floats, locked: Floats, shape: tuple[int, ...]) -> Turns:
        """Return the solutions of the solver family by joint: cosine and sine (2, B, N) or distances (1, B, N)."""
        if self._one_pose is not None and len(poses) == 1:
            return self._turns_of_one(poses[0], self._one_pose)
        reach = self.chain.reach
        given: dict[int, Floats] = {}
        turns: list[Floats] = [np.zeros((1, *shape))] * self.chain.dof
        for column, joint in zip(locked.T, self.locked, strict=True):
            if self.chain.prismatic[joint]:
                given[joint], turns[joint] = column[None, None] / reach, column[None, None]
            else:
                given[joint] = turns[joint] = np.stack([np.cos(column), np.sin(column)])[:, None]
        at = {self._locked[joint]: value for joint, value in given.items()}
        solved = self.family.solve(self._motion(poses, at), at)
        for index, joint in self._answers:
            turns[joint] = solved[index] * reach if self.chain.prismatic[joint] else solved[index]
        branches = shape[0]
        return [_filled(tile(turn, branches), (len(turn), *shape)) for turn in turns]

    def _turns_of_one(self, pose: Floats, solver: OnePose) -> Floats:
        """Return the solutions of the solver family for one pose, computed in Python floats, shape (6, 2, B, 1)."""
        motion = pose @ self._tool
        motion[:3, 3] /= self.chain.reach
        x, y, z, _ = motion.tolist()
        solved = solver.solve((tuple(x[:3]), tuple(y[:3]), tuple(z[:3]), (x[3], y[3], z[3])))
        numbers = chain.from_iterable(chain.from_iterable(solved))
        turns = np.fromiter(numbers, float, 12 * len(solved)).reshape(-1, 6, 2)
        return turns[:, self._order].transpose(1, 2, 0)[..., None]

    def _motion(self, poses: Floats, locked: dict[int, Floats]) -> Transform:
        """Return the motion that the joints must make or, if only the position is constrained, the tool's position.

        The unit of length is the reach.
        """
        whole = self.task in (Task.TRANSFORM, Task.PLANAR)
        motion = poses @ self._tool if whole else poses
        rotation = np.ascontiguousarray(motion[:, :3, :3].transpose(1, 2, 0))[:, :, None]
        transform = Transform(rotation, motion[:, :3, 3].T[:, None] / self.chain.reach)
        return self.family.arm.trimmed(transform, locked) if whole and locked else transform

    def _error(self, tool: Floats, goal: Floats) -> Floats:
        """Return the norm of the tool's error: position divided by the reach, angle in rad."""
        away = tool - goal
        away *= away
        return np.sqrt((self._counts @ away.reshape(12, -1)).reshape(away.shape[2:]))

    def errors(self, values: Floats, poses: Floats) -> Floats:
        """Return the errors of values (M, n) for poses (M, 4, 4): positions divided by the reach, angles in rad."""
        tool = self.chain.tool_columns(self.chain.turns(values))
        return self._error(tool, poses[:, :3].transpose(2, 1, 0))

    def _refine(self, doubtful: Bools, goal: Floats, values: Floats, valid: Bools) -> bool:
        """Refine the solutions marked in ``doubtful`` by Newton's method; set ``valid`` if they reach their goals.

        Returns:
            Whether any of them reaches its goal.
        """
        branch, pose = np.nonzero(doubtful)
        start = values[:, branch, pose].T
        refined, error = self.refine(start, goal[:, :, pose])
        near = np.abs(refined - start).max(axis=1) < 0.5  # farther ones are solutions of other branches
        good = (error <= ACCURATE) & near
        values[:, branch[good], pose[good]] = refined[good].T
        valid[branch[good], pose[good]] = True
        return bool(good.any())

    def refine(self, values: Floats, goal: Floats) -> tuple[Floats, Floats]:
        """Refine values (M, n) by damped Newton steps towards M tool poses; return them and their errors (M,).

        ``goal`` has the axes x, y, z and the position of the tool, shape (4, 3, M). Locked joints keep their values.
        """
        chain, free = self.chain, [joint for joint in range(self.chain.dof) if joint not in self._locked]
        values = values.copy()
        errors = first = np.full(len(values), np.inf)
        active = np.arange(len(values))
        for step in range(_STEPS):
            tool, jacobians = chain.forward_and_jacobian(values[active])
            target, before = goal[:, :, active], errors[active]
            errors[active] = self._error(tool, target)
            first = errors.copy() if step == 0 else first
            active_again = errors[active] > EXACT / 10
            if self._is_accurate:
                active_again &= errors[active] < _MOST_GROWTH * first[active]
            if step >= _SETTLED:
                active_again &= errors[active] < _SLOWEST * before
            if step == _STEPS - 1 or not active_again.any():
                break
            turned = cross(tool[:3].swapaxes(0, 1), target[:3].swapaxes(0, 1)).sum(axis=1)
            missing = np.concatenate([target[3] - tool[3], turned / 2]).T * self._scale
            jacobians = jacobians * self._scale[:, None]
            part = jacobians[active_again][:, self._rows][:, :, free]
            square: Floats = part.swapaxes(1, 2) @ part
            # damping that keeps singular systems solvable, too small to slow the convergence of others
            square += 1e-13 * np.eye(len(free)) * (1 + np.trace(square, axis1=1, axis2=2)[:, None, None])
            pull: Floats = part.swapaxes(1, 2) @ missing[active_again][:, self._rows, None]
            active = active[active_again]
            moved = np.asarray(np.linalg.solve(square, pull), dtype=float)[:, :, 0]
            values[active[:, None], free] += np.clip(moved, -0.3, 0.3)
        turning = ~chain.prismatic
        values[:, turning] = np.mod(values[:, turning] + np.pi, 2 * np.pi) - np.pi
        return values, errors


def _flat(turns: Turns) -> Turns:
    """Flatten the axes of branches and poses of joint values into one; values are (cosine, sine) or distances."""
    if isinstance(turns, np.ndarray):
        return turns.reshape(*turns.shape[:2], -1)
    return [turn.reshape(len(turn), -1) for turn in turns]


def _filled(values: Floats, shape: tuple[int, ...]) -> Floats:
    return values if values.shape == shape else np.broadcast_to(values, shape)


def _merge(parts: Floats, valid: Bools, merged: Bools) -> None:
    """Keep one of several equal solutions of a pose; mark the others as invalid, and the pose as merged.

    Solutions are equal if, for instance, axes coincide or two branches meet.

    ``parts`` are cosines, sines and distances of all joints, shape (K, B, N); ``valid`` (B, N) and ``merged`` (N,) are
    changed. Equal rows have equal sums with fixed weights, so only neighbours in the order of these sums are compared.
    """
    weights = np.mod(np.arange(1, len(parts) + 1) * 0.618034, 1) + 0.5
    mark = (weights @ parts.reshape(len(parts), -1)).reshape(valid.shape)
    mark[~valid] = np.inf
    mark.sort(axis=0)
    close = np.logical_or.reduce(mark[1:] - mark[:-1] < 10 * _SAME, axis=0)
    for pose in np.nonzero(close)[0]:
        kept: list[Floats] = []
        for branch in np.nonzero(valid[:, pose])[0]:
            row = parts[:, branch, pose]
            if any(np.abs(row - other).max() < _SAME for other in kept):
                valid[branch, pose], merged[pose] = False, True
            else:
                kept.append(row)
