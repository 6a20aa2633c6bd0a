"""Check of statics-1."""

from functools import cache

import numpy as np

import ravemj
from ravemj.learn import Check


@cache
def panda():
    env = ravemj.load(ravemj.model_path("panda"))
    return env, env.GetRobots()[0]


def question(random):
    _, robot = panda()
    robot.SetDOFValues(random.uniform(*robot.GetDOFLimits()))
    links = robot.GetLinks()
    masses = np.array([link.GetMass() for link in links]) * random.uniform(0.5, 2, len(links))
    poses = np.array([link.GetTransform() for link in links])
    return masses, poses, np.array([link.GetLocalCOM() for link in links])


def answer(masses, T_world_links, centres):
    points = np.einsum("nij,nj->ni", T_world_links[:, :3, :3], centres) + T_world_links[:, :3, 3]
    return np.average(points, axis=0, weights=masses)


CHECK = Check(
    function="centre_of_mass",
    question=question,
    answer=answer,
    kind="position",
    mistakes={
        "The centres of mass are forgotten: the masses are taken to be at the origins of the links.": lambda m, T, c: (
            answer(m, T, 0 * c)
        ),
        "Every link counts alike: a heavy link has to count more, in proportion to its mass.": lambda m, T, c: answer(
            np.ones(len(m)), T, c
        ),
        "The rotations of the links are left out: a centre of mass is given in the axes of its link.": lambda m, T, c: (
            np.average(T[:, :3, 3] + c, axis=0, weights=m)
        ),
        "The sum of mass times position is not divided by the total mass.": lambda m, T, c: answer(m, T, c) * m.sum(),
        "The sum is divided by the number of links, in place of the total mass.": lambda m, T, c: (
            answer(m, T, c) * m.mean()
        ),
        "The links' frames are forgotten: the centres of mass are averaged as if they were in the world.": (
            lambda m, T, c: np.average(c, axis=0, weights=m)
        ),
    },
    hints=(
        "Where is the centre of mass of one link in the world? Its pose takes points of the link to the world.",
        "The pose is a matrix of shape (4, 4), so the point needs a 1 as its fourth number. Then take an average.",
        "Sum m * (T @ [*c, 1])[:3] over all links, and divide by the sum of m.",
    ),
)
