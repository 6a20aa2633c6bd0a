"""Collision of a body."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arrays import checked_numbers, checked_transform
from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.moving import batch_collides
from ravemj.engine.collision.questions import moved_apart
from ravemj.engine.collision.resting import tested_pairs
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import AABB, OrientedBox, OrientedBoxFromAABB
from ravemj.model.bounds import enclosing_box, links_bounds
from ravemj.rave.body.base import BodyPart
from ravemj.rave.enums import AdjacentOptions
from ravemj.rave.interface import Interface

if TYPE_CHECKING:
    from ravemj.rave.collision import CollisionChecker
    from ravemj.rave.report import CollisionReport


class BodyCollision(BodyPart, Interface):
    """Collision of the body with itself, what takes part in it, and how much room the body needs."""

    AdjacentOptions = AdjacentOptions
    _internal = ("active_dofs", "moves_as_a_whole")

    _self_checker: "CollisionChecker | None" = None

    def CheckSelfCollision(
        self, report: "CollisionReport | None" = None, collisionchecker: "CollisionChecker | None" = None
    ) -> bool:
        """Return whether links of the body collide with each other or with what it holds.

        Links are left out that a joint connects, that the file calls ``<adjacent>``, or that touched when the body was
        added.

        Args:
            report: Filled with what is found.
            collisionchecker: The checker whose options hold; None: that of ``SetSelfCollisionChecker``, or else of the
                environment.

        Example:
            >>> robot.SetDOFValues([0, 3.0])
            >>> robot.CheckSelfCollision()
            True
        """
        checker = collisionchecker or self._self_checker or self._env.GetCollisionChecker()
        return checker.CheckSelfCollision(self, report)

    def SetSelfCollisionChecker(self, collisionchecker: "CollisionChecker | None") -> None:
        """Choose the checker of ``CheckSelfCollision``; None: that of the environment.

        Args:
            collisionchecker: The checker; None: the environment's.
        """
        self._self_checker = collisionchecker

    def GetSelfCollisionChecker(self) -> "CollisionChecker | None":
        """Return the checker that ``SetSelfCollisionChecker`` chose, or None."""
        return self._self_checker

    def batch_collides(self, values: ArrayLike, itself_too: bool = True) -> NDArray[np.bool_]:
        """Return for each of many configurations whether the body collides there.

        Args:
            values: A row of joint values for each [rad or m], shape (n, dof); limits are not checked.
            itself_too: Whether collisions of the body with itself count.

        Returns:
            Shape (n,). The body is in its configuration again afterwards. Options and callbacks of collision checkers
            make no difference.

        Example:
            >>> lower, upper = robot.GetDOFLimits()
            >>> samples = np.random.uniform(lower, upper, (1000, robot.GetDOF()))
            >>> free = samples[~robot.batch_collides(samples)]
        """
        rows = checked_numbers(values, "batch_collides: values")
        if rows.ndim != 2 or rows.shape[1] != self.GetDOF() or not np.isfinite(rows).all():
            raise ArgumentError(
                f"batch_collides: values have shape {rows.shape}, and should be finite, of shape (n, {self.GetDOF()})"
            )
        with self._simulation.lock:
            return batch_collides(self._state, rows, itself_too=itself_too)

    def active_dofs(self) -> tuple[int, ...]:
        """Return the active joints' DOFs: all, where ``SetActiveDOFs`` has not chosen any."""
        return tuple(range(self.GetDOF()))

    def moves_as_a_whole(self) -> bool:
        """Return whether active DOFs move the body's base."""
        return False

    def Enable(self, enable: bool) -> None:
        """Enable or disable all links for collision checking; nothing else changes.

        Args:
            enable: Whether it takes part.
        """
        self._state.link_enabled = [bool(enable)] * len(self._state.link_enabled)

    def IsEnabled(self) -> bool:
        """Return whether any link is enabled for collision checking."""
        return any(self._state.link_enabled)

    def GetLinkEnableStates(self) -> NDArray[np.uint8]:
        """Return for each link 1 if it is enabled and else 0, shape (links,)."""
        return np.array(self._state.link_enabled, dtype=np.uint8)

    def SetLinkEnableStates(self, enablestates: ArrayLike) -> None:
        """Enable and disable links.

        Args:
            enablestates: For each link whether it is enabled, shape (links,).
        """
        states = checked_numbers(enablestates, "SetLinkEnableStates: enablestates")
        count = len(self._state.link_enabled)
        if states.shape != (count,):
            message = f"SetLinkEnableStates: enablestates have shape {states.shape}, and should have shape ({count},)"
            raise RavemjError(message, ErrorCode.Assert)
        self._state.link_enabled = states != 0

    def GetLinkEnableStatesMasks(self) -> NDArray[np.uint64]:
        """Return the enabled links as bits: link i is bit i % 64 of number i // 64."""
        states = self.GetLinkEnableStates().astype(np.uint64)
        padded = np.concatenate([states, np.zeros(-len(states) % 64, dtype=np.uint64)]).reshape(-1, 64)
        return (padded << np.arange(64, dtype=np.uint64)).sum(axis=1, dtype=np.uint64)

    def SetLinkEnableStatesMasks(self, masks: Iterable[int]) -> None:
        """Enable the links whose bits are set, as ``GetLinkEnableStatesMasks`` returns them.

        Args:
            masks: Numbers of 64 bits each, one bit for each link.
        """
        bits = [bool(int(mask) >> bit & 1) for mask in masks for bit in range(64)]
        count = len(self._state.link_enabled)
        if len(bits) < count:
            raise ArgumentError(f"SetLinkEnableStatesMasks: masks have {len(bits)} bits for {count} links")
        self._state.link_enabled = bits[:count]

    def GetNonAdjacentLinks(self, adjacentoptions: int = 0) -> list[tuple[int, int]]:
        """Return the pairs of links, by index, that ``CheckSelfCollision`` tests.

        Args:
            adjacentoptions: Which of them, ``AdjacentOptions`` combined with ``|``; 0: all.
        """
        with self._simulation.lock:
            pairs = tested_pairs(self._simulation.collisions(), self._state)
        if adjacentoptions & AdjacentOptions.Enabled:
            enabled = self._state.link_enabled
            pairs = [(first, second) for first, second in pairs if enabled[first] and enabled[second]]
        if adjacentoptions & AdjacentOptions.ActiveDOFs:
            apart = moved_apart(self._state.scene, self.active_dofs())
            pairs = [pair for pair in pairs if pair in apart]
        return pairs

    def SetAdjacentLinks(self, linkindex0: int, linkindex1: int) -> None:
        """Leave a pair of links out of ``CheckSelfCollision``.

        Args:
            linkindex0: Index of a link.
            linkindex1: Index of the other.

        Raises:
            openrave_exception: there is no such link, or both are the same.
        """
        self.SetAdjacentLinksPairs([(linkindex0, linkindex1)])

    def SetAdjacentLinksCombinations(self, linkIndices: Sequence[int]) -> None:
        """Leave all pairs of some links out of ``CheckSelfCollision``.

        Args:
            linkIndices: Indices of the links.
        """
        self.SetAdjacentLinksPairs([(a, b) for a in linkIndices for b in linkIndices if a < b])

    def SetAdjacentLinksPairs(self, pairs: Iterable[Sequence[int]]) -> None:
        """Leave pairs of links out of ``CheckSelfCollision``; see ``SetAdjacentLinks``."""
        count, added = len(self._state.scene.links), set(self._state.scene.adjacent)
        for first, second in pairs:
            if not (0 <= first < count and 0 <= second < count and first != second):
                message = (
                    f"SetAdjacentLinks: ({first}, {second}) should be two of the {count} links of '{self.GetName()}'"
                )
                raise RavemjError(message, ErrorCode.Assert)
            added.add((min(first, second), max(first, second)))
        with self._simulation.lock:
            self._simulation.forget_model()  # it excludes these pairs, too
            self._state.edit(adjacent=tuple(sorted(added)))

    def SetNonCollidingConfiguration(self) -> None:
        """Declare the present pose free of self-collision: links that touch now are never tested again.

        Nothing moves.
        """
        with self._simulation.lock:
            self._state.rest_poses = self._state.link_transforms()
            self._simulation.collision_stamp += 1

    def ComputeAABB(self, enabledOnlyLinks: bool = False) -> AABB:
        """Return the smallest box along the world's axes that holds all geometries.

        Args:
            enabledOnlyLinks: Whether disabled links are left out.

        Returns:
            The box, with methods ``pos()``, its centre, and ``extents()``, half its edge lengths. Of a body without
            geometries it is the point where its first link is.

        Example:
            >>> box = robot.ComputeAABB()
            >>> height = box.pos()[2] + box.extents()[2]
        """
        with self._simulation.lock:
            return self._bounds(self._state.link_transforms(), enabledOnlyLinks)

    def ComputeAABBFromTransform(self, transform: ArrayLike, enabledOnlyLinks: bool = False) -> AABB:
        """Return the box of ``ComputeAABB`` for the body standing elsewhere, with its present joint values.

        Args:
            transform: ``T_world_link0``, as ``SetTransform`` takes it.
            enabledOnlyLinks: Whether disabled links are left out.
        """
        T_world_body = checked_transform(transform, "ComputeAABBFromTransform: transform")
        with self._simulation.lock:
            poses = self._state.link_transforms()
        return self._bounds(T_world_body @ inverse(poses[0]) @ poses if len(poses) else poses, enabledOnlyLinks)

    def ComputeLocalAABB(self, enabledOnlyLinks: bool = False) -> AABB:
        """Return the box of ``ComputeAABB`` along the axes of the first link and in its frame.

        Args:
            enabledOnlyLinks: Whether to leave out links that are not enabled.
        """
        return self.ComputeAABBFromTransform(np.eye(4), enabledOnlyLinks)

    def ComputeOBBOnAxes(self, transform: ArrayLike, enabledOnlyLinks: bool = False) -> OrientedBox:
        """Return the smallest box along the axes of a frame that holds all geometries, where the body stands.

        Args:
            transform: ``T_world_frame``, whose axes the box has: 4x4, 3x4 or [w, x, y, z, tx, ty, tz].
            enabledOnlyLinks: Whether disabled links are left out.
        """
        T_world_frame = checked_transform(transform, "ComputeOBBOnAxes: transform")
        with self._simulation.lock:
            local = self._bounds(inverse(T_world_frame) @ self._state.link_transforms(), enabledOnlyLinks)
        return OrientedBoxFromAABB(local, T_world_frame)

    def _bounds(self, poses: Floats, enabled_only: bool) -> AABB:
        enabled = self._state.link_enabled
        chosen = [link for link in range(len(poses)) if enabled[link] or not enabled_only]
        bounds = links_bounds([self._state.scene.links[link] for link in chosen], poses[chosen])
        return enclosing_box(bounds, poses[0] if len(poses) else np.eye(4))
