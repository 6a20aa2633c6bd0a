"""Check of cameras-2."""

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
    p = seen(random)
    return K, T, (K @ p)[:2] / p[2], p[2]


def ray(K, pixel):
    return np.array([*(pixel - K[:2, 2]) / [K[0, 0], K[1, 1]], 1])


def in_world(T, p):
    return T[:3, :3] @ p + T[:3, 3]


def answer(K, T, pixel, depth):
    return in_world(T, depth * ray(K, pixel))


CHECK = Check(
    function="seen_point",
    question=question,
    answer=answer,
    kind="position",
    mistakes={
        "The point is in the frame of the camera: T_world_camera takes it to the world.": lambda K, T, pixel, depth: (
            depth * ray(K, pixel)
        ),
        "Depth is taken for the distance along the ray: it is measured along the z axis, so the ray needs z = 1.": (
            lambda K, T, pixel, depth: in_world(T, depth * ray(K, pixel) / np.linalg.norm(ray(K, pixel)))
        ),
        "The pose is inverted, which is not needed here: T_world_camera takes points of the camera to the world.": (
            lambda K, T, pixel, depth: T[:3, :3].T @ (depth * ray(K, pixel) - T[:3, 3])
        ),
        "The rotation is transposed: T_world_camera takes points of the camera to the world as it is.": (
            lambda K, T, pixel, depth: T[:3, :3].T @ (depth * ray(K, pixel)) + T[:3, 3]
        ),
        "The position of the camera is left out.": lambda K, T, pixel, depth: T[:3, :3] @ (depth * ray(K, pixel)),
        "The principal point is forgotten: subtract cx and cy from the pixel first.": lambda K, T, pixel, depth: (
            in_world(T, depth * ray(K, pixel + K[:2, 2]))
        ),
        "The ray is not multiplied by the depth: only z is.": lambda K, T, pixel, depth: in_world(
            T, ray(K, pixel) * [1, 1, depth]
        ),
        "y is up here, as in OpenGL: in this frame y points down, as rows of pixels do.": lambda K, T, pixel, depth: (
            in_world(T, depth * ray(K, pixel) * [1, -1, 1])
        ),
        "The camera looks along -z here, as in OpenGL: in this frame it looks along +z, and y is down.": (
            lambda K, T, pixel, depth: in_world(T, depth * ray(K, pixel) * [1, -1, -1])
        ),
        "u and v are exchanged: u is the column, v the row.": lambda K, T, pixel, depth: answer(
            K, T, pixel[::-1], depth
        ),
    },
    hints=(
        "Solve u = fx x / z + cx for x, and the same for y. z is the depth.",
        "In the camera's frame the point is depth * [(u - cx) / fx, (v - cy) / fy, 1]. And in the world?",
        "(T_world_camera @ [x, y, depth, 1])[:3], with x = depth * (u - cx) / fx and y = depth * (v - cy) / fy.",
    ),
)
