"""Check of ik-1."""

import numpy as np

from ravemj.learn import Check


def question(random):
    """Return a goal that is too near, in reach, or too far, and one of the links may be the longer one."""
    l1, l2 = random.permutation([random.uniform(0.6, 1.2), random.uniform(0.2, 0.5)])
    nearest, farthest = abs(l1 - l2), l1 + l2
    ranges = [(0.1, 0.95 * nearest), (1.05 * nearest, 0.95 * farthest), (1.05 * farthest, 2 * farthest)]
    distance, direction = random.uniform(*random.choice(ranges)), random.uniform(-np.pi, np.pi)
    return distance * np.cos(direction), distance * np.sin(direction), l1, l2


def answer(x, y, l1, l2):
    return abs(l1 - l2) <= np.hypot(x, y) <= l1 + l2


CHECK = Check(
    function="reachable",
    question=question,
    answer=answer,
    kind="boolean",
    mistakes={
        "The second link is left out: it takes the hand farther than l1.": (lambda x, y, l1, l2: np.hypot(x, y) <= l1),
        "x and y are compared one by one: only the distance np.hypot(x, y) counts.": lambda x, y, l1, l2: (
            max(abs(x), abs(y)) <= l1 + l2 and max(abs(x), abs(y)) >= abs(l1 - l2)
        ),
        "A goal can be too near: if one link is longer, the hand cannot come closer than |l1 - l2|.": (
            lambda x, y, l1, l2: np.hypot(x, y) <= l1 + l2
        ),
        "The second link may be the longer one: l1 - l2 is negative then; take np.abs of it.": lambda x, y, l1, l2: (
            l1 - l2 <= np.hypot(x, y) <= l1 + l2
        ),
        "A goal can be too far: the hand cannot get further than l1 + l2.": lambda x, y, l1, l2: (
            np.hypot(x, y) >= abs(l1 - l2)
        ),
        "The distance is np.hypot(x, y); the sum of x and y is no distance.": lambda x, y, l1, l2: answer(
            x + y, 0, l1, l2
        ),
        "The distance is squared, and is compared with lengths: take its root.": lambda x, y, l1, l2: answer(
            x**2 + y**2, 0, l1, l2
        ),
        "True and False are exchanged.": lambda *arguments: not answer(*arguments),
    },
    hints=(
        "Only the distance of the goal from the shoulder counts. How far does the stretched arm reach?",
        "And how near to the shoulder can the hand come? Fold the arm.",
        "abs(l1 - l2) <= np.hypot(x, y) <= l1 + l2",
    ),
)
