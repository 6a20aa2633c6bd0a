"""All Jacobians of whole-body tasks in one array: the same numbers as one by one."""

import numpy as np
import pytest
from conftest import MODELS

import ravemj
from ravemj.engine.dynamics.stacked import with_base_columns


@pytest.mark.parametrize("base", [False, True])
@pytest.mark.parametrize(("name", "links"), [("biped.robot.xml", (3, 8, 21)), ("puma560.xml", (6,)), ("scara.dae", ())])
def test_rows_are_those_of_single_calls(name, links, base):
    robot = ravemj.load(MODELS / name).GetRobots()[0]
    lower, upper = robot.GetDOFLimits()
    robot.SetTransform(ravemj.matrixFromPose([0.8, 0.6, 0, 0, 0.3, 0.2, 0.1]))
    state = robot.simulation_state
    kinematics, dynamics = state.kinematics, state.dynamics
    dofs = np.arange(robot.GetDOF())[::-2]
    rows = dynamics.whole_body_rows(len(links), dofs, base=base)
    for part in (0.4, 0.6):
        robot.SetDOFValues(lower + (upper - lower) * part)
        points = np.array([robot.GetLinks()[link].GetTransform()[:3, 3] + [0.1, -0.2, 0.3] for link in links])
        points = points.reshape(-1, 3)
        filled = rows.filled(kinematics.body_ids[list(links)].tolist(), points)
        expected = dynamics.jacobians(links, points, dofs, base=base)
        np.testing.assert_allclose(filled[:-3], expected.reshape(-1, filled.shape[1]), atol=1e-14)
        com, turning = dynamics.com_jacobian()[:, dofs], np.zeros((1, 6, len(dofs)))
        turning[0, :3] = com
        arm = robot.GetCenterOfMass() - robot.GetTransform()[:3, 3]
        wanted = with_base_columns(turning, arm[None])[0, :3] if base else com
        np.testing.assert_allclose(filled[-3:], wanted, atol=1e-12)


def test_coupled_joints_have_none():
    state = ravemj.load(MODELS / "panda.xml").GetRobots()[0].simulation_state
    assert state.dynamics.whole_body_rows(1, np.arange(8), base=True) is None
