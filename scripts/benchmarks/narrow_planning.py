"""Motion planning where the way out is narrow: a peg in a hole, a ring on a peg, a base and a door."""

import statistics
import time
import warnings
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

import ravemj
from benchmarks.measure import ROOT, Row
from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges
from ravemj.planning.ompl_search import planner_classes, search_with_ompl
from ravemj.planning.rrt import Budget, Search, connect
from ravemj.rave import Planner

_SECONDS = 20.0
_MOST_ITERATIONS = 1_000_000
_DOWN = np.diag([1.0, -1.0, -1.0, 1.0])
_PEG = 0.02  # half width [m] of the peg, and of the hole in the ring
_CLEARANCE = 0.008  # around it [m]
_DEEP = 0.06  # half length of the peg, and half depth of its hole [m]
_THICK = 0.015  # half width of walls and of the ring's sides [m]

_Body = TypeVar("_Body", bound=ravemj.KinBody)

Boxes = list[list[float]]
"""Centre and half extents of boxes."""


class Problem(NamedTuple):
    """A problem for a planner.

    Attributes:
        env: The world.
        params: The parameters of the planner, with the start and the goal.
    """

    env: ravemj.Environment
    params: Planner.PlannerParameters


def rows(seed: int = 0, each: int = 20) -> list[Row]:
    """Solve narrow problems with our RRT-Connect, and with OMPL's where it is installed.

    Args:
        seed: The seed of the problems.
        each: The number of problems of each kind.
    """
    return [row for name, make in PROBLEMS.items() for row in _kind(name, make, seed, each)]


def _kind(name: str, make: Callable[[np.random.Generator], Problem], seed: int, each: int) -> Iterable[Row]:
    ours: list[float] = []
    others: list[float] = []
    rival = (planner_classes() or {}).get("rrtconnect")
    for number in range(each):
        problem = make(np.random.default_rng((seed, number)))
        ours.append(solve(problem, number))
        if rival is not None:
            others.append(solve(problem, number, rival))
    solved, note = [sum(map(np.isfinite, one)) for one in (ours, others)], f"limit in ms; {each} problems"
    floor = statistics.median(others) if others else None
    yield Row(f"{name}: solved", "%", 100 * solved[0] / each, 1.0, 100.0, more_is_better=True, note=f"{each} problems")
    yield Row(f"{name}: median", "ms", statistics.median(ours), 1.0, 1000.0, note=note)
    yield Row(f"{name}: median : OMPL", "ms", statistics.median(ours), floor, 1.0 if others else None)


def solve(problem: Problem, seed: int, rival: object = None) -> float:
    """Return how long a search takes [ms], infinite if it fails."""
    values = problem.params.resolved()
    starts, goals = (list(values.configurations(f"_v{end}config")) for end in ("initial", "goal"))
    assert values.bodies is not None
    with values.bodies.kept():
        edges = values.edges(np.array([*starts, *goals]))
        begin = time.process_time()
        budget = Budget(_MOST_ITERATIONS, _SECONDS)
        found = search(edges, starts, goals, budget, seed, rival)
        took = (time.process_time() - begin) * 1e3
    return took if found.path is not None else np.inf


def search(
    edges: Edges, starts: Sequence[Floats], goals: Sequence[Floats], budget: Budget, seed: int, rival: object
) -> Search:
    """Search with RRT-Connect, ours or OMPL's."""
    if rival is not None:
        return search_with_ompl(rival, edges, starts, goals, budget, seed, {})
    return connect(edges, starts, goals, budget, np.random.default_rng(seed))


def _arm_problem(obstacles: Boxes, held: Boxes, start: Floats, goal: Floats) -> Problem | None:
    """Return a problem of the Panda that holds boxes, given in the frame of its tool; None if an end collides.

    ``start`` and ``goal`` are ``T_world_tool``.
    """
    env = ravemj.Environment()
    with warnings.catch_warnings(action="ignore"):
        env.Load(str(ROOT / "models" / "panda.xml"))
    robot = env.GetRobots()[0]
    manip = robot.GetActiveManipulator()
    assert manip is not None
    ravemj.databases.inversekinematics.InverseKinematicsModel(
        robot, iktype=ravemj.IkParameterization.Type.Transform6D
    ).load()
    ends = [_solutions(manip, pose) for pose in (start, goal)]
    _add_boxes(env, "obstacles", obstacles)
    robot.SetActiveDOFs(manip.GetArmIndices())
    body = _add_boxes(env, "held", held)
    body.SetTransform(manip.GetTransform())
    robot.Grab(body, manip.GetEndEffector())
    free = [[one for one in rows if _is_free(env, robot, one)] for rows in ends]
    return _problem(env, robot, free[0][0], free[1][:1]) if all(free) else None


