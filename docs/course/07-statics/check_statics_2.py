"""Check of statics-2."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check

G, LENGTH = 9.81, 0.2


@cache
def pendulum():
    env = ravemj.load(ravemj.model_path("pendulum"))
    env.GetPhysicsEngine().SetGravity([0, 0, -G])
    return env, env.GetRobots()[0]


def question(random):
    return (*random.uniform(-np.pi, np.pi, 2), *random.uniform(1, 10, 2))


def answer(q0, q1, m0, m1):
    _, robot = pendulum()
    for name, mass in (("Arm0", m0), ("Arm1", m1)):
        robot.GetLink(name).SetMass(mass)
    robot.SetDOFValues([q0, q1])
    return robot.ComputeInverseDynamics(np.zeros(2))


def torques(q0, direction, m0, m1, centre=LENGTH / 2):
    """Return the torques if the second arm makes the angle ``direction`` with straight down."""
    second = m1 * centre * np.sin(direction)
    return G * np.array([(m0 * centre + m1 * LENGTH) * np.sin(q0) + second, second])


CHECK = Check(
    function="holding_torques",
    question=question,
    answer=answer,
    angles=(0, 1),
    mistakes={
        "The masses are exchanged: m0 is that of the first arm.": lambda q0, q1, m0, m1: answer(q0, q1, m1, m0),
        "The torques are exchanged: the first one is that of the first joint.": lambda *arguments: answer(*arguments)[
            ::-1
        ],
        "The sign of gravity is wrong: these torques push down, as gravity does; the motors have to push up.": (
            lambda *arguments: -answer(*arguments)
        ),
        "g is forgotten: a mass of m kilograms has the weight 9.81 m newtons.": lambda *arguments: (
            answer(*arguments) / G
        ),
        "The masses are taken to be at the ends of the arms: their centres are in the middle, at 0.1 m.": (
            lambda q0, q1, m0, m1: torques(q0, q0 + q1, m0, m1, LENGTH)
        ),
        "q1 is measured from the first arm: the second arm makes the angle q0 + q1 with straight down.": torques,
        "The first joint holds the second arm as well: its torque has a part for each arm that hangs on it.": (
            lambda q0, q1, m0, m1: np.array([answer(q0, q1, m0, 0)[0], answer(q0, q1, m0, m1)[1]])
        ),
        "The angles are measured from straight down, so the horizontal distance is the sine, not the cosine.": (
            lambda q0, q1, m0, m1: torques(q0 + np.pi / 2, q0 + q1 + np.pi / 2, m0, m1)
        ),
        "The torque of the second arm about the first joint lacks a part: its distance from there begins with the "
        "whole first arm.": lambda q0, q1, m0, m1: np.array(
            [torques(q0, q0 + q1, m0, m1)[0] - G * m1 * LENGTH * np.sin(q0), answer(q0, q1, m0, m1)[1]]
        ),
    },
    hints=(
        "How far is the middle of the second arm from the second joint, measured horizontally?",
        "It is 0.1 sin(q0 + q1). From the first joint it is 0.2 sin(q0) more; the first arm weighs something, too.",
        "The second torque is g m1 0.1 sin(q0 + q1); the first one is g (0.1 m0 + 0.2 m1) sin(q0) plus the second.",
    ),
)
