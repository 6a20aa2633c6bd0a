"""Motions of fingers, and of arms to grasps: the module ``TaskManipulation``."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.collision.queries import MovedBy, body_and_others, itself
from ravemj.errors import ArgumentError
from ravemj.manipulation.motions import move_until_contact
from ravemj.manipulation.tool import ToolConstraint
from ravemj.planning.projection import PROJECTION_STEPS, project
from ravemj.rave.kinbody import KinBody
from ravemj.rave.modules.base_manipulation import BaseManipulation
from ravemj.rave.modules.grasp_planning import GraspPlan, GraspQuery, plan_grasp
from ravemj.rave.modules.motions import Manipulation
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.planning.values import hand_of
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

_STEP = 0.01
"""The step in which joints move between two collision tests [rad or m]."""


class TaskManipulation(Manipulation):
    """Opens and closes grippers, and moves arms to grasps."""

    def __init__(self, env: "Environment") -> None:
        super().__init__(env)
        self._base = BaseManipulation(env)

    def plan_grasp(self, query: GraspQuery) -> GraspPlan:
        """Return a motion of the active manipulator's arm to one of several grasps.

        Raises:
            PlanningError: no grasp can be reached.
        """
        self._base.choose(self.robot.GetName())
        self._base.planner = self.planner
        return plan_grasp(self._base, query)

    def evaluate_constraints(
        self, constraint: ToolConstraint, configurations: Sequence[Floats]
    ) -> tuple[list[int], list[Floats]]:
        """Project configurations of the active DOFs, those of the arm, onto a constraint.

        Return the number of steps for each, -1 if it does not reach the constraint, and the results.

        Raises:
            ArgumentError: the active DOFs are not the joints of the arm, or the constraint has numbers of none.
        """
        params = PlannerParameters()
        params.SetRobotActiveJoints(self.robot)
        values = params.resolved()
        tool = hand_of(self.env, values).tool
        error, threshold = tool.to_constraint(constraint)
        with tool.bodies.kept():
            found = [project(one, error, values.space(), threshold, PROJECTION_STEPS) for one in configurations]
        return [steps for steps, _ in found], [row for _, row in found]

    def close_fingers(
        self, directions: Floats | None = None, offsets: Floats | None = None, step: float = _STEP
    ) -> tuple[Floats, Trajectory]:
        """Close the gripper: return the last values of its joints, and the motion.

        Joints stop at contacts and limits. Each direction is the sign of the motion of a joint, by default the closing
        direction; offsets are how far joints move back from there [rad or m].

        Raises:
            PlanningError: the robot has no gripper.
        """
        dofs, closing = self._gripper()
        directions = closing if directions is None else directions
        final = self._until_contact(dofs, directions, step)
        if offsets is not None:
            lower, upper = self.robot.GetDOFLimits(dofs)
            final = np.clip(final - np.sign(directions) * offsets, lower, upper)
        return final, self._motion(dofs, final)

    def release_fingers(
        self, directions: Floats | None = None, target: KinBody | None = None, step: float = _STEP
    ) -> tuple[Floats, Trajectory]:
        """Open the gripper, and let a target go: return the last values of its joints, and the motion.

        Each direction is the sign of the motion of a joint, by default against the closing direction.

        Raises:
            PlanningError: the robot has no gripper.
        """
        dofs, closing = self._gripper()
        if target is not None:
            self.robot.Release(target)
        final = self._until_contact(dofs, -closing if directions is None else directions, step)
        return final, self._motion(dofs, final)

    def release_active(self, directions: Floats, step: float = _STEP) -> tuple[Floats, Trajectory]:
        """Move each active joint to the side of its sign in ``directions``; return the last values and the motion."""
        dofs = [int(dof) for dof in self.robot.GetActiveDOFIndices()]
        if len(directions) != len(dofs):
            raise ArgumentError(f"movingdir: has {len(directions)} numbers, and there are {len(dofs)} active joints")
        final = self._until_contact(dofs, directions, step)
        return final, self._motion(dofs, final)

    def _gripper(self) -> tuple[list[int], Floats]:
        manip = self.robot.GetActiveManipulator()
        dofs = [] if manip is None else [int(dof) for dof in manip.GetGripperIndices()]
        if manip is None or not dofs:
            raise PlanningError(f"robot '{self.robot.GetName()}' has no active manipulator with a gripper")
        return dofs, np.asarray(manip.GetChuckingDirection(), dtype=float)

    def _motion(self, dofs: Sequence[int], final: Floats) -> Trajectory:
        return self.straight(np.stack([self.robot.GetDOFValues(dofs), final]), dofs)

    def _until_contact(self, dofs: Sequence[int], directions: Floats, step: float) -> Floats:
        """Return the values at which joints stop."""
        if not (np.isfinite(directions).all() and np.isfinite(step) and step > 0):
            wanted = "finite directions, and a step above 0"
            raise ArgumentError(f"movingdir is {directions.tolist()} with steps of {step:g}, and should be {wanted}")
        return move_until_contact(
            self.bodies_of(dofs),
            self.robot.GetDOFLimits(dofs),
            np.sign(directions),
            step,
            lambda joint: self._touches(dofs[joint]),
        )

    def _touches(self, dof: int) -> bool:
        """Return whether a link that a joint moves touches another body, or a link that does not move with it."""
        state, simulation = self.robot.simulation_state, self.env.simulation
        moved = MovedBy((dof,))
        with simulation.lock, self.env.GetCollisionChecker().world() as world:
            return world.collide(body_and_others(world, state, moved)) or world.collide(itself(world, state, moved))
