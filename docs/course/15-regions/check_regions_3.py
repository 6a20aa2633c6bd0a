"""Check of regions-3."""

import numpy as np

import ravemj
from ravemj.learn import Check

NAMES = ("x", "y", "z", "roll", "pitch", "yaw")
COUNT = 60


def pose(random):
    T = ravemj.matrixFromAxisAngle(random.normal(size=3))
    T[:3, 3] = random.uniform(-0.5, 0.5, 3)
    return T


def question(random):
    widest = np.array([1, 1, 1, 2.5, 1.2, 2.5])
    return pose(random), pose(random), np.sort(random.uniform(-1, 1, (6, 2)) * widest[:, None]), COUNT


def displaced(numbers):
    T = np.eye(4)
    for axis, angle in zip(np.eye(3), numbers[3:], strict=True):
        T = ravemj.matrixFromAxisAngle(axis * angle) @ T
    T[:3, 3] = numbers[:3]
    return T


def answer(T0_w, Tw_e, Bw, count):
    return ravemj.Region(T0_w, Tw_e, Bw).sample(count, seed=0)


def numbers_of(T0_w, Tw_e, poses):
    """Return the six numbers of each pose, shape (n, 6)."""
    D = np.linalg.inv(T0_w) @ poses @ np.linalg.inv(Tw_e)
    roll, pitch = np.arctan2(D[:, 2, 1], D[:, 2, 2]), -np.arcsin(np.clip(D[:, 2, 0], -1, 1))
    return np.column_stack([D[:, :3, 3], roll, pitch, np.arctan2(D[:, 1, 0], D[:, 0, 0])])


def judge(poses, T0_w, Tw_e, Bw, count):
    R = poses[:, :3, :3]
    if np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max() > 1e-4 or np.abs(poses[:, 3] - [0, 0, 0, 1]).max() > 1e-6:
        return "these are no poses: rotations should have perpendicular columns of length 1, and the last row 0 0 0 1"
    numbers, widths = numbers_of(T0_w, Tw_e, poses), Bw[:, 1] - Bw[:, 0]
    outside = ((numbers < Bw[:, 0] - 1e-4) | (numbers > Bw[:, 1] + 1e-4)).sum(axis=0)
    if outside.any():
        i = int(outside.argmax())
        return f"{NAMES[i]} is outside of its bounds in {outside[i]} of {count} poses"
    spread = np.ptp(numbers, axis=0) < 0.6 * widths
    if spread.any():
        return f"{NAMES[int(spread.argmax())]} does not use its whole interval: is each pose drawn on its own?"
    uneven = np.abs(numbers.mean(axis=0) - Bw.mean(axis=1)) > 0.22 * widths
    if uneven.any():
        return f"{NAMES[int(uneven.argmax())]} is not distributed evenly between its bounds"
    if np.abs(np.corrcoef(numbers.T) - np.eye(6)).max() > 0.75:
        return "the numbers of a pose depend on one another: draw each of the six on its own"
    return None


def always(*numbers):
    """Return a function that returns the same pose always: at 0 of the lower, or 1 of the upper bounds."""

    def mistake(T0_w, Tw_e, Bw, count):
        values = Bw[:, 0] + np.array(numbers) * (Bw[:, 1] - Bw[:, 0])
        return np.tile(T0_w @ displaced(values) @ Tw_e, (count, 1, 1))

    return mistake


CHECK = Check(
    function="sample",
    question=question,
    answer=answer,
    judge=judge,
    mistakes={
        "These are the lower bounds always: draw between lower and upper bounds.": always(0),
        "These are the upper bounds always: draw between lower and upper bounds.": always(1),
        "This is the middle of the region always: draw by chance.": always(0.5),
        "This is the pose with six zeros always: draw numbers between the bounds.": lambda T0_w, Tw_e, Bw, count: (
            np.tile(T0_w @ Tw_e, (count, 1, 1))
        ),
    },
    hints=(
        "Draw six numbers for each pose, all at once with the columns of Bw. Then make D from them.",
        "The rotation of D is Rz(yaw) Ry(pitch) Rx(roll): the first turn stands on the right. Then set D[:3, 3].",
        "T0_w @ D @ Tw_e for each; and draw again for each of the `count` poses.",
    ),
)
