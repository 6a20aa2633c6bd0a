"""OpenRAVE's JSON of infos, units, samplers, sensors' data and the other small values of the API."""

import json

import numpy as np
import pytest
from command_line import run

import ravemj
from ravemj import InterfaceType, KinBody, Robot

ARM = """<Robot name="arm"><KinBody>
  <Body name="base"><Geom type="box" name="plate"><extents>.2 .2 .1</extents>
    <diffuseColor>1 0 0</diffuseColor></Geom></Body>
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
<AttachedSensor name="eye"><link>fore</link><Translation>0 0 1</Translation>
  <sensor type="BaseCamera"><KK>500 510 320 240</KK><width>640</width><height>480</height></sensor></AttachedSensor>
</Robot>"""


@pytest.fixture
def env():
    made = ravemj.Environment()
    yield made
    made.Destroy()


@pytest.fixture
def robot(env):
    env.LoadData(ARM)
    return env.GetRobot("arm")


def leaves(value):
    """The numbers in JSON, in order."""
    if isinstance(value, dict | list):
        for one in value.values() if isinstance(value, dict) else value:
            yield from leaves(one)
    elif isinstance(value, int | float):
        yield value


def test_parts_go_through_json_and_back(env):
    env.Load("models/puma560.xml")
    robot = env.GetRobots()[0]
    parts = [*robot.GetLinks(), *robot.GetJoints(), *robot.GetManipulators()]
    assert len(parts) > 12
    for part in parts:
        info = part.GetInfo()
        read = type(info)()
        read.DeserializeJSON(json.loads(json.dumps(info.SerializeJSON())))
        for geometry, own in zip(
            getattr(read, "_vgeometryinfos", []), getattr(info, "_vgeometryinfos", []), strict=True
        ):
            geometry._filenamerender = own._filenamerender  # OpenRAVE's JSON has none
        assert read == info


def test_a_robot_goes_through_json_and_back(env, robot):
    robot.SetDOFValues([0.4, 0.2])
    info = robot.ExtractInfo()
    text = json.dumps(info.SerializeJSON())
    read = Robot.RobotBaseInfo()
    read.DeserializeJSON(json.loads(text))
    assert list(leaves(read.SerializeJSON())) == pytest.approx(list(leaves(json.loads(text))), abs=1e-12)
    copy = ravemj.RaveCreateRobot(env, "")
    assert copy.InitFromRobotInfo(read)
    env.Add(copy, True)
    np.testing.assert_allclose(copy.link_transforms(), robot.link_transforms(), atol=1e-12)
    np.testing.assert_allclose(copy.GetDOFValues(), robot.GetDOFValues(), atol=1e-12)
    for link, other in zip(copy.GetLinks(), robot.GetLinks(), strict=True):
        np.testing.assert_allclose(link.GetLocalInertia(), other.GetLocalInertia(), atol=1e-12)
        assert link.ComputeLocalAABB().extents() == pytest.approx(other.ComputeLocalAABB().extents())
        assert [one.GetType() for one in link.GetGeometries()] == [one.GetType() for one in other.GetGeometries()]
    camera = copy.GetAttachedSensor("eye").GetSensor().GetSensorGeometry()
    assert (camera.width, camera.height, camera.KK[1, 1]) == (640, 480, 510)
    assert copy.GetManipulator("hand").GetTransform() == pytest.approx(robot.GetManipulator("hand").GetTransform())


def test_the_keys_are_openraves(robot):
    plate = robot.GetLink("base").GetGeometries()[0].GetInfo().SerializeJSON()
    assert plate == {
        **{"id": "", "name": "plate", "transform": [1, 0, 0, 0, 0, 0, 0], "type": "box"},
        **{"halfExtents": [0.2, 0.2, 0.1], "diffuseColor": [1, 0, 0]},
    }
    joint = robot.GetJoint("j1").GetInfo().SerializeJSON()
    assert (joint["type"], joint["parentLinkName"], joint["lowerLimit"], joint["maxJerk"]) == (
        *("prismatic", "upper"),
        *([-1.0], [50000.0]),
    )
    assert robot.GetJoint("j2").GetInfo().SerializeJSON()["mimics"][0]["equations"][0] == "2*j0"
    assert {"mass", "inertiaMoments", "massTransform", "isStatic"} <= robot.GetLinks()[
        1
    ].GetInfo().SerializeJSON().keys()


