"""Check of collisions-1."""

import numpy as np

from ravemj.learn import Check


def question(random):
    centre1, centre2 = random.uniform(-1, 1, (2, 3))
    return centre1, random.uniform(0.05, 0.5, 3), centre2, random.uniform(0.05, 0.5, 3)


def gaps(centre1, extents1, centre2, extents2):
    return np.abs(centre2 - centre1) - extents1 - extents2


def answer(*arguments):
    return np.linalg.norm(np.maximum(gaps(*arguments), 0))


CHECK = Check(
    function="distance",
    question=question,
    answer=answer,
    kind="number",
    mistakes={
        "Extents are taken for whole lengths: they are half of the sides, so both count fully.": (
            lambda c1, e1, c2, e2: answer(c1, e1 / 2, c2, e2 / 2)
        ),
        "Extents are doubled: they are half of the sides already, measured from the centre.": (
            lambda c1, e1, c2, e2: answer(c1, 2 * e1, c2, 2 * e2)
        ),
        "Negative gaps are kept: along an axis on which the boxes overlap, the gap is 0.": (
            lambda *arguments: np.linalg.norm(gaps(*arguments))
        ),
        "This is the distance of the centres: the boxes begin earlier.": (
            lambda c1, e1, c2, e2: np.linalg.norm(c2 - c1)
        ),
        "This is the largest gap alone: the nearest points may be apart along several axes.": (
            lambda *arguments: max(gaps(*arguments).max(), 0)
        ),
        "The gaps are added: the distance is the length of the vector of the gaps.": (
            lambda *arguments: np.maximum(gaps(*arguments), 0).sum()
        ),
        "The second box is smaller here than it is: its extents count, too.": (
            lambda c1, e1, c2, e2: answer(c1, e1, c2, 0 * e2)
        ),
        "The boxes are treated as spheres around them: then they touch too early.": (
            lambda c1, e1, c2, e2: max(np.linalg.norm(c2 - c1) - np.linalg.norm(e1) - np.linalg.norm(e2), 0)
        ),
        "The sign of the distance along an axis is kept: either box may be on the left, so take absolute values.": (
            lambda c1, e1, c2, e2: np.linalg.norm(np.maximum(c2 - c1 - e1 - e2, 0))
        ),
    },
    hints=(
        "Look at one axis: how far apart are the intervals that the boxes cover there?",
        "The gap is |x2 - x1| less both extents. What does a negative gap mean, and what should it count?",
        "np.linalg.norm of np.maximum(gaps, 0), where gaps is |centre2 - centre1| - extents1 - extents2.",
    ),
)
