"""Check of ja-2."""

import numpy as np

from ravemj.learn import Check


def question(random):
    axis = random.normal(size=3)
    return axis / np.linalg.norm(axis), random.uniform(-1, 1, 3), random.uniform(-1, 1, 3)


def answer(axis, anchor, point):
    return np.concatenate([np.cross(axis, point - anchor), axis])


def reversed_product(axis, anchor, point):
    return np.concatenate([np.cross(point - anchor, axis), axis])


CHECK = Check(
    function="column",
    question=question,
    answer=answer,
    kind="vector",
    mistakes={
        "The factors of the cross product are exchanged, or anchor and point: that changes its sign.": (
            reversed_product
        ),
        "The anchor is left out: the distance from the axis counts, not that from the origin.": (
            lambda axis, anchor, point: answer(axis, 0 * anchor, point)
        ),
        "That is the velocity of the anchor: the point is left out.": lambda axis, anchor, point: answer(
            axis, 0 * anchor, anchor
        ),
        "The two halves are exchanged: the velocity of the point comes first.": lambda *q: np.roll(answer(*q), 3),
    },
    hints=(
        "The point moves at a right angle to the axis, and to the line from the anchor to the point.",
        "np.cross(axis, ...) is at a right angle to both. What has to stand there?",
        "np.cross(axis, point - anchor), then axis; np.concatenate joins the two.",
    ),
)
