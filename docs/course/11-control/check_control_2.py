"""Check of control-2."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check


@cache
def panda():
    env = ravemj.load(ravemj.model_path("panda"))
    env.GetPhysicsEngine().SetGravity([0, 0, -9.81])
    return env, env.GetRobots()[0]


def question(random):
    _, robot = panda()
    values, goal = random.uniform(*robot.GetDOFLimits(), (2, 8))
    velocities = random.uniform(-1, 1, 8) * robot.GetDOFVelocityLimits()
    return robot, values, velocities, goal, random.uniform(10, 100, 8), random.uniform(1, 10, 8)


def gravity(robot, values):
    robot.SetDOFValues(values)
    return robot.ComputeInverseDynamics(None, None, True)[2]


def coriolis(robot, values, velocities):
    robot.SetDOFValues(values)
    robot.SetDOFVelocities(velocities)
    torques = robot.ComputeInverseDynamics(None, None, True)[1]
    robot.SetDOFVelocities(0 * velocities)
    return torques


def pd(values, velocities, goal, kp, kd):
    return kp * (goal - values) - kd * velocities


def answer(robot, values, *others):
    return pd(values, *others) + gravity(robot, values)


CHECK = Check(
    function="torques",
    question=question,
    answer=answer,
    mistakes={
        "The gains are exchanged: kp belongs to the error of the position, kd to the velocity.": (
            lambda robot, values, velocities, goal, kp, kd: answer(robot, values, velocities, goal, kd, kp)
        ),
        "Gravity is forgotten: the arm sags until the springs carry it.": lambda robot, *others: pd(*others),
        "The sign of gravity is wrong: ComputeInverseDynamics returns what the motors have to do, so add it.": (
            lambda robot, values, *others: pd(values, *others) - gravity(robot, values)
        ),
        "Gravity is that at the goal: compensate it where the robot is now.": (
            lambda robot, values, velocities, goal, kp, kd: pd(values, velocities, goal, kp, kd) + gravity(robot, goal)
        ),
        "The PD controller is forgotten: gravity compensation alone leaves the robot where it is.": (
            lambda robot, values, *others: gravity(robot, values)
        ),
        "Coriolis forces are in it, too: take the third array alone, or leave the robot's velocities at zero.": (
            lambda robot, values, velocities, *others: (
                answer(robot, values, velocities, *others) + coriolis(robot, values, velocities)
            )
        ),
        "The damper has the wrong sign: it drives the joints faster and faster.": (
            lambda robot, values, velocities, *others: answer(robot, values, -velocities, *others)
        ),
        "The spring has the wrong sign: it pushes away from the goal.": (
            lambda robot, values, velocities, goal, kp, kd: answer(robot, values, velocities, goal, -kp, kd)
        ),
        "The damper is missing: without it the joints swing about the goal.": (
            lambda robot, values, velocities, *others: answer(robot, values, 0 * velocities, *others)
        ),
    },
    hints=(
        "Two parts: the PD controller of control-1 with a goal velocity of 0, and what holds the robot still.",
        "Put the robot at `values` and ask it. Which of the three arrays of ComputeInverseDynamics is gravity?",
        "kp * (goal - values) - kd * velocities + robot.ComputeInverseDynamics(None, None, True)[2]",
    ),
)
