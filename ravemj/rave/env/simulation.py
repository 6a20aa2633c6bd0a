"""Simulation time, physics, and the state of bodies that is published meanwhile."""

import math
from typing import Any

from ravemj.core.arguments import checked_kind
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
    """Simulation time: each step runs physics, then controllers, then sensors.

    Time passes by itself from the first command to a controller, or the first question for the time, until
    ``StopSimulation``; before that no thread runs. While ``with env:`` holds the environment, it stands still.

    What is published are copies of poses and joint values, for those who do not take the lock:
    ``UpdatePublishedBodies`` makes them and, always, time that runs.
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
            timestep: Length of the steps [s].
            realtime: Whether a second of simulation takes a second; else as fast as it can be computed.
        """
        self._check_alive()
        self._clock.start(_checked_step(timestep, "StartSimulation", least=1e-6), realtime=realtime)

    def StopSimulation(self, shutdownthread: int = 1) -> None:
        """Stop simulation time until ``StartSimulation``; ``StepSimulation`` still works.

        Args:
            shutdownthread: Whether to wait for the end of a step that is under way.
        """
        self._clock.stop(wait=bool(shutdownthread))

    def StepSimulation(self, timestep: float) -> None:
        """Run one step of simulation time: physics, controllers, sensors.

        Args:
            timestep: How long [s].

        Example:
            >>> env.StopSimulation()
            >>> robot.GetController().SetPath(trajectory)
            >>> while not robot.GetController().IsDone():
            ...     env.StepSimulation(0.01)
        """
        self._check_alive()
        self._clock.step(_checked_step(timestep, "StepSimulation"))

    def IsSimulationRunning(self) -> bool:
        """Return whether simulation time runs in a thread."""
        self._clock.wake()
        return self._clock.is_allowed

    def GetSimulationTime(self) -> int:
        """Return the simulation time [microseconds] since it began to pass."""
        self._clock.wake()
        return self._clock.now

    def SetPhysicsEngine(self, physics: "PhysicsEngine | str | None") -> bool:
        """Choose the physics engine.

        Args:
            physics: What ``RaveCreatePhysicsEngine`` made; None: nothing falls. A name stands for a new engine with
                the gravity that the environment has now.

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
            raise RavemjError(f"there is no physics engine '{name}'; there are ode, mujoco and GenericPhysicsEngine")
        if name is not None:
            engine.SetGravity(self._engine.GetGravity())
        return engine

    def GetPhysicsEngine(self) -> PhysicsEngine:
        """Return the physics engine, which holds gravity and moves bodies; never None."""
        return self._engine

    def UpdatePublishedBodies(self, timeout: float = 0.0) -> None:
        """Publish the state of the bodies for ``GetPublishedBodies``.

        Viewers show every change at once. While a script has the environment, they show what is published, by this or
        by a step of simulation time.

        Args:
            timeout: Without meaning.
        """
        del timeout
        with self._simulation.lock:
            self._published = [_state(self.wrap(state)) for state in self._simulation.bodies]
            self._simulation.publish()

    def GetPublishedBodies(self, timeout: float = 0.0) -> list[State]:
        """Return the published state of all bodies.

        While time runs by itself (see ``StopSimulation``), it is the present one; else that of the last
        ``UpdatePublishedBodies``.

        Args:
            timeout: Without meaning.

        Returns:
            For each body a dict: ``body``, ``name``, ``uri``, ``environmentid``, ``updatestamp``, ``jointvalues``
            [rad or m], and ``linktransforms``, a list of ``T_world_link``; of a robot also ``activeManipulatorName``
            and ``activeManipulatorTransform``.
        """
        del timeout
        if self._clock.is_allowed:  # OpenRAVE's thread publishes at each of its steps
            self.UpdatePublishedBodies()
        return [dict(state) for state in self._published]

    def GetPublishedBody(self, name: str, timeout: float = 0.0) -> State | None:
        """Return the published state of one body, as in ``GetPublishedBodies``, or None.

        Args:
            name: Its name.
            timeout: Without meaning.
        """
        return next((state for state in self.GetPublishedBodies(timeout) if state["name"] == name), None)

    def GetPublishedBodyJointValues(self, name: str, timeout: float = 0.0) -> Any:  # noqa: ANN401 - an array or None
        """Return the published joint values of one body [rad or m], shape (dof,), or None.

        Args:
            name: Its name.
            timeout: Without meaning.
        """
        state = self.GetPublishedBody(name, timeout)
        return None if state is None else state["jointvalues"]

    def GetPublishedBodyTransformsMatchingPrefix(self, prefix: str, timeout: float = 0.0) -> dict[str, Any]:
        """Return the published ``T_world_body`` of the bodies whose names start with a text, by their names.

        Args:
            prefix: The text.
            timeout: Without meaning.
        """
        states = (state for state in self.GetPublishedBodies(timeout) if state["name"].startswith(prefix))
        return {state["name"]: state["linktransforms"][0] for state in states if state["linktransforms"]}

    @property
    def clock(self) -> Clock:
        """The clock of simulation time; below the OpenRAVE API."""
        return self._clock

    def _advance(self, timestep: float) -> None:
        """Run one step of simulation time; the clock holds the lock."""
        self._engine.SimulateStep(timestep)
        for body in map(self.wrap, self._simulation.bodies):
            if isinstance(body, Robot):
                body.step_controller(timestep)
        for module in tuple(self._modules):
            module.SimulationStep(timestep)
        stamp = self._clock.now + round(timestep * 1e6)
        for body in map(self.wrap, self._simulation.bodies):
            if isinstance(body, Robot):
                body.step_sensors(timestep, stamp)
        for sensor in tuple(self._sensors):
            sensor.advance(timestep, stamp)
        self._simulation.publish()


def _checked_step(timestep: float, name: str, least: float = 0.0) -> float:
    if not (math.isfinite(timestep) and timestep >= least):
        raise ArgumentError(f"{name}: timestep is {timestep}, and should be a time in seconds")
    return float(timestep)


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
