"""Geometry groups that a collision checker uses instead of the links' own geometries."""

from collections.abc import Mapping
from dataclasses import replace
from weakref import WeakKeyDictionary

from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.engine.simulation.world_model import WorldModel
from ravemj.errors import Diagnostics, send_warnings
from ravemj.model.scene import OWN_SHAPES, KinBody


class GeometryGroups:
    """Selected geometry groups of bodies. A link without the group keeps its own geometries.

    Attributes:
        default: The group of bodies without a selected one; empty for the links' own geometries.
        is_used: Whether any body has a selected group.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._of_bodies: WeakKeyDictionary[BodyState, str] = WeakKeyDictionary()
        self._model_key: tuple[object, ...] = ()
        self._world: CollisionWorld | None = None
        self.is_used = False
        self.default = ""

    def group_of(self, body: BodyState) -> str:
        """Return the group of a body."""
        return self._of_bodies.get(body, self.default)

    def choose(self, name: str, body: BodyState | None = None) -> None:
        """Select the group of a body, or of all bodies."""
        if body is not None:
            self._of_bodies[body] = name
        else:
            self.default = name
            self._of_bodies.clear()
        self.is_used = bool(self.default) or any(self._of_bodies.values())
        if not self.is_used:
            self._model_key, self._world = (), None

    def world(self) -> CollisionWorld:
        """Return the collision world with the selected geometries at the present poses.

        The caller holds the lock.
        """
        simulation = self._simulation
        if not self.is_used:
            return simulation.collisions()
        described = {body: _with_group(body.scene, self.group_of(body)) for body in simulation.bodies}
        key = (simulation.compiled(), *(link.geometries for body in described.values() for link in body.links))
        world = self._world
        if world is None or key != self._model_key:  # compilation is slow, and only necessary for changed shapes
            world = CollisionWorld(simulation.bodies, self._compiled(described), simulation.collision_stamp)
        elif world.stamp != simulation.collision_stamp:
            world = CollisionWorld(simulation.bodies, world.model, simulation.collision_stamp)
        self._model_key, self._world = key, world
        world.model.take(simulation.bodies)
        return world

    def _compiled(self, described: Mapping[BodyState, KinBody]) -> WorldModel:
        findings = Diagnostics()
        model = WorldModel(self._simulation.bodies, self._simulation.view, findings, described)
        send_warnings(finding for finding in findings if finding.code != "renamed")
        return model


def has_group(body: KinBody, name: str) -> bool:
    """Return whether a link of a body has a group of its own."""
    return name in {"", OWN_SHAPES} or any(name in dict(link.groups) for link in body.links)


def _with_group(body: KinBody, name: str) -> KinBody:
    """Return a body in which links that have the geometry group ``name`` use its geometries."""
    links = tuple(replace(link, geometries=dict(link.groups).get(name, link.geometries)) for link in body.links)
    return replace(body, links=links)
