"""Check of ar-4."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import Scene, precision, shortened

ARM = range(7)
AWAY = 0.05


@cache
def panda():
    """Return a Panda, and its joint values at the start."""
    env = ravemj.load(ravemj.model_path("panda"))
    robot = env.GetRobots()[0]
    return env, robot, robot.GetDOFValues(ARM)


def question(random):
    """Return an arm whose elbow can be well away from where it is."""
    _, robot, _ = panda()
    lower, upper = robot.GetDOFLimits(ARM)
    while True:
        q = random.uniform(lower, upper)
        if moved(robot, q, [answer(robot, q)])[0] > 2 * AWAY:
            return robot, q


def tool(robot, q):
    with robot:
        robot.SetDOFValues(q, ARM, ravemj.CheckLimitsAction.Nothing)
        return robot.GetActiveManipulator().GetTransform()


def ways(robot, q):
    """Return what arm.ik answers to the pose of the tool at q."""
    return robot.GetActiveManipulator().ik(tool(robot, q))


def moved(robot, q, rows):
    """Return how far the elbow is from where it is at q, for each row of joint values."""
    Q = np.column_stack([[q, *rows], np.zeros(1 + len(rows))])  # and the fingers closed
    elbows = robot.batch_link_transforms(Q)[:, robot.GetLink("link4").GetIndex(), :3, 3]
    return np.linalg.norm(elbows[1:] - elbows[0], axis=1)


def answer(robot, q):
    """Return the joint values whose elbow is farthest away; q if arm.ik samples no others."""
    rows = [q, *valid(robot, q)]
    return rows[moved(robot, q, rows).argmax()]


def valid(robot, q):
    found = ways(robot, q)
    return found.solutions[0][found.valid[0]]


def judge(given, robot, q):
    lower, upper = robot.GetDOFLimits(ARM)
    beyond = np.maximum(lower - given, given - upper)
    if beyond.max() > precision(given):
        joint = int(np.argmax(beyond))
        return (
            f"joint {joint + 1} is at {given[joint]:.4g} rad; its limits are {lower[joint]:.4g} and {upper[joint]:.4g}"
        )
    T_world_tool, goal = tool(robot, given), tool(robot, q)
    if np.abs(T_world_tool - tool(robot, panda()[2])).max() < precision(given):
        return "the tool is where it was at the start; are the joint values set before the pose is asked for?"
    if np.abs(T_world_tool - goal).max() > precision(given):
        off = np.linalg.norm((T_world_tool - goal)[:3, 3])
        return f"the tool is {off:.3g} m away, or turned, from where it should stay: {shortened(goal[:3, 3])}"
    distance = moved(robot, q, [given])[0]
    return None if distance >= AWAY else f"the tool stays, but the elbow has moved by only {distance:.3g} m"


def invalid_row(robot, q):
    """Return the first row with another elbow, valid or not."""
    rows = ways(robot, q).solutions[0]
    return rows[moved(robot, q, rows) >= AWAY][0]


CHECK = Check(
    function="other_elbow",
    question=question,
    answer=answer,
    judge=judge,
    kind="joint values",
    scene=lambda robot, q: Scene("panda"),
    mistakes={
        "Those are the joint values that were given: the elbow is where it was.": lambda robot, q: q,
        "That row of the solutions has another elbow, but it is not valid: it does not reach the pose.": invalid_row,
        "That is the first valid solution: see where its elbow is before you take it.": lambda robot, q: valid(
            robot, q
        )[0],
    },
    hints=(
        "Set the joint values, and note two things: the pose of the tool, and where the elbow is.",
        "Ask arm.ik for all valid solutions of that pose. Then set one after the other, and see where the elbow is.",
        "Return the first row for which np.linalg.norm(new_elbow - elbow) is more than 0.05.",
    ),
)
