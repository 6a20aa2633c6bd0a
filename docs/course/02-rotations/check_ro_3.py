"""Check of ro-3."""

import numpy as np

import ravemj
from ravemj.learn import Check


def question(random):
    T = ravemj.matrixFromAxisAngle(random.uniform(-1.7, 1.7, 3))
    T[:3, 3] = random.uniform(-1, 1, 3)
    return (T,)


def answer(T_world_link):
    return np.linalg.inv(T_world_link)


def composed(R, p):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


CHECK = Check(
    function="inverse",
    question=question,
    answer=answer,
    kind="pose",
    mistakes={
        "The whole matrix is transposed: only the rotation is, and the last row stays 0 0 0 1.": lambda T: T.T,
        "The position is only negated: it also has to be turned into the link's axes, -R.T @ p.": lambda T: composed(
            T[:3, :3].T, -T[:3, 3]
        ),
        "The position is left as it was: the world's origin in the frame of the link is -R.T @ p.": lambda T: composed(
            T[:3, :3].T, T[:3, 3]
        ),
        "The sign of the position is wrong: seen from the link, the world lies in the opposite direction.": (
            lambda T: composed(T[:3, :3].T, T[:3, :3].T @ T[:3, 3])
        ),
        "The position is turned with R; it should be turned with its transpose.": lambda T: composed(
            T[:3, :3].T, -T[:3, :3] @ T[:3, 3]
        ),
        "That is the pose itself, not its inverse.": lambda T: T,
    },
    hints=(
        "A point of the link is at p_world = R @ p_link + p. Solve that for p_link.",
        "The inverse of a rotation is its transpose: p_link = R.T @ (p_world - p).",
        "Start with np.eye(4); its rotation becomes R.T, its position -R.T @ p.",
    ),
)
