"""Check of body-2."""

import numpy as np

from ravemj.learn import Check


def question(random):
    angles = np.sort(random.uniform(0, 2 * np.pi, random.integers(4, 8)))
    while np.diff(angles, append=angles[0] + 2 * np.pi).max() > 2.5:
        angles = np.sort(random.uniform(0, 2 * np.pi, len(angles)))
    corners = np.column_stack([np.cos(angles), np.sin(angles)]) * random.uniform(0.08, 0.3, 2)
    middle = random.uniform(-1, 1, 2)
    return np.array([*(middle + random.uniform(-0.12, 0.12, 2)), random.uniform(0.4, 1)]), corners + middle


def distances(com, corners):
    edges = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack([-edges[:, 1], edges[:, 0]]) / np.linalg.norm(edges, axis=1)[:, None]
    return np.einsum("ni,ni->n", normals, com[:2] - corners)


def answer(com, corners):
    return distances(com, corners).min()


def not_normalized(com, corners):
    lengths = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    return (distances(com, corners) * lengths).min()


CHECK = Check(
    function="margin",
    question=question,
    answer=answer,
    kind="number",
    mistakes={
        "The sign is wrong: a distance is positive inside.": lambda com, corners: -answer(com, corners),
        "Signs are forgotten: the robot falls if the centre of mass is outside.": lambda com, corners: np.abs(
            distances(com, corners)
        ).min(),
        "This is the largest distance from an edge: the nearest edge counts.": lambda com, corners: distances(
            com, corners
        ).max(),
        "Inner and outer side are exchanged: along a counterclockwise edge, the inner side is on the left.": (
            lambda com, corners: (-distances(com, corners)).min()
        ),
        "This is the distance from the nearest corner: the edges between the corners may be nearer.": (
            lambda com, corners: np.linalg.norm(com[:2] - corners, axis=1).min()
        ),
        "The cross product is not divided by the length of the edge.": not_normalized,
        "The last edge is missing, from the last corner back to the first one.": lambda com, corners: distances(
            com, corners
        )[:-1].min(),
    },
    hints=(
        "Take one edge, from a to b. On which side of it is the point? The sign of a cross product tells.",
        "(b - a) x (p - a) in the plane is an area: the length of the edge times the distance from its line.",
        "(ex * wy - ey * wx) / |e|, with e = b - a and w = p - a. The last edge goes back to the first corner.",
    ),
)
