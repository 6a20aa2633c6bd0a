"""Cameras of robots."""

import numpy as np
import pytest

import ravemj
from ravemj import Sensor

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
    laser = env.GetSensor("eye:laser")
    laser.Configure(Sensor.ConfigureCommand.PowerOn)
    with pytest.raises(NotImplementedError, match="cameras"):
        laser.GetSensorData()
