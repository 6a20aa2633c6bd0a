"""Check of ja-3."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check

ARM = range(7)


@cache
def panda():
    """Return a Panda, and its joint values at the start."""
    env = ravemj.load(ravemj.model_path("panda"))
    robot = env.GetRobots()[0]
    return env, robot, robot.GetDOFValues(ARM)


def question(random):
    _, robot, _ = panda()
    lower, upper = robot.GetDOFLimits(ARM)
    return robot, random.uniform(lower, upper), random.uniform(-1, 1, 7)


def answer(robot, q, qd):
    with robot:
        robot.SetDOFValues(q, ARM)
        return robot.GetActiveManipulator().CalculateJacobian() @ qd


def of_hand(robot, q, qd):
    with robot:
        robot.SetDOFValues(q, ARM)
        hand = robot.GetLink("hand")
        J = robot.ComputeJacobianTranslation(hand.GetIndex(), hand.GetTransform()[:3, 3])
        return J[:, :7] @ qd


def in_tool_frame(robot, q, qd):
    with robot:
        robot.SetDOFValues(q, ARM)
        T_world_tool = robot.GetActiveManipulator().GetTransform()
    return T_world_tool[:3, :3].T @ answer(robot, q, qd)


def angular(robot, q, qd):
    with robot:
        robot.SetDOFValues(q, ARM)
        return robot.GetActiveManipulator().CalculateAngularVelocityJacobian() @ qd


CHECK = Check(
    function="tool_velocity",
    question=question,
    answer=answer,
    kind="vector",
    angles=(1,),
    mistakes={
        "The joint values are not set: that is the Jacobian where the robot was at the start.": lambda robot, q, qd: (
            answer(robot, panda()[2], qd)
        ),
        "That is the velocity of the hand's origin; the tool is 10.34 cm in front of it.": of_hand,
        "The velocity is in the axes of the tool; the Jacobian already has it in those of the world.": in_tool_frame,
        "That is the angular velocity: the rows of the translation are wanted.": angular,
        "J is multiplied with the joint values in place of their velocities.": lambda robot, q, qd: answer(robot, q, q),
    },
    hints=(
        "Set the joint values first: the Jacobian depends on them.",
        "The velocity of the tool is the Jacobian times the velocities of the joints.",
        "robot.GetActiveManipulator().CalculateJacobian() @ qd",
    ),
)
