"""Regions as starts and goals of planning problems."""

# ruff: noqa: PLC0415 - inverse kinematics is slow to import

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_parameterization import goal_of_tool
from ravemj.geometry_functions.regions import PoseSet
from ravemj.manipulation.refusals import Cause
from ravemj.manipulation.region_errors import at_values, region_error
from ravemj.manipulation.roots import PoseSolutions, RegionRoots, Sampler
from ravemj.planning.projection import PROJECTION_STEPS, Error, project
from ravemj.planning.space import Space
from ravemj.rave.enums import IkFilterOptions
from ravemj.rave.iksolver import IkSolver
from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.path_constraints import TOLERANCE, constrain, moving_frame, of_tool, stacked, tool_frame
from ravemj.rave.planning.values import Hand, Values
from ravemj.rave.region import Region
from ravemj.rave.specification import IkParameterization

_PROJECTED = 0.1
"""Error at which a projection stops, as a fraction of the tolerance, so that rounding does not reject its result."""

_TRIES = 4
"""Number of random configurations to project onto a region if the arm has no IK solver."""

_STEPS = 20
"""Maximum number of steps of a projection onto a region."""

_MOST_ROWS = 16
"""Maximum number of IK solutions that are tested for a pose; arms with ranges of several turns may have hundreds."""

_SAME = 1e-9
"""Tolerance of equal gripper values [rad or m]."""

_FULL_POSE = 6
"""Minimum number of joints of an arm that can reach full poses."""

_Type = IkParameterization.Type
_NO_COLLISIONS = int(IkFilterOptions.IgnoreSelfCollisions)


class MotionSets(NamedTuple):
    """Goal regions and constraints of a motion.

    Attributes:
        goals: Regions, one of which the tool should reach.
        constraints: The constraints along the whole motion, as arguments of ``constrain``.
        holding: The grabbed body to which the regions refer; None for the tool.
    """

    goals: Sequence[Region] = ()
    constraints: Sequence[object] = ()
    holding: KinBody | None = None

    def state(self, values: Values, hand: Callable[[], Hand], probability: float) -> None:
        """Add goals and constraints to a problem of a hand; an iteration samples a goal with ``probability``."""
        for constraint in self.constraints:
            constrain(values, constraint, lambda: hand().manip, TOLERANCE, self.holding)
        if self.goals:
            values.goal_sampler = Sampler(region_roots(values, hand(), self.goals, self.holding), probability)


def region_roots(values: Values, hand: Hand, regions: Sequence[Region], holding: KinBody | None) -> RegionRoots:
    """Return a source of arm configurations with the tool in one of several regions.

    Args:
        values: The problem, in which the arm joints of one active manipulator move, and perhaps those of its gripper.
        hand: This manipulator and its tool.
        regions: The regions of the tool, or of the body that it has grabbed.
        holding: The grabbed body; None for the tool.

    Raises:
        ArgumentError: other joints move, the frame of a region was removed or moves with the arm, or a preshape has
            a wrong number of values, or values of joints that do not move.
    """
    bodies, names = hand.tool.bodies, _names(regions)
    tool = tool_frame(bodies, hand.manip)
    sets = [of_tool(region.at_present(), hand.manip, holding) for region in regions]
    for given_region, poses in zip(regions, sets, strict=True):
        poses.sample(np.random.default_rng(0), 0)  # which needs bounds
        if given_region.frame is not None and moving_frame(bodies, given_region.frame) is not None:
            raise ArgumentError(f"region '{given_region.name}': its frame moves with the arm that should reach it")
    assert tool is not None, "the tool of the arm moves"
    errors = [at_values(bodies, region_error(poses_of_tool, tool, None)) for poses_of_tool in sets]
    solver = _PoseSolver(hand, values.space(), errors, [_at_start(hand, region) for region in regions])
    solve = solver.solve if solver.solves_poses else solver.search
    return RegionRoots(
        sets,
        names,
        solve,
        lambda region, row: _repaired(values, errors[region], row),
        lambda region, pose: solver.shortfall(region, sets[region], pose),
    )


