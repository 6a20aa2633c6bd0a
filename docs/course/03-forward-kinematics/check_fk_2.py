"""Check of fk-2."""

import numpy as np

import ravemj
from ravemj.learn import Check


def question(random):
    return (*random.uniform(-1.5, 1.5, 3), *random.uniform(0.2, 0.8, 3))


def turn(x, y, z):
    return ravemj.matrixFromAxisAngle([x, y, z])


def shift(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def factors(q1, q2, q3, h, a, b):
    return turn(0, 0, q1), shift(0, 0, h), turn(0, q2, 0), shift(a, 0, 0), turn(0, q3, 0), shift(b, 0, 0)


def product(*poses):
    return np.linalg.multi_dot(poses)


def answer(*arguments):
    return product(*factors(*arguments))


def moved_first(*arguments):
    turn1, height, turn2, upper, turn3, lower = factors(*arguments)
    return product(height, turn1, upper, turn2, lower, turn3)


CHECK = Check(
    function="hand_pose",
    question=question,
    answer=answer,
    kind="pose",
    angles=(0, 1, 2),
    mistakes={
        "a and b are exchanged: the upper arm, which comes first, has the length a.": lambda q1, q2, q3, h, a, b: (
            answer(q1, q2, q3, h, b, a)
        ),
        "Joint 3 is left out: its turn stands before the shift along the forearm.": lambda q1, q2, q3, *rest: answer(
            q1, q2, 0, *rest
        ),
        "The factors are in the wrong order: begin with the base, and go outwards.": lambda *q: product(
            *factors(*q)[::-1]
        ),
        "Each link is moved along before its joint turns: first turn, then move along the turned axis.": moved_first,
        "A turn about y has its -sin in the lower left corner: it turns z towards x.": lambda q1, q2, q3, *rest: answer(
            q1, -q2, -q3, *rest
        ),
        "The turn about z has the wrong sign: its -sin is in the first row.": lambda q1, *rest: answer(-q1, *rest),
        "q3 is measured from the upper arm: the product adds q2 by itself.": lambda q1, q2, q3, *rest: answer(
            q1, q2, q3 - q2, *rest
        ),
        "That is the end of the upper arm: the forearm is left out.": lambda q1, q2, q3, h, a, b: answer(
            q1, q2, q3, h, a, 0
        ),
        "The column is left out: joint 2 is at the height h.": lambda q1, q2, q3, h, a, b: answer(q1, q2, q3, 0, a, b),
        "Joints 2 and 3 turn about y; here they turn about z like the first one.": lambda q1, q2, q3, h, a, b: product(
            turn(0, 0, q1), shift(0, 0, h), turn(0, 0, q2), shift(a, 0, 0), turn(0, 0, q3), shift(b, 0, 0)
        ),
    },
    hints=(
        "Six factors, from the base outwards: a turn, a shift, a turn, a shift, a turn, a shift.",
        "Turn about z by q1, shift by h along z, turn about y by q2, shift by a along x; then the forearm.",
        "turn_z(q1) @ shift(0, 0, h) @ turn_y(q2) @ shift(a, 0, 0) @ turn_y(q3) @ shift(b, 0, 0)",
    ),
)
