"""Check of en-3."""

import warnings

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import shortened

POLE, ARM, START = 0.4, 0.3, 0.01
BODIES, JOINTS = ["plate", "pole", "arm"], ["turn", "nod"]
PARTS = {
    "the middle of the box of pole": (slice(0, 3), "m"),
    "the size of the box of pole": (slice(3, 6), "m"),
    "the middle of the box of arm": (slice(6, 9), "m"),
    "the size of the box of arm": (slice(9, 12), "m"),
    "the pair of limits of nod": (slice(12, 14), "rad"),
}


def measured(path):
    """Return a function of the two joint values: middles and sizes of the boxes, limits of the second joint."""
    with warnings.catch_warnings(action="ignore"):
        env = ravemj.load(path)
    for finding in env.diagnostics:
        raise ValueError(str(finding))
    robot = env.GetRobots()[0]
    for kind, wanted, parts in (("bodies", BODIES, robot.GetLinks()), ("joints", JOINTS, robot.GetJoints())):
        names = [part.GetName() for part in parts]
        if names != wanted:
            raise ValueError(f"the lamp should keep its {kind} {', '.join(wanted)}; it has {', '.join(names)}")
    boxes = [(link, link.GetGeometries()) for link in robot.GetLinks()[1:]]
    for link, shapes in boxes:
        if [shape.GetType() for shape in shapes] != [ravemj.GeometryType.Box]:
            raise ValueError(f"the body {link.GetName()} should keep its box")
    limits = np.concatenate(robot.GetJoint("nod").GetLimits())

    def values(q):
        robot.SetDOFValues(q, range(2), ravemj.CheckLimitsAction.Nothing)
        parts = [limits]
        for link, (shape,) in reversed(boxes):
            parts = [(link.GetTransform() @ shape.GetTransform())[:3, 3], 2 * shape.GetBoxExtents(), *parts]
        return np.concatenate(parts)

    return values


def answer(q, limit=np.pi / 3, arm_frame=POLE):
    turn, nod = q
    arm = ARM / 2 * np.array([np.cos(turn) * np.cos(nod), np.sin(turn) * np.cos(nod), -np.sin(nod)])
    middles = [0, 0, START + POLE / 2], arm + np.array([0, 0, START + arm_frame])
    sizes = [0.02, 0.02, POLE], [ARM, 0.02, 0.02]
    return np.concatenate([middles[0], sizes[0], middles[1], sizes[1], [-limit, limit]])


def judge(given, q):
    right = answer(q)
    for name, (part, unit) in PARTS.items():
        if np.abs(given[part] - right[part]).max() > 1e-6:
            return f"{name} is {shortened(given[part])} and should be {shortened(right[part])} {unit}"
    return None


CHECK = Check(
    function=measured,
    question=lambda random: (random.uniform(-1, 1, 2),),
    answer=answer,
    judge=judge,
    mistakes={
        "Without <limitsdeg> a hinge turns by half a turn to either side: mend the tag, do not delete it.": (
            lambda q: answer(q, limit=np.pi)
        ),
        "The limits are in degrees, so their tag is <limitsdeg>; <limits> takes radians.": lambda q: answer(
            q, limit=60
        ),
        "The arm is at the lower end of the pole: its Translation is 0 0 0.4, with a zero in place of the letter O.": (
            lambda q: answer(q, arm_frame=0)
        ),
    },
    hints=(
        "ravemj check en_3.xml names a line for each finding; after a fatal one it reads no further. Then ask again.",
        "Four things are misspelled: two tags, a name, and a number.",
        "Extents, pole, 0 0 0.4 with a zero, limitsdeg.",
    ),
)
