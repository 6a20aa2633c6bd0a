"""Approach rays: grids of start points and directions around a target, and directions on the unit sphere."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import quatRotateDirection, rotationMatrixFromQuat

MARGIN = 0.01
"""Distance of the grids from the sides of the target's bounding box [m]."""

_FAR = 100.0
"""Length of rays that start on a plane [m]."""

_MOST_LINES = 1000
"""Maximum number of grid lines along each axis of a box side."""


class Rays(NamedTuple):
    """Rays towards a target.

    Attributes:
        origins: Start points, shape (n, 3) [m].
        ways: Directions times lengths, shape (n, 3) [m].
    """

    origins: Floats
    ways: Floats

    def numbers(self) -> Floats:
        """Return the rays as input of ``env.CheckCollisionRays``, shape (n, 6)."""
        return np.hstack([self.origins, self.ways])


def grid_lines(half: float, delta: float) -> Floats:
    """Return the coordinates of grid lines: 0, and steps of ``delta`` from ``-half`` to 0 and from 0 to ``half``.

    Args:
        half: Half of the side length [m].
        delta: Spacing of the lines [m].

    Raises:
        ArgumentError: there would be more than a thousand lines.

    >>> grid_lines(0.03, 0.02)
    array([-0.03, -0.01,  0.  ,  0.02])
    """
    if not delta > 0 or 2 * half / delta > _MOST_LINES:
        raise ArgumentError(f"delta is {delta:g}; expected at least {2 * half / _MOST_LINES:.2g} m for this target")
    return np.concatenate([np.arange(-half, -0.25 * delta, delta), [0.0], np.arange(delta, half, delta)])


def grid_rays(center: Floats, sides: tuple[Floats, Floats], direction: Floats, delta: float) -> Rays:
    """Return parallel rays from a grid on a rectangle.

    Args:
        center: Center of the rectangle, shape (3,).
        sides: Vectors of half of each side, shape (3,) [m].
        direction: Direction times length of the rays [m].
        delta: Spacing of the grid lines [m].
    """
    lengths = [float(np.linalg.norm(side)) for side in sides]
    if min(lengths) == 0:
        raise ArgumentError("sidex and sidey: a side has length 0; expected half of each side of the rectangle")
    first, second = np.meshgrid(*(grid_lines(length, delta) for length in lengths))
    steps = [side / length for side, length in zip(sides, lengths, strict=True)]
    origins = center + np.outer(first.ravel(), steps[0]) + np.outer(second.ravel(), steps[1])
    return Rays(origins, np.tile(direction, (len(origins), 1)))


def box_rays(center: Floats, half: Floats, delta: float) -> Rays:
    """Return rays from grids on the six sides of an enlarged box, in the order +z, -z, +y, -y, +x, -x.

    Args:
        center: Center of the target's box, shape (3,).
        half: Half of its side lengths, shape (3,) [m].
        delta: Spacing of the grid lines [m].
    """
    axes = np.diag(half + MARGIN)
    sides: list[Rays] = []
    for axis, first, second in ((2, 0, 1), (1, 0, 2), (0, 1, 2)):
        for outward in (axes[axis], -axes[axis]):
            sides.append(grid_rays(center + outward, (axes[first], axes[second]), -2 * outward, delta))
    return Rays(np.concatenate([side.origins for side in sides]), np.concatenate([side.ways for side in sides]))


def plane_rays(center: ArrayLike, sidex: ArrayLike, sidey: ArrayLike, delta: float) -> Rays:
    """Return parallel rays from a grid on a rectangle, in the direction ``sidex`` x ``sidey``.

    Args:
        center: Center of the rectangle, shape (3,).
        sidex: Vector of half of one side, shape (3,) [m].
        sidey: Vector of half of the other side, shape (3,) [m].
        delta: Spacing of the grid lines [m].
    """
    sides = np.asarray(sidex, float), np.asarray(sidey, float)
    normal = np.cross(*sides)
    length = float(np.linalg.norm(normal))
    if length == 0:
        raise ArgumentError("sidex and sidey: are parallel; expected two sides of a rectangle")
    return grid_rays(np.asarray(center, float), sides, normal * (_FAR / length), delta)


def sphere_rays(center: Floats, radius: float, delta: float) -> Rays:
    """Return rays from a sphere around the target to its center.

    Args:
        center: Center of the sphere, shape (3,).
        radius: Radius [m].
        delta: Angle between neighbours [rad].
    """
    outward = directions(level_of(delta))
    return Rays(center + radius * outward, -radius * outward)


def circle_rays(center: ArrayLike, normalaxis: ArrayLike, radius: float, delta: float) -> Rays:
    """Return rays from a circle to its center.

    Args:
        center: Center of the circle, shape (3,).
        normalaxis: Axis of the circle, shape (3,).
        radius: Radius [m].
        delta: Angle between neighbours [rad].
    """
    if not delta > 0:
        raise ArgumentError(f"delta is {delta:g}; expected an angle above 0")
    angles = np.arange(0, 2 * np.pi, delta)
    inward = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])
    inward = inward @ _least_rotation(np.asarray(normalaxis, float)).T
    return Rays(np.asarray(center, float) - radius * inward, radius * inward)


def spread(hits: Floats, angle: float, delta: float) -> Floats:
    """Return for each hit several directions in a cone around its normal.

    Args:
        hits: Points and unit normals, shape (n, 6).
        angle: Largest angle from the normal [rad]; 0 returns the hits.
        delta: Angle between neighbouring directions [rad].

    Returns:
        Points and unit directions, shape (n * k, 6); the normal alone if no direction is near enough.
    """
    if angle <= 0:
        return hits
    around = directions(level_of(delta))
    near = around[around[:, 2] > np.cos(angle)]
    if not len(near):
        return hits
    turned = [np.hstack([np.tile(hit[:3], (len(near), 1)), near @ _least_rotation(hit[3:]).T]) for hit in hits]
    return np.concatenate(turned) if turned else hits


def level_of(delta: float) -> int:
    """Return the level of ``directions`` whose neighbours are about ``delta`` [rad] apart, by OpenRAVE's rule."""
    if not delta > 0:
        raise ArgumentError(f"delta is {delta:g}; expected an angle above 0")
    return max(0, int(0.5 - np.log2(delta)))


def directions(level: int) -> Floats:
    """Return the centers of the 12 * 4^level pixels of HEALPix, unit vectors from the north pole on, shape (n, 3).

    Gorski et al. (2005), equations 4 to 9, in the ring scheme.
    """
    sides = 2**level
    rings: list[Floats] = []
    for ring in range(1, 4 * sides):
        polar = min(ring, 4 * sides - ring)
        if polar < sides:
            count, height, shift = 4 * polar, 1 - polar**2 / (3 * sides**2), 0.5
            height = height if ring == polar else -height
        else:
            count, height, shift = 4 * sides, 4 / 3 - 2 * ring / (3 * sides), ((ring - sides + 1) % 2) / 2
        angles = 2 * np.pi * (np.arange(count) + (shift if polar < sides else 1 - shift)) / count
        radius = np.sqrt(1 - height**2)
        rings.append(np.column_stack([radius * np.cos(angles), radius * np.sin(angles), np.full(count, height)]))
    return np.concatenate(rings)


def _least_rotation(axis: Floats) -> Floats:
    """Return the least rotation from z to an axis, shape (3, 3)."""
    return rotationMatrixFromQuat(quatRotateDirection([0, 0, 1], axis))
