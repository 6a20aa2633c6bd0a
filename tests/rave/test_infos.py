"""Infos: what they say of a body, and the bodies that are made of them."""

import pickle
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples, scene_node, scenes, xml

import ravemj
from ravemj import KinBody
from ravemj.core.transforms import Pose
from ravemj.model import scene
from ravemj.model.shape_bodies import shape_geometry

ARM = """<Robot name="arm"><KinBody>
  <Body name="base"><Geom type="box"><extents>.2 .2 .1</extents></Geom></Body>
  <Body name="upper"><Translation>0 0 .3</Translation><Geom type="cylinder"><radius>.1</radius><height>1</height></Geom>
    <Mass type="custom"><total>2</total><com>.1 .2 .3</com><inertia>.1 .01 0  .01 .2 0  0 0 .25</inertia></Mass></Body>
  <Body name="fore"><Translation>1 0 .3</Translation><Geom type="sphere"><radius>.1</radius></Geom></Body>
  <Body name="tip"><Translation>1 0 .5</Translation></Body>
  <Joint name="j0"><Body>base</Body><Body>upper</Body><axis>0 0 1</axis><limits>-3 3</limits></Joint>
  <Joint name="j1" type="slider"><Body>upper</Body><Body>fore</Body><axis>1 0 0</axis><limits>-1 1</limits></Joint>
  <Joint name="j2" mimic_pos="2*j0" enable="true"><Body>fore</Body><Body>tip</Body><axis>1 0 0</axis></Joint>
  <adjacent>base fore</adjacent>
</KinBody>
<Manipulator name="hand"><base>base</base><effector>fore</effector><Translation>.1 0 0</Translation></Manipulator>
<AttachedSensor name="eye"><link>fore</link><Translation>0 0 1</Translation></AttachedSensor>
</Robot>"""


@pytest.fixture
def env():
    return ravemj.Environment()


@pytest.fixture
def robot(env):
    env.LoadData(ARM)
    return env.GetRobot("arm")


def copy_of(body):
    """Return a body made of a body's infos, which were pickled on the way."""
    env = body.GetEnv()
    make = ravemj.RaveCreateRobot if body.IsRobot() else ravemj.RaveCreateKinBody
    copy = make(env, "")
    assert copy.InitFromKinBodyInfo(pickle.loads(pickle.dumps(body.ExtractInfo())))
    assert copy.GetName() == body.GetName()
    env.Add(copy, True)
    return copy


def frames(robot):
    return [*robot.GetManipulators(), *robot.GetAttachedSensors()]


def assert_alike(copy, body):
    np.testing.assert_allclose(copy.link_transforms(), body.link_transforms(), atol=1e-9)
    np.testing.assert_allclose(copy.GetDOFValues(), body.GetDOFValues(), atol=1e-9)
    np.testing.assert_array_equal(copy.GetDOFLimits(), body.GetDOFLimits())
    for mine, theirs in zip(copy.GetLinks(), body.GetLinks(), strict=True):
        assert mine.GetName() == theirs.GetName()
        assert mine.GetMass() == theirs.GetMass()
        scale = np.abs(theirs.GetLocalInertia()).max()
        np.testing.assert_allclose(mine.GetLocalInertia(), theirs.GetLocalInertia(), rtol=0, atol=1e-12 * scale)
        np.testing.assert_allclose(mine.GetGlobalCOM(), theirs.GetGlobalCOM(), atol=1e-9)
        assert len(mine.GetGeometries()) == len(theirs.GetGeometries())


