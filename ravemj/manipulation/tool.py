"""Tool of an arm: pose and Jacobian, error against a goal pose, and task-space constraints."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, Ints, inverse
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, RavemjError
from ravemj.manipulation.bodies import Bodies
from ravemj.model.scene import Manipulator
from ravemj.planning.constrained_edges import Manifold
from ravemj.planning.projection import Error

# Importing ``ik`` takes as long as importing the rest, and most scripts do without it.
# ruff: noqa: PLC0415


class Tool(NamedTuple):
    """Tool of a manipulator with an end effector.

    Attributes:
        arm: The manipulator.
        T_effector_tool: The pose of the tool in the effector, shape (4, 4).
        origin: The last column of ``T_effector_tool``.
        dofs: The DOF indices of the joints, shape (n,).
    """

    arm: Manipulator
    T_effector_tool: Floats
    origin: Floats
    dofs: Ints

    @classmethod
    def for_arm(cls, arm: Manipulator) -> "Tool":
        """Return the tool of a manipulator."""
        T_effector_tool = arm.T_effector_tool.matrix()
        return cls(arm, T_effector_tool, T_effector_tool[:, 3].copy(), np.array(arm.arm_dofs, dtype=np.int_))

    def pose(self, body: BodyState) -> Floats:
        """Return ``T_world_tool``, shape (4, 4)."""
        return body.link_transform(self.effector).dot(self.T_effector_tool)

    def translation_jacobian(self, body: BodyState) -> Floats:
        """Return the derivative of the tool's position in the world with respect to the joint values, shape (3, n)."""
        effector = self.effector
        point = body.link_transform(effector).dot(self.origin)[:3]
        return body.dynamics.translation_jacobian(effector, point).take(self.dofs, 1)

    def rotation_jacobian(self, body: BodyState) -> Floats:
        """Return the Jacobian of the tool's angular velocity in world axes, shape (3, n)."""
        return body.dynamics.rotation_jacobian(self.effector).take(self.dofs, 1)

    @property
    def effector(self) -> int:
        """The index of the link that carries the tool."""
        if self.arm.effector is None:
            raise RavemjError(f"manipulator '{self.arm.name}' has no end effector")
        return self.arm.effector


class ToolConstraint(NamedTuple):
    """Task-space constraint of the tool.

    The constraint keeps ``T_task_world @ T_world_tool @ T_tool_point`` free of rotation about some axes and of
    translation along some axes.

    Attributes:
        T_task_world: The task frame, whose axes ``freedoms`` refers to.
        T_tool_point: The constrained frame, relative to the tool; None for the frame that coincides with the task frame
            at the start.
        freedoms: 1 constrains, 0 leaves free: the rotations about x, y, z, then the translations along them, shape
            (6,).
        threshold: The tolerance of the constraint [m and rad].
    """

    T_task_world: Floats
    T_tool_point: Floats | None
    freedoms: Floats
    threshold: float

    def checked(self, T_world_tool: Floats) -> tuple[Floats, Floats, Floats, float]:
        """Return task frame, ``T_tool_point``, freedoms and threshold, checked, with rotations orthonormal to rounding.

        If ``T_tool_point`` is None, it follows from the tool pose.

        Raises:
            ArgumentError: the numbers are invalid.
        """
        freedoms = checked_vector(self.freedoms, 6, "constraintfreedoms")
        if (freedoms < 0).any():
            raise ArgumentError(f"constraintfreedoms: are {freedoms.tolist()}, and should be 1 or 0 each")
        if not 0 < self.threshold < np.inf:
            raise ArgumentError(f"constrainterrorthresh: is {self.threshold:g}, and should be more than 0")
        T_task_world = checked_transform(self.T_task_world, "constraintmatrix")
        point = inverse(T_task_world @ T_world_tool) if self.T_tool_point is None else self.T_tool_point
        T_tool_point = checked_transform(point, "constrainttaskmatrix")
        return T_task_world, T_tool_point, freedoms, self.threshold


