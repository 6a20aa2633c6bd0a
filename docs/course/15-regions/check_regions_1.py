"""Check of regions-1."""

import numpy as np

from ravemj.learn import Check

NAMES = ("x", "y", "z", "roll", "pitch", "yaw")


def question(random):
    return *random.uniform(0.4, 2, 2), random.uniform(0.02, 0.06)


def answer(length, width, radius):
    halves = np.array([length / 2 - radius, width / 2 - radius, 0, 0, 0, np.pi])
    return np.column_stack([-halves, halves])


def judge(Bw, *arguments):
    right = answer(*arguments)
    off = np.abs(Bw - right).max(axis=1) > 1e-5
    off[5] = not 2 * np.pi - 1e-5 <= Bw[5, 1] - Bw[5, 0] <= 4 * np.pi
    if not off.any():
        return None
    row = int(off.argmax())
    if row == 5:
        return f"yaw is between {Bw[5, 0]:.4g} and {Bw[5, 1]:.4g}, and should be free: a whole turn"
    lower, upper = right[row]
    return f"{NAMES[row]} is between {Bw[row, 0]:.4g} and {Bw[row, 1]:.4g}, and should be in [{lower:.4g}, {upper:.4g}]"


def changed(rows, to):
    """Return a function that makes a mistake: some rows get other bounds."""

    def mistake(*arguments):
        Bw = answer(*arguments)
        Bw[rows] = to
        return Bw

    return mistake


FREE = [-np.pi, np.pi]

CHECK = Check(
    function="bounds",
    question=question,
    answer=answer,
    judge=judge,
    mistakes={
        "The radius is forgotten: at the edge, half of the glass would hang over.": lambda length, width, radius: (
            answer(length, width, 0)
        ),
        "The lengths are not halved: the origin is in the middle of the table.": lambda length, width, radius: answer(
            2 * length, 2 * width, radius
        ),
        "The diameter is subtracted: the middle of the glass may come as near as its radius to the edge.": (
            lambda length, width, radius: answer(length, width, 2 * radius)
        ),
        "The radius is added: the glass would stand beside the table.": lambda length, width, radius: answer(
            length, width, -radius
        ),
        "The origin of the frame is in the middle of the table, not at its corner.": lambda length, width, radius: (
            answer(length, width, radius) + np.array([[length / 2], [width / 2], *[[0]] * 4])
        ),
        "The glass is not upright: roll and pitch should be 0.": changed([3, 4], FREE),
        "Roll is free and yaw is fixed: a turn about the vertical is the yaw, the last row.": changed(
            [3, 5], [FREE, [0, 0]]
        ),
        "Pitch is free and yaw is fixed: a turn about the vertical is the yaw, the last row.": changed(
            [4, 5], [FREE, [0, 0]]
        ),
        "Yaw is fixed: the glass may be turned about the vertical as it likes.": changed([5], [0, 0]),
        "Angles are in degrees: bounds are in radians, so a whole turn is from -pi to pi.": changed([5], [-180, 180]),
        "Length and width are exchanged: x is along the length.": lambda length, width, radius: answer(
            width, length, radius
        ),
        "Lower and upper bounds are exchanged: the lower one comes first.": lambda *arguments: answer(*arguments)[
            :, ::-1
        ],
    },
    hints=(
        "Six rows: three positions and three angles. Which of them are fixed, so that both bounds are 0?",
        "z, roll and pitch are fixed, and yaw is free. How near may the middle of the glass come to the edge?",
        "x from -(length / 2 - radius) to length / 2 - radius, y alike; z, roll, pitch [0, 0]; yaw [-np.pi, np.pi].",
    ),
)
