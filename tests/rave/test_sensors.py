"""Sensors, against geometry and mechanics worked out by hand."""

import math

import numpy as np
import pytest
from waiting import await_that

import ravemj
from ravemj import Robot, Sensor

PowerOn = Sensor.ConfigureCommand.PowerOn
RenderDataOn = Sensor.ConfigureCommand.RenderDataOn
RenderDataOff = Sensor.ConfigureCommand.RenderDataOff
RenderGeometryOn = Sensor.ConfigureCommand.RenderGeometryOn

ROBOT = """<Environment>
  <bkgndcolor>0 0 1</bkgndcolor>
  <Robot name="eye">
    <KinBody><Body name="base" type="dynamic"><Mass type="custom"><total>1</total></Mass></Body></KinBody>
    <AttachedSensor name="camera">
      <link>base</link>
      <sensor type="BaseCamera"><KK>100 100 40 20</KK><width>64</width><height>48</height></sensor>
    </AttachedSensor>
    <AttachedSensor name="laser"><link>base</link><sensor type="BaseLaser2D"/></AttachedSensor>
    <AttachedSensor name="frame"><link>base</link></AttachedSensor>
  </Robot>
  <KinBody name="ball"><Body name="ball" type="static">
    <Translation>0.1 -0.1 2</Translation>
    <Geom type="sphere"><radius>.1</radius><diffuseColor>1 0 0</diffuseColor><ambientColor>1 0 0</ambientColor></Geom>
  </Body></KinBody>
</Environment>"""


@pytest.fixture
def env():
    env = ravemj.Environment()
    env.StopSimulation()
    assert env.LoadData(ROBOT)
    yield env
    env.Destroy()


def centre_of_red(image):
    rows, columns = np.nonzero(image[..., 0].astype(int) > image[..., 2].astype(int))
    return np.array([columns.mean(), rows.mean()]) + 0.5


def test_a_camera_sees_with_its_own_intrinsics(env):
    camera = env.GetRobot("eye").GetAttachedSensor("camera").GetSensor()
    assert camera.Supports(Sensor.Type.Camera)
    with pytest.raises(ravemj.openrave_exception, match="off"):
        camera.GetSensorData()
    assert camera.Configure(Sensor.ConfigureCommand.PowerCheck) == 0
    assert camera.Configure(Sensor.ConfigureCommand.PowerOn) == 1
    assert env.GetSensor("eye:camera").Configure(Sensor.ConfigureCommand.PowerCheck) == 1
    env.StepSimulation(0.5)
    data = camera.GetSensorData(Sensor.Type.Camera)
    assert data.imagedata.shape == (48, 64, 3)
    assert data.stamp == 500_000
    np.testing.assert_array_equal(data.KK, [[100, 0, 40], [0, 100, 20], [0, 0, 1]])
    np.testing.assert_allclose(centre_of_red(data.imagedata), [40 + 5, 20 - 5], atol=0.5)
    T = np.eye(4)
    T[0, 3] = 0.2
    env.GetRobot("eye").SetTransform(T)
    moved = camera.GetSensorData()
    np.testing.assert_allclose(centre_of_red(moved.imagedata), [40 - 5, 20 - 5], atol=0.5)
    np.testing.assert_array_equal(moved.transform, T)
    with pytest.raises(ravemj.openrave_exception, match="Laser"):
        camera.GetSensorData(Sensor.Type.Laser)
    assert camera.Configure(Sensor.ConfigureCommand.PowerOff) == 1
    with pytest.raises(ravemj.openrave_exception, match="off"):
        camera.GetSensorData()


def test_the_environment_knows_all_devices(env):
    assert [sensor.GetName() for sensor in env.GetSensors()] == ["eye:camera", "eye:laser"]
    assert env.GetSensor("nonsense") is None
    assert env.GetSensor("eye:laser") is env.GetRobot("eye").GetAttachedSensor("laser").GetSensor()


def box(name, center, half):
    texts = [" ".join(map(str, numbers)) for numbers in (center, half)]
    return (
        f'<KinBody name="{name}"><Body name="{name}" type="static"><Translation>{texts[0]}</Translation>'
        f'<Geom type="box"><Extents>{texts[1]}</Extents></Geom></Body></KinBody>'
    )


ROOM = "".join(
    box(name, center, half)
    for name, center, half in (
        ("east", (2.5, 0, 0), (0.5, 2, 2)),
        ("west", (-2.5, 0, 0), (0.5, 2, 2)),
        ("north", (0, 1.5, 0), (2, 0.5, 2)),
        ("south", (0, -1.5, 0), (2, 0.5, 2)),
        ("ceiling", (0, 0, 1.5), (2, 2, 0.5)),
        ("floor", (0, 0, -1.5), (2, 2, 0.5)),
    )
)
"""A room inside: x from -2 to 2, y and z from -1 to 1."""

HALF = np.array([2.0, 1.0, 1.0])


def loaded(content):
    env = ravemj.Environment()
    env.StopSimulation()
    env.LoadData(f"<Environment>{content}</Environment>")
    return env


def on_link(sensor, name="device", more="<Translation>0 0 0.1</Translation>", link="base"):
    return f'<AttachedSensor name="{name}"><link>{link}</link>{more}{sensor}</AttachedSensor>'


def robot(sensors, links='<Body name="base" type="static"/>'):
    return f'<Robot name="r"><KinBody>{links}</KinBody>{sensors}</Robot>'


def switched_on(env, name="r:device"):
    sensor = env.GetSensor(name)
    assert sensor.Configure(PowerOn) == 1
    return sensor