def test_lengths_are_scaled_and_angles_are_not(robot):
    for name, factor in (("j0", 1.0), ("j1", 1000.0)):
        info = robot.GetJoint(name).GetInfo()
        written = info.SerializeJSON(1000.0)
        assert written["upperLimit"] == pytest.approx(factor * np.array(info._vupperlimit)[:1])
        back = KinBody.JointInfo()
        back.DeserializeJSON(written, 0.001)
        np.testing.assert_allclose(back._vupperlimit, info._vupperlimit)
        np.testing.assert_allclose(back._vanchor, info._vanchor, atol=1e-12)
    link = robot.GetLink("upper").GetInfo()
    written = link.SerializeJSON(1000.0)
    np.testing.assert_allclose(written["inertiaMoments"], np.array(link._vinertiamoments) * 1e6)
    assert written["geometries"][0]["height"] == pytest.approx(1000.0)
    shape = robot.GetLink("upper").GetGeometries()[0].GetInfo()
    shape.ConvertUnitScale(2.0)
    assert (shape.GetCylinderRadius(), shape.GetCylinderHeight()) == (0.2, 2.0)


def test_partial_json_changes_what_it_names(robot):
    info = robot.ExtractInfo()
    info.DeserializeJSON({"links": [{"name": "upper", "mass": 7.0}, {"name": "tip", "__deleted__": True}]})
    assert [(link._name, link._mass) for link in info._vLinkInfos][1] == ("upper", 7.0)
    assert [link._name for link in info._vLinkInfos] == ["base", "upper", "fore"]
    assert len(info._vJointInfos) == 3


@pytest.mark.parametrize(
    ("info", "given", "words"),
    [
        (KinBody.GeometryInfo(), {"type": "blob"}, "no type 'blob'"),
        (KinBody.GeometryInfo(), {"transform": [1, 2]}, "seven numbers"),
        (KinBody.LinkInfo(), {"mass": 1, "floatParameters": [{"values": [1]}]}, "no id"),
        (KinBody.JointInfo(), 3, "should be a dict"),
    ],
)
def test_wrong_json_is_said_to_be_wrong(info, given, words):
    with pytest.raises(ravemj.openrave_exception, match=words):
        info.DeserializeJSON(given)


def test_every_field_shows_on_its_class():
    for kind in (KinBody.GeometryInfo, KinBody.JointInfo, Robot.AttachedSensorInfo, ravemj.ElectricMotorActuatorInfo):
        assert all(hasattr(kind, name) for name in vars(kind()))
    assert ravemj.CollisionReport.minDistance is not None
    assert ravemj.openrave_exception.message is not None


def test_units():
    assert ravemj.GetLengthUnitConversionScale(ravemj.LengthUnit.m, ravemj.LengthUnit.mm) == 1000.0
    assert ravemj.GetLengthUnitConversionScale(ravemj.LengthUnit["in"], ravemj.LengthUnit.cm) == pytest.approx(2.54)
    assert ravemj.GetMassUnitConversionScale(ravemj.MassUnit.kg, ravemj.MassUnit.g) == pytest.approx(1000.0)
    assert ravemj.GetMassUnitStandardValue(ravemj.MassUnit.lb) == pytest.approx(0.002204622621848776)
    assert ravemj.GetAngleUnitConversionScale(ravemj.AngleUnit.deg, ravemj.AngleUnit.rad) == pytest.approx(np.pi / 180)
    assert ravemj.GetTimeDurationUnitStandardValue(ravemj.TimeDurationUnit.ms) == 1000.0
    assert ravemj.GetLengthUnitString(ravemj.LengthUnit.dmm) == "0.1mm"
    assert ravemj.GetLengthUnitFromString("inch", ravemj.LengthUnit.m) == ravemj.LengthUnit["in"]
    assert ravemj.GetLengthUnitFromString("", ravemj.LengthUnit.ft) == ravemj.LengthUnit.ft
    with pytest.raises(ravemj.openrave_exception, match="parsec"):
        ravemj.GetLengthUnitFromString("parsec", ravemj.LengthUnit.m)
    units = ravemj.UnitInfo()
    units.DeserializeJSON({"lengthUnit": "mm"})
    assert (units.lengthUnit, units.SerializeJSON()["massUnit"]) == (ravemj.LengthUnit.mm, "kg")
    assert ravemj.UnitInfo(units) == units
    with pytest.raises(ravemj.openrave_exception, match="a dict"):
        units.DeserializeJSON(None)


