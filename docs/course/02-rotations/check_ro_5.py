"""Check of ro-5."""

import numpy as np

import ravemj
from ravemj.learn import Check


def question(random):
    axis = random.normal(size=3)
    angle = random.uniform(0.1, 2.9)
    return (ravemj.matrixFromAxisAngle(angle * axis / np.linalg.norm(axis))[:3, :3],)


def answer(R):
    return ravemj.quatFromRotationMatrix(R)


def axis_angle(R):
    """Return the angle and the unit vector of the axis."""
    quaternion = answer(R)
    quaternion = quaternion * np.sign(quaternion[0])
    half = np.arccos(quaternion[0])
    return 2 * half, quaternion[1:] / np.sin(half)


def whole_angle(R):
    angle, axis = axis_angle(R)
    return np.array([np.cos(angle), *(np.sin(angle) * axis)])


def not_unit(R):
    angle, axis = axis_angle(R)
    return np.array([np.cos(angle / 2), *axis])


CHECK = Check(
    function="quaternion",
    question=question,
    answer=answer,
    kind="quaternion",
    mistakes={
        "A quaternion has the sine and cosine of half the angle; these are of the whole one.": whole_angle,
        "The axis is not multiplied by sin(a / 2), so this is no unit quaternion.": not_unit,
        "That is the angle, then the axis; a quaternion has cos(a / 2), then sin(a / 2) times the axis.": lambda R: (
            np.concatenate([[axis_angle(R)[0]], axis_angle(R)[1]])
        ),
    },
    hints=(
        "First the angle: its cosine is (np.trace(R) - 1) / 2.",
        "R[2, 1] - R[1, 2] is 2 sin(a) times the x of the axis; R[0, 2] - R[2, 0] and R[1, 0] - R[0, 1] give y and z.",
        "w is sqrt(1 + trace) / 2; and x, y, z are these three differences, divided by 4 w.",
    ),
)
