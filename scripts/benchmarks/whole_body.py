"""Whole-body inverse kinematics: a step of a humanoid beside bare MuJoCo with a QP, and beside mink."""

import importlib.util
import time
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

import ravemj
from benchmarks.measure import ROOT, Row, take_turns
from ravemj.core.transforms import Floats
from ravemj.ik.whole_body.box_qp import is_optimal

_LIMBS = ("LFoot", "RFoot", "LHand", "RHand")
_STEPS, _DT = 100, 0.01
_WEIGHTS = (1.0, 0.01, 1e-6)  # of contacts, centre of mass and posture
_PLAIN = 435 / 616
"""Time of a plain program of MuJoCo, numpy and a box QP, as a fraction of mink's for the same step.

``_bare`` takes half of that: it fills arrays made before, for a number of tasks that is known.
"""
_AGAINST_PLAIN = 1.2
_FINGER = (
    '<Body name="F{0}" type="dynamic"><offsetfrom>{1}</offsetfrom><Translation>0 0 -0.08</Translation>'
    '<Geom type="sphere"><radius>0.01</radius></Geom><Mass type="mimicgeom"><total>0.02</total></Mass></Body>'
    '<Joint name="F{0}" type="hinge">'
    "<Body>{1}</Body><Body>F{0}</Body><offsetfrom>F{0}</offsetfrom><Axis>0 1 0</Axis><limitsdeg>-60 60</limitsdeg>"
    "<maxvel>6</maxvel></Joint>"
)


def rows() -> list[Row]:
    """Measure a step with four contacts, the centre of mass on a circle and a posture, of 38 variables."""
    steps = [_timed(_ours()), _timed(_bare()), _followed(), *map(_timed, _mink())]
    measured = take_turns(steps, 15)
    found = [
        Row("whole body: a step, weights alone", "µs", measured[0], measured[1], 2.5, note="floor: bare calls, a QP"),
        Row("whole body: follow, a step", "µs", measured[2], measured[0], 2.0, note="exact contacts; floor: weights"),
    ]
    if len(measured) > 3:
        note = f"floor: mink; limit: {_AGAINST_PLAIN} times a plain program"
        limit = _AGAINST_PLAIN * _PLAIN
        found.append(Row("whole body: a step, weights alone", "µs", measured[0], measured[3], limit, note=note))
    return found


def _timed(step: Callable[[float], None]) -> Callable[[], float]:
    """Return a function that measures a step [µs of the processor]."""
    clock = [0.0]

    def measure() -> float:
        start = time.process_time()
        for _ in range(_STEPS):
            clock[0] += _DT
            step(clock[0])
        return (time.process_time() - start) / _STEPS * 1e6

    return measure


def _robot() -> ravemj.Robot:
    """Return the biped with seven more joints, of fingers."""
    text = (ROOT / "models" / "biped.robot.xml").read_text(encoding="utf-8")
    fingers = "".join(_FINGER.format(number, "LHand" if number % 2 else "RHand") for number in range(7))
    values = "<jointvalues>"
    head, tail = text.split("    " + values)
    env = ravemj.Environment()
    robot = env.ReadRobotData(head + fingers + values + tail.replace("</jointvalues>", " 0" * 7 + "</jointvalues>"))
    env.Add(robot)
    return robot


def _circle(com: Floats, t: float) -> Floats:
    return com + 0.01 * np.array([np.cos(t) - 1, np.sin(t), 0])


def _tasks(*, exact: bool) -> tuple[ravemj.WholeBodyIK, Callable[[float], None]]:
    """Return the tasks, and a function that moves the target of the centre of mass."""
    ik = ravemj.WholeBodyIK(_robot(), base=True)
    ik.exact_contacts = exact
    for name in _LIMBS:
        ik.add_contact(name, weight=_WEIGHTS[0])
    com = ik.add_com(weight=_WEIGHTS[1])
    ik.add_posture(weight=_WEIGHTS[2])
    start = np.array(com.target)

    def retarget(t: float) -> None:
        com.target = _circle(start, t)

    return ik, retarget


def _ours() -> Callable[[float], None]:
    """Return a step with weighted contacts."""
    ik, retarget = _tasks(exact=False)

    def step(t: float) -> None:
        retarget(t)
        ik.step(_DT)

    return step


def _followed() -> Callable[[], float]:
    """Return a function that measures a step of ``follow`` with exact contacts [µs of the processor]."""
    ik, retarget = _tasks(exact=True)
    past = [0.0]

    def measure() -> float:
        start, begin = past[0], time.process_time()
        ik.follow(_STEPS * _DT, _DT, lambda t: retarget(start + t))
        past[0] += _STEPS * _DT
        return (time.process_time() - begin) / _STEPS * 1e6

    return measure


