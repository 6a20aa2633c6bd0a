"""Check of grasps-1."""

import numpy as np

from ravemj.learn import Check


def unit(vector):
    return vector / np.linalg.norm(vector)


def tilted(random, axis, angle):
    """Return a unit vector at an angle from an axis."""
    side = unit(np.cross(axis, random.normal(size=3)))
    return np.cos(angle) * axis + np.sin(angle) * side


def question(random):
    friction = random.uniform(0.2, 1.2)
    limit = np.arctan(friction)
    line = unit(random.normal(size=3))
    first = random.uniform(-0.1, 0.1, 3)
    # just inside, just outside, or anywhere; and sometimes a normal that points into the object
    angles = random.choice([0.6, 0.9, 1.1, 1.6], 2, p=[0.3, 0.4, 0.2, 0.1]) * limit
    one, other = tilted(random, -line, angles[0]), tilted(random, line, angles[1])
    signs = [(1, 1), (1, 1), (1, 1), (1, 1), (-1, 1), (1, -1), (-1, -1)][random.integers(7)]
    return first, signs[0] * one, first + random.uniform(0.02, 0.08) * line, signs[1] * other, friction


def cosines(first, n1, second, n2):
    line = unit(second - first)
    return np.array([-n1 @ line, n2 @ line])


def answer(first, n1, second, n2, friction):
    return bool((cosines(first, n1, second, n2) > np.cos(np.arctan(friction))).all())


CHECK = Check(
    function="is_antipodal",
    question=question,
    answer=answer,
    kind="boolean",
    questions=200,
    mistakes={
        "Only the first contact is tested: the line has to be inside both cones.": lambda a, n, b, m, mu: bool(
            cosines(a, n, b, m)[0] > np.cos(np.arctan(mu))
        ),
        "Only the second contact is tested: the line has to be inside both cones.": lambda a, n, b, m, mu: bool(
            cosines(a, n, b, m)[1] > np.cos(np.arctan(mu))
        ),
        "One cone is enough here: the line has to be inside both.": lambda a, n, b, m, mu: bool(
            (cosines(a, n, b, m) > np.cos(np.arctan(mu))).any()
        ),
        "The signs of the normals do not count: they point out of the object, and fingers push against them.": (
            lambda a, n, b, m, mu: bool((np.abs(cosines(a, n, b, m)) > np.cos(np.arctan(mu))).all())
        ),
        "The angle is compared with the friction coefficient: its tangent is.": lambda a, n, b, m, mu: bool(
            (np.arccos(np.clip(cosines(a, n, b, m), -1, 1)) < mu).all()
        ),
        "The direction of the line is wrong: the first finger pushes towards the second point.": (
            lambda a, n, b, m, mu: bool((-cosines(a, n, b, m) > np.cos(np.arctan(mu))).all())
        ),
        "Yes and no are exchanged.": lambda *arguments: not answer(*arguments),
    },
    hints=(
        "The fingers push along the line between the points. Which angle has this line with each normal?",
        "The dot product of unit vectors is the cosine of their angle. Mind the sign: a push goes against its normal.",
        "With line = (second - first) / length, both -first_normal @ line and second_normal @ line have to be greater "
        "than cos(atan(friction)).",
    ),
)
