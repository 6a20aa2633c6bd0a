"""Collision checks of a body, bounding boxes, and groups of geometries."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arrays import checked_numbers, checked_rows, checked_transform
from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.moving import batch_collides
from ravemj.engine.collision.queries import moved_apart, tested_pairs
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import AABB, OrientedBox, OrientedBoxFromAABB
from ravemj.model.bounds import enclosing_box, links_bounds
from ravemj.rave.body.structure import Structure
from ravemj.rave.enums import AdjacentOptions, InterfaceType
from ravemj.rave.infos import GeometryInfo
from ravemj.rave.interface import Interface

if TYPE_CHECKING:
    from ravemj.rave.collision import CollisionChecker
    from ravemj.rave.report import CollisionReport


class BodyCollision(Structure, Interface):
    """Self-collision, enabled links, adjacent links, bounding boxes, and groups of geometries.

    A group has a name and a list of geometries for each link, which can replace the link's own geometries; see
    ``link.SetGroupGeometries``.
    """

    AdjacentOptions = AdjacentOptions
    _internal = ("active_dofs", "moves_as_a_whole")

    _self_checker: "CollisionChecker | None" = None

    def CheckSelfCollision(
        self, report: "CollisionReport | None" = None, collisionchecker: "CollisionChecker | None" = None
    ) -> bool:
        """Return whether links of the body collide with each other or with grabbed bodies.

        Pairs of links do not count if a joint connects them, if the file declares them ``<adjacent>``, or if they
        touched when the body was added.

        Args:
            report: Receives the collisions.
            collisionchecker: The checker, whose options apply. The default is that of ``SetSelfCollisionChecker``, or
                else that of the environment.

        Example:
            >>> robot.SetDOFValues([0, 3.0])
            >>> robot.CheckSelfCollision()
            True
        """
        if collisionchecker is not None:
            _check_checker(collisionchecker, "CheckSelfCollision")
        checker = collisionchecker or self._self_checker or self._env.GetCollisionChecker()
        return checker.CheckSelfCollision(self, report)

    def SetSelfCollisionChecker(self, collisionchecker: "CollisionChecker | None") -> None:
        """Let ``CheckSelfCollision`` use ``collisionchecker``; None selects that of the environment."""
        if collisionchecker is not None:
            _check_checker(collisionchecker, "SetSelfCollisionChecker")
        self._self_checker = collisionchecker

    def GetSelfCollisionChecker(self) -> "CollisionChecker | None":
        """Return the checker that ``SetSelfCollisionChecker`` chose, or None."""
        return self._self_checker

    def batch_collides(self, values: ArrayLike, itself_too: bool = True) -> NDArray[np.bool_]:
        """Return for each of many configurations whether the body collides in it.

        Args:
            values: The joint values of the configurations [rad or m], shape (n, dof); limits are not checked.
            itself_too: Whether self-collisions count.

        Returns:
            Whether the body collides, shape (n,). Afterwards the body is back in its configuration. Options,
            groups and callbacks of collision checkers have no effect.

        Example:
            >>> lower, upper = robot.GetDOFLimits()
            >>> samples = np.random.uniform(lower, upper, (1000, robot.GetDOF()))
            >>> free = samples[~robot.batch_collides(samples)]
        """
        rows = checked_rows(values, self.GetDOF(), "batch_collides: values")
        with self._simulation.lock:
            return batch_collides(self._state, rows, itself_too=itself_too)

    def active_dofs(self) -> tuple[int, ...]:
        """Return the DOF indices of the active joints. Only robots can choose them; other bodies have all."""
        return tuple(range(self.GetDOF()))

    def moves_as_a_whole(self) -> bool:
        """Return whether affine DOFs are active, which move the body as a whole; only robots can have them."""
        return False

    def Enable(self, enable: bool) -> None:
        """Let all links take part in collision checks, or none, as ``enable`` says."""
        self._state.link_enabled = [bool(enable)] * len(self._state.link_enabled)

    def IsEnabled(self) -> bool:
        """Return whether any link takes part in collision checks."""
        return any(self._state.link_enabled)

    def GetLinkEnableStates(self) -> NDArray[np.uint8]:
        """Return for each link 1 if it is enabled, else 0, shape (links,)."""
        return np.array(self._state.link_enabled, dtype=np.uint8)

    def SetLinkEnableStates(self, enablestates: ArrayLike) -> None:
        """Enable and disable links: ``enablestates`` has a truth value for each link, shape (links,)."""
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
            adjacentoptions: The choice of pairs, ``AdjacentOptions`` combined with ``|``; 0 for all.

        Raises:
            ArgumentError: ``ActiveDOFs`` is set, and the body is not a robot.
        """
        if adjacentoptions & AdjacentOptions.ActiveDOFs and not self._state.scene.is_robot:  # random-api-90
            raise ArgumentError(f"GetNonAdjacentLinks: '{self.GetName()}' is not a robot, and so has no active DOFs")
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
        """Exclude a pair of links from ``CheckSelfCollision``.

        Args:
            linkindex0: Index of a link.
            linkindex1: Index of the other.

        Raises:
            openrave_exception: there is no such link, or both are the same.
        """
        self.SetAdjacentLinksPairs([(linkindex0, linkindex1)])

    def SetAdjacentLinksCombinations(self, linkIndices: Sequence[int]) -> None:
        """Exclude all pairs of the links with indices ``linkIndices`` from ``CheckSelfCollision``."""
        self.SetAdjacentLinksPairs([(a, b) for a in linkIndices for b in linkIndices if a < b])

    def SetAdjacentLinksPairs(self, pairs: Iterable[Sequence[int]]) -> None:
        """Exclude pairs of links from ``CheckSelfCollision``; see ``SetAdjacentLinks``.

        Args:
            pairs: Pairs of link indices.

        Raises:
            openrave_exception: a pair names a link that the body does not have, or the same link twice.
        """
        count, added = len(self._state.scene.links), set(self._state.scene.adjacent)
        for first, second in pairs:
            if not (0 <= first < count and 0 <= second < count and first != second):
                message = (
                    f"SetAdjacentLinks: ({first}, {second}) should be two of the {count} links of '{self.GetName()}'"
                )
                raise RavemjError(message, ErrorCode.Assert)
            added.add((min(first, second), max(first, second)))
        with self._simulation.lock:
            self._simulation.forget_model()  # the compiled model has a list of the excluded pairs
            self._state.edit(adjacent=tuple(sorted(added)))

    def SetNonCollidingConfiguration(self) -> None:
        """Declare the current configuration free of self-collisions: links that touch now are never tested again."""
        with self._simulation.lock:
            self._state.rest_poses = self._state.link_transforms()
            self._simulation.collision_stamp += 1

    def ComputeAABB(self, enabledOnlyLinks: bool = False) -> AABB:
        """Return the axis-aligned bounding box of all geometries in the world.

        Args:
            enabledOnlyLinks: Whether to ignore disabled links.

        Returns:
            The box; ``pos()`` is its centre, ``extents()`` its half extents [m]. Without geometries it is a point at
            the origin of the first link.

        Example:
            >>> box = robot.ComputeAABB()
            >>> height = box.pos()[2] + box.extents()[2]
        """
        return self._bounds(self._poses(), enabledOnlyLinks)

    def ComputeAABBFromTransform(self, transform: ArrayLike, enabledOnlyLinks: bool = False) -> AABB:
        """Return the bounding box of ``ComputeAABB`` for another pose of the body and its current joint values.

        Args:
            transform: ``T_world_link0``, as ``SetTransform`` takes it.
            enabledOnlyLinks: Whether to ignore disabled links.
        """
        T_world_body = checked_transform(transform, "ComputeAABBFromTransform: transform")
        return self._bounds(self._poses(T_world_body), enabledOnlyLinks)

    def ComputeLocalAABB(self, enabledOnlyLinks: bool = False) -> AABB:
        """Return the box of ``ComputeAABB(enabledOnlyLinks)`` in the frame of the first link, along its axes."""
        return self.ComputeAABBFromTransform(np.eye(4), enabledOnlyLinks)

    def ComputeOBBOnAxes(self, transform: ArrayLike, enabledOnlyLinks: bool = False) -> OrientedBox:
        """Return the bounding box of all geometries along the axes of a given frame.

        Args:
            transform: ``T_world_frame``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz].
            enabledOnlyLinks: Whether to ignore disabled links.
        """
        T_world_frame = checked_transform(transform, "ComputeOBBOnAxes: transform")
        local = self._bounds(inverse(T_world_frame) @ self._poses(), enabledOnlyLinks)
        return OrientedBoxFromAABB(local, T_world_frame)

    def SetLinkGroupGeometries(self, name: str, linkgeometries: Sequence[Sequence[GeometryInfo]]) -> None:
        """Store a group of geometries for every link under one name.

        Args:
            name: The name of the group.
            linkgeometries: The descriptions of the geometries of each link, in the order of ``GetLinks()``.

        Raises:
            openrave_exception: the number of lists differs from the number of links, or a description does not make a
                geometry.
        """
        links = self.GetLinks()
        if len(linkgeometries) != len(links):
            message = f"linkgeometries has {len(linkgeometries)} lists, and should have {len(links)}, one for each link"
            raise ArgumentError(f"SetLinkGroupGeometries: {message}")
        for link, infos in zip(links, linkgeometries, strict=True):
            link.SetGroupGeometries(name, infos)

    def SetLinkGeometriesFromGroup(self, name: str, propagateGroupNameToSelfCollisionChecker: bool = True) -> None:
        """Replace the geometries of every link by those of a group.

        Args:
            name: The name of the group; ``self`` restores the links' own geometries.
            propagateGroupNameToSelfCollisionChecker: Not used: collision checks always use the current geometries.

        Raises:
            openrave_exception: a link has no such group. All links stay as they are.
        """
        del propagateGroupNameToSelfCollisionChecker
        with self._simulation.lock:
            for link in self.GetLinks():
                link.GetGeometriesFromGroup(name)  # raises before any link has changed
            for link in self.GetLinks():
                link.SetGeometriesFromGroup(name)

    def ComputeAABBForGeometryGroup(self, geomgroupname: str, enabledOnlyLinks: bool = False) -> AABB:
        """Return the bounding box of ``ComputeAABB`` for a group of geometries. Links without the group do not count.

        Args:
            geomgroupname: The name of the group; ``self`` is the group of the links' own geometries.
            enabledOnlyLinks: Whether to ignore disabled links.
        """
        with self._simulation.lock:
            T_world_link0 = self._state.link_transform(0) if self._state.scene.links else np.eye(4)
        return self.ComputeAABBForGeometryGroupFromTransform(geomgroupname, T_world_link0, enabledOnlyLinks)

    def ComputeAABBForGeometryGroupFromTransform(
        self, geomgroupname: str, transform: ArrayLike, enabledOnlyLinks: bool = False
    ) -> AABB:
        """Return the bounding box of ``ComputeAABBForGeometryGroup`` for another pose of the body.

        Args:
            geomgroupname: The name of the group.
            transform: ``T_world_link0``, as ``SetTransform`` takes it.
            enabledOnlyLinks: Whether to ignore disabled links.
        """
        T_world_body = checked_transform(transform, "ComputeAABBForGeometryGroupFromTransform: transform")
        links = [
            (link.scene_with_group(geomgroupname), pose)
            for link, pose, takes_part in zip(
                self.GetLinks(), self._poses(T_world_body), self._state.link_enabled, strict=True
            )
            if link.GetGroupNumGeometries(geomgroupname) >= 0 and (takes_part or not enabledOnlyLinks)
        ]
        return enclosing_box(links_bounds([link for link, _ in links], [pose for _, pose in links]), T_world_body)

    def ComputeLocalAABBForGeometryGroup(self, geomgroupname: str, enabledOnlyLinks: bool = False) -> AABB:
        """Return the bounding box of a group of geometries in the frame of the first link.

        Args:
            geomgroupname: The name of the group.
            enabledOnlyLinks: Whether to ignore disabled links.
        """
        return self.ComputeAABBForGeometryGroupFromTransform(geomgroupname, np.eye(4), enabledOnlyLinks)

    def _poses(self, T_world_body: Floats | None = None) -> Floats:
        """Return the poses of the links for the current or a given pose of the first link, shape (links, 4, 4)."""
        with self._simulation.lock:
            poses = self._state.link_transforms()
        return poses if T_world_body is None or not len(poses) else T_world_body @ inverse(poses[0]) @ poses

    def _bounds(self, poses: Floats, enabled_only: bool) -> AABB:
        enabled = self._state.link_enabled
        bounds = self._state.bounds.at(poses, enabled if enabled_only else (True,) * len(enabled))
        return enclosing_box(bounds, poses[0] if len(poses) else np.eye(4))


def _check_checker(checker: object, caller: str) -> None:
    if getattr(checker, "GetInterfaceType", lambda: None)() is not InterfaceType.collisionchecker:
        found = f"is of type {type(checker).__name__}, and should be CollisionChecker"
        raise ArgumentError(f"{caller}: collisionchecker: {found}")
