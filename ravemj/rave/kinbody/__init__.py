"""Bodies: names, grabbing, collision settings and bounding boxes."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Callable, Generator, Iterable, Sequence
from operator import methodcaller
from types import EllipsisType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform, checked_whole_numbers
from ravemj.core.blocks import Block, Closing, exit_in_c, restoring
from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.queries import moved_apart, tested_pairs
from ravemj.engine.grabbing import grab_as_it_stands
from ravemj.engine.simulation import BodyState, both_locks
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import AABB, OrientedBox, OrientedBoxFromAABB
from ravemj.model.bounds import enclosing_box, links_bounds
from ravemj.model.shape_bodies import empty_body
from ravemj.rave.enums import (
    AdjacentOptions,
    CheckLimitsAction,
    GrabbedInfoCheckResult,
    InterfaceType,
    JointType,
    SaveParameters,
)
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo, GrabbedInfo, JointInfo, KinBodyInfo, LinkInfo
from ravemj.rave.interface import Annotations, Interface
from ravemj.rave.joint import Joint
from ravemj.rave.kinbody.configuration import BodyConfiguration
from ravemj.rave.kinbody.state_saver import Restorer, StateSaver, body_restorers
from ravemj.rave.link import Link

if TYPE_CHECKING:
    from ravemj.rave.collision import CollisionChecker
    from ravemj.rave.environment import Environment
    from ravemj.rave.report import CollisionReport


class KinBody(BodyConfiguration, Interface):
    """Body of links connected by joints; ``env.GetBodies()`` returns the bodies.

    Grabbed bodies (``Grab``) move along, and belong to the body in collision checks.

    Example:
        >>> body.GetDOF()
        2
        >>> body.SetDOFValues([0.5, -0.5])
        >>> body.GetLink("Arm1").GetTransform()
    """

    _often_called = ("CheckSelfCollision",)

    _internal = (
        "active_dofs",
        "connect",
        "default_saved",
        "disconnect",
        "innermost_block",
        "moves_as_a_whole",
        "restorers",
        "set_following",
    )

    CheckLimitsAction = CheckLimitsAction
    Geometry = Geometry
    GeometryInfo = GeometryInfo
    Joint = Joint
    JointInfo = JointInfo
    JointType = JointType
    KinBodyInfo = KinBodyInfo
    Link = Link
    LinkInfo = LinkInfo
    KinBodyStateSaver = StateSaver
    SaveParameters = SaveParameters

    _interface_type = InterfaceType.kinbody
    default_saved = int(SaveParameters.LinkTransformation | SaveParameters.LinkEnable)

    def __init__(self, env: "Environment", state: BodyState) -> None:
        self._env = env
        self._state = state
        self._simulation = state.simulation
        self.annotations = Annotations()
        self.annotations.description = state.scene.description
        self.innermost_block: _SavedBody | None = None

    def SetName(self, name: str) -> None:
        """Set the ``name``.

        Raises:
            openrave_exception: the name is taken in the environment (``BodyNameConflict``), or empty.

        Example:
            >>> robot.SetName("swing")
            >>> env.GetRobot("swing") == robot
            True
        """
        self._simulation.rename(self._state, checked_kind(name or "", str, "SetName: name", "a text"))

    def IsRobot(self) -> bool:
        """Return whether the body is a robot."""
        return self._state.scene.is_robot

    def GetEnvironmentBodyIndex(self) -> int:
        """Return the body's index in its environment, from 1; 0 outside of an environment."""
        return self._state.index

    @also_named(reference="ref")
    def Clone(self, ref: "KinBody", cloningoptions: int = 0) -> None:
        """Copy another body, also from another environment: links, joints, name and configuration.

        Args:
            ref: The body to copy; grabbed bodies are not copied.
            cloningoptions: Not used.

        Raises:
            openrave_exception: this body is in an environment.
        """
        del cloningoptions
        original = checked_kind(ref, KinBody, "Clone: ref").simulation_state
        with both_locks(self._simulation, original.simulation):
            self._state.copy(original)

    def Destroy(self) -> None:
        """Remove the body from the environment, and delete its content except for the name."""
        with self._simulation.lock:
            self._env.Remove(self)
            self._state.rebuild(empty_body(self._state.scene))

    def connect(self) -> None:
        """Merge active connected bodies into a robot; the environment calls this before it adds the body."""

    def disconnect(self) -> None:
        """Remove the parts of connected bodies; the environment calls this after it has removed the body."""

    SetJointValues = BodyConfiguration.SetDOFValues
    GetJointValues = BodyConfiguration.GetDOFValues
    GetBodyTransformations = BodyConfiguration.GetLinkTransformations
    SetBodyTransformations = BodyConfiguration.SetLinkTransformations
    GetEnvironmentId = GetEnvironmentBodyIndex

    def CreateKinBodyStateSaver(self, options: int | None = None) -> StateSaver:
        """Save the body's state.

        Args:
            options: What to save, ``SaveParameters`` combined with ``|``; by default poses, joint values and enabled
                links.

        Returns:
            A saver. At the end of a ``with`` block it restores the state, also after an exception. Otherwise call
            ``Restore()``; deleting the saver does nothing.

        Example:
            >>> with body.CreateKinBodyStateSaver():
            ...     body.SetDOFValues([0.5, 0.5])
        """
        return StateSaver(self, options)

    def SetDOFTorques(self, torques: ArrayLike, add: bool = False) -> None:
        """Apply joint torques during the next simulation step only.

        They require a physics engine: ``env.SetPhysicsEngine("mujoco")``. Without one they have no effect.

        Args:
            torques: Torques [N m, for sliders N], shape (dof,).
            add: Whether to add to the torques that were set for that step; False replaces them.

        Raises:
            ArgumentError: the number of torques is wrong.

        Example:
            >>> robot.SetDOFTorques(robot.ComputeInverseDynamics([0, 0]))  # hold against gravity
            >>> env.StepSimulation(0.01)
        """
        checked, dof = checked_numbers(torques, "SetDOFTorques: torques"), self.GetDOF()
        if checked.shape != (dof,) or not np.isfinite(checked).all():
            message = f"SetDOFTorques: torques has shape {checked.shape}, and should be finite, of shape ({dof},)"
            raise ArgumentError(message, ErrorCode.Assert)
        with self._simulation.lock:
            loads = self._env.GetPhysicsEngine().loads(self._state)
            if loads is not None:
                loads.torques = checked + add * loads.torques

    SetJointTorques = SetDOFTorques

    def Grab(
        self,
        body: "KinBody",
        grablink: Link,
        linkstoignore: "Iterable[Link | int | str] | EllipsisType" = ...,
        grabbedUserData: object = ...,
    ) -> bool:
        """Grab a body with a link at their present relative pose: ``Grab(body, grablink)``, or with all four arguments.

        The body then moves with the link. Collisions with links that it touches now are ignored. Grabbing a body again
        updates link and pose.

        Args:
            body: The body to grab. It must be made for the same environment, but need not be in it.
            grablink: The link of this body that grabs the other.
            linkstoignore: Further links of this body whose collisions with the other are ignored.
            grabbedUserData: Not used; given together with ``linkstoignore``, as in OpenRAVE.

        Returns:
            True.

        Raises:
            TypeError: one of ``linkstoignore`` and ``grabbedUserData`` is given without the other.
            openrave_exception: this body is not in the environment (``NotInitialized``); the other one is None
                (``Failed``), of another environment, this body itself, or has grabbed this body (``InvalidArguments``).
        """
        if (linkstoignore is ...) != (grabbedUserData is ...):
            raise TypeError("Grab: takes links to ignore as Grab(body, grablink, linkstoignore, grabbedUserData)")
        with self._simulation.lock:
            if body is None:  # pyright: ignore[reportUnnecessaryComparison] - OpenRAVE has an error of its own
                raise ArgumentError("Grab: body is None, and should be a KinBody", ErrorCode.Failed)
            held = checked_kind(body, KinBody, "Grab: body").simulation_state
            check_holdable(self._state, held)
            link = self._own_link(grablink, "Grab")
            ignored = [] if linkstoignore is ... else [self._link_index(ignored_link) for ignored_link in linkstoignore]
            self._state.grab(grab_as_it_stands(self._state, held, link, ignored))
            return True

    def Release(self, body: "KinBody") -> None:
        """Release a body, which stays in place. If it is not grabbed, nothing happens."""
        held = checked_kind(body, KinBody, "Release: body").simulation_state
        with self._simulation.lock:
            self._state.release(held)

    def ReleaseAllGrabbed(self) -> None:
        """Release all grabbed bodies."""
        with self._simulation.lock:
            self._state.grabs = []

    def ReleaseAllGrabbedWithLink(self, grablink: Link) -> None:
        """Release all bodies grabbed by the link ``grablink``."""
        index = self._own_link(grablink, "ReleaseAllGrabbedWithLink")
        with self._simulation.lock:
            self._state.grabs = [grab for grab in self._state.grabs if grab.link != index]

    def CheckGrabbedInfo(
        self,
        body: "KinBody",
        grablink: Link,
        linkstoignore: "Iterable[Link | int | str] | None" = None,
        grabbedUserData: object = None,
    ) -> GrabbedInfoCheckResult:
        """Compare the grab of a body with given arguments of ``Grab``, and return the result.

        Args:
            body: The body.
            grablink: The expected grabbing link of this body.
            linkstoignore: The expected links to ignore; None skips this comparison.
            grabbedUserData: Not used.
        """
        del grabbedUserData
        held = checked_kind(body, KinBody, "CheckGrabbedInfo: body").simulation_state
        index = self._own_link(grablink, "CheckGrabbedInfo")
        grab = grab_of(self._state, held)
        if grab is None:
            return GrabbedInfoCheckResult.BodyNotGrabbed
        if grab.link != index:
            return GrabbedInfoCheckResult.GrabbingLinkNotMatch
        if (
            linkstoignore is not None
            and not {self._link_index(ignored_link) for ignored_link in linkstoignore} <= grab.ignored
        ):
            return GrabbedInfoCheckResult.IgnoredLinksNotMatch
        return GrabbedInfoCheckResult.Identical

    def RegrabAll(self) -> None:
        """Restore the relative poses of all grabbed bodies at the time of grabbing."""
        with self._simulation.lock:
            self._state.moved()

    def GetGrabbed(self) -> "list[KinBody]":
        """Return the grabbed bodies in the environment, in the order of grabbing."""
        return [self._env.wrap(grab.body) for grab in self._state.grabs if self._simulation.holds(grab.body)]

    def GetNumGrabbed(self) -> int:
        """Return the number of grabbed bodies."""
        return len(self._state.grabs)

    def IsGrabbing(self, body: "KinBody") -> Link | None:
        """Return the link that grabs a body, or None."""
        held = checked_kind(body, KinBody, "IsGrabbing: body").simulation_state
        grab = grab_of(self._state, held)
        return None if grab is None else Link(self._env.wrap(self._state), self._state, grab.link)

    def GetGrabbedInfo(self, grabbedname: str | None = None) -> list[GrabbedInfo] | GrabbedInfo | None:
        """Return the descriptions of grabs, for ``ResetGrabbed``.

        Args:
            grabbedname: The name of a body; returns its description, or None if it is not grabbed. By default a list of
                all.
        """
        infos = grabbed_infos(self._state)
        if grabbedname is None:
            return infos
        return next((info for info in infos if info._grabbedname == grabbedname), None)  # pyright: ignore[reportPrivateUsage] - OpenRAVE's field

    def ResetGrabbed(self, grabbedinfos: Sequence[GrabbedInfo]) -> None:
        """Replace all grabs by the described ones, each with its relative pose.

        Args:
            grabbedinfos: The descriptions, results of ``GetGrabbedInfo``.

        Raises:
            openrave_exception: a body or link does not exist. Nothing changes then.
        """
        with self._simulation.lock:
            infos = [checked_kind(info, GrabbedInfo, "ResetGrabbed: grabbedinfos") for info in grabbedinfos]
            self._state.grabs = [described_grab(self._state, info) for info in infos]
            self._state.moved()

    def GetAttached(self) -> "list[KinBody]":
        """Return this body and all bodies connected to it by grabs, directly or indirectly."""
        return [self._env.wrap(state) for state in self._simulation.attached(self._state)]

    def HasAttached(self) -> bool:
        """Return whether the body has grabbed others or is grabbed."""
        return len(self._simulation.attached(self._state)) > 1

    def GetAttachedEnvironmentBodyIndices(self) -> list[int]:
        """Return ``GetEnvironmentBodyIndex()`` of all bodies of ``GetAttached()``, in ascending order."""
        return sorted(state.index for state in self._simulation.attached(self._state))

    def IsAttached(self, body: "KinBody") -> bool:
        """Return whether a body is among ``GetAttached()``."""
        other = checked_kind(body, KinBody, "IsAttached: body").simulation_state
        return other in self._simulation.attached(self._state)

    def _link_index(self, link: Link | int | str) -> int:
        return link.GetIndex() if isinstance(link, Link) else link_index(self._state, link)

    def _own_link(self, link: Link, caller: str) -> int:
        if checked_kind(link, Link, f"{caller}: grablink").GetParent() != self:
            raise ArgumentError(f"{caller}: grablink is {link!r}, and should be a link of '{self.GetName()}'")
        return link.GetIndex()

    def restorers(self, options: int) -> list[Restorer]:
        """Return functions that restore the present state, on this body or on another body of the same structure.

        ``options`` are the parts of the state, ``SaveParameters`` combined.
        """
        return body_restorers(self._state, options)

    def __enter__(self) -> Self:
        """Lock the environment and save the body's state, which the end of the ``with`` block restores.

        The state consists of poses, joint values and enabled links; for a robot also of its active DOFs and active
        manipulator. Limits, velocities and grabs are not restored.

        Example:
            >>> with robot:
            ...     robot.SetDOFValues([0.5, 0.5])
            ...     hits = env.CheckCollision(robot)
        """
        saving = _SavedBody(self)
        try:
            saving.__enter__()
            return self
        except BaseException:
            saving.close()
            raise

    def _leave(self) -> Callable[..., object]:
        return Closing(self).__exit__

    __exit__ = exit_in_c(_leave)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, KinBody) and self._state is other._state

    def __hash__(self) -> int:
        return hash(id(self._state))

    def __repr__(self) -> str:
        return f"{self._env!r}.Get{'Robot' if self.IsRobot() else 'KinBody'}({self.GetName()!r})"

    def _repr_html_(self) -> str:
        from ravemj.rave.tables import body_table  # noqa: PLC0415 - html is slow to import

        return body_table(self)

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:  # noqa: ANN401 - IPython's
        """Print the table of the DOFs in IPython; ``repr`` names only the body."""
        from ravemj.rave.tables import body_text, print_pretty  # noqa: PLC0415 - html is slow to import

        del cycle
        print_pretty(printer, self, body_text(self))

    def __str__(self) -> str:
        kind = self._interface_type.name
        return f"<{kind}:{self.GetXMLId()} - {self.GetName()} ({self.GetKinematicsGeometryHash()})>"

    def __reduce__(self) -> tuple[Callable[[object], object], tuple[object]]:
        """Pickle the body with its environment."""
        if not self._state.index:
            message = f"'{self.GetName()}' cannot be pickled, since it is not in an environment; add it first"
            raise RavemjError(message, ErrorCode.InvalidState)
        return methodcaller("GetBodyFromEnvironmentBodyIndex", self._state.index), (self._env,)

    AdjacentOptions = AdjacentOptions

    _self_checker: "CollisionChecker | None" = None

    def CheckSelfCollision(
        self, report: "CollisionReport | None" = None, collisionchecker: "CollisionChecker | None" = None
    ) -> bool:
        """Return whether links of the body collide with each other or with grabbed bodies.

        Pairs of links are ignored if a joint connects them, if the file declares them ``<adjacent>``, or if they
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
        """Set the checker of ``CheckSelfCollision``; ``collisionchecker`` None selects the environment's checker."""
        if collisionchecker is not None:
            _check_checker(collisionchecker, "SetSelfCollisionChecker")
        self._self_checker = collisionchecker

    def GetSelfCollisionChecker(self) -> "CollisionChecker | None":
        """Return the checker of ``SetSelfCollisionChecker``, or None."""
        return self._self_checker

    def active_dofs(self) -> tuple[int, ...]:
        """Return the DOF indices of the active joints of a robot; for any other body, all DOFs."""
        return tuple(range(self.GetDOF()))

    def moves_as_a_whole(self) -> bool:
        """Return whether affine DOFs are active, which move the whole body; only robots can have them."""
        return False

    def Enable(self, enable: bool) -> None:
        """Enable collisions of all links if ``enable``, else disable them."""
        self._state.link_enabled = [bool(enable)] * len(self._state.link_enabled)

    def IsEnabled(self) -> bool:
        """Return whether any link takes part in collision checks."""
        return any(self._state.link_enabled)

    def GetLinkEnableStates(self) -> NDArray[np.uint8]:
        """Return for each link 1 if it is enabled, else 0, shape (links,)."""
        return np.array(self._state.link_enabled, dtype=np.uint8)

    def SetLinkEnableStates(self, enablestates: ArrayLike) -> None:
        """Enable and disable links: ``enablestates`` has a boolean for each link, shape (links,)."""
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
        wanted = "pairs: the link indices of a pair"
        for pair in (checked_whole_numbers(pair, wanted).tolist() for pair in pairs):
            if len(pair) != 2:
                raise ArgumentError(f"{wanted} are {pair}, and should be two")
            first, second = pair
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
        """Declare the current configuration free of self-collisions: links that touch now are excluded from tests."""
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
            openrave_exception: the number of lists differs from the number of links, or a description is invalid.
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
        """Return the link poses, shape (links, 4, 4); ``T_world_body`` replaces the present pose of the first link."""
        with self._simulation.lock:
            poses = self._state.link_transforms()
        return poses if T_world_body is None or not len(poses) else T_world_body @ inverse(poses[0]) @ poses

    def _bounds(self, poses: Floats, enabled_only: bool) -> AABB:
        enabled = self._state.link_enabled
        bounds = self._state.bounds.at(poses, enabled if enabled_only else (True,) * len(enabled))
        return enclosing_box(bounds, poses[0] if len(poses) else np.eye(4))


