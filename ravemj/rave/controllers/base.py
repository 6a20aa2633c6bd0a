"""The base class of controllers."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_indices, checked_transform, checked_vector
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ErrorCode, RavemjError
from ravemj.rave.enums import InterfaceType
from ravemj.rave.interface import Interface
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.robot import Robot


class Controller(Interface):
    """A controller: it moves a robot over time. ``robot.GetController()`` returns the controller of a robot."""

    _interface_type = InterfaceType.controller

    def __init__(self, env: "Environment", xmlid: str) -> None:
        super().__init__(env, xmlid)
        self._attached_robot: Robot | None = None
        self._dofs: Ints | None = None
        self._moves_base = False
        self._is_done = True
        self._time = 0.0

    def Init(self, robot: "Robot", dofindices: ArrayLike | None = None, controltransform: int = 1) -> bool:
        """Set the robot and the DOFs that the controller moves; ``robot.SetController`` calls this.

        Args:
            robot: The robot.
            dofindices: The DOF indices, in the order of the values that the controller takes; None for all.
            controltransform: Whether the controller also moves the robot's base.

        Returns:
            True.
        """
        indices = None if dofindices is None else checked_indices(dofindices, robot.GetDOF())
        with robot.simulation_state.simulation.lock:
            self._attached_robot, self._dofs, self._moves_base = robot, indices, bool(controltransform)
            self.Reset()
        return True

    @property
    def _robot(self) -> "Robot":
        if self._attached_robot is None:
            message = f"the {type(self).__name__} has no robot yet; call robot.SetController(controller) first"
            raise RavemjError(message, ErrorCode.NotInitialized)
        return self._attached_robot

    def GetRobot(self) -> "Robot | None":
        """Return the robot that the controller moves, or None."""
        return self._attached_robot

    def GetControlDOFIndices(self) -> Ints:
        """Return the DOF indices that the controller moves, in the order of the values that it takes."""
        if self._dofs is not None:
            return self._dofs.copy()
        return np.arange(0 if self._attached_robot is None else self._attached_robot.GetDOF())

    def IsControlTransformation(self) -> int:
        """Return 1 if the controller also moves the robot's base, else 0."""
        return int(self._moves_base)

    def IsDone(self) -> bool:
        """Return whether the controller has finished its last command.

        Example:
            >>> while not robot.GetController().IsDone():
            ...     time.sleep(0.01)
        """
        return self._is_done

    def GetTime(self) -> float:
        """Return the time along the current path [s]."""
        return self._time

    def Reset(self, options: int = 0) -> None:
        """Cancel the current command; the robot stays in place. ``options`` are not used."""
        del options
        self._is_done = True

    def SetDesired(self, values: ArrayLike, transform: ArrayLike | None = None) -> bool:
        """Command a configuration of the robot.

        Args:
            values: One value for each of ``GetControlDOFIndices()`` [rad or m]; for velocity controllers a velocity
                [rad/s or m/s].
            transform: ``T_world_link0``, the pose of the robot's base, if the controller moves it; None leaves the base
                in place.

        Returns:
            True.

        Raises:
            ArgumentError: the number of values is wrong. The robot does not move.
        """
        checked = checked_vector(values, len(self._robot_dofs()), "SetDesired: values")
        T_world_base = None if transform is None else checked_transform(transform, "SetDesired: transform")
        with self._robot.simulation_state.simulation.lock:
            self._desire(checked, T_world_base if self._moves_base else None)
        self._env.clock.wake()
        return True

    def _desire(self, values: Floats, T_world_base: Floats | None) -> None:
        raise self._cannot("take single values")

    def SetPath(self, traj: Trajectory | None) -> bool:
        """Play a copy of the trajectory ``traj`` in simulation time from its first waypoint on, and return True."""
        del traj
        raise self._cannot("play paths")

    def SimulationStep(self, timestep: float) -> None:
        """Advance the controller by ``timestep`` [s]; each step of simulation time calls this."""

    def GetVelocity(self) -> Floats:
        """Return the current velocities of the DOFs that the controller moves [rad/s or m/s], shape (n,)."""
        return self._robot.GetDOFVelocities()[self._robot_dofs()]

    def GetTorque(self) -> Floats:
        """Return the torques that the controller applies [N m or N], shape (n,): zeros, since it sets joint values."""
        return np.zeros(len(self._robot_dofs()))

    def _robot_dofs(self) -> Ints:
        """Return the DOF indices that the controller moves; an error where it has no robot."""
        assert self._robot is not None
        return self.GetControlDOFIndices()

    def _cannot(self, what: str) -> RavemjError:
        return RavemjError(f"{type(self).__name__} cannot {what}", ErrorCode.NotImplemented)

    def __repr__(self) -> str:
        robot = self._attached_robot
        if robot is not None and robot.GetController() is self:
            return f"{robot!r}.GetController()"
        return f"RaveCreateController({self._env!r}, {self._xmlid!r})"
