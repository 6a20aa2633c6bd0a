"""What loops call most, one call at a time, against the least that MuJoCo and numpy can do for it.

    PYTHONPATH=scripts:. python -c "from benchmarks.calls import table; print(table())"

prints the table of docs/api.md.
"""

import tempfile
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

import ravemj
from benchmarks.collision import add_boxes
from benchmarks.kinematics import robots
from benchmarks.measure import Row, microseconds, take_turns
from ravemj.core.transforms import Floats

NAMES = {
    "arm of 7 joints": "arm, 7 joints",
    "Panda with gripper": "Panda, a mimic joint, IK, 10 boxes",
    "90 links": "90 links",
    "PR2": "PR2, meshes",
}


POINT = np.array([0.1, 0.2, 0.3])

RAYS = np.hstack([np.tile([0.0, 0.0, 3.0], (100, 1)), np.random.default_rng(1).uniform(-6, 6, (100, 3))])
RAYS[0, 3:] = 0, 0, -6


class Call(NamedTuple):
    """A call and what it is compared with.

    Attributes:
        name: The call.
        ours: Makes it.
        floor: What it is compared with; None: MuJoCo and numpy have nothing like it.
        bare: Does the same with MuJoCo and numpy.
    """

    name: str
    ours: Callable[[], object]
    floor: str = ""
    bare: Callable[[], object] | None = None


def rows() -> list[Row]:
    """Compare all calls, for several robots."""
    return [
        Row(f"{robot}: {call.name}{call.floor and f' : {call.floor}'}".replace("`", ""), "µs", ours, bare)
        for robot, call, ours, bare in _measured()
    ]


def _measured() -> Iterator[tuple[str, Call, float, float | None]]:
    with tempfile.TemporaryDirectory() as folder:
        for name, robot in robots(Path(folder)):
            if name not in NAMES:
                continue
            if name.startswith("Panda"):
                add_boxes(robot.GetEnv(), 0.6)
                model = ravemj.databases.inversekinematics.InverseKinematicsModel(
                    robot, ravemj.IkParameterizationType.Transform6D
                )
                model.load()
            for call in _calls(robot):
                with warnings.catch_warnings(action="ignore"):
                    yield name, call, *_times(call)


def _times(call: Call) -> tuple[float, float | None]:
    """Return the times of a call and of what it is compared with [µs]."""
    functions = [call.ours] if call.bare is None else [call.ours, call.bare]
    (first,) = take_turns([microseconds(call.ours)], 3)
    calls = max(1, min(50, int(2000 / max(first, 1))))
    ours, *bare = take_turns([microseconds(function, calls) for function in functions], 30)
    return ours, bare[0] if bare else None


class Bare:
    """MuJoCo and numpy without us, in the robot's world and configuration."""

    def __init__(self, robot: ravemj.Robot) -> None:
        self.model = model = robot.GetEnv().model
        self.data = data = mujoco.MjData(model)
        data.qpos[:] = robot.GetEnv().data.qpos
        data.qvel[:] = 0.1
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        self._qpos, self._place = data.qpos.copy(), robot.GetTransform()
        self._moving, self._turning, self._forces = np.zeros((3, model.nv)), np.zeros((3, model.nv)), np.zeros(model.nv)

    def place(self) -> None:
        """Set joint values."""
        self.data.qpos[:] = self._qpos
        mujoco.mj_kinematics(self.model, self.data)

    def poses(self) -> Floats:
        """Set joint values, and return all poses."""
        self.place()
        found = np.zeros((self.model.nbody - 1, 4, 4))
        found[:, :3, 3] = self.data.xpos[1:]
        found[:, :3, :3] = self.data.xmat[1:].reshape(-1, 3, 3)
        found[:, 3, 3] = 1
        return found

    def pose(self) -> Floats:
        """Return the pose of the last link."""
        found = np.eye(4)
        found[:3, 3] = self.data.xpos[-1]
        found[:3, :3] = self.data.xmat[-1].reshape(3, 3)
        return found

    def move(self) -> None:
        """Move the robot."""
        self.model.body_pos[1] = self._place[:3, 3]
        mujoco.mju_mat2Quat(self.model.body_quat[1], self._place[:3, :3].ravel())

    def restore(self) -> None:
        """Copy joint values, and put them back."""
        self.data.qpos[:] = self.data.qpos.copy()

    def jacobian(self, turning: Floats | None = None) -> None:
        """Write the Jacobian of a point of the last link, and perhaps that of its rotation."""
        mujoco.mj_jac(self.model, self.data, self._moving, turning, POINT, self.model.nbody - 1)

    def both_jacobians(self) -> None:
        """Write both Jacobians."""
        self.jacobian(self._turning)

    def inverse(self) -> None:
        """Write the torques."""
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        self.velocities()
        mujoco.mj_rne(self.model, self.data, 1, self._forces)

    def velocities(self) -> None:
        """Compute the velocities of the links."""
        mujoco.mj_comVel(self.model, self.data)

    def accelerations(self) -> None:
        """Compute the accelerations of the links."""
        self.velocities()
        mujoco.mj_rnePostConstraint(self.model, self.data)

    def collide(self) -> None:
        """Set joint values, and look for contacts."""
        self.place()
        mujoco.mj_collision(self.model, self.data)

    def cast(self) -> None:
        """Cast a ray."""
        geom, normal = np.empty(1, dtype=np.int32), np.empty(3)
        mujoco.mj_ray(self.model, self.data, RAYS[0, :3], RAYS[0, 3:], None, True, -1, geom, normal)

    def cast_many(self) -> None:
        """Cast 100 rays from a point."""
        geoms, distances = np.empty(100, dtype=np.int32), np.empty(100)
        start, ways, far = RAYS[0, :3], RAYS[:, 3:].ravel(), mujoco.mjMAXVAL
        mujoco.mj_multiRay(self.model, self.data, start, ways, None, True, -1, geoms, distances, None, 100, far)


