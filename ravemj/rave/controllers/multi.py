"""A controller that distributes DOFs among other controllers."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_indices
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError
from ravemj.rave.controllers.base import Controller
from ravemj.rave.trajectory import Trajectory


class _Part(NamedTuple):
    """One of the other controllers, and the indices of its values among those of the ``MultiController``."""

    controller: Controller
    places: Ints


class MultiController(Controller):
    """A controller that distributes the DOFs of a robot among several controllers.

    ``RaveCreateMultiController`` makes it.

    Example:
        >>> multi = RaveCreateMultiController(env)
        >>> robot.SetController(multi)
        True
        >>> multi.AttachController(RaveCreateController(env, "IdealController"), arm.GetArmIndices(), 0)
        True
    """

    _parts: tuple[_Part, ...] = ()

    def AttachController(self, controller: Controller, dofindices: ArrayLike, controltransform: int) -> bool:
        """Assign DOFs to a controller.

        Args:
            controller: The controller; it is initialised here.
            dofindices: The DOF indices that it moves.
            controltransform: Whether it also moves the robot's base.

        Returns:
            True.

        Raises:
            ArgumentError: this controller does not move such a DOF, another controller has it, or another controller
                moves the base.
        """
        robot = self._robot
        dofs = checked_indices(dofindices, robot.GetDOF())
        own = self._robot_dofs().tolist()
        taken = {int(dof) for part in self._parts for dof in part.controller.GetControlDOFIndices()}
        for dof in dofs.tolist():
            if dof not in own or dof in taken:
                reason = "has a controller already" if dof in taken else "is not among those of the MultiController"
                raise ArgumentError(f"AttachController: dofindices: DOF {dof} {reason}")
        if controltransform and any(part.controller.IsControlTransformation() for part in self._parts):
            raise ArgumentError("AttachController: controltransform: the base has a controller already")
        with robot.simulation_state.simulation.lock:
            controller.Init(robot, dofs, controltransform)
            self._parts = (*self._parts, _Part(controller, np.array([own.index(dof) for dof in dofs], dtype=int)))
        return True

    def RemoveController(self, controller: Controller) -> None:
        """Remove ``controller``. Its DOFs then have none."""
        self._parts = tuple(part for part in self._parts if part.controller is not controller)

    def GetController(self, dof: int) -> Controller | None:
        """Return the controller of the DOF with the index ``dof``, or None."""
        owners = (part.controller for part in self._parts if dof in part.controller.GetControlDOFIndices())
        return next(owners, None)

    def Reset(self, options: int = 0) -> None:
        """Reset all controllers, each with ``options``."""
        for part in self._parts:
            part.controller.Reset(options)

    def SetPath(self, traj: Trajectory | None) -> bool:
        """Have each controller play its part of ``traj``, and return True; see ``IdealController.SetPath``."""
        return all([part.controller.SetPath(traj) for part in self._parts])

    def _desire(self, values: Floats, T_world_base: Floats | None) -> None:
        for part in self._parts:
            part.controller.SetDesired(values[part.places], T_world_base)

    def SimulationStep(self, timestep: float) -> None:
        """Advance all controllers by ``timestep`` [s]."""
        for part in self._parts:
            part.controller.SimulationStep(timestep)

    def IsDone(self) -> bool:
        """Return whether all controllers have finished their last command."""
        return all(part.controller.IsDone() for part in self._parts)

    def GetTime(self) -> float:
        """Return the time along the current path [s]."""
        return max((part.controller.GetTime() for part in self._parts), default=0.0)

    def GetTorque(self) -> Floats:
        """Return the torques that the controllers apply [N m or N], shape (n,)."""
        torques = np.zeros(len(self._robot_dofs()))
        for part in self._parts:
            torques[part.places] = part.controller.GetTorque()
        return torques
