"""Collision checking."""

import warnings

import mujoco
import numpy as np

import ravemj
from benchmarks.measure import Row, microseconds, take_turns

_LINKS = 7
_LINK = """<Body name="l{n}"><offsetfrom>l{before}</offsetfrom><Translation>0 0 .3</Translation>
<Geom type="{kind}"><extents>.05 .05 .1</extents><radius>.06</radius><height>.2</height>
<RotationAxis>1 0 0 90</RotationAxis><Translation>0 0 .15</Translation></Geom></Body>
<Joint name="j{n}" type="hinge"><Body>l{before}</Body><Body>l{n}</Body><offsetfrom>l{n}</offsetfrom>
<axis>{axis}</axis><limitsrad>-3 3</limitsrad></Joint>"""


def rows() -> list[Row]:
    """Compare ``SetDOFValues`` and ``CheckCollision`` of an arm among boxes with what MuJoCo takes for the scene."""
    with warnings.catch_warnings(action="ignore"):
        env = _scene()
    robot = env.GetRobots()[0]
    model, data = env.model, mujoco.MjData(env.model)
    samples = np.random.default_rng(2).uniform(-1.5, 1.5, (100, _LINKS))
    first, second = samples[~robot.batch_collides(samples)][:2]

    def ours() -> None:
        robot.SetDOFValues(first)
        env.CheckCollision(robot)
        robot.SetDOFValues(second)
        env.CheckCollision(robot)

    def bare() -> None:
        data.qpos[:] = first
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        data.qpos[:] = second
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)

    both, floor = (time / 2 for time in take_turns([microseconds(ours, 100), microseconds(bare, 100)], 300))
    check, itself = take_turns(
        [microseconds(lambda: env.CheckCollision(robot), 100), microseconds(robot.CheckSelfCollision, 100)], 300
    )
    what = f"SetDOFValues + CheckCollision, {_LINKS} links among 10 boxes : mj_kinematics + mj_collision"
    return [
        Row(what, "µs", both, floor, 3.0, note="configurations without collision, in turn"),
        Row("CheckCollision alone", "µs", check),
        Row("CheckSelfCollision alone", "µs", itself),
    ]


def _scene() -> ravemj.Environment:
    links = "".join(
        _LINK.format(n=n, before=n - 1, kind="box" if n % 2 else "cylinder", axis=("0 0 1", "0 1 0")[n % 2])
        for n in range(1, _LINKS + 1)
    )
    base = '<Body name="l0"><Geom type="box"><extents>.1 .1 .05</extents></Geom></Body>'
    env = ravemj.Environment()
    env.LoadData(f'<Environment><Robot name="arm"><KinBody>{base}{links}</KinBody></Robot></Environment>')
    for number in range(10):
        body = ravemj.RaveCreateKinBody(env, "")
        assert body is not None
        angle = 2 * np.pi * number / 10
        body.InitFromBoxes([[1.2 * np.cos(angle), 1.2 * np.sin(angle), 0.5 + 0.1 * number, 0.2, 0.2, 0.3]])
        body.SetName(f"box{number}")
        env.Add(body)
    return env
