"""Arms of a robot."""

from typing import TYPE_CHECKING

import numpy as np

from ravemj import scene
from ravemj.errors import RavemjError
from ravemj.rave.link import Link
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.simulation import BodyState
from ravemj.transforms import Floats, Ints

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Manipulator:
    """A chain of joints with a tool at its end; ``robot.GetManipulators()`` makes it."""

    def __init__(self, robot: "KinBody", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._index = index

    @property
    def _scene(self) -> scene.Manipulator:
        return self._state.scene.manipulators[self._index]

    def GetName(self) -> str:
        """Return the manipulator's name."""
        return self._scene.name

    def GetRobot(self) -> "KinBody":
        """Return the robot that the manipulator belongs to."""
        return self._robot

    def GetBase(self) -> Link | None:
        """Return the link that the chain starts from."""
        return self._link(self._scene.base)

    def GetEndEffector(self) -> Link | None:
        """Return the link that carries the tool."""
        return self._link(self._scene.effector)

    def _link(self, index: int | None) -> Link | None:
        return None if index is None else Link(self._robot, self._state, index)

    def GetTransform(self) -> Floats:
        """Return the pose of the tool in the world.

        Returns:
            ``T_world_tool``, shape (4, 4): that of the effector times the local tool transform.

        Raises:
            openrave_exception: the manipulator has no effector.
        """
        effector = self.GetEndEffector()
        if effector is None:
            raise RavemjError(f"manipulator '{self.GetName()}' has no end effector")
        return effector.GetTransform() @ self.GetLocalToolTransform()

    def GetLocalToolTransform(self) -> Floats:
        """Return the pose of the tool in the effector.

        Returns:
            ``T_effector_tool``, shape (4, 4).
        """
        return self._scene.T_effector_tool.matrix()

    def GetLocalToolDirection(self) -> Floats:
        """Return the unit vector that the tool points along, in its own frame, shape (3,)."""
        return np.array(self._scene.direction)

    def GetArmIndices(self) -> Ints:
        """Return the DOF indices of the joints between base and effector, the base first."""
        return np.array(self._scene.arm_dofs, dtype=np.int_)

    def GetGripperIndices(self) -> Ints:
        """Return the DOF indices of the gripper's joints."""
        return np.array(self._scene.gripper_dofs, dtype=np.int_)

    def GetChuckingDirection(self) -> Floats:
        """Return for each DOF of the gripper the sign of closing: 1, 0 or -1."""
        return np.array(self._scene.chucking_direction)

    def GetArmConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return the specification of the arm's joint values.

        Args:
            interpolation: How they change between waypoints, for instance ``linear``.
        """
        return self._robot.GetConfigurationSpecificationIndices(self.GetArmIndices(), interpolation)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Manipulator) and self._state is other._state and self._index == other._index

    def __hash__(self) -> int:
        return hash((id(self._state), "manipulator", self._index))

    def __repr__(self) -> str:
        return f"{self._robot!r}.GetManipulator('{self.GetName()}')"

    def __str__(self) -> str:
        return f"<manipulator:{self.GetName()}, parent={self._robot.GetName()}>"
