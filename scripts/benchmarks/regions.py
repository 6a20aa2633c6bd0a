"""Planning to regions and on constraints: 18 grasps among three cans, and a glass that is carried upright."""

import importlib.util
import statistics
import time
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

import ravemj
from benchmarks.measure import Row
from ravemj.planning.rrt import End, Problem, Search
from ravemj.rave.planning.path_planners import BiRrt
from ravemj.rave.planning.values import Values

_TURN, _ANY, _ZERO = [-np.pi, np.pi], [-np.inf, np.inf], [0.0, 0.0]
SECONDS = 10.0
_PROJECTED = 5  # seeds with which OMPL plans on a constraint: most of its runs take all the time

# The lengths of a UR5 [m]: axis of each joint, and where it is in the link before.
_JOINTS = [
    ("0 0 1", (0, 0, 0.089)),
    ("0 1 0", (0, 0.136, 0)),
    ("0 1 0", (0.425, -0.12, 0)),
    ("0 1 0", (0.392, 0, 0)),
    ("0 0 -1", (0, 0.093, 0)),
    ("0 1 0", (0, 0, -0.095)),
]
_SHAPES = [
    ((0, 0.05, 0), (0.05, 0.07, 0.05)),
    ((0.21, 0, 0), (0.25, 0.04, 0.04)),
    ((0.19, 0, 0), (0.22, 0.035, 0.035)),
    ((0, 0.05, 0), (0.035, 0.05, 0.035)),
    ((0, 0, -0.05), (0.035, 0.035, 0.05)),
    ((0, 0.06, 0), (0.04, 0.03, 0.02)),
]


class Task(NamedTuple):
    """An arm in its world, parameters of planners, and the regions in them."""

    robot: ravemj.Robot
    params: ravemj.Planner.PlannerParameters
    goals: list[ravemj.Region]
    constraints: list[ravemj.Region]


def rows(seeds: int = 100) -> list[Row]:
    """Plan with many seeds; beside OMPL where it is installed.

    For the first goals of regions, that is its RRTConnect; on a constraint, the same in its projected state space, with
    ``_PROJECTED`` seeds.
    """
    found: list[Row] = []
    has_ompl = importlib.util.find_spec("ompl") is not None
    for name, make, rival, most in (
        ("18 grasps", cans, partial(planned, name="ompl_rrtconnect"), seeds),
        ("upright carry", upright, _projected, _PROJECTED),
    ):
        task, runs, others = make(), list[tuple[bool, float]](), list[tuple[bool, float]]()
        for seed in range(seeds):
            runs.append(planned(task, seed, "birrt"))
            if has_ompl and seed < most:
                others.append(rival(task, seed))
        solved, median = _summary(runs)
        found.append(Row(f"{name}: solved", "%", solved, 1.0, 100.0, more_is_better=True, note=f"{seeds} seeds"))
        note = f"OMPL solves {_summary(others)[0]:g} % of {len(others)} seeds" if others else ""
        floor, limit = (_summary(others)[1], 1.0) if others else (None, None)
        found.append(Row(f"{name}: median : OMPL", "ms", median, floor, limit, note=note))
    return found


def _summary(runs: Sequence[tuple[bool, float]]) -> tuple[float, float]:
    """Return how many runs found a path [%], and their median time [ms]."""
    return 100 * sum(done for done, _ in runs) / len(runs), statistics.median(took for _, took in runs)


def planned(task: Task, seed: int, name: str) -> tuple[bool, float]:
    """Return whether a planner finds a path, and its process time [ms]; nothing is smoothed."""
    params = ravemj.Planner.PlannerParameters(task.params)
    params.SetRandomGeneratorSeed(seed)
    params.SetMaxIterations(1_000_000)
    params.SetMaxPlanningTime(int(SECONDS * 1000))
    params.SetPostProcessing("", "")
    env = task.robot.GetEnv()
    planner, trajectory = ravemj.RaveCreatePlanner(env, name), ravemj.RaveCreateTrajectory(env, "")
    assert planner is not None
    begin = time.process_time()
    planner.InitPlan(task.robot, params)
    status = planner.PlanPath(trajectory)
    return bool(status), (time.process_time() - begin) * 1e3


def _projected(task: Task, seed: int) -> tuple[bool, float]:
    """Return whether OMPL finds a path on the constraint, and its process time [ms], with that for starts and goals."""
    from benchmarks.projected_ompl import is_solved  # noqa: PLC0415 - optional

    solved = False

    class Projected(BiRrt):
        def _search(self, problem: Problem, values: Values) -> Search:
            nonlocal solved
            assert values.conditions.manifold is not None
            solved = is_solved(problem, values.conditions.manifold, SECONDS, seed)
            return Search(End.stuck, None, -1, -1, 0, ())  # its path is not looked at

    params = ravemj.Planner.PlannerParameters(task.params)
    params.SetRandomGeneratorSeed(seed)
    env = task.robot.GetEnv()
    planner = Projected(env, "birrt")
    begin = time.process_time()
    planner.InitPlan(task.robot, params)
    planner.PlanPath(ravemj.RaveCreateTrajectory(env, ""))
    return solved, (time.process_time() - begin) * 1e3