def _solutions(manip: ravemj.Robot.Manipulator, pose: Floats) -> list[Floats]:
    return list(manip.FindIKSolutions(pose, 0))


def _is_free(env: ravemj.Environment, robot: ravemj.Robot, values: Floats) -> bool:
    robot.SetActiveDOFValues(values)
    return not env.CheckCollision(robot) and not robot.CheckSelfCollision()


def _problem(env: ravemj.Environment, robot: ravemj.Robot, start: Floats, goals: Sequence[Floats]) -> Problem:
    robot.SetActiveDOFValues(start)
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig(np.concatenate(goals))
    return Problem(env, params)


def _add_boxes(env: ravemj.Environment, name: str, boxes: Boxes) -> ravemj.KinBody:
    body = ravemj.RaveCreateKinBody(env, "")
    assert body is not None
    return _added(env, name, boxes, body)


def _added(env: ravemj.Environment, name: str, boxes: Boxes, body: _Body) -> _Body:
    body.InitFromBoxes(boxes)
    body.SetName(name)
    env.Add(body)
    return body


def _pose(random: np.random.Generator) -> Floats:
    """Return a pose of a tool that points down."""
    pose = _DOWN.copy()
    angle, far = random.uniform(-1.2, 1.2), random.uniform(0.45, 0.6)
    pose[:3, 3] = far * np.cos(angle), far * np.sin(angle), random.uniform(0.3, 0.4)
    return pose


def _frame(x: float, y: float, z: float, inner: float, height: float) -> Boxes:
    """Return four walls around a square hole."""
    middle, outer = inner + _THICK, inner + 2 * _THICK
    sides = [[x + side * middle, y, z, _THICK, outer, height] for side in (-1, 1)]
    return [*sides, *([x, y + side * middle, z, inner, _THICK, height] for side in (-1, 1))]


def peg(random: np.random.Generator) -> Problem:
    """Return a problem of a held peg that is deep in a hole, and should get anywhere else."""
    while True:
        pose = _pose(random)
        x, y, z = pose[:3, 3].tolist()
        hole = _frame(x, y, z - 0.02 - _DEEP, _PEG + _CLEARANCE, _DEEP)
        found = _arm_problem(hole, [[0, 0, _DEEP + 0.02, _PEG, _PEG, _DEEP]], pose, _pose(random))
        if found is not None:
            return found


def ring(random: np.random.Generator) -> Problem:
    """Return a problem of a held ring that is on one peg, and should get onto another."""
    while True:
        poses = [_pose(random), _pose(random)]
        if np.linalg.norm(poses[0][:2, 3] - poses[1][:2, 3]) < 0.2:
            continue
        pegs = [[*pose[:2, 3], pose[2, 3] - 0.05, _PEG, _PEG, 0.04] for pose in poses]
        held = _frame(0, 0, 0.03, _PEG + _CLEARANCE, 0.01)
        found = _arm_problem(pegs, held, *poses)
        if found is not None:
            return found


def door(random: np.random.Generator) -> Problem:
    """Return a problem of a base that goes from one room through a door into another; limits are OpenRAVE's 100 m."""
    env = ravemj.Environment()
    empty = ravemj.RaveCreateRobot(env, "")
    assert empty is not None
    robot = _added(env, "base", [[0, 0, 0.5, 0.33, 0.3, 0.5]], empty)
    at, place, half = float(random.uniform(-1.4, 1.4)), float(random.uniform(-0.5, 0.5)), 0.4
    walls = [[x, 0, 0.5, 0.05, 2, 0.5] for x in (-4, 4)] + [[0, y, 0.5, 4, 0.05, 0.5] for y in (-2, 2)]
    walls += [[place, (at + half + 2) / 2, 0.5, 0.05, (2 - at - half) / 2, 0.5]]
    walls += [[place, (at - half - 2) / 2, 0.5, 0.05, (2 + at - half) / 2, 0.5]]
    for _ in range(4):
        x, y = random.uniform([-3, -1.5], [3, 1.5]).tolist()
        if abs(x - place) > 1.2:
            walls.append([x, y, 0.4, 0.25, 0.25, 0.4])
    _add_boxes(env, "walls", walls)
    robot.SetActiveDOFs([], ravemj.DOFAffine.X | ravemj.DOFAffine.Y | ravemj.DOFAffine.RotationAxis, [0, 0, 1])
    ends: list[Floats] = []
    for side in (-1, 1):
        while True:
            one = np.array([place + side * random.uniform(1.0, 3.0), *random.uniform([-1.5, -3], [1.5, 3])])
            if abs(one[0]) < 3.5 and _is_free(env, robot, one):
                break
        ends.append(one)
    return _problem(env, robot, ends[0], ends[1:])


PROBLEMS: dict[str, Callable[[np.random.Generator], Problem]] = {"peg": peg, "ring": ring, "door": door}