class _SavedBody(Block["KinBody"]):
    """Context manager for ``with body:``, which restores the body's state."""

    def __init__(self, body: KinBody) -> None:
        super().__init__(self._run(body))

    def _run(self, body: KinBody) -> Generator[KinBody]:
        with body.GetEnv().simulation.lock:
            saver, outer = StateSaver(body, None), body.innermost_block
            with restoring(saver.Restore):
                try:
                    body.innermost_block = self
                    yield body
                finally:
                    body.innermost_block = outer


def _check_checker(checker: object, caller: str) -> None:
    if getattr(checker, "GetInterfaceType", lambda: None)() is not InterfaceType.collisionchecker:
        given = f"is of type {type(checker).__name__}, and should be CollisionChecker"
        raise ArgumentError(f"{caller}: collisionchecker: {given}")


def link_index(state: BodyState, link: int | str) -> int:
    """Return the index of a link, given by its index or its name.

    Raises:
        ArgumentError: the body has no such link.
    """
    names = [scene_link.name for scene_link in state.scene.links]
    if isinstance(link, str) and link in names:
        return names.index(link)
    if isinstance(link, str) or not 0 <= link < len(names):
        raise ArgumentError(f"'{state.scene.name}' has no link {link!r}")
    return link


def check_holdable(state: BodyState, held: BodyState) -> None:
    """Check that a body can grab another one.

    Raises:
        RavemjError: the body is not in its environment; or the other body was made for another environment, or has
            grabbed this one.
    """
    if not state.simulation.holds(state):
        message = f"Grab: '{state.scene.name}' is not in this environment; add it first"
        raise RavemjError(message, ErrorCode.NotInitialized)
    if held.simulation is not state.simulation:
        raise ArgumentError(f"Grab: '{held.scene.name}' was made for another environment")
    _check_not_carried_by(state, held)


