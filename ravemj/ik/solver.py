"""Common interface of IK solvers: closed form, closed form with sampled joints, or numeric search.

Poses are ``T_base_tool``. Limits, whole turns, free joints and singular configurations are handled as in OpenRAVE: all
turns within the limits are solutions; a free joint is sampled from 0 or from the present value outwards; if two joints
rotate about one line, the first is sampled every pi/8. If no sample has a solution, values between the samples are
tried (``intervals``).
"""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ravemj.ik import redundancy
from ravemj.ik.chain import Chain
from ravemj.ik.closed import ClosedForm, Solutions
from ravemj.ik.derive import Validation, derive
from ravemj.ik.following import FollowingChain
from ravemj.ik.intervals import between_samples, closest
from ravemj.ik.limits import all_turns, distances, nearest_turns
from ravemj.ik.numeric import ACCURATE, DISTINCT, NumericSolver
from ravemj.ik.reductions import ReducedForm, derive_reduced
from ravemj.ik.redundancy import ANGLE_STEP, SLIDE_STEP
from ravemj.ik.tasks import Task, goal_poses
from ravemj.ik.vectors import Floats

_TRIED = 12
_STARTS = 24
"""Number of starts of a numeric search for a solution."""
FIRST, NEXT = 12, 96
"""Batch sizes of free joint samples; the first is small, since samples near the present values mostly suffice."""


_NEAREST_STARTS = 12
"""Number of starts of a numeric search for the nearest reachable pose."""
_MOST_SAMPLES = 256
_NO_ANGLE = 1e-4


@dataclass(frozen=True, eq=False)
class Reachable:
    """Reachable configuration nearest to a goal.

    Attributes:
        values: Joint values within the limits, shape (n,).
        T_base_tool: The pose of the tool, shape (4, 4).
        distance: Distance to the goal [m]; 0 if the task does not constrain the position.
        angle: Angle to the goal [rad]; 0 if the task does not constrain the orientation.
    """

    values: Floats
    T_base_tool: Floats
    distance: float
    angle: float

    def __str__(self) -> str:
        """Describe how far the goal is from the nearest reachable pose."""
        turn = f"{np.degrees(self.angle):.1f}°"
        far = f"{self.distance:.3g} m" + (f" and {turn}" if self.angle > _NO_ANGLE else "")
        return f"the nearest that it reaches is {far if self.distance else turn} away"


