"""How many modules a call of the API passes: the shorter the walk, the sooner a reader has seen all of it."""

import sys
from pathlib import Path

import ravemj

PACKAGE = str(Path(ravemj.__file__).parent)


def modules_passed(call):
    """Files of the package in which functions run during a call."""
    found = set()

    def note(frame, event, argument):
        del argument
        if event == "call" and frame.f_code.co_filename.startswith(PACKAGE):
            found.add(frame.f_code.co_filename.removeprefix(PACKAGE))

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        call()
    finally:
        sys.setprofile(before)
    return found


def test_walks_through_manipulation_are_short(models):
    env = ravemj.load(models / "puma560.xml")
    env.StopSimulation()
    robot = env.GetRobots()[0]
    kind = ravemj.IkParameterizationType.Transform6D
    assert ravemj.databases.inversekinematics.InverseKinematicsModel(robot, iktype=kind).load()
    arm, helper = robot.GetActiveManipulator(), ravemj.interfaces.BaseManipulation(robot)
    robot.SetDOFValues([0.2] * robot.GetDOF())
    goal, T_world_tool = arm.GetArmDOFValues() + 0.1, arm.GetTransform()
    walks = {
        50: lambda: helper.MoveManipulator(goal, execute=False, outputtrajobj=True),
        40: lambda: arm.FindIKSolution(T_world_tool, ravemj.IkFilterOptions.CheckEnvCollisions),
    }
    for most, call in walks.items():
        call()  # warm
        passed = modules_passed(call)
        assert len(passed) <= most, sorted(passed)
        assert any(name.startswith("/manipulation/") for name in passed)
