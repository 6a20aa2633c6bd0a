"""The manipulators of a robot."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, Ints, pose_of, wxyz_from_rows, wxyz_jacobian
from ravemj.errors import ArgumentError
from ravemj.model import hashes
from ravemj.rave.arm_end import ArmEnd
from ravemj.rave.arm_ik import WITH_DIRECTION
from ravemj.rave.arm_redundancy import ArmRedundancy
from ravemj.rave.infos import ManipulatorInfo
from ravemj.rave.link import Link
from ravemj.rave.specification import ConfigurationSpecification

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot

_SAME = 1e-12
"""The tolerance within which two tool poses or directions are equal."""


class Manipulator(ArmEnd, ArmRedundancy):
    """A manipulator: a chain of joints with a tool at its end. ``robot.GetManipulators()`` returns them."""

    def SetName(self, name: str) -> None:
        """Give the manipulator another name.

        Args:
            name: The name.

        Raises:
            openrave_exception: the name is empty, or another manipulator of the robot has it.
        """
        checked_kind(name, str, "SetName: name", "a text")
        taken = {arm.name for arm in self._state.scene.manipulators} - {self.GetName()}
        if not name or name in taken:
            problem = f"the robot has another manipulator '{name}'" if name else "the name is empty"
            raise ArgumentError(f"SetName: {problem}; choose another name")
        self._edit(name=name)

    def GetId(self) -> str:
        """Return the id of the manipulator in OpenRAVE's JSON, which is always empty."""
        return ""

    def GetRobot(self) -> "Robot":
        """Return the robot that the manipulator belongs to."""
        return self._robot

    def GetBase(self) -> Link | None:
        """Return the link that the chain starts from."""
        return self._link(self._scene.base)

    def GetEndEffector(self) -> Link | None:
        """Return the link that carries the tool."""
        return self._link(self._scene.effector)

    def GetIkChainEndLink(self) -> Link | None:
        """Return the link at which the chain of IK solvers ends. It is None, which stands for the end effector."""
        return None

    def _link(self, index: int | None) -> Link | None:
        return None if index is None else Link(self._robot, self._state, index)

    def GetVelocity(self) -> Floats:
        """Return the velocity of the tool in the world.

        Returns:
            The velocity of the tool's origin [m/s], then its angular velocity [rad/s], in world axes, shape (6,).
        """
        effector = self._tool().effector
        with self._state.simulation.lock:
            velocity = self._state.link_velocities()[effector]
            arm = self.GetTransform()[:3, 3] - self._state.link_transform(effector)[:3, 3]
        velocity[:3] += np.cross(velocity[3:], arm)
        return velocity

    def CalculateJacobian(self) -> Floats:
        """Return the Jacobian of the tool's position.

        Returns:
            The derivative of the tool's position in the world by the joint values of ``GetArmIndices()``,
            [m/rad or m/m], shape (3, arm dof).
        """
        with self._state.simulation.lock:
            return self._tool().translation_jacobian(self._state)

    def CalculateAngularVelocityJacobian(self) -> Floats:
        """Return the Jacobian of the tool's angular velocity in world axes, shape (3, arm dof)."""
        with self._state.simulation.lock:
            return self._tool().rotation_jacobian(self._state)

    def CalculateRotationJacobian(self) -> Floats:
        """Return the Jacobian of the tool's quaternion [w, x, y, z], shape (4, arm dof)."""
        with self._state.simulation.lock:
            wxyz = wxyz_from_rows(self.GetTransform()[:3, :3].tolist())
            return wxyz_jacobian(wxyz).dot(self.CalculateAngularVelocityJacobian())

    def GetTransformPose(self) -> Floats:
        """Return the pose of the tool in the world as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def GetLocalToolTransform(self) -> Floats:
        """Return the pose of the tool in the frame of the end effector.

        Returns:
            ``T_effector_tool``, shape (4, 4).
        """
        return self._tool().T_effector_tool.copy()

    def GetLocalToolTransformPose(self) -> Floats:
        """Return ``GetLocalToolTransform`` as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return self._scene.T_effector_tool.numbers()

    def GetLocalToolDirection(self) -> Floats:
        """Return the direction in which the tool points, a unit vector in the tool frame, shape (3,)."""
        return np.array(self._scene.direction)

    GetDirection = GetPalmDirection = GetLocalToolDirection

    def SetLocalToolTransform(self, transform: ArrayLike) -> None:
        """Set the pose of the tool in the frame of the end effector. A changed pose removes the IK solver.

        Args:
            transform: ``T_effector_tool``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz].
        """
        matrix = checked_transform(transform, "SetLocalToolTransform: transform")
        if not np.allclose(matrix, self.GetLocalToolTransform(), rtol=0, atol=_SAME):
            self.SetIkSolver(None)
        self._edit(T_effector_tool=pose_of(matrix))

    def SetLocalToolDirection(self, direction: ArrayLike) -> None:
        """Set the direction in which the tool points. A changed direction removes an IK solver that depends on it.

        Args:
            direction: The direction in the tool frame, shape (3,); it is normalised.

        Raises:
            ArgumentError: the direction is zero.
        """
        given = checked_vector(direction, 3, "SetLocalToolDirection: direction")
        length = float(np.linalg.norm(given))
        if not length:
            raise ArgumentError("SetLocalToolDirection: direction is 0 0 0, and should have a length")
        solver, unit = self.GetIkSolver(), given / length
        turned = not np.allclose(unit, self._scene.direction, rtol=0, atol=_SAME)
        if turned and solver is not None and solver.kind in WITH_DIRECTION:
            self.SetIkSolver(None)
        self._edit(direction=tuple(unit.tolist()))

    def GetArmIndices(self) -> Ints:
        """Return the DOF indices of the joints from the base to the end effector, shape (n,).

        Example:
            >>> robot.SetActiveDOFs(robot.GetActiveManipulator().GetArmIndices())
        """
        return self._tool().dofs.copy()

    GetArmJoints = GetArmIndices

    def GetArmDOF(self) -> int:
        """Return the number of DOFs of the arm."""
        return len(self._scene.arm_dofs)

    def GetArmDOFValues(self) -> Floats:
        """Return the joint values of the arm [rad or m], in the order of ``GetArmIndices()``, shape (n,)."""
        return self._robot.GetDOFValues(self.GetArmIndices())

    def GetKinematicsStructureHash(self) -> str:
        """Return a hash of the arm's joints and tool, 32 hexadecimal digits."""
        return hashes.of_arm(self._state.scene, self._scene)

    def GetStructureHash(self) -> str:
        """Return a hash of the manipulator and its robot's structure, 32 hexadecimal digits."""
        return hashes.of_manipulator(self._state.scene, self._scene)

    def GetInfo(self) -> ManipulatorInfo:
        """Return the description of the manipulator."""
        return ManipulatorInfo.of(self._state.scene, self._scene)

    UpdateAndGetInfo = GetInfo

    def GetArmConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return the configuration specification of the arm's joint values.

        Args:
            interpolation: The interpolation between waypoints, for instance ``linear``.
        """
        return self._robot.GetConfigurationSpecificationIndices(self.GetArmIndices(), interpolation)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Manipulator) and self._state is other._state and self._index == other._index

    def __hash__(self) -> int:
        return hash((id(self._state), "manipulator"))  # without the place, which changes when others are removed

    def __repr__(self) -> str:
        if self not in self._robot.GetManipulators():
            return f"<manipulator that {self._robot!r} does not have any more>"
        return f"{self._robot!r}.GetManipulator({self.GetName()!r})"

    def __str__(self) -> str:
        return f"<manipulator:{self.GetName()}, parent={self._robot.GetName()}>"
