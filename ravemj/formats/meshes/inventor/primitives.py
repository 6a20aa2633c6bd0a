"""Boxes, spheres, cylinders and cones as triangles, tessellated like Coin, with which OpenRAVE loads Inventor.

Round shapes start at -z; their axis is y. Triangles are their three points, shape (n, 3, 3).
"""

from collections.abc import Set
from itertools import pairwise

import numpy as np

from ravemj.core.transforms import Floats

DEFAULT_COMPLEXITY = 0.5
"""Fineness, from 0 to 1, without a Complexity node: 20 sides of cylinders and cones, 15 of spheres."""


def box(size: Floats) -> Floats:
    """Return a centred box with full edge lengths ``size``, shape (12, 3, 3)."""
    signs = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
    quads = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    return (signs * size / 2)[quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)]


def cylinder(radius: float, height: float, parts: Set[str], complexity: float = DEFAULT_COMPLEXITY) -> Floats:
    """Return ``parts`` of a centred cylinder: ``SIDES``, ``TOP``, ``BOTTOM``."""
    low = _bottom(radius, height, complexity)
    high = low + np.array([0.0, height, 0.0])
    return _joined(parts, SIDES=_band(high, low), TOP=_disc(high), BOTTOM=_disc(low[::-1]))


def cone(radius: float, height: float, parts: Set[str], complexity: float = DEFAULT_COMPLEXITY) -> Floats:
    """Return ``parts`` of a cone, ``SIDES`` and ``BOTTOM``; its tip is at ``height / 2``."""
    low = _bottom(radius, height, complexity)
    tip = np.broadcast_to([0.0, height / 2, 0.0], low.shape)
    sides = np.stack([tip, low, np.roll(low, -1, axis=0)], axis=1)
    return _joined(parts, SIDES=sides, BOTTOM=_disc(low[::-1]))


def sphere(radius: float, complexity: float = DEFAULT_COMPLEXITY) -> Floats:
    """Return a sphere."""
    slices = max(int(30 * complexity), 4)
    stacks = max(int(30 * complexity), 3) - 1
    circle = _circle(slices)
    angles = np.pi * np.arange(1, stacks) / stacks
    rings = [radius * (np.sin(angle) * circle + [0.0, np.cos(angle), 0.0]) for angle in angles]
    top, bottom = (np.broadcast_to([0.0, y, 0.0], circle.shape) for y in (radius, -radius))
    caps = [
        np.stack([top, rings[0], np.roll(rings[0], -1, axis=0)], axis=1),
        np.stack([bottom, np.roll(rings[-1], -1, axis=0), rings[-1]], axis=1),
    ]
    bands = [_band(high, low) for high, low in pairwise(rings)]
    return np.concatenate(caps + bands)


def _bottom(radius: float, height: float, complexity: float) -> Floats:
    return _circle(max(int(40 * complexity), 4)) * [radius, 0.0, radius] - [0.0, height / 2, 0.0]


def _joined(parts: Set[str], **pieces: Floats) -> Floats:
    return np.concatenate([np.zeros((0, 3, 3)), *(piece for name, piece in pieces.items() if name in parts)])


def _circle(count: int) -> Floats:
    """Return points of the unit circle about y, counter-clockwise seen from above (+y)."""
    angles = 2 * np.pi * np.arange(count) / count
    return np.stack([-np.sin(angles), np.zeros(count), -np.cos(angles)], axis=1)


def _band(high: Floats, low: Floats) -> Floats:
    """Return triangles that connect two rings of equally many points, facing outwards; ``high`` is the upper ring."""
    high_next, low_next = np.roll(high, -1, axis=0), np.roll(low, -1, axis=0)
    return np.concatenate([np.stack([high, low, low_next], axis=1), np.stack([high, low_next, high_next], axis=1)])


def _disc(ring: Floats) -> Floats:
    first = np.broadcast_to(ring[0], (len(ring) - 2, 3))
    return np.stack([first, ring[1:-1], ring[2:]], axis=1)
