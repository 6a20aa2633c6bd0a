"""Simulation time, physics, and the state of bodies that is published meanwhile."""

from typing import Any

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_number
from ravemj.engine.clock import Clock
from ravemj.engine.simulation import DEFAULT_GRAVITY
from ravemj.errors import ArgumentError, RavemjError
from ravemj.rave.env.contents import Contents
from ravemj.rave.kinbody import KinBody
from ravemj.rave.physics import PhysicsEngine, RaveCreatePhysicsEngine
from ravemj.rave.robot import Robot

State = dict[str, Any]
"""The published state of a body; see ``GetPublishedBodies``."""


class Simulating(Contents):
    """Simulation time. Each step runs physics, then controllers and modules, then sensors.

    Time starts to pass in a thread with the first command to a controller, or with the first call of
    ``GetSimulationTime`` or ``IsSimulationRunning``; before that, no thread runs. It passes until ``StopSimulation``,
    and stands still while a script locks the environment (``with env:``).

    Published bodies are copies of poses and joint values, for readers that do not take the lock.
    ``UpdatePublishedBodies`` makes them, and so does each step of running time.
    """

    _internal = ("clock",)

    def __init__(self) -> None:
        super().__init__()
        self._clock = self._simulation.clock = Clock(self._simulation.lock, self._advance)
        self._engine = PhysicsEngine(self._environment, "GenericPhysicsEngine", DEFAULT_GRAVITY)
        self._engine.attach()
        self._published: list[State] = []

    def StartSimulation(self, timestep: float, realtime: bool = True) -> None:
        """Run simulation time in a thread.

        Args:
            timestep: The duration of a step [s].
            realtime: Whether a second of simulation takes a second; False runs it as fast as possible.
        """
        self._check_alive()
        self._clock.start(checked_number(timestep, "StartSimulation: timestep", 1e-6, " s"), realtime=realtime)

    def StopSimulation(self, shutdownthread: int = 1) -> None:
        """Stop simulation time until ``StartSimulation``.

        ``StepSimulation`` still works. With ``shutdownthread``, wait for the end of a running step.
        """
        self._clock.stop(wait=bool(shutdownthread))

    def StepSimulation(self, timestep: float) -> None:
        """Run one step of simulation time: physics, controllers, sensors.

        Args:
            timestep: The duration of the step [s].

        Example:
            >>> env.StopSimulation()
            >>> robot.GetController().SetPath(trajectory)
            >>> while not robot.GetController().IsDone():
            ...     env.StepSimulation(0.01)
        """
        self._check_alive()
        self._clock.step(checked_number(timestep, "StepSimulation: timestep", 0, " s"))

    def IsSimulationRunning(self) -> bool:
        """Return whether simulation time runs in a thread."""
        self._clock.wake()
        return self._clock.is_allowed

    def GetSimulationTime(self) -> int:
        """Return the simulation time that has passed [microseconds]."""
        self._clock.wake()
        return self._clock.now

    def SetPhysicsEngine(self, physics: "PhysicsEngine | str | None") -> bool:
        """Choose the physics engine.

        Args:
            physics: An engine from ``RaveCreatePhysicsEngine``; None for no physics. A name makes a new engine with the
                environment's current gravity.

        Returns:
            True.

        Example:
            >>> env.SetPhysicsEngine("mujoco")
            True
        """
        self._check_alive()
        engine = self._new_engine(physics) if isinstance(physics, str | None) else physics
        checked_kind(engine, PhysicsEngine, "SetPhysicsEngine: physics")
        if engine.GetEnv() is not self._environment:
            raise ArgumentError("SetPhysicsEngine: physics was made for another environment")
        with self._simulation.lock:
            if engine is not self._engine:
                self._engine.detach()
                self._engine = engine
                engine.attach()
        return True

    def _new_engine(self, name: str | None) -> PhysicsEngine:
        engine = RaveCreatePhysicsEngine(self._environment, name or "GenericPhysicsEngine")
        if engine is None:
            known = "ode, bullet, mujoco and GenericPhysicsEngine"
            raise RavemjError(f"SetPhysicsEngine: there is no physics engine '{name}'; there are {known}")
        if name is not None:
            engine.SetGravity(self._engine.GetGravity())
        return engine

    def GetPhysicsEngine(self) -> PhysicsEngine:
        """Return the physics engine, which has gravity and advances bodies in time; never None."""
        return self._engine

    def UpdatePublishedBodies(self, timeout: float = 0.0) -> None:
        """Publish the state of the bodies for ``GetPublishedBodies``.

        Viewers show every change at once. While a script locks the environment, viewers show the state that this method
        or a step of simulation time published last.

        Args:
            timeout: Not used.
        """
        del timeout
        with self._simulation.lock:
            self._published = [_state(self.wrap(state)) for state in self._simulation.bodies]
            self._simulation.publish()

    def GetPublishedBodies(self, timeout: float = 0.0) -> list[State]:
        """Return the published state of all bodies.

        While simulation time runs in its thread, this is the current state; otherwise that of the last call of
        ``UpdatePublishedBodies``.

        Args:
            timeout: Not used.

        Returns:
            For each body a dict with ``body``, ``name``, ``uri``, ``environmentid``, ``updatestamp``, ``jointvalues``
            [rad or m], and ``linktransforms``, a list of ``T_world_link``; for a robot also with
            ``activeManipulatorName`` and ``activeManipulatorTransform``.
        """
        del timeout
        if self._clock.is_allowed:  # OpenRAVE's thread publishes at each of its steps
            self.UpdatePublishedBodies()
        return [dict(state) for state in self._published]

    def GetPublishedBody(self, name: str, timeout: float = 0.0) -> State | None:
        """Return the published state of one body, as in ``GetPublishedBodies``, or None.

        Args:
            name: The name of the body.
            timeout: Not used.
        """
        return next((state for state in self.GetPublishedBodies(timeout) if state["name"] == name), None)

    def GetPublishedBodyJointValues(self, name: str, timeout: float = 0.0) -> Any:  # noqa: ANN401 - an array or None
        """Return the published joint values of one body [rad or m], shape (dof,), or None.

        Args:
            name: The name of the body.
            timeout: Not used.
        """
        state = self.GetPublishedBody(name, timeout)
        return None if state is None else state["jointvalues"]

    def GetPublishedBodyTransformsMatchingPrefix(self, prefix: str, timeout: float = 0.0) -> dict[str, Any]:
        """Return the published ``T_world_body`` of all bodies whose names begin with a prefix, by name.

        Args:
            prefix: The beginning of the names.
            timeout: Not used.
        """
        states = (state for state in self.GetPublishedBodies(timeout) if state["name"].startswith(prefix))
        return {state["name"]: state["linktransforms"][0] for state in states if state["linktransforms"]}

    @property
    def clock(self) -> Clock:
        """The clock of simulation time, an object below OpenRAVE's API."""
        return self._clock

    def _advance(self, timestep: float) -> None:
        """Run one step of simulation time. The clock holds the lock.

        Sensors come last, so that they measure the state at the end of the step.
        """
        self._engine.SimulateStep(timestep)
        for body in map(self.wrap, self._simulation.bodies):
            if isinstance(body, Robot):
                body.step_controller(timestep)
        for module in tuple(self._modules):
            module.SimulationStep(timestep)
        stamp = self._clock.now + round(timestep * 1e6)
        for body in map(self.wrap, self._simulation.bodies):
            if isinstance(body, Robot):
                body.devices.step(timestep, stamp)
        for sensor in tuple(self._sensors):
            sensor.advance(timestep, stamp)
        self._simulation.publish()


def _state(body: KinBody) -> State:
    state: State = {
        "body": body,
        "name": body.GetName(),
        "uri": body.GetURI(),
        "environmentid": body.GetEnvironmentBodyIndex(),
        "updatestamp": body.GetUpdateStamp(),
        "jointvalues": body.GetDOFValues(),
        "linktransforms": body.GetLinkTransformations(),
    }
    arm = body.GetActiveManipulator() if isinstance(body, Robot) else None
    if arm is not None and arm.GetEndEffector() is not None:
        state |= {"activeManipulatorName": arm.GetName(), "activeManipulatorTransform": arm.GetTransform()}
    return state