def _free_model() -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the same robot in a model of MuJoCo with a free joint at the pelvis."""
    env = _robot().GetEnv()
    spec = env.spec
    spec.body("Pelvis").add_freejoint()
    model, start = spec.compile(), env.data.qpos
    data = mujoco.MjData(model)
    data.qpos[7:] = start
    mujoco.mj_forward(model, data)
    return model, data


def _bare() -> Callable[[float], None]:
    """Return the same step by calls of MuJoCo and numpy: Jacobians, normal equations, box QP, integration.

    The program is scaled, snapped and checked as ours, without which its answers are wrong now and then.
    """
    model, data = _free_model()
    count = model.nv
    bodies = [model.body(name).id for name in _LIMBS]
    goals = [(data.xpos[body].copy(), data.xquat[body].copy()) for body in bodies]
    start, posture = data.subtree_com[0].copy(), data.qpos.copy()
    roots = np.sqrt(np.repeat(_WEIGHTS[:2], [24, 3]))
    jacobian, error = np.zeros((27, count)), np.zeros(27)
    diagonal = np.full(count, 1e-8)
    diagonal[6:] += _WEIGHTS[2]
    factor, turn = np.zeros((count, count + 7)), np.zeros(3)
    fastest = np.append(np.full(6, np.inf), np.full(count - 6, 6.0)) * _DT
    lowest, highest = (
        np.append(np.full(6, -np.inf), model.jnt_range[1:, 0]),
        np.append(np.full(6, np.inf), model.jnt_range[1:, 1]),
    )
    values = np.zeros(count)

    def step(t: float) -> None:
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        for index, (body, (place, wxyz)) in enumerate(zip(bodies, goals, strict=True)):
            row = 6 * index
            mujoco.mj_jacBody(model, data, jacobian[row : row + 3], jacobian[row + 3 : row + 6], body)
            error[row : row + 3] = place - data.xpos[body]
            mujoco.mju_subQuat(turn, wxyz, data.xquat[body])
            error[row + 3 : row + 6] = data.xmat[body].reshape(3, 3) @ turn
        mujoco.mj_jacSubtreeCom(model, data, jacobian[24:27], 1)
        error[24:27] = _circle(start, t) - data.subtree_com[0]
        rows, wanted = jacobian * roots[:, None], error * roots
        hessian, gradient = rows.T @ rows, -(wanted @ rows)
        hessian.ravel()[:: count + 1] += diagonal
        values[6:] = data.qpos[7:]
        gradient[6:] -= _WEIGHTS[2] * (posture[7:] - values[6:])
        scale, x = 1e6 / np.linalg.norm(gradient), np.zeros(count)
        lower, upper = np.maximum(lowest - values, -fastest), np.minimum(highest - values, fastest)
        lower[np.abs(lower) < 1e-9] = 0.0
        upper[np.abs(upper) < 1e-9] = 0.0
        hessian, gradient = hessian * scale, gradient * scale
        mujoco.mju_boxQP(x, factor, None, hessian, gradient, lower, upper)
        assert is_optimal(hessian, gradient, lower, upper, x)
        mujoco.mj_integratePos(model, data.qpos, x, 1.0)

    return step


def _mink() -> list[Callable[[float], None]]:
    """Return the same step by mink; none if it is not installed."""
    if importlib.util.find_spec("mink") is None:
        return []
    import mink  # noqa: PLC0415 - of the group ``bench``

    model, data = _free_model()
    configuration = mink.Configuration(model, data.qpos.copy())
    contact, balance, rest = _WEIGHTS
    feet = [mink.FrameTask(name, "body", contact**0.5, contact**0.5) for name in _LIMBS]
    com, posture = mink.ComTask(balance**0.5), mink.PostureTask(model, rest**0.5)
    tasks: list[Any] = [*feet, com, posture]
    for task in tasks:
        task.set_target_from_configuration(configuration)
    start = data.subtree_com[0].copy()
    speeds = {model.joint(joint).name: 6.0 for joint in range(1, model.njnt)}
    limits = [mink.ConfigurationLimit(model), mink.VelocityLimit(model, speeds)]

    def step(t: float) -> None:
        com.set_target(_circle(start, t))
        velocity = mink.solve_ik(configuration, tasks, _DT, "daqp", damping=1e-8, limits=limits)
        configuration.integrate_inplace(velocity, _DT)

    return [step]
