"""The gripper of an arm, and what it holds."""

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.simulation import BodyState
from ravemj.model import scene

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody
    from ravemj.rave.link import Link


class ArmGripper:
    """The joints of a gripper, the sign in which each closes, and the bodies that its links hold."""

    _robot: "KinBody"
    _state: BodyState

    @property
    @abstractmethod
    def _scene(self) -> scene.Manipulator:
        """The description as it stands."""

    @abstractmethod
    def _edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Manipulator
        """Change the description."""

    @abstractmethod
    def GetChildLinks(self) -> "list[Link]":
        """Return the effector, the links that are fixed to it, and those beyond."""

    def GetGripperIndices(self) -> Ints:
        """Return the DOF indices of the gripper's joints."""
        return np.array(self._scene.gripper_dofs, dtype=np.int_)

    GetGripperJoints = GetGripperIndices

    def GetGripperDOF(self) -> int:
        """Return the number of DOFs of the gripper."""
        return len(self._scene.gripper_dofs)

    def GetGripperDOFValues(self) -> Floats:
        """Return the joint values of the gripper [rad or m], in the order of ``GetGripperIndices()``, shape (n,)."""
        return self._robot.GetDOFValues(self.GetGripperIndices())

    def GetChuckingDirection(self) -> Ints:
        """Return for each DOF of the gripper the sign of closing: 1, 0 or -1."""
        return np.array(self._scene.chucking_direction, dtype=np.int_)

    GetClosingDirection = GetChuckingDirection

    def SetChuckingDirection(self, chuckingdirection: ArrayLike) -> None:
        """Set for each DOF of the gripper the sign of closing.

        Args:
            chuckingdirection: -1, 0 or 1 for each of the gripper's DOFs.
        """
        count = len(self._scene.gripper_dofs)
        signs = checked_vector(chuckingdirection, count, "SetChuckingDirection: chuckingdirection")
        self._edit(chucking_direction=tuple(signs.tolist()))

    SetClosingDirection = SetChuckingDirection

    def IsGrabbing(self, body: "KinBody") -> bool:
        """Return whether the effector, or a link beyond it, holds a body.

        Args:
            body: The body.
        """
        return self._robot.IsGrabbing(body) in self.GetChildLinks()

    def ReleaseAllGrabbed(self) -> None:
        """Let go of all bodies that the effector and the links beyond it hold."""
        with self._state.simulation.lock:
            for link in self.GetChildLinks():
                self._robot.ReleaseAllGrabbedWithLink(link)

    def GetGripperName(self) -> str:
        """Return the name of the ``GripperInfo`` that describes the gripper; empty where nobody says."""
        return self._scene.gripper_name

    def GetRestrictGraspSetNames(self) -> list[str]:
        """Return the sets of grasps that the arm is restricted to: none."""
        return []

    def GetToolChangerConnectedBodyToolName(self) -> str:
        """Return the tool of a connected body that a tool changer puts on here; empty: no tool changer is known."""
        return ""

    def GetToolChangerLinkName(self) -> str:
        """Return the link that a tool changer docks to; empty: no tool changer is known."""
        return ""