def preshaped_dofs(manip: Manipulator, regions: Sequence[Region]) -> list[int]:
    """Return the gripper DOFs that the preshapes of regions change from their present values.

    Raises:
        ArgumentError: the number of values of a preshape differs from that of the gripper.
    """
    dofs = [int(dof) for dof in manip.GetGripperIndices()]
    present, moved = manip.GetRobot().GetDOFValues()[dofs], set[int]()
    for region in regions:
        if region.preshape is None:
            continue
        if len(region.preshape) != len(dofs):
            joints = f"the gripper of '{manip.GetName()}' has {len(dofs)} joints"
            raise ArgumentError(f"region '{region.name}': its preshape has {len(region.preshape)} values, and {joints}")
        moved |= {
            dof for dof, value, now in zip(dofs, region.preshape, present, strict=True) if abs(value - now) > _SAME
        }
    return [dof for dof in dofs if dof in moved]


def _at_start(hand: Hand, region: Region) -> Floats:
    """Return the present configuration, with the gripper at the preshape of a region; shape (n,)."""
    bodies, manip = hand.tool.bodies, hand.manip
    values, active = bodies.values(), [dof for part in bodies.parts for dof in part.dofs]
    for dof in preshaped_dofs(manip, [region]):
        if dof not in active:
            joint = manip.GetRobot().GetJointFromDOFIndex(dof).GetName()
            raise ArgumentError(f"region '{region.name}': its preshape moves joint '{joint}', which is not active")
    if region.preshape is not None:
        for dof, value in zip(manip.description.gripper_dofs, region.preshape.tolist(), strict=True):
            if dof in active:
                values[active.index(dof)] = value
    return values


def _names(regions: Sequence[Region]) -> list[str]:
    """Return unique names of regions; a region without name, or with that of another, gets its index."""
    given = Counter(region.name for region in regions)
    return [
        one.name if one.name and given[one.name] == 1 else f"{one.name or 'region'} {number}"
        for number, one in enumerate(regions)
    ]


