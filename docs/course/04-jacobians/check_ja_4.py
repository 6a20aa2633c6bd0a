"""Check of ja-4."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check

ARM = range(7)


@cache
def panda():
    env = ravemj.load(ravemj.model_path("panda"))
    return env, env.GetRobots()[0]


def question(random):
    _, robot = panda()
    lower, upper = robot.GetDOFLimits(ARM)
    robot.SetDOFValues(random.uniform(lower, upper), ARM)
    return (robot.GetActiveManipulator().CalculateJacobian(),)


def answer(J):
    return np.sqrt(np.linalg.eigvalsh(J @ J.T)[::-1])


CHECK = Check(
    function="semi_axes",
    question=question,
    answer=answer,
    kind="vector",
    mistakes={
        "Those are the squares: the eigenvalues of J J.T are the squares of the singular values.": lambda J: (
            answer(J) ** 2
        ),
        "Those are the squares, and the shortest one comes first.": lambda J: (answer(J) ** 2)[::-1],
        "The shortest one comes first: turn them round.": lambda J: answer(J)[::-1],
        "Those are the lengths of the rows: the axes of the ellipsoid need not lie along x, y and z.": lambda J: (
            np.linalg.norm(J, axis=1)
        ),
        "Those are the axes of the whole ellipsoid: semi-axes go from its middle outwards.": lambda J: 2 * answer(J),
        "Those are the semi-axes of the inverse: where the joints are slow, not the tool.": lambda J: 1 / answer(J),
    },
    hints=(
        "J takes a unit sphere to the ellipsoid. The singular value decomposition says how.",
        "The semi-axes are the singular values of J: np.linalg.svd.",
        "np.linalg.svd(J, compute_uv=False) returns them, the largest one first.",
    ),
)
