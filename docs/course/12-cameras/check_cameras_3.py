"""Check of cameras-3."""

import numpy as np

import ravemj
from ravemj.learn import Check, Scene


def question(random):
    eye = random.uniform(-2, 2, 3)
    return eye, eye + random.uniform(0.3, 2, 3) * random.choice([-1, 1], 3)


def answer(eye, point):
    return ravemj.transformLookat(point, eye, [0, 0, -1])


def with_axes(eye, point, *signs, order=(0, 1, 2)):
    """Return the pose with some axes reversed and reordered."""
    T = answer(eye, point)
    T[:3, :3] = T[:3, order] * signs
    return T


def not_normalized(eye, point):
    z = point - eye
    x = np.cross(z, [0, 0, 1])
    T = np.eye(4)
    T[:3] = np.column_stack([x, np.cross(z, x), z, eye])
    return T


def x_not_normalized(eye, point):
    z = (point - eye) / np.linalg.norm(point - eye)
    x = np.cross(z, [0, 0, 1])
    T = np.eye(4)
    T[:3] = np.column_stack([x, np.cross(z, x), z, eye])
    return T


def at_origin(eye, point):
    T = answer(eye, point)
    T[:3, 3] = 0
    return T


def rows(eye, point):
    T = answer(eye, point)
    T[:3, :3] = T[:3, :3].T
    return T


CHECK = Check(
    function="look_at",
    question=question,
    answer=answer,
    kind="pose",
    scene=lambda eye, point: Scene("panda", [0, 0, 0, -1.5, 0, 1.5, 0, 0]),
    mistakes={
        "This is the frame of OpenGL and MuJoCo: y is up, and it looks along -z. Here y is down and z forward.": (
            lambda eye, point: with_axes(eye, point, 1, -1, -1)
        ),
        "The picture is upside down: y should point down, and x to the right.": lambda eye, point: with_axes(
            eye, point, -1, -1, 1
        ),
        "x, y and z are left-handed: y points up. It is the cross product of z and x, in this order.": (
            lambda eye, point: with_axes(eye, point, 1, -1, 1)
        ),
        "x, y and z are left-handed: x points to the left. It is the cross product of y and z, in this order.": (
            lambda eye, point: with_axes(eye, point, -1, 1, 1)
        ),
        "z points from the point to the eye: the camera looks away from the point.": lambda eye, point: with_axes(
            eye, point, -1, 1, -1
        ),
        "Eye and point are exchanged: the camera is at the point, and looks at the eye.": lambda eye, point: answer(
            point, eye
        ),
        "The axes are not of length 1: divide each by its length.": not_normalized,
        "x is not of length 1: the cross product of two unit vectors is shorter, if they are not perpendicular.": (
            x_not_normalized
        ),
        "The position is missing: the last column has the eye.": at_origin,
        "The axes stand in the rows: they are the columns of the rotation.": rows,
        "x is forward here: the camera looks along its z axis.": lambda eye, point: with_axes(
            eye, point, 1, -1, -1, order=(2, 0, 1)
        ),
    },
    hints=(
        "Begin with z, the direction from the eye to the point, of length 1.",
        "x is perpendicular to z, and to the vertical [0, 0, 1]: a cross product, brought to length 1. In which order?",
        "x = cross(z, [0, 0, 1]), normalized; y = cross(z, x); the columns of the pose are x, y, z and the eye.",
    ),
)
