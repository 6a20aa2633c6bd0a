"""Least-squares fits of circles and spheres, and the closest points of lines."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError


def fitCircle(points: ArrayLike, geometric_refinement: bool = True) -> tuple[Floats, float, float]:
    """Return the circle that fits points best, by least squares of squared distances to the centre.

    Args:
        points: At least three points in a plane, shape (n, 2), or in space, shape (n, 3).
        geometric_refinement: Without effect, as in OpenRAVE.

    Returns:
        Centre, radius, and the sum of squared residuals.
    """
    del geometric_refinement
    given = _points(points, (2, 3), 3)
    if given.shape[1] == 2:
        return _fitted(given)
    middle = given.mean(axis=0)
    plane = np.linalg.svd(given - middle, full_matrices=False)[2][:2]  # orthogonal directions of largest extent
    centre, radius, error = _fitted((given - middle) @ plane.T)
    return middle + centre @ plane, radius, error


def fitSphere(points: ArrayLike, geometric_refinement: bool = True) -> tuple[Floats, float, float]:
    """Return the sphere that fits ``points`` of shape (n, 3) best; ``geometric_refinement`` as for ``fitCircle``."""
    del geometric_refinement
    return _fitted(_points(points, (3,), 4))


def _points(points: ArrayLike, dimensions: Sequence[int], least: int) -> Floats:
    given = checked_numbers(points, "points")
    if given.ndim != 2 or given.shape[1] not in dimensions or len(given) < least:
        shapes = " or ".join(f"(n, {dimension})" for dimension in dimensions)
        raise ArgumentError(f"points: has shape {given.shape}, and should have shape {shapes}, with n from {least} up")
    return given


def _fitted(points: Floats) -> tuple[Floats, float, float]:
    """Fit a circle or sphere by x^2 = 2 c x + (r^2 - c^2); return centre c, radius r, and sum of squared residuals."""
    unknowns, squares = np.column_stack([2 * points, np.ones(len(points))]), (points**2).sum(axis=1)
    solution = np.linalg.pinv(unknowns) @ squares
    centre = solution[:-1]
    error = float(((unknowns @ solution - squares) ** 2).sum())
    return centre, float(np.sqrt(solution[-1] + centre @ centre)), error


def intersectSegments(L0: ArrayLike, L1: ArrayLike) -> tuple[Floats, float]:
    """Return the midpoint of the shortest connection of two lines in space, each given by two points, shape (2, 3).

    Returns:
        The point halfway between ``L0`` and ``L1``, shape (3,), and the signed distance of the lines: positive if the
        cross product of their directions, that of ``L1`` first, points from ``L1`` to ``L0``.

    Raises:
        ArgumentError: the lines are parallel.
    """
    first, second = _line(L0, "L0"), _line(L1, "L1")
    along0, along1 = first[1] - first[0], second[1] - second[0]
    normal = np.cross(along1, along0)
    length = np.linalg.norm(normal)
    if length == 0.0:
        raise ArgumentError("L0, L1: are parallel, and should cross")
    normal /= length
    across = np.cross(normal, along1)
    nearest = first[0] + along0 * (across @ (second[0] - first[0])) / (across @ along0)
    distance = float((nearest - second[0]) @ normal)
    return nearest - 0.5 * distance * normal, distance


def _line(points: ArrayLike, name: str) -> Floats:
    line = checked_numbers(points, name)
    if line.shape != (2, 3):
        raise ArgumentError(f"{name}: has shape {line.shape}, and should have shape (2, 3)")
    return line
