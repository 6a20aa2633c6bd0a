"""Check of urdf-1."""

import warnings

import numpy as np

import ravemj
from ravemj.geometry_functions import matrixFromAxisAngle
from ravemj.learn import Check

HALF = np.array([0.03, 0.02, 0.15])


def part(robot, get, name, kind):
    found = get(name)
    if found is None:
        raise LookupError(f"there is no {kind} {name!r}; the names must be as they are asked for")
    return found


def arm(path):
    """Return a function of two angles that returns two corners of the forearm of a student's arm."""
    with warnings.catch_warnings():
        warnings.filterwarnings("error", r".*error\[")  # such as a mimic joint that follows none
        robot = ravemj.load(path).GetRobots()[0]
    forearm = part(robot, robot.GetLink, "forearm", "link")
    joints = [part(robot, robot.GetJoint, name, "joint") for name in ("shoulder", "elbow")]
    shapes = [shape for shape in forearm.GetGeometries() if shape.GetType() == ravemj.GeometryType.Box]
    if len(shapes) != 1:
        raise LookupError("the link 'forearm' should have one <collision>, with a <box>")
    for joint in joints:
        if joint.GetDOFIndex() < 0:
            raise LookupError(f"the joint {joint.GetName()!r} should have the type revolute")

    def corners(shoulder, elbow):
        for joint, value in zip(joints, (shoulder, elbow), strict=True):
            lower, upper = joint.GetLimits()
            robot.SetDOFValues([np.clip(value, lower[0], upper[0])], [joint.GetDOFIndex()])
        T = forearm.GetTransform() @ shapes[0].GetTransform()
        return [(T @ [*(sign * shapes[0].GetBoxExtents()), 1])[:3] for sign in (-1, 1)]

    return corners


def at(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def turned(angle, axis=(0, 1, 0)):
    return matrixFromAxisAngle(np.array(axis) * angle)


def corners(T, half=HALF, middle=(0, 0, 0.15)):
    return np.array([(T @ [*(middle + sign * half), 1])[:3] for sign in (-1, 1)])


def upper_arm(shoulder):
    return at(0, 0, 0.1) @ turned(np.clip(shoulder, -2, 2))


def forearm(shoulder, elbow, offset=0.4, limits=(-1.2, 2), axis=(0, 1, 0)):
    return upper_arm(shoulder) @ at(0, 0, offset) @ turned(np.clip(elbow, *limits), axis)


def question(random):
    return tuple(random.uniform(-3, 3, 2))


def answer(shoulder, elbow):
    return corners(forearm(shoulder, elbow))


CHECK = Check(
    function=arm,
    question=question,
    answer=answer,
    kind="vector",
    mistakes={
        "The size of a box in URDF is its whole lengths; these are half of them, as OpenRAVE's extents are.": (
            lambda *q: corners(forearm(*q), HALF / 2)
        ),
        "The box is twice too large: its size is its whole lengths, so write them as they are.": (
            lambda *q: corners(forearm(*q), 2 * HALF)
        ),
        "The middle of the box is at the elbow: give the collision shape an <origin> with 0.15 m in z.": (
            lambda *q: corners(forearm(*q), middle=(0, 0, 0))
        ),
        "The elbow is at the shoulder: the joint needs an <origin> of 0.4 m in z, in the frame of the upper arm.": (
            lambda *q: corners(forearm(*q, offset=0))
        ),
        "The <origin> of the elbow is in the frame of the upper arm, not in that of the base: 0.4 m, not 0.5 m.": (
            lambda *q: corners(forearm(*q, offset=0.5))
        ),
        "The elbow is in the middle of the upper arm: the upper arm is 0.4 m long.": lambda *q: corners(
            forearm(*q, offset=0.2)
        ),
        "The axis is x, which it is without an <axis>: it should be y.": lambda *q: corners(
            forearm(*q, axis=(1, 0, 0))
        ),
        "The axis is z: it should be y.": lambda *q: corners(forearm(*q, axis=(0, 0, 1))),
        "The axis points the other way: it should be 0 1 0.": lambda shoulder, elbow: corners(
            upper_arm(shoulder) @ at(0, 0, 0.4) @ turned(-np.clip(elbow, -1.2, 2))
        ),
        "The limits are missing or exchanged: lower is -1.2, and upper is 2.": lambda *q: corners(
            forearm(*q, limits=(-2, 1.2))
        ),
        "The joint turns farther than it should: its limits are -1.2 and 2, in radians.": lambda *q: corners(
            forearm(*q, limits=(-9, 9))
        ),
        "The parent of the elbow is the base: it should be the upper arm.": lambda shoulder, elbow: corners(
            at(0, 0, 0.4) @ turned(np.clip(elbow, -1.2, 2))
        ),
    },
    hints=(
        "Copy the link and the joint that are there, and change names and numbers.",
        "The parent of the elbow is upper_arm, its origin is 0 0 0.4. The box needs an origin, too: 0 0 0.15.",
        'The joint has <origin xyz="0 0 0.4"/>, <axis xyz="0 1 0"/>, and a <limit> with lower="-1.2" and upper="2".',
    ),
)
