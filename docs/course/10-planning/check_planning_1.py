"""Check of planning-1."""

import numpy as np

from ravemj.learn import Check


def question(random):
    dof = random.integers(2, 5)
    return random.uniform(-np.pi, np.pi, (random.integers(10, 30), dof)), random.uniform(-np.pi, np.pi, dof)


def turns(nodes, sample):
    return np.arctan2(np.sin(nodes - sample), np.cos(nodes - sample))


def answer(nodes, sample):
    return np.linalg.norm(turns(nodes, sample), axis=1).argmin()


CHECK = Check(
    function="nearest",
    question=question,
    answer=answer,
    kind="number",
    questions=40,
    mistakes={
        "Indices begin with 0 here: this is one too many.": lambda *arguments: answer(*arguments) + 1,
        "Whole turns count here: from 3 rad to -3 rad a joint turns only by 0.28 rad, the other way round.": (
            lambda nodes, sample: np.linalg.norm(nodes - sample, axis=1).argmin()
        ),
        "This is the farthest node: look for the smallest distance.": lambda nodes, sample: np.linalg.norm(
            turns(nodes, sample), axis=1
        ).argmax(),
        "The turns are added: the distance is the length of their vector.": lambda nodes, sample: (
            np.abs(turns(nodes, sample)).sum(axis=1).argmin()
        ),
        "Only the joint that turns most counts here: the distance is the length of the vector of all turns.": (
            lambda nodes, sample: np.abs(turns(nodes, sample)).max(axis=1).argmin()
        ),
        "Only the first joint is compared: all of them count.": lambda nodes, sample: np.abs(turns(nodes, sample))[
            :, 0
        ].argmin(),
        "Signs are kept: a turn backwards is a turn, too. Take squares, or absolute values.": lambda nodes, sample: (
            turns(nodes, sample).sum(axis=1).argmin()
        ),
    },
    hints=(
        "First forget whole turns: which of the differences nodes - sample is the shortest vector?",
        "Bring each difference into the interval from -pi to pi before that, by adding or subtracting whole turns.",
        "turns = (nodes - sample + np.pi) % (2 * np.pi) - np.pi; then np.linalg.norm(turns, axis=1).argmin().",
    ),
)
