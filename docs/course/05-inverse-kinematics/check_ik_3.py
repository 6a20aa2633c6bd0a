"""Check of ik-3."""

import numpy as np

from ravemj.learn import Check
from ravemj.learn.check import precision, shortened


def question(random):
    """Return a goal in reach, three times of four, or one that is too far or too near."""
    l1, l2 = random.permutation([random.uniform(0.7, 1.2), random.uniform(0.3, 0.6)])
    nearest, farthest = abs(l1 - l2), l1 + l2
    ranges = [(1.05 * nearest, 0.95 * farthest)] * 6 + [(0.02, 0.9 * nearest), (1.1 * farthest, 2 * farthest)]
    distance, direction = random.uniform(*random.choice(ranges)), random.uniform(-np.pi, np.pi)
    return distance * np.cos(direction), distance * np.sin(direction), l1, l2


def answer(x, y, l1, l2):
    cosine = (x**2 + y**2 - l1**2 - l2**2) / (2 * l1 * l2)
    if abs(cosine) > 1:
        return np.array([])
    return both(x, y, l1, l2, cosine)


def both(x, y, l1, l2, cosine):
    rows = []
    for q2 in (np.arccos(cosine), -np.arccos(cosine)):
        rows.append([np.arctan2(y, x) - np.arctan2(l2 * np.sin(q2), l1 + l2 * np.cos(q2)), q2])
    return np.array(rows)


def clipped(x, y, l1, l2):
    return both(x, y, l1, l2, np.clip((x**2 + y**2 - l1**2 - l2**2) / (2 * l1 * l2), -1, 1))


def of_rows(change):
    """Return the mistake that changes the rows of the right answer, where there are any."""

    def mistake(x, y, l1, l2):
        rows = answer(x, y, l1, l2)
        return change(rows, x, y) if len(rows) else rows

    return mistake


def half_circle(rows, x, y):
    return rows + np.array([np.arctan(y / x) - np.arctan2(y, x), 0])


def exchanged(rows, x, y):
    """Return solutions with the sign of the second arctan2 exchanged."""
    return np.column_stack([2 * np.arctan2(y, x) - rows[:, 0], rows[:, 1]])


def judge(given, x, y, l1, l2):
    for q in given:
        hand = [l1 * np.cos(q[0]) + l2 * np.cos(q.sum()), l1 * np.sin(q[0]) + l2 * np.sin(q.sum())]
        off = np.hypot(hand[0] - x, hand[1] - y)
        if off > precision(given):
            return f"{shortened(q)} takes the hand to {shortened(hand)}, {off:.3g} m from the goal"
    if len(given) and np.abs(np.exp(1j * given[0]) - np.exp(1j * given[1])).max() < precision(given):
        return "both rows are the same solution"
    return None


CHECK = Check(
    function="solutions",
    question=question,
    answer=answer,
    judge=judge,
    kind="joint values",
    mistakes={
        "Both solutions have the same q1: compute q1 for each q2 by itself.": of_rows(
            lambda rows, x, y: np.column_stack([rows[[0, 0], 0], rows[:, 1]])
        ),
        "Both solutions have the q1 of the negative q2: compute q1 for each q2 by itself.": of_rows(
            lambda rows, x, y: np.column_stack([rows[[1, 1], 0], rows[:, 1]])
        ),
        "q1 is the direction of the goal: subtract the angle between the goal and the first link.": of_rows(
            lambda rows, x, y: np.column_stack([np.full(2, np.arctan2(y, x)), rows[:, 1]])
        ),
        "That is one elbow of two: arccos returns one angle, and its negative has the same cosine.": of_rows(
            lambda rows, x, y: rows[:1]
        ),
        "That is one elbow of two: the positive angle q2 has the same cosine.": of_rows(lambda rows, x, y: rows[1:]),
        "That is one solution, and not in a list: return a list of both elbows.": of_rows(lambda rows, x, y: rows[0]),
        "A goal out of reach is replaced by the nearest one: where there is no solution, return [].": clipped,
        "np.arctan(y / x) knows only two quadrants: np.arctan2(y, x) knows all four.": of_rows(half_circle),
        "q2 is measured from the first link, not from the x-axis: subtract q1.": of_rows(
            lambda rows, x, y: np.column_stack([rows[:, 0], rows.sum(axis=1)])
        ),
        "q1 belongs to the other elbow: the angle between hand and first link has the wrong sign.": of_rows(exchanged),
        "q2 is the angle inside of the elbow: that is 180 degrees minus the joint's angle.": of_rows(
            lambda rows, x, y: np.column_stack([rows[:, 0], np.pi * np.sign(rows[:, 1]) - rows[:, 1]])
        ),
    },
    hints=(
        "First cos(q2), by the law of cosines. If it is not between -1 and 1, return [].",
        "q2 is np.arccos of that, or its negative: these are the two elbows. Then q1 by the formula on the page.",
        "For each q2: q1 = np.arctan2(y, x) - np.arctan2(l2 * np.sin(q2), l1 + l2 * np.cos(q2))",
    ),
)
