"""Check of ja-5."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import precision

ARM = range(7)


@cache
def panda():
    """Return a Panda, and its joint values at the start."""
    env = ravemj.load(ravemj.model_path("panda"))
    robot = env.GetRobots()[0]
    return env, robot, robot.GetDOFValues(ARM)


def question(random):
    """Return an arm whose two shorter axes differ, so that the direction is well defined."""
    _, robot, _ = panda()
    lower, upper = robot.GetDOFLimits(ARM)
    while True:
        q = random.uniform(lower, upper)
        _, lengths = ellipsoid(robot, q)
        if lengths[2] < 0.8 * lengths[1]:
            return robot, q


def ellipsoid(robot, q):
    """Return the directions of the axes, as columns, and their lengths, the longest one first."""
    with robot:
        robot.SetDOFValues(q, ARM)
        directions, lengths, _ = np.linalg.svd(robot.GetActiveManipulator().CalculateJacobian())
    return directions, lengths


def answer(robot, q, column=2):
    return ellipsoid(robot, q)[0][:, column]


def judge(given, robot, q):
    if abs(np.linalg.norm(given) - 1) > precision(given):
        return f"its length is {np.linalg.norm(given):.4g}, and a unit vector's is 1"
    directions, lengths = ellipsoid(robot, q)
    speed = np.linalg.norm(lengths * (directions.T @ given))
    if np.abs(directions[:, :2].T @ given).max() <= precision(given):
        return None
    return f"along it, the tool reaches {speed:.3f} m/s, and along the shortest axis {lengths[2]:.3f} m/s"


CHECK = Check(
    function="slowest_direction",
    question=question,
    answer=answer,
    judge=judge,
    kind="direction",
    angles=(1,),
    mistakes={
        "That is the direction in which the tool is fastest: the last column of U is wanted.": lambda *q: answer(*q, 0),
        "That is the last row of U: the directions of the axes are its columns.": lambda *q: ellipsoid(*q)[0][2],
        "The joint values are not set: that is the direction where the robot was at the start.": lambda robot, q: (
            answer(robot, panda()[2])
        ),
    },
    hints=(
        "Set the joint values, ask for the Jacobian, and decompose it: U, lengths, Vt = np.linalg.svd(J).",
        "lengths are in decreasing order. The columns of U are the directions that belong to them.",
        "U[:, 2], or U[:, -1]",
    ),
)
