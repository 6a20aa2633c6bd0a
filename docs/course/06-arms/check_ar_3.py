"""Check of ar-3."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import precision

ARM = range(7)


@cache
def panda():
    """Return a Panda, and its joint values at the start."""
    env = ravemj.load(ravemj.model_path("panda"))
    robot = env.GetRobots()[0]
    return env, robot, robot.GetDOFValues(ARM)


def question(random):
    """Return an arm that is not near a singularity."""
    _, robot, _ = panda()
    lower, upper = robot.GetDOFLimits(ARM)
    while True:
        q = random.uniform(lower, upper)
        if np.linalg.svd(jacobian(robot, q), compute_uv=False)[-1] > 0.02:
            return robot, q


def jacobian(robot, q):
    arm = robot.GetActiveManipulator()
    with robot:
        robot.SetDOFValues(q, ARM)
        return np.vstack([arm.CalculateJacobian(), arm.CalculateAngularVelocityJacobian()])


def answer(robot, q):
    return np.linalg.svd(jacobian(robot, q))[2][-1]


def judge(given, robot, q):
    if abs(np.linalg.norm(given) - 1) > precision(given):
        return f"its length is {np.linalg.norm(given):.4g}, and should be 1"
    velocity = jacobian(robot, q) @ given
    for name, unit, part in (("moves", "m/s", velocity[:3]), ("turns", "rad/s", velocity[3:])):
        if np.linalg.norm(part) > precision(given):
            return f"the tool {name} with {np.linalg.norm(part):.3g} {unit}"
    return None


CHECK = Check(
    function="self_motion",
    question=question,
    answer=answer,
    judge=judge,
    kind="direction",
    angles=(1,),
    mistakes={
        "The tool stays, but it turns: the Jacobian needs the three rows of the rotation, too.": lambda robot, q: (
            np.linalg.svd(jacobian(robot, q)[:3])[2][-1]
        ),
        "The tool does not turn, but it moves: the Jacobian needs the three rows of the position, too.": (
            lambda robot, q: np.linalg.svd(jacobian(robot, q)[3:])[2][-1]
        ),
        "That is the last column of Vt: the last row belongs to the joint velocities that do nothing.": (
            lambda robot, q: np.linalg.svd(jacobian(robot, q))[2][:, -1]
        ),
        "That is the first row of Vt, which moves the tool most: the last one is wanted.": lambda robot, q: (
            np.linalg.svd(jacobian(robot, q))[2][0]
        ),
        "The joint values are not set: that is right where the robot was at the start.": lambda robot, q: answer(
            robot, panda()[2]
        ),
    },
    hints=(
        "Six rows, three for the position and three for the rotation: np.vstack. Wanted is qd with J @ qd = 0.",
        "Of U, lengths, Vt = np.linalg.svd(J), Vt has seven rows, and there are only six lengths.",
        "Vt[-1] is the row to which no length belongs: J takes it to 0.",
    ),
)
