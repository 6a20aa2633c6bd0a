"""Search for IK solutions of an arm: candidates in order, collision checks, reasons for rejection."""

from collections.abc import Generator, Iterable, Iterator
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.blocks import block, restoring
from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats
from ravemj.engine.collision import arms
from ravemj.engine.collision.findings import Checker, Findings
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState
from ravemj.model.scene import Manipulator

# Importing ``ik`` takes as long as importing the rest, and most scripts do without it.
# ruff: noqa: PLC0415

if TYPE_CHECKING:
    from ravemj.ik import ArmSolutions


class Reason(Enum):
    """Reason for rejecting joint values, or for not finding any."""

    OUT_OF_REACH = "out of reach"
    LIMITS = "beyond the limits"
    SELF_COLLISION = "collision with itself"
    COLLISION = "collision with another body"
    END_COLLISION = "collision of the links beyond the arm, which all joint values for a pose have"


class Checks(NamedTuple):
    """Tests of IK solutions.

    Attributes:
        others: Whether to check collisions with other bodies.
        itself: Whether to check self-collisions.
        limits: Whether to enforce joint limits. Without them, angles are in [-pi, pi], and solutions that differ by
            whole turns count as one.
        end_and_others: Whether to check the links beyond the arm (end effector, gripper) against other bodies, too.
        end_and_rest: Whether to check the links beyond the arm against links not moved by the arm.
    """

    others: bool = False
    itself: bool = True
    limits: bool = True
    end_and_others: bool = True
    end_and_rest: bool = True


