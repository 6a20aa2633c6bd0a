"""Check of ar-1."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import Scene, precision, shortened


@cache
def puma():
    env = ravemj.load(ravemj.model_path("puma560"))
    return env, env.GetRobots()[0]


def question(random):
    _, robot = puma()
    return robot, tool(robot, random.uniform(*robot.GetDOFLimits()))


def tool(robot, q):
    with robot:
        robot.SetDOFValues(q, range(6), ravemj.CheckLimitsAction.Nothing)
        return robot.GetActiveManipulator().GetTransform()


def answer(robot, T_world_tool):
    found = robot.GetActiveManipulator().ik(T_world_tool)
    return found.solutions[0][found.valid[0]]


def judge(given, robot, T_world_tool):
    lower, upper = robot.GetDOFLimits()
    for q in given:
        off = np.abs(tool(robot, q) - T_world_tool).max()
        if off > precision(given):
            return f"{shortened(q)} does not take the tool to the pose: it is off by {off:.3g}"
        if np.maximum(lower - q, q - upper).max() > precision(given):
            joint = int(np.argmax(np.maximum(lower - q, q - upper)))
            return f"{shortened(q)} is beyond the limits of joint {joint + 1}: {lower[joint]:.4g} to {upper[joint]:.4g}"
    for q in answer(robot, T_world_tool):
        if np.abs(np.exp(1j * given) - np.exp(1j * q)).max(axis=1).min() > 10 * precision(given):
            return f"{shortened(q)} is missing, and another solution is there twice"
    return None


def all_rows(robot, T_world_tool):
    return robot.GetActiveManipulator().ik(T_world_tool).solutions[0]


def without_limits(robot, T_world_tool):
    found = robot.GetActiveManipulator().ik(T_world_tool, limits=False)
    return found.solutions[0][found.valid[0]]


def every_turn(robot, T_world_tool):
    kind = ravemj.IkParameterizationType.Transform6D
    ravemj.databases.inversekinematics.InverseKinematicsModel(robot, iktype=kind).load()
    return robot.GetActiveManipulator().FindIKSolutions(T_world_tool, 0)


CHECK = Check(
    function="all_ways",
    question=question,
    answer=answer,
    judge=judge,
    kind="joint values",
    scene=lambda robot, T_world_tool: Scene("puma560"),
    mistakes={
        "All rows of solutions are returned; those that are not valid do not reach the pose.": all_rows,
        "The limits do not count here: some joints of these solutions cannot turn that far.": without_limits,
        "solutions has a row for each goal, and there is one goal: solutions[0] are its ways.": (
            lambda robot, T: robot.GetActiveManipulator().ik(T).solutions
        ),
        "valid says which rows are good; the rows themselves are in solutions.": lambda robot, T: (
            robot.GetActiveManipulator().ik(T).valid[0]
        ),
        "FindIKSolutions gives all turns of joint 6, and no solution in which the arm touches itself: ask arm.ik.": (
            every_turn
        ),
        "That is one way of several: return all rows that are valid.": lambda *arguments: answer(*arguments)[0],
        "That is one way of several, in a row: return all rows that are valid.": lambda *arguments: answer(*arguments)[
            :1
        ],
    },
    hints=(
        "Call arm.ik with the pose. It takes many goals; yours is the first and only one, with the index 0.",
        "found.solutions[0] has eight rows. found.valid[0] says of each whether it is good, and can be an index.",
        "found.solutions[0][found.valid[0]]",
    ),
)
