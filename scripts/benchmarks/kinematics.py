"""Joint values in, link poses out: one configuration after the other, and many at once."""

import tempfile
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import mujoco
import numpy as np

import ravemj
from benchmarks.measure import MODEL, ROOT, Row, microseconds, take_turns
from ravemj.core.transforms import Floats

AXES = ("1 0 0", "0 1 0", "0 0 1")
LIMITS = {
    "pendulum": (3.0, 2.0),
    "arm of 7 joints": (2.5, 2.0),
    "90 links": (1.5, 1.6),
    "PR2": (None, None),
    "Panda with gripper": (3.0, 2.0),
}
"""Greatest ratios of values alone, and of values and all poses."""

PR2 = "rdiankov+openrave/src/robots/pr2-beta-static.zae"

MANY = 600
"""Configurations of a batch."""


def rows() -> list[Row]:
    """Compare our calls with the MuJoCo calls that they stand for, for robots of several sizes."""
    with tempfile.TemporaryDirectory() as folder:
        return [row for name, robot in robots(Path(folder)) for row in _of(name, robot)]


def robots(folder: Path) -> Iterator[tuple[str, ravemj.Robot]]:
    """Yield robots of several sizes, with what they are; the PR2 where the corpus is present.

    Args:
        folder: Takes the files of those that are written.
    """
    paths = {
        "pendulum": MODEL,
        "arm of 7 joints": _write(folder / "arm.xml", [8]),
        "90 links": _write(folder / "large.xml", [15] * 6),
        "PR2": ROOT.parent / "shared" / "corpus" / "models" / PR2,
        "Panda with gripper": ROOT / "models" / "panda.xml",
    }
    for name, path in paths.items():
        if path.exists():
            with warnings.catch_warnings(action="ignore"):
                yield name, ravemj.load(path).GetRobots()[0]


def _write(path: Path, branches: list[int]) -> Path:
    """Write a robot of chains of links that start at a common one; every fifth joint of several chains is a weld."""
    bodies, joints = [_link("base", "")], list[str]()
    for branch, length in enumerate(branches):
        before = "base"
        for index in range(length - (branch == 0)):
            name = f"link{branch}_{index}"
            bodies.append(_link(name, before))
            weld = "<limits>0 0</limits>" if index % 5 == 4 and len(branches) > 1 else "<limits>-2 2</limits>"
            ends = f"<Body>{before}</Body><Body>{name}</Body><offsetfrom>{name}</offsetfrom>"
            joints.append(f"<Joint name='to_{name}' type='hinge'>{ends}<axis>{AXES[index % 3]}</axis>{weld}</Joint>")
            before = name
    path.write_text(f"<Robot name='robot'><KinBody>{''.join(bodies + joints)}</KinBody></Robot>")
    return path


def _link(name: str, before: str) -> str:
    place = f"<offsetfrom>{before}</offsetfrom><Translation>0.1 0.02 0.05</Translation>" if before else ""
    geometry = "<Geom type='box'><extents>0.05 0.02 0.02</extents></Geom>"
    return f"<Body name='{name}'>{place}<rotationaxis>0 0 1 10</rotationaxis>{geometry}</Body>"


def _of(what: str, robot: ravemj.Robot) -> Iterator[Row]:
    placed, posed = LIMITS[what]
    yield from _one(what, robot, posed)
    yield from _values_alone(what, robot, placed)
    yield from _getters(what, robot)
    if not robot.GetPassiveJoints():  # bare MuJoCo lets no joint follow another
        yield _many(what, robot)


class Bare:
    """MuJoCo without us."""

    def __init__(self, robot: ravemj.Robot) -> None:
        self.model = robot.GetEnv().model
        self.data = mujoco.MjData(self.model)
        self.qpos, self.xpos, self.xmat = self.data.qpos, self.data.xpos[1:], self.data.xmat[1:]
        self.data.qpos[:] = robot.GetEnv().data.qpos

    def place(self, qpos: Floats, transforms: Floats) -> None:
        """Write the poses of the links, without the last rows."""
        self.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, self.data)
        transforms[:, :3, 3] = self.xpos
        transforms[:, :3, :3] = self.xmat.reshape(-1, 3, 3)


def _middle(robot: ravemj.Robot) -> Floats:
    """Return joint values off zero, where sines and cosines have to be computed, within the limits."""
    lower, upper = robot.GetDOFLimits()
    return np.where(lower < upper, np.clip(0.5, lower, upper), 0.0)


