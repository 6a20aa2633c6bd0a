# A class of the user's around a robot, Python 2, with string exceptions of the time avoided.
import openravepy
from openravepy import *
class ArmController(object):
	"""tabs, as editors left them"""
	def __init__(self, env, name="arm"):
		self.env = env
		self.robot = env.GetRobot(name)
		if self.robot is None:
			raise Exception, "no robot %s" % name
	def move(self, **joints):
		for name, degrees in joints.iteritems():
			j = self.robot.GetJoint(name)
			self.robot.SetDOFValues([degrees * 3.141592653589793 / 180], [j.GetDOFIndex()])
		return self.robot.GetActiveManipulator().GetTransform()
env = Environment()
env.Load("data/room.env.xml")
arm = ArmController(env)
T = arm.move(shoulder=90, elbow=-90)
print "x=%.3f y=%.3f" % (T[0][3], T[1][3]),
print "z=%.3f" % T[2,3]
try:
	ArmController(env, "leg")
except Exception, e:
	print `str(e)`, 5/2, 5/2.
exec "result = len(env.GetBodies())"
print result