def to_the_walls(origin, directions):
    """How far it is from a point in the room to its walls."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return ((np.sign(directions) * HALF - origin) / directions).min(axis=1, initial=np.inf, where=directions != 0)


def test_a_sensor_that_is_on_lets_time_pass():
    """Scripts wait for the stamp of the data to change, and command nothing else."""
    env = ravemj.Environment()
    env.LoadData(f"<Environment>{robot(on_link(LASER))}</Environment>")
    laser = switched_on(env)
    await_that(lambda: laser.GetSensorData().stamp > 0, "time stood still")
    env.Destroy()


LASER = """<Sensor type="BaseLaser2D"><min_angle>-180</min_angle><max_angle>179</max_angle><resolution>1</resolution>
<max_range>1.5</max_range><time_scan>0.1</time_scan></Sensor>"""


def test_a_laser_measures_a_room():
    env = loaded(ROOM + robot(on_link(LASER)))
    T = ravemj.matrixFromAxisAngle([0, 0, 0.3])
    T[:3, 3] = [0.5, 0.2, 0]
    env.GetRobot("r").SetTransform(T)
    laser = switched_on(env)
    data = laser.GetSensorData()
    angles = 0.3 + np.radians(np.arange(-180, 180))
    directions = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(360)])
    expected = to_the_walls(np.array([0.5, 0.2, 0.1]), directions)
    assert (expected > 1.5).any()
    np.testing.assert_allclose(data.positions, [[0.5, 0.2, 0.1]], atol=1e-12)
    np.testing.assert_array_equal(data.intensity, expected <= 1.5)
    np.testing.assert_allclose(data.ranges, np.minimum(expected, 1.5)[:, None] * directions, atol=1e-9)
    assert (data.type, data.stamp) == (Sensor.Type.Laser, 0)
    numbers = laser.SendCommand("collidingbodies").split()
    bodies = [env.GetBodyFromEnvironmentBodyIndex(int(number)) for number in numbers]
    assert {body and body.GetName() for body in bodies} == {"north", "south", None}
    assert (np.array([body is not None for body in bodies]) == (data.intensity == 1)).all()


def test_a_laser_scans_once_in_its_time_and_sees_what_moves():
    env = loaded(ROOM + robot(on_link(LASER)))
    laser = switched_on(env)
    stamps, ranges = [], []
    for _ in range(25):
        env.StepSimulation(0.01)
        ranges.append(np.linalg.norm(laser.GetSensorData().ranges[180]))
        stamps.append(laser.GetSensorData().stamp)
        env.GetRobot("r").SetTransform([1, 0, 0, 0, env.GetSimulationTime() * 1e-6, 0, 0])
    assert sorted(set(stamps)) == [10_000, 110_000, 210_000]
    np.testing.assert_allclose([ranges[5], ranges[15]], [1.5, 1.5])
    np.testing.assert_allclose(ranges[24], 1.5)
    env.GetRobot("r").SetTransform([1, 0, 0, 0, 1, 0, 0])
    assert np.linalg.norm(laser.GetSensorData().ranges[180]) == pytest.approx(1.5), "time has passed since the scan"
    env.StepSimulation(0.1)
    data = laser.GetSensorData()
    data.ranges[:] = 7
    assert np.linalg.norm(laser.GetSensorData().ranges[180]) == pytest.approx(1), "users have copies"


def test_a_laser_measures_while_time_passes_by_itself():
    env = loaded(ROOM + robot(on_link(LASER)))
    laser = switched_on(env)
    env.StartSimulation(0.05, realtime=False)
    await_that(lambda: laser.GetSensorData().stamp > 300_000)
    env.StopSimulation()
    assert (laser.GetSensorData().intensity == 1).any()


def test_a_laser_looks_beyond_what_is_too_near():
    near = box("near", (0.05, 0, 0), (0.01, 1, 1))
    look = (
        '<Sensor type="BaseLaser2D"><min_angle>0</min_angle><max_angle>0</max_angle><min_range>{}</min_range></Sensor>'
    )
    for least, expected in ((0.03, 0.04), (0.05, 0.06), (0.08, 2.0)):
        env = loaded(ROOM + near + robot(on_link(look.format(least), more="")))
        (ranges,) = switched_on(env).GetSensorData().ranges
        np.testing.assert_allclose(ranges, [expected, 0, 0], atol=1e-9)


def test_a_laser_spins():
    spin = """<Sensor type="BaseSpinningLaser2D"><min_angle>-90</min_angle><max_angle>90</max_angle>
        <resolution>0.5</resolution><spinaxis>2 0 0</spinaxis><spinpos>0 0.5 0</spinpos>
        <spinspeed>1.5</spinspeed></Sensor>"""
    env = loaded(ROOM + robot(on_link(spin, more="")))
    laser = switched_on(env)
    for _ in range(10):
        env.StepSimulation(0.1)
    data = laser.GetSensorData()
    turn = ravemj.matrixFromAxisAngle([1.5, 0, 0])[:3, :3]
    angles = np.radians(np.arange(-90, 90.25, 0.5))
    directions = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(361)]) @ turn.T
    origin = np.array([0, 0.5, 0]) - turn @ [0, 0.5, 0]
    np.testing.assert_allclose(data.positions[0], origin, atol=1e-12)
    np.testing.assert_allclose(data.ranges, to_the_walls(origin, directions)[:, None] * directions, atol=1e-8)
    laser.Configure(PowerOn)
    assert laser.GetSensorData().positions[0] == pytest.approx([0, 0, 0]), "it begins anew"


def test_a_flash_lidar_measures_through_its_pixels():
    lidar = '<Sensor type="BaseFlashLidar3D"><KK>8 10 4 3</KK><width>9</width><height>7</height></Sensor>'
    env = loaded(ROOM + robot(on_link(lidar, more="")))
    data = switched_on(env).GetSensorData()
    through = np.array([((u - 4) / 8, (v - 3) / 10, 1) for u in range(9) for v in range(7)])
    directions = through / np.linalg.norm(through, axis=1, keepdims=True)
    np.testing.assert_allclose(data.ranges, to_the_walls(np.zeros(3), directions)[:, None] * directions, atol=1e-9)


CAMERA = '<Sensor type="BaseCamera"><KK>100 90 40 20</KK><width>64</width><height>48</height></Sensor>'


def test_a_camera_measures_the_depth_of_a_plane_and_says_what_it_shows():
    tilted = """<KinBody name="wall"><Body name="wall" type="static"><Translation>0 0 2</Translation>
        <RotationAxis>0 1 0 30</RotationAxis><Geom type="box"><Extents>0.5 0.5 0.001</Extents></Geom></Body>
        </KinBody>"""
    env = loaded(tilted + robot(on_link(CAMERA, more="")))
    camera = switched_on(env)
    depth, labels = camera.depth_image(), camera.segmentation_image()
    u, v = np.meshgrid((np.arange(64) + 0.5 - 40) / 100, (np.arange(48) + 0.5 - 20) / 90)
    normal = np.array([math.sin(math.radians(30)), 0, math.cos(math.radians(30))])
    expected = (2 * normal[2] - 0.001) / (normal[0] * u + normal[2])  # the face that looks back
    inside = np.abs(expected * v) < 0.5
    inside &= np.abs(((expected - 2) * normal[2] * 0 + expected * u) * normal[2] - (expected - 2) * normal[0]) < 0.495
    outside = np.abs(expected * v) > 0.505
    assert inside.any()
    np.testing.assert_allclose(depth[inside], expected[inside], atol=1e-4)
    assert np.isinf(depth[outside]).all()
    index = env.GetKinBody("wall").GetEnvironmentBodyIndex()
    assert (labels[inside] == [index, 0]).all()
    assert (labels[outside] == [0, -1]).all()
    laser = ravemj.RaveCreateSensor(env, "BaseLaser2D")
    laser.Configure(PowerOn)
    with pytest.raises(ravemj.openrave_exception, match="not a camera"):
        laser.depth_image()


HAND = """<Body name="base" type="static"/><Body name="hand"><Mass type="custom"><total>2</total><com>0.1 0 0</com>
<inertia>0.01 0 0 0 0.01 0 0 0 0.01</inertia></Mass></Body><Joint name="wrist" type="hinge"><Body>base</Body>
<Body>hand</Body><axis>0 0 1</axis></Joint>"""


LOAD = """<KinBody name="load"><Body name="load"><Geom type="box"><Extents>0.1 0.1 0.1</Extents></Geom>
<Mass type="mimicgeom"><density>375</density></Mass></Body></KinBody>"""
"""A cube of 3 kg."""


def with_physics(env):
    engine = ravemj.RaveCreatePhysicsEngine(env, "mujoco")
    engine.SetGravity([0, 0, -9.81])
    env.SetPhysicsEngine(engine)
    return env


def test_a_force_sensor_holds_a_known_mass():
    turned = "<Translation>0.05 0 0.2</Translation><RotationAxis>1 0 0 90</RotationAxis>"
    env = loaded(robot(on_link('<Sensor type="BaseForce6D"/>', more=turned, link="hand"), HAND))
    sensor = switched_on(env)
    env.StepSimulation(0.01)
    with pytest.raises(ravemj.openrave_exception, match="SetPhysicsEngine"):
        sensor.GetSensorData()
    with_physics(env)
    data = sensor.GetSensorData(Sensor.Type.Force6D)
    np.testing.assert_allclose(data.force, [0, 2 * 9.81, 0], atol=1e-6)  # its y points up
    np.testing.assert_allclose(data.torque, [0, 0, 2 * 9.81 * 0.05], atol=1e-6)
    assert env.LoadData(f"<Environment>{LOAD}</Environment>")
    load = env.GetKinBody("load")
    load.SetTransform([1, 0, 0, 0, 0.05, 0, 0.2])
    hand = env.GetRobot("r").GetLink("hand")
    env.GetRobot("r").Grab(load, hand)
    for _ in range(20):
        env.StepSimulation(0.01)
    held = sensor.GetSensorData()
    np.testing.assert_allclose(held.force, [0, 5 * 9.81, 0], rtol=0.01, atol=0.05)  # MuJoCo's welds give a little
    geometry = sensor.GetSensorGeometry()
    geometry.polarity = -1
    geometry.correction_matrix = (np.eye(6) * 2).ravel()
    assert sensor.SetSensorGeometry(geometry)
    np.testing.assert_allclose(sensor.GetSensorData().force, -2 * held.force)


def test_forces_follow_gravity_before_any_step():
    sensors = on_link('<Sensor type="BaseForce6D"/>', "force", link="hand")
    sensors += on_link('<Sensor type="BaseIMU"/>', "imu", link="hand")
    env = with_physics(loaded(robot(sensors, HAND)))
    force, imu = switched_on(env, "r:force"), switched_on(env, "r:imu")
    for gravity in (1.62, 3.7):  # on the moon and on Mars
        env.GetPhysicsEngine().SetGravity([0, 0, -gravity])
        np.testing.assert_allclose(force.GetSensorData().force, [0, 0, 2 * gravity], atol=1e-9)
        np.testing.assert_allclose(imu.GetSensorData().linear_acceleration, [0, 0, gravity], atol=1e-9)


PENDULUM = """<Body name="base" type="static"/><Body name="rod"><Mass type="custom"><total>1.5</total>
<com>0 0 -0.4</com><inertia>0.02 0 0 0 0.02 0 0 0 0.02</inertia></Mass></Body>
<Joint name="hinge" type="hinge" circular="true">
<Body>base</Body><Body>rod</Body><axis>1 0 0</axis></Joint>"""


def test_an_imu_swings_on_a_pendulum():
    place = "<Translation>0 0 -0.7</Translation>"
    env = with_physics(loaded(robot(on_link('<Sensor type="BaseIMU"/>', more=place, link="rod"), PENDULUM)))
    pendulum, imu = env.GetRobot("r"), switched_on(env)
    pendulum.SetDOFValues([1.0])
    fastest = 0.0
    for _ in range(60):
        env.StepSimulation(0.01)
        (angle,), (speed,) = pendulum.GetDOFValues(), pendulum.GetDOFVelocities()
        alpha = -1.5 * 9.81 * 0.4 * math.sin(angle) / (0.02 + 1.5 * 0.4**2)
        data = imu.GetSensorData()
        np.testing.assert_allclose(data.angular_velocity, [speed, 0, 0], atol=1e-9)
        expected = [0, 0.7 * alpha + 9.81 * math.sin(angle), 0.7 * speed**2 + 9.81 * math.cos(angle)]
        np.testing.assert_allclose(data.linear_acceleration, expected, atol=1e-6)
        np.testing.assert_allclose(data.rotation, [math.cos(angle / 2), math.sin(angle / 2), 0, 0], atol=1e-9)
        fastest = max(fastest, abs(speed))
    assert fastest > 3


def test_an_imu_without_physics_takes_differences_of_velocities():
    env = loaded(robot(on_link('<Sensor type="BaseIMU"/>', more="", link="rod"), PENDULUM))
    env.GetPhysicsEngine().SetGravity([0, 0, -10])
    imu = switched_on(env)
    np.testing.assert_allclose(imu.GetSensorData().linear_acceleration, [0, 0, 10])
    for speed in (0.0, 0.1):
        env.GetRobot("r").SetVelocity([speed, 0, 0], [0, 0, 0])
        env.StepSimulation(0.05)
    np.testing.assert_allclose(imu.GetSensorData().linear_acceleration, [2, 0, 10], atol=1e-12)


def test_odometry_and_encoders():
    sensors = on_link('<Sensor type="BaseOdometry"/>', "odometry", "<Translation>0 0 -0.5</Translation>", "rod")
    sensors += on_link('<Sensor type="BaseJointEncoder"><resolution>0.25</resolution></Sensor>', "encoder")
    env = loaded(box("crate", (1, 2, 3), (0.1, 0.1, 0.1)) + robot(sensors, PENDULUM))
    pendulum = env.GetRobot("r")
    pendulum.SetDOFValues([0.6])
    pendulum.SetDOFVelocities([2.0])
    odometry, encoder = switched_on(env, "r:odometry"), switched_on(env, "r:encoder")
    data = odometry.GetSensorData()
    np.testing.assert_allclose(data.pose[:3, 3], [0, 0.5 * math.sin(0.6), -0.5 * math.cos(0.6)], atol=1e-12)
    np.testing.assert_allclose(data.linear_velocity, [0, math.cos(0.6), math.sin(0.6)], atol=1e-12)
    np.testing.assert_allclose(data.angular_velocity, [2, 0, 0], atol=1e-12)
    read = encoder.GetSensorData()
    np.testing.assert_allclose([read.encoderValues, read.encoderVelocity, read.resolution], [[0.5], [2], [0.25]])
    geometry = odometry.GetSensorGeometry()
    geometry.targetid = "crate"
    assert odometry.SetSensorGeometry(geometry)
    np.testing.assert_array_equal(odometry.GetSensorData().pose[:3, 3], [1, 2, 3])
    env.Remove(env.GetKinBody("crate"))
    env.StepSimulation(0.01)
    with pytest.raises(ravemj.openrave_exception, match="crate"):
        odometry.GetSensorData()


def test_a_skin_feels_what_lies_on_it():
    plate = """<Body name="base" type="static"><Geom type="box"><Extents>1 1 0.1</Extents></Geom></Body>"""
    skin = '<Sensor type="BaseTactile"><thickness>0.002</thickness></Sensor>'
    env = with_physics(loaded(LOAD + robot(on_link(skin), plate)))
    env.GetKinBody("load").SetTransform([1, 0, 0, 0, 0.3, 0, 0.2])
    sensor = switched_on(env)
    for _ in range(40):
        env.StepSimulation(0.025)
    data = sensor.GetSensorData()
    np.testing.assert_allclose(data.forces.sum(axis=0), [0, 0, -3 * 9.81], atol=0.01)
    corners = [(0.2, -0.1), (0.2, 0.1), (0.4, -0.1), (0.4, 0.1)]
    np.testing.assert_allclose(sorted(map(tuple, data.positions[:, :2].round(3).tolist())), corners, atol=2e-3)
    assert data.thickness == 0.002


def test_sensors_without_a_robot():
    env = loaded(ROOM)
    laser = ravemj.RaveCreateSensor(env, "baselaser2d")
    assert laser.GetXMLId() == "baselaser2d"
    with pytest.raises(ravemj.openrave_exception, match="no name"):
        env.Add(laser)
    laser.SetName("door")
    env.Add(laser)
    other = ravemj.RaveCreateSensor(env, "BaseCamera")
    other.SetName("door")
    with pytest.raises(ravemj.openrave_exception, match="already"):
        env.Add(other)
    env.Add(other, True)
    assert [sensor.GetName() for sensor in env.GetSensors()] == ["door", "door0"]
    assert env.GetSensor("door") is laser
    geometry = laser.GetSensorGeometry()
    geometry.min_angle, geometry.max_angle, geometry.resolution = [0, 0], [math.pi / 2, 0], [math.pi / 2, 0]
    assert laser.SetSensorGeometry(geometry)
    laser.SetTransform([1, 0, 0, 0, 1.5, 0, 0])
    laser.Configure(PowerOn)
    np.testing.assert_allclose(laser.GetSensorData().ranges, [[0.5, 0, 0], [0, 1, 0]], atol=1e-12)
    env.StepSimulation(0.02)
    assert laser.GetSensorData().stamp == 20_000
    laser.Configure(RenderGeometryOn)
    laser.SetTransform([1, 0, 0, 0, 0, 0, 0.5])
    np.testing.assert_allclose(env.simulation.drawings.primitives().triangles.corners[0, 0], [0, 0, 0.5])
    assert env.Remove(laser)
    assert not env.Remove(laser)
    env.Reset()
    assert env.GetSensors() == []


def test_nothing_is_half_configured():
    sensors = (
        on_link('<Sensor type="BaseCamera"/>', "blank") + on_link(CAMERA, "loose", link="nowhere") + on_link(LASER)
    )
    with pytest.warns(ravemj.RavemjWarning, match="nowhere"):
        env = loaded(robot(sensors))
    for name, message in (("r:blank", "fx and fy above 0"), ("r:loose", "no link")):
        sensor = env.GetSensor(name)
        with pytest.raises(ravemj.openrave_exception, match=message):
            sensor.Configure(PowerOn)
        assert sensor.Configure(Sensor.ConfigureCommand.PowerCheck) == 0
    laser = switched_on(env)
    before = laser.GetSensorGeometry()
    for name, value, message in (
        ("resolution", [0, 0], "no rays"),
        ("resolution", [1e-9, 0], "can have 1,000,000"),
        ("resolution", [math.nan, 0], "finite"),
        ("resolution", [], "hold a number"),
        ("max_angle", [-7, 0], "no rays"),
        ("max_range", math.nan, "range"),
        ("min_range", -1, "range"),
        ("time_scan", -1, "time"),
        ("max_range", "far", "numbers"),
    ):
        geometry = laser.GetSensorGeometry()
        setattr(geometry, name, value)
        with pytest.raises(ravemj.openrave_exception, match=message):
            laser.SetSensorGeometry(geometry)
        assert laser.GetSensorGeometry() == before
    assert not laser.SetSensorGeometry(ravemj.CameraGeomData())
    robot_of_laser, info = env.GetRobot("r"), env.GetRobot("r").GetAttachedSensor("device").GetInfo()
    info._name, info._sensorgeometry.resolution = "second", [0, 0]
    with pytest.raises(ravemj.openrave_exception, match="cannot measure"):
        robot_of_laser.AddAttachedSensor(info)
    info._sensorgeometry = ravemj.CameraGeomData()
    with pytest.raises(ravemj.openrave_exception, match="does not describe BaseLaser2D"):
        robot_of_laser.AddAttachedSensor(info)
    assert len(robot_of_laser.GetAttachedSensors()) == 3
    camera = ravemj.CameraGeomData()
    camera.KK, camera.width, camera.height = [[math.nan, 0, 0], [0, 1, 0], [0, 0, 1]], 10, 10
    with pytest.raises(ravemj.openrave_exception, match="finite"):
        env.GetSensor("r:blank").SetSensorGeometry(camera)
    force = ravemj.RaveCreateSensor(env, "BaseForce6D")
    with pytest.raises(ravemj.openrave_exception, match="AddAttachedSensor"):
        force.Configure(PowerOn)
    for wrong in (99, "on", None):
        with pytest.raises(ravemj.openrave_exception, match="no command"):
            laser.Configure(wrong)
    with pytest.raises(ravemj.openrave_exception, match="finite"):
        env.CheckCollisionRays([[0, 0, 0, math.inf, 0, 0]])


def test_power_in_a_file():
    on = LASER.replace("<max_range>", "<power>1</power><color>1 0 0</color><max_range>")
    with pytest.warns(ravemj.RavemjWarning, match="stays off"):
        env = loaded(
            ROOM + robot(on_link(on) + on_link('<Sensor type="BaseCamera"><power>1</power></Sensor>', "blank"))
        )
    env.StepSimulation(0.01)
    assert env.GetSensor("r:device").GetSensorData().stamp == 10_000
    with pytest.raises(ravemj.openrave_exception, match="off"):
        env.GetSensor("r:blank").GetSensorData()


def test_noise_is_asked_for():
    env = loaded(ROOM + robot(on_link(LASER)))
    laser = switched_on(env)
    exact = laser.GetSensorData().ranges
    np.testing.assert_array_equal(laser.GetSensorData().ranges, exact)
    laser.set_noise(0.01, seed=1)
    errors = np.linalg.norm(laser.GetSensorData().ranges, axis=1) - np.linalg.norm(exact, axis=1)
    is_hit = laser.GetSensorData().intensity == 1
    assert errors[is_hit].std() == pytest.approx(0.01, rel=0.2)
    assert not errors[~is_hit].any()
    with pytest.raises(ravemj.openrave_exception):
        laser.set_noise(math.nan)
    laser.set_noise(0)
    np.testing.assert_array_equal(laser.GetSensorData().ranges, exact)


def test_viewers_draw_what_is_asked_for():
    env = loaded(ROOM + robot(on_link(LASER) + on_link(CAMERA, "camera")))
    laser, camera, drawings = switched_on(env), switched_on(env, "r:camera"), env.simulation.drawings
    env.StepSimulation(0.1)
    assert len(drawings.primitives()) == 0
    assert laser.Configure(RenderDataOn) == 1
    assert camera.Configure(RenderDataOn) == 0
    data = laser.GetSensorData()
    env.StepSimulation(0.1)
    drawn = drawings.primitives()
    met = data.intensity == 1
    np.testing.assert_allclose(drawn.points.corners[:, 0], (data.positions + data.ranges)[met], atol=1e-9)
    assert len(drawn.triangles.sizes) == 359
    laser.Configure(RenderDataOff)
    assert len(drawings.primitives()) == 0
    assert camera.Configure(RenderGeometryOn) == 1
    corners = drawings.primitives().lines.corners
    corner = np.array([-40 / 100, -20 / 90, 1])
    assert np.abs(np.cross(corners.reshape(-1, 3) - [0, 0, 0.1], corner)).sum(axis=1).min() < 1e-12
    env.GetRobot("r").SetTransform([1, 0, 0, 0, 1, 0, 0])
    env.StepSimulation(0.1)
    np.testing.assert_allclose(drawings.primitives().lines.corners, corners + np.array([1, 0, 0]), atol=1e-12)
    assert len(env.render(32, 24).reshape(-1, 3)) == 32 * 24
    env.Remove(env.GetRobot("r"))
    assert len(drawings.primitives()) == 0


def test_many_rays_find_what_single_rays_find():
    env = loaded(ROOM + box("post", (1, 0.3, 0), (0.1, 0.1, 0.5)))
    rng = np.random.default_rng(3)
    starts = np.repeat(rng.uniform(-0.9, 0.9, (10, 3)), 20, axis=0)
    rays = np.hstack([starts, rng.normal(size=(200, 3)) * 2])
    rays[7, 3:] = 0
    found, points = env.CheckCollisionRays(rays)
    report = ravemj.CollisionReport()
    for ray, is_hit, point in zip(rays, found, points, strict=True):
        assert env.CheckCollision(ravemj.Ray(ray[:3], ray[3:]), report) == is_hit
        if is_hit:
            np.testing.assert_allclose(point, [*report.contacts[0].pos, *report.contacts[0].norm], atol=1e-9)
    assert 20 < found.sum() < 190
    env.GetKinBody("post").Enable(False)
    post = env.CheckCollisionRays([[0, 0.3, 0, 1, 0, 0]], env.GetKinBody("post"))
    assert not post[0].any()


def test_rays_see_what_nobody_does():
    """Wholly transparent shapes collide, and disabled links do not."""
    env = loaded(box("glass", (1, 0, 0), (0.1, 1, 1)) + robot(on_link(LASER, more="")))
    glass, laser = env.GetKinBody("glass").GetLinks()[0], switched_on(env)
    ahead = 180
    glass.GetGeometries()[0].SetTransparency(1)
    assert laser.GetSensorData().ranges[ahead, 0] == pytest.approx(0.9)
    glass.Enable(False)
    assert laser.GetSensorData().intensity[ahead] == 0


@pytest.mark.parametrize("suffix", ["xml", "dae"])
def test_sensors_are_saved(tmp_path, suffix):
    kinds = {
        "BaseCamera": "<KK>100 90 40 20</KK><width>64</width><height>48</height><power>1</power><color>1 0 0.5</color>",
        "BaseLaser2D": "<min_angle>-13.7</min_angle><resolution>0.3</resolution><max_range>4</max_range>",
        "BaseSpinningLaser2D": "<spinaxis>0 1 0</spinaxis><spinspeed>-2</spinspeed><time_scan>0.1</time_scan>",
        "BaseFlashLidar3D": "<KK>8 10 4 3</KK><width>9</width><height>7</height><maxrange>5</maxrange>",
        "BaseForce6D": f"<polarity>-1</polarity><correction_matrix>{' '.join(map(str, range(36)))}</correction_matrix>",
        "BaseJointEncoder": "<resolution>0.1 0.2</resolution>",
        "BaseIMU": f"<measurement_time>0.1</measurement_time><rotation_covariance>{'2 ' * 9}</rotation_covariance>",
        "BaseOdometry": "<target>crate</target>",
        "BaseTactile": "<thickness>0.01</thickness>",
    }
    env = loaded(
        robot("".join(on_link(f'<Sensor type="{kind}">{text}</Sensor>', kind) for kind, text in kinds.items()))
    )
    first, second = tmp_path / f"first.{suffix}", tmp_path / f"second.{suffix}"
    env.Save(str(first))
    again = ravemj.load(first)
    again.Save(str(second))
    assert first.read_text() == second.read_text()
    for one, other in zip(env.GetSensors(), again.GetSensors(), strict=True):
        assert (one.description.is_on, one.description.color) == (other.description.is_on, other.description.color)
        device, read = one.device, other.device
        assert type(device) is type(read)
        defaults = type(device)()
        for field in device.__slots__:
            value = getattr(device, field)
            assert getattr(read, field) == (value if isinstance(value, str) else pytest.approx(value, rel=1e-11)), field
        assert device != defaults or one.GetXMLId() == "BaseSpinningLaser2D"
    info = env.GetSensor("r:BaseSpinningLaser2D").attached.GetInfo()
    read = ravemj.AttachedSensorInfo()
    read.DeserializeJSON(info.SerializeJSON())
    assert read._sensorgeometry == info._sensorgeometry
    assert read._sensorgeometry.spin_speed == -2


class TestCopies:
    """Copies of environments and robots measure as the originals do."""

    @pytest.fixture
    def devices(self, env):
        laser, camera = (env.GetRobot("eye").GetAttachedSensor(name).GetSensor() for name in ("laser", "camera"))
        laser.Configure(PowerOn)
        laser.set_noise(0.01, seed=1)
        camera.Configure(RenderGeometryOn)
        loose = ravemj.RaveCreateSensor(env, "BaseSpinningLaser2D")
        loose.SetName("door")
        loose.SetTransform([1, 0, 0, 0, 0.5, 0, 0.3])
        env.Add(loose)
        loose.Configure(PowerOn)
        return laser, camera, loose

    @staticmethod
    def states(sensor):
        commands = Sensor.ConfigureCommand
        checks = commands.PowerCheck, commands.RenderDataCheck, commands.RenderGeometryCheck
        return [sensor.Configure(command) for command in checks]

    def test_the_only_sensor_of_a_file_is_read(self, env, tmp_path):
        path = tmp_path / "door.xml"
        path.write_text('<Sensor type="BaseLaser2D" name="door"><maxrange>3</maxrange></Sensor>')
        sensor = env.ReadInterfaceURI(str(path))
        assert (sensor.GetName(), sensor.GetSensorGeometry().max_range) == ("door", 3)
        assert env.GetSensor("door") is None
        assert str(path) in env.files
        env.Add(sensor)
        assert env.GetSensor("door") == sensor
        path.write_text(f"<Environment>{path.read_text()}<KinBody name='k'><Body/></KinBody></Environment>")
        assert env.ReadInterfaceURI(str(path)).GetName() == "k"
        assert env.ReadKinBodyURI(str(path)).GetName() == "k"
        path.write_text("<Sensor")
        assert env.ReadInterfaceURI(str(path)) is None

    def test_of_an_environment(self, env, devices):
        options = ravemj.CloningOptions.Bodies | ravemj.CloningOptions.Sensors
        copy = env.CloneSelf(options)
        names = ["eye:camera", "eye:laser", "door"]
        assert [sensor.GetName() for sensor in copy.GetSensors()] == names
        for name in names:
            assert self.states(copy.GetSensor(name)) == self.states(env.GetSensor(name))
        np.testing.assert_allclose(copy.GetSensor("door").GetTransform(), devices[2].GetTransform(), atol=1e-12)
        first, second = (one.GetSensor("eye:laser").GetSensorData().ranges for one in (env, copy))
        np.testing.assert_array_equal(first, second)
        drawn = len(env.simulation.drawings.primitives())
        assert len(copy.simulation.drawings.primitives()) == drawn > 0
        copy.GetSensor("eye:laser").Configure(Sensor.ConfigureCommand.PowerOff)
        assert self.states(devices[0])[0] == 1
        copy.Clone(env, options)
        assert [sensor.GetName() for sensor in copy.GetSensors()] == names
        assert len(copy.simulation.drawings.primitives()) == drawn
        copy.Clone(env)
        assert [sensor.GetName() for sensor in copy.GetSensors()] == names[:2]

    def test_of_a_robot(self, env, devices):
        twin = ravemj.RaveClone(env.GetRobot("eye"), 0)
        assert self.states(twin.GetAttachedSensor("laser").GetSensor()) == [1, 0, 0]
        assert self.states(twin.GetAttachedSensor("camera").GetSensor()) == [0, 0, 1]
        twin.SetName("twin")
        env.Add(twin)
        assert env.GetSensor("twin:laser").GetSensorData().ranges.shape == (315, 3)

    def test_of_a_sensor(self, env, devices):
        _, _, loose = devices
        other = ravemj.RaveClone(loose)
        assert (other.GetName(), self.states(other)) == ("door", [1, 0, 0])
        other.SetTransform(np.eye(4))
        assert loose.GetTransform()[0, 3] == 0.5
        taken = ravemj.RaveClone(devices[0])
        np.testing.assert_allclose(taken.GetTransform(), devices[0].GetTransform())
        with pytest.raises(ravemj.openrave_exception, match="this is a 'BaseLaser2D'"):
            devices[0].Clone(loose)
        at = devices[0].GetTransform()
        taken.set_noise(0, seed=1)
        devices[0].Clone(taken)  # its robot carries it on
        np.testing.assert_array_equal(devices[0].GetTransform(), at)

    def test_of_a_sensor_that_needs_its_link(self, env):
        info = Robot.AttachedSensorInfo(_name="imu", _linkname="base", _sensorname="BaseIMU")
        imu = env.GetRobot("eye").AddAttachedSensor(info).GetSensor()
        imu.Configure(PowerOn)
        taken = ravemj.RaveClone(imu)
        assert self.states(taken)[0] == 0
        with pytest.raises(ravemj.openrave_exception, match="is off"):
            taken.GetSensorData()


class TestOfTheEnvironment:
    """Sensors that stand in an environment, and not on a robot."""

    FILE = """
