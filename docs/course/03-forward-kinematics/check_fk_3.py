"""Check of fk-3."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import Scene


@cache
def panda():
    """Return a Panda, and its joint values at the start."""
    env = ravemj.load(ravemj.model_path("panda"))
    robot = env.GetRobots()[0]
    return env, robot, robot.GetDOFValues(range(7))


def question(random):
    _, robot, _ = panda()
    lower, upper = robot.GetDOFLimits(range(7))
    return robot, random.uniform(lower, upper), f"link{random.integers(1, 7)}"


def poses(robot, q, name):
    """Return the poses of the tool, of the link and of the hand in the world."""
    with robot:
        robot.SetDOFValues(q, range(7))
        links = [robot.GetLink(one).GetTransform() for one in (name, "hand")]
        return robot.GetActiveManipulator().GetTransform(), *links


def answer(robot, q, name):
    T_world_tool, T_world_link, _ = poses(robot, q, name)
    return np.linalg.inv(T_world_link) @ T_world_tool


def of_hand(robot, q, name):
    _, T_world_link, T_world_hand = poses(robot, q, name)
    return np.linalg.inv(T_world_link) @ T_world_hand


def wrong_order(robot, q, name):
    T_world_tool, T_world_link, _ = poses(robot, q, name)
    return T_world_tool @ np.linalg.inv(T_world_link)


def subtracted(robot, q, name):
    T_world_tool, T_world_link, _ = poses(robot, q, name)
    T = answer(robot, q, name)
    T[:3, 3] = T_world_tool[:3, 3] - T_world_link[:3, 3]
    return T


CHECK = Check(
    function="tool_in_link",
    question=question,
    answer=answer,
    kind="pose",
    angles=(1,),
    scene=lambda robot, q, name: Scene("panda", [*q, 0.03], name),
    mistakes={
        "That is the tool in the frame of the world; it should be seen from the link.": lambda *q: poses(*q)[0],
        "That is the pose of the link in the world; the pose of the tool is still missing.": lambda *q: poses(*q)[1],
        "That is the frame of the hand, not of the tool, which is 10.34 cm in front of it.": of_hand,
        "The joint values are not set: the robot is still where it was at the start.": lambda robot, q, name: answer(
            robot, panda()[2], name
        ),
        "Wrong order: the inverse of T_world_link stands on the left, so that world meets world.": wrong_order,
        "The pose of the link is not inverted before the product.": lambda *q: poses(*q)[1] @ poses(*q)[0],
        "The difference of the positions is in world axes; it has to be turned into those of the link.": subtracted,
    },
    hints=(
        "Set the joint values first. Then ask for two poses in the world: that of the link, and that of the tool.",
        "T_link_tool begins with link, so T_world_link has to be inverted.",
        "np.linalg.inv(robot.GetLink(name).GetTransform()) @ robot.GetActiveManipulator().GetTransform()",
    ),
)
