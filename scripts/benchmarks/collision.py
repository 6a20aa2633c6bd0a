"""Collision checking."""

import copy
import os
import tempfile
import time
import warnings
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path

import mujoco
import numpy as np

import ravemj
from benchmarks.kinematics import robots
from benchmarks.measure import ROOT, Row, microseconds, take_turns
from ravemj.core.transforms import Floats
from ravemj.engine.collision.moving import moving_test

_LINKS = 7
_LINK = """<Body name="l{n}"><offsetfrom>l{before}</offsetfrom><Translation>0 0 .3</Translation>
<Geom type="{kind}"><extents>.05 .05 .1</extents><radius>.06</radius><height>.2</height>
<RotationAxis>1 0 0 90</RotationAxis><Translation>0 0 .15</Translation></Geom></Body>
<Joint name="j{n}" type="hinge"><Body>l{before}</Body><Body>l{n}</Body><offsetfrom>l{n}</offsetfrom>
<axis>{axis}</axis><limitsrad>-3 3</limitsrad></Joint>"""

_COUNT = 10
"""Configurations that are taken in turn, since MuJoCo's time depends on them."""

_BATCH = 600


def rows() -> list[Row]:
    """Compare collision checks in changing configurations with ``mj_kinematics`` and ``mj_collision``."""
    with warnings.catch_warnings(action="ignore"):
        arm = _arm()
        panda = ravemj.load(ROOT / "models" / "panda.xml").GetRobots()[0]
        add_boxes(panda.GetEnv(), 0.6)
    return [*_arm_rows(arm), *_panda_rows(panda), *_pr2_rows()]


def _arm_rows(arm: ravemj.Robot) -> Iterator[Row]:
    env = arm.GetEnv()
    free = _Configurations(arm, 1.5)
    both, floor = free.measure(lambda: env.CheckCollision(arm))
    what = f"SetDOFValues + CheckCollision, {_LINKS} links among 10 boxes : mj_kinematics + mj_collision"
    yield Row(what, "µs", both, floor, 3.0, note="configurations without collision")
    check, itself = take_turns(
        [microseconds(lambda: env.CheckCollision(arm), 100), microseconds(arm.CheckSelfCollision, 100)], 300
    )
    yield Row("CheckCollision alone", "µs", check)
    yield Row("CheckSelfCollision alone", "µs", itself)


def _panda_rows(panda: ravemj.Robot) -> Iterator[Row]:
    env, what = panda.GetEnv(), "Panda among 10 boxes"
    free = _Configurations(panda, 3.0)
    both, floor = free.measure(lambda: env.CheckCollision(panda) or panda.CheckSelfCollision())
    label = f"{what}: SetDOFValues + CheckCollision + CheckSelfCollision : mj_kinematics + mj_collision"
    yield Row(label, "µs", both, floor)
    yield _world_row(what, panda, free, 2.2)
    yield from _report_rows(what, panda)
    with env, panda:
        collides = moving_test(panda.simulation_state, range(panda.GetDOF()))
        tested, floor = free.measure(collides=collides)
    yield Row(f"{what}: the same as planners ask : mj_kinematics + mj_collision", "µs", tested, floor, 1.5)
    values, qpos = zip(*(free.one() for _ in range(_BATCH)), strict=True)
    samples = np.array(values)
    for processors, limit in ((1, 1.0), (2, 1.5)):
        with _processors(processors) as present:
            if present < processors:
                continue
            env.simulation.collision_stamp += 1  # so that MuJoCo's threads are started anew
            batch, loop = take_turns(
                [
                    microseconds(lambda: panda.batch_collides(samples), clock=time.perf_counter),
                    microseconds(lambda: [free.bare(one) for one in qpos], clock=time.perf_counter),
                ],
                10,
            )
        what_for = f"{what}: configurations a second, batch_collides on {processors} : a loop over MuJoCo"
        yield Row(what_for, "1/s", _BATCH / batch * 1e6, _BATCH / loop * 1e6, limit, more_is_better=True)


def _report_rows(what: str, robot: ravemj.Robot) -> Iterator[Row]:
    """Compare reports with answers alone: with contacts if it collides, with the distance if it does not."""
    env, report = robot.GetEnv(), ravemj.CollisionReport()
    checker, options = env.GetCollisionChecker(), ravemj.CollisionOptions
    assert checker is not None
    random, limits = np.random.default_rng(5), robot.GetDOFLimits()
    for option, hits, limit in ((options.Contacts, True, 3.0), (options.Distance, False, 8.0)):
        chosen: list[Floats] = []
        while len(chosen) < _COUNT:
            robot.SetDOFValues(random.uniform(*limits))
            if env.CheckCollision(robot) == hits:
                chosen.append(robot.GetDOFValues())

        def ask(*wanted: ravemj.CollisionReport, chosen: list[Floats] = chosen) -> None:
            for values in chosen:
                robot.SetDOFValues(values)
                env.CheckCollision(robot, *wanted)

        checker.SetCollisionOptions(option)
        told, alone = take_turns([microseconds(lambda ask=ask: ask(report), 3), microseconds(ask, 3)], 100)
        checker.SetCollisionOptions(0)
        yield Row(f"{what}: a report of {option.name} : the answer alone", "µs", told / _COUNT, alone / _COUNT, limit)


@contextmanager
def _processors(count: int) -> Generator[int]:
    """Let this process use so many processors at most, and say how many there are."""
    if not hasattr(os, "sched_setaffinity"):
        yield os.cpu_count() or 1
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, set(sorted(before)[:count]))
    try:
        yield len(os.sched_getaffinity(0))
    finally:
        os.sched_setaffinity(0, before)