@dataclass(frozen=True, eq=False)
class ArmSolutions:
    """IK solver of one arm for one task. ``make_solver`` makes it.

    Attributes:
        chain: The arm.
        task: The constrained components of the tool pose.
        closed: The closed-form solver, or None if no family fits.
        certificate: The validation of ``closed`` on random configurations.
        free: The sampled joints.
        steps: Sampling step of each free joint [rad or m]; several free joints may be sampled more coarsely.
        numeric: The numeric solver, used if there is no closed form.
    """

    chain: Chain
    task: Task
    closed: ClosedForm | ReducedForm | None
    certificate: Validation | None
    free: tuple[int, ...]
    steps: tuple[float, ...]
    numeric: NumericSolver

    @property
    def complete(self) -> bool:
        """Whether all solutions are found; with free joints, all solutions at each sample."""
        return self.closed is not None

    def describe(self) -> str:
        """Return a few lines on the solution method, its reason and its accuracy."""
        if self.closed is None or self.certificate is None:
            return (
                f"numeric: no closed form fits this arm of {self.chain.dof} joints for {self.task.value}\n"
                f"damped least squares from up to {self.numeric.starts} starts; the list of solutions is not complete"
            )
        family, proof = self.closed.family, self.certificate
        lines = [
            f"closed form for {self.task.value}: {family.name}, since {family.why}",
            f"up to {len(self.closed.branch_names)} solutions, by {family.equations}",
            f"certificate: {proof.found} of {proof.configurations} random configurations found, "
            f"worst error {proof.error:.1e}, {proof.solutions:.1f} solutions on average",
        ]
        if isinstance(self.closed, ReducedForm):
            lines.insert(1, f"by reduction: {self.closed.how}")
        for joint, step in zip(self.free, self._affordable_steps(), strict=True):
            unit = "m" if self.chain.prismatic[joint] else "rad"
            lines.append(f"joint {joint + 1} is free, sampled every {step:g} {unit}; complete for each of its values")
        return "\n".join(lines)

    def free_samples(self, start: Floats | None = None) -> Floats:
        """Return samples of the free joints, shape (K, k), from a start or from 0 outwards."""
        return redundancy.samples(self.chain, self.free, self._affordable_steps(), start)

    def _affordable_steps(self) -> Sequence[float]:
        return redundancy.affordable(self.chain, self.free, self.steps)

    def solve(self, goals: ArrayLike, *, free: Floats | None = None, limits: bool = True) -> Solutions:
        """Return all solutions of many goals, without their equivalents by whole turns.

        Args:
            goals: Poses (N, 4, 4), or other goals of the task, with N as first axis.
            free: Values of the free joints, shape (K, k), all tried for every goal; by default their samples.
            limits: Whether only solutions within the limits are valid; else angles are in [-pi, pi].

        Returns:
            The solutions; B is K times the number of branches, or for a numeric search the largest number of solutions.

        Raises:
            ValueError: goals have a wrong shape, are not finite, or are not rigid transforms.
        """
        poses = goal_poses(self.chain, self.task, goals)
        if self.closed is None:
            return self._search_all(poses)
        count, tries = len(poses), 1
        if self.free:
            values = self.free_samples() if free is None else np.asarray(free, dtype=float).reshape(-1, len(self.free))
            tries = len(values)
            poses, values = np.repeat(poses, tries, axis=0), np.tile(values, (count, 1))
            solutions = _solve_alike(self.closed, poses, values, limits=limits)
        else:
            solutions = _solve_alike(self.closed, poses, None, limits=limits)
        shape = (count, -1) if count else (0, len(self.closed.branch_names) * tries)
        rows, valid = solutions.values.reshape(*shape, self.chain.dof), solutions.valid.reshape(shape)
        if limits:
            rows, inside = nearest_turns(self.chain, rows)
            valid = valid & inside
        merged = np.logical_or.reduce(solutions.merged.reshape(count, tries), axis=1)
        return Solutions(rows, valid, merged, solutions.errors.reshape(shape))

    def _search_all(self, poses: Floats) -> Solutions:
        rows = [self.numeric.solve_all(pose) for pose in poses]
        most = max(map(len, rows), default=0)
        values, valid = np.zeros((len(poses), most, self.chain.dof)), np.zeros((len(poses), most), dtype=bool)
        for index, row in enumerate(rows):
            values[index, : len(row)], valid[index, : len(row)] = row, True
        return Solutions(values, valid, np.zeros(len(poses), dtype=bool), np.zeros(valid.shape))

    def solve_one(self, goal: ArrayLike, *, free: Floats | None = None, limits: bool = True) -> Floats:
        """Return all solutions of a goal and their equivalents by whole turns within the limits, shape (K, n).

        In singular configurations, samples of the infinitely many solutions are returned. The arguments are those of
        ``solve``, for one goal. Without limits, every solution is returned once.
        """
        pose = goal_poses(self.chain, self.task, goal)
        if self.closed is None:
            rows = self.numeric.solve_all(pose)
            return all_turns(self.chain, rows) if limits else rows
        given = free is not None or not self.free
        samples = self.free_samples()
        if free is not None and self.free:
            samples = np.asarray(free, dtype=float).reshape(-1, len(self.free))
        solutions = self.at(pose, samples, limits=False)
        rows = solutions.rows[0]
        rows = self.spread(rows) if solutions.merged.any() else rows
        kept = all_turns(self.chain, rows) if limits else rows
        if given or len(kept):
            return kept
        rows = next(self.between(pose, samples, solutions, limits=limits), rows)
        return all_turns(self.chain, rows) if limits else rows

    def at(self, pose: Floats, free: Floats, *, limits: bool = True) -> Solutions:
        """Return the closed-form solutions of one pose (4, 4) for free joint values, shape (K, k)."""
        assert self.closed is not None
        return self.closed.solve(np.repeat(pose[None], len(free), axis=0), free, limits=limits)

    def between(
        self, pose: Floats, samples: Floats, solutions: Solutions, seed: Floats | None = None, *, limits: bool = True
    ) -> Iterator[Floats]:
        """Yield all solutions for free joint values between their samples, each of shape (K, n).

        Args:
            pose: The pose (4, 4).
            samples: The samples, shape (K, k).
            solutions: The result of ``at`` for the samples.
            seed: Configuration whose joint values are also tried for singular solutions, shape (n,); see ``spread``.
            limits: Whether to enforce limits; equivalents by whole turns are left to the caller.
        """
        for row, here in between_samples(self, pose, samples, solutions):
            more = here if here is not None and limits else self.at(pose, row[None, list(self.free)], limits=limits)
            others = self.spread(more.of(0), seed) if more.merged[0] else more.of(0)
            yield np.vstack([row, others[self.chain.differences(others, row) > DISTINCT]])

    def spread(self, rows: Floats, at: Floats | None = None) -> Floats:
        """Return solutions, with equivalent ones added if two joints of a solution rotate about one line.

        If the configuration ``at`` is given, equivalents with its values of these joints are added, too.
        """
        if self.task is not Task.TRANSFORM or not len(rows):
            return rows
        extra = [redundancy.spread(self.chain, row, at) for row in redundancy.singular_rows(self.chain, rows)]
        return np.vstack([rows, *extra]) if extra else rows

    def nearest(self, goal: ArrayLike, seed: Floats, *, weights: Floats | None = None) -> Floats | None:
        """Return the solution within the limits nearest to the configuration ``seed``.

        Free joints take precedence: the search ends at the nearest free joint values with a solution. In singular
        configurations, a closed form returns some of infinitely many solutions; there a descent from the configuration
        adds one. If no sample has a solution, values between the samples are tried, then a short numeric search.

        Args:
            goal: A pose (4, 4), or another goal of the task.
            seed: The configuration, shape (n,).
            weights: Weight of each joint in distances, shape (n,); by default equal.

        Returns:
            Joint values, shape (n,), or None.

        Raises:
            ValueError: the goal has a wrong shape, is not finite, or is not a rigid transform.
        """
        pose = goal_poses(self.chain, self.task, goal)
        if self.closed is None:
            return self.numeric.solve(pose, seed)
        if not self.free:
            solutions = self.closed.solve(pose[None], limits=True)
            more = self.descent(pose, seed) if solutions.merged[0] or not solutions.valid.any() else None
            return self._best(solutions, 0, seed, weights, more)
        values, parts = self.free_samples(seed[list(self.free)]), list[Solutions]()
        for part in np.split(values, range(FIRST, len(values), NEXT)):
            solutions = self.at(pose, part)
            inside = nearest_turns(self.chain, solutions.values, seed)[1] | solutions.merged[:, None]
            for index in np.nonzero((inside & solutions.valid).any(axis=1))[0]:
                best = self._best(solutions, int(index), seed, weights)
                if best is not None:
                    return best
            parts.append(solutions)
        rows = all_turns(self.chain, next(self.between(pose, values, Solutions.joined(parts), seed), seed[None][:0]))
        if len(rows):
            return rows[np.argmin(distances(self.chain, rows, seed, weights))]
        return self.numeric.solve(pose, seed, starts=_STARTS)

    def nearest_reachable(self, goal: ArrayLike, seed: Floats | None = None) -> Reachable:
        """Return the configuration within the limits whose tool is nearest to a goal.

        The measure is the norm of the distance, divided by the reach, and the angle [rad]. Descents from a few starts
        find a local minimum.

        Args:
            goal: A pose (4, 4), or another goal of the task.
            seed: An additional start, shape (n,).

        Raises:
            ValueError: the goal has a wrong shape, is not finite, or is not a rigid transform.

        Example:
            >>> near = solver.nearest_reachable(T_base_tool)
            >>> print(f"{near.distance:.3f} m and {near.angle:.3f} rad off")
        """
        pose = goal_poses(self.chain, self.task, goal)
        starts = [] if seed is None else [seed]
        if self.closed is not None:
            samples = self.free_samples()
            reached = self.at(pose, samples[:: max(1, len(samples) // _MOST_SAMPLES)])
            starts += closest(self.chain, reached, _NEAREST_STARTS)
        starts += [self.numeric.start(number) for number in range(_NEAREST_STARTS - len(starts) + 1)]
        reached = (self.numeric.nearest(pose, start) for start in starts)
        best = min(reached, key=lambda descent: round(descent.error, 9))  # the first of those equal up to rounding
        distance, angle = self.numeric.shortfall(pose, best.values)
        values = nearest_turns(self.chain, best.values, 0.0 if seed is None else seed)[0]
        return Reachable(values, self.chain.forward(values), distance, angle)

    def descent(self, pose: Floats, seed: Floats) -> Floats:
        """Return the solution found by descent from a configuration, shape (1, n), or none, shape (0, n)."""
        reached = self.numeric.descend(pose, seed)
        return reached.values[None][: int(reached.error < ACCURATE)]

    def _best(
        self, solutions: Solutions, index: int, seed: Floats, weights: Floats | None, more: Floats | None = None
    ) -> Floats | None:
        """Return the solution of pose ``index`` nearest to ``seed`` within the limits, or None.

        ``more`` are further candidates, shape (K, n).
        """
        rows = solutions.of(index)
        rows = self.spread(rows, seed) if solutions.merged[index] else rows
        rows = rows if more is None else np.vstack([rows, more])
        moved, inside = nearest_turns(self.chain, rows, seed)
        moved = moved[inside]
        return moved[np.argmin(distances(self.chain, moved, seed, weights))] if len(moved) else None


def _solve_alike(closed: ClosedForm | ReducedForm, poses: Floats, values: Floats | None, *, limits: bool) -> Solutions:
    """Solve poses; a single pose is passed twice, since BLAS rounds a batch of one differently from larger ones."""
    if len(poses) != 1:
        return closed.solve(poses, values, limits=limits)
    both = closed.solve(
        np.repeat(poses, 2, axis=0), None if values is None else np.repeat(values, 2, axis=0), limits=limits
    )
    return Solutions(both.values[:1], both.valid[:1], both.merged[:1], both.errors[:1])


def make_solver(
    chain: Chain,
    task: Task = Task.TRANSFORM,
    *,
    free: Sequence[int] | None = None,
    steps: Sequence[float] | None = None,
) -> ArmSolutions:
    """Make the solver of an arm: the first family that passes validation, else a numeric search.

    Arms with mimic joints are always solved numerically.

    Args:
        chain: The arm.
        task: The constrained components of the tool pose.
        free: Joints to sample; by default the redundant ones, in the order of ``redundancy.choices``.
        steps: A step for each free joint [rad or m]; by default 0.1 rad and a hundredth of the reach.

    Raises:
        ValueError: a free joint that the arm does not have, or a step that is not above 0.
    """
    if isinstance(chain, FollowingChain):
        return ArmSolutions(chain, task, None, None, (), (), NumericSolver(chain, task))
    chosen = list(redundancy.choices(chain, task))[:_TRIED] if free is None else [tuple(sorted(free))]
    for joints in chosen:
        if any(not 0 <= joint < chain.dof for joint in joints):
            raise ValueError(f"free joints {joints}: the arm has joints 0 to {chain.dof - 1}")
    numeric = NumericSolver(chain, task)
    for general, joints in itertools.product((False, True), chosen):
        derived = derive_reduced(chain, task, joints, general=general) or derive(chain, task, joints, general=general)
        if derived is not None:
            sizes = [SLIDE_STEP * chain.reach if chain.prismatic[joint] else ANGLE_STEP for joint in joints]
            given = tuple(sizes if steps is None else steps)
            if len(given) != len(joints) or not all(step > 0 for step in given):
                raise ValueError(f"steps {given} for free joints {joints}: expected one above 0 for each")
            return ArmSolutions(chain, task, *derived, joints, given, numeric)
    return ArmSolutions(chain, task, None, None, (), (), numeric)
