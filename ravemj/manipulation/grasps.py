"""Reachable grasps of a grasp table: preshape of the gripper, linear approach, destinations of the target."""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ravemj.core.blocks import block, restoring
from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.findings import Checker
from ravemj.engine.collision.hand import hand_tests
from ravemj.engine.collision.queries import body_and_others
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import SavedConfiguration
from ravemj.errors import ArgumentError
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.manipulation.grasping.closing import Approach, Steps, close
from ravemj.manipulation.grasping.hands import hand_of, target_of
from ravemj.manipulation.motions import follow_goals
from ravemj.manipulation.options import GraspMotion
from ravemj.model.scene import Manipulator
from ravemj.planning.space import Space

_LINE_STEP = 0.01
"""Spacing of tested poses on the straight approach to a grasp [m]."""

_IN_LIMITS = 1e-3
"""Amount by which values of a preshape may exceed the joint limits [rad or m], as in OpenRAVE."""

_BACK = 1e-3  # m, step of a hand back out of the target, as in OpenRAVE
_MOST_BACK = 300  # steps

_POSES = ("grasptrans_nocol", "igrasptrans")
"""Names of grasp table columns with the pose of the tool; the first has precedence."""


class GraspTable(NamedTuple):
    """A table of grasps.

    Attributes:
        rows: One grasp in each row, shape (n, m).
        columns: The first column of each property of a grasp, by OpenRAVE's names: ``igrasptrans`` (``T_target_tool``,
            12 numbers by columns) or ``grasptrans_nocol``, which has precedence; ``igraspdir`` (the approach direction
            of the hand in the target frame), ``imanipulatordirection`` (the same in the tool frame), ``igrasppreshape``
            (the values of the gripper). If a row has no pose, or zeros, the grasp is simulated, from ``igraspdir``,
            ``igrasppos``, ``igrasproll``, ``igraspstandoff`` and ``ichuckingdirection``.
    """

    rows: Floats
    columns: Mapping[str, int]

    def numbers(self, grasp: int, name: str, count: int) -> Floats | None:
        """Return the values of a grasp's property, or None if the table does not have it.

        Raises:
            ArgumentError: the table has too few columns, or a number is not finite.
        """
        start, row = self.columns.get(name, -1), self.rows[grasp]
        if start < 0:
            return None
        if start + count > len(row):
            raise ArgumentError(f"graspindices: '{name}' is {start}, and grasps have {len(row)} numbers")
        numbers = row[start : start + count]
        if not np.isfinite(numbers).all():
            raise ArgumentError(f"grasps: '{name}' of grasp {grasp} is {numbers.tolist()}, and should be finite")
        return numbers

    def check(self) -> None:
        """Check that the table has grasp poses.

        Raises:
            ArgumentError: the table has no grasp poses.
        """
        if all(self.columns.get(name, -1) < 0 for name in (*_POSES, "igraspdir")):
            raise ArgumentError(
                "graspindices: should have 'igrasptrans' or 'grasptrans_nocol', the pose of the tool, or 'igraspdir', "
                "the direction in which the hand flies to the target"
            )

    def pose(self, grasp: int) -> Floats | None:
        """Return ``T_target_tool``, shape (4, 4); None if the row has none."""
        given = (self.numbers(grasp, name, 12) for name in _POSES)
        numbers = next((numbers for numbers in given if numbers is not None and numbers.any()), None)
        return None if numbers is None else np.vstack([numbers.reshape(4, 3).T, [0.0, 0.0, 0.0, 1.0]])

    def approach(self, grasp: int, tool_direction: Sequence[float]) -> Approach | None:
        """Return the approach of the hand to the target in a grasp; None if the table has no direction for it.

        Args:
            grasp: Index of the row in the table.
            tool_direction: The manipulator's direction, for rows without one.
        """

        def part(name: str, count: int) -> Floats:
            numbers = self.numbers(grasp, name, count)
            return np.zeros(count) if numbers is None else numbers

        direction, in_tool = part("igraspdir", 3), part("imanipulatordirection", 3)
        if not direction.any():
            return None
        return Approach(
            direction=_unit(direction),
            tool_direction=_unit(in_tool if in_tool.any() else np.array(tool_direction, float)),
            position=part("igrasppos", 3),
            roll=part("igrasproll", 1).item(),
            standoff=part("igraspstandoff", 1).item(),
            avoid_contact=True,
        )


