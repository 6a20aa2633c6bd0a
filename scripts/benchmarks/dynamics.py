"""Jacobians and inverse dynamics: one configuration, and many at once."""

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import mujoco
import numpy as np

import ravemj
from benchmarks.kinematics import robots
from benchmarks.measure import Row, microseconds, take_turns
from ravemj.core.transforms import Floats

MANY = 600
"""Configurations of a batch."""


def rows() -> list[Row]:
    """Compare our calls with the MuJoCo calls that they stand for, for robots of several sizes."""
    with tempfile.TemporaryDirectory() as folder:
        return [row for name, robot in robots(Path(folder)) for row in _of(name, robot)]


class Bare:
    """MuJoCo without us, on the model of the same robot."""

    def __init__(self, robot: ravemj.Robot) -> None:
        self.model = robot.GetEnv().model
        self.data = mujoco.MjData(self.model)
        self.data.qpos[:] = robot.GetEnv().data.qpos
        self.qpos, self.qvel, self.qacc = self.data.qpos, self.data.qvel, self.data.qacc
        self.moving, self.turning = np.zeros((3, self.model.nv)), np.zeros((3, self.model.nv))
        self.forces = np.zeros(self.model.nv)
        self.body = self.model.nbody - 1
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)

    def jacobian(self, point: Floats) -> None:
        """Write the Jacobian of the last link."""
        mujoco.mj_jac(self.model, self.data, self.moving, None, point, self.body)

    def both(self, point: Floats) -> None:
        """Write the Jacobians of position and rotation of the last link."""
        mujoco.mj_jac(self.model, self.data, self.moving, self.turning, point, self.body)

    def inverse(self) -> None:
        """Write the torques."""
        model, data = self.model, self.data
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 1, self.forces)


def _of(what: str, robot: ravemj.Robot) -> Iterator[Row]:
    bare, dof, last = Bare(robot), robot.GetDOF(), len(robot.GetLinks()) - 1
    point, quat = np.array([0.1, 0.2, 0.3]), np.array([1.0, 0, 0, 0])
    rates = np.full(dof, 0.1)
    values = robot.GetDOFValues()
    robot.SetDOFVelocities(rates)
    bare.qvel[:] = 0.1
    push = {last: np.array([1.0, 2, 3, 4, 5, 6])}

    def set_and_inverse() -> None:
        robot.SetDOFValues(values)
        robot.ComputeInverseDynamics(rates)

    calls: list[tuple[str, Callable[[], object], Callable[[], object], float]] = [
        (
            "ComputeJacobianTranslation : mj_jac",
            lambda: robot.ComputeJacobianTranslation(last, point),
            lambda: bare.jacobian(point),
            5.0,
        ),
        (
            "ComputeJacobianAxisAngle : mj_jac",
            lambda: robot.ComputeJacobianAxisAngle(last),
            lambda: bare.jacobian(point),
            5.0,
        ),
        (
            "CalculateActiveJacobian : mj_jac",
            lambda: robot.CalculateActiveJacobian(last, point),
            lambda: bare.jacobian(point),
            5.0,
        ),
        (
            "CalculateRotationJacobian : mj_jac",
            lambda: robot.CalculateRotationJacobian(last, quat),
            lambda: bare.both(point),
            10.0,
        ),
        (
            "ComputeInverseDynamics : kinematics, comPos, comVel, rne",
            lambda: robot.ComputeInverseDynamics(rates),
            bare.inverse,
            3.0,
        ),
        ("SetDOFValues + ComputeInverseDynamics : the same", set_and_inverse, bare.inverse, 8.0),
        (
            "  with an external force : the same",
            lambda: robot.ComputeInverseDynamics(rates, push),
            bare.inverse,
            5.0,
        ),
        (
            "  in components : the same",
            lambda: robot.ComputeInverseDynamics(rates, None, True),
            bare.inverse,
            5.0,
        ),
    ]
    arm = robot.GetActiveManipulator()
    if arm is not None:
        calls.append(
            ("CalculateJacobian of an arm : mj_jac", arm.CalculateJacobian, lambda: bare.jacobian(point), 10.0)
        )
    for label, ours, floor, limit in calls:
        measured, bared = take_turns([microseconds(ours, 50), microseconds(floor, 50)], 200)
        yield Row(f"{what}: {label}", "µs", measured, bared, limit)
    (hessian,) = take_turns([microseconds(lambda: robot.ComputeHessianTranslation(last, point), 10)], 100)
    yield Row(f"{what}: ComputeHessianTranslation", "µs", hessian)
    yield from _many(what, robot, bare)


def _many(what: str, robot: ravemj.Robot, bare: Bare) -> Iterator[Row]:
    moving = robot.qpos_indices >= 0
    if len(bare.qpos) != moving.sum():
        return  # mimic joints, which bare MuJoCo does not follow
    link = len(robot.GetLinks()) - 1
    values = np.random.default_rng(1).uniform(-1, 1, (MANY, robot.GetDOF())) * moving
    qpos = values[:, moving]
    jacobians = np.zeros((MANY, 6, robot.GetDOF()))
    torques = np.zeros((MANY, robot.GetDOF()))

    def loop_jacobians() -> None:
        for own, out in zip(qpos, jacobians, strict=True):
            bare.qpos[:] = own
            mujoco.mj_kinematics(bare.model, bare.data)
            mujoco.mj_comPos(bare.model, bare.data)
            bare.both(bare.data.xpos[bare.body])
            out[:3, moving], out[3:, moving] = bare.moving, bare.turning

    def loop_inverse() -> None:
        for own, out in zip(qpos, torques, strict=True):
            bare.qpos[:] = bare.qacc[:] = own
            bare.qvel[:] = 0.1 * own
            bare.inverse()
            out[moving] = bare.forces

    zeros = np.zeros(3)
    pairs: list[tuple[str, Callable[[], object], Callable[[], object], float]] = [
        ("batch_jacobians", lambda: robot.batch_jacobians(values, link, zeros), loop_jacobians, 1.5),
        (
            "batch_inverse_dynamics",
            lambda: robot.batch_inverse_dynamics(values, 0.1 * values, values),
            loop_inverse,
            1.0,
        ),
    ]
    for name, ours, floor, limit in pairs:
        batched, looped = (MANY / time * 1e6 for time in take_turns([microseconds(ours), microseconds(floor)], 15))
        label = f"{what}: configurations a second, {name} : a loop over MuJoCo"
        yield Row(label, "1/s", batched, looped, limit, more_is_better=True)
