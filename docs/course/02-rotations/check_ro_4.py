"""Check of ro-4."""

import numpy as np

import ravemj
from ravemj.learn import Check


def pose(random):
    T = ravemj.matrixFromAxisAngle(random.uniform(-1.7, 1.7, 3))
    T[:3, 3] = random.uniform(-1, 1, 3)
    return T


def answer(T_world_hand, T_world_cup):
    return np.linalg.inv(T_world_hand) @ T_world_cup


def subtracted(T_world_hand, T_world_cup):
    T = answer(T_world_hand, T_world_cup)
    T[:3, 3] = T_world_cup[:3, 3] - T_world_hand[:3, 3]
    return T


CHECK = Check(
    function="cup_in_hand",
    question=lambda random: (pose(random), pose(random)),
    answer=answer,
    kind="pose",
    mistakes={
        "The transpose is not the inverse of a pose: it is that of its rotation alone.": lambda hand, cup: hand.T @ cup,
        "Only the rotation of the hand is inverted: its position is subtracted before, in world axes.": (
            lambda hand, cup: np.vstack([hand[:3, :3].T @ cup[:3] - np.outer(hand[:3, 3], [0, 0, 0, 1]), cup[3]])
        ),
        "Wrong order: the inverse of T_world_hand stands on the left, so that world meets world.": lambda hand, cup: (
            cup @ np.linalg.inv(hand)
        ),
        "The wrong pose is inverted: it is that of the hand, whose name has to begin with hand.": lambda hand, cup: (
            hand @ np.linalg.inv(cup)
        ),
        "The pose of the hand is not inverted: T_world_hand @ T_world_cup has no names that meet.": lambda hand, cup: (
            hand @ cup
        ),
        "The difference of the positions is in world axes; it has to be turned into those of the hand.": subtracted,
        "Poses are not subtracted: the last row of the result shows it.": lambda hand, cup: cup - hand,
    },
    hints=(
        "T_hand_cup should begin with hand. Which of the two poses has to be inverted for that?",
        "T_hand_world is the inverse of T_world_hand.",
        "np.linalg.inv(T_world_hand) @ T_world_cup",
    ),
)
