"""planning-3: Can you find a path around the boxes?

The double pendulum hangs among three boxes. Return a path from the joint values `start` to `goal`, shape (n, 2) [rad],
on whose straight lines it touches no box. All angles may be between -pi and pi; the straight line is always blocked.

Check the straight lines of your path in steps of at most 0.04 rad; it is examined a little more kindly. A path does not
go on from pi to -pi. All 20 paths together may take 10 s.

The robot may be asked: `robot.SetDOFValues(values)`, then `robot.GetEnv().CheckCollision(robot)`. Leave the planners of
ravemj for later; about forty lines will do, in as many functions as you like.
"""

import numpy as np


def plan(robot, start, goal):
    """Return the waypoints of a path from start to goal, shape (n, 2)."""
    random = np.random.default_rng()
    nodes, parents = [np.array(start)], [0]
    while True:
        sample = goal if random.random() < 0.2 else random.uniform(-np.pi, np.pi, 2)
        nearest = np.linalg.norm(np.array(nodes) - sample, axis=1).argmin()
        new = _steer(nodes[nearest], sample, 0.4)
        if not _is_free(robot, nodes[nearest], new):
            continue
        nodes.append(new)
        parents.append(nearest)
        if np.array_equal(new, goal):
            break
    path, index = [goal], len(nodes) - 1
    while index:
        index = parents[index]
        path.append(nodes[index])
    return path[::-1]


def _steer(node, sample, step):
    length = np.linalg.norm(sample - node)
    return sample if length <= step else node + step / length * (sample - node)


def _is_free(robot, start, goal):
    """Return whether nothing is touched on a straight line."""
    count = int(np.ceil(np.linalg.norm(goal - start) / 0.04)) + 1
    for values in np.linspace(start, goal, count):
        robot.SetDOFValues(values)
        if robot.GetEnv().CheckCollision(robot):
            return False
    return True