def _one(what: str, robot: ravemj.Robot, limit: float | None) -> list[Row]:
    values = _middle(robot)
    robot.SetDOFValues(values)
    bare = Bare(robot)
    qpos = bare.qpos.copy()
    count = len(bare.xpos)

    def as_list() -> list[Floats]:
        robot.SetDOFValues(values)
        return robot.GetLinkTransformations()

    def as_array() -> Floats:
        robot.SetDOFValues(values)
        return robot.link_transforms()

    def floor() -> Floats:
        transforms = np.zeros((count, 4, 4))
        bare.place(qpos, transforms)
        transforms[:, 3, 3] = 1
        return transforms

    if not np.allclose(as_list(), floor(), rtol=0, atol=1e-13):
        raise RuntimeError("the poses differ")
    calls = max(1, 100 // count)  # short runs, which other programs seldom interrupt

    listed, arrayed, bared = take_turns(
        [microseconds(function, calls) for function in (as_list, as_array, floor)], 1000
    )
    return [
        Row(f"{what}: SetDOFValues + GetLinkTransformations : mj_kinematics, poses", "µs", listed, bared, limit),
        Row(f"{what}: SetDOFValues + link_transforms : mj_kinematics, poses", "µs", arrayed, bared, 2.5),
    ]


def _values_alone(what: str, robot: ravemj.Robot, limit: float | None) -> Iterator[Row]:
    values = _middle(robot)
    robot.SetDOFValues(values)
    bare, kinematics, plain = Bare(robot), robot.simulation_state.kinematics, values.tolist()
    qpos = bare.qpos.copy()

    def placed() -> None:
        robot.SetDOFValues(values)
        kinematics.place()  # what is asked for next would do it

    def placed_of_list() -> None:
        robot.SetDOFValues(plain)
        kinematics.place()

    def floor() -> None:
        bare.qpos[:] = qpos
        mujoco.mj_kinematics(bare.model, bare.data)

    ours, listed, bared = take_turns([microseconds(one, 20) for one in (placed, placed_of_list, floor)], 500)
    yield Row(f"{what}: SetDOFValues : qpos, mj_kinematics", "µs", ours, bared, limit)
    yield Row(f"{what}: SetDOFValues of a list : the same", "µs", listed, bared)


def _getters(what: str, robot: ravemj.Robot) -> Iterator[Row]:
    """Compare what loops call beside ``SetDOFValues`` with the least that numpy can do for it."""
    bare, values, place = Bare(robot), robot.GetDOFValues(), robot.GetTransform()
    last = robot.GetLinks()[-1].GetName()

    def pose() -> Floats:
        transform = np.eye(4)
        transform[:3, 3] = bare.xpos[-1]
        transform[:3, :3] = bare.xmat[-1].reshape(3, 3)
        return transform

    def entered() -> None:
        with robot:
            pass

    def listed() -> Floats:
        return robot.GetLinks()[-1].GetTransform()

    def found() -> Floats:
        link = robot.GetLink(last)
        assert link is not None
        return link.GetTransform()

    calls: list[tuple[str, Callable[[], object], float | None]] = [
        ("GetLinks()[-1].GetTransform()", listed, 2.0),
        ("GetLink(name).GetTransform()", found, None),
        ("GetDOFValues()", robot.GetDOFValues, None),
        ("GetActiveDOFValues()", robot.GetActiveDOFValues, None),
        ("SetActiveDOFValues", lambda: robot.SetActiveDOFValues(values), None),
        ("GetDOFLimits()", robot.GetDOFLimits, None),
        ("SetTransform", lambda: robot.SetTransform(place), None),
        ("GetJointFromDOFIndex", lambda: robot.GetJointFromDOFIndex(0), None),
        ("GetChain", lambda: robot.GetChain(0, len(robot.GetLinks()) - 1), None),
        ("ComputeAABB", robot.ComputeAABB, None),
        ("with robot:", entered, None),
    ]
    *measured, bared = take_turns([microseconds(call, 20) for _, call, _ in calls] + [microseconds(pose, 20)], 200)
    for (label, _, limit), ours in zip(calls, measured, strict=True):
        yield Row(f"{what}: {label} : a pose from xpos and xmat", "µs", ours, bared, limit)


def _many(what: str, robot: ravemj.Robot) -> Row:
    bare, moving = Bare(robot), robot.qpos_indices >= 0
    values = np.random.default_rng(1).uniform(-1, 1, (MANY, robot.GetDOF())) * moving
    qpos = values[:, moving]
    out = np.zeros((MANY, len(bare.xpos), 4, 4))
    out[:, :, 3, 3] = 1

    def loop() -> Floats:
        for own, transforms in zip(qpos, out, strict=True):
            bare.place(own, transforms)
        return out

    def batch() -> Floats:
        return robot.batch_link_transforms(values, out)

    if not np.allclose(loop().copy(), batch(), rtol=0, atol=1e-12):
        raise RuntimeError("the poses differ")
    batched, looped = (MANY / time * 1e6 for time in take_turns([microseconds(batch), microseconds(loop)], 50))
    label = f"{what}: configurations a second, batch_link_transforms : a loop over mj_kinematics, poses"
    return Row(label, "1/s", batched, looped, 1.5, more_is_better=True)
