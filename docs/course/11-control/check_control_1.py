"""Check of control-1."""

import numpy as np

from ravemj.learn import Check


def question(random):
    return (*random.uniform(-2, 2, (4, 3)), random.uniform(10, 100, 3), random.uniform(1, 10, 3))


def answer(q, dq, goal, dgoal, kp, kd):
    return kp * (goal - q) + kd * (dgoal - dq)


CHECK = Check(
    function="pd_torques",
    question=question,
    answer=answer,
    mistakes={
        "Both signs are wrong: the torque pushes away from the goal. The error is the goal less the value.": (
            lambda *arguments: -answer(*arguments)
        ),
        "The spring has the wrong sign: it pushes away from the goal.": lambda q, dq, goal, dgoal, kp, kd: answer(
            q, dq, goal, dgoal, -kp, kd
        ),
        "The damper has the wrong sign: it drives the joint faster and faster.": lambda q, dq, goal, dgoal, kp, kd: (
            answer(q, dq, goal, dgoal, kp, -kd)
        ),
        "The goal velocity is forgotten: the damper compares the velocity with it, not with 0.": (
            lambda q, dq, goal, dgoal, kp, kd: kp * (goal - q) - kd * dq
        ),
        "The damper is missing: without it the joint swings about its goal.": (
            lambda q, dq, goal, dgoal, kp, kd: kp * (goal - q)
        ),
        "kp and kd are exchanged: kp belongs to the values, kd to the velocities.": (
            lambda q, dq, goal, dgoal, kp, kd: answer(q, dq, goal, dgoal, kd, kp)
        ),
        "The goal itself is in the spring: it pulls by the difference of goal and value.": (
            lambda q, dq, goal, dgoal, kp, kd: kp * goal + kd * (dgoal - dq)
        ),
    },
    hints=(
        "Each joint has its own spring and damper, so everything goes number by number.",
        "The spring pulls by kp times the error, goal less value: towards the goal.",
        "kp * (goal_values - values) + kd * (goal_velocities - velocities)",
    ),
)
