"""Motion planning: generated problems of an arm among boxes, retiming, and one question about collisions."""

import statistics
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import mujoco
import numpy as np

import ravemj
from benchmarks.measure import ROOT, Row, microseconds, take_turns
from ravemj.core.transforms import Floats, Ints
from ravemj.manipulation.bodies import Bodies
from ravemj.planning.edges import Edges, length
from ravemj.planning.retiming.polynomials import Parabolic
from ravemj.planning.retiming.segments import PathLimits, retime
from ravemj.planning.rrt import Budget, Search, connect
from ravemj.planning.shortcuts import shorten
from ravemj.planning.space import Coordinates, Space

_DOFS = 7
_APART = 2.0  # rad, from start to goal
_RESOLUTION = 0.05  # rad
_SECONDS = 20.0
_SHORTCUTS = 60
_SAMPLES = 1000  # of which goals are chosen
_GOALS = 10  # that a problem has for choice

Boxes = list[list[float]]
"""Centre and half extents of boxes."""


class Problem(NamedTuple):
    """A world, and where to plan.

    Attributes:
        env: The world.
        bodies: What moves.
        space: Where it moves.
        start: Where it starts.
        goal: Where it should go.
    """

    env: ravemj.Environment
    bodies: Bodies
    space: Space
    start: Floats
    goal: Floats


def rows(seed: int = 0, each: int = 20, resolution: float = _RESOLUTION) -> list[Row]:
    """Solve generated problems with our RRT-Connect, and with OMPL's where it is installed.

    Args:
        seed: Of the problems.
        each: How many problems of each kind.
        resolution: In what steps lines are tested [rad].
    """
    found: list[Row] = []
    times: list[float] = []
    others: list[float] = []
    savings: list[float] = []
    cuts: list[float] = []
    other = _ompl_planner()
    for _, problem in problems(seed, each, resolution):
        with problem.bodies.kept():
            milliseconds, search = _solved(problem)
            if search.path is None and not (other and other(problem)[1]):
                continue  # not known to have a solution
            times.append(milliseconds if search.path is not None else np.inf)
            if other is not None:
                others.append(other(problem)[0])
            if search.path is not None:
                took, saved = _shortened(problem, search.path)
                cuts.append(took)
                savings.append(saved)
    count, solved = len(times), sum(np.isfinite(times))
    note = f"{count} problems with steps of {resolution:g} rad"
    found += [
        Row("RRT-Connect: solved", "%", 100 * solved / count, 1.0, 100.0, more_is_better=True, note=note),
        Row("RRT-Connect: median", "ms", statistics.median(times), 1.0, 20.0, note="limit in ms"),
        Row("RRT-Connect: mean : OMPL", "ms", statistics.mean(times), _mean(others), 0.5 if others else None),
        Row("RRT-Connect: mean", "ms", statistics.mean(times), 1.0, 50.0, note="limit in ms"),
        Row("RRT-Connect: 95th percentile", "ms", float(np.percentile(times, 95)), 1.0, 200.0, note="limit in ms"),
        Row(f"{_SHORTCUTS} shortcuts: median", "ms", statistics.median(cuts), 1.0, 10.0, note="limit in ms"),
        Row("shortcuts: median of what is saved", "%", statistics.median(savings), 1.0, 30.0, more_is_better=True),
    ]
    return [*found, *_one_check(), _retiming()]


def problems(seed: int, each: int, resolution: float) -> "list[tuple[str, Problem]]":
    """Return problems of each kind of world, with free hands and with a held box.

    Args:
        seed: Of the random numbers.
        each: How many of each kind.
        resolution: In what steps lines are tested [rad].
    """
    random = np.random.default_rng(seed)
    found: list[tuple[str, Problem]] = []
    for number in range(each):
        kinds = list(_WORLDS.items())
        kinds.append(("held", kinds[number % len(kinds)][1]))
        for name, boxes in kinds:
            found.append((name, _problem(boxes, random, resolution, held=name == "held")))
    return found


def _problem(
    boxes: Callable[[np.random.Generator], tuple[Boxes, list[float]]],
    random: np.random.Generator,
    resolution: float,
    *,
    held: bool,
) -> Problem:
    """Return a problem whose goal has the tool near a place that is hard to get to; no straight line leads there."""
    while True:
        placed, focus = boxes(random)
        env, bodies, space = _world(placed, resolution, held=held)
        with bodies.kept():
            test = _test(bodies)
            free = list(filter(test, (space.sample(random) for _ in range(_SAMPLES))))
            apart = [np.linalg.norm(_tool(bodies, one) - focus) for one in free]
            goals = [free[place] for place in np.argsort(apart)[:_GOALS]]
            edges = Edges(space, _test(bodies))
            for _ in range(_GOALS):
                start, goal = free[int(random.integers(len(free)))], goals[int(random.integers(len(goals)))]
                if np.linalg.norm(goal - start) > _APART and not edges.line(start, goal - start):
                    return Problem(env, bodies, space, start, goal)


