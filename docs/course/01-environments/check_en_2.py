"""Check of en-2."""

import warnings

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import shortened

UPPER, LOWER, SIZE = 0.3, 0.2, np.array([0.06, 0.08, 0.1])
PARTS = {
    "the middle of the box of hand": (slice(0, 3), "m"),
    "the size of the box of hand": (slice(3, 6), "m"),
    "the pair of limits of wrist": (slice(6, 8), "rad"),
}


def measured(path):
    """Return a function of the three joint values: middle and size of the hand, limits of the wrist."""
    with warnings.catch_warnings(action="ignore"):
        env = ravemj.load(path)
    for finding in env.diagnostics:
        raise ValueError(str(finding))
    robot = env.GetRobots()[0]
    joints = [joint.GetName() for joint in robot.GetJoints()]
    if joints != ["shoulder", "elbow", "wrist"]:
        raise ValueError(f"the robot should have the joints shoulder, elbow and wrist; it has {joints}")
    hand = robot.GetLink("hand")
    shapes = [] if hand is None else hand.GetGeometries()
    if [shape.GetType() for shape in shapes] != [ravemj.GeometryType.Box]:
        raise ValueError('there should be a body hand with one shape, a <Geom type="box">')
    limits = np.concatenate(robot.GetJoint("wrist").GetLimits())

    def values(q):
        robot.SetDOFValues(q, range(3), ravemj.CheckLimitsAction.Nothing)
        middle = (hand.GetTransform() @ shapes[0].GetTransform())[:3, 3]
        return np.concatenate([middle, 2 * shapes[0].GetBoxExtents(), limits])

    return values


def turn(axis, angle):
    return ravemj.matrixFromAxisAngle(angle * np.asarray(axis))


def shift(z):
    T = np.eye(4)
    T[2, 3] = z
    return T


def answer(q, hand=-LOWER, anchor=0.0, axis=(0, 1, 0), middle=-SIZE[2] / 2, scale=1.0, limit=np.pi / 2):
    """Return the numbers for a hand whose frame is there in that of lower, and whose joint is there in its own."""
    T_world_lower = turn([1, 0, 0], q[0]) @ shift(-UPPER) @ turn([1, 0, 0], q[1])
    T_world_hand = T_world_lower @ shift(hand) @ shift(anchor) @ turn(axis, q[2]) @ shift(-anchor)
    return np.concatenate([(T_world_hand @ shift(middle))[:3, 3], scale * SIZE, [-limit, limit]])


def judge(given, q):
    right = answer(q)
    for name, (part, unit) in PARTS.items():
        if np.abs(given[part] - right[part]).max() > 1e-6:
            return f"{name} is {shortened(given[part])} and should be {shortened(right[part])} {unit}"
    return None


CHECK = Check(
    function=measured,
    question=lambda random: (random.uniform(-1.5, 1.5, 3),),
    answer=answer,
    judge=judge,
    mistakes={
        "<limits> are in radians: 90 degrees are 1.5708 there, or 90 in <limitsdeg>.": lambda q: answer(q, limit=90),
        "The hand is placed from the base: without <offsetfrom>lower</offsetfrom> a Translation starts there.": (
            lambda q: answer(q, hand=UPPER - LOWER)
        ),
        "The wrist turns about the origin of lower: its own offsetfrom should name hand.": lambda q: answer(
            q, anchor=LOWER
        ),
        "The wrist turns about the origin of the base: it has no offsetfrom, which should name hand.": lambda q: answer(
            q, anchor=UPPER + LOWER
        ),
        "Extents are half of the sides: 0.03 0.04 0.05.": lambda q: answer(q, scale=2),
        "The box is centred on the wrist: its own Translation moves it down by half its height.": lambda q: answer(
            q, middle=0
        ),
        "The wrist turns about x like the others: its axis is 0 1 0.": lambda q: answer(q, axis=(1, 0, 0)),
        "The frame of hand is at the elbow: its Translation, from lower, is the length of lower.": lambda q: answer(
            q, hand=0
        ),
    },
    hints=(
        "The body lower and the joint elbow show the form. Without circular, a hinge has limits.",
        "The frame of hand is 0.2 m below that of lower; its box is 0.05 m below the frame of hand.",
        "The joint: Body lower, Body hand, offsetfrom hand, axis 0 1 0, and <limitsdeg>-90 90</limitsdeg>.",
    ),
)
