"""The bodies of an environment and the MuJoCo model made of them."""

import heapq
from collections.abc import Generator, Mapping
from typing import TYPE_CHECKING
from weakref import WeakSet

from ravemj.core.blocks import block
from ravemj.core.forks import disown, in_child
from ravemj.core.locks import StateLock
from ravemj.core.transforms import Vec3
from ravemj.engine.simulation.body import BodyState
from ravemj.engine.simulation.published import Published
from ravemj.errors import Diagnostics, ErrorCode, RavemjError, send_warnings
from ravemj.model.drawing import Drawings
from ravemj.model.scene import KinBody, View

if TYPE_CHECKING:
    from ravemj.engine.clock import Clock
    from ravemj.engine.collision.world import CollisionWorld
    from ravemj.engine.physics import Physics
    from ravemj.engine.simulation.world_model import WorldModel

_simulations: "WeakSet[Simulation]" = WeakSet()

DEFAULT_GRAVITY: Vec3 = (0.0, 0.0, -9.797930195020351)
"""OpenRAVE's, where a file has no physics engine."""


class Simulation:
    """The bodies of an environment, and one MuJoCo model of all of them that is compiled when it is first asked for.

    Bodies know their joint values and poses by themselves; who asks for collisions, pictures or MJCF needs the model.
    Adding, removing and reshaping bodies puts it out of date. Moving and enabling them does not.
    """

    def __init__(self) -> None:
        _simulations.add(self)
        self.lock = StateLock()  # held by every reader and writer of the model's state, such as the threads of viewers
        self.drawings = Drawings()  # what scripts draw beside the bodies; needs no lock
        self.published = Published()  # what viewers show while the lock is held; needs none
        self.view = View()  # background and camera that the loaded files ask for
        self.diagnostics = Diagnostics()  # what the last translation to MJCF found
        self.version = 0  # grows by one with each compiled model
        self.gravity = DEFAULT_GRAVITY  # acceleration of free fall in the world [m/s^2]
        self.changed: set[BodyState] = set()  # moved or described anew since the model was last brought up to date
        self.collision_stamp = 0  # grows when what may collide with what changes: links are enabled, bodies are held
        self.clock: Clock | None = None  # simulation time; None where nobody lets it pass
        self.physics: Physics | None = None  # moves the bodies in that time; None: they stay where they are put
        self._places: list[BodyState | None] = []
        self._gaps: list[int] = []  # a heap of the free places among these, and of some that are no longer free
        self._by_name: dict[str, BodyState] = {}
        self._next_numbers: dict[str, int] = {}  # from which on ``free_name`` looks for a free one
        self._world: WorldModel | None = None
        self._collisions: CollisionWorld | None = None

    @property
    def bodies(self) -> tuple[BodyState, ...]:
        """The bodies in the order of their index: that in which they were added, except that gaps are filled."""
        return tuple(body for body in self._places if body is not None)

    def body(self, name: str) -> BodyState | None:
        """Return the body of that name, or None."""
        return self._by_name.get(name)

    def body_at(self, index: int) -> BodyState | None:
        """Return the body with that index, which counts from 1, or None."""
        return self._places[index - 1] if 0 < index <= len(self._places) else None

    def create(self, scene: KinBody) -> BodyState:
        """Return a new body that is not in the world."""
        return BodyState(scene, self)

    def add(self, scene: KinBody) -> BodyState:
        """Add a new body in its loaded configuration; errors as for ``insert``."""
        body = self.create(scene)
        self.insert(body)
        return body

    def insert(self, body: BodyState, index: int | None = None) -> None:
        """Take a body into the world, in the pose that it has, with a free index or by default the first free one.

        Raises:
            RavemjError: a body of that name is already there, or the name is empty.
        """
        with self.lock:
            self.check_name(body, body.scene.name)
            self.forget_model()
            body.index = index or self._free_index()
            for gap in range(len(self._places), body.index):
                heapq.heappush(self._gaps, gap)
                self._places.append(None)
            self._places[body.index - 1] = self._by_name[body.scene.name] = body
            if body.rest_poses is None:
                body.rest_poses = body.link_transforms()

    def _free_index(self) -> int:
        while self._gaps and (self._gaps[0] >= len(self._places) or self._places[self._gaps[0]] is not None):
            heapq.heappop(self._gaps)
        return (self._gaps[0] if self._gaps else len(self._places)) + 1

    def remove(self, body: BodyState) -> bool:
        """Take a body out of the world; it keeps its pose. Return False if it was not there."""
        with self.lock:
            if not self.holds(body):
                return False
            self.forget_model()
            self.changed.discard(body)
            body.grabs, body.rest_poses = [], None
            for holder in [*body.holders]:
                holder.release(body)
            self._places[body.index - 1] = None
            heapq.heappush(self._gaps, body.index - 1)
            while self._places and self._places[-1] is None:
                self._places.pop()
            self._forget_name(body)
            body.index = 0
            return True

    def _forget_name(self, body: BodyState) -> None:
        del self._by_name[body.scene.name]
        self._next_numbers.clear()

    def holds(self, body: BodyState) -> bool:
        """Return whether a body is in the world."""
        return body.simulation is self and body.index > 0

    def attached(self, body: BodyState) -> list[BodyState]:
        """Return a body and all that are connected to it by grabbing, in whichever direction."""
        found = [body]
        for one in found:  # which grows meanwhile
            near = [grab.body for grab in one.grabs]
            near += sorted(filter(self.holds, one.holders), key=lambda holder: holder.index)
            found += [other for other in dict.fromkeys(near) if other not in found]
        return found

    def rename(self, body: BodyState, name: str) -> None:
        """Give a body another name.

        Raises:
            RavemjError: the name is empty, or both bodies are in the world and another one has it.
        """
        with self.lock:
            if self.holds(body):
                self.check_name(body, name)
                self._forget_name(body)
                self._by_name[name] = body
            elif not name:
                raise RavemjError("a body's name should not be empty", ErrorCode.Assert)
            body.edit(name=name)

    def check_name(self, body: BodyState, name: str) -> None:
        """Check that a body can have a name.

        Raises:
            RavemjError: another body has it, or it is empty.
        """
        if not name:
            raise RavemjError("a body's name should not be empty", ErrorCode.Assert)
        if self._by_name.get(name, body) is not body:
            raise RavemjError(f"there already is a body '{name}' in the environment", ErrorCode.BodyNameConflict)

    def free_name(self, name: str) -> str:
        """Return the name, or one made of it by a number, that no body has."""
        number, free = self._next_numbers.get(name, 0), name or "_"
        while free in self._by_name:
            free = f"{name}{number}"
            number += 1
        self._next_numbers[name] = max(number - 1, 0)
        return free

    def clear(self) -> None:
        """Remove all bodies."""
        with self.lock:
            for body in self.bodies:
                self.remove(body)

    def copy(self, other: "Simulation", *, bodies: bool = True) -> dict[BodyState, BodyState]:
        """Replace bodies, view and gravity by copies of another world's. The caller holds both locks.

        Joints outside their limits go to them, as in OpenRAVE (random-api-232). Without ``bodies`` this world is empty.

        Returns:
            For each body of the other world its copy.
        """
        self.clear()
        self.view = other.view
        self.set_gravity(other.gravity)
        copies = {body: self.create(body.scene) for body in other.bodies if bodies}
        for body, copy in copies.items():
            copy.copy(body)
            self.insert(copy, body.index)
            copy.enter_limits()
        for body, copy in copies.items():
            copy.grabs = [grab._replace(body=copies[grab.body]) for grab in body.grabs if grab.body in copies]
        return copies

    def set_gravity(self, gravity: Vec3) -> None:
        """Set the acceleration of free fall [m/s^2]."""
        with self.lock:
            self.gravity = gravity
            if self._world is not None:
                self._world.model.opt.gravity[:] = gravity

    def forget_model(self) -> None:
        """Put the model out of date: the bodies or what they consist of are about to change."""
        self._world = None

    def compiled(self) -> "WorldModel":
        """Return the model of the present bodies as they are now; it is compiled if bodies came, went or changed.

        Raises:
            CompileError: MuJoCo refuses the model.
        """
        with self.lock:
            world = self.compile()
            if self.changed or not world.stamp:
                world.take(self.changed)
                self.changed.clear()
            return world

    def publish(self) -> None:
        """Let viewers that wait for the lock show where the bodies are; the caller holds it."""
        if self.published.is_wanted:
            world = self.compiled()
            self.published.put(world.model, world.data)

    def compile(self) -> "WorldModel":
        """Return the model of the present bodies, which may be elsewhere than they are; errors as for ``compiled``."""
        with self.lock:
            if self._world is None:
                self._world = self._compile()
                self.changed = set(self.bodies)
            return self._world

    def collisions(self) -> "CollisionWorld":
        """Return what collision checking knows of the present bodies as they are now. The caller holds ``lock``."""
        model, stamp, known = self._world, self.collision_stamp, self._collisions
        if model is None or not model.stamp:
            model = self.compiled()
        elif self.changed:  # as in ``compiled``, in fewer steps, since planners ask this most
            model.take(self.changed)
            self.changed.clear()
        if known is None or known.model is not model or known.stamp != stamp:
            from ravemj.engine.collision.world import CollisionWorld  # noqa: PLC0415 - slow to import

            self._collisions = known = CollisionWorld(self.bodies, model, stamp)
        return known

    @block
    def described_as(
        self, scenes: Mapping[BodyState, KinBody], known: "CollisionWorld | None"
    ) -> "Generator[CollisionWorld]":
        """Let bodies have other geometries for a while, and yield what collision checking knows of them then.

        The caller holds ``lock``.

        Args:
            scenes: The descriptions of bodies, which differ from theirs in geometries alone.
            known: What was yielded for these geometries before, which is used again; None: nothing.
        """
        kept = self._collisions, self.diagnostics, self.version
        world, changed, own = self._world, self.changed, {body: body.scene for body in scenes}
        self._world, self._collisions = None if known is None else known.model, known
        self.changed = set(self.bodies)
        for body, scene in scenes.items():
            body.scene = scene
        try:
            yield self.collisions()
        finally:
            for body, scene in own.items():
                body.scene = scene
            self._collisions, self.diagnostics, self.version = kept
            if self._world is not None:  # callbacks may have changed what the bodies consist of
                self._world = world
            self.changed = changed | self.changed

    def _compile(self) -> "WorldModel":
        from ravemj.engine.simulation.world_model import WorldModel  # noqa: PLC0415 - slow to import

        self.diagnostics = Diagnostics()
        world = WorldModel(self.bodies, self.view, self.diagnostics)
        world.model.opt.gravity[:] = self.gravity
        self.version += 1
        # Links that scripts make are all called "base"; only who reads the MJCF wants to know its names.
        send_warnings(finding for finding in self.diagnostics if finding.code != "renamed")
        return world


@block
def both_locks(one: Simulation, other: Simulation) -> Generator[None]:
    """Hold the locks of two environments. All callers take them in the same order, which prevents deadlocks."""
    first, second = sorted((one, other), key=id)
    with first.lock, second.lock:
        yield


@in_child
def _disown_all() -> None:
    for simulation in [*_simulations]:
        for body in simulation.bodies:
            disown(body)
        disown(simulation)
    _simulations.clear()
