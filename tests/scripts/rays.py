# A laser made of rays.
from openravepy import *
from numpy import *
env = Environment()
env.Load('data/room.env.xml')
env.Remove(env.GetRobots()[0])
env.Remove(env.GetKinBody('mug'))
dirs = array([[cos(a), sin(a), 0] for a in arange(0, 2*pi, pi/4)])
rays = c_[tile([0, 0, 0.15], (len(dirs), 1)), 2 * dirs]
collision, info = env.CheckCollisionRays(rays, None)
for hit, row, d in zip(collision, info, dirs):
    if hit:
        print('hit', round(linalg.norm(row[0:3] - [0, 0, 0.15]), 6), row[3:6])
report = CollisionReport()
down = Ray([0.6, 0, 1], [0, 0, -5])
print('down', env.CheckCollision(down, report), report.contacts[0].pos, report.contacts[0].norm)
print('range', env.CheckCollision(Ray([0.6, 0, 1], [0, 0, -0.5])), env.CheckCollision(down, env.GetKinBody('wall')))
