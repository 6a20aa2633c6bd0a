"""Arms of a robot."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, Ints, inverse, pose_of, wxyz_from_rows, wxyz_jacobian
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, ErrorCode, RavemjError, UnsupportedError
from ravemj.geometry_functions.ik_parameterization import INVERSE_KINEMATICS, IkParameterizationType, goal_of_tool
from ravemj.model import chains, hashes, scene
from ravemj.model.manipulators import joint_dofs
from ravemj.rave.arm_collision import ArmCollision
from ravemj.rave.infos import ManipulatorInfo
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Tool(NamedTuple):
    """What is computed with at a manipulator.

    Attributes:
        arm: The description that it was made of.
        T_effector_tool: Pose of the tool in the effector, shape (4, 4).
        origin: Its last column.
        dofs: DOF indices of the joints, shape (n,).
    """

    arm: scene.Manipulator
    T_effector_tool: Floats
    origin: Floats
    dofs: Ints


class Manipulator(ArmCollision, ApiObject):
    """A chain of joints with a tool at its end; ``robot.GetManipulators()`` makes it."""

    def __init__(self, robot: "KinBody", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._index = index
        self._known: Tool | None = None

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
        effector = self._checked_effector()
        with self._state.simulation.lock:
            return self._state.link_transform(effector).dot(self._tool().T_effector_tool)

    GetEndEffectorTransform = GetTransform

    def _checked_effector(self) -> int:
        effector = self._scene.effector
        if effector is None:
            raise RavemjError(f"manipulator '{self.GetName()}' has no end effector")
        return effector

    def _tool(self) -> Tool:
        """Return the tool and the joints as arrays, which are made anew when the description is another one."""
        arm = self._scene
        if self._known is None or self._known.arm is not arm:
            T_effector_tool = arm.T_effector_tool.matrix()
            dofs = np.array(arm.arm_dofs, dtype=np.int_)
            self._known = Tool(arm, T_effector_tool, T_effector_tool[:, 3].copy(), dofs)
        return self._known

    def GetVelocity(self) -> Floats:
        """Return the velocity of the tool, in world axes.

        Returns:
            That of the tool point [m/s] and the angular one [rad/s], shape (6,).
        """
        effector = self._checked_effector()
        with self._state.simulation.lock:
            velocity = self._state.link_velocities()[effector]
            arm = self.GetTransform()[:3, 3] - self._state.link_transform(effector)[:3, 3]
        velocity[:3] += np.cross(velocity[3:], arm)
        return velocity

    def CalculateJacobian(self) -> Floats:
        """Return how the tool point moves with the arm's joints.

        Returns:
            Derivative of its position in the world by the values of ``GetArmIndices()``, shape (3, arm dof).
        """
        effector = self._checked_effector()
        with self._state.simulation.lock:
            state, tool = self._state, self._tool()
            point = state.link_transform(effector).dot(tool.origin)[:3]
            return state.dynamics.translation_jacobian(effector, point).take(tool.dofs, 1)

    def CalculateAngularVelocityJacobian(self) -> Floats:
        """Return the angular velocity of the tool, in world axes, per unit of the arm's, shape (3, arm dof)."""
        effector = self._checked_effector()
        with self._state.simulation.lock:
            return self._state.dynamics.rotation_jacobian(effector).take(self._tool().dofs, 1)

    def CalculateRotationJacobian(self) -> Floats:
        """Return how the tool's quaternion [w, x, y, z] changes with the arm's joints, shape (4, arm dof)."""
        with self._state.simulation.lock:
            wxyz = wxyz_from_rows(self.GetTransform()[:3, :3].tolist())
            return wxyz_jacobian(wxyz).dot(self.CalculateAngularVelocityJacobian())

    def GetTransformPose(self) -> Floats:
        """Return the pose of the tool in the world as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def GetLocalToolTransform(self) -> Floats:
        """Return the pose of the tool in the effector.

        Returns:
            ``T_effector_tool``, shape (4, 4).
        """
        return self._tool().T_effector_tool.copy()

    def GetLocalToolDirection(self) -> Floats:
        """Return the unit vector that the tool points along, in its own frame, shape (3,)."""
        return np.array(self._scene.direction)

    GetDirection = GetPalmDirection = GetLocalToolDirection

    def SetLocalToolTransform(self, transform: ArrayLike) -> None:
        """Set the pose of the tool in the effector.

        Args:
            transform: ``T_effector_tool``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz].
        """
        self._edit(T_effector_tool=pose_of(checked_transform(transform, "SetLocalToolTransform: transform")))

    def SetLocalToolDirection(self, direction: ArrayLike) -> None:
        """Set the direction that the tool points along, in its own frame, shape (3,); it is normalised."""
        given = checked_vector(direction, 3, "SetLocalToolDirection: direction")
        length = float(np.linalg.norm(given))
        if not length:
            raise ArgumentError("SetLocalToolDirection: direction is zero, and should point somewhere")
        self._edit(direction=tuple((given / length).tolist()))

    def _edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Manipulator
        with self._state.simulation.lock:
            arms = list(self._state.scene.manipulators)
            arms[self._index] = replace(arms[self._index], **changes)
            self._state.edit(manipulators=tuple(arms))

    def GetArmIndices(self) -> Ints:
        """Return the DOF indices of the joints between base and effector, the base first.

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

    def GetChildJoints(self) -> list[Joint]:
        """Return the joints beyond the arm, for instance those of fingers."""
        return self._robot.GetJoints(chains.joints_beyond(self._state.scene, self._scene))

    def GetChildDOFIndices(self) -> list[int]:
        """Return the DOFs of ``GetChildJoints()``."""
        joints = chains.joints_beyond(self._state.scene, self._scene)
        return [dof for joint in joints for dof in joint_dofs(self._state.scene, joint)]

    def GetChildLinks(self) -> list[Link]:
        """Return the effector, the links that are fixed to it, and those beyond."""
        return self._robot.GetLinks(chains.links_beyond(self._state.scene, self._scene))

    def IsChildLink(self, link: Link) -> bool:
        """Return whether a link is among ``GetChildLinks()``."""
        return link in self.GetChildLinks()

    def GetIndependentLinks(self) -> list[Link]:
        """Return the links that neither the arm nor the gripper moves."""
        return self._robot.GetLinks(chains.independent_links(self._state.scene, self._scene))

    def GetKinematicsStructureHash(self) -> str:
        """Return a text that is the same for arms of the same joints and tool: 32 hexadecimal digits."""
        return hashes.of_arm(self._state.scene, self._scene)

    def GetStructureHash(self) -> str:
        """Return a text that is the same for manipulators of the same kind in the same robot: 32 hexadecimal digits."""
        return hashes.of_manipulator(self._state.scene, self._scene)

    def GetInfo(self) -> ManipulatorInfo:
        """Return the description of the manipulator, a copy."""
        return ManipulatorInfo.of(self._state.scene, self._scene)

    UpdateAndGetInfo = GetInfo

    def GetArmConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return the specification of the arm's joint values.

        Args:
            interpolation: How they change between waypoints, for instance ``linear``.
        """
        return self._robot.GetConfigurationSpecificationIndices(self.GetArmIndices(), interpolation)

    def GetIkParameterization(
        self, iktype: IkParameterizationType | IkParameterization | int, inworld: bool = True
    ) -> IkParameterization:
        """Return where the tool is now, as a goal.

        Args:
            iktype: The type of goal, or a goal of that type.
            inworld: True: in the world. False: in the base link of the arm.
        """
        kind = IkParameterizationType(iktype.GetType() if isinstance(iktype, IkParameterization) else iktype)
        base = self.GetBase()
        T_world_tool = self.GetTransform()
        T_base_world = np.eye(4) if inworld or base is None else inverse(base.GetTransform())
        return IkParameterization(goal_of_tool(kind, T_base_world @ T_world_tool, self.GetLocalToolDirection()), kind)

    def GetIkSolver(self) -> None:
        """Return the solver of inverse kinematics: None, there is none."""

    def SetIkSolver(self, solver: object) -> bool:
        """Refuse a solver of inverse kinematics; return whether it was taken."""
        del solver
        return False

    def FindIKSolution(self, param: ArrayLike | IkParameterization, *arguments: Any, **options: Any) -> Floats | None:  # noqa: ANN401 - OpenRAVE's overloads
        """Return joint values that take the tool to a goal, in the order of ``GetArmIndices()``, shape (n,).

        Args:
            param: ``T_world_tool``, or an ``IkParameterization``.
            arguments: ``IkFilterOptions``, and what OpenRAVE's other overloads take.
            options: The same by name.

        Raises:
            UnsupportedError: always; there is no solver.
        """
        raise UnsupportedError("FindIKSolution", INVERSE_KINEMATICS, ErrorCode.Failed)

    def FindIKSolutions(self, param: ArrayLike | IkParameterization, *arguments: Any, **options: Any) -> Floats:  # noqa: ANN401 - OpenRAVE's overloads
        """Return joint values that take the tool to a goal, each way in a row, shape (k, n).

        Args:
            param: ``T_world_tool``, or an ``IkParameterization``.
            arguments: ``IkFilterOptions``, and what OpenRAVE's other overloads take.
            options: The same by name.

        Raises:
            UnsupportedError: always; there is no solver.
        """
        raise UnsupportedError("FindIKSolutions", INVERSE_KINEMATICS, ErrorCode.Failed)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Manipulator) and self._state is other._state and self._index == other._index

    def __hash__(self) -> int:
        return hash((id(self._state), "manipulator", self._index))

    def __repr__(self) -> str:
        return f"{self._robot!r}.GetManipulator({self.GetName()!r})"

    def __str__(self) -> str:
        return f"<manipulator:{self.GetName()}, parent={self._robot.GetName()}>"
