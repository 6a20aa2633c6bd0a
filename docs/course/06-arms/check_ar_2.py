"""Check of ar-2."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check

TURN = 2 * np.pi


@cache
def puma():
    env = ravemj.load(ravemj.model_path("puma560"))
    return env, env.GetRobots()[0]


def question(random):
    """Return all ways to a pose, some beyond the limits, and joint values that are at the pose or somewhere else."""
    _, robot = puma()
    lower, upper = robot.GetDOFLimits()
    goal, now = random.uniform(lower, upper, (2, 6))
    robot.SetDOFValues(goal)
    found = robot.GetActiveManipulator().ik(robot.GetActiveManipulator().GetTransform(), limits=False)
    return random.permutation(found.solutions[0][found.valid[0]]), now, lower, upper


def answer(solutions, now, lower, upper, choose=np.argmin):
    """Return the nearest of all rows, each with every angle turned to where it is nearest within its limits."""
    turned = solutions[:, :, np.newaxis] + TURN * np.arange(-2, 3)
    allowed = (turned >= lower[:, np.newaxis]) & (turned <= upper[:, np.newaxis])
    away = np.where(allowed, np.abs(turned - now[:, np.newaxis]), np.inf)
    rows = np.take_along_axis(turned, away.argmin(axis=2)[:, :, np.newaxis], axis=2)[:, :, 0]
    rows = rows[allowed.any(axis=2).all(axis=1)]
    return rows[choose(np.linalg.norm(rows - now, axis=1))]


def without_limits(solutions, now, lower, upper):
    return answer(solutions, now, np.full(6, -50.0), np.full(6, 50.0))


def as_given(solutions, now, lower, upper):
    """Return the nearest row, as it is."""
    return solutions[np.linalg.norm(solutions - now, axis=1).argmin()]


def first_turn(solutions, now, lower, upper):
    """Return the nearest row when each angle is turned into its limits, and no further."""
    turned = np.where(solutions < lower, solutions + TURN, np.where(solutions > upper, solutions - TURN, solutions))
    rows = turned[((turned >= lower) & (turned <= upper)).all(axis=1)]
    return rows[np.linalg.norm(rows - now, axis=1).argmin()]


def clipped(solutions, now, lower, upper):
    return np.clip(without_limits(solutions, now, lower, upper), lower, upper)


CHECK = Check(
    function="nearest",
    question=question,
    answer=answer,
    kind="joint values",
    mistakes={
        "The rows are compared as they are: an angle may be changed by whole turns, into the limits.": as_given,
        "The limits are forgotten: that is the nearest solution, but a joint cannot turn that far.": without_limits,
        "Joint 6 has a range of more than a turn: within the limits, the angle nearest to now may be a turn away.": (
            first_turn
        ),
        "Angles beyond the limits are clipped: that is another pose. Leave out a row that does not fit.": clipped,
        "That is the farthest solution: np.argmin finds the least distance.": lambda *arguments: answer(
            *arguments, np.argmax
        ),
        "That is the first solution within the limits, not the nearest.": lambda *arguments: answer(
            *arguments, lambda distances: 0
        ),
    },
    hints=(
        "Treat each angle by itself: of angle + 2 pi k with k from -2 to 2, keep those within its limits.",
        "Of these, take the one nearest to now. If an angle has none, the whole row is of no use.",
        "Then compare the rows that are left: min(rows, key=lambda q: np.linalg.norm(q - now))",
    ),
)
