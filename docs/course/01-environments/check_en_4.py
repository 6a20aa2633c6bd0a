"""Check of en-4."""

import warnings

import numpy as np

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import shortened

SIZES = {"table": np.array([1.2, 0.8, 0.04]), "parcel": np.array([0.3, 0.2, 0.1])}
HEIGHT, TURN = 0.75, np.pi / 6
PARTS = {
    "the middle of table": slice(0, 3),
    "the size of table": slice(3, 6),
    "the middle of parcel": slice(6, 9),
    "the size of parcel": slice(9, 12),
}
X_AXIS = slice(12, 15)


def measured(path):
    """Return a function without arguments: middles and sizes of the boxes, direction of the parcel's x-axis."""
    with warnings.catch_warnings(action="ignore"):
        env = ravemj.load(path)
    for finding in env.diagnostics:
        raise ValueError(str(finding))
    parts = []
    for name in SIZES:
        body = env.GetKinBody(name)
        if body is None:
            names = ", ".join(body.GetName() for body in env.GetBodies())
            raise ValueError(f"there is no KinBody {name}; there are {names}")
        shapes = [(link, shape) for link in body.GetLinks() for shape in link.GetGeometries()]
        if [shape.GetType() for _, shape in shapes] != [ravemj.GeometryType.Box]:
            raise ValueError(f'{name} should have one shape, a <Geom type="box">')
        if not shapes[0][0].IsStatic():
            raise ValueError(f'{name} should not fall: <Body type="static">')
        T_world_box = shapes[0][0].GetTransform() @ shapes[0][1].GetTransform()
        parts += [T_world_box[:3, 3], 2 * shapes[0][1].GetBoxExtents()]
    return lambda: np.concatenate([*parts, T_world_box[:3, 0]])


def answer(table=HEIGHT - 0.02, parcel=HEIGHT + 0.05, scale=1.0, turn=TURN):
    return np.concatenate(
        [
            [0.6, 0, table],
            scale * SIZES["table"],
            [0.5, 0.1, parcel],
            scale * SIZES["parcel"],
            [np.cos(turn), np.sin(turn), 0],
        ]
    )


def judge(given):
    right = answer()
    for name, part in PARTS.items():
        if np.abs(given[part] - right[part]).max() > 1e-6:
            return f"{name} is {shortened(given[part])} and should be {shortened(right[part])} m"
    if np.abs(given[X_AXIS] - right[X_AXIS]).max() > 1e-6:
        return (
            f"the x-axis of parcel points along {shortened(given[X_AXIS])}, and should along {shortened(right[X_AXIS])}"
        )
    return None


CHECK = Check(
    function=measured,
    question=lambda random: (),
    answer=answer,
    judge=judge,
    questions=1,
    mistakes={
        "Extents are half of the sides: both boxes are twice as large as they should be.": lambda: answer(scale=2),
        "Translation is the middle of a box: the table's upper side is half its thickness above that.": lambda: answer(
            table=HEIGHT, parcel=HEIGHT + 0.07
        ),
        "The table's middle is at 0.75 m, so its upper side is 2 cm too high, and the parcel is in it.": lambda: answer(
            table=HEIGHT
        ),
        "The middle of the parcel is at the height of the table: it should be half its own height above.": (
            lambda: answer(parcel=HEIGHT)
        ),
        "The angle of <RotationAxis> is in degrees: 0 0 1 30.": lambda: answer(turn=np.deg2rad(TURN)),
        "The parcel is turned the other way: a positive angle about z turns x towards y.": lambda: answer(turn=-TURN),
        "The parcel is not turned: <RotationAxis>0 0 1 30</RotationAxis>.": lambda: answer(turn=0),
    },
    hints=(
        "A box is given by the position of its middle, and by half of its three sides.",
        "The middle of the table is half its thickness below 0.75, the parcel's half its height above.",
        "Translation 0.6 0 0.73 and Extents 0.6 0.4 0.02; 0.5 0.1 0.8 and 0.15 0.1 0.05, RotationAxis 0 0 1 30.",
    ),
)
