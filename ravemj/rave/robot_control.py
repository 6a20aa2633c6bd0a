"""Controllers of a robot."""

import logging
import time
from threading import Condition, RLock
from types import EllipsisType
from typing import TYPE_CHECKING, cast

from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_indices
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.body.base import BodyPart
from ravemj.rave.controllers import Controller, IdealController
from ravemj.rave.interface import checked_kind

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot

_LOG = logging.getLogger("ravemj")

POLL = 1e-3
"""How often [s] ``WaitForController`` looks."""


class RobotControl(BodyPart):
    """What moves a robot in time."""

    _internal = ("step_controller",)

    _controller: "Controller | EllipsisType | None" = ...

    def GetController(self) -> Controller | None:
        """Return the robot's controller: an ``IdealController`` from the start; None after ``SetController(None)``.

        Example:
            >>> robot.GetController().SetDesired([0.5, -0.5])
            True
        """
        if self._controller is ...:
            self.SetController(IdealController(self._env, "IdealController"))
        assert self._controller is not ...
        return self._controller

    def SetController(
        self,
        controller: Controller | None,
        dofindices: "ArrayLike | str | EllipsisType" = ...,
        controltransform: int = 1,
    ) -> bool:
        """Give the robot a controller in place of the one before.

        Args:
            controller: What ``RaveCreateController`` made; None: none.
            dofindices: Which DOFs it moves; left out: all. A text is OpenRAVE's old form with arguments, for all.
            controltransform: Whether it moves the robot's base, too.

        Returns:
            True.

        Raises:
            openrave_exception: None was given together with DOFs.
            IndexError: there is no such DOF.
        """
        dofs = None if dofindices is ... or isinstance(dofindices, str) else dofindices
        if controller is None and dofs is not None:
            raise RavemjError("SetController: controller is None, and can have no DOFs")
        if controller and checked_kind(controller, Controller, "SetController: controller").GetEnv() is not self._env:
            raise ArgumentError("SetController: controller was made for another environment")
        indices = None if dofs is None else checked_indices(dofs, self.GetDOF())
        with self._simulation.lock:
            if isinstance(self._controller, Controller):
                self._controller.Reset()
            if controller is not None:
                controller.Init(cast("Robot", self), indices, controltransform)
            self._controller = controller
        return True

    def WaitForController(self, timeout: float = 0.0) -> bool:
        """Wait until the controller has done what it was told.

        Args:
            timeout: How long to wait [s] of real time; 0: as long as it takes.

        Returns:
            Whether it is done; False for a robot without a controller.

        Raises:
            openrave_exception: it would take forever: this thread holds the environment (``with env:``), so that
                time stands still. With a timeout, the answer is False at once then.

        Example:
            >>> robot.GetController().SetPath(trajectory)
            True
            >>> robot.WaitForController(0)
            True
        """
        controller = self.GetController()
        if controller is None:
            return False
        if controller.IsDone():
            return True
        if _is_held(self._simulation.lock):
            message = "WaitForController: time stands still inside 'with env:'; wait outside of it"
            if timeout <= 0:
                raise RavemjError(message, ErrorCode.InvalidState)
            _LOG.warning("%s", message)
            return False
        if not self._env.IsSimulationRunning():
            _LOG.warning("WaitForController: time was stopped by StopSimulation; waiting for others to step it")
        deadline = time.monotonic() + timeout
        while not controller.IsDone():
            if timeout > 0 and deadline < time.monotonic():
                return False
            time.sleep(POLL)
        return True

    def step_controller(self, timestep: float) -> None:
        """Let the controller act for a step of time [s]; it is not made only for that."""
        if isinstance(self._controller, Controller):
            self._controller.SimulationStep(timestep)


def _is_held(lock: RLock) -> bool:
    """Return whether this thread holds a lock: only its holder may notify others of something."""
    try:
        Condition(lock).notify(0)
    except RuntimeError:
        return False
    return True
