"""Check of statics-3."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check

G = 9.81
GRIPPER = ("hand", "left_finger", "right_finger")


@cache
def panda():
    env = ravemj.load(ravemj.model_path("panda"))
    return env, env.GetRobots()[0]


def question(random):
    _, robot = panda()
    return robot, random.uniform(*robot.GetDOFLimits())


def wrench(robot, values, names=GRIPPER, point=lambda link: link.GetGlobalCOM(), about="link7"):
    """Return the wrench that holds some links, with the weight of each at a point of it."""
    robot.SetDOFValues(values)
    origin = robot.GetLink(about).GetTransform()[:3, 3]
    total = np.zeros(6)
    for link in map(robot.GetLink, names):
        force = np.array([0, 0, G * link.GetMass()])
        total += [*force, *np.cross(point(link) - origin, force)]
    return total


def in_link_axes(robot, values):
    f, tau = wrench(robot, values).reshape(2, 3)
    R = robot.GetLink("link7").GetTransform()[:3, :3]
    return np.concatenate([R.T @ f, R.T @ tau])


CHECK = Check(
    function="wrench_at_wrist",
    question=question,
    answer=wrench,
    mistakes={
        "The sign of gravity is wrong: the wrist pulls up, gravity down.": lambda *arguments: -wrench(*arguments),
        "The centres of mass are forgotten: the weights are taken to act at the origins of the links.": lambda r, q: (
            wrench(r, q, point=lambda link: link.GetTransform()[:3, 3])
        ),
        "GetLocalCOM is in the frame of the link: the pose of the link takes it to the world.": lambda r, q: wrench(
            r, q, point=lambda link: link.GetLocalCOM()
        ),
        "The fingers are forgotten: they weigh something, too.": lambda r, q: wrench(r, q, names=("hand",)),
        "g is forgotten: a mass of m kilograms has the weight 9.81 m newtons.": lambda r, q: wrench(r, q) / G,
        "The result is in the axes of link7: the question is for the axes of the world.": in_link_axes,
        "The torque is about the origin of the world, in place of that of link7.": lambda r, q: np.append(
            wrench(r, q)[:3],
            wrench(r, q)[3:] + np.cross(r.GetLink("link7").GetTransform()[:3, 3], wrench(r, q)[:3]),
        ),
        "The torque is about the origin of the hand, in place of that of link7.": lambda r, q: wrench(
            r, q, about="hand"
        ),
        "The factors of the cross product are exchanged: it is the lever arm times the force.": lambda r, q: (
            wrench(r, q) * [1, 1, 1, -1, -1, -1]
        ),
        "The weight of link7 is in it: the wrist holds only what comes after it.": lambda r, q: wrench(
            r, q, names=("link7", *GRIPPER)
        ),
        "Torque comes first here: the force should be first, then the torque.": lambda r, q: np.roll(wrench(r, q), 3),
    },
    hints=(
        "The force of one link is [0, 0, m g], upwards. At which point of the link does its weight act?",
        "A force f at a point p has the torque cross(p - o, f) about a point o. Here o is the origin of link7.",
        "For each of the three links, f is [0, 0, 9.81 * link.GetMass()] and p is link.GetGlobalCOM().",
    ),
)
