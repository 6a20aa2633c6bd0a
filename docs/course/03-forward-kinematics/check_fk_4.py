"""Check of fk-4."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import Scene


@cache
def scara():
    env = ravemj.load(ravemj.model_path("scara"))
    return env, env.GetRobots()[0]


def question(random):
    _, robot = scara()
    return tuple(random.uniform(*robot.GetDOFLimits()))


def answer(*q):
    _, robot = scara()
    robot.SetDOFValues(q, range(4), ravemj.CheckLimitsAction.Nothing)
    return robot.GetActiveManipulator().GetTransform()


def looking_up(*q):
    """Return a pose without the half turn about x that makes the tool look down."""
    return answer(*q) @ np.diag([1.0, -1, -1, 1])


CHECK = Check(
    function="tool_pose",
    question=question,
    answer=answer,
    kind="pose",
    angles=(0, 1, 3),
    scene=lambda *q: Scene("scara", q),
    mistakes={
        "The axes of joints 2 and 4 point down: seen from above, they turn clockwise.": lambda q1, q2, q3, q4: answer(
            q1, -q2, q3, -q4
        ),
        "The axis of joint 2 points down: seen from above, it turns clockwise.": lambda q1, q2, q3, q4: answer(
            q1, -q2, q3, q4
        ),
        "The axis of joint 4 points down: seen from above, it turns clockwise.": lambda q1, q2, q3, q4: answer(
            q1, q2, q3, -q4
        ),
        "The axis of joint 3 points down: the tool sinks when its value grows.": lambda q1, q2, q3, q4: answer(
            q1, q2, -q3, q4
        ),
        "The tool looks down: turn its frame by half a turn about x.": looking_up,
        "The tool looks down, and the axes of joints 2 and 4 do so, too: from above they turn clockwise.": (
            lambda q1, q2, q3, q4: looking_up(q1, -q2, q3, -q4)
        ),
        "The quill's turn is left out: q4 turns the tool, too.": lambda q1, q2, q3, q4: answer(q1, q2, q3, 0),
    },
    hints=(
        "Seen from above, this is the arm of fk-1 with q1 and -q2; the height is 0.677 - q3.",
        "The tool's x-axis has the direction q1 - q2 - q4. Its z-axis points down.",
        "With a = q1 - q2 - q4, the rotation is [[cos a, sin a, 0], [sin a, -cos a, 0], [0, 0, -1]].",
    ),
)
