"""Check of cameras-1."""

import numpy as np

from ravemj import matrixFromAxisAngle
from ravemj.learn import Check


def camera(random):
    """Return a camera matrix and a random pose."""
    fx, fy = random.uniform(200, 600, 2)
    T = matrixFromAxisAngle(random.normal(size=3))
    T[:3, 3] = random.uniform(-2, 2, 3)
    return np.array([[fx, 0, random.uniform(100, 300)], [0, fy, random.uniform(100, 300)], [0, 0, 1]]), T


def seen(random):
    """Return a point in front of a camera, in its frame."""
    z = random.uniform(0.5, 3)
    return np.array([*random.uniform(-0.5, 0.5, 2) * z, z])


def question(random):
    K, T = camera(random)
    return K, T, T[:3, :3] @ seen(random) + T[:3, 3]


def in_camera(T, point):
    return T[:3, :3].T @ (point - T[:3, 3])


def projected(K, p):
    return (K @ p)[:2] / p[2]


def by_distance(K, T, point):
    p = in_camera(T, point)
    return projected(K, [*p[:2] / np.linalg.norm(p), 1])


def answer(K, T, point):
    return projected(K, in_camera(T, point))


CHECK = Check(
    function="pixel",
    question=question,
    answer=answer,
    mistakes={
        "The pixel is rounded: leave it as it is.": lambda *arguments: np.round(answer(*arguments)),
        "The camera matrix K is missing: these are x / z and y / z in metres, not pixels.": lambda K, T, p: (
            in_camera(T, p)[:2] / in_camera(T, p)[2]
        ),
        "The pose is not inverted: T_world_camera takes points of the camera to the world, not the other way.": (
            lambda K, T, p: projected(K, T[:3, :3] @ p + T[:3, 3])
        ),
        "The point is not in the frame of the camera: take it there first, with the inverse of the pose.": (
            lambda K, T, p: projected(K, p)
        ),
        "The position of the camera is left out: subtract it from the point before you rotate.": lambda K, T, p: (
            projected(K, T[:3, :3].T @ p)
        ),
        "The rotation of the camera is left out.": lambda K, T, p: projected(K, p - T[:3, 3]),
        "Only the rotation is transposed: the inverse of a pose has the position -R.T @ p.": lambda K, T, p: projected(
            K, T[:3, :3].T @ p - T[:3, 3]
        ),
        "The division by the depth z is missing: what is twice as far looks half as large.": lambda K, T, p: (
            K @ in_camera(T, p)
        )[:2],
        "The division is by the distance from the camera: divide by z alone.": by_distance,
        "y is up here, as in OpenGL: in this frame y points down, as rows of pixels do.": lambda K, T, p: projected(
            K, in_camera(T, p) * [1, -1, 1]
        ),
        "The camera looks along -z here, as in OpenGL: in this frame it looks along +z, and y is down.": (
            lambda K, T, p: projected(K, in_camera(T, p) * [-1, 1, 1])
        ),
        "The principal point is forgotten: add cx and cy, because pixels count from the corner of the picture.": (
            lambda K, T, p: answer(K, T, p) - K[:2, 2]
        ),
        "u and v are exchanged: u is the column, v the row.": lambda K, T, p: answer(K, T, p)[::-1],
    },
    hints=(
        "Where is the point in the frame of the camera? Which of T_world_camera and its inverse takes it there?",
        "p = (np.linalg.inv(T_world_camera) @ [*point, 1])[:3]. Then K @ p, and what is still to be divided?",
        "u, v, w = K @ p; the pixel is [u / w, v / w].",
    ),
)