def _calls(robot: ravemj.Robot) -> Iterator[Call]:
    """Yield the calls, in a configuration off zero."""
    lower, upper = robot.GetDOFLimits()
    values = np.where(lower < upper, np.clip(0.5, lower, upper), 0.0)
    robot.SetDOFValues(values)
    bare = Bare(robot)
    yield from _of_configuration(robot, bare, values)
    yield from _of_motion(robot, bare)
    yield from _of_world(robot, bare, values)
    yield from _of_arm(robot, bare)


def _of_configuration(robot: ravemj.Robot, bare: Bare, values: Floats) -> Iterator[Call]:
    place, transforms, indices = robot.GetTransform(), robot.GetLinkTransformations(), np.arange(robot.GetDOF())
    spec, numbers = robot.GetConfigurationSpecification(), robot.GetConfigurationValues()

    def set_and_get() -> object:
        robot.SetDOFValues(values)
        return robot.GetLinkTransformations()

    def save() -> None:
        with robot:
            pass

    def pose_of_last() -> Floats:
        return robot.GetLinks()[-1].GetTransform()

    def put_back() -> None:
        robot.SetLinkTransformations(transforms)

    def extract() -> object:
        return spec.ExtractJointValues(numbers, robot, indices)

    yield Call("`SetDOFValues`", lambda: robot.SetDOFValues(values), "`qpos`, `mj_kinematics`", bare.place)
    yield Call("`SetDOFValues` + `GetLinkTransformations`", set_and_get, "the same, and all poses", bare.poses)
    yield Call("`GetDOFValues`", robot.GetDOFValues, "a copy of `qpos`", bare.data.qpos.copy)
    yield Call("`GetDOFLimits`", robot.GetDOFLimits, "a copy of `jnt_range`", bare.model.jnt_range.T.copy)
    yield Call("`GetLinks`", robot.GetLinks)
    yield Call("`GetLinks()[-1].GetTransform()`", pose_of_last, "a pose", bare.pose)
    yield Call("`GetTransform`", robot.GetTransform, "a pose", bare.pose)
    yield Call("`SetTransform`", lambda: robot.SetTransform(place), "`body_pos`, `mju_mat2Quat`", bare.move)
    yield Call("`SetLinkTransformations`", put_back, "`mj_kinematics`, all poses", bare.poses)
    yield Call("`with robot:`", save, "`qpos`, copied and put back", bare.restore)
    yield Call("`GetJoints()[0].GetValue(0)`", lambda: robot.GetJoints()[0].GetValue(0))
    yield Call("`GetConfigurationValues`", robot.GetConfigurationValues)
    yield Call("`ExtractJointValues`", extract, "`array[indices]`", lambda: numbers[indices])
    yield Call("`GetKinematicsGeometryHash`", robot.GetKinematicsGeometryHash)


