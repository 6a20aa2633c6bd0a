"""Collision of the end of an arm."""

from abc import abstractmethod
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.questions import body_and_others, held_with, itself
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState
from ravemj.model import chains, scene
from ravemj.rave.ikparameterization import IkParameterization
from ravemj.rave.report import CollisionReport

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
        transform: Target = None,
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
        target, report = _sorted_out(transform, report)
        beyond = self._links_beyond()
        with self._state.simulation.lock:
            world = self._state.simulation.collisions()
            with self._moved(world, target):
                checker = self._robot.GetEnv().GetCollisionChecker()
                return checker.answer(world, body_and_others(world, self._state, beyond), report)

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
        beyond, others = self._links_beyond(), set(range(len(self._state.scene.links)))
        if ignoreManipulatorLinks:
            others = set(chains.independent_links(self._state.scene, self._scene))
        asked = frozenset((min(a, b), max(a, b)) for a in beyond for b in others - beyond)
        with self._state.simulation.lock:
            world = self._state.simulation.collisions()
            with self._moved(world, target):
                checker = self._robot.GetEnv().GetCollisionChecker()
                return checker.answer(world, itself(world, self._state, asked), report)

    def CheckIndependentCollision(self, report: CollisionReport | None = None) -> bool:
        """Return whether the links that neither arm nor gripper move, and what they hold, collide with other bodies.

        Args:
            report: Filled with what is found.
        """
        links = frozenset(chains.independent_links(self._state.scene, self._scene))
        with self._state.simulation.lock:
            world = self._state.simulation.collisions()
            checker = self._robot.GetEnv().GetCollisionChecker()
            return checker.answer(world, body_and_others(world, self._state, links), report)

    def _links_beyond(self) -> frozenset[int]:
        return frozenset(chains.links_beyond(self._state.scene, self._scene))

    def _moved(self, world: CollisionWorld, T_world_tool: Floats | None) -> AbstractContextManager[None]:
        """Put the links beyond the arm, and what they hold, where the tool is wanted."""
        if T_world_tool is None:
            return nullcontext()
        motion, beyond = T_world_tool @ inverse(self.GetTransform()), self._links_beyond()
        moved = {(self._state, link): motion for link in beyond}
        for grab in self._state.grabs:
            if grab.link in beyond:
                for body in held_with(grab.body):
                    moved.update({(body, link): motion for link in range(len(body.scene.links))})
        return world.moved(moved)


def _sorted_out(transform: Target, report: CollisionReport | None) -> tuple[Floats | None, CollisionReport | None]:
    """Return the pose and the report, the first of which may have been left out."""
    if isinstance(transform, IkParameterization):
        return transform.GetTransform6D(), report
    if transform is None or isinstance(transform, CollisionReport):
        return None, transform or report
    return checked_transform(np.asarray(transform), "transform"), report
