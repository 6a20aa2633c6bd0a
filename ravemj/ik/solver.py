"""One way to ask for inverse kinematics, whatever answers: a closed form, one with sampled joints, or a search.

Poses are those of the tool in the base. Limits, whole turns, free joints and singular configurations are treated as
OpenRAVE treats them: every solution within the limits is one, further turns included; a free joint is sampled from 0 or
from the present value outwards; where two joints turn about one line, the first is shown at every pi/8.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ravemj.ik import redundancy
from ravemj.ik.chain import Chain
from ravemj.ik.closed import ClosedForm, Solutions
from ravemj.ik.derive import Certificate, derive
from ravemj.ik.limits import all_turns, distances, nearest_turns
from ravemj.ik.numeric import ACCURATE, NumericSolver
from ravemj.ik.reductions import ReducedForm, derive_reduced
from ravemj.ik.redundancy import ANGLE_STEP, SLIDE_STEP
from ravemj.ik.tasks import Task, goal_poses
from ravemj.ik.vectors import Floats

_TRIED = 12
_STARTS = 24
"""Starts of a search for what is between the samples of a free joint."""
FIRST, NEXT = 12, 96
"""So many samples of free joints are tried at once; those near the present values mostly are enough."""


@dataclass(frozen=True, eq=False)
class ArmSolutions:
    """Solves one kind of goal for one arm. Made by ``make_solver``.

    Attributes:
        chain: The arm.
        task: What is asked for.
        closed: The solver in closed form, or None where no family fits.
        certificate: What it did with random configurations.
        free: Joints that are sampled.
        steps: A step for each of them [rad or m]; several free joints are sampled more coarsely where need be.
        numeric: The search, which also answers where there is no closed form.
    """

    chain: Chain
    task: Task
    closed: ClosedForm | ReducedForm | None
    certificate: Certificate | None
    free: tuple[int, ...]
    steps: tuple[float, ...]
    numeric: NumericSolver

    @property
    def complete(self) -> bool:
        """Whether all solutions are found; with free joints, all for each of their samples."""
        return self.closed is not None

    def describe(self) -> str:
        """Return in a few lines how the arm is solved, why, and how good that is."""
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
        """Return values of the free joints, shape (K, k), from a start or from 0 outwards."""
        return redundancy.samples(self.chain, self.free, self._affordable_steps(), start)

    def _affordable_steps(self) -> Sequence[float]:
        return redundancy.affordable(self.chain, self.free, self.steps)

    def solve(self, goals: ArrayLike, *, free: Floats | None = None, limits: bool = True) -> Solutions:
        """Return all solutions of many goals, one turn of each.

        Args:
            goals: Poses (N, 4, 4), or what else the task asks for, with N in front.
            free: Values of the free joints, shape (K, k), which are all tried for every goal; None: their samples.
            limits: Whether only solutions within the limits are valid; else angles are in [-pi, pi].

        Returns:
            Solutions with K times as many branches as the family has; of a search with as many as the richest goal.

        Raises:
            ValueError: goals of a wrong shape, not finite, or no rigid transforms.
        """
        poses = goal_poses(self.chain, self.task, goals)
        if self.closed is None:
            return self._search_all(poses)
        count, tries = len(poses), 1
        if self.free:
            values = self.free_samples() if free is None else np.asarray(free, dtype=float).reshape(-1, len(self.free))
            tries = len(values)
            poses, values = np.repeat(poses, tries, axis=0), np.tile(values, (count, 1))
            found = self.closed.solve(poses, values, limits=limits)
        else:
            found = self.closed.solve(poses, limits=limits)
        shape = (count, -1) if count else (0, len(self.closed.branch_names) * tries)
        rows, valid = found.values.reshape(*shape, self.chain.dof), found.valid.reshape(shape)
        if limits:
            rows, inside = nearest_turns(self.chain, rows)
            valid = valid & inside
        return Solutions(rows, valid, np.logical_or.reduce(found.merged.reshape(count, tries), axis=1))

    def _search_all(self, poses: Floats) -> Solutions:
        rows = [self.numeric.solve_all(pose) for pose in poses]
        most = max(map(len, rows), default=0)
        values, valid = np.zeros((len(poses), most, self.chain.dof)), np.zeros((len(poses), most), dtype=bool)
        for index, found in enumerate(rows):
            values[index, : len(found)], valid[index, : len(found)] = found, True
        return Solutions(values, valid, np.zeros(len(poses), dtype=bool))

    def solve_one(self, goal: ArrayLike, *, free: Floats | None = None, limits: bool = True) -> Floats:
        """Return all solutions of one goal, shape (K, n), with all turns within the limits, and singular ones spread.

        The arguments are those of ``solve``, for one goal. Without limits, every solution comes once.
        """
        found = self.solve(np.asarray(goal, dtype=float)[None], free=free, limits=False)
        rows = self.spread(found.of(0)) if found.merged[0] else found.of(0)
        return all_turns(self.chain, rows) if limits else rows

    def spread(self, rows: Floats, at: Floats | None = None) -> Floats:
        """Add to solutions in which two joints turn about one line other angles of these."""
        if self.task is not Task.TRANSFORM or not len(rows):
            return rows
        extra = [redundancy.spread(self.chain, row, at) for row in redundancy.singular_rows(self.chain, rows)]
        return np.vstack([rows, *extra]) if extra else rows

    def nearest(self, goal: ArrayLike, seed: Floats, *, weights: Floats | None = None) -> Floats | None:
        """Return the solution within the limits that is nearest to a configuration.

        Free joints come first: the value nearest to theirs in the configuration with any solution ends the search. In
        singular configurations a closed form shows some of infinitely many solutions; there one descent from the
        present configuration adds what it finds. Where no sample has a solution, a short search is the last word.

        Args:
            goal: A pose (4, 4), or what else the task asks for.
            seed: The configuration, shape (n,).
            weights: What a radian or a metre of each joint counts, shape (n,); all the same if None.

        Returns:
            Joint values, shape (n,), or None.

        Raises:
            ValueError: a goal of a wrong shape, not finite, or no rigid transform.
        """
        pose = goal_poses(self.chain, self.task, goal)
        if self.closed is None:
            return self.numeric.solve(pose, seed)
        if not self.free:
            solutions = self.closed.solve(pose[None], limits=True)
            more = self.descent(pose, seed) if solutions.merged[0] or not solutions.valid.any() else None
            return self._best(solutions, 0, seed, weights, more)
        values = self.free_samples(seed[list(self.free)])
        for part in np.split(values, range(FIRST, len(values), NEXT)):
            solutions = self.closed.solve(np.repeat(pose[None], len(part), axis=0), part, limits=True)
            inside = nearest_turns(self.chain, solutions.values, seed)[1] | solutions.merged[:, None]
            for index in np.nonzero((inside & solutions.valid).any(axis=1))[0]:
                best = self._best(solutions, int(index), seed, weights)
                if best is not None:
                    return best
        return self.numeric.solve(pose, seed, starts=_STARTS)

    def descent(self, pose: Floats, seed: Floats) -> Floats:
        """Return the solution below a configuration, shape (1, n), or none, shape (0, n)."""
        found = self.numeric.descend(pose, seed)
        return found.values[None][: int(found.error < ACCURATE)]

    def _best(
        self, solutions: Solutions, index: int, seed: Floats, weights: Floats | None, more: Floats | None = None
    ) -> Floats | None:
        """Return the solution for one pose, or of some more, that is nearest and within the limits."""
        rows = solutions.of(index)
        rows = self.spread(rows, seed) if solutions.merged[index] else rows
        rows = rows if more is None else np.vstack([rows, more])
        moved, inside = nearest_turns(self.chain, rows, seed)
        moved = moved[inside]
        return moved[np.argmin(distances(self.chain, moved, seed, weights))] if len(moved) else None


def make_solver(
    chain: Chain,
    task: Task = Task.TRANSFORM,
    *,
    free: Sequence[int] | None = None,
    steps: Sequence[float] | None = None,
) -> ArmSolutions:
    """Find out how an arm is solved: by the first family that proves itself, else by a search.

    Args:
        chain: The arm.
        task: What is asked for.
        free: Joints to sample; None: as few as are too many, in the order of ``redundancy.choices``.
        steps: A step for each free joint [rad or m]; 0.1 rad and a hundredth of the reach if None.

    Raises:
        ValueError: a free joint that the arm does not have, or a step that is not above 0.
    """
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
