# Python 2 as well: the neighbour of homework2_py2.py
GRID = 5
STEP = 0.7

def state(env, robot, values):
    "'free', or what it is"
    with robot:
        robot.SetActiveDOFValues(values)
        if env.CheckCollision(robot):
            return 'collision'
        elif robot.CheckSelfCollision():
            return 'self'
    return 'free'

if __name__ == '__main__':
    print "import me"
