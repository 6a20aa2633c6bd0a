# Attached sensors: where they are, and what the camera's matrix is.
from openravepy import *
env = Environment()
env.StopSimulation()
env.Load('data/arm.robot.xml')
robot = env.GetRobots()[0]
for attached in robot.GetAttachedSensors():
    sensor = attached.GetSensor()
    print('sensor', attached.GetName(), sensor.GetName(), attached.GetAttachingLink().GetName())
    geometry = sensor.GetSensorGeometry(Sensor.Type.Camera)
    print('camera', geometry.KK[0, 0], geometry.width, geometry.height)
robot.SetDOFValues([1.5707963267948966], [0])
print('looks', robot.GetAttachedSensor('eye').GetTransform()[0:3, 2], env.GetSensor('arm:eye').GetTransform()[0:3, 3])
print('unknown', robot.GetAttachedSensor('ear'), env.GetSensor('ear'), len(env.GetSensors()))
sensor.Configure(Sensor.ConfigureCommand.PowerOn)
env.StepSimulation(0.1)
data = sensor.GetSensorData(Sensor.Type.Camera)
print('image', data.imagedata.shape, data.imagedata.dtype, data.KK[0, 2])
print('made', RaveCreateSensor(env, 'baselaser2d').GetXMLId())
