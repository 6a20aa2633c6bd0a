"""Check of urdf-3."""

import warnings

import numpy as np

import ravemj
from ravemj.learn import Check


def gripper(path):
    """Return a function of the left joint that returns the heights and the positions of both fingers."""
    with warnings.catch_warnings():
        warnings.filterwarnings("error", r".*error\[")  # such as a mimic joint that follows none
        robot = ravemj.load(path).GetRobots()[0]
    left, fingers = robot.GetJoint("left"), [robot.GetLink(name) for name in ("left_finger", "right_finger")]
    if left is None or left.GetDOFIndex() < 0 or None in fingers:
        raise LookupError("the joint 'left' and both fingers should stay as they are; only 'right' is to be completed")

    def positions(value):
        robot.SetDOFValues([value], [left.GetDOFIndex()])
        return [finger.GetTransform()[1, 3] for finger in fingers]

    return positions


def question(random):
    return (random.uniform(0.002, 0.04),)


def answer(value):
    return np.array([value, -value - 0.002])


CHECK = Check(
    function=gripper,
    question=question,
    answer=answer,
    mistakes={
        "The right finger stands still: a joint follows another one by <mimic joint=.../>.": lambda value: np.array(
            [value, 0]
        ),
        "Both fingers move to the same side: the multiplier should be -1.": lambda value: np.array(
            [value, value - 0.002]
        ),
        "Both fingers move to the same side, without an offset: the multiplier should be -1, the offset -0.002.": (
            lambda value: np.array([value, value])
        ),
        "Both fingers move to the same side, and the offset has the wrong sign: it should be -1 and -0.002.": (
            lambda value: np.array([value, value + 0.002])
        ),
        "The offset has the wrong sign: the right finger is farther out, at smaller y.": lambda value: np.array(
            [value, -value + 0.002]
        ),
        "The offset is missing: the right finger is 2 mm farther out.": lambda value: np.array([value, -value]),
        "The offset is in millimetres, so the right finger stays at its limit: URDF has metres.": (
            lambda value: np.array([value, -0.05])
        ),
        "The multiplier is missing: the right finger stays at the offset.": lambda value: np.array([value, -0.002]),
    },
    hints=(
        "The joint needs one more tag. The page says which one, and what it has in it.",
        "The value of the right joint should be -1 times that of the left one, less 0.002.",
        'The tag is mimic, with joint="left", multiplier="-1" and offset="-0.002".',
    ),
)
