"""Shortened paths among thin posts, bars and boxes: how many graze between the tests, with certificates and without."""

from collections.abc import Iterator

import numpy as np

import ravemj
from benchmarks.certificates import grazes
from benchmarks.measure import ROOT, Row
from ravemj.core.transforms import Floats

_FINE = 10  # of the resolution: steps in which motions are looked at afterwards
_ARMS = ("puma560", "panda")
_OBSTACLES = 10
_THIN = 0.008  # half width of posts and bars [m]


def rows(scenes: int = 4, paths: int = 5) -> list[Row]:
    """Plan paths in scenes made by chance, by the seeds from 0 on; scenes take turns in arm and obstacles.

    ``rows(20, 25)`` counts over 500 paths, in about ten minutes.
    """
    count = failed = uncertified = 0
    grazing = {False: 0, True: 0}
    for seed in range(scenes):
        for robot, start, goal in _queries(seed, paths):
            for certify in (False, True):
                traj = _plan(robot, start, goal, certify=certify)
                if traj is None:
                    failed += certify
                    continue
                resolution = float(robot.GetActiveDOFResolutions().min())
                grazing[certify] += grazes(robot, traj, resolution / _FINE)
                if certify:
                    certificate = traj.certificate
                    assert certificate is not None
                    count += 1
                    uncertified += not certificate.certified
    note = f"{count} paths in {scenes} scenes; {failed} without a path; {uncertified} not certified"
    return [
        Row("shortened paths that graze", "", float(grazing[True]), 1.0, 0.0, note=note),
        Row("the same without certificates", "", float(grazing[False]), 1.0, None),
    ]


def _queries(seed: int, paths: int) -> Iterator[tuple[ravemj.Robot, Floats, Floats]]:
    """Yield an arm among obstacles, with free starts and goals; the scene has thin obstacles if the seed is even."""
    random, env = np.random.default_rng(seed), ravemj.Environment()
    env.Load(str(ROOT / "models" / f"{_ARMS[seed // 2 % 2]}.xml"))
    robot = env.GetRobots()[0]
    arm = robot.GetActiveManipulator()
    assert arm is not None
    robot.SetActiveDOFs(arm.GetArmIndices())
    for number in range(_OBSTACLES):
        body = ravemj.RaveCreateKinBody(env, "")
        assert body is not None
        body.InitFromBoxes([_box(random, thin=seed % 2 == 0)])
        body.SetName(f"obstacle{number}")
        env.Add(body)
        if env.CheckCollision(body, robot):
            env.Remove(body)
    limits = np.clip(robot.GetActiveDOFLimits(), -np.pi, np.pi)

    def free() -> Floats:
        while True:
            values = random.uniform(*limits)
            robot.SetActiveDOFValues(values)
            if not env.CheckCollision(robot) and not robot.CheckSelfCollision():
                return values

    for _ in range(paths):
        yield robot, free(), free()
    env.Destroy()


def _box(random: np.random.Generator, *, thin: bool) -> list[float]:
    """Return the centre and half extents of a post, a bar or a box around the arm."""
    angle, far = random.uniform(-np.pi, np.pi), random.uniform(0.4, 0.8)
    centre = [far * np.cos(angle), far * np.sin(angle), random.uniform(0.2, 0.9)]
    if not thin:
        return [*centre, *random.uniform(0.03, 0.12, 3).tolist()]
    half = [_THIN] * 3
    half[int(random.integers(3))] = 0.4
    return [*centre, *half]


def _plan(robot: ravemj.Robot, start: Floats, goal: Floats, *, certify: bool) -> ravemj.Trajectory | None:
    robot.SetActiveDOFValues(start)
    base = ravemj.interfaces.BaseManipulation(robot)
    try:
        found = base.MoveActiveJoints(goal=goal, maxtries=1, certify=certify, execute=False, outputtrajobj=True)
    except ravemj.PlanningError:
        return None
    assert isinstance(found, ravemj.Trajectory)
    return found