def test_units_other_than_those_of_length_stay(env):
    assert env.GetUnit() == ("m", 1)
    env.SetUnit("mm", 0.001)
    assert env.GetUnit() == ("mm", 0.001)
    with pytest.raises(ravemj.openrave_exception, match=r"0\.001 m long"):
        env.SetUnit("mm", 1)
    with pytest.raises(NotImplementedError):
        env.SetUnitInfo(ravemj.UnitInfo(massUnit=ravemj.MassUnit.g))
    for wrong in ("x", ravemj.UnitInfo(lengthUnit=77)):
        with pytest.raises(ravemj.openrave_exception):
            env.SetUnitInfo(wrong)
    with pytest.raises(ravemj.openrave_exception):
        env.SetUnit("m", "x")
    assert env.GetUnitInfo() == ravemj.UnitInfo(lengthUnit=ravemj.LengthUnit.mm)


def test_what_an_environment_is_called():
    with ravemj.Environment("cell") as env:
        assert env.GetName() == "cell"
        assert ravemj.Environment(env) is env
        assert ravemj.Environment(penv=env) is env
        env.SetKeywords(["a"])
        env.SetDescription("words")
        env.SetUInt64Parameter("n", 5)
        assert (env.GetKeywords(), env.GetDescription(), env.GetUInt64Parameter("n", 0)) == (["a"], "words", 5)
        assert env.RemoveUInt64Parameter("n")
        assert env.GetUInt64Parameter("n", 3) == 3
    env.Destroy()


def test_functions_hear_of_bodies(env):
    heard = []
    handle = env.RegisterBodyCallback(lambda body, action: heard.append((body.GetName(), action)))
    env.LoadData(ARM)
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes([[0, 0, 3, 0.1, 0.1, 0.1]], True, "my:box")
    assert box.GetURI() == "my:box"
    box.SetName("box")
    env.Add(box)
    assert env.RemoveKinBodyByName("box")
    assert not env.RemoveKinBodyByName("box")
    env.Reset()
    handle.Close()
    env.Add(box)
    assert heard == [("arm", 1), ("box", 1), ("box", 0), ("arm", 0)]


def test_adding_under_a_taken_name(env, robot):
    for mode, renames in ((True, True), (ravemj.InterfaceAddMode.AllowRenaming, True), (False, False), (None, False)):
        other = ravemj.RaveClone(robot)
        if renames:
            env.Add(other, mode)
            assert other.GetName() != "arm"
        else:
            with pytest.raises(ravemj.openrave_exception, match="BodyNameConflict"):
                env.Add(other, addMode=mode)
    other = ravemj.RaveClone(robot)
    env.Add(other, anonymous=True)
    assert len(env.GetBodies()) == 4


