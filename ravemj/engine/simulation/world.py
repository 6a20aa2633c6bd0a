"""Bodies of an environment and their common MuJoCo model."""

import heapq
from collections.abc import Generator
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
"""OpenRAVE's gravity for files without a physics engine."""


class Simulation:
    """Bodies of an environment, and one MuJoCo model of all of them that is compiled on first use.

    Bodies store their joint values and poses themselves; collisions, pictures and MJCF use the model. Adding, removing
    and reshaping bodies requires recompilation; moving and enabling them does not.
    """

    def __init__(self) -> None:
        _simulations.add(self)
        self.lock = StateLock()  # held by every reader and writer of the model's state, such as threads of viewers
        self.drawings = Drawings()  # drawings of scripts; needs no lock
        self.published = Published()  # state shown by viewers while the lock is held; needs none
        self.view = View()  # background and camera of the loaded files
        self.diagnostics = Diagnostics()  # diagnostics of the last translation to MJCF
        self.version = 0  # incremented with each compiled model
        self.gravity = DEFAULT_GRAVITY  # gravitational acceleration in the world [m/s^2]
        self.changed: set[BodyState] = set()  # bodies moved or edited since the last update of the model
        self.collision_stamp = 0  # incremented if collision pairs change: links are enabled, bodies are grabbed
        self.clock: Clock | None = None  # simulation time; None without a clock
        self.physics: Physics | None = None  # dynamics; None if bodies stay in place
        self._places: list[BodyState | None] = []
        self._gaps: list[int] = []  # a heap of the free indices, including some that are no longer free
        self._by_name: dict[str, BodyState] = {}
        self._next_numbers: dict[str, int] = {}  # lower bound of the numbers that ``free_name`` tries
        self._world: WorldModel | None = None
        self._collisions: CollisionWorld | None = None

    @property
    def bodies(self) -> tuple[BodyState, ...]:
        """The bodies in the order of their indices: the order of addition, except that gaps are filled."""
        return tuple(body for body in self._places if body is not None)

    def body(self, name: str) -> BodyState | None:
        """Return the body called ``name``, or None."""
        return self._by_name.get(name)

    def body_at(self, index: int) -> BodyState | None:
        """Return the body with that index, which counts from 1, or None."""
        return self._places[index - 1] if 0 < index <= len(self._places) else None

    def create(self, scene: KinBody) -> BodyState:
        """Return a new body that is not in the world."""
        return BodyState(scene, self)

    def add(self, scene: KinBody) -> BodyState:
        """Create a body in its loaded configuration, and add it to the world; raises the errors of ``insert``."""
        body = self.create(scene)
        self.insert(body)
        return body

    def insert(self, body: BodyState, index: int | None = None) -> None:
        """Add a body at its present pose, with an unused index; by default the first.

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
        """Remove a body from the world; it keeps its pose. Return False if it was not there."""
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
        """Return a body and all bodies connected to it by grabs, in either direction."""
        bodies = [body]
        for attached_body in bodies:  # which is extended in the loop
            near = [grab.body for grab in attached_body.grabs]
            near += sorted(filter(self.holds, attached_body.holders), key=lambda holder: holder.index)
            bodies += [other for other in dict.fromkeys(near) if other not in bodies]
        return bodies

    def rename(self, body: BodyState, name: str) -> None:
        """Give a body another name.

        Raises:
            RavemjError: the name is empty, or the body is in the world and another one there has the name.
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
        """Check that a body can have a name: it is neither empty nor taken.

        Raises:
            RavemjError: it is taken or empty.
        """
        if not name:
            raise RavemjError("a body's name should not be empty", ErrorCode.Assert)
        if self._by_name.get(name, body) is not body:
            raise RavemjError(f"there already is a body '{name}' in the environment", ErrorCode.BodyNameConflict)

    def free_name(self, name: str) -> str:
        """Return a name that no body has: ``name`` if possible, else with a number appended."""
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

        Joints are clamped to their limits, as in OpenRAVE (test random-api-232). Without ``bodies``, this world becomes
        empty.

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
        """Set the gravitational acceleration [m/s^2]."""
        with self.lock:
            self.gravity = gravity
            if self._world is not None:
                self._world.model.opt.gravity[:] = gravity

    def forget_model(self) -> None:
        """Invalidate the model before the bodies or their shapes change."""
        self._world = None

    def compiled(self) -> "WorldModel":
        """Return the up-to-date model of the present bodies, recompiled if necessary.

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
        """Publish the present poses for viewers that wait for the lock, which the caller holds."""
        if self.published.is_wanted:
            world = self.compiled()
            self.published.put(world.model, world.data)

    def compile(self) -> "WorldModel":
        """Return the model of the present bodies, whose poses may be outdated; raises the errors of ``compiled``."""
        with self.lock:
            if self._world is None:
                self._world = self._compile()
                self.changed = set(self.bodies)
            return self._world

    def collisions(self) -> "CollisionWorld":
        """Return the up-to-date collision world of the present bodies. The caller holds ``lock``."""
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

    def _compile(self) -> "WorldModel":
        from ravemj.engine.simulation.world_model import WorldModel  # noqa: PLC0415 - slow to import

        self.diagnostics = Diagnostics()
        world = WorldModel(self.bodies, self.view, self.diagnostics)
        world.model.opt.gravity[:] = self.gravity
        self.version += 1
        # Links made by scripts are all called "base"; only readers of the MJCF need distinct names.
        send_warnings(finding for finding in self.diagnostics if finding.code != "renamed")
        return world


@block
def both_locks(simulation: Simulation, other: Simulation) -> Generator[None]:
    """Acquire the locks of two environments, always in the same order to prevent deadlocks."""
    first, second = sorted((simulation, other), key=id)
    with first.lock, second.lock:
        yield


@in_child
def _disown_all() -> None:
    for simulation in [*_simulations]:
        for body in simulation.bodies:
            disown(body)
        disown(simulation)
    _simulations.clear()