@examples(40)
@given(scene=scenes(), seed=st.integers(0, 2**32 - 1))
def test_a_copy_through_infos_is_alike_and_moves_alike(scene, seed):
    env, random = ravemj.Environment(), np.random.default_rng(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        env.LoadData(xml(scene_node(scene)))
        for body in env.GetBodies():
            body.SetDOFValues(random.uniform(-1, 1, body.GetDOF()))
            copy = copy_of(body)
            assert_alike(copy, body)
            if body.GetDOF() and not body.GetPassiveJoints():  # else joints that do nothing are described otherwise
                assert copy.GetKinematicsGeometryHash() == body.GetKinematicsGeometryHash()
            values = random.uniform(-1, 1, body.GetDOF())
            body.SetDOFValues(values)
            copy.SetDOFValues(values)
            np.testing.assert_allclose(copy.link_transforms(), body.link_transforms(), atol=1e-8)


def test_a_robot_is_copied_with_arms_and_sensors(robot):
    robot.SetDOFValues([0.5, 0.2])
    copy = copy_of(robot)
    assert_alike(copy, robot)
    assert [joint.GetName() for joint in copy.GetPassiveJoints()] == ["j2"]
    assert copy.GetAdjacentLinks() == robot.GetAdjacentLinks()
    assert copy.GetRobotStructureHash() == robot.GetRobotStructureHash()
    for mine, theirs in zip(frames(copy), frames(robot), strict=True):
        np.testing.assert_allclose(mine.GetTransform(), theirs.GetTransform(), atol=1e-12)


def test_infos_give_copies(robot):
    info = robot.GetLink("upper").GetInfo()
    info._t[0, 3] = 7
    info._vgeometryinfos[0]._vGeomData[0] = 7
    assert robot.GetLink("upper").GetTransform()[0, 3] == 0
    assert robot.GetLink("upper").GetGeometries()[0].GetCylinderRadius() == 0.1


def test_anchor_and_axis_are_in_the_frame_of_the_first_link(robot):
    robot.SetTransform([0, 1, 0, 0, 5, 6, 7])
    info = robot.GetJoint("j1").GetInfo()
    assert (info._linkname0, info._linkname1) == ("upper", "fore")
    np.testing.assert_allclose(info._vaxes, [[1, 0, 0]], atol=1e-12)


def box_info(half, **fields):
    info = ravemj.KinBody.GeometryInfo()
    info._type, info._vGeomData = ravemj.GeometryType.Box, half
    for name, value in fields.items():
        setattr(info, name, value)
    return info


def link_info(name, *geometries, **fields):
    info = ravemj.KinBody.LinkInfo()
    info._name, info._vgeometryinfos = name, geometries
    for field, value in fields.items():
        setattr(info, field, value)
    return info


def joint_info(kind, **fields):
    info = ravemj.KinBody.JointInfo()
    info._type, info._name, info._linkname0, info._linkname1 = kind, "j", "a", "b"
    info._vlowerlimit, info._vupperlimit = [-2] * 3, [2] * 3
    for name, value in fields.items():
        setattr(info, name, value)
    return info


@pytest.fixture
def made(env):
    """Make a body of two links and a joint."""

    def made(joint, *links):
        body = ravemj.RaveCreateKinBody(env, "")
        body.Init(links or [link_info("a"), link_info("b", _t=ravemj.matrixFromPose([1, 0, 0, 0, 1, 0, 0]))], [joint])
        body.SetName("made")
        env.Add(body)
        return body

    return made


def test_a_hinge_turns_about_its_anchor(made):
    body = made(joint_info(ravemj.JointType.Hinge, _vanchor=[0.5, 0, 0], _vaxes=[[0, 0, 2]]))
    body.SetDOFValues([np.pi / 2])
    np.testing.assert_allclose(body.GetLink("b").GetTransform()[:3, 3], [0.5, 0.5, 0], atol=1e-12)


def test_a_spherical_joint_starts_at_its_value(made):
    body = made(joint_info(ravemj.JointType.Spherical, _vanchor=[1, 0, 0], _vcurrentvalues=[0, 0, np.pi / 2]))
    np.testing.assert_allclose(body.GetDOFValues(), [0, 0, np.pi / 2], atol=1e-12)
    np.testing.assert_allclose(body.GetLink("b").GetTransform()[:3, :3], np.eye(3), atol=1e-12)
    body.SetDOFValues([0, 0, 0])
    np.testing.assert_allclose(body.GetLink("b").GetTransform()[:3, :3], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-12)


def test_a_follower_and_a_circular_joint(env):
    body = ravemj.RaveCreateKinBody(env, "")
    joints = [
        joint_info(ravemj.JointType.Hinge, _name="lead", _bIsCircular=[True]),
        joint_info(ravemj.JointType.Hinge, _name="tail", _linkname0="b", _linkname1="c", _vmimic=[["-lead", "", ""]]),
    ]
    body.Init([link_info(name) for name in "abc"], joints)
    body.SetName("made")
    env.Add(body)
    body.SetDOFValues([1.5])
    assert body.GetDOFLimits()[1] == 10000
    np.testing.assert_allclose(body.GetLink("c").GetTransform(), np.eye(4), atol=1e-12)


def test_a_motor_limits_the_torque(made):
    motor = ravemj.ElectricMotorActuatorInfo(gear_ratio=100, max_instantaneous_torque=0.5)
    body = made(joint_info(ravemj.JointType.Hinge, _infoElectricMotor=motor, _vmaxtorque=[3]))
    assert body.GetDOFTorqueLimits() == 3
    assert body.GetDOFMaxTorque() == 50


def test_masses_about_turned_axes(made):
    turned = ravemj.matrixFromAxisAngle([0, 0, np.pi / 2])
    link = link_info("a", _mass=3.0, _tMassFrame=turned, _vinertiamoments=[3, 2, 1])
    body = made(joint_info(ravemj.JointType.Hinge), link, link_info("b"))
    np.testing.assert_allclose(body.GetLinks()[0].GetLocalInertia(), np.diag([2, 3, 1]), atol=1e-12)
    np.testing.assert_allclose(body.GetLinks()[0].GetInfo()._vinertiamoments, [3, 2, 1], atol=1e-12)


@pytest.mark.parametrize(
    ("links", "joint", "match"),
    [
        ([link_info(None)], None, "_name"),
        ([link_info("a"), link_info("a")], None, "name of its own"),
        ([link_info("a")], joint_info(ravemj.JointType.Hinge), "link 'b'"),
        ([link_info("a"), link_info("b")], joint_info(ravemj.JointType.Universal), "Universal"),
        ([link_info("a"), link_info("b")], joint_info(ravemj.JointType.Hinge, _vaxes=[[0, 0, 0]]), "0 0 0"),
        ([link_info("a", box_info([1, 1]))], None, "three finite"),
        ([link_info("a", _t=np.ones((4, 4)))], None, "LinkInfo._t"),
        (["a"], None, "LinkInfo"),
    ],
)
def test_what_is_refused_changes_nothing(env, links, joint, match):
    body = ravemj.RaveCreateKinBody(env, "")
    body.InitFromSpheres([[0, 0, 0, 1]])
    with pytest.raises(ravemj.openrave_exception, match=match):
        body.Init(links, [joint] if joint else [])
    assert body.GetLinks()[0].GetGeometries()[0].GetSphereRadius() == 1


@pytest.mark.parametrize(
    "fields",
    [
        {"_type": ravemj.GeometryType.Container, "_vGeomData": [1, 1, 1], "_vGeomData2": [0.9, 0.9, 0.9]},
        {"_type": ravemj.GeometryType.Capsule, "_vGeomData": [0.1, 1.0]},
        {"_type": ravemj.GeometryType.Prism, "_vGeomData": [2.0], "_vCrossSection": [[0, 0], [1, 0], [0, 1]]},
        {"_type": ravemj.GeometryType.Trimesh, "_meshcollision": ravemj.TriMesh(np.eye(3), [[0, 1, 2]])},
        {"_type": ravemj.GeometryType(0), "_name": "none"},
    ],
)
def test_every_shape_comes_back(env, fields):
    body = ravemj.RaveCreateKinBody(env, "")
    colours = {"_vDiffuseColor": [0.1, 0.2, 0.3], "_fTransparency": 0.4, "_bVisible": False}
    body.InitFromGeometries([box_info([0, 0, 0], **fields, **colours)])
    first = body.simulation_state.scene
    body.InitFromGeometries([geometry.GetInfo() for geometry in body.GetLinks()[0].GetGeometries()])
    assert body.simulation_state.scene == first
    geometry = body.GetLinks()[0].GetGeometries()[0]
    assert geometry.GetType() == fields["_type"]
    assert (geometry.GetDiffuseColor().tolist(), geometry.GetTransparency()) == ([0.1, 0.2, 0.3], 0.4)
    assert not geometry.IsVisible()


def test_mesh_files(env, tmp_path):
    path = tmp_path / "flat.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    info = box_info([1, 1, 1], _filenamerender=str(path), _vRenderScale=[2, 2, 2])
    mesh = box_info([], _type=ravemj.GeometryType.Trimesh, _filenamecollision=str(path))
    body = ravemj.RaveCreateKinBody(env, "")
    body.InitFromGeometries([info, mesh])
    box, triangle = body.GetLinks()[0].GetGeometries()
    assert box.GetRenderFilename() == str(path)
    np.testing.assert_array_equal(box.GetRenderScale(), [2, 2, 2])
    np.testing.assert_array_equal(triangle.GetCollisionMesh().vertices, [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    (surface,) = body.simulation_state.scene.links[0].geometries[0].display
    assert surface.mesh.vertices.max() == 2
    assert env.ReadTrimeshURI(str(path)).indices.tolist() == [[0, 1, 2]]
    assert env.ReadTrimeshURI(str(tmp_path / "none.obj")) is None
    with pytest.raises(ravemj.SourceError):
        box.SetRenderFilename(str(tmp_path / "none.obj"))
    assert box.GetRenderFilename() == str(path)


class TestManipulators:
    def test_a_new_arm_has_the_joints_between_its_links(self, robot):
        info = ravemj.Robot.ManipulatorInfo()
        info._name, info._sBaseLinkName, info._sEffectorLinkName = "short", "upper", "fore"
        info._vClosingDirection = [1]
        assert info._vChuckingDirection == [1]
        arm = robot.AddManipulator(info)
        assert arm.GetArmIndices().tolist() == [1]
        assert robot.GetActiveManipulator().GetName() == "hand"
        assert [link.GetName() for link in arm.GetIndependentLinks()] == ["base", "upper"]
        assert robot.RemoveManipulator(robot.GetManipulator("hand"))
        assert robot.GetActiveManipulator() is None
        assert [one.GetName() for one in robot.GetManipulators()] == ["short"]

    def test_arms_stay_themselves_when_others_go(self, robot):
        hand = robot.GetManipulator("hand")
        info = hand.GetInfo()
        info._name = "other"
        other = robot.AddManipulator(info)
        assert robot.GetManipulators() == [hand, other]
        assert robot.RemoveManipulator(hand)
        assert other.GetName() == "other"
        assert robot.GetManipulators() == [other]
        for call in (hand.GetTransform, hand.GetName, lambda: hand.SetLocalToolTransform(np.eye(4))):
            with pytest.raises(ravemj.openrave_exception, match="any more"):
                call()
        assert "any more" in repr(hand)
        assert robot.GetManipulators() == [other]
        assert not robot.RemoveManipulator(hand)

    def test_what_is_refused_changes_nothing(self, robot):
        info = robot.GetManipulator("hand").GetInfo()
        with pytest.raises(ravemj.ArgumentError, match="already"):
            robot.AddManipulator(info)
        info._name, info._sBaseLinkName, info._sEffectorLinkName = "back", "fore", "base"
        with pytest.raises(ravemj.openrave_exception):
            robot.AddManipulator(info)
        assert len(robot.GetManipulators()) == 1

    def test_beyond_the_arm(self, robot):
        arm = robot.GetManipulator("hand")
        assert [link.GetName() for link in arm.GetChildLinks()] == ["fore", "tip"]
        assert arm.GetChildJoints() == []
        assert arm.IsChildLink(robot.GetLink("tip"))


SHAPES = [
    scene.Box((1, 2, 3)),
    scene.CalibrationBoard((1, 2, 3)),
    scene.Sphere(1),
    scene.Cylinder(1, 2),
    scene.Capsule(1, 2),
    scene.Container((4, 5, 6), (3, 4, 5), (1, 2, 3), (2, 1, 3)),
    scene.Prism(((0, 0), (1, 0), (0, 1)), 2),
    scene.TriMesh(scene.Mesh(np.eye(3), np.array([[0, 1, 2]]))),
    scene.NoShape(),
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
def test_every_type_of_geometry_is_described_and_made(shape):
    info = KinBody.GeometryInfo.of(shape_geometry(shape, Pose(), visible=True))
    assert info.geometry().shape == shape
    assert type(info.geometry().shape) is type(shape)


def test_these_are_all_types_of_geometry():
    assert {one.shape for one in scene.SHAPE_TYPES} == {type(shape) for shape in SHAPES}


def test_what_a_shape_does_not_need_is_not_looked_at():
    info = KinBody.GeometryInfo(_vGeomData="not a number")
    assert info.geometry().shape == scene.NoShape()


def test_numbers_of_cameras_and_actuators_go_through_json():
    intrinsics, limits = ravemj.Sensor.CameraIntrinsics(), ravemj.ActuatorGeomData(maxtorque=3.0)
    with pytest.raises(ravemj.ArgumentError, match="DeserializeJSON: fx"):
        intrinsics.DeserializeJSON({"fx": "wide"})
    twin = ravemj.ActuatorGeomData()
    twin.DeserializeJSON(limits.SerializeJSON())
    assert twin == limits
    assert twin.maxtorque == 3.0