def _arm(env: ravemj.Environment) -> ravemj.Robot:
    """Add an arm with the axes of a UR5 to an environment."""
    bodies, joints = ['<Body name="link0"/>'], list[str]()
    for number, ((axis, place), (centre, half)) in enumerate(zip(_JOINTS, _SHAPES, strict=True), 1):
        bodies.append(
            f'<Body name="link{number}"><offsetfrom>link{number - 1}</offsetfrom>'
            f"<Translation>{_text(place)}</Translation>"
            f'<Geom type="box"><Translation>{_text(centre)}</Translation><extents>{_text(half)}</extents></Geom></Body>'
        )
        joints.append(
            f'<Joint name="j{number}" type="hinge"><Body>link{number - 1}</Body><Body>link{number}</Body>'
            f"<offsetfrom>link{number}</offsetfrom><axis>{axis}</axis><limitsdeg>-360 360</limitsdeg></Joint>"
        )
    apart = "".join(f"<adjacent>link{first} link{first + 2}</adjacent>" for first in range(5))
    env.LoadData(
        f'<Environment><Robot name="arm"><KinBody>{"".join([*bodies, *joints, apart])}</KinBody>'
        '<Manipulator name="tool"><base>link0</base><effector>link6</effector><Translation>0 0.16 0</Translation>'
        "<RotationAxis>1 0 0 -90</RotationAxis></Manipulator></Robot></Environment>"
    )
    robot = env.GetRobots()[0]
    robot.SetActiveDOFs(robot.GetActiveManipulator().GetArmIndices())
    robot.SetActiveDOFValues([0.0, -1.6, 1.2, -1.2, 0.0, 0.0])
    return robot


def _text(numbers: Sequence[float]) -> str:
    return " ".join(map(str, numbers))


def _add(
    env: ravemj.Environment, name: str, kind: ravemj.GeometryType, sizes: Sequence[float], place: Sequence[float]
) -> ravemj.KinBody:
    shape = ravemj.KinBody.GeometryInfo()
    shape._type, shape._vGeomData = kind, list(sizes)
    body = ravemj.RaveCreateKinBody(env, "")
    body.SetName(name)
    body.InitFromGeometries([shape])
    env.Add(body)
    body.SetTransform([1, 0, 0, 0, *place])
    return body


def cans() -> Task:
    """Return the task to grasp any of three cans on a table, from the side at two heights or from above."""
    env = ravemj.Environment()
    robot = _arm(env)
    _add(env, "table", ravemj.GeometryType.Box, [0.25, 0.4, 0.02], [0.5, 0, -0.02])
    _add(env, "wall", ravemj.GeometryType.Box, [0.2, 0.01, 0.2], [0.5, 0.1, 0.2])
    cans = [
        _add(env, f"can {number}", ravemj.GeometryType.Cylinder, [0.03, 0.12], [*place, 0.061])
        for number, place in enumerate([(0.45, -0.2), (0.5, 0.2), (0.6, 0.0)])
    ]
    side, down = (ravemj.matrixFromAxisAngle(axis) for axis in ([0, np.pi / 2, 0], [np.pi, 0, 0]))
    regions: list[ravemj.Region] = []
    for can in cans:
        for tool, low, high in ((side, -0.03, 0.0), (side, 0.0, 0.03), (down, 0.06, 0.07)):
            for half_turn in (0.0, np.pi):
                turned = tool @ ravemj.matrixFromAxisAngle([0, 0, half_turn])
                turned[:3, 3] = -0.04 * turned[:3, 2]
                bounds = [_ZERO, _ZERO, [low, high], _ZERO, _ZERO, _TURN]
                regions.append(ravemj.Region(Tw_e=turned, Bw=bounds, frame=can, name=can.GetName()))
    params = ravemj.Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.set_goal_sampler(regions)
    return Task(robot, params, regions, [])


def upright() -> Task:
    """Return the task to carry a glass over a wall, leaning by 5 degrees at most."""
    env = ravemj.Environment()
    robot = _arm(env)
    robot.SetActiveDOFValues([-1.1, -1.6, 1.2, -1.2, 0.0, 0.0])
    start = robot.GetActiveManipulator().GetTransform()
    _add(env, "wall", ravemj.GeometryType.Box, [0.2, 0.01, 0.2], [0.6, 0.0, start[2, 3] - 0.1])
    glass = _add(env, "glass", ravemj.GeometryType.Cylinder, [0.03, 0.12], start[:3, 3] + 0.05 * start[:3, 2])
    robot.Grab(glass)
    goal = glass.GetTransform()
    goal[1, 3] *= -1
    params = ravemj.Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    lean = np.radians(5)
    level = ravemj.Region(Bw=[_ANY, _ANY, _ANY, _ZERO, _ZERO, _TURN], lean=lean)
    params.add_constraint(level, holding=glass)
    place = [[-0.03, 0.03], [-0.03, 0.03], [-0.03, 0.03], _ZERO, _ZERO, _TURN]
    placed = ravemj.Region(goal, Bw=place, lean=lean)
    params.set_goal_sampler(placed, holding=glass)
    return Task(robot, params, [placed], [level])
