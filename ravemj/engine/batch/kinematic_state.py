"""Batched mechanics of a body in many configurations.

Arrays have a first axis for the links or velocity coordinates, then one for components, then one for configurations.
Motions are six numbers in world axes: the angular velocity, and the velocity of the body's point that passes through a
fixed reference point. Accelerations are their time derivatives. Forces are their duals: moment about the reference
point, and force. The root links are at rest.
"""

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.dynamics import NONE, CoordinateTree, Coupling
from ravemj.model.inertia import Inertias


class KinematicState:
    """Poses of the links and axes of a body.

    Attributes:
        tree: The tree of coordinates.
        coupling: The relation of coordinates to DOFs.
        screws: The motion of a link for one unit of each coordinate's velocity, shape (coordinates, 6, N).
        positions: Origins of the links, from the reference point [m], shape (links, 3, N).
        rotations: The x, y and z axis of each link, shape (links, 3, 3, N).
    """

    def __init__(
        self,
        tree: CoordinateTree,
        coupling: Coupling,
        axes: Floats,
        anchors: Floats,
        positions: Floats,
        rotations: Floats,
    ) -> None:
        self.tree = tree
        self.coupling = coupling
        self.positions = positions
        self.rotations = rotations
        self.screws = np.concatenate((axes, cross(anchors, axes)), axis=1)
        self.screws[tree.slides, :3] = 0.0
        self.screws[tree.slides, 3:] = axes[tree.slides]

    def twists(self, velocities: Floats) -> Floats:
        """Return the motion of the link moved directly by each coordinate, shape (coordinates, 6, N).

        Args:
            velocities: Velocities of the coordinates, shape (coordinates, N).
        """
        return self._outward(self.screws * velocities[:, None])

    def accelerations(self, twists: Floats, velocities: Floats, accelerations: Floats) -> Floats:
        """Return the time derivative of ``twists``.

        Args:
            twists: Result of ``twists``.
            velocities: Velocities of the coordinates, shape (coordinates, N).
            accelerations: Accelerations of the coordinates, shape (coordinates, N).
        """
        turned = _carried(twists[self.tree.carriers], self.screws)
        return self._outward(self.screws * accelerations[:, None] + turned * velocities[:, None])

    def _outward(self, own: Floats) -> Floats:
        """Add to each coordinate's values those of all coordinates between it and the base, in place."""
        for coordinate, parent in enumerate(self.tree.parents):
            if parent != NONE:
                own[coordinate] += own[parent]
        return own

    def of_links(self, of_coordinates: Floats) -> Floats:
        """Return for each link the value ``of_coordinates`` of the last coordinate that moves it; 0 for the roots."""
        by_link = np.zeros((len(self.tree.last), *of_coordinates.shape[1:]))
        moved = [link for link, last in enumerate(self.tree.last) if last != NONE]
        by_link[moved] = of_coordinates[[self.tree.last[link] for link in moved]]
        return by_link

    def forces(self, link_forces: Floats) -> Floats:
        """Return the generalised forces, shape (coordinates, N), of forces on the links, shape (links, 6, N)."""
        tree = self.tree
        borne = np.zeros((tree.count, *link_forces.shape[1:]))
        for link, last in enumerate(tree.last):
            if last != NONE:
                borne[last] += link_forces[link]
        for coordinate in reversed(range(tree.count)):
            if tree.parents[coordinate] != NONE:
                borne[tree.parents[coordinate]] += borne[coordinate]
        return (self.screws * borne).sum(axis=1)

    def needed_forces(self, inertias: Inertias, twists: Floats, accelerations: Floats, gravity: Floats) -> Floats:
        """Return the forces that produce given motions of the links, shape (links, 6, N).

        Args:
            inertias: Mass properties.
            twists: Motions of the links, shape (links, 6, N).
            accelerations: Time derivatives of the motions, shape (links, 6, N).
            gravity: Gravitational acceleration [m/s^2], shape (3,).
        """
        coms = self.positions + self._to_world(inertias.coms[:, :, None])
        spin, angular = twists[:, :3], accelerations[:, :3]
        velocities = twists[:, 3:] + cross(spin, coms)
        force = accelerations[:, 3:] + cross(angular, coms) + cross(spin, velocities) - gravity[None, :, None]
        force *= inertias.masses[:, None, None]
        local_spin, local_angular = self._to_local(spin), self._to_local(angular)
        moment = inertias.tensors @ local_angular + cross(local_spin, inertias.tensors @ local_spin)
        return np.concatenate((self._to_world(moment) + cross(coms, force), force), axis=1)

    def _to_local(self, vectors: Floats) -> Floats:
        return (self.rotations * vectors[:, None]).sum(axis=2)

    def _to_world(self, vectors: Floats) -> Floats:
        return (self.rotations * vectors[:, :, None]).sum(axis=1)


def cross(first: Floats, other: Floats) -> Floats:
    """Return the cross products along the second axis."""
    ax, ay, az = first[:, 0], first[:, 1], first[:, 2]
    bx, by, bz = other[:, 0], other[:, 1], other[:, 2]
    return np.stack((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx), axis=1)


def _carried(twists: Floats, screws: Floats) -> Floats:
    """Return the time derivative of screws moving with given twists."""
    spin, axis = twists[:, :3], screws[:, :3]
    return np.concatenate((cross(spin, axis), cross(spin, screws[:, 3:]) + cross(twists[:, 3:], axis)), axis=1)
