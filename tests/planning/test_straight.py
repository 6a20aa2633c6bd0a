"""``MoveHandStraight`` from a pose that has several solutions of inverse kinematics."""

import pytest

import ravemj

DIRECTION = [0.4, -0.8, 0.3]
STEP = 0.02


@pytest.fixture
def robot(models):
    env = ravemj.load(models / "puma560.xml")
    env.StopSimulation()
    robot = env.GetRobots()[0]
    kind = ravemj.IkParameterizationType.Transform6D
    model = ravemj.databases.inversekinematics.InverseKinematicsModel(robot, iktype=kind)
    if not model.load():
        model.autogenerate()
    return robot


def steps(helper, **options):
    """How many steps the tool goes, at most 25."""
    try:
        traj = helper.MoveHandStraight(
            DIRECTION, stepsize=STEP, maxsteps=25, execute=False, outputtrajobj=True, **options
        )
    except ravemj.PlanningError:
        return 0
    return traj.GetNumWaypoints() - 1


def test_the_solution_that_goes_far_enough_is_found_whatever_the_arm_does_now(robot):
    arm, helper = robot.GetActiveManipulator(), ravemj.interfaces.BaseManipulation(robot)
    indices = arm.GetArmIndices()
    robot.SetDOFValues([1.2, 0.1, 0.785, -1.0, 0.6, 0.0], indices)
    start = arm.GetTransform()
    found = arm.FindIKSolutions(start, ravemj.IkFilterOptions.CheckEnvCollisions)
    reached = []
    for row in found:
        robot.SetDOFValues(row, indices)
        reached.append(steps(helper))
    assert min(reached) < max(reached)  # else this tests nothing
    for row in found:
        robot.SetDOFValues(row, indices)
        assert steps(helper, starteematrix=start, minsteps=max(reached)) == max(reached)
        assert steps(helper, starteematrix=start, minsteps=max(reached) + 1) == 0
        assert robot.GetDOFValues(indices) == pytest.approx(row)
