"""A controller of joint velocities."""

from typing import ClassVar

import numpy as np

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats
from ravemj.rave.controllers.base import Controller
from ravemj.rave.enums import CheckLimitsAction


class VelocityController(Controller):
    """A controller of joint velocities: OpenRAVE's ``IdealVelocityController`` and ``odevelocity``.

    It keeps the commanded velocities until the next command. With physics, motors at the joints drive them to the
    velocities, within the torque limits. Without physics, the joints move at the velocities and stop at their limits.
    ``IsDone()`` is always True. ``SendCommand("setvelocity 0.5 0")`` is ``SetDesired([0.5, 0])``.

    Example:
        >>> controller = RaveCreateController(env, "odevelocity")
        >>> robot.SetController(controller, range(robot.GetDOF()), 0)
        True
        >>> controller.SetDesired([0.5, 0])  # [rad/s]
        True
    """

    _velocities: Floats | None = None

    def Reset(self, options: int = 0) -> None:
        """Stop driving the joints. ``options`` are not used."""
        with self._env.simulation.lock:
            super().Reset(options)
            self._drive(None)

    def _desire(self, values: Floats, T_world_base: Floats | None) -> None:
        del T_world_base
        robot, dofs = self._robot, self._robot_dofs()
        limits = robot.GetDOFVelocityLimits()[dofs]
        self._drive(np.clip(values, -limits, limits))

    def _drive(self, velocities: Floats | None) -> None:
        self._velocities = velocities
        if self._attached_robot is not None:
            loads = self._env.GetPhysicsEngine().loads(self._attached_robot.simulation_state)
            if loads is not None:
                from ravemj.engine.physics import Motor  # noqa: PLC0415 - imported with the engine

                loads.motor = None if velocities is None else Motor(self._robot_dofs(), velocities)

    def SimulationStep(self, timestep: float) -> None:
        """Move the joints by ``timestep`` [s], unless physics moves them."""
        if self._velocities is None:
            return
        if self._env.GetPhysicsEngine().dynamics is not None:
            self._drive(self._velocities)
            return
        robot, dofs = self._robot, self._robot_dofs()
        values = robot.GetDOFValues()[dofs] + timestep * self._velocities
        robot.SetDOFValues(values, dofs, CheckLimitsAction.CheckLimitsSilent)
        all_velocities = robot.GetDOFVelocities()
        all_velocities[dofs] = self._velocities
        robot.SetDOFVelocities(all_velocities, checklimits=CheckLimitsAction.Nothing)

    def _set_velocity(self, arguments: str) -> str:
        self.SetDesired(checked_numbers(arguments.split(), "setvelocity"))
        return ""

    _commands: ClassVar = {"setvelocity": _set_velocity}
