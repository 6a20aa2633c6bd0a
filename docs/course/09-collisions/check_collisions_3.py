"""Check of collisions-3."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check

STEPS = 40


@cache
def panda():
    env = ravemj.load(ravemj.model_path("panda"))
    post = ravemj.RaveCreateKinBody(env, "")
    post.SetName("post")
    post.InitFromBoxes(np.array([[0.45, 0, 0.5, 0.05, 0.05, 0.5]]), True)
    env.Add(post)
    return env, env.GetRobots()[0]


def collides(values):
    """Return whether the robot touches itself, and whether it touches the post."""
    env, robot = panda()
    robot.SetDOFValues(values)
    return robot.CheckSelfCollision(), env.CheckCollision(robot)


def drawn(random, wanted):
    """Return random joint values that touch the robot (0), the post (1), or nothing (2)."""
    _, robot = panda()
    while True:
        values = random.uniform(*robot.GetDOFLimits())
        found = collides(values)
        if found[wanted] if wanted < 2 else not any(found):
            return values


def just_touching(random):
    """Return a start, and a goal between which only the goal collides."""
    while True:
        start, goal = drawn(random, 2), drawn(random, random.integers(2))
        free, hit = 0.0, 1.0
        while hit - free > hit / STEPS:
            middle = (free + hit) / 2
            free, hit = (free, middle) if any(collides(start + middle * (goal - start))) else (middle, hit)
        goal = start + hit * (goal - start)
        if first(table(start, goal).any(axis=1)) == STEPS:
            return start, goal


def passing(random):
    """Return a start and a goal with several collisions between them, of which bisection finds a later one."""
    _, robot = panda()
    while True:
        start, goal = drawn(random, 2), drawn(random, random.integers(2))
        if bisection(robot, start, goal) != answer(robot, start, goal):
            return start, goal


def question(random):
    _, robot = panda()
    kind = random.random()
    if kind < 0.6:
        return robot, drawn(random, 2), drawn(random, random.integers(3))
    return robot, *(just_touching(random) if kind < 0.8 else passing(random))


@cache
def _table(start, goal):
    return np.array([collides(values) for values in np.linspace(start, goal, STEPS + 1)])


def table(start, goal):
    """Return for each configuration whether it touches the robot and the post, shape (41, 2)."""
    return _table(tuple(start), tuple(goal))


def first(bad):
    return int(np.argmax(bad)) if bad.any() else -1


def answer(robot, start, goal):
    return first(table(start, goal).any(axis=1))


def forty(robot, start, goal):
    """Return the answer for 40 configurations, which are 39 steps."""
    return first(np.array([any(collides(values)) for values in np.linspace(start, goal, STEPS)]))


def bisection(robot, start, goal):
    bad = table(start, goal).any(axis=1)
    low, high = 0, STEPS
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if bad[middle] else (middle, high)
    return high if bad[high] else -1


CHECK = Check(
    function="first_collision",
    question=question,
    answer=answer,
    kind="number",
    mistakes={
        "np.linspace(start, goal, 40) has 39 steps: 40 steps need 41 configurations.": forty,
        "Self-collision is forgotten: CheckCollision(robot) tells only about what else the robot touches.": (
            lambda robot, start, goal: first(table(start, goal)[:, 1])
        ),
        "The environment is forgotten: CheckSelfCollision tells only whether the robot touches itself.": (
            lambda robot, start, goal: first(table(start, goal)[:, 0])
        ),
        "This is the last configuration in collision: the first one is asked for.": lambda robot, start, goal: (
            STEPS - first(table(goal, start).any(axis=1)) if table(start, goal).any() else -1
        ),
        "This halves the line again and again: it finds a collision, but may overlook an earlier one.": bisection,
        "This is one too few: the configuration before the collision is still free.": lambda robot, start, goal: (
            answer(robot, start, goal) - (answer(robot, start, goal) > 0)
        ),
        "This is one too many: the start is number 0.": lambda robot, start, goal: (
            answer(robot, start, goal) + (answer(robot, start, goal) >= 0)
        ),
        "The goal is left out: there are 41 configurations, from 0 to 40.": lambda robot, start, goal: first(
            table(start, goal).any(axis=1)[:-1]
        ),
        "If there is no collision, the answer is -1.": lambda robot, start, goal: max(answer(robot, start, goal), 0),
        "This goes backwards, from the goal to the start.": lambda robot, start, goal: answer(robot, goal, start),
        "A collision counts if it is with the robot itself or with the post; it need not be both.": (
            lambda robot, start, goal: first(table(start, goal).all(axis=1))
        ),
    },
    questions=30,
    hints=(
        "Which joint values has configuration k? Those at the fraction k / 40 of the line from start to goal.",
        "Put the robot there with SetDOFValues, and ask both questions. Stop at the first yes.",
        "for k in range(41): set start + k / 40 * (goal - start), and return k if it collides. After this loop: -1.",
    ),
)
