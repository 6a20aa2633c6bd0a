"""Bodies that hold others."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Iterable, Sequence
from types import EllipsisType
from typing import TYPE_CHECKING

import numpy as np

from ravemj.core.arguments import checked_kind
from ravemj.engine.grabbing import attached_bodies, grab_as_it_stands
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.body.base import BodyPart
from ravemj.rave.enums import GrabbedInfoCheckResult
from ravemj.rave.infos import GrabbedInfo
from ravemj.rave.interface import Interface
from ravemj.rave.link import Link

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Grabbing(BodyPart, Interface):
    """Holds other bodies: they move along, and count as part of this one for collision."""

    def Grab(
        self,
        body: "KinBody",
        grablink: Link,
        linkstoignore: "Iterable[Link | int | str] | EllipsisType" = ...,
        grabbedUserData: object = ...,
    ) -> bool:
        """Hold a body by a link, in the pose that both have now: ``Grab(body, grablink)``, or with all four arguments.

        From now on it moves with the link. It does not collide with the links that it touches now. Grabbing a body
        that is held already renews link and pose.

        Args:
            body: What to hold; it was made for the same environment, and need not be in it.
            grablink: The link of this body that holds it.
            linkstoignore: Further links of this body that it should not collide with.
            grabbedUserData: Goes with ``linkstoignore``, as in OpenRAVE, which keeps it; not used.

        Returns:
            True.

        Raises:
            TypeError: one of ``linkstoignore`` and ``grabbedUserData`` is given without the other (gap-20).
            openrave_exception: this body is not in the environment (``NotInitialized``); the other one is None
                (``Failed``), of another environment, this body itself, or holds this body (``InvalidArguments``).
        """
        if (linkstoignore is ...) != (grabbedUserData is ...):
            raise TypeError("Grab: takes links to ignore as Grab(body, grablink, linkstoignore, grabbedUserData)")
        with self._simulation.lock:
            self._check_holdable(body)
            link = self._own_link(grablink, "Grab")
            held = body.simulation_state
            ignored = [] if linkstoignore is ... else [self._link_index(one) for one in linkstoignore]
            self._state.grab(grab_as_it_stands(self._state, held, link, ignored))
            return True

    def _check_holdable(self, body: "KinBody | None") -> None:
        if body is None:
            raise ArgumentError("Grab: body is None, and should be a KinBody", ErrorCode.Failed)
        held = checked_kind(body, BodyPart, "Grab: body", "a KinBody").simulation_state
        if not self._simulation.holds(self._state):
            message = f"Grab: '{self.GetName()}' is not in this environment; add it first"
            raise RavemjError(message, ErrorCode.NotInitialized)
        if held.simulation is not self._simulation:
            raise ArgumentError(f"Grab: '{held.scene.name}' was made for another environment")
        self._check_not_carried_by(held)

    def _check_not_carried_by(self, held: BodyState) -> None:
        if held.carries(self._state):
            name = held.scene.name
            raise ArgumentError(f"Grab: '{self.GetName()}' cannot hold '{name}', by which it is held itself")

    def _link_index(self, link: Link | int | str) -> int:
        if isinstance(link, Link):
            return link.GetIndex()
        names = [one.name for one in self._state.scene.links]
        if isinstance(link, str) and link in names:
            return names.index(link)
        if isinstance(link, str) or not 0 <= link < len(names):
            raise ArgumentError(f"'{self.GetName()}' has no link {link!r}")
        return link

    def Release(self, body: "KinBody") -> None:
        """Let go of a body; it stays where it is. Nothing happens if it is not held."""
        held = checked_kind(body, BodyPart, "Release: body", "a KinBody").simulation_state
        with self._simulation.lock:
            self._state.release(held)

    def ReleaseAllGrabbed(self) -> None:
        """Let go of all held bodies."""
        with self._simulation.lock:
            self._state.grabs = []

    def ReleaseAllGrabbedWithLink(self, grablink: Link) -> None:
        """Let go of all bodies that one link holds.

        Args:
            grablink: The link.
        """
        index = self._own_link(grablink, "ReleaseAllGrabbedWithLink")
        with self._simulation.lock:
            self._state.grabs = [grab for grab in self._state.grabs if grab.link != index]

    def _own_link(self, link: Link, caller: str) -> int:
        if checked_kind(link, Link, f"{caller}: grablink").GetParent() != self:
            raise ArgumentError(f"{caller}: grablink is {link!r}, and should be a link of '{self.GetName()}'")
        return link.GetIndex()

    def CheckGrabbedInfo(
        self,
        body: "KinBody",
        grablink: Link,
        linkstoignore: "Iterable[Link | int | str] | None" = None,
        grabbedUserData: object = None,
    ) -> GrabbedInfoCheckResult:
        """Return whether a body is held in a way, as ``Grab`` would hold it.

        Args:
            body: The body.
            grablink: The link of this body that should hold it.
            linkstoignore: The links that it should not collide with; None: they are not compared.
            grabbedUserData: Not used.
        """
        del grabbedUserData
        held = checked_kind(body, BodyPart, "CheckGrabbedInfo: body", "a KinBody").simulation_state
        index = self._own_link(grablink, "CheckGrabbedInfo")
        grab = next((one for one in self._state.grabs if one.body is held), None)
        if grab is None:
            return GrabbedInfoCheckResult.BodyNotGrabbed
        if grab.link != index:
            return GrabbedInfoCheckResult.GrabbingLinkNotMatch
        if linkstoignore is not None and not {self._link_index(one) for one in linkstoignore} <= grab.ignored:
            return GrabbedInfoCheckResult.IgnoredLinksNotMatch
        return GrabbedInfoCheckResult.Identical

    def RegrabAll(self) -> None:
        """Put all held bodies back where they were grabbed, relative to their links."""
        with self._simulation.lock:
            self._state.moved()

    def GetGrabbed(self) -> "list[KinBody]":
        """Return the held bodies that are in the environment, in the order of grabbing."""
        return [self._env.wrap(grab.body) for grab in self._state.grabs if self._simulation.holds(grab.body)]

    def GetNumGrabbed(self) -> int:
        """Return the number of held bodies."""
        return len(self._state.grabs)

    def IsGrabbing(self, body: "KinBody") -> Link | None:
        """Return the link that holds a body, or None."""
        held = checked_kind(body, BodyPart, "IsGrabbing: body", "a KinBody").simulation_state
        grab = next((one for one in self._state.grabs if one.body is held), None)
        return None if grab is None else Link(self._env.wrap(self._state), self._state, grab.link)

    def GetGrabbedInfo(self, grabbedname: str | None = None) -> "list[GrabbedInfo] | GrabbedInfo | None":
        """Return how bodies are held, for ``ResetGrabbed``.

        Args:
            grabbedname: Return that of one body, or None if it is not held; left out: a list of all.
        """
        links = [link.name for link in self._state.scene.links]
        infos = [
            GrabbedInfo(
                grab.body.scene.name, links[grab.link], grab.T_link_body.copy(), sorted(links[i] for i in grab.ignored)
            )
            for grab in self._state.grabs
        ]
        if grabbedname is None:
            return infos
        return next((info for info in infos if info._grabbedname == grabbedname), None)

    def ResetGrabbed(self, grabbedinfos: Sequence[GrabbedInfo]) -> None:
        """Hold the bodies that the infos of ``GetGrabbedInfo`` name, each in the pose that it had, and no others.

        Args:
            grabbedinfos: What ``GetGrabbedInfo`` returned.

        Raises:
            openrave_exception: a body or link is not there. Nothing has changed then.
        """
        with self._simulation.lock:
            infos = [checked_kind(info, GrabbedInfo, "ResetGrabbed: grabbedinfos") for info in grabbedinfos]
            self._state.grabs = [self._grab_of(info) for info in infos]
            self._state.moved()

    def _grab_of(self, info: GrabbedInfo) -> GrabbedBody:
        body = self._simulation.body(info._grabbedname)
        if body is None:
            raise ArgumentError(f"ResetGrabbed: there is no body '{info._grabbedname}' in the environment")
        self._check_not_carried_by(body)
        ignored = frozenset(self._link_index(name) for name in info._setIgnoreRobotLinkNames)
        return GrabbedBody(body, self._link_index(info._robotlinkname), np.array(info._trelative, dtype=float), ignored)

    def GetAttached(self) -> "list[KinBody]":
        """Return this body, those that it holds, those that hold it, and so on."""
        return [self._env.wrap(state) for state in attached_bodies(self._state)]

    def HasAttached(self) -> bool:
        """Return whether the body holds others or is held."""
        return len(attached_bodies(self._state)) > 1

    def GetAttachedEnvironmentBodyIndices(self) -> list[int]:
        """Return ``GetEnvironmentBodyIndex()`` of all bodies of ``GetAttached()``, in ascending order."""
        return sorted(state.index for state in attached_bodies(self._state))

    def IsAttached(self, body: "KinBody") -> bool:
        """Return whether a body is among ``GetAttached()``."""
        other = checked_kind(body, BodyPart, "IsAttached: body", "a KinBody").simulation_state
        return other in attached_bodies(self._state)
