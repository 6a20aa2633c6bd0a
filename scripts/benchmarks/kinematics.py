"""Joint values in, link poses out."""

import mujoco
import numpy as np

import ravemj
from benchmarks.measure import MODEL, Row, microseconds, take_turns
from ravemj.transforms import Floats


def rows() -> list[Row]:
    """Compare ``SetDOFValues`` and ``GetLinkTransformations`` with the MuJoCo calls that they stand for."""
    env = ravemj.load(MODEL)
    robot = env.GetRobots()[0]
    model, data = env.model, mujoco.MjData(env.model)
    qpos, xpos, xmat = data.qpos, data.xpos[1:], data.xmat[1:]
    values = np.full(robot.GetDOF(), 0.5)

    def ours() -> list[Floats]:
        robot.SetDOFValues(values)
        return robot.GetLinkTransformations()

    def bare() -> Floats:
        qpos[:] = values
        mujoco.mj_kinematics(model, data)
        transforms = np.zeros((len(xpos), 4, 4))
        transforms[:, :3, 3] = xpos
        transforms[:, :3, :3] = xmat.reshape(-1, 3, 3)
        transforms[:, 3, 3] = 1
        return transforms

    if not np.array_equal(ours(), bare()):
        raise RuntimeError("the poses differ")
    measured, floor = take_turns([microseconds(ours, 100), microseconds(bare, 100)], 1000)
    what = "SetDOFValues + GetLinkTransformations : mj_kinematics + copies of xpos, xmat"
    return [Row(what, "µs", measured, floor, 5.0)]