def _tool(bodies: Bodies, values: Floats) -> Floats:
    bodies.move(values)
    (robot,) = bodies.bodies
    return robot.link_transforms()[-1][:3, 3]


def _world(boxes: Boxes, resolution: float, *, held: bool) -> tuple[ravemj.Environment, Bodies, Space]:
    env = ravemj.Environment()
    with warnings.catch_warnings(action="ignore"):
        env.Load(str(ROOT / "models" / "panda.xml"))
    robot = env.GetRobots()[0]
    for number, box in enumerate(boxes):
        _add_box(env, f"box{number}", box)
    if held:
        tool = robot.GetActiveManipulator() or robot.GetManipulators()[0]
        x, y, z = (tool.GetTransform() @ [0, 0, 0.06, 1])[:3].tolist()
        body = _add_box(env, "held", [x, y, z, 0.03, 0.03, 0.04])
        robot.Grab(body, robot.GetLinks()[-1])
    spec = robot.GetConfigurationSpecificationIndices(range(_DOFS))
    bodies = Bodies(env.simulation, spec.GetGroups(), env.GetCollisionChecker)
    lower, upper = bodies.numbers("lower"), bodies.numbers("upper")
    ones = np.ones(_DOFS)
    return env, bodies, Space(bodies.coordinates(), lower, upper, ones, resolution * ones)


def _add_box(env: ravemj.Environment, name: str, box: Sequence[float]) -> ravemj.KinBody:
    body = ravemj.RaveCreateKinBody(env, "")
    assert body is not None
    body.InitFromBoxes([box])
    body.SetName(name)
    env.Add(body)
    return body


def _scattered(random: np.random.Generator) -> tuple[Boxes, list[float]]:
    found: Boxes = []
    while len(found) < 10:
        x, y = random.uniform(-0.9, 0.9, 2).tolist()
        if x * x + y * y > 0.4**2:
            found.append([x, y, float(random.uniform(0.0, 0.9)), *random.uniform(0.04, 0.12, 3).tolist()])
    return found, found[0][:3]


def _shelf(random: np.random.Generator) -> tuple[Boxes, list[float]]:
    x, y = float(random.uniform(0.6, 0.75)), float(random.uniform(-0.1, 0.1))
    boards = [[x, y, z, 0.15, 0.4, 0.01] for z in (0.1, 0.4, 0.7, 1.0)]
    sides = [[x, y + side, 0.55, 0.15, 0.01, 0.45] for side in (-0.4, 0.0, 0.4)]
    inside = [x, y + float(random.choice([-0.2, 0.2])), float(random.choice([0.25, 0.55]))]
    return [*boards, *sides, [x + 0.16, y, 0.55, 0.01, 0.4, 0.45]], inside


def _cage(random: np.random.Generator) -> tuple[Boxes, list[float]]:
    far, turn = float(random.uniform(0.55, 0.65)), float(random.uniform(0, 1))
    angles = [2 * np.pi * (number + turn) / 12 for number in range(12)]
    bars = [[far * np.cos(one), far * np.sin(one), 0.5, 0.02, 0.02, 0.5] for one in angles]
    angle = 2 * np.pi * (turn + 0.5 + int(random.integers(12))) / 12
    outside = [(far + 0.15) * np.cos(angle), (far + 0.15) * np.sin(angle), 0.5]
    return [*bars, [0.0, 0.0, 1.25, 0.65, 0.65, 0.02]], outside


def _table(random: np.random.Generator) -> tuple[Boxes, list[float]]:
    height = float(random.uniform(0.15, 0.35))
    top = [0.6, 0.0, height, 0.25, 0.6, 0.02]
    legs = [[x, y, height / 2, 0.02, 0.02, height / 2 - 0.02] for x in (0.4, 0.8) for y in (-0.55, 0.55)]
    box = [0.6, float(random.uniform(-0.3, 0.3)), height + 0.15, 0.1, 0.1, 0.12]
    return [top, *legs, box], [0.6, 0.0, height - 0.1]


def _tall(random: np.random.Generator) -> tuple[Boxes, list[float]]:
    x, width = float(random.uniform(0.45, 0.6)), float(random.uniform(0.12, 0.2))
    wall = 0.015
    sides = [[x + side * width, 0.0, 0.25, wall, width, 0.25] for side in (-1, 1)]
    ends = [[x, side * width, 0.25, width, wall, 0.25] for side in (-1, 1)]
    return [*sides, *ends, [0.0, 0.6, 0.5, 0.3, 0.02, 0.5]], [x, 0.0, 0.25]


_WORLDS: dict[str, Callable[[np.random.Generator], tuple[Boxes, list[float]]]] = {
    "boxes": _scattered,
    "shelf": _shelf,
    "cage": _cage,
    "table": _table,
    "tall": _tall,
}