def _pr2_rows() -> Iterator[Row]:
    with tempfile.TemporaryDirectory() as folder:
        pr2 = dict(robots(Path(folder))).get("PR2")
    if pr2 is None:
        return
    for what, overlap, limit in (("nothing overlaps", False, 2.0), ("hulls overlap, triangles decide", True, 5.0)):
        chosen = _Configurations(pr2, 3.0, hulls_overlap=overlap)
        check, floor = chosen.measure(pr2.CheckSelfCollision)
        label = f"PR2, {what}: SetDOFValues + CheckSelfCollision : mj_kinematics + mj_collision"
        yield Row(label, "µs", check, floor, limit)
    with warnings.catch_warnings(action="ignore"):
        add_boxes(pr2.GetEnv(), 1.5)
        among_boxes = _Configurations(pr2, 3.0)
    yield _world_row("PR2 among 10 boxes", pr2, among_boxes, 1.8)


def _world_row(what: str, robot: ravemj.Robot, free: "_Configurations", limit: float) -> Row:
    """Compare a question about the world with MuJoCo's time if it looks only at pairs of the robot and the world."""
    env = robot.GetEnv()
    with free.only_pairs_with_others():
        check, floor = free.measure(lambda: env.CheckCollision(robot))
    label = f"{what}: SetDOFValues + CheckCollision : mj_kinematics + mj_collision of the wanted pairs"
    return Row(label, "µs", check, floor, limit)


class _Configurations:
    """Configurations of a robot in which it does not collide, for us and for MuJoCo alone."""

    def __init__(self, robot: ravemj.Robot, largest: float, *, hulls_overlap: bool = False) -> None:
        """Choose configurations.

        Args:
            robot: The robot.
            largest: Greatest joint value [rad or m].
            hulls_overlap: Whether MuJoCo finds contacts of hulls in each of them, or in none.
        """
        self._robot = robot
        self._model = robot.GetEnv().model
        self._data = mujoco.MjData(self._model)
        lower, upper = robot.GetDOFLimits()
        self._limits = np.maximum(lower, -largest), np.minimum(upper, largest)
        self._random = np.random.default_rng(2)
        self._chosen = [self.one(hulls_overlap=hulls_overlap) for _ in range(_COUNT)]

    def one(self, *, hulls_overlap: bool | None = None) -> tuple[Floats, Floats]:
        """Return DOF values and ``qpos`` of the world; with None whether it collides or not."""
        env, robot = self._robot.GetEnv(), self._robot
        while True:
            values = self._random.uniform(*self._limits)
            robot.SetDOFValues(values)
            qpos = env.simulation.compiled().data.qpos.copy()
            if hulls_overlap is None:
                return values, qpos
            self.bare(qpos)
            is_free = not (env.CheckCollision(robot) or robot.CheckSelfCollision())
            if is_free and hulls_overlap == bool(self._data.ncon):
                return values, qpos

    @contextmanager
    def only_pairs_with_others(self) -> Generator[None]:
        """Let MuJoCo alone look only at pairs of the robot and other bodies."""
        everything, self._model = self._model, copy.copy(self._model)
        ours = self._robot.GetEnv().simulation.compiled().part(self._robot.simulation_state).body_ids
        self._model.body_contype[:], self._model.body_conaffinity[:] = 0, 1
        self._model.body_contype[ours], self._model.body_conaffinity[ours] = 1, 0
        yield
        self._model = everything

    def bare(self, qpos: Floats) -> None:
        """Let MuJoCo look for contacts."""
        self._data.qpos[:] = qpos
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)

    def measure(
        self, check: Callable[[], bool] | None = None, collides: Callable[[Floats], bool] | None = None
    ) -> list[float]:
        """Return the mean times [µs] of ``SetDOFValues`` with a check, or of a test, and of MuJoCo alone."""

        def ours() -> None:
            for values, _ in self._chosen:
                if collides is not None:
                    collides(values)
                elif check is not None:
                    self._robot.SetDOFValues(values)
                    check()

        def floor() -> None:
            for _, qpos in self._chosen:
                self.bare(qpos)

        return [time / _COUNT for time in take_turns([microseconds(ours, 3), microseconds(floor, 3)], 200)]


def _arm() -> ravemj.Robot:
    links = "".join(
        _LINK.format(n=n, before=n - 1, kind="box" if n % 2 else "cylinder", axis=("0 0 1", "0 1 0")[n % 2])
        for n in range(1, _LINKS + 1)
    )
    base = '<Body name="l0"><Geom type="box"><extents>.1 .1 .05</extents></Geom></Body>'
    env = ravemj.Environment()
    env.LoadData(f'<Environment><Robot name="arm"><KinBody>{base}{links}</KinBody></Robot></Environment>')
    add_boxes(env, 1.2)
    return env.GetRobots()[0]


def add_boxes(env: ravemj.Environment, radius: float) -> None:
    """Add ten boxes in a spiral [m]."""
    for number in range(10):
        body = ravemj.RaveCreateKinBody(env, "")
        assert body is not None
        angle = 2 * np.pi * number / 10
        place = [radius * np.cos(angle), radius * np.sin(angle), 0.5 + 0.1 * number]
        body.InitFromBoxes([[*place, *(radius / 6 * np.array([1, 1, 1.5]))]])
        body.SetName(f"box{number}")
        env.Add(body)
