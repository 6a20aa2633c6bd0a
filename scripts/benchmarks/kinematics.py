"""Joint values in, link poses out: one configuration after the other, and many at once."""

import tempfile
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np

import ravemj
from benchmarks.measure import MODEL, Row, microseconds, take_turns
from ravemj.transforms import Floats

AXES = ("1 0 0", "0 1 0", "0 0 1")
MANY = 2000
"""Configurations of a batch."""


def rows() -> list[Row]:
    """Compare our calls with the MuJoCo calls that they stand for, for robots of several sizes."""
    with tempfile.TemporaryDirectory() as folder:
        arm = _write(Path(folder) / "arm.xml", [8])
        large = _write(Path(folder) / "large.xml", [15] * 6)
        return [*_of("pendulum", MODEL, 5.0), *_of("arm of 7 joints", arm, 4.5), *_of("90 links", large, 3.0)]


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


def _of(what: str, path: Path, limit: float) -> list[Row]:
    env = ravemj.load(path)
    robot = env.GetRobots()[0]
    model, data = env.model, mujoco.MjData(env.model)
    qpos, xpos, xmat = data.qpos, data.xpos[1:], data.xmat[1:]
    moving = robot.qpos_indices >= 0
    values = np.where(moving, 0.5, 0.0)
    places = robot.qpos_indices[moving]
    place: slice | np.ndarray = slice(None) if np.array_equal(places, np.arange(model.nq)) else places

    def bare_of(values: Floats) -> Callable[[], Floats]:
        own = values[moving]

        def bare() -> Floats:
            qpos[place] = own
            mujoco.mj_kinematics(model, data)
            transforms = np.zeros((len(xpos), 4, 4))
            transforms[:, :3, 3] = xpos
            transforms[:, :3, :3] = xmat.reshape(-1, 3, 3)
            transforms[:, 3, 3] = 1
            return transforms

        return bare

    def as_list() -> list[Floats]:
        robot.SetDOFValues(values)
        return robot.GetLinkTransformations()

    def as_array() -> Floats:
        robot.SetDOFValues(values)
        return robot.link_transforms()

    many = np.random.default_rng(1).uniform(-1, 1, (MANY, robot.GetDOF())) * moving
    out = np.empty((MANY, len(xpos), 4, 4))

    def batch() -> Floats:
        return robot.batch_link_transforms(many, out)

    def loop() -> Floats:
        own = many[:, moving]
        for index in range(MANY):
            qpos[place] = own[index]
            mujoco.mj_kinematics(model, data)
            transforms = out[index]
            transforms[:, :3, 3] = xpos
            transforms[:, :3, :3] = xmat.reshape(-1, 3, 3)
        return out

    bare = bare_of(values)
    if not (np.allclose(as_list(), bare(), rtol=0, atol=1e-13) and np.allclose(batch().copy(), loop(), atol=1e-12)):
        raise RuntimeError("the poses differ")
    calls = max(1, 800 // len(xpos) // 8)  # short runs, which other programs seldom interrupt
    timed = [microseconds(function, calls) for function in (as_list, as_array, bare)]
    listed, arrayed, floor = take_turns(timed, 1000)
    batched, looped = take_turns([microseconds(batch), microseconds(loop)], 20)
    return [
        Row(f"{what}: SetDOFValues + GetLinkTransformations : mj_kinematics, poses", "µs", listed, floor, limit),
        Row(f"{what}: SetDOFValues + link_transforms : mj_kinematics, poses", "µs", arrayed, floor, 2.5),
        Row(
            f"{what}: configurations a second, batch_link_transforms : a loop over mj_kinematics, poses",
            "1/s",
            MANY / batched * 1e6,
            MANY / looped * 1e6,
            1.5,
            more_is_better=True,
        ),
    ]
