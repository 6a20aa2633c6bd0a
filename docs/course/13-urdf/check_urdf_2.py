"""Check of urdf-2."""

import numpy as np

from ravemj.geometry_functions import rotationMatrixFromAxisAngle
from ravemj.learn import Check

X, Y, Z = np.eye(3)


def turn(axis, angle):
    return rotationMatrixFromAxisAngle(axis * angle)


def question(random):
    return tuple(random.uniform(-np.pi, np.pi, 3))


def answer(roll, pitch, yaw):
    return turn(Z, yaw) @ turn(Y, pitch) @ turn(X, roll)


CHECK = Check(
    function="rotation",
    question=question,
    answer=answer,
    kind="rotation",
    angles=(0, 1, 2),
    mistakes={
        "The turns are in the wrong order: the first one, about x, stands on the right.": lambda roll, pitch, yaw: (
            turn(X, roll) @ turn(Y, pitch) @ turn(Z, yaw)
        ),
        "Roll and yaw are exchanged: roll turns about x, and yaw about z.": lambda roll, pitch, yaw: answer(
            yaw, pitch, roll
        ),
        "Roll and yaw are exchanged, and the order of the turns is the wrong one.": lambda roll, pitch, yaw: (
            turn(X, yaw) @ turn(Y, pitch) @ turn(Z, roll)
        ),
        "Pitch has the wrong sign: a turn about y takes z to x, so its plus sine is on the upper right.": (
            lambda roll, pitch, yaw: answer(roll, -pitch, yaw)
        ),
        "Roll has the wrong sign: a turn about x takes y to z.": lambda roll, pitch, yaw: answer(-roll, pitch, yaw),
        "Yaw has the wrong sign: a turn about z takes x to y.": lambda roll, pitch, yaw: answer(roll, pitch, -yaw),
        "All three turns go the wrong way.": lambda roll, pitch, yaw: answer(-roll, -pitch, -yaw),
        "Roll, pitch and yaw are taken for one axis times an angle: they are three turns, one after the other.": (
            lambda *angles: rotationMatrixFromAxisAngle(angles)
        ),
    },
    hints=(
        "Write down three matrices, one for each turn. Which one acts on a vector first, and where does it stand?",
        "R = Rz @ Ry @ Rx. About z it is [[c, -s, 0], [s, c, 0], [0, 0, 1]]; about x the same with other rows.",
        "Rx = [[1, 0, 0], [0, c, -s], [0, s, c]], Ry = [[c, 0, s], [0, 1, 0], [-s, 0, c]]; mind the signs in Ry.",
    ),
)
