"""Check of ro-2."""

import numpy as np

import ravemj
from ravemj.learn import Check


def pose(random):
    T = ravemj.matrixFromAxisAngle(random.uniform(-1.7, 1.7, 3))
    T[:3, 3] = random.uniform(-1, 1, 3)
    return T


def question(random):
    return pose(random), pose(random), pose(random)


def answer(T_world_hand, T_hand_camera, T_camera_cup):
    return T_world_hand @ T_hand_camera @ T_camera_cup


def added(*poses):
    T = answer(*poses)
    T[:3, 3] = sum(one[:3, 3] for one in poses)
    return T


CHECK = Check(
    function="cup_in_world",
    question=question,
    answer=answer,
    kind="pose",
    mistakes={
        "The poses are composed in the wrong order: start with the world, so that the inner names meet.": (
            lambda *poses: answer(*poses[::-1])
        ),
        "The positions are added in different frames: each has to be turned into the world's axes first.": added,
        "The matrices are multiplied number by number: the matrix product is @, not *.": lambda a, b, c: a * b * c,
        "The camera is left out: T_camera_cup has to be taken from the camera to the hand.": lambda a, b, c: a @ c,
        "That is the pose of the camera: the cup is left out.": lambda a, b, c: a @ b,
        "That is the cup in the frame of the hand: its pose in the world is still to be applied.": lambda a, b, c: (
            b @ c
        ),
    },
    hints=(
        "Write the names in a row, so that the end of one is the beginning of the next one.",
        "From the world to the hand, from the hand to the camera, from the camera to the cup; the product is @.",
        "T_world_hand @ T_hand_camera @ T_camera_cup",
    ),
)