<Sensor name="ceiling" type="BaseCamera">
  <KK>100 100 40 20</KK><width>80</width><height>40</height>
  <power>1</power><color>1 0 0</color><translation>0 0 3</translation><rotationaxis>1 0 0 180</rotationaxis>
</Sensor>
<Sensor name="door" type="BaseLaser2D">
  <translation>1 0 0</translation><translation>-0.5 0 0.2</translation>
  <min_angle>0</min_angle><max_angle>90</max_angle><resolution>90</resolution><power>1</power>
</Sensor>
<Sensor name="off" type="BaseFlashLidar3D"/>
<KinBody name="wall"><Body type="static">
  <Translation>2 0 0.5</Translation><Geom type="box"><extents>0.1 4 0.5</extents></Geom>
</Body></KinBody>
<KinBody name="floor"><Body type="static">
  <Translation>0 0 -0.5</Translation><Geom type="box"><extents>4 4 0.5</extents></Geom>
</Body></KinBody>"""

    def test_measure_where_they_are(self):
        env = loaded(self.FILE)
        ceiling, door, off = env.GetSensors()
        assert [one.Configure(Sensor.ConfigureCommand.PowerCheck) for one in env.GetSensors()] == [1, 1, 0]
        assert ceiling.description.color == (1, 0, 0)
        np.testing.assert_allclose(ceiling.depth_image(), 3, rtol=1e-3)
        np.testing.assert_allclose(door.GetTransformPose(), [1, 0, 0, 0, 0.5, 0, 0.2])
        data = door.GetSensorData()
        np.testing.assert_allclose(data.ranges[0], [1.4, 0, 0])
        assert list(data.intensity) == [1, 0]
        env.StepSimulation(0.02)
        assert door.GetSensorData().stamp == 20_000
        assert env.GetSensor("off") is off
        assert env.Remove(off)
        assert not env.GetSensor("off")

    @pytest.mark.parametrize(
        ("name", "format"), [("a.env.xml", "openrave"), ("a.dae", "collada"), ("a.zae", "collada")]
    )
    def test_are_saved_as_they_stand(self, tmp_path, name, format):
        env = loaded(self.FILE)
        env.GetSensor("door").SetTransform([0.6, 0, 0, 0.8, 1, 2, 3])
        (tmp_path / "again").mkdir()
        first, second = tmp_path / name, tmp_path / "again" / name
        env.Save(first, atts={"format": format})
        again = ravemj.load(first)
        again.Save(second, atts={"format": format})
        assert first.read_bytes() == second.read_bytes()
        for one, other in zip(env.GetSensors(), again.GetSensors(), strict=True):
            np.testing.assert_allclose(one.GetTransform(), other.GetTransform(), atol=1e-12)
            assert one.GetName() == other.GetName()
            assert (one.device, one.description.color) == (other.device, other.description.color)
            assert one.description.is_on == other.description.is_on

    def test_are_saved_without_a_body(self, tmp_path):
        for name, format in (("a.env.xml", "openrave"), ("a.dae", "collada")):
            loaded('<Sensor name="door" type="BaseLaser2D"/>').Save(tmp_path / name, atts={"format": format})
            assert [one.GetName() for one in ravemj.load(tmp_path / name).GetSensors()] == ["door"]

    def test_are_left_out_where_that_is_asked_for(self, tmp_path):
        env, path = loaded(self.FILE), tmp_path / "a.dae"
        for arguments in ((env.SelectionOptions.NoRobots,), (1, {"skipwrite": "sensors"}), (4, "wall")):
            env.Save(path, *arguments)
            assert ravemj.load(path).GetSensors() == []

    def test_are_lost_in_json(self, tmp_path):
        with pytest.warns(ravemj.RavemjWarning, match=r"not-written.*ceiling, door, off"):
            loaded(self.FILE).Save(tmp_path / "a.json")

    def test_in_files_of_their_own(self, tmp_path):
        (tmp_path / "eye.sensor.xml").write_text(
            '<sensor name="eye" type="BaseCamera"><KK>1 2 3 4</KK><translation>9 9 9</translation></sensor>'
        )
        env = ravemj.Environment()
        assert env.Load(tmp_path / "eye.sensor.xml")
        assert not env.Load(tmp_path / "eye.sensor.xml")  # the name is taken
        (tmp_path / "a.env.xml").write_text(
            "<Environment><Sensor file='eye.sensor.xml' name='other'><Translation>1 2 3</Translation><KK>5 6 7 8</KK>"
            "</Sensor></Environment>"
        )
        with pytest.warns(ravemj.RavemjWarning, match="<KK> is left out"):
            assert env.Load(tmp_path / "a.env.xml")
        assert [one.device.fx for one in env.GetSensors()] == [1, 1]
        assert [list(one.GetTransform()[:3, 3]) for one in env.GetSensors()] == [[9, 9, 9], [1, 2, 3]]

    def test_on_a_robot_the_place_is_that_of_the_attached_sensor(self):
        with pytest.warns(ravemj.RavemjWarning, match="the AttachedSensor says where it is"):
            env = loaded(robot(on_link('<Sensor type="BaseCamera"><Translation>9 9 9</Translation></Sensor>')))
        assert list(env.GetSensor("r:device").GetTransform()[:3, 3]) == [0, 0, 0.1]

    @pytest.mark.parametrize(
        ("content", "is_loaded", "words"),
        [
            ('<Sensor name="a"/>', False, "of no type"),
            ('<Sensor name="a" type="nose"/>', False, "no sensor of type 'nose'"),
            ('<Sensor name="a" type="BaseIMU"><power>1</power></Sensor>', True, "stays off: it measures what its link"),
            (
                '<Sensor name="a" type="BaseLaser2D"><power>1</power><resolution>0</resolution></Sensor>',
                True,
                "no rays",
            ),
        ],
    )
    def test_that_measure_nothing(self, content, is_loaded, words):
        env = ravemj.Environment()
        with pytest.warns(ravemj.RavemjWarning, match=words):
            assert env.LoadData(f"<Environment>{content}</Environment>") is is_loaded
        for sensor in env.GetSensors():
            assert sensor.Configure(Sensor.ConfigureCommand.PowerCheck) == 0

    def test_need_names_of_their_own(self, caplog):
        one = '<Sensor name="a" type="BaseCamera"/>'
        env = ravemj.Environment()
        assert not env.LoadData(f"<Environment>{one}{one}</Environment>")
        assert "there already is a sensor 'a'" in caplog.text
        assert len(env.GetSensors()) == 1
        with pytest.raises(ravemj.openrave_exception, match="no name"):
            env.LoadData('<Environment><Sensor type="BaseCamera"/></Environment>')
