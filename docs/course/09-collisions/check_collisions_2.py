"""Check of collisions-2."""

import numpy as np

from ravemj.learn import Check


def question(random):
    start, goal = random.uniform(-3, 3, (2, 3))
    return start, goal, random.uniform(0.1, 1, 3), random.uniform(0.01, 0.1)


def bound(start, goal, reach):
    return np.abs(goal - start) @ reach


def answer(start, goal, reach, thickness):
    return np.ceil(bound(start, goal, reach) / thickness)


CHECK = Check(
    function="steps",
    question=question,
    answer=answer,
    kind="number",
    mistakes={
        "Absolute values are forgotten: a joint that turns backwards moves the robot, too.": lambda a, b, r, d: np.ceil(
            (b - a) @ r / d
        ),
        "The farthest reach counts for all joints: each angle is multiplied by the reach of its own joint.": (
            lambda a, b, r, d: np.ceil(np.abs(b - a).sum() * r.max() / d)
        ),
        "The number is rounded down: then a step is a little too long. Round up, with np.ceil.": lambda a, b, r, d: (
            np.floor(bound(a, b, r) / d)
        ),
        "The number is rounded to the nearest: if that is down, a step is too long. Round up.": lambda a, b, r, d: (
            np.round(bound(a, b, r) / d)
        ),
        "The number is not a whole one: round up.": lambda a, b, r, d: bound(a, b, r) / d,
        "This is the number of configurations: there is one step less.": lambda *arguments: answer(*arguments) + 1,
        "Joints that turn backwards cancel others: take absolute values before you add.": lambda a, b, r, d: np.ceil(
            abs((b - a) @ r) / d
        ),
        "Only the joint that moves the robot farthest counts here: the motions of all joints add up.": (
            lambda a, b, r, d: np.ceil((np.abs(b - a) * r).max() / d)
        ),
        "The reach is forgotten: an angle moves a point by angle times distance from the axis.": (
            lambda a, b, r, d: np.ceil(np.abs(b - a).sum() / d)
        ),
        "The bound is the sum over the joints, not the length of the vector: all may move it in one direction.": (
            lambda a, b, r, d: np.ceil(np.linalg.norm((b - a) * r) / d)
        ),
    },
    hints=(
        "How far does a point move at most from start to goal, if only one joint turns?",
        "By reach times angle. Add this over the joints, with absolute values; then divide it into pieces.",
        "np.ceil of the sum of reach * |goal - start|, divided by thickness.",
    ),
)
