"""In the manner of OpenRAVE's own examples: options, a main, a viewer if wanted."""
import openravepy
if not __openravepy_build_doc__:
    from openravepy import *
    from numpy import *
else:
    from openravepy import OpenRAVEGlobalArguments

def main(env, options):
    "Main example code."
    env.Load(options.scene)
    robot = env.GetRobots()[0]
    with env:
        robot.SetDOFValues(tile(0.01, robot.GetDOF()))
    print('options', options.scene, env.GetViewer() is not None, env.GetPhysicsEngine().GetXMLId(), env.GetCollisionChecker().GetXMLId())
    print('level', RaveGetDebugLevel() & 0xffff)

from optparse import OptionParser
from openravepy.misc import OpenRAVEGlobalArguments

@openravepy.with_destroy
def run(args=None):
    parser = OptionParser(description='Shows how examples start.')
    OpenRAVEGlobalArguments.addOptions(parser)
    parser.add_option('--scene', action="store", type='string', dest='scene', default='data/room.env.xml')
    (options, leftargs) = parser.parse_args(args=args)
    OpenRAVEGlobalArguments.parseAndCreateThreadedUser(options, main, defaultviewer=True)

if __name__ == "__main__":
    run()
