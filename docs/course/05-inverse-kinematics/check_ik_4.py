"""Check of ik-4."""

import numpy as np

from ravemj.learn import Check
from ravemj.learn.check import precision, shortened


def question(random):
    """Return a hand whose wrist is in reach, three times of four, or too far or too near."""
    l1, l2 = random.permutation([random.uniform(0.7, 1.2), random.uniform(0.3, 0.6)])
    nearest, farthest = abs(l1 - l2), l1 + l2
    ranges = [(1.05 * nearest, 0.95 * farthest)] * 6 + [(0.02, 0.9 * nearest), (1.1 * farthest, 2 * farthest)]
    distance, direction, phi = random.uniform(*random.choice(ranges)), *random.uniform(-np.pi, np.pi, 2)
    l3 = random.uniform(0.2, 0.5)
    x = distance * np.cos(direction) + l3 * np.cos(phi)
    y = distance * np.sin(direction) + l3 * np.sin(phi)
    return x, y, phi, l1, l2, l3


def two_links(x, y, l1, l2):
    cosine = (x**2 + y**2 - l1**2 - l2**2) / (2 * l1 * l2)
    if abs(cosine) > 1:
        return np.zeros((0, 2))
    elbow = np.arccos(cosine)
    return np.array(
        [[np.arctan2(y, x) - np.arctan2(l2 * np.sin(q2), l1 + l2 * np.cos(q2)), q2] for q2 in (elbow, -elbow)]
    )


def answer(x, y, phi, l1, l2, l3):
    rows = two_links(x - l3 * np.cos(phi), y - l3 * np.sin(phi), l1, l2)
    return np.column_stack([rows, phi - rows.sum(axis=1)]) if len(rows) else np.array([])


def with_wrist(wrist):
    """Return the mistake that computes the last angle in another way."""

    def mistake(x, y, phi, l1, l2, l3):
        rows = two_links(x - l3 * np.cos(phi), y - l3 * np.sin(phi), l1, l2)
        return np.column_stack([rows, wrist(phi, rows)]) if len(rows) else np.array([])

    return mistake


def wrist_at_hand(x, y, phi, l1, l2, l3):
    return answer(x + l3 * np.cos(phi), y + l3 * np.sin(phi), phi, l1, l2, l3)


def wrist_in_front(x, y, phi, l1, l2, l3):
    return answer(x + 2 * l3 * np.cos(phi), y + 2 * l3 * np.sin(phi), phi, l1, l2, l3)


def one_elbow(index):
    """Return the mistake that returns one of the solutions alone."""
    return lambda *arguments: answer(*arguments)[index:][:1]


def judge(given, x, y, phi, l1, l2, l3):
    for q in given:
        angles = np.cumsum(q)
        hand = [l1, l2, l3] @ np.column_stack([np.cos(angles), np.sin(angles)])
        off = np.hypot(hand[0] - x, hand[1] - y)
        if off > precision(given):
            return f"{shortened(q)} takes the hand to {shortened(hand)}, {off:.3g} m from the goal"
        turned = np.angle(np.exp(1j * (angles[2] - phi)))
        if abs(turned) > precision(given):
            return f"{shortened(q)} takes the hand to the goal, but its direction is off by {turned:.3g} rad"
    if len(given) and np.abs(np.exp(1j * given[0]) - np.exp(1j * given[1])).max() < precision(given):
        return "both rows are the same solution"
    return None


CHECK = Check(
    function="solutions",
    question=question,
    answer=answer,
    judge=judge,
    kind="joint values",
    angles=(2,),
    mistakes={
        "q3 is measured from the second link: subtract q1 and q2 from phi.": with_wrist(
            lambda phi, rows: np.full(len(rows), phi)
        ),
        "q3 is measured from the second link, which points along q1 + q2: q1 is not subtracted.": with_wrist(
            lambda phi, rows: phi - rows[:, 1]
        ),
        "q3 has the wrong sign: it is what is missing to phi, phi - (q1 + q2).": with_wrist(
            lambda phi, rows: rows.sum(axis=1) - phi
        ),
        "The wrist is taken for the hand: it is l3 behind it, at x - l3 cos(phi), y - l3 sin(phi).": wrist_at_hand,
        "The wrist is behind the hand, not in front of it: subtract l3 along phi.": wrist_in_front,
        "That is one elbow of two: arccos returns one angle, and its negative has the same cosine.": one_elbow(0),
        "That is one elbow of two: the positive angle q2 has the same cosine.": one_elbow(1),
    },
    hints=(
        "The wrist is at the beginning of the third link. The direction phi says where that is.",
        "The wrist is at x - l3 cos(phi), y - l3 sin(phi): two links take it there, as in ik-3.",
        "For each q1, q2 of the wrist: q3 = phi - q1 - q2",
    ),
)