def test_interfaces_by_kind(env, robot):
    assert ravemj.RaveHasInterface(InterfaceType.controller, "idealController")
    assert not ravemj.RaveHasInterface(InterfaceType.controller, "nosuch")
    made = ravemj.RaveCreateInterface(env, InterfaceType.trajectory, "")
    assert isinstance(made, ravemj.Trajectory)
    made.Init(robot.GetActiveConfigurationSpecification())
    assert ravemj.RaveClone(made).GetConfigurationSpecification() == made.GetConfigurationSpecification()
    engine = ravemj.RaveCreatePhysicsEngine(env, "ode")
    engine.SetGravity([0, 0, -1])
    assert ravemj.RaveClone(engine).GetGravity()[2] == -1
    controller = robot.GetController()
    controller.SetDescription("mine")
    controller.SetUserData("key", 3)
    copy = ravemj.RaveClone(controller)
    assert (type(copy), copy.GetRobot()) == (type(controller), None)
    assert (copy.GetDescription(), copy.GetUserData("key")) == ("mine", 3)
    copy.SetUserData("key", 4)
    assert controller.GetUserData("key") == 3
    module = ravemj.RaveCreateModule(env, "BaseManipulation")
    assert ravemj.RaveClone(module).GetXMLId() == "BaseManipulation"
    with pytest.raises(ravemj.openrave_exception, match="Clone: ref"):
        copy.Clone(engine)
    camera = ravemj.RaveCreateSensor(env, "BaseCamera")
    geometry = camera.GetSensorGeometry()
    geometry.width, geometry.height, geometry.intrinsics.K = 77, 48, [[100, 0, 38], [0, 100, 24], [0, 0, 1]]
    camera.SetSensorGeometry(geometry)
    camera.SetTransform([1, 0, 0, 0, 1, 2, 3])
    twin = ravemj.RaveClone(camera)
    assert twin.GetSensorGeometry().width == 77
    assert twin.GetTransform()[2, 3] == 3
    with pytest.raises(ravemj.openrave_exception, match="Clone: ref"):
        twin.Clone(ravemj.RaveCreateSensor(env, "BaseLaser2D"))
    with pytest.raises(NotImplementedError):
        ravemj.SensorSystem(env)


