"""Manipulators of a robot."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from types import EllipsisType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, Ints, inverse, pose_of, wxyz_from_rows, wxyz_jacobian
from ravemj.engine.collision import arms
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.model import chains, hashes, scene
from ravemj.model.manipulators import joint_dofs
from ravemj.rave.infos import ManipulatorInfo
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link
from ravemj.rave.manipulator.arm_ik import WITH_DIRECTION, ArmIk
from ravemj.rave.report import CollisionReport
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody
    from ravemj.rave.robot import Robot


Target = ArrayLike | IkParameterization | CollisionReport | None
"""Tool goal of a collision check; if it is omitted, the report may take its place."""


def _sorted_out(transform: Target, report: CollisionReport | None) -> tuple[Floats | None, CollisionReport | None]:
    """Return tool pose (None if not given) and report; a report may also be given as the first argument."""
    if isinstance(transform, IkParameterization):
        return transform.GetTransform6D(), report
    if transform is None or isinstance(transform, CollisionReport):
        return None, transform or report
    return checked_transform(np.asarray(transform), "transform"), report


_SAME = 1e-12
"""The tolerance within which two tool poses or directions are equal."""


class Manipulator(ArmIk):
    """Chain of joints with a tool at its end; ``robot.GetManipulators()`` returns the manipulators."""

    def SetName(self, name: str) -> None:
        """Rename the manipulator.

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
        """Return the last link of the IK chain: None, which means the end effector."""
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
            The derivative of the tool's position in the world with respect to the joint values of ``GetArmIndices()``,
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

    def GetChildJoints(self) -> list[Joint]:
        """Return the joints beyond the arm, for instance those of fingers."""
        return self._robot.GetJoints(chains.joints_beyond(self._state.scene, self._scene))

    def GetChildDOFIndices(self) -> list[int]:
        """Return the DOFs of ``GetChildJoints()``."""
        joints = chains.joints_beyond(self._state.scene, self._scene)
        return [dof for joint in joints for dof in joint_dofs(self._state.scene, joint)]

    def GetChildLinks(self) -> list[Link]:
        """Return the end effector, the links fixed to it, and the links beyond."""
        return self._robot.GetLinks(chains.links_beyond(self._state.scene, self._scene))

    def IsChildLink(self, link: Link) -> bool:
        """Return whether a link is among ``GetChildLinks()``."""
        return link in self.GetChildLinks()

    def GetIndependentLinks(self) -> list[Link]:
        """Return the links that are moved neither by the arm nor by the gripper."""
        return self._robot.GetLinks(chains.independent_links(self._state.scene, self._scene))

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
        """Return the sign of closing for each gripper DOF: 1, 0 or -1."""
        return np.array(self._scene.chucking_direction, dtype=np.int_)

    GetClosingDirection = GetChuckingDirection

    def SetChuckingDirection(self, chuckingdirection: ArrayLike) -> None:
        """Set ``chuckingdirection``, the sign of closing for each gripper DOF: -1, 0 or 1."""
        count = len(self._scene.gripper_dofs)
        signs = checked_vector(chuckingdirection, count, "SetChuckingDirection: chuckingdirection")
        self._edit(chucking_direction=tuple(signs.tolist()))

    SetClosingDirection = SetChuckingDirection

    def IsGrabbing(self, body: "KinBody") -> bool:
        """Return whether the end effector, or a link beyond it, has grabbed ``body``."""
        return self._robot.IsGrabbing(body) in self.GetChildLinks()

    def ReleaseAllGrabbed(self) -> None:
        """Release all bodies grabbed by the end effector and the links beyond it."""
        with self._state.simulation.lock:
            for link in self.GetChildLinks():
                self._robot.ReleaseAllGrabbedWithLink(link)

    def GetGripperName(self) -> str:
        """Return the name of the ``GripperInfo`` that describes the gripper; empty if there is none."""
        return self._scene.gripper_name

    def GetRestrictGraspSetNames(self) -> list[str]:
        """Return the names of the grasp sets that the arm is restricted to: none."""
        return []

    def GetToolChangerConnectedBodyToolName(self) -> str:
        """Return the tool of the connected body at a tool changer: empty, since tool changers are not supported."""
        return ""

    def GetToolChangerLinkName(self) -> str:
        """Return the link of a tool changer: empty, since tool changers are not supported."""
        return ""

    def CheckEndEffectorCollision(
        self,
        transform: "Target | EllipsisType" = ...,
        report: CollisionReport | None = None,
        numredundantsamples: int = 0,
    ) -> bool:
        """Return whether the links beyond the arm and their grabbed bodies collide with other bodies.

        Args:
            transform: ``T_world_tool`` to test: 4x4, 3x4, 7 numbers, or an ``IkParameterization``; the arm does not
                move. None means the present pose. It may be omitted before ``report``.
            report: Receives the collisions.
            numredundantsamples: Not used.

        Example:
            >>> T = manip.GetTransform()
            >>> T[2, 3] += 0.1
            >>> manip.CheckEndEffectorCollision(T)  # ten centimetres higher
            False
        """
        del numredundantsamples
        if transform is ... and report is None:
            raise TypeError("CheckEndEffectorCollision: takes a pose, a report or both")  # random-api-21
        target, report = _sorted_out(None if transform is ... else transform, report)
        return self._answer(arms.end_and_others, report, target)

    def CheckEndEffectorSelfCollision(
        self,
        transform: Target = None,
        report: CollisionReport | None = None,
        numredundantsamples: int = 0,
        ignoreManipulatorLinks: bool = False,
    ) -> bool:
        """Return whether the links beyond the arm and their grabbed bodies collide with the rest of the robot.

        Args:
            transform: ``T_world_tool`` to test, as in ``CheckEndEffectorCollision``.
            report: Receives the collisions.
            numredundantsamples: Not used.
            ignoreManipulatorLinks: Whether to ignore the links of the arm itself, which move to reach the pose.
        """
        del numredundantsamples
        target, report = _sorted_out(transform, report)
        find = partial(arms.end_and_rest, without_arm=ignoreManipulatorLinks)
        return self._answer(find, report, target)

    def CheckIndependentCollision(self, report: CollisionReport | None = None) -> bool:
        """Return whether the links of ``GetIndependentLinks()`` and their grabbed bodies collide with other bodies.

        Args:
            report: Receives the collisions.
        """
        return self._answer(arms.independent_and_others, report, None)

    def _answer(
        self,
        find: Callable[[CollisionWorld, BodyState, scene.Manipulator], Pairs],
        report: CollisionReport | None,
        T_world_tool: Floats | None,
    ) -> bool:
        """Test the geom pairs that ``find`` selects, with the tool at ``T_world_tool``; None is its present pose."""
        checker = self._robot.GetEnv().GetCollisionChecker()
        with self._state.simulation.lock:
            world = checker.world()
            with self._moved(world, T_world_tool):
                return checker.answer(world, find(world, self._state, self._scene), report)

    def _moved(self, world: CollisionWorld, T_world_tool: Floats | None) -> AbstractContextManager[None]:
        """Context manager that moves the end effector's links, and bodies grabbed by them, to a tool goal."""
        if T_world_tool is None:
            return nullcontext()
        return world.moved(arms.motions_of_end(self._state, self._scene, T_world_tool @ inverse(self.GetTransform())))