class _PoseSolver:
    """IK for poses in regions: by the arm's solver, or by projecting random configurations."""

    def __init__(self, hand: Hand, space: Space, errors: Sequence[Error], starts: Sequence[Floats]) -> None:
        self._manip, self._space, self._errors, self._starts = hand.manip, space, errors, starts
        self._columns, manip = list(hand.tool.columns), hand.manip
        self._rest = np.setdiff1d(np.arange(hand.tool.dof), self._columns)  # of the gripper
        self._given, self._direction = manip.GetIkSolver(), np.array(manip.description.direction)
        self.solves_poses = self._given is not None or manip.GetArmDOF() >= _FULL_POSE

    def solve(self, region: int, T_world_tool: Floats, random: np.random.Generator) -> PoseSolutions:
        """Return all IK solutions for a pose of a region, including those that differ by full turns.

        Solvers of goal types other than poses leave a part of the pose free; their solutions are projected onto the
        region.
        """
        kind = _Type.Transform6D if self._given is None else self._given.kind
        base = self._manip.GetBase()
        T_base_tool = T_world_tool if base is None else inverse(base.GetTransform()) @ T_world_tool
        goal = T_base_tool if kind == _Type.Transform6D else goal_of_tool(kind, T_base_tool, self._direction)
        if self._given is None:
            solutions, asked = self._manip.ik_solver(kind).solve_one(goal, limits=True), False
        else:
            solutions, asked = self._accepted(self._given, goal)
        if not len(solutions):
            return PoseSolutions(solutions, self._cause(kind, goal, asked=asked))
        rows = np.tile(self._starts[region], (len(solutions), 1))
        near = rows[0].copy()
        rows[:, self._columns], near[self._columns] = solutions, self._manip.GetArmDOFValues()
        rows = _some(rows, near, random)
        if kind == _Type.Transform6D:
            return PoseSolutions(rows, Cause.FILTER)
        return PoseSolutions(self._moved(region, rows, self._space), Cause.REGION)

    def _accepted(self, solver: IkSolver, goal: Floats) -> tuple[Floats, bool]:
        """Return the solutions of a goal that user filters accept, and whether there are filters."""
        asked = IkParameterization()
        if goal.ndim == 1:
            asked.SetValues(goal, solver.kind)
        search = solver.search(goal if goal.ndim == 2 else asked, None, _NO_COLLISIONS)
        return np.array(search.every()).reshape(-1, self._manip.GetArmDOF()), search.asks_users

    def _cause(self, kind: _Type, goal: Floats, *, asked: bool) -> Cause:
        """Return the reason why a goal has no solution; ``asked`` tells whether user filters were called."""
        from ravemj.ik.candidates import shortfall

        solver = self._manip.ik_solver(kind)
        if asked and len(solver.solve_one(goal, limits=True)):
            return Cause.FILTER
        return Cause.LIMITS if shortfall(solver, goal)[1] else Cause.REACH

    def shortfall(self, region: int, poses: PoseSet, T_world_tool: Floats) -> str:
        """Describe how near to a region the tool gets.

        The distance is a local minimum, found from the reachable configuration nearest to one pose of the region.
        """
        solver, base = self._manip.ik_solver(_Type.Transform6D), self._manip.GetBase()
        T_world_base = np.eye(4) if base is None else base.GetTransform()
        near = solver.nearest_reachable(inverse(T_world_base) @ T_world_tool, self._manip.GetArmDOFValues())
        values = self._starts[region].copy()
        values[self._columns] = near.values
        _, nearer = project(values, self._errors[region], self._space, TOLERANCE, _STEPS)
        away = [
            poses.displacement(T_world_base @ T)
            for T in solver.chain.forward(np.array([values, nearer])[:, self._columns])
        ]
        distance, angle = np.linalg.norm(min(away, key=np.linalg.norm).reshape(2, 3), axis=1).tolist()
        return str(replace(near, distance=distance, angle=angle))

    def search(self, region: int, T_world_tool: Floats, random: np.random.Generator) -> PoseSolutions:
        """Project random configurations onto a region; return those that succeed. ``T_world_tool`` is ignored."""
        del T_world_tool
        starts = np.array([self._space.sample(random) for _ in range(_TRIES)])
        starts[:, self._rest] = self._starts[region][self._rest]
        solutions = self._moved(region, starts, self._space)
        endless = np.full(len(self._space.lower), np.inf)
        unlimited = replace(self._space, lower=-endless, upper=endless)
        is_limited = not len(solutions) and len(self._moved(region, starts[:2], unlimited))
        return PoseSolutions(solutions, Cause.LIMITS if is_limited else Cause.REACH)

    def _moved(self, region: int, rows: Floats, space: Space) -> Floats:
        error, smallest = self._errors[region], TOLERANCE * _PROJECTED
        ends = [project(row, error, space, smallest, _STEPS) for row in rows]
        return np.array([end for steps, end in ends if steps >= 0]).reshape(-1, rows.shape[1])


def _some(rows: Floats, near: Floats, random: np.random.Generator) -> Floats:
    """Return at most ``_MOST_ROWS`` of many IK solutions.

    Of each set of solutions that differ by full turns, the one nearest to ``near`` has priority: paths to the others
    are longer and reach the same tool pose. The solutions with priority are in random order.
    """
    rows = rows[np.argsort(np.linalg.norm(rows - near, axis=1), kind="stable")]
    first = np.unique(np.round(np.mod(rows, 2 * np.pi), 6), axis=0, return_index=True)[1]
    others = np.setdiff1d(np.arange(len(rows)), first)
    return rows[[*random.permutation(first), *others][:_MOST_ROWS]]


def _repaired(values: Values, error: Error, row: Floats) -> Floats | None:
    """Project a configuration onto the path constraint and a region; None if that fails or there is no constraint."""
    manifold = values.conditions.manifold
    if manifold is None:
        return None
    both = stacked([manifold.error, error], [1.0, manifold.threshold / TOLERANCE])
    steps, projected = project(row, both, values.space(), _PROJECTED * manifold.threshold, PROJECTION_STEPS)
    return projected if steps >= 0 else None