def _of_motion(robot: ravemj.Robot, bare: Bare) -> Iterator[Call]:
    link, rates = len(robot.GetLinks()) - 1, np.full(robot.GetDOF(), 0.1)
    robot.SetDOFVelocities(rates)

    def jacobian() -> Floats:
        return robot.ComputeJacobianTranslation(link, POINT)

    yield Call("`ComputeJacobianTranslation`", jacobian, "`mj_jac`", bare.jacobian)
    yield Call("`ComputeJacobianAxisAngle`", lambda: robot.ComputeJacobianAxisAngle(link), "`mj_jac`", bare.jacobian)
    yield Call("`ComputeInverseDynamics`", lambda: robot.ComputeInverseDynamics(rates), "up to `mj_rne`", bare.inverse)
    yield Call("`GetDOFVelocities`", robot.GetDOFVelocities, "a copy of `qvel`", bare.data.qvel.copy)
    yield Call("`SetDOFVelocities`", lambda: robot.SetDOFVelocities(rates), "`mj_comVel`", bare.velocities)
    yield Call("`SetVelocity`", lambda: robot.SetVelocity([1, 0, 0], [0, 0, 1]))
    yield Call("`GetLinkVelocities`", robot.GetLinkVelocities, "a copy of `cvel`", bare.data.cvel.copy)
    yield Call(
        "`GetLinkAccelerations`",
        lambda: robot.GetLinkAccelerations(rates),
        "`mj_rnePostConstraint`",
        bare.accelerations,
    )
    yield Call("`GetJoints()[-1].GetVelocities()`", robot.GetJoints()[-1].GetVelocities)


def _of_world(robot: ravemj.Robot, bare: Bare, values: Floats) -> Iterator[Call]:
    env, ray, carrier = robot.GetEnv(), ravemj.Ray(RAYS[0, :3], RAYS[0, 3:]), robot.GetLinks()[-1]

    def check() -> None:
        robot.SetDOFValues(values)
        env.CheckCollision(robot)

    def check_itself() -> None:
        robot.SetDOFValues(values)
        robot.CheckSelfCollision()

    detection = "`mj_kinematics`, `mj_collision`"
    yield Call("`SetDOFValues` + `CheckCollision(robot)`", check, detection, bare.collide)
    yield Call("`SetDOFValues` + `CheckSelfCollision`", check_itself, detection, bare.collide)
    yield Call("`CheckCollision(ray)`", lambda: env.CheckCollision(ray), "`mj_ray`", bare.cast)
    yield Call("`CheckCollisionRays`, 100 rays", lambda: env.CheckCollisionRays(RAYS), "`mj_multiRay`", bare.cast_many)
    yield Call("`ComputeAABB`", robot.ComputeAABB)
    yield Call("`GetLinks()[-1].ComputeAABB()`", carrier.ComputeAABB)
    thing = ravemj.RaveCreateKinBody(env, "")
    assert thing is not None
    thing.InitFromBoxes([[0, 0, 9, 0.1, 0.1, 0.1]])
    thing.SetName("held")
    env.Add(thing)

    def grab() -> None:
        robot.Grab(thing, carrier)
        robot.Release(thing)

    yield Call("`Grab` + `Release`", grab)
    env.Remove(thing)


def _of_arm(robot: ravemj.Robot, bare: Bare) -> Iterator[Call]:
    arm = robot.GetActiveManipulator()
    if arm is None:
        return
    goal, alone = arm.GetTransform(), ravemj.IkFilterOptions.IgnoreSelfCollisions
    yield Call("`manip.CalculateJacobian`", arm.CalculateJacobian, "`mj_jac`", bare.jacobian)
    yield Call("`manip.GetTransform`", arm.GetTransform, "a pose", bare.pose)
    if arm.GetIkSolver() is not None:
        yield Call("`FindIKSolution(goal, 0)`", lambda: arm.FindIKSolution(goal, 0))
        yield Call("`FindIKSolution(goal, IgnoreSelfCollisions)`", lambda: arm.FindIKSolution(goal, alone))


def table() -> str:
    """Return the measurements as a table in Markdown: microseconds a call, and how often the floor fits in."""
    cells: dict[tuple[str, str], dict[str, str]] = {}
    for robot, call, ours, bare in _measured():
        ratio = "" if bare is None else f" ({ours / bare:.1f}x)"
        cells.setdefault((call.name, call.floor), {})[robot] = f"{ours:.{3 if ours < 1000 else 4}g}{ratio}"
    lines = [f"| call | compared with | {' | '.join(NAMES.values())} |", "|---|---|" + "---:|" * len(NAMES)]
    lines += [
        f"| {name} | {floor} | {' | '.join(found.get(robot, '') for robot in NAMES)} |"
        for (name, floor), found in cells.items()
    ]
    return "\n".join(lines)
