"""Check of body-3."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check

FEET = ("left_foot", "right_foot")


@cache
def biped():
    """Return the environment, the robot, its pose and its joint values as it is loaded."""
    env = ravemj.load(ravemj.model_path("biped"))
    robot = env.GetRobots()[0]
    return env, robot, robot.GetTransform(), robot.GetDOFValues()


def question(random):
    _, robot, T, values = biped()
    moved = ravemj.matrixFromAxisAngle([0, 0, random.uniform(-np.pi, np.pi)])
    moved[:2, 3] = random.uniform(-1, 1, 2)
    point = moved @ [*random.uniform([0.15, 0.1, 0.5], [0.3, 0.3, 0.75]), 1]
    return robot, np.concatenate([ravemj.poseFromMatrix(moved @ T), values]), point[:3]


def answer(robot, start, point):
    """Return something of the right shape: the judge alone decides, and a solution would take as long again."""
    return start


def put(robot, numbers):
    robot.SetTransform(numbers[:7])
    robot.SetDOFValues(numbers[7:], checklimits=0)
    feet = [robot.GetManipulator(name).GetTransform() for name in FEET]
    return feet, robot.GetCenterOfMass()[:2], robot.GetManipulator("left_hand").GetTransform()[:3, 3]


def judge(numbers, robot, start, point):
    if abs(np.linalg.norm(numbers[:4]) - 1) > 1e-4:
        return "the first four numbers should be a quaternion of length 1: first the pose, then the joint values"
    lower, upper = robot.GetDOFLimits()
    outside = np.maximum(lower - numbers[7:], numbers[7:] - upper)
    if outside.max() > 1e-3:
        joint = robot.GetJointFromDOFIndex(int(outside.argmax())).GetName()
        return f"joint {joint} is {outside.max():.3g} rad outside of its limits"
    (soles, com, _), (feet, now, hand) = put(robot, start), put(robot, numbers)
    for name, before, after in zip(FEET, soles, feet, strict=True):
        if np.abs(after - before).max() > 1.1e-3:
            slip = np.linalg.norm((after - before)[:3, 3])
            return f"{name} does not stay: it moves by {slip:.3g} m, or turns; a contact keeps it, with base=True"
    if np.linalg.norm(now - com) > 1.1e-3:
        return f"the centre of mass moves sideways by {np.linalg.norm(now - com):.3g} m; a task can keep it, in x and y"
    if np.linalg.norm(hand - point) > 1.1e-3:
        return f"the left hand is {np.linalg.norm(hand - point):.3g} m away from the point"
    return None


CHECK = Check(
    function="reach",
    question=question,
    answer=answer,
    judge=judge,
    hints=(
        "After SetTransform and SetDOFValues, make a ravemj.WholeBodyIK with base=True, as on the page, and add tasks.",
        "Both feet are contacts, the centre of mass has axes='xy', and the hand has a target. Then solve().",
        "add_contact for both feet, add_com(axes='xy'), add_reach('left_hand', point), add_posture(), solve(); then "
        "concatenate poseFromMatrix(robot.GetTransform()) and robot.GetDOFValues().",
    ),
)
