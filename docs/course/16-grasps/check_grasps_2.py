"""Check of grasps-2."""

import numpy as np

from ravemj.learn import Check


def question(random):
    return random.uniform(-10, 10, 3), random.uniform(-1, 1, 3), random.uniform(-1, 1, 3)


def answer(force, point, centre):
    return np.concatenate([force, np.cross(point - centre, force)])


CHECK = Check(
    function="wrench",
    question=question,
    answer=answer,
    mistakes={
        "The torque is about the origin of the world: subtract the centre of mass from the point.": lambda f, p, c: (
            np.concatenate([f, np.cross(p, f)])
        ),
        "The factors of the cross product are exchanged: the lever stands first.": lambda f, p, c: np.concatenate(
            [f, np.cross(f, p - c)]
        ),
        "The torque stands before the force: the force comes first.": lambda f, p, c: np.concatenate(
            [np.cross(p - c, f), f]
        ),
        "The product of lever and force is taken number by number: a torque is a cross product.": lambda f, p, c: (
            np.concatenate([f, (p - c) * f])
        ),
        "The lever is point plus centre: it leads from the centre to the point.": lambda f, p, c: np.concatenate(
            [f, np.cross(p + c, f)]
        ),
    },
    hints=(
        "The torque of a force about a point is the cross product of lever and force. Where does the lever begin?",
        "The lever leads from the centre of mass to the contact: point - centre.",
        "np.concatenate([force, np.cross(point - centre, force)])",
    ),
)
