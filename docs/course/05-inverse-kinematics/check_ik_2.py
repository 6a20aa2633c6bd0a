"""Check of ik-2."""

import numpy as np

from ravemj.learn import Check
from ravemj.learn.check import precision, shortened


def question(random):
    l1, l2 = random.uniform(0.3, 1.2, 2)
    q1, q2 = random.uniform(-np.pi, np.pi), random.choice([-1, 1]) * random.uniform(0.3, 2.8)
    return l1 * np.cos(q1) + l2 * np.cos(q1 + q2), l1 * np.sin(q1) + l2 * np.sin(q1 + q2), l1, l2


def answer(x, y, l1, l2):
    return points(x, y, l1, along=(x**2 + y**2 + l1**2 - l2**2) / (2 * np.hypot(x, y)))


def points(x, y, l1, along):
    """Return the points of the first circle that are so far along the line to the hand."""
    u = np.array([x, y]) / np.hypot(x, y)
    aside = np.sqrt(l1**2 - along**2) * np.array([-u[1], u[0]])
    return np.array([along * u - aside, along * u + aside])


def judge(given, x, y, l1, l2):
    for elbow in given:
        for name, length, centre in (("shoulder", l1, (0, 0)), ("hand", l2, (x, y))):
            distance = np.linalg.norm(elbow - centre)
            if abs(distance - length) > precision(given):
                return f"{shortened(elbow)} is {distance:.4g} m from the {name}, and should be {length:.4g} m"
    if np.linalg.norm(given[0] - given[1]) < precision(given):
        return "both rows are the same point"
    return None


CHECK = Check(
    function="elbows",
    question=question,
    answer=answer,
    judge=judge,
    kind="position",
    mistakes={
        "h is forgotten: these points are on the line to the hand, beside which the elbows are.": lambda x, y, l1, l2: (
            np.tile(answer(x, y, l1, l2).mean(axis=0), (2, 1))
        ),
        "That is one elbow of two: the other one is its mirror image at the line to the hand.": (
            lambda *arguments: answer(*arguments)[0]
        ),
        "That is one elbow of two: the other one is its mirror image; here h has the other sign.": (
            lambda *arguments: answer(*arguments)[1]
        ),
        "Both rows are the same elbow: in one of them, h has the other sign.": lambda *arguments: answer(*arguments)[
            [0, 0]
        ],
        "Both rows are the same elbow; the other one is its mirror image.": lambda *arguments: answer(*arguments)[
            [1, 1]
        ],
        "l1 and l2 are exchanged: a is measured from the shoulder, so it has + l1² - l2².": lambda x, y, l1, l2: answer(
            x, y, l2, l1
        ),
        "The x and y of each elbow are exchanged.": lambda *arguments: answer(*arguments)[:, ::-1],
    },
    hints=(
        "The unit vector towards the hand is u = [x, y] / d; at a right angle to it is v = [-y, x] / d.",
        "How far along u is the elbow? a on the page says it. How far to the side? h² = l1² - a².",
        "np.array([a * u + h * v, a * u - h * v])",
    ),
)
