"""Simulation time and physics."""

import math

from ravemj.core.arguments import checked_kind
from ravemj.engine.clock import Clock
from ravemj.engine.simulation import DEFAULT_GRAVITY
from ravemj.errors import ArgumentError, RavemjError
from ravemj.rave.env.base import EnvironmentPart
from ravemj.rave.physics import PhysicsEngine, RaveCreatePhysicsEngine
from ravemj.rave.robot import Robot


class Simulating(EnvironmentPart):
    """Simulation time: each step runs physics, then controllers, then sensors.

    Time passes by itself from the first command to a controller, or the first question for the time, until
    ``StopSimulation``; before that no thread runs. While ``with env:`` holds the environment, it stands still.
    """

    _internal = ("clock",)

    def __init__(self) -> None:
        super().__init__()
        self._clock = Clock(self._simulation.lock, self._advance)
        self._engine = PhysicsEngine(self._environment, "GenericPhysicsEngine", DEFAULT_GRAVITY)
        self._engine.attach()

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


def _checked_step(timestep: float, name: str, least: float = 0.0) -> float:
    if not (math.isfinite(timestep) and timestep >= least):
        raise ArgumentError(f"{name}: timestep is {timestep}, and should be a time in seconds")
    return float(timestep)
