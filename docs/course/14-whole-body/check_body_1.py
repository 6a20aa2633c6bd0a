"""Check of body-1."""

import numpy as np

from ravemj.learn import Check


def question(random):
    def task(rows):
        return random.normal(size=(rows, 7)), random.normal(size=rows), random.uniform(0.1, 5)

    return *task(3), *task(random.integers(2, 6)), random.uniform(0.01, 0.5)


def answer(J1, e1, w1, J2, e2, w2, damping):
    rows = np.vstack([np.sqrt(w1) * J1, np.sqrt(w2) * J2, np.sqrt(damping) * np.eye(J1.shape[1])])
    return np.linalg.lstsq(rows, np.concatenate([np.sqrt(w1) * e1, np.sqrt(w2) * e2, np.zeros(J1.shape[1])]))[0]


CHECK = Check(
    function="best_step",
    question=question,
    answer=answer,
    mistakes={
        "The damping is forgotten: the step is too long.": lambda J1, e1, w1, J2, e2, w2, d: answer(
            J1, e1, w1, J2, e2, w2, 0
        ),
        "The damping is squared: it stands in the equations as it is.": lambda J1, e1, w1, J2, e2, w2, d: answer(
            J1, e1, w1, J2, e2, w2, d * d
        ),
        "The weights are squared: multiply rows by their square roots, or J.T @ J by the weights.": (
            lambda J1, e1, w1, J2, e2, w2, d: answer(J1, e1, w1 * w1, J2, e2, w2 * w2, d)
        ),
        "The weights are forgotten: both tasks count alike.": lambda J1, e1, w1, J2, e2, w2, d: answer(
            J1, e1, 1, J2, e2, 1, d
        ),
        "The weights are exchanged.": lambda J1, e1, w1, J2, e2, w2, d: answer(J1, e1, w2, J2, e2, w1, d),
        "The weights are on the left side of the equations alone: the errors have them, too.": (
            lambda J1, e1, w1, J2, e2, w2, d: np.linalg.solve(
                w1 * J1.T @ J1 + w2 * J2.T @ J2 + d * np.eye(J1.shape[1]), J1.T @ e1 + J2.T @ e2
            )
        ),
        "Only the first task is served.": lambda J1, e1, w1, J2, e2, w2, d: answer(J1, e1, w1, J2, e2, 0, d),
        "Only the second task is served.": lambda J1, e1, w1, J2, e2, w2, d: answer(J1, e1, 0, J2, e2, w2, d),
        "Each task is served alone, and the steps are added: then one disturbs the other.": (
            lambda J1, e1, w1, J2, e2, w2, d: answer(J1, e1, w1, J2, e2, 0, d) + answer(J1, e1, 0, J2, e2, w2, d)
        ),
    },
    hints=(
        "Set the derivative of the sum with respect to dq to 0. That of |J dq - e|^2 is 2 J.T (J dq - e).",
        "You get linear equations A dq = b, with A = w1 J1.T J1 + ... + damping times the unit matrix. And b?",
        "b = w1 * J1.T @ e1 + w2 * J2.T @ e2; np.linalg.solve(A, b) is the step.",
    ),
)