@dataclass(frozen=True)
class MovedTool:
    """Tool of a robot that a planner moves.

    Attributes:
        tool: The tool.
        bodies: The robot.
        columns: The columns of a configuration that hold the joints of the arm.
    """

    tool: Tool
    bodies: Bodies
    columns: Sequence[int]

    @classmethod
    def for_arm(cls, bodies: Bodies, arm: Manipulator, *, gripper: bool = False) -> "MovedTool":
        """Return the tool of an arm of the robot that moves.

        Args:
            bodies: The robot, as the only body that moves.
            arm: The manipulator.
            gripper: Whether joints of the gripper may move as well.

        Raises:
            ArgumentError: other joints than those of the arm move.
        """
        dofs = [dof for part in bodies.parts for dof in part.dofs]
        others = sorted(set(dofs).difference(arm.gripper_dofs if gripper else ()).union(set(dofs) & set(arm.arm_dofs)))
        if others != sorted(arm.arm_dofs) or any(not part.dofs for part in bodies.parts):
            wanted = f"those of the arm of '{arm.name}': {list(arm.arm_dofs)}"
            raise ArgumentError(f"the DOFs are {dofs}, and should be {wanted}")
        return cls(Tool.for_arm(arm), bodies, [dofs.index(dof) for dof in arm.arm_dofs])

    @property
    def body(self) -> BodyState:
        """The robot."""
        return self.bodies.bodies[0]

    @property
    def dof(self) -> int:
        """The number of values of a configuration."""
        return self.bodies.dof

    def pose(self) -> Floats:
        """Return ``T_world_tool`` at the present configuration, shape (4, 4)."""
        return self.tool.pose(self.body)

    def motion(self, values: Floats) -> tuple[Floats, Floats]:
        """Move the robot to a configuration (n,), and return ``T_world_tool`` and its Jacobian, shape (6, n).

        The Jacobian gives the linear velocity of the tool's origin, then the angular velocity, in world axes.
        """
        self.bodies.move(values)
        jacobian = np.zeros((6, self.dof))
        jacobian[:3, self.columns] = self.tool.translation_jacobian(self.body)
        jacobian[3:, self.columns] = self.tool.rotation_jacobian(self.body)
        return self.pose(), jacobian

    def to_pose(self, T_world_goal: Floats) -> Error:
        """Return the error function of a goal pose (4, 4): translation and rotation vectors to the goal."""
        from ravemj.ik.residuals import rotation_between

        def lacking(values: Floats) -> tuple[Floats, Floats]:
            T_world_tool, jacobian = self.motion(values)
            way = T_world_goal[:3, 3] - T_world_tool[:3, 3]
            return np.append(way, rotation_between(T_world_tool[:3, :3], T_world_goal)), jacobian

        return lacking

    def to_constraint(self, constraint: ToolConstraint) -> Manifold:
        """Return the manifold of a constraint for a tool that starts at its present pose.

        Raises:
            ArgumentError: the numbers of the constraint are invalid.
        """
        from ravemj.ik.residuals import rotation_between

        T_task_world, T_tool_point, freedoms, threshold = constraint.checked(self.pose())
        rotation = T_task_world[:3, :3]

        def lacking(values: Floats) -> tuple[Floats, Floats]:
            T_world_tool, jacobian = self.motion(values)
            T_task_point = T_task_world @ T_world_tool @ T_tool_point
            arm = T_world_tool[:3, :3] @ T_tool_point[:3, 3]
            moves = jacobian[:3] - np.cross(arm, jacobian[3:], axisb=0, axisc=0)  # v_point = v_tool + omega x arm
            error = np.append(rotation_between(T_task_point[:3, :3], np.eye(4)), -T_task_point[:3, 3])
            return freedoms * error, freedoms[:, None] * np.vstack([rotation @ jacobian[3:], rotation @ moves])

        return Manifold(lacking, threshold)
