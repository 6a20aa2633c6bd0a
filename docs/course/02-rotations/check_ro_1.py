"""Check of ro-1."""

import numpy as np

from ravemj.learn import Check


def question(random):
    direction = random.normal(size=3)
    return random.uniform(0.5, 2.5) * direction / np.linalg.norm(direction), random.uniform(-np.pi, np.pi)


def answer(axis, angle):
    return formula(axis / np.linalg.norm(axis), angle)


def formula(u, angle, square_sign=1, skew_sign=1):
    K = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    return np.eye(3) + skew_sign * np.sin(angle) * K + square_sign * (1 - np.cos(angle)) * K @ K


def by_elements(axis, angle):
    u = axis / np.linalg.norm(axis)
    K = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K * K


def without_square(axis, angle):
    u = axis / np.linalg.norm(axis)
    return formula(u, angle, square_sign=0)


CHECK = Check(
    function="rotation",
    question=question,
    answer=answer,
    kind="rotation",
    angles=(1,),
    mistakes={
        "K * K multiplies element by element: the product of matrices is K @ K.": by_elements,
        "The axis need not be a unit vector: divide it by its length first.": formula,
        "The last part is missing, (1 - cos(angle)) K K: without it this is no rotation.": without_square,
        "The last part has the wrong sign: it is I + sin(angle) K + (1 - cos(angle)) K K.": lambda axis, angle: formula(
            axis / np.linalg.norm(axis), angle, square_sign=-1
        ),
        "The rotation is by the opposite angle: the signs in K are exchanged; K @ v should be np.cross(u, v).": (
            lambda axis, angle: answer(axis, -angle)
        ),
    },
    hints=(
        "First make the axis a unit vector u: divide it by np.linalg.norm(axis).",
        "Rodrigues' formula on the page needs the matrix K, for which K @ v is np.cross(u, v).",
        "np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K, with [0, -u[2], u[1]] as the first row of K.",
    ),
)
