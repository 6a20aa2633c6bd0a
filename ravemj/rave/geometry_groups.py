"""The groups of geometries that a collision checker looks at."""

from collections.abc import Generator
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from weakref import WeakKeyDictionary

from ravemj.core.blocks import block
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.model import scene


class GeometryGroups:
    """Which group a checker takes in place of the geometries of links. A link without the group keeps its geometries.

    Attributes:
        default: The group of all bodies that have no other; empty for the geometries that links have.
        is_used: Whether any body has a group.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._of_bodies: WeakKeyDictionary[BodyState, str] = WeakKeyDictionary()
        self._last: tuple[tuple[object, ...], CollisionWorld] | None = None
        self.is_used = False
        self.default = ""

    def of(self, body: BodyState) -> str:
        """Return the group that is taken for a body."""
        return self._of_bodies.get(body, self.default)

    def choose(self, name: str, body: BodyState | None = None) -> None:
        """Take a group for a body, or for all bodies."""
        if body is not None:
            self._of_bodies[body] = name
        else:
            self.default = name
            self._of_bodies.clear()
        self.is_used = bool(self.default) or any(self._of_bodies.values())

    def world(self) -> AbstractContextManager[CollisionWorld]:
        """Let bodies have the geometries of their groups, and give what collision checking knows of them then.

        The caller holds the lock.
        """
        return self._exchanged() if self.is_used else nullcontext(self._simulation.collisions())

    @block
    def _exchanged(self) -> Generator[CollisionWorld]:
        scenes = {body: with_group(body.scene, self.of(body)) for body in self._simulation.bodies}
        # A world is made again only for other shapes: that takes long.
        key = (self._simulation.compiled(), *(link.geometries for body in scenes.values() for link in body.links))
        last = self._last[1] if self._last is not None and self._last[0] == key else None
        with self._simulation.described_as(scenes, last) as world:
            self._last = key, world
            yield world


def with_group(body: scene.KinBody, name: str) -> scene.KinBody:
    """Return a body whose links have the geometries of a group, where they have that group."""
    links = tuple(replace(link, geometries=dict(link.groups).get(name, link.geometries)) for link in body.links)
    return replace(body, links=links)


def has_group(body: scene.KinBody, name: str) -> bool:
    """Return whether a link of a body has a group; each has its own geometries."""
    return name in {"", scene.OWN_SHAPES} or any(name in dict(link.groups) for link in body.links)
