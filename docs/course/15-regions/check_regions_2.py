"""Check of regions-2."""

import numpy as np

import ravemj
from ravemj.learn import Check


def pose(random, scale=1.0):
    T = ravemj.matrixFromAxisAngle(scale * random.normal(size=3))
    T[:3, 3] = scale * random.uniform(-0.5, 0.5, 3)
    return T


def moved(numbers):
    """Return the displacement with six numbers: x, y, z, roll, pitch, yaw."""
    T = np.eye(4)
    for axis, angle in zip(np.eye(3), numbers[3:], strict=True):
        T = ravemj.matrixFromAxisAngle(axis * angle) @ T
    T[:3, 3] = numbers[:3]
    return T


def question(random):
    Bw = np.sort(random.uniform([[-1]] * 3 + [[-2.5], [-1.2], [-2.5]], [[1]] * 3 + [[2.5], [1.2], [2.5]], (6, 2)))
    numbers = random.uniform(Bw[:, 0], Bw[:, 1])
    if random.random() < 0.5:  # one number is outside
        i = random.integers(6)
        numbers[i] = random.choice([Bw[i, 0] - 0.02, Bw[i, 1] + 0.02]) + random.choice([-0.01, 0.01])
    T0_w, Tw_e = pose(random, 0.3), pose(random, 0.3)
    return T0_w, Tw_e, Bw, T0_w @ moved(numbers) @ Tw_e


def within(D, Bw, used=slice(6)):
    R = D[:3, :3]
    angles = np.arctan2(R[2, 1], R[2, 2]), -np.arcsin(np.clip(R[2, 0], -1, 1)), np.arctan2(R[1, 0], R[0, 0])
    numbers = np.array([*D[:3, 3], *angles])
    return bool(((numbers >= Bw[:, 0]) & (numbers <= Bw[:, 1]))[used].all())


def answer(T0_w, Tw_e, Bw, T):
    return bool(ravemj.Region(T0_w, Tw_e, Bw).contains(T))


inv = np.linalg.inv

CHECK = Check(
    function="contains",
    question=question,
    answer=answer,
    kind="boolean",
    questions=200,
    mistakes={
        "Tw_e is forgotten: multiply by its inverse, on the right.": lambda T0_w, Tw_e, Bw, T: within(
            inv(T0_w) @ T, Bw
        ),
        "T0_w is forgotten: multiply by its inverse, on the left.": lambda T0_w, Tw_e, Bw, T: within(T @ inv(Tw_e), Bw),
        "The tool's pose is taken for D: multiply by the inverses of T0_w, on the left, and of Tw_e, on the right.": (
            lambda T0_w, Tw_e, Bw, T: within(T, Bw)
        ),
        "T0_w and Tw_e are not inverted: solve T = T0_w @ D @ Tw_e for D.": lambda T0_w, Tw_e, Bw, T: within(
            T0_w @ T @ Tw_e, Bw
        ),
        "The order is wrong: the inverse of T0_w stands on the left of the tool's pose, that of Tw_e on the right.": (
            lambda T0_w, Tw_e, Bw, T: within(inv(Tw_e) @ T @ inv(T0_w), Bw)
        ),
        "Angles are not compared: all six numbers have bounds.": lambda T0_w, Tw_e, Bw, T: within(
            inv(T0_w) @ T @ inv(Tw_e), Bw, slice(3)
        ),
        "Positions are not compared: all six numbers have bounds.": lambda T0_w, Tw_e, Bw, T: within(
            inv(T0_w) @ T @ inv(Tw_e), Bw, slice(3, 6)
        ),
        "Roll and yaw are exchanged: roll is the fourth number, yaw the last.": lambda T0_w, Tw_e, Bw, T: within(
            inv(T0_w) @ T @ inv(Tw_e), Bw[[0, 1, 2, 5, 4, 3]]
        ),
        "Yes and no are exchanged.": lambda *arguments: not answer(*arguments),
    },
    hints=(
        "Solve T_world_tool = T0_w @ D @ Tw_e for D, with two inverses. On which sides do they stand?",
        "D = inv(T0_w) @ T_world_tool @ inv(Tw_e). Its first three numbers are in the last column.",
        "Compute the three angles from D[:3, :3] by the formulas; compare all six numbers with Bw[:, 0] and Bw[:, 1].",
    ),
)