@pytest.mark.parametrize(
    ("seed", "first"), [(42, [1608637542, 3421126067, 4083286876, 787846414]), (5489, [3499211612, 581869302])]
)
def test_random_samplers_are_the_standard_mersenne_twister(seed, first, env):
    sampler = ravemj.RaveCreateSpaceSampler(env, "MT19937")
    sampler.SetSpaceDOF(2)
    sampler.SetSeed(seed)
    whole = sampler.SampleSequence(ravemj.SampleDataType.Uint32, len(first) // 2)
    assert whole.tolist() == first
    sampler.SetSeed(np.int64(seed))
    reals = sampler.SampleSequence2D(ravemj.SampleDataType.Real, len(first) // 2)
    np.testing.assert_array_equal(reals, whole.reshape(-1, 2) / 2**32)


def test_a_seed_does_not_move_haltons_sequence(env):
    sampler = ravemj.RaveCreateSpaceSampler(env, "Halton")
    sampler.SetSpaceDOF(2)
    first = sampler.SampleSequence2D(ravemj.SampleDataType.Real, 1).tolist()
    sampler.SetSeed(7)
    second = sampler.SampleSequence2D(ravemj.SampleDataType.Real, 1).tolist()
    sampler.SetSpaceDOF(3)
    again = sampler.SampleSequence2D(ravemj.SampleDataType.Real, 1).tolist()
    assert (first, second, again) == ([[0, 0]], [[1 / 2, 1 / 3]], [[0, 0, 0]])


def test_random_samplers_repeat_and_stay_inside(env, robot):
    sampler = ravemj.RaveCreateSpaceSampler(env, "MT19937")
    sampler.SetSpaceDOF(3)
    sampler.SetSeed(7)
    rows = sampler.SampleSequence2D(ravemj.SampleDataType.Real, 200)
    sampler.SetSeed(7)
    np.testing.assert_array_equal(sampler.SampleSequence2D(ravemj.SampleDataType.Real, 200), rows)
    assert rows.shape == (200, 3)
    assert rows.min() >= 0
    assert rows.max() <= 1
    assert (abs(rows.mean(axis=0) - 0.5) < 0.1).all()
    whole = sampler.SampleSequence(ravemj.SampleDataType.Uint32, 5)
    assert whole.dtype == np.uint32
    assert whole.shape == (15,)
    sampler.SetSpaceDOF(1)
    assert 0 <= sampler.SampleSequenceOneReal() <= 1
    assert sampler.SampleSequenceOneUInt32() >= 0
    with pytest.raises(ravemj.openrave_exception):
        ravemj.RaveCreateSpaceSampler(env, "BodyConfiguration nosuch")
    assert ravemj.RaveCreateSpaceSampler(env, "BodyConfiguration arm").GetDOF() == robot.GetDOF()


def test_boxes_and_meshes_are_checked_like_bodies(env, robot):
    checker = env.GetCollisionChecker()
    box, far = ravemj.AABB([0, 0, 0], [0.05, 0.05, 0.05]), np.eye(4)
    far[0, 3] = 50
    report = ravemj.CollisionReport()
    assert checker.CheckCollisionOBB(box, np.eye(4), report)
    assert report.plink2.GetParent() == robot
    assert not checker.CheckCollisionOBB(box, far, None)
    assert checker.CheckCollisionOBB(box, np.eye(4), [robot], report)
    assert not checker.CheckCollisionOBB(box, np.eye(4), [], report)
    mesh = robot.GetLink("fore").GetCollisionData()
    mesh.vertices += (1, 0, 0.3)
    assert checker.CheckCollisionTriMesh(mesh, report)
    assert checker.CheckCollisionTriMesh(mesh, robot, report)
    assert env.GetBodies() == [robot]


def test_boxes_around_groups_of_geometries(robot):
    infos = [[] for _ in robot.GetLinks()]
    ball = KinBody.GeometryInfo()
    ball._type, ball._vGeomData = ravemj.GeometryType.Sphere, [0.5]
    infos[0] = [ball]
    before = robot.ComputeAABB()
    robot.SetLinkGroupGeometries("big", infos)
    np.testing.assert_allclose(robot.ComputeAABBForGeometryGroup("big").extents(), [0.5] * 3)
    np.testing.assert_allclose(robot.ComputeAABBForGeometryGroup("self").extents(), before.extents())
    robot.SetLinkGeometriesFromGroup("big", True)
    np.testing.assert_allclose(robot.ComputeAABB().extents(), [0.5] * 3)
    robot.SetLinkGeometriesFromGroup("self")
    np.testing.assert_allclose(robot.ComputeAABB().extents(), before.extents())
    with pytest.raises(ravemj.openrave_exception):
        robot.SetLinkGeometriesFromGroup("nosuch")
    turned = ravemj.matrixFromAxisAngle([0, 0, 0.7])
    around = robot.ComputeOBBOnAxes(turned)
    np.testing.assert_allclose(around.transform()[:3, :3], turned[:3, :3], atol=1e-12)


def test_how_a_body_is_held(env, robot):
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes([[0, 0, 3, 0.1, 0.1, 0.1]])
    box.SetName("box")
    env.Add(box)
    fore, base = robot.GetLink("fore"), robot.GetLink("base")
    same = ravemj.GrabbedInfoCheckResult
    assert robot.CheckGrabbedInfo(box, fore) == same.BodyNotGrabbed
    robot.Grab(box, fore)
    assert robot.GetManipulator("hand").IsGrabbing(box)
    assert robot.HasAttached()
    assert sorted(robot.GetAttachedEnvironmentBodyIndices()) == [1, 2]
    assert robot.CheckGrabbedInfo(box, fore) == same.Identical
    assert robot.CheckGrabbedInfo(box, base) == same.GrabbingLinkNotMatch
    assert robot.CheckGrabbedInfo(box, fore, ["base"]) == same.IgnoredLinksNotMatch
    held = robot.GetGrabbedInfo("box")
    again = ravemj.GrabbedInfo()
    again.DeserializeJSON(held.SerializeJSON())
    assert again.GetGrabbedInfoHash() == held.GetGrabbedInfoHash()
    assert again._robotlinkname == "fore"
    robot.ReleaseAllGrabbedWithLink(base)
    assert robot.GetNumGrabbed() == 1
    robot.GetManipulator("hand").ReleaseAllGrabbed()
    assert robot.GetNumGrabbed() == 0


def test_sensors_can_be_attached_and_moved(robot):
    info = robot.GetAttachedSensor("eye").GetInfo()
    info._name = "second"
    camera = robot.AddAttachedSensor(info)
    with pytest.raises(ravemj.openrave_exception, match="already"):
        robot.AddAttachedSensor(info)
    camera.SetRelativeTransform(np.eye(4))
    np.testing.assert_allclose(camera.GetTransform(), robot.GetLink("fore").GetTransform())
    np.testing.assert_allclose(camera.GetTransformPose()[4:], [1, 0, 0.3])
    sensor = camera.GetSensor()
    assert isinstance(sensor.CreateSensorData(), ravemj.Sensor.CameraSensorData)
    with pytest.raises(ravemj.openrave_exception):
        sensor.CreateSensorData(ravemj.Sensor.Type.Laser)
    geometry = sensor.GetSensorGeometry()
    geometry.width = 320
    assert sensor.SetSensorGeometry(geometry)
    assert robot.GetAttachedSensor("second").GetSensor().GetSensorGeometry().width == 320
    assert robot.RemoveAttachedSensor(camera)
    assert not robot.RemoveAttachedSensor(camera)


def test_a_video_of_simulation_time(env, robot, tmp_path):
    recorder = ravemj.RaveCreateModule(env, "viewerrecorder")
    assert env.AddModule(recorder, "") == 0
    assert env.GetModules() == [recorder]
    target = tmp_path / "video.gif"
    recorder.SendCommand(f"Start 32 24 10 codec 0 timing simtime filename {target}\nviewer x")
    for step in range(5):
        robot.SetDOFValues([0.2 * (step + 1)], [0])
        env.StepSimulation(0.1)
    recorder.SendCommand("Stop")
    import imageio.v3 as iio

    assert len(iio.imread(target, index=None)) == 6
    for wrong in ("Start 32", "Start 32 24 10 timing nosuch filename x.gif", "Stop"):
        with pytest.raises(ravemj.openrave_exception):
            recorder.SendCommand(wrong)
    assert env.Remove(recorder)
    assert env.GetModules() == []


@pytest.mark.stress
def test_a_script_that_ends_without_stop_completes_its_video(tmp_path):
    (tmp_path / "fails.py").write_text(
        """
import ravemj
env = ravemj.load(ravemj.model_path("pendulum"))
recorder = ravemj.RaveCreateModule(env, "viewerrecorder")
env.AddModule(recorder, "")
recorder.SendCommand("Start 32 24 10 codec 0 timing simtime filename video.gif")
env.StepSimulation(0.5)
raise SystemExit(3)
"""
    )
    assert run(tmp_path, "fails.py").returncode == 3
    assert (tmp_path / "video.gif").read_bytes().startswith(b"GIF89a")


def test_values_of_scripts_under_ids(robot):
    value = ravemj.stringreaders.CreateStringReadable("note", "a < b")
    robot.SetReadableInterface("note", value)
    assert robot.GetReadableInterface("note").SerializeXML() == "<note>a &lt; b</note>"
    assert list(robot.GetReadableInterfaces()) == ["note"]
    robot.SetReadableInterface("note", None)
    assert robot.GetReadableInterface("note") is None


def test_an_info_moves_a_body_that_stays(robot):
    info = robot.ExtractInfo()
    assert robot.UpdateFromKinBodyInfo(info) == ravemj.UpdateFromInfoResult.NoChange
    robot.SetDOFValues([0.5, 0.1])
    moved = np.eye(4)
    moved[0, 3] = 2
    robot.SetTransform(moved)
    assert robot.UpdateFromKinBodyInfo(info) == ravemj.UpdateFromInfoResult.Success
    np.testing.assert_allclose(robot.GetDOFValues(), 0, atol=1e-12)
    np.testing.assert_allclose(robot.GetTransform(), np.eye(4), atol=1e-12)
    info._vLinkInfos[0]._mass = 99
    assert robot.UpdateFromKinBodyInfo(info) == ravemj.UpdateFromInfoResult.RequireReinitialize


def test_a_body_can_be_emptied(env, robot):
    robot.Destroy()
    assert env.GetBodies() == []
    assert robot.GetLinks() == []


def test_an_environment_goes_through_json(env, robot):
    robot.SetDOFValues([0.3, 0.1])
    env.SetDescription("words")
    env.GetPhysicsEngine().SetGravity([0, 0, -1])
    text = json.dumps(env.ExtractInfo().SerializeJSON())
    other = ravemj.Environment()
    assert other.LoadJSON(json.loads(text))
    np.testing.assert_allclose(other.GetRobot("arm").link_transforms(), robot.link_transforms(), atol=1e-12)
    assert other.GetDescription() == "words"
    assert other.GetPhysicsEngine().GetGravity()[2] == -1
    read = other.ReadRobotJSON(json.loads(text))
    assert (read.GetName(), read.GetDOF(), len(other.GetBodies())) == ("arm", 2, 1)
    assert other.ReadKinBodyJSON({"bodies": []}) is None
    robot.SetDOFValues([0.5, 0.1])
    added, changed, removed = other.UpdateFromInfo(env.ExtractInfo(), ravemj.UpdateFromInfoMode.Exact)
    assert ([], [other.GetRobot("arm")], []) == (added, changed, removed)
    np.testing.assert_allclose(other.GetRobot("arm").GetDOFValues(), [0.5, 0.1], atol=1e-12)
    _, _, removed = other.UpdateFromInfo(ravemj.EnvironmentBaseInfo(), ravemj.UpdateFromInfoMode.Exact)
    assert [body.GetName() for body in removed] == ["arm"]
    other.Destroy()


def test_grippers_are_kept(robot):
    info = ravemj.GripperInfo(_name="two fingers", _gripperJointNames=["j1"])
    assert robot.AddGripperInfo(info)
    with pytest.raises(ravemj.openrave_exception):
        robot.AddGripperInfo(info)
    assert robot.ExtractInfo().SerializeJSON()["gripperInfos"][0]["gripperJointNames"] == ["j1"]
    assert robot.RemoveGripperInfo("two fingers")
    assert robot.GetGripperInfos() == []


def test_the_nearest_points():
    from ravemj.compat import pyANN_int

    rng = np.random.default_rng(3)
    points, queries = rng.normal(size=(200, 3)), rng.normal(size=(7, 3))
    tree = pyANN_int.KDTree(points)
    indices, distances = tree.kSearchArray(queries, 4, 0)
    true = ((queries[:, None] - points) ** 2).sum(axis=2)
    np.testing.assert_array_equal(indices, np.argsort(true, axis=1)[:, :4])
    np.testing.assert_allclose(distances, np.sort(true, axis=1)[:, :4])
    near, squared, count = tree.kFRSearch(queries[0], 0.5, 300, 0)
    assert count == (true[0] <= 0.5).sum() == (near >= 0).sum()
    assert near.shape == (300,)
    assert np.isinf(squared[count:]).all()
    assert (len(tree), tree.dim()) == (200, 3)


def test_boxes_are_drawn(env):
    env.SetViewer("offscreen")
    box = ravemj.AABB([0, 0, 0], [1, 1, 1])
    assert env.drawaabb(box, np.eye(4), [1, 0, 0], 0.5) is not None
    assert env.drawobb(ravemj.OrientedBox(pose=np.eye(4), extents=[1, 1, 1])) is not None
    assert env.drawboxarray([[0, 0, 0], [3, 0, 0]], [1, 1, 1]) is not None
    moved = box.GetTransformed(ravemj.matrixFromPose([1, 0, 0, 0, 2, 0, 0]))
    combined = box.GetCombined(moved)
    np.testing.assert_allclose([combined.pos(), combined.extents()], [[1, 0, 0], [2, 1, 1]])
