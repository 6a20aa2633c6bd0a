"""The mechanics of a body whose links are somewhere: one configuration, or many at once.

Arrays have a first axis for the links or movers, then one for components, and, for many configurations, a last one.
Motions are six numbers in world axes: the angular velocity, and the velocity of the body's point that passes through a
fixed reference point. Accelerations are their time derivatives, and forces their duals: moment about the reference
point, and force.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.dynamics.coupling import Slopes
from ravemj.engine.dynamics.tree import NONE, Tree
from ravemj.model.scene import Link


@dataclass(frozen=True, slots=True)
class Inertias:
    """Mass properties of the links.

    Attributes:
        masses: Masses [kg], shape (links,).
        coms: Centres of mass in the links' frames [m], shape (links, 3).
        tensors: Inertia about them, in axes parallel to the links' [kg m^2], shape (links, 3, 3).
    """

    masses: Floats
    coms: Floats
    tensors: Floats

    @classmethod
    def of(cls, links: Sequence[Link]) -> "Inertias":
        """Return those of the links of a scene."""
        count = len(links)
        return cls(
            np.array([link.inertial.mass for link in links], dtype=np.float64),
            np.array([link.inertial.com for link in links], dtype=np.float64).reshape(count, 3),
            np.array([link.inertial.inertia for link in links], dtype=np.float64).reshape(count, 3, 3),
        )


class Posture:
    """Where the links and the axes of a body are.

    Attributes:
        tree: What carries what.
        slopes: How the movers follow the DOFs.
        screws: The motion of a link for one unit of each mover's velocity, shape (movers, 6, ...).
        positions: Origins of the links, from the reference point [m], shape (links, 3, ...).
        rotations: For each link the directions of its axes, one after the other, shape (links, 3, 3, ...).
    """

    def __init__(
        self, tree: Tree, slopes: Slopes, axes: Floats, anchors: Floats, positions: Floats, rotations: Floats
    ) -> None:
        self.tree = tree
        self.slopes = slopes
        self.positions = positions
        self.rotations = rotations
        self.screws = np.concatenate((axes, cross(anchors, axes)), axis=1)
        self.screws[tree.slides, :3] = 0.0
        self.screws[tree.slides, 3:] = axes[tree.slides]

    def columns(self, link: int, point: Floats) -> Floats:
        """Return how a link's point and the link move with each mover.

        Args:
            link: Its index.
            point: From the reference point [m], shape (3, ...).

        Returns:
            Velocity of the point and angular velocity for one unit of each mover's, shape (movers, 6, ...).
        """
        turning = self.screws[:, :3]
        reach = self.tree.reach[link].reshape(-1, *[1] * (self.screws.ndim - 1))
        return reach * np.concatenate((self.screws[:, 3:] + cross(turning, point[None]), turning), axis=1)

    def jacobian(self, link: int, point: Floats) -> Floats:
        """Return ``columns`` by the DOFs, shape (dof, 6, ...)."""
        return self.slopes.backward(self.columns(link, point))

    def twists(self, rates: Floats, bases: Floats | None) -> Floats:
        """Return the motion of the links that each mover moves last, shape (movers, 6, ...).

        Args:
            rates: The movers' velocities, shape (movers, ...).
            bases: Motions of the links, of which those of the roots count, shape (links, 6, ...); None: they rest.
        """
        return self._outward(self.screws * rates[:, None], bases)

    def _outward(self, own: Floats, bases: Floats | None) -> Floats:
        """Add to what each mover does what those below it do, in place."""
        for mover, parent in enumerate(self.tree.parents):
            if parent != NONE:
                own[mover] += own[parent]
            elif bases is not None:
                own[mover] += bases[self.tree.mover_roots[mover]]
        return own

    def of_links(self, of_movers: Floats, bases: Floats | None) -> Floats:
        """Return for each link what is said of its last mover, or of its base where no mover moves it."""
        rest = np.zeros((len(self.tree.last), *of_movers.shape[1:])) if bases is None else bases[self.tree.roots]
        moved = [link for link, mover in enumerate(self.tree.last) if mover != NONE]
        rest[moved] = of_movers[[self.tree.last[link] for link in moved]]
        return rest

    def accelerations(self, twists: Floats, rates: Floats, growths: Floats, bases: Floats | None) -> Floats:
        """Return the time derivative of ``twists``.

        Args:
            twists: From ``twists``.
            rates: The movers' velocities, shape (movers, ...).
            growths: Their derivatives, shape (movers, ...).
            bases: Those of the links' motions, of which those of the roots count; None: none.
        """
        turned = _carried(twists[self.tree.carriers], self.screws)
        return self._outward(self.screws * growths[:, None] + turned * rates[:, None], bases)

    def forces(self, link_forces: Floats) -> Floats:
        """Return the movers' generalised forces of forces on the links, shape (links, 6, ...) to (movers, ...)."""
        tree = self.tree
        borne = np.zeros((tree.count, *link_forces.shape[1:]))
        for link, mover in enumerate(tree.last):
            if mover != NONE:
                borne[mover] += link_forces[link]
        for mover in reversed(range(tree.count)):
            if tree.parents[mover] != NONE:
                borne[tree.parents[mover]] += borne[mover]
        return (self.screws * borne).sum(axis=1)

    def coms(self, inertias: Inertias) -> Floats:
        """Return the centres of mass of the links, from the reference point [m], shape (links, 3, ...)."""
        return self.positions + self._to_world(_like(inertias.coms, self.positions))

    def needed_forces(self, inertias: Inertias, twists: Floats, accelerations: Floats, gravity: Floats) -> Floats:
        """Return the forces that let the links move as they do, shape (links, 6, ...).

        Args:
            inertias: Mass properties.
            twists: Motions of the links, shape (links, 6, ...).
            accelerations: Their derivatives, shape (links, 6, ...).
            gravity: Acceleration of free fall [m/s^2], shape (3,).
        """
        coms = self.coms(inertias)
        spin, growth = twists[:, :3], accelerations[:, :3]
        velocities = twists[:, 3:] + cross(spin, coms)
        falling = _like(gravity[None], coms)
        force = accelerations[:, 3:] + cross(growth, coms) + cross(spin, velocities) - falling
        force *= _like(inertias.masses[:, None], force)
        local_spin, local_growth = self._to_local(spin), self._to_local(growth)
        moment = _times(inertias.tensors, local_growth) + cross(local_spin, _times(inertias.tensors, local_spin))
        return np.concatenate((self._to_world(moment) + cross(coms, force), force), axis=1)

    def _to_local(self, vectors: Floats) -> Floats:
        return (self.rotations * vectors[:, None]).sum(axis=2)

    def _to_world(self, vectors: Floats) -> Floats:
        return (self.rotations * vectors[:, :, None]).sum(axis=1)


def cross(one: Floats, other: Floats) -> Floats:
    """Return the cross products along the second axis."""
    ax, ay, az = one[:, 0], one[:, 1], one[:, 2]
    bx, by, bz = other[:, 0], other[:, 1], other[:, 2]
    return np.stack((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx), axis=1)


def _carried(twists: Floats, screws: Floats) -> Floats:
    """Return how fast screws change that are carried with given motions."""
    spin, axis = twists[:, :3], screws[:, :3]
    return np.concatenate((cross(spin, axis), cross(spin, screws[:, 3:]) + cross(twists[:, 3:], axis)), axis=1)


def _times(tensors: Floats, vectors: Floats) -> Floats:
    """Return matrices of shape (links, 3, 3) times vectors of shape (links, 3, ...)."""
    return (tensors @ vectors.reshape(*vectors.shape[:2], -1)).reshape(vectors.shape)


def _like(array: Floats, other: Floats) -> Floats:
    """Return an array with as many axes as another has."""
    return array.reshape(*array.shape, *[1] * (other.ndim - array.ndim))
