"""Check of fk-1."""

import numpy as np

from ravemj.learn import Check, Scene


def question(random):
    return (*random.uniform(-np.pi, np.pi, 2), *random.uniform(0.2, 1.5, 2))


def answer(q1, q2, l1, l2):
    return np.array([l1 * np.cos(q1) + l2 * np.cos(q1 + q2), l1 * np.sin(q1) + l2 * np.sin(q1 + q2)])


def scene(q1, q2, l1, l2):
    return Scene(line=[(0, 0), answer(q1, 0, l1, 0), answer(q1, q2, l1, l2)])


def absolute(q1, q2, l1, l2):
    return np.array([l1 * np.cos(q1) + l2 * np.cos(q2), l1 * np.sin(q1) + l2 * np.sin(q2)])


CHECK = Check(
    function="hand_position",
    question=question,
    answer=answer,
    kind="position",
    angles=(0, 1),
    scene=scene,
    mistakes={
        "The elbow turns the other way: the second link points along q1 + q2, not q1 - q2.": lambda q1, q2, l1, l2: (
            answer(q1, -q2, l1, l2)
        ),
        "That is the second link alone: it begins at the end of the first one.": lambda q1, q2, l1, l2: answer(
            q1, q2, 0, l2
        ),
        "l1 and l2 are exchanged: the first link has the length l1.": lambda q1, q2, l1, l2: answer(q1, q2, l2, l1),
        "q2 is measured from the first link, not from the x-axis: the second link points along q1 + q2.": absolute,
        "x and y are exchanged: the cosine belongs to x.": lambda *arguments: answer(*arguments)[::-1],
        "The second link is left out: that is where the elbow is.": lambda q1, q2, l1, l2: answer(q1, q2, l1, 0),
    },
    hints=(
        "Where is the elbow? The first link alone is one right triangle.",
        "From the elbow to the hand it is another triangle. Which angle does the second link make with the x-axis?",
        "x is l1 cos(q1) + l2 cos(q1 + q2); y is the same with the sine.",
    ),
)
