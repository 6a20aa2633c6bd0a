"""Classical mistakes in wrong answers are named, by the kind of the answer."""

import numpy as np
import pytest

from ravemj.learn.check import Check
from ravemj.learn.child import questions
from ravemj.learn.mistakes import recognized


def check_of(kind, answer, **changes):
    return Check("f", lambda random: tuple(random.uniform(0.5, 1.5, 3)), answer, ("a", "b", "c"), kind, **changes)


def rotation(a, b, c):
    turn_z = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    turn_x = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    return turn_z @ turn_x


def pose(a, b, c):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation(a, b, c), [a, b, c]
    return T


def transposed(T):
    return np.block([[T[:3, :3].T, T[:3, 3:]], [T[3:]]])


VECTOR = check_of("vector", lambda a, b, c: np.array([a, 2 * b, 3 * c]))
POSITION = check_of("position", lambda a, b, c: np.array([a, 2 * b, 3 * c]))
ANGLES = check_of("position", lambda a, b, c: np.array([np.cos(a), np.sin(a)]), angles=(0,))
JOINTS = check_of("joint values", lambda a, b, c: np.array([a, 2 * b, 3 * c]))
QUATERNION = check_of("quaternion", lambda a, b, c: np.array([a, b, c, 1]) / np.linalg.norm([a, b, c, 1]))


@pytest.mark.parametrize(
    ("check", "wrong", "says"),
    [
        (VECTOR, lambda a, b, c: [-a, -2 * b, -3 * c], "sign"),
        (VECTOR, lambda a, b, c: [3 * c, a, 2 * b], "another order: [2, 0, 1]"),
        (POSITION, lambda a, b, c: np.array([a, 2 * b, 3 * c]) * 1000, "in millimetres"),
        (POSITION, lambda a, b, c: np.array([a, 2 * b, 3 * c]) / 1000, "taken for metres"),
        (POSITION, lambda a, b, c: np.array([a, 2 * b, 3 * c]) / 2, "half"),
        (POSITION, lambda a, b, c: np.array([a, 2 * b, 3 * c]) * 2, "twice"),
        (ANGLES, lambda a, b, c: [np.cos(np.deg2rad(a)), np.sin(np.deg2rad(a))], "taken for degrees"),
        (ANGLES, lambda a, b, c: [np.cos(np.rad2deg(a)), np.sin(np.rad2deg(a))], "wrong way round"),
        (JOINTS, lambda a, b, c: np.rad2deg([a, 2 * b, 3 * c]), "in degrees"),
        (JOINTS, lambda a, b, c: [a + 2 * np.pi, 2 * b, 3 * c - 4 * np.pi], "whole turns"),
        (check_of("rotation", rotation), lambda *q: rotation(*q).T, "transposed"),
        (check_of("pose", pose), lambda *q: transposed(pose(*q)), "transposed"),
        (check_of("pose", pose), lambda *q: np.linalg.inv(pose(*q)), "inverted"),
        (QUATERNION, lambda *q: np.roll(QUATERNION.answer(*q), -1), "x y z w"),
        (QUATERNION, lambda *q: QUATERNION.answer(*q) * [1, -1, -1, -1], "inverse rotation"),
        (VECTOR, lambda a, b, c: [a, b, c], None),
        (VECTOR, lambda a, b, c: [a, 2 * b], None),
        (VECTOR, lambda a, b, c: "text", None),
    ],
)
def test_mistakes(check, wrong, says):
    asked = questions(check, 5)
    said = recognized(check, asked, [wrong(*arguments) for arguments in asked])
    assert said is None if says is None else says in said


def test_a_right_answer_is_no_mistake():
    asked = questions(QUATERNION, 5)
    assert all(QUATERNION.complaint(-QUATERNION.answer(*arguments), arguments) is None for arguments in asked)
    assert recognized(QUATERNION, asked, [-QUATERNION.answer(*arguments) for arguments in asked]) is None


def test_listed_mistakes_come_first_and_may_fail():
    failing = check_of(
        "vector",
        lambda a, b, c: np.array([a, b]),
        mistakes={"It divides by zero.": lambda *_: 1 / 0, "The two are added.": lambda a, b, c: [a + b, b]},
    )
    asked = questions(failing, 5)
    assert recognized(failing, asked, [[a + b, b] for a, b, _ in asked]) == "The two are added."
