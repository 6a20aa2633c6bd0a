"""Check of ja-1."""

import numpy as np

from ravemj.learn import Check


def question(random):
    return (*random.uniform(-np.pi, np.pi, 2), *random.uniform(0.2, 1.5, 2))


def sideways(length, angle):
    """Return the derivative of the end of a link by its angle."""
    return length * np.array([-np.sin(angle), np.cos(angle)])


def answer(q1, q2, l1, l2):
    second = sideways(l2, q1 + q2)
    return np.column_stack([sideways(l1, q1) + second, second])


def sideways_to_along(J):
    """Return the positions whose derivatives are the columns of J."""
    return np.array([J[1], -J[0]])


def absolute(q1, q2, l1, l2):
    return np.column_stack([sideways(l1, q1), sideways(l2, q2)])


def separate(q1, q2, l1, l2):
    return np.column_stack([sideways(l1, q1), sideways(l2, q1 + q2)])


def unsigned(*arguments):
    J = answer(*arguments)
    J[0] *= -1
    return J


CHECK = Check(
    function="jacobian",
    question=question,
    answer=answer,
    kind="vector",
    angles=(0, 1),
    mistakes={
        "That is not differentiated: these are x and y of the links, not what they change by.": lambda q1, q2, l1, l2: (
            sideways_to_along(answer(q1, q2, l1, l2))
        ),
        "q2 is measured from the first link: the second link points along q1 + q2.": absolute,
        "The first joint turns the second link as well: both links are in its column.": separate,
        "Rows and columns are exchanged: a column belongs to a joint, a row to x or y.": lambda *q: answer(*q).T,
        "The columns are exchanged: the first one belongs to q1.": lambda *q: answer(*q)[:, ::-1],
        "The rows are exchanged: the first one is x, whose derivative has the sines.": lambda *q: answer(*q)[::-1],
        "The derivative of the cosine is minus the sine: the first row has the wrong sign.": unsigned,
    },
    hints=(
        "Write down x and y of the hand as in fk-1, and differentiate: first by q1, then by q2.",
        "q1 is in both terms of x and y, q2 in the last one alone. The derivative of cos is -sin, that of sin is cos.",
        "The column of q2 is [-l2 sin(q1 + q2), l2 cos(q1 + q2)]; that of q1 adds [-l1 sin(q1), l1 cos(q1)].",
    ),
)