def _test(bodies: Bodies) -> Callable[[Floats], bool]:
    collides = bodies.fast_test()
    assert collides is not None
    return lambda values: not collides(values)


def _solved(problem: Problem) -> tuple[float, Search]:
    begin = time.process_time()
    edges = Edges(problem.space, _test(problem.bodies))
    budget = Budget(1_000_000, _SECONDS)
    found = connect(edges, [problem.start], [problem.goal], budget, np.random.default_rng(1))
    return (time.process_time() - begin) * 1e3, found


def _shortened(problem: Problem, path: Floats) -> tuple[float, float]:
    """Return how long shortcuts take [ms], and what part they save [%]."""
    edges = Edges(problem.space, _test(problem.bodies))
    begin = time.process_time()
    short = shorten(edges, path, _SHORTCUTS, np.random.default_rng(2))
    took = (time.process_time() - begin) * 1e3
    return took, 100 * (1 - length(problem.space, short) / length(problem.space, path))


def _ompl_planner() -> "Callable[[Problem], tuple[float, bool]] | None":
    """Return a solver that asks OMPL's RRTConnect, with the same test of configurations; None without OMPL."""
    try:
        from ompl import base, geometric, util  # noqa: PLC0415 # pyright: ignore - optional
    except ImportError:
        return None
    util.setLogLevel(util.LogLevel.LOG_NONE)

    def solve(problem: Problem) -> tuple[float, bool]:
        space = base.RealVectorStateSpace(_DOFS)
        bounds = base.RealVectorBounds(_DOFS)
        for axis in range(_DOFS):
            bounds.setLow(axis, float(problem.space.lower[axis]))
            bounds.setHigh(axis, float(problem.space.upper[axis]))
        space.setBounds(bounds)
        setup = geometric.SimpleSetup(space)
        test = _test(problem.bodies)
        setup.setStateValidityChecker(lambda state: test(np.array([state[axis] for axis in range(_DOFS)])))
        information = setup.getSpaceInformation()
        information.setStateValidityCheckingResolution(problem.space.resolution[0] / space.getMaximumExtent())
        ends = [space.allocState(), space.allocState()]
        for state, values in zip(ends, (problem.start, problem.goal), strict=True):
            for axis in range(_DOFS):
                state[axis] = float(values[axis])
        setup.setStartAndGoalStates(*ends)
        setup.setPlanner(geometric.RRTConnect(information))
        begin = time.process_time()
        setup.solve(_SECONDS)
        return (time.process_time() - begin) * 1e3, setup.haveExactSolutionPath()  # others end elsewhere

    return solve


def _mean(numbers: Sequence[float]) -> float | None:
    return statistics.mean(numbers) if numbers else None


def _one_check() -> Iterator[Row]:
    """Compare one test inside of a planner with bare MuJoCo, for which what is held stays where it is."""
    by_kind = dict(problems(3, 1, _RESOLUTION))
    for what, problem in (("", by_kind["boxes"]), (" with a held box", by_kind["held"])):
        bodies, random = problem.bodies, np.random.default_rng(4)
        with bodies.kept():
            test = _test(bodies)
            samples = list(filter(test, (problem.space.sample(random) for _ in range(300))))[:50]
            model, data = problem.env.model, mujoco.MjData(problem.env.model)
            places = problem.env.GetRobots()[0].qpos_indices[:_DOFS]
            measured, floor = (one / len(samples) for one in _times(test, samples, model, data, places))
        label = f"a test of a free configuration{what} : mj_kinematics + mj_collision"
        yield Row(label, "µs", measured, floor, 1.5)


def _times(
    test: Callable[[Floats], bool],
    samples: Sequence[Floats],
    model: mujoco.MjModel,
    data: mujoco.MjData,
    places: Ints,
) -> list[float]:
    """Return how long all samples take us, and MuJoCo alone [µs]."""

    def ours() -> None:
        for one in samples:
            test(one)

    def bare() -> None:
        for one in samples:
            data.qpos[places] = one
            mujoco.mj_kinematics(model, data)
            mujoco.mj_collision(model, data)

    return take_turns([microseconds(ours), microseconds(bare)], 30)


def _retiming() -> Row:
    """Measure retiming of ten waypoints of seven joints."""
    points = np.random.default_rng(5).uniform(-2, 2, (10, _DOFS))
    ones = np.ones(_DOFS)
    plain = Coordinates(np.zeros(_DOFS, dtype=bool))
    limits = PathLimits(plain, -3 * ones, 3 * ones, 2 * ones, 5 * ones, 100 * ones)
    (measured,) = take_turns([microseconds(lambda: retime(Parabolic(), points, limits))], 20)
    return Row("parabolic times for ten waypoints of seven joints", "ms", measured / 1e3, 1.0, 1.0, note="limit in ms")
