"""Bodies that are connected to a robot: parts of it while they are active and it is in an environment."""

import numpy as np
import pytest
from conftest import MODELS

import ravemj

ARM = [0.1, 0.4, -0.3, 0.2, 0.6, -0.1]
T_LINK_TOOL = ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, 0.2])


def gripper(**changes):
    """A palm with two fingers, of which one follows the other."""
    box = ravemj.GeometryInfo(_type=ravemj.GeometryType.Box, _vGeomData=[0.01, 0.01, 0.05])
    fingers = [
        ravemj.LinkInfo(_name=name, _t=ravemj.matrixFromPose([1, 0, 0, 0, y, 0, 0.1]), _vgeometryinfos=[box], _mass=0.1)
        for name, y in (("left", -0.05), ("right", 0.05))
    ]
    hinge = {
        **{"_type": ravemj.JointType.Revolute, "_linkname0": "palm", "_vaxes": [[0, 1, 0]]},
        **{"_vlowerlimit": [-1], "_vupperlimit": [1]},
    }
    fields = {
        "_name": "tool",
        "_linkname": "link6",
        "_trelative": T_LINK_TOOL,
        "_linkInfos": [ravemj.LinkInfo(_name="palm", _mass=1.0), *fingers],
        "_jointInfos": [
            ravemj.JointInfo(_name="close", _linkname1="left", **hinge),
            ravemj.JointInfo(
                _name="follow", _linkname1="right", _vmimic=[["-close", "|close -1", ""]], _bIsActive=False, **hinge
            ),
        ],
        "_manipulatorInfos": [
            ravemj.ManipulatorInfo(
                _name="hand", _sBaseLinkName="base", _sEffectorLinkName="palm", _vGripperJointNames=["close"]
            )
        ],
        "_attachedSensorInfos": [ravemj.AttachedSensorInfo(_name="eye", _linkname="palm", _sensorname="BaseCamera")],
        "_gripperInfos": [ravemj.GripperInfo(_name="two", _gripperJointNames=["close"])],
    }
    return ravemj.ConnectedBodyInfo(**{**fields, **changes})


@pytest.fixture
def env():
    env = ravemj.load(MODELS / "puma560.xml")
    yield env
    env.Destroy()


@pytest.fixture
def robot(env):
    robot = env.GetRobots()[0]
    robot.SetDOFValues(ARM)
    return robot


def test_parts_come_and_go_with_the_robot(env, robot):
    before = robot.GetLinkTransformations()
    env.Remove(robot)
    tool = robot.AddConnectedBody(gripper())
    assert tool.SetActive(True)
    assert not tool.SetActive(1)
    assert tool.GetResolvedLinks() == [None] * 3
    env.Add(robot)
    assert [link.GetName() for link in robot.GetLinks()][7:] == ["tool_palm", "tool_left", "tool_right"]
    assert [joint.GetName() for joint in robot.GetJoints()][6:] == ["tool_close"]
    np.testing.assert_allclose(robot.GetLinkTransformations()[:7], before, atol=1e-12)
    np.testing.assert_allclose(robot.GetDOFValues(), [*ARM, 0], atol=1e-12)
    palm, _, right = tool.GetResolvedLinks()
    for values in (ARM, [0.5, 0, 0.2, 0, -0.3, 0]):
        robot.SetDOFValues([*values, 0.4])
        np.testing.assert_allclose(palm.GetTransform(), robot.GetLink("link6").GetTransform() @ T_LINK_TOOL, atol=1e-12)
        np.testing.assert_allclose(tool.GetTransform(), palm.GetTransform(), atol=1e-12)
        turn = ravemj.axisAngleFromRotationMatrix(palm.GetTransform()[:3, :3].T @ right.GetTransform()[:3, :3])
        np.testing.assert_allclose(turn, [0, -0.4, 0], atol=1e-12)
    hand = robot.GetManipulator("tool_hand")
    assert [hand] == tool.GetResolvedManipulators()
    assert tool.CanProvideManipulator("tool_hand")
    assert not tool.CanProvideManipulator("hand")
    assert (list(hand.GetArmIndices()), list(hand.GetGripperIndices())) == ([0, 1, 2, 3, 4, 5], [6])
    assert robot.GetAttachedSensor("tool_eye").GetAttachingLink() == palm
    assert robot.GetGripperInfo("tool_two")._gripperJointNames == ["tool_close"]
    tool_joint, shape = robot.GetJoint("tool_close"), right.GetGeometries()[0]
    robot.GetJoint("joint1").SetVelocityLimits([0.125])
    saver = robot.CreateRobotStateSaver()
    env.Remove(robot)
    assert len(robot.GetLinks()) == 7
    assert robot.GetGripperInfos() == []
    with pytest.raises(ravemj.openrave_exception, match="10 links and 7 DOFs"):
        saver.Restore()
    for gone in (palm, tool_joint, hand, shape):
        with pytest.raises(ravemj.openrave_exception, match="any more"):
            gone.GetName()
    env.Add(robot)
    assert robot.GetDOF() == 7
    assert robot.GetDOFVelocityLimits()[0] == 0.125


def test_the_description_keeps_them_apart(env, robot):
    env.Remove(robot)
    robot.AddConnectedBody(gripper(_bIsActive=1))
    env.Add(robot)
    info = robot.ExtractInfo()
    assert len(info._vLinkInfos) == 7
    assert info._vConnectedBodyInfos == [gripper(_bIsActive=1)]
    copies = [env.CloneSelf(ravemj.CloningOptions.Bodies), ravemj.Environment()]
    copies[1].LoadJSON(env.ExtractInfo().SerializeJSON())
    for copy in copies:
        twin = copy.GetRobots()[0]
        assert [link.GetName() for link in twin.GetLinks()] == [link.GetName() for link in robot.GetLinks()]
        np.testing.assert_allclose(twin.GetLinkTransformations(), robot.GetLinkTransformations(), atol=1e-9)
        assert twin.GetConnectedBodyActiveStates() == [1]
        copy.Remove(twin)
        assert len(twin.GetLinks()) == 7
        copy.Destroy()


def test_what_is_refused_changes_nothing(env, robot):
    with pytest.raises(ravemj.openrave_exception, match="in an environment"):
        robot.AddConnectedBody(gripper())
    env.Remove(robot)
    for wrong in ({"_name": ""}, {"_linkname": "link7"}):
        with pytest.raises(ravemj.openrave_exception):
            robot.AddConnectedBody(gripper(**wrong))
    tool = robot.AddConnectedBody(gripper())
    with pytest.raises(ravemj.openrave_exception, match="already"):
        robot.AddConnectedBody(gripper())
    other = robot.AddConnectedBody(gripper(_trelative=np.eye(4)), removeduplicate=True)
    assert robot.GetConnectedBodies() == [other]
    assert tool.GetInfoHash() != other.GetInfoHash()
    robot.SetConnectedBodyActiveStates([1])
    env.Add(robot)
    for call in (lambda: other.SetActive(False), lambda: robot.RemoveConnectedBody(other)):
        with pytest.raises(ravemj.openrave_exception, match="in an environment"):
            call()
    env.Reset()
    assert robot.RemoveConnectedBody(other)
    assert not robot.RemoveConnectedBody(other)
    env.Add(robot)
    assert robot.GetDOF() == 6
    assert robot.GetConnectedBody("tool") is None
