"""Certified plans beside plans without certificates: time, and motions that graze what stands between tests."""

import statistics
import time

import numpy as np

import ravemj
from benchmarks.measure import Row
from benchmarks.planning import Problem, problems
from ravemj.manipulation.bodies import Bodies

_FINE = 10  # of the resolution: steps in which motions are looked at afterwards
_ITERATIONS = 100_000


def rows(seed: int = 0, each: int = 4, resolution: float = 0.05) -> list[Row]:
    """Plan with and without certificates, in turns."""
    times: tuple[list[float], list[float]] = ([], [])
    grazing = [0, 0]
    proved = 0
    for _, problem in problems(seed, each, resolution):
        plans = [_plan(problem, resolution, certify=certify) for certify in (False, True)]
        if any(traj is None for traj, _ in plans):
            continue
        for number, (traj, took) in enumerate(plans):
            assert traj is not None
            times[number].append(took)
            grazing[number] += grazes(problem.env.GetRobots()[0], traj, resolution / _FINE)
            proved += traj.certificate is not None and traj.certificate.certified
    count = len(times[0])
    note = f"{count} problems, of which {grazing[0]} graze without certificates"
    return [
        Row("a certified plan : a plan, sum", "s", sum(times[1]), sum(times[0]), 1.3, note=note),
        Row("a certified plan : a plan, median", "s", statistics.median(times[1]), statistics.median(times[0]), 1.3),
        Row("certified", "%", 100 * proved / count, 1.0, 100.0, more_is_better=True),
        Row("certified plans that graze", "", float(grazing[1]), 1.0, 0.0),
    ]


def _plan(problem: Problem, resolution: float, *, certify: bool) -> tuple[ravemj.Trajectory | None, float]:
    robot = problem.env.GetRobots()[0]
    robot.SetActiveDOFs(range(len(problem.start)))
    params = ravemj.Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetInitialConfig(problem.start)
    params.SetGoalConfig(problem.goal)
    params.SetConfigResolution(np.full(len(problem.start), resolution))
    params.SetMaxIterations(_ITERATIONS)
    params.set_certify(certify)
    planner, traj = ravemj.RaveCreatePlanner(problem.env, "birrt"), ravemj.Trajectory(problem.env, "")
    assert planner is not None
    planner.InitPlan(robot, params)
    begin = time.process_time()
    status = planner.PlanPath(traj)
    return (traj if status else None), time.process_time() - begin


def grazes(robot: ravemj.Robot, traj: ravemj.Trajectory, step: float) -> bool:
    """Return whether a motion of the active joints collides in steps of so many radians."""
    env = robot.GetEnv()
    spec = robot.GetActiveConfigurationSpecification()
    coarse = traj.SamplePoints2D(np.linspace(0, traj.GetDuration(), 1000), spec)
    number = int(np.abs(np.diff(coarse, axis=0)).max(axis=1).sum() / step) + 1000
    values = traj.SamplePoints2D(np.linspace(0, traj.GetDuration(), number), spec)
    bodies = Bodies(env.simulation, spec.GetGroups(), env.GetCollisionChecker)
    with bodies.kept():
        test = bodies.fast_test()
        assert test is not None
        return any(map(test, values))
