"""The bodies of an environment and the MuJoCo model made of them."""

from threading import RLock

import mujoco

from ravemj.core.transforms import Vec3
from ravemj.engine.kinematics import BodyKinematics
from ravemj.engine.simulation.body import BodyState
from ravemj.engine.compiled import Compiled
from ravemj.errors import Diagnostics, ErrorCode, RavemjError, send_warnings
from ravemj.model.drawing import Drawings
from ravemj.model.scene import KinBody, Scene, View

DEFAULT_GRAVITY: Vec3 = (0.0, 0.0, -9.797930195020351)
"""OpenRAVE's, where a file has no physics engine."""


class Simulation:
    """The bodies of an environment, in one MuJoCo model that is compiled when it is first asked for.

    Adding bodies puts the model out of date; the next query of joints compiles it once, and the bodies keep their
    state. Moving and enabling bodies never compiles.

    Attributes:
        lock: Held by every reader and writer of the model's state; viewers draw in threads of their own.
        view: Background and camera that the loaded files ask for.
        diagnostics: What the last translation to MJCF found.
        version: Grows by one with each compiled model.
        gravity: Acceleration of free fall in the world [m/s^2].
        collision_stamp: Grows when what may collide with what changes: links are enabled, bodies are held.
        collision_world: What collision checking keeps between its queries; the layer above keeps it here.
        drawings: What scripts draw beside the bodies; needs no lock.
    """

    def __init__(self) -> None:
        self.lock = RLock()
        self.drawings = Drawings()
        self.view = View()
        self.diagnostics = Diagnostics()
        self.version = 0
        self.gravity = DEFAULT_GRAVITY
        self.collision_stamp = 0
        self.collision_world: object | None = None
        self._places: list[BodyState | None] = []
        self._by_name: dict[str, BodyState] = {}
        self._compiled: Compiled | None = None

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
        """Add a new body in its loaded configuration.

        Raises:
            RavemjError: a body of that name is already there.
        """
        body = self.create(scene)
        self.insert(body)
        return body

    def insert(self, body: BodyState, index: int | None = None) -> None:
        """Take a body into the world, in the pose that it has.

        Args:
            body: The body.
            index: Its index, which is free; None: the first free one.

        Raises:
            RavemjError: a body of that name is already there, or the name is empty.
        """
        with self.lock:
            self.check_name(body, body.scene.name)
            self.forget_model()
            body.index = index or [*self._places, None].index(None) + 1
            self._places += [None] * (body.index - len(self._places))
            self._places[body.index - 1] = self._by_name[body.scene.name] = body
            body.rest_poses = body.link_transforms()

    def remove(self, body: BodyState) -> bool:
        """Take a body out of the world; it keeps its pose. Return False if it was not there."""
        with self.lock:
            if not self.holds(body):
                return False
            self.forget_model()
            body.grabs = []
            for holder in self.bodies:
                holder.release(body)
            self._places[body.index - 1] = None
            while self._places and self._places[-1] is None:
                self._places.pop()
            del self._by_name[body.scene.name]
            body.index = 0
            return True

    def holds(self, body: BodyState) -> bool:
        """Return whether a body is in the world."""
        return body.simulation is self and body.index > 0

    def rename(self, body: BodyState, name: str) -> None:
        """Give a body another name.

        Raises:
            RavemjError: the name is empty, or both bodies are in the world and another one has it.
        """
        with self.lock:
            if self.holds(body):
                self.check_name(body, name)
                del self._by_name[body.scene.name]
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
        number, free = 0, name or "_"
        while free in self._by_name:
            free = f"{name}{number}"
            number += 1
        return free

    def clear(self) -> None:
        """Remove all bodies."""
        with self.lock:
            for body in self.bodies:
                self.remove(body)

    def set_gravity(self, gravity: Vec3) -> None:
        """Set the acceleration of free fall [m/s^2]."""
        with self.lock:
            self.gravity = gravity
            if self._compiled is not None:
                self._compiled.model.opt.gravity[:] = gravity

    def forget_model(self) -> None:
        """Put the model out of date: the bodies or what they consist of are about to change."""
        if self._compiled is not None:
            self._compiled = None
            for body in self.bodies:
                body.leave_model()

    def compile(self) -> Compiled:
        """Return the model of the present bodies, compiled if it is out of date.

        Raises:
            CompileError: MuJoCo refuses the model.
        """
        known = self._compiled
        if known is not None:
            return known
        with self.lock:
            if self._compiled is not None:  # another thread was faster
                return self._compiled
            self.diagnostics = Diagnostics()
            scene = Scene(tuple(body.scene for body in self.bodies), self.view)
            compiled = Compiled(scene, self.diagnostics)
            compiled.write_true_inertias(scene)
            compiled.model.opt.gravity[:] = self.gravity
            for body, names in zip(self.bodies, compiled.mjcf.names, strict=True):
                body.enter_model(BodyKinematics(compiled.model, compiled.data, body.scene, names))
            mujoco.mj_kinematics(compiled.model, compiled.data)
            for body in self.bodies:
                body.settle()
            self._compiled = compiled
            self.version += 1
            # Links that scripts make are all called "base"; only who reads the MJCF wants to know its names.
            send_warnings(finding for finding in self.diagnostics if finding.code != "renamed")
            return compiled
