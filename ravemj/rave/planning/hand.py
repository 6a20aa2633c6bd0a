"""The error of a robot's tool against a goal pose or a task-space constraint, with its Jacobian."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, inverse
from ravemj.errors import ArgumentError
from ravemj.ik.residuals import rotation_between
from ravemj.planning.constrained_edges import Manifold
from ravemj.planning.projection import Error
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.bodies import Bodies
from ravemj.rave.planning.values import Values
from ravemj.rave.robot import Robot
from ravemj.trajectories.groups import joint_indices


class ToolConstraint(NamedTuple):
    """A task-space constraint of the tool.

    The constraint keeps ``T_task_world @ T_world_tool @ T_tool_point`` free of rotation about some axes and of
    translation along some axes.

    Attributes:
        T_task_world: The task frame, whose axes ``freedoms`` refers to.
        T_tool_point: The constrained frame, relative to the tool; None for the frame that is the task frame at the
            start, so that the tool keeps what it has there.
        freedoms: 1 constrains, 0 leaves free: the rotations about x, y, z, then the translations along them, shape
            (6,).
        threshold: The tolerance of the constraint [m and rad].
    """

    T_task_world: Floats
    T_tool_point: Floats | None
    freedoms: Floats
    threshold: float

    def checked(self, T_world_tool: Floats) -> tuple[Floats, Floats, Floats, float]:
        """Return the fields, with the constrained frame filled in for a tool at a pose, and exact rotations.

        Raises:
            ArgumentError: its numbers are none of a constraint.
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
class Hand:
    """The active manipulator of the robot that a problem is about.

    Attributes:
        manip: The manipulator.
        bodies: The robot, as the planner moves it.
        columns: The columns of a configuration that hold the joints of ``manip.GetArmIndices()``.
        dof: The number of values of a configuration.
    """

    manip: Manipulator
    bodies: Bodies
    columns: Sequence[int]
    dof: int

    def motion(self, values: Floats) -> tuple[Floats, Floats]:
        """Move the robot to a configuration (n,), and return ``T_world_tool`` and its Jacobian, shape (6, n).

        In world axes, its first rows are the velocity of the origin, its last the angular velocity.
        """
        self.bodies.move(values)
        jacobian = np.zeros((6, self.dof))
        jacobian[:3, self.columns] = self.manip.CalculateJacobian()
        jacobian[3:, self.columns] = self.manip.CalculateAngularVelocityJacobian()
        return self.manip.GetTransform(), jacobian

    def to_pose(self, T_world_goal: Floats) -> Error:
        """Return the error function of a goal pose (4, 4): the translation and rotation vectors that are left."""

        def lacking(values: Floats) -> tuple[Floats, Floats]:
            T_world_tool, jacobian = self.motion(values)
            way = T_world_goal[:3, 3] - T_world_tool[:3, 3]
            return np.append(way, rotation_between(T_world_tool[:3, :3], T_world_goal)), jacobian

        return lacking

    def to_constraint(self, constraint: ToolConstraint) -> Manifold:
        """Return the configurations that keep a constraint; the tool starts where it is.

        Raises:
            ArgumentError: the constraint has numbers that make no sense.
        """
        T_task_world, T_tool_point, freedoms, threshold = constraint.checked(self.manip.GetTransform())
        rotation = T_task_world[:3, :3]

        def lacking(values: Floats) -> tuple[Floats, Floats]:
            T_world_tool, jacobian = self.motion(values)
            found = T_task_world @ T_world_tool @ T_tool_point
            arm = T_world_tool[:3, :3] @ T_tool_point[:3, 3]
            moves = jacobian[:3] - np.cross(arm, jacobian[3:], axisb=0, axisc=0)  # v_point = v_tool + omega x arm
            error = np.append(rotation_between(found[:3, :3], np.eye(4)), -found[:3, 3])
            return freedoms * error, freedoms[:, None] * np.vstack([rotation @ jacobian[3:], rotation @ moves])

        return Manifold(lacking, threshold)


def hand_of(values: Values) -> Hand:
    """Return the active manipulator of the one robot that a problem moves.

    Raises:
        ArgumentError: the problem moves anything but the arm joints of one robot's active manipulator.
    """
    robots = [] if values.bodies is None else values.bodies.bodies
    manip = robots[0].GetActiveManipulator() if len(robots) == 1 and isinstance(robots[0], Robot) else None
    if manip is None or values.bodies is None:
        raise ArgumentError("the hand of one robot should move, and it should have an active manipulator")
    dofs = [dof for group in values.groups for dof in joint_indices(group)]
    arm = manip.GetArmIndices().tolist()
    if sorted(dofs) != sorted(arm):
        raise ArgumentError(f"the DOFs are {dofs}, and should be those of the arm of '{manip.GetName()}': {arm}")
    return Hand(manip, values.bodies, [dofs.index(dof) for dof in arm], len(dofs))
