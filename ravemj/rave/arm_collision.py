"""Collision of the end of an arm."""

from abc import abstractmethod
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from types import EllipsisType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision import arms
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState
from ravemj.model import scene
from ravemj.rave.report import CollisionReport
from ravemj.rave.specification import IkParameterization

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody

Target = ArrayLike | IkParameterization | CollisionReport | None
"""Where a tool should be, or, where that is left out, the report that follows it."""


class ArmCollision:
    """Tests of the links beyond the arm, also where the tool is not now, and of the links before it."""

    _robot: "KinBody"
    _state: BodyState

    @property
    @abstractmethod
    def _scene(self) -> scene.Manipulator: ...

    @abstractmethod
    def GetTransform(self) -> Floats:
        """Return ``T_world_tool``."""

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
        with self._state.simulation.lock:
            world = self._state.simulation.collisions()
            with self._moved(world, T_world_tool):
                checker = self._robot.GetEnv().GetCollisionChecker()
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