def _check_not_carried_by(state: BodyState, held: BodyState) -> None:
    if held.carries(state):
        reason = "itself" if held is state else f"'{held.scene.name}', by which it is held itself"
        raise ArgumentError(f"Grab: '{state.scene.name}' cannot hold {reason}")


def grab_of(state: BodyState, held: BodyState) -> GrabbedBody | None:
    """Return the grab of a held body, or None."""
    return next((grab for grab in state.grabs if grab.body is held), None)


def grabbed_infos(state: BodyState) -> list[GrabbedInfo]:
    """Return the infos of all grabs of a body, for ``ResetGrabbed``."""
    return [GrabbedInfo.of(state.scene, grab) for grab in state.grabs]


def described_grab(state: BodyState, info: GrabbedInfo) -> GrabbedBody:
    """Return the grab described by an info.

    Raises:
        ArgumentError: the body to grab or a link does not exist, or the body to grab has grabbed this one.
    """
    held = state.simulation.body(info._grabbedname)
    if held is None:
        raise ArgumentError(f"ResetGrabbed: there is no body '{info._grabbedname}' in the environment")
    _check_not_carried_by(state, held)
    ignored = frozenset(link_index(state, name) for name in info._setIgnoreRobotLinkNames)
    link = link_index(state, info._robotlinkname)
    return GrabbedBody(held, link, np.array(info._trelative, dtype=float), ignored)