class GraspingArm(NamedTuple):
    """Grasping arm.

    Attributes:
        body: The robot.
        arm: Its manipulator.
        space: The configuration space of the arm.
        checker: Returns the collision checker.
        search: Returns the search for collision-free IK solutions of ``T_world_tool``.
    """

    body: BodyState
    arm: Manipulator
    space: Space
    checker: Callable[[], Checker]
    search: Callable[[Floats], ArmSearch]


@dataclass
class Grasp:
    """Reachable grasp.

    Attributes:
        number: Its index in the table.
        preshape: Joint values of the gripper [rad or m].
        rows: Alternative joint values of the arm at the start of the approach, on which the tool moves straight.
        T_world_goals: Poses of the tool at the destinations of the target.
    """

    number: int
    preshape: Floats
    rows: list[Floats] = field(default_factory=lambda: [])
    T_world_goals: list[Floats] = field(default_factory=lambda: [])


class GraspSearch:
    """Search for the reachable grasps of a table. It moves the robot and the target, and restores both.

    Args:
        hand: The arm.
        target: The body to grasp.
        table: The grasps.
        places: ``T_world_target`` of destinations of the target; the arm has to reach one of them with a grasp.
        options: The options of the search.

    Raises:
        ArgumentError: the table has no grasp poses.
    """

    def __init__(
        self, hand: GraspingArm, target: BodyState, table: GraspTable, places: Sequence[Floats], options: GraspMotion
    ) -> None:
        table.check()
        self._hand, self._target, self._table, self._places, self._options = hand, target, table, places, options
        self._random = np.random.default_rng(0)

    def all(self) -> Iterator[Grasp]:
        """Yield the reachable grasps. Between two of them, the robot and the target are in their original state."""
        count = len(self._table.rows)
        for number in self._random.permutation(count).tolist() if self._options.randomgrasps else range(count):
            with self._kept():
                grasp = self._grasp(number)
            if grasp is not None:
                yield grasp

    def _grasp(self, number: int) -> Grasp | None:
        """Return the grasp of a table row if it is reachable, else None. Robot and target are not restored."""
        preshape = self._preshaped(number)
        if preshape is None:
            return None
        T_target_tool = self._pose(number)
        if T_target_tool is None:
            return None
        T_world_tool = self._target.link_transform(0) @ T_target_tool
        grasp = Grasp(number, preshape, self._approaches(T_world_tool, self._direction(number, T_world_tool)))
        if grasp.rows and self._places:
            grasp.T_world_goals = self._goals(T_target_tool)
        return grasp if grasp.rows and (grasp.T_world_goals or not self._places) else None

    def _pose(self, number: int) -> Floats | None:
        """Return ``T_target_tool`` of a table row, simulated if it has none; None if the simulation fails.

        After the simulation, the open hand is moved back until it does not touch the target.
        """
        given = self._table.pose(number)
        approach = self._table.approach(number, self._hand.arm.direction) if given is None else None
        if approach is None:
            return given
        body, arm = self._hand.body, self._hand.arm
        closing = self._table.numbers(number, "ichuckingdirection", len(arm.gripper_dofs))
        signs = arm.chucking_direction if closing is None or not closing.any() else closing.tolist()
        flying, target = hand_of(body, arm, dict(zip(arm.gripper_dofs, signs, strict=True))), target_of(self._target)
        steps = Steps(fine=self._options.graspfinestep, per_radian=self._options.grasptranslationstepmult)
        with hand_tests(self._hand.checker().world(), body, self._target) as tests:
            closed = close(flying, target, approach, tests, steps)
            if closed.reason is not None:
                return None
            T_world_base = closed.T_world_base.copy()
            for _ in range(_MOST_BACK):
                if not tests(flying.links, T_world_base, flying.values, "target"):
                    break
                T_world_base[:3, 3] -= _BACK * target.T_world_target[:3, :3] @ approach.direction
        return inverse(target.T_world_target) @ T_world_base @ flying.T_base_tool

    def _preshaped(self, number: int) -> Floats | None:
        """Move the gripper to the preshape of a table row, and return its values; None if they violate the limits."""
        body, dofs = self._hand.body, list(self._hand.arm.gripper_dofs)
        values = body.kinematics.values()
        if not dofs:
            return values[dofs]
        given = self._table.numbers(number, "igrasppreshape", len(dofs))
        axes = [body.scene.dof_axes[dof] for dof in dofs]
        lower, upper = np.array([(axis.lower, axis.upper) for axis in axes]).T
        preshape = values[dofs] if given is None else given
        if (preshape < lower - _IN_LIMITS).any() or (preshape > upper + _IN_LIMITS).any():
            return None
        values[dofs] = np.clip(preshape, lower, upper)
        body.set_values(values)
        return values[dofs]

    def _direction(self, number: int, T_world_tool: Floats) -> Floats:
        """Return the approach direction of the hand, a unit vector in the world."""
        in_target = self._table.numbers(number, "igraspdir", 3)
        if in_target is not None:
            direction = self._target.link_transform(0)[:3, :3] @ in_target
        else:
            in_tool = self._table.numbers(number, "imanipulatordirection", 3)
            direction = T_world_tool[:3, :3] @ (np.array(self._hand.arm.direction) if in_tool is None else in_tool)
        return _unit(direction)

    def _approaches(self, T_world_tool: Floats, direction: Floats) -> list[Floats]:
        """Return IK solutions at the start of the straight approach from which the arm can follow it to the grasp."""
        start = T_world_tool.copy()
        start[:3, 3] -= self._options.approachoffset * direction
        rows: list[Floats] = []
        for row in self._hand.search(start).every():
            if self._gets_there(row, start, direction):
                rows.append(row)
            if len(rows) == self._options.seedik > 0:
                break
        return rows

    def _gets_there(self, row: Floats, start: Floats, direction: Floats) -> bool:
        offset = self._options.approachoffset
        count = int(np.ceil(offset / _LINE_STEP))

        def search(number: int) -> ArmSearch:
            T_world_goal = start.copy()
            T_world_goal[:3, 3] += direction * (offset * number / count)
            return self._hand.search(T_world_goal)

        with _disabled(self._target):  # the hand may touch the body to grasp
            return len(follow_goals(self._hand.space, row, count, search)) == count + 1

    def _goals(self, T_target_tool: Floats) -> list[Floats]:
        """Return the tool poses, for grasp ``T_target_tool``, at the destinations where the target can be put down."""
        options, goals = self._options, list[Floats]()
        count = len(self._places)
        for place in self._random.permutation(count).tolist() if options.randomdests else range(count):
            T_world_target = self._places[place]
            T_world_tool = T_world_target @ T_target_tool
            if self._is_free(T_world_target) and self._is_reached(T_world_tool):
                goals.append(T_world_tool)
            if len(goals) == options.seeddests > 0:
                break
        return goals

    def _is_free(self, T_world_target: Floats) -> bool:
        """Return whether the target at a pose collides with nothing but the robot."""
        with self._kept(), _disabled(self._hand.body):
            self._target.set_transform(T_world_target)
            checker = self._hand.checker()
            world = checker.world()
            return not checker.collides(world, body_and_others(world, self._target))

    def _is_reached(self, T_world_tool: Floats) -> bool:
        with self._kept(), _disabled(self._target):
            return len(self._hand.search(T_world_tool).every()) > 0

    @block
    def _kept(self) -> Generator[None]:
        """Context manager that acquires the lock, and restores the robot and the target."""
        bodies = self._hand.body, self._target
        with self._hand.body.simulation.lock:
            saved = [(body, body.configuration()) for body in bodies]
            with restoring(lambda: _restore(saved)):
                yield


def _unit(vector: Floats) -> Floats:
    return vector / (np.linalg.norm(vector) or 1.0)


def _restore(saved: Sequence[tuple[BodyState, SavedConfiguration]]) -> None:
    for body, configuration in saved:
        body.restore(configuration)


@block
def _disabled(body: BodyState) -> Generator[None]:
    """Context manager that excludes a body from collision checks, and then restores its enabled links."""
    enabled = body.link_enabled

    def restore() -> None:
        body.link_enabled = enabled

    with restoring(restore):
        body.link_enabled = [False] * len(enabled)
        yield
