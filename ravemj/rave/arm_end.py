"""The end of an arm: its links, its gripper, what these hold and what they collide with."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from types import EllipsisType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, Ints, inverse
from ravemj.engine.collision import arms
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState
from ravemj.model import chains, scene
from ravemj.model.manipulators import joint_dofs
from ravemj.rave.arm_base import ArmPart
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link
from ravemj.rave.report import CollisionReport
from ravemj.rave.specification import IkParameterization

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody

Target = ArrayLike | IkParameterization | CollisionReport | None
"""Where a tool should be, or, where that is left out, the report that follows it."""


class ArmEnd(ArmPart):
    """Links and joints beyond the arm; the closing direction of each joint of a gripper, and the bodies that it holds.

    Collisions are tested for the links beyond the arm, at any pose of the tool, and for those before it.
    """

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
        """Return the sign in which each DOF of the gripper closes: 1, 0 or -1."""
        return np.array(self._scene.chucking_direction, dtype=np.int_)

    GetClosingDirection = GetChuckingDirection

    def SetChuckingDirection(self, chuckingdirection: ArrayLike) -> None:
        """Set ``chuckingdirection``, the sign in which each DOF of the gripper closes: -1, 0 or 1."""
        count = len(self._scene.gripper_dofs)
        signs = checked_vector(chuckingdirection, count, "SetChuckingDirection: chuckingdirection")
        self._edit(chucking_direction=tuple(signs.tolist()))

    SetClosingDirection = SetChuckingDirection

    def IsGrabbing(self, body: "KinBody") -> bool:
        """Return whether the effector, or a link beyond it, holds ``body``."""
        return self._robot.IsGrabbing(body) in self.GetChildLinks()

    def ReleaseAllGrabbed(self) -> None:
        """Let go of all bodies that the effector and the links beyond it hold."""
        with self._state.simulation.lock:
            for link in self.GetChildLinks():
                self._robot.ReleaseAllGrabbedWithLink(link)

    def GetGripperName(self) -> str:
        """Return the name of the ``GripperInfo`` that describes the gripper; empty if there is none."""
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

    def CheckEndEffectorCollision(
        self,
        transform: "Target | EllipsisType" = ...,
        report: CollisionReport | None = None,
        numredundantsamples: int = 0,
    ) -> bool:
        """Return whether the links beyond the arm, and what they hold, collide with other bodies.

        Args:
            transform: ``T_world_tool``, where the tool is meanwhile: 4x4, 3x4, 7 numbers, or an
                ``IkParameterization``. The arm stays. None: where it is. It may be left out before ``report``.
            report: Filled with what is found.
            numredundantsamples: OpenRAVE's, for goals that leave the tool some freedom; ignored.

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
        """Return whether the links beyond the arm, and what they hold, collide with the rest of the robot.

        Args:
            transform: ``T_world_tool``, where the tool is meanwhile, as in ``CheckEndEffectorCollision``.
            report: Filled with what is found.
            numredundantsamples: Ignored.
            ignoreManipulatorLinks: Whether the links of the arm itself are left out, which move to reach the pose.
        """
        del numredundantsamples
        target, report = _sorted_out(transform, report)
        find = partial(arms.end_and_rest, without_arm=ignoreManipulatorLinks)
        return self._answer(find, report, target)

    def CheckIndependentCollision(self, report: CollisionReport | None = None) -> bool:
        """Return whether the links that neither arm nor gripper move, and what they hold, collide with other bodies.

        Args:
            report: Filled with what is found.
        """
        return self._answer(arms.independent_and_others, report, None)

    def _answer(
        self,
        find: Callable[[CollisionWorld, BodyState, scene.Manipulator], Pairs],
        report: CollisionReport | None,
        T_world_tool: Floats | None,
    ) -> bool:
        """Test pairs with the tool where it is wanted, or where it is."""
        checker = self._robot.GetEnv().GetCollisionChecker()
        with self._state.simulation.lock, checker.groups.world() as world, self._moved(world, T_world_tool):
            return checker.answer(world, find(world, self._state, self._scene), report)

    def _moved(self, world: CollisionWorld, T_world_tool: Floats | None) -> AbstractContextManager[None]:
        """Put the links beyond the arm, and what they hold, where the tool is wanted."""
        if T_world_tool is None:
            return nullcontext()
        return world.moved(arms.motions_of_end(self._state, self._scene, T_world_tool @ inverse(self.GetTransform())))


def _sorted_out(transform: Target, report: CollisionReport | None) -> tuple[Floats | None, CollisionReport | None]:
    """Return the pose and the report, the first of which may have been left out."""
    if isinstance(transform, IkParameterization):
        return transform.GetTransform6D(), report
    if transform is None or isinstance(transform, CollisionReport):
        return None, transform or report
    return checked_transform(np.asarray(transform), "transform"), report
