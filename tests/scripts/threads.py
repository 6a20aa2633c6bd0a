# Two threads share an environment with its lock.
import threading, time
from openravepy import *
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
wrong = []

def work(value):
    for i in range(50):
        with env:
            robot.SetDOFValues([value], [0])
            time.sleep(0.0001)
            if abs(robot.GetDOFValues([0])[0] - value) > 1e-12:
                wrong.append(value)

threads = [threading.Thread(target=work, args=(v,)) for v in (0.1, 0.2)]
[t.start() for t in threads]
[t.join() for t in threads]
print('wrong', len(wrong))
env.Lock()
other = []
t = threading.Thread(target=lambda: other.append(env.Lock(0.05)))
t.start(); t.join()
env.Unlock()
print('locked', other)