class ArmSearch:
    """Search for IK solutions of one goal. It moves the robot, and restores its configuration.

    Subclasses may override ``accepts`` and ``solution`` to call user callbacks, and ``reject`` to record rejections.

    Args:
        body: The robot.
        arm: Its manipulator.
        solver: The solver of the arm.
        goal: A pose in the base of the arm (4, 4), or another goal of the solver's task.
        checks: The tests of joint values.
        checker: The collision checker.
        free: The values of the free joints, shape (k,); None for samples.

    Attributes:
        asks_users: Whether to call ``accepts``.
        explains: Whether ``reject`` gets the colliding geometries.
        ended: Whether the search must stop.
    """

    def __init__(
        self,
        body: BodyState,
        arm: Manipulator,
        solver: "ArmSolutions",
        goal: Floats,
        checks: Checks,
        checker: Checker,
        free: Floats | None = None,
    ) -> None:
        self.body, self.arm, self.solver, self.checks = body, arm, solver, checks
        self._goal, self._checker, self._free = goal, checker, free
        self._end_is_free = False
        self.asks_users = self.explains = self.ended = False

    # Functions of users

    def accepts(self, row: Floats, *, before_collisions: bool) -> bool:
        """Return whether user callbacks accept joint values. It is called before and after the collision checks."""
        del row, before_collisions
        return True

    def solution(self, row: Floats) -> Floats:
        """Return accepted joint values, or replacements given by user callbacks."""
        return row

    def reject(self, reason: Reason, row: Floats, findings: Findings | None) -> None:
        """Record a rejection; ``row`` is empty if it concerns the goal instead of joint values."""

    @block
    def moving(self) -> Generator[None]:
        """Hold the lock; on leaving, restore the configuration of the robot."""
        with self.body.simulation.lock:
            saved = self.body.configuration()
            with restoring(lambda: self.body.restore(saved)):
                yield

    # Candidates

    def nearest(self, seed: Floats | None = None) -> Floats | None:
        """Return the first accepted joint values in ``nearest_first`` order from ``seed``, shape (n,), or None."""
        start, limits = self.present() if seed is None else seed, self.checks.limits
        if not self._is_tested and limits and self._free is None:
            return self.solver.nearest(self._goal, start, weights=self.weights)
        from ravemj.ik.candidates import nearest_first

        rows = nearest_first(
            self.solver,
            self._goal,
            start,
            weights=self.weights,
            free=self._free,
            limits=limits,
            fine=not self.asks_users,
        )
        with self.moving():
            return next(self.good(rows), None)

    def near(self, seed: Floats, largest: float) -> Floats | None:
        """Return the accepted joint values nearest to ``seed`` with no joint step above ``largest``, or None."""
        rows = self.rows()
        away = np.abs(rows - seed).max(axis=1, initial=0.0)
        order = [number for number in np.argsort(away, kind="stable").tolist() if away[number] <= largest]
        with self.moving():
            return next(self.good(rows[order]), None)

    def every(self) -> list[Floats]:
        """Return all accepted joint values, each of shape (n,); none if a callback ends the search."""
        with self.moving():
            solutions = list(self.all_good())
        return [] if self.ended else solutions

    def all_good(self) -> Iterator[Floats]:
        """Yield all accepted joint values, each of shape (n,). Use it within ``moving``.

        Free joints are tried between their samples only if no sample is accepted.
        """
        from ravemj.ik.candidates import everything

        accepted = False
        limits, fine = self.checks.limits, not self.asks_users
        for rows in everything(self.solver, self._goal, free=self._free, limits=limits, fine=fine):
            for row in self.good(rows):
                accepted = True
                yield row
            if accepted or self.ended:
                return

    def rows(self) -> Floats:
        """Return all joint values that reach the goal, accepted or not, shape (K, n)."""
        free = None if self._free is None else self._free[None]
        return self.solver.solve_one(self._goal, free=free, limits=self.checks.limits)

    def present(self) -> Floats:
        """Return the joint values of the arm, shape (n,)."""
        return self.body.kinematics.values()[list(self.arm.arm_dofs)]

    @cached_property
    def weights(self) -> Floats:
        """The weights of the joints in distances, shape (n,)."""
        axes = self.body.scene.dof_axes
        return np.array([axes[dof].weight for dof in self.arm.arm_dofs])

    # Tests

    @property
    def _is_tested(self) -> bool:
        return self.asks_users or self.checks.others or self.checks.itself

    def good(self, rows: Iterable[Floats]) -> Iterator[Floats]:
        """Yield the joint values, each of shape (n,), that pass the tests. Use it within ``moving``."""
        for row in rows:
            if not self._is_tested or self._is_good(row):
                yield self.solution(row)
            if self.ended:
                return

    def _is_good(self, row: Floats) -> bool:
        values = self.body.kinematics.values()
        values[list(self.arm.arm_dofs)] = row
        self.body.set_values(values)
        asks = self.asks_users
        if (asks and not self.accepts(row, before_collisions=True)) or self._collides(row):
            return False
        return not asks or self.accepts(row, before_collisions=False)

    def _collides(self, row: Floats) -> bool:
        """Return whether the robot collides at its present joint values, according to ``self.checks``."""
        if not (self.checks.others or self.checks.itself):
            return False
        checks, body, arm, world = self.checks, self.body, self.arm, self._checker.world()
        with_end = checks.end_and_others
        if checks.others and with_end and self._goal.ndim == 2:
            # All solutions of a pose have the links beyond the arm at the same pose.
            pairs = arms.end_and_others(world, body, arm)
            if not self._end_is_free and self._hits(world, pairs, row, Reason.END_COLLISION):
                self.ended = True
                return True
            self._end_is_free, with_end = True, False
        if checks.itself:
            pairs = arms.arm_and_rest(world, body, arm, without_end=not checks.end_and_rest)
            if self._hits(world, pairs, row, Reason.SELF_COLLISION):
                return True
        if not checks.others:
            return False
        pairs = arms.arm_and_others(world, body, arm, without_end=not with_end)
        return self._hits(world, pairs, row, Reason.COLLISION)

    def _hits(self, world: CollisionWorld, pairs: Pairs, row: Floats, reason: Reason) -> bool:
        """Return whether one of the pairs of geoms collides; if so, reject the solution ``row``."""
        findings = self._checker.find(world, pairs) if self.explains else None
        hit = bool(findings.collisions) if findings else self._checker.collides(world, pairs)
        if hit:
            self.reject(reason, row, findings)
        return hit

    def shortfall(self) -> str:
        """Describe how far the goal is out of reach; empty if joint values within the limits reach it."""
        return "" if len(self.rows()) else str(self.solver.nearest_reachable(self._goal, self.present()))

    def explain(self) -> None:
        """Reject the goal itself: it is unreachable, or its solutions exceed enforced limits."""
        from ravemj.ik.candidates import shortfall

        unreached, limited = shortfall(self.solver, self._goal, self._free)
        if unreached:
            self.reject(Reason.OUT_OF_REACH, np.zeros(0), None)
        if limited and self.checks.limits:
            self.reject(Reason.LIMITS, np.zeros(0), None)
