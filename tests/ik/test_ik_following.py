"""Inverse kinematics of arms with joints that follow others."""

import pickle

import numpy as np
import pytest

import ravemj

_Type = ravemj.IkParameterization.Type
LINK = '<Body name="l{0}"><offsetfrom>l{1}</offsetfrom><Translation>{2}</Translation></Body>'
JOINT = (
    '<Joint name="j{0}" type="{3}"{4}><Body>l{1}</Body><Body>l{0}</Body><offsetfrom>l{0}</offsetfrom>'
    "<axis>{2}</axis><limits>{5}</limits></Joint>"
)
FREE = (
    ("0 0 1", "0 0 0.1", "hinge", ""),
    ("0 1 0", "0 0 0.2", "hinge", ""),
    ("0 1 0", "0.1 0 0.3", "hinge", ""),
    ("1 0 0", "0 0.05 0.3", "hinge", ""),
    ("0 1 0", "0.2 0 0", "hinge", ""),
    ("0 0 1", "0.1 0.1 0", "hinge", ""),
)


def following(number, equation):
    return f' enable="false" mimic_pos="{equation}"'


def inserted(place, equation, kind="hinge", axis="0 1 0"):
    """Return the joints of an arm with one more that follows others."""
    rows = list(FREE)
    rows.insert(place, (axis, "0.05 0.02 0.1", kind, equation))
    names = {f"q{number}": f"j{index + 1}" for number, index in enumerate(free(rows))}
    for short, name in names.items():
        rows[place] = (*rows[place][:3], rows[place][3].replace(short, name))
    return rows


def free(rows):
    return [index for index, row in enumerate(rows) if not row[3]]


def arm(rows, limits="-2.5 2.5", base="l0"):
    bodies = "".join(LINK.format(number + 1, number, row[1]) for number, row in enumerate(rows))
    joints = "".join(
        JOINT.format(number + 1, number, axis, kind, following(number, equation) if equation else "", limits)
        for number, (axis, _, kind, equation) in enumerate(rows)
    )
    env = ravemj.Environment()
    assert env.LoadData(
        f'<Robot name="r"><KinBody><Body name="l0"/>{bodies}{joints}</KinBody><Manipulator name="arm">'
        f"<base>{base}</base><effector>l{len(rows)}</effector></Manipulator></Robot>"
    )
    return env.GetRobots()[0]


def solved(robot, iktype=_Type.Transform6D):
    manip = robot.SetActiveManipulator("arm")
    assert ravemj.databases.inversekinematics.InverseKinematicsModel(robot, iktype=iktype).load()
    return manip


ARMS = {
    "last joint": inserted(6, "q5*0.5"),
    "first joint": inserted(0, "-q0"),
    "level": inserted(3, "-q1-q2"),
    "factor and offset": inserted(2, "0.7*q1+0.3"),
    "slider": inserted(4, "0.05*q3", kind="slider"),
    "formula": inserted(3, "0.5*sin(q2)+0.1*q1^2"),
    "follows what comes later": inserted(1, "q4+0.1*q5"),
}


@pytest.mark.filterwarnings("ignore:.*dropped-mimic")
@pytest.mark.parametrize("name", ARMS)
def test_poses_that_the_arm_had_are_reached_again(name):
    robot = arm(ARMS[name])
    manip = solved(robot)
    assert manip.GetArmDOF() == 6
    random = np.random.default_rng(7)
    for _ in range(4):
        robot.SetDOFValues(random.uniform(-1.2, 1.2, 6))
        T = manip.GetTransform()
        robot.SetDOFValues(np.zeros(6))
        values = manip.FindIKSolution(T, 0)
        robot.SetDOFValues(values, manip.GetArmIndices())
        np.testing.assert_allclose(manip.GetTransform(), T, atol=1e-8)
        np.testing.assert_array_equal(robot.GetDOFValues(manip.GetArmIndices()), values)


def test_limits_of_what_follows_are_kept():
    robot = arm(inserted(2, "3*q1"), limits="-1 1")
    manip = solved(robot)
    robot.SetDOFValues([0.1, 0.8, 0.2, 0.3, -0.4, 0.5])  # the follower stops at 1
    T = manip.GetTransform()
    assert robot.GetJoint("j3").GetValue(0) == 1
    solutions = manip.FindIKSolutions(T, 0)
    for values in solutions:
        robot.SetDOFValues(values, manip.GetArmIndices())
        np.testing.assert_allclose(manip.GetTransform(), T, atol=1e-8)
    assert len(solutions)


def test_a_leader_before_the_base_moves_the_arm_too():
    robot = arm(inserted(6, "q0*0.5"), base="l1")
    manip = solved(robot)
    assert sorted(manip.GetArmIndices()) == list(range(6))
    robot.SetDOFValues([0.4, 0.3, -0.2, 0.5, 0.6, 0.2])
    T_base_tool = np.linalg.inv(robot.GetLink("l1").GetTransform()) @ manip.GetTransform()
    solutions = manip.FindIKSolutions(manip.GetTransform(), 0)
    for values in solutions:
        robot.SetDOFValues(values, manip.GetArmIndices())
        reached = np.linalg.inv(robot.GetLink("l1").GetTransform()) @ manip.GetTransform()
        np.testing.assert_allclose(reached, T_base_tool, atol=1e-8)
    assert len(solutions)


def test_the_solver_can_be_pickled():
    robot = arm(ARMS["level"])
    manip = robot.SetActiveManipulator("arm")
    robot.SetDOFValues([0.3, 0.4, -0.2, 0.1, 0.6, 0.2])
    solver = manip.ik_solver()
    copied = pickle.loads(pickle.dumps(solver))
    values = robot.GetDOFValues(manip.GetArmIndices())
    np.testing.assert_allclose(copied.chain.forward(values), solver.chain.forward(values), atol=0)
    assert "numeric" in solver.describe()
