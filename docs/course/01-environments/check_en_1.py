"""Check of en-1."""

import warnings

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import shortened

UPPER, LOWER = 0.3, 0.2
PARTS = {
    "the middle of the box of upper": slice(0, 3),
    "the size of the box of upper": slice(3, 6),
    "the middle of the box of lower": slice(6, 9),
    "the size of the box of lower": slice(9, 12),
}


def measured(path):
    """Return a function of the two joint values: middles and sizes of the boxes."""
    with warnings.catch_warnings(action="ignore"):
        env = ravemj.load(path)
    for finding in env.diagnostics:
        raise ValueError(str(finding))
    robots = env.GetRobots()
    joints = [joint.GetName() for robot in robots for joint in robot.GetJoints()]
    if joints != ["shoulder", "elbow"]:
        raise ValueError(f"the robot should have the joints shoulder and elbow, in this order; it has {joints}")
    links = [box(robots[0], name) for name in ("upper", "lower")]

    def values(q):
        robots[0].SetDOFValues(q)
        return np.concatenate(
            [
                part
                for link, shape in links
                for part in ((link.GetTransform() @ shape.GetTransform())[:3, 3], 2 * shape.GetBoxExtents())
            ]
        )

    return values


def box(robot, name):
    """Return a link and its box."""
    link = robot.GetLink(name)
    if link is None:
        names = ", ".join(link.GetName() for link in robot.GetLinks())
        raise ValueError(f"the robot has no body {name}; it has {names}")
    shapes = link.GetGeometries()
    if len(shapes) != 1 or shapes[0].GetType() != ravemj.GeometryType.Box:
        raise ValueError(f'the body {name} should have one shape, a <Geom type="box">')
    return link, shapes[0]


def down(angle, length):
    """Return the end of a rod that hangs down and is turned about x."""
    return length * np.array([0, np.sin(angle), -np.cos(angle)])


def answer(q, start=UPPER, middle=LOWER / 2, scale=1.0, sign=1):
    first, second = q[0], q[0] + sign * q[1]
    centre = down(first, start) + down(second, middle)
    sizes = np.array([0.02, 0.02, UPPER, *(scale * np.array([0.02, 0.02, LOWER]))])
    return np.concatenate([down(first, UPPER / 2), sizes[:3], centre, sizes[3:]])


def about_shoulder(q):
    result = answer(q)
    result[6:9] = down(q[0] + q[1], UPPER + LOWER / 2)
    return result


def judge(given, q):
    right = answer(q)
    for name, part in PARTS.items():
        if np.abs(given[part] - right[part]).max() > 1e-6:
            return f"{name} is {shortened(given[part])} and should be {shortened(right[part])} m"
    return None


CHECK = Check(
    function=measured,
    question=lambda random: (random.uniform(-np.pi, np.pi, 2),),
    answer=answer,
    judge=judge,
    mistakes={
        "Extents are half of the sides: a rod of 0.2 m has 0.1 there.": lambda q: answer(q, scale=2),
        "The box is centred on the frame of lower: its own Translation moves it down by half its length.": lambda q: (
            answer(q, middle=0)
        ),
        "The frame of lower is at the shoulder: its Translation, from upper, is the length of upper.": lambda q: answer(
            q, start=0
        ),
        "The elbow turns about the shoulder: its offsetfrom should name lower, whose origin is the anchor.": (
            about_shoulder
        ),
        "The elbow turns the wrong way: its axis is 1 0 0, and its bodies are upper, then lower.": lambda q: answer(
            q, sign=-1
        ),
    },
    hints=(
        "Copy the body upper and the joint shoulder, and change what differs: names, lengths, and what they hang from.",
        "The body: offsetfrom upper, Translation 0 0 -0.3. Its Geom: Translation 0 0 -0.1, Extents half of the sides.",
        "The joint: Body upper, Body lower, offsetfrom lower, axis 1 0 0. The box: Extents 0.01 0.01 0.1.",
    ),
)
