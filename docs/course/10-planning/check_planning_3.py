"""Check of planning-3."""

from collections import deque
from functools import cache
from itertools import pairwise

import numpy as np

import ravemj
from ravemj.learn import Check

BOXES = [[0, 0.26, -0.14, 0.03, 0.05, 0.04], [0, -0.1, 0.27, 0.03, 0.05, 0.05], [0, -0.28, -0.1, 0.03, 0.04, 0.05]]
FORGIVEN = 0.01  # a step of 0.04 rad may overlook 0.02 rad times reaches of 0.4 m and 0.2 m, at most 9 mm
ANGLES = np.linspace(-np.pi, np.pi, 61)
NEIGHBOURS = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]


@cache
def pendulum(smaller=0.0):
    env = ravemj.load(ravemj.model_path("pendulum"))
    for number, box in enumerate(BOXES):
        body = ravemj.RaveCreateKinBody(env, "")
        body.SetName(f"box{number}")
        body.InitFromBoxes(np.array([box]) - [0, 0, 0, smaller, smaller, smaller], True)
        env.Add(body)
    return env, env.GetRobots()[0]


def collision(waypoints, smaller=0.0, step=0.02):
    """Return the index of the first straight line of a path that touches a box, and the joint values; or None."""
    env, robot = pendulum(smaller)
    for index, (one, other) in enumerate(pairwise(waypoints)):
        for values in np.linspace(one, other, int(np.abs(other - one).max() / step) + 2):
            robot.SetDOFValues(values)
            if env.CheckCollision(robot):
                return index, values
    return None


@cache
def free():
    """Return which nodes of a grid are free, with all nodes around them, shape (61, 61)."""
    env, robot = pendulum()
    grid = np.zeros((len(ANGLES) + 2, len(ANGLES) + 2), dtype=bool)
    for i, j in np.ndindex(len(ANGLES), len(ANGLES)):
        robot.SetDOFValues(ANGLES[[i, j]])
        grid[i + 1, j + 1] = not env.CheckCollision(robot)
    return np.logical_and.reduce([grid[1 + i : 62 + i, 1 + j : 62 + j] for i, j in [(0, 0), *NEIGHBOURS]])


def parents_from(goal, start=None):
    """Return the parent of each node of the grid that can reach the goal, until the start is among them."""
    parents, queue = {goal: goal}, deque([goal])
    while queue and start not in parents:
        i, j = queue.popleft()
        for k, m in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
            if 0 <= k < len(ANGLES) and 0 <= m < len(ANGLES) and free()[k, m] and (k, m) not in parents:
                parents[k, m] = i, j
                queue.append((k, m))
    return parents


@cache
def connected():
    """Return the nodes of the largest free region, shape (n, 2)."""
    left, largest = set(map(tuple, np.argwhere(free()).tolist())), []
    while left:
        region = list(parents_from(next(iter(left))))
        left.difference_update(region)
        largest = max(largest, region, key=len)
    return np.array(sorted(largest))


@cache
def grid_path(start, goal):
    """Return the shortest path between two nodes of the grid."""
    parents, nodes = parents_from(goal, start), [start]
    while nodes[-1] != goal:
        nodes.append(parents[nodes[-1]])
    return ANGLES[np.array(nodes)]


def node(values):
    return tuple(int(np.abs(ANGLES - one).argmin()) for one in values)


def question(random):
    while True:
        ends = ANGLES[random.choice(connected(), 2)]
        if collision(ends, FORGIVEN, 0.1) is not None:
            return pendulum()[1], *ends


def answer(robot, start, goal):
    return grid_path(node(start), node(goal))


def judge(path, robot, start, goal):
    if np.abs(path[0] - start).max() > 1e-5:
        return f"the path begins at {path[0].round(4)}, and should begin at the start"
    if np.abs(path[-1] - goal).max() > 1e-5:
        return f"the path ends at {path[-1].round(4)}, and should end at the goal"
    found = collision(path, FORGIVEN)
    if found is None:
        return None
    return f"between waypoints {found[0]} and {found[0] + 1}, at {found[1].round(3)}, the pendulum touches a box"


CHECK = Check(
    function="plan",
    question=question,
    answer=answer,
    kind="joint values",
    judge=judge,
    any_length=True,
    mistakes={
        "This is the straight line: boxes block it.": lambda robot, start, goal: np.array([start, goal]),
        "The path is backwards: follow the parents from the goal to the start, and then reverse the path.": (
            lambda *arguments: answer(*arguments)[::-1]
        ),
        "The start is missing: the path should begin with it.": lambda *arguments: answer(*arguments)[1:],
        "The goal is missing: the path should end with it.": lambda *arguments: answer(*arguments)[:-1],
    },
    hints=(
        "Keep two lists: nodes, which begins with the start, and for each node the index of its parent.",
        "In a loop: sample (every fifth time the goal), find the nearest node, steer by 0.4 rad, check, append.",
        "If the new node is the goal, go back by index = parents[index] until it is 0; reverse what you collect.",
    ),
)
