"""Force closure: friction cones, wrenches of contacts, and how well a grasp resists the worst disturbance.

A contact pushes along any direction within its friction cone; OpenRAVE's cones have eight edges, each of length 1. The
wrenches of all edges span a convex hull. A grasp is in force closure if the origin is inside, and its quality is the
distance of the origin from the hull's boundary (Ferrari and Canny, 1992).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import Floats
from ravemj.core.transforms import cross_rows
from ravemj.manipulation.grasping.hulls import hull_volume, missing_direction, nearest_facet

EDGES = 8
"""The number of edges of a friction cone in OpenRAVE."""

_ROUNDING = 1e-12
"""Distance from the boundary of the hull below which the origin counts as on it."""


@dataclass(frozen=True)
class Resistance:
    """Resistance of a grasp against the worst unit disturbance.

    Attributes:
        epsilon: Distance of the origin from the boundary of the wrench hull; 0 if the grasp is not in force closure.
        direction: Unit wrench, force and torque, shape (6,), in whose direction the contacts push least.
        contacts: Indices of the contacts that limit ``epsilon``: those with a wrench on the nearest facet, ascending.
    """

    epsilon: float
    direction: Floats
    contacts: tuple[int, ...]

    @property
    def closed(self) -> bool:
        """Whether the grasp is in force closure."""
        return self.epsilon > 0


def friction_cones(normals: Floats, friction: float, edges: int = EDGES) -> Floats:
    """Return the unit edges of the friction cones about unit normals, shape (n, edges, 3).

    Args:
        normals: Shape (n, 3).
        friction: Friction coefficient; at 0 a cone has one edge, the normal.
        edges: Number of edges of a cone.
    """
    if friction <= 0:
        return normals[:, None, :]
    x, y, z = normals.T
    down = z < -1 + 1e-12
    share = 1 / np.where(down, 1.0, 1 + z)  # the frame is the least rotation from z to the normal
    right = np.stack([1 - x * x * share, -x * y * share, -x], axis=1)
    up = np.stack([-x * y * share, 1 - y * y * share, -y], axis=1)
    right[down], up[down] = (1, 0, 0), (0, -1, 0)
    angles = np.arange(edges) * (2 * np.pi / edges)
    sine, cosine = np.sin(angles)[:, None], np.cos(angles)[:, None]
    cones = normals[:, None] + friction * (sine * right[:, None] + cosine * up[:, None])
    return cones / np.linalg.norm(cones, axis=2, keepdims=True)


def wrenches(positions: Floats, cones: Floats) -> Floats:
    """Return forces and their torques about the origin, shape (n * edges, 6).

    Args:
        positions: Contact points, shape (n, 3).
        cones: Forces at each contact, shape (n, edges, 3).
    """
    forces = cones.reshape(-1, 3)
    return np.hstack([forces, cross_rows(np.repeat(positions, cones.shape[1], axis=0), forces)])


def resistance(positions: ArrayLike, normals: ArrayLike, friction: float, edges: int = EDGES) -> Resistance:
    """Return the resistance of contacts against the worst unit disturbance, with torques about the origin.

    Args:
        positions: Contact points, shape (n, 3) [m].
        normals: Unit normals, shape (n, 3), all towards the object or all away from it.
        friction: Friction coefficient.
        edges: Number of edges of a friction cone.

    >>> faces = np.vstack([np.eye(3), -np.eye(3)])
    >>> resistance(faces, faces, friction=0.5).contacts
    (0, 1, 2, 3, 4, 5)
    """
    points = _points(positions, normals, friction, edges)
    per_contact = edges if friction > 0 else 1
    if len(points) == 0:
        return Resistance(0.0, np.zeros(6), ())
    facet = nearest_facet(points)
    if facet is None:
        return Resistance(0.0, missing_direction(points), tuple(range(len(points) // per_contact)))
    contacts = np.unique(facet.points // per_contact)
    return Resistance(facet.offset if facet.offset > _ROUNDING else 0.0, facet.normal, tuple(map(int, contacts)))


def epsilon(positions: ArrayLike, normals: ArrayLike, friction: float, edges: int = EDGES) -> float:
    """Return the distance of the origin from the boundary of the wrench hull: OpenRAVE's ``mindist``.

    The value mixes newtons and newton metres, and depends on the object's pose in the world; ``quality`` does not. It
    is 0 if the grasp is not in force closure.

    Args:
        positions: Contact points in the world, shape (n, 3) [m].
        normals: Unit normals, shape (n, 3), all towards the object or all away from it.
        friction: Friction coefficient.
        edges: Number of edges of a friction cone.

    >>> faces = np.vstack([np.eye(3), -np.eye(3)])
    >>> round(epsilon(faces, faces, friction=0.4), 5)
    0.30324
    """
    return resistance(positions, normals, friction, edges).epsilon


def quality(
    positions: ArrayLike, normals: ArrayLike, friction: float, center: Floats, radius: float, edges: int = EDGES
) -> Resistance:
    """Return the resistance computed with torques about the centre of mass that are divided by the object's radius.

    It does not change if the object moves or is scaled, so grasps of different objects can be compared. The torques in
    ``direction`` are divided by the radius, too.

    Args:
        positions: Contact points, shape (n, 3) [m].
        normals: Unit normals, shape (n, 3).
        friction: Friction coefficient.
        center: Centre of mass of the object, shape (3,), in the frame of the contacts [m].
        radius: Distance of the object's farthest point from the centre of mass [m].
        edges: Number of edges of a friction cone.
    """
    return resistance((np.asarray(positions, float).reshape(-1, 3) - center) / radius, normals, friction, edges)


def volume(positions: ArrayLike, normals: ArrayLike, friction: float, edges: int = EDGES) -> float:
    """Return the volume of the wrench hull; 0 if it is flat.

    Args:
        positions: Contact points, shape (n, 3) [m].
        normals: Unit normals, shape (n, 3).
        friction: Friction coefficient.
        edges: Number of edges of a friction cone.
    """
    return hull_volume(_points(positions, normals, friction, edges))


def _points(positions: ArrayLike, normals: ArrayLike, friction: float, edges: int) -> Floats:
    positions, normals = np.asarray(positions, float).reshape(-1, 3), np.asarray(normals, float).reshape(-1, 3)
    return wrenches(positions, friction_cones(normals, friction, edges))
