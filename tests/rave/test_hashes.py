"""Hashes of a robot after each kind of change: which change and which do not."""

import numpy as np
import pytest

import ravemj
from ravemj import IkParameterizationType, RaveCreateKinBody, matrixFromAxisAngle, matrixFromPose

ROBOT = """<Environment><Robot name="r"><KinBody>
<Body name="a"><Geom type="box"><extents>.1 .1 .1</extents></Geom></Body>
<Body name="b"><Translation>.3 0 .1</Translation><Geom type="box"><extents>.1 .03 .04</extents></Geom></Body>
<Body name="c"><offsetfrom>b</offsetfrom><Translation>.3 0 0</Translation>
<Geom type="sphere"><radius>.03</radius></Geom></Body>
<Joint name="j0" type="hinge"><Body>a</Body><Body>b</Body><offsetfrom>b</offsetfrom><axis>0 0 1</axis></Joint>
<Joint name="j1" type="slider"><Body>b</Body><Body>c</Body><offsetfrom>c</offsetfrom><axis>0 1 0</axis>
<limits>-.1 .3</limits></Joint>
</KinBody><Manipulator name="m"><base>a</base><effector>b</effector><joints>j1</joints>
<closingdirection>1</closingdirection></Manipulator></Robot></Environment>"""
HASHES = {
    "body": lambda robot: robot.GetKinematicsGeometryHash(),
    "robot": lambda robot: robot.GetRobotStructureHash(),
    "manipulator": lambda robot: robot.GetManipulators()[0].GetStructureHash(),
    "kinematics": lambda robot: robot.GetManipulators()[0].GetKinematicsStructureHash(),
    "pose": lambda robot: inverse_kinematics(robot, IkParameterizationType.Transform6D),
    "place": lambda robot: inverse_kinematics(robot, IkParameterizationType.Translation3D),
    "ray": lambda robot: inverse_kinematics(robot, IkParameterizationType.Ray4D),
}
TOOLS = {"robot", "manipulator", "kinematics"}
ALL = set(HASHES)


def inverse_kinematics(robot, kind):
    return robot.GetManipulators()[0].GetInverseKinematicsStructureHash(kind)


def load(text=ROBOT):
    env = ravemj.Environment()
    assert env.LoadData(text)
    return env.GetRobots()[0]


def grab(robot):
    box = RaveCreateKinBody(robot.GetEnv(), "")
    box.InitFromBoxes(np.array([[0, 0, 2, 0.1, 0.1, 0.1]]))
    box.SetName("box")
    robot.GetEnv().Add(box)
    robot.Grab(box)


def add_manipulator(robot):
    info = robot.GetManipulators()[0].GetInfo()
    info._name = "other"
    robot.AddManipulator(info)


def arm(robot):
    return robot.GetManipulators()[0]


def shape(robot):
    return robot.GetLinks()[1].GetGeometries()[0]


CALLS = {
    "values": (lambda robot: robot.SetDOFValues([0.1, 0.2]), set()),
    "place": (lambda robot: robot.SetTransform(matrixFromAxisAngle([0, 0, 1.0])), set()),
    "limits": (lambda robot: robot.SetDOFLimits([-1, 0], [1, 0.1]), set()),
    "speeds": (lambda robot: robot.SetDOFVelocityLimits([1, 1]), set()),
    "accelerations": (lambda robot: robot.SetDOFAccelerationLimits([1, 1]), set()),
    "torques": (lambda robot: robot.SetDOFTorqueLimits([1, 1]), set()),
    "weights": (lambda robot: robot.SetDOFWeights([3, 3]), set()),
    "resolutions": (lambda robot: robot.SetDOFResolutions([0.3, 0.3]), set()),
    "velocities": (lambda robot: robot.SetDOFVelocities([0.1, 0.1]), set()),
    "colour": (lambda robot: shape(robot).SetDiffuseColor([1, 0, 0]), set()),
    "transparency": (lambda robot: shape(robot).SetTransparency(0.5), set()),
    "visible": (lambda robot: robot.SetVisible(False), set()),
    "enabled": (lambda robot: robot.Enable(False), set()),
    "name": (lambda robot: robot.SetName("x"), set()),
    "name of arm": (lambda robot: arm(robot).SetName("x"), set()),
    "active": (lambda robot: robot.SetActiveDOFs([1]), set()),
    "grabbed": (grab, set()),
    "removed": (lambda robot: robot.GetEnv().Remove(robot), set()),
    "user data": (lambda robot: robot.SetUserData("a", 1), set()),
    "parameters": (lambda robot: robot.GetLinks()[0].SetFloatParameters("a", [1.0]), set()),
    "mass": (lambda robot: robot.GetLinks()[1].SetMass(7), {"body"}),
    "moments": (lambda robot: robot.GetLinks()[1].SetPrincipalMomentsOfInertia([1, 2, 2.5]), {"body"}),
    "mass frame": (
        lambda robot: robot.GetLinks()[1].SetLocalMassFrame(matrixFromPose([1, 0, 0, 0, 1, 0, 0])),
        {"body"},
    ),
    "tool": (
        lambda robot: arm(robot).SetLocalToolTransform(matrixFromPose([1, 0, 0, 0, 0.1, 0, 0])),
        TOOLS | {"place", "ray"},
    ),
    "tool direction": (lambda robot: arm(robot).SetLocalToolDirection([1, 0, 0]), TOOLS | {"ray"}),
    "another arm": (add_manipulator, {"robot"}),
}


@pytest.mark.parametrize("call", CALLS)
def test_after_a_call(call):
    change, expected = CALLS[call]
    robot = load()
    before = {name: make(robot) for name, make in HASHES.items()}
    change(robot)
    assert {name for name, make in HASHES.items() if make(robot) != before[name]} == expected
    assert all(len(text) == 32 for text in before.values())


TEXTS = {
    "again": ("", "", set()),
    "box": (".1 .03 .04", ".1 .03 .05", {"body", "robot"}),
    "rounded": ("<Translation>.3 0 .1", "<Translation>.30000001 0 .1", set()),
    "offset": ("<Translation>.3 0 .1", "<Translation>.31 0 .1", ALL),
    "axis": ("<axis>0 0 1</axis>", "<axis>0 0 -1</axis>", ALL),
    "other axis": ("<axis>0 1 0</axis>", "<axis>0 -1 0</axis>", {"body", "robot"}),
    "limits": ("-.1 .3", "-.2 .3", set()),
    "joint": ('"j0"', '"elbow"', set()),
    "gripper": ("j1", "finger", {"robot", "manipulator"}),
    "closing": ("<closingdirection>1", "<closingdirection>-1", {"robot", "manipulator"}),
    "no gripper": ("<joints>j1</joints>", "", {"robot", "manipulator"}),
}


@pytest.mark.parametrize("change", TEXTS)
def test_of_another_file(change):
    old, new, expected = TEXTS[change]
    one, other = load(), load(ROBOT.replace(old, new) if old else ROBOT)
    assert {name for name, make in HASHES.items() if make(one) != make(other)} == expected
