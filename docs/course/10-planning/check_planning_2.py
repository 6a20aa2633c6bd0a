"""Check of planning-2."""

import numpy as np

from ravemj.learn import Check


def question(random):
    dof = random.integers(2, 5)
    way = random.normal(size=dof)
    node = random.uniform(-2, 2, dof)
    return node, node + random.uniform(0.1, 2) * way / np.linalg.norm(way), random.uniform(0.3, 1.2)


def length(node, sample):
    return np.linalg.norm(sample - node)


def answer(node, sample, step):
    return node + min(step / length(node, sample), 1) * (sample - node)


CHECK = Check(
    function="steer",
    question=question,
    answer=answer,
    kind="joint values",
    mistakes={
        "The step goes beyond the sample: if the sample is nearer than a step, stop there.": lambda a, b, step: (
            a + step / length(a, b) * (b - a)
        ),
        "Each joint is limited on its own: then the line bends, and is longer than a step.": (
            lambda a, b, step: a + np.clip(b - a, -step, step)
        ),
        "The step is taken for a fraction: divide the difference by its length first.": lambda a, b, step: (
            a + min(step, 1) * (b - a)
        ),
        "The step is taken for a fraction, without an end: divide the difference by its length first.": (
            lambda a, b, step: a + step * (b - a)
        ),
        "This is the sample: at most one step towards it is asked for.": lambda a, b, step: b,
        "This goes away from the sample: the direction is the sample less the node.": lambda a, b, step: (
            2 * a - answer(a, b, step)
        ),
        "This begins at the sample: begin at the node.": lambda a, b, step: answer(b, a, step),
        "This is only the difference: add the node.": lambda a, b, step: answer(a, b, step) - a,
        "A far sample is right, but a near one is not: if it is nearer than a step, return the sample.": (
            lambda a, b, step: answer(a, b, step) if length(a, b) > step else a
        ),
        "The largest turn of a joint is taken for the distance: it is the length of the vector.": (
            lambda a, b, step: a + min(step / np.abs(b - a).max(), 1) * (b - a)
        ),
        "The sum of the turns is taken for the distance: it is the length of the vector.": (
            lambda a, b, step: a + min(step / np.abs(b - a).sum(), 1) * (b - a)
        ),
    },
    hints=(
        "How long is the vector sample - node? What has to be done if it is longer than a step?",
        "This vector divided by its length has the length 1; times `step` it is one step.",
        "node + (sample - node) * min(1, step / np.linalg.norm(sample - node))",
    ),
)
