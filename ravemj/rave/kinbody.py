"""Bodies."""

from collections.abc import Callable, Generator, Iterable, Sequence
from types import EllipsisType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.core.blocks import Block, Closing, exit_in_c, restoring
from ravemj.engine.grabbing import grab_as_it_stands
from ravemj.engine.simulation import BodyState, both_locks
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.model.shape_bodies import empty_body
from ravemj.rave.body.building import Building
from ravemj.rave.body.collision import BodyCollision
from ravemj.rave.body.configuration import Configuration
from ravemj.rave.body.dynamics import Dynamics
from ravemj.rave.body.grabbing import check_holdable, described_grab, grab_of, grabbed_infos, link_index
from ravemj.rave.body.saving import Restorer, StateSaver, body_restorers
from ravemj.rave.enums import CheckLimitsAction, GrabbedInfoCheckResult, InterfaceType, JointType, SaveParameters
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo, GrabbedInfo, JointInfo, KinBodyInfo, LinkInfo
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link
from ravemj.rave.user_data import Annotations

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class KinBody(Building, BodyCollision, Dynamics, Configuration):
    """A body: links connected by joints. ``env.GetBodies()`` makes it.

    What it holds (``Grab``) moves along, and counts as part of it for collision.

    Example:
        >>> body.GetDOF()
        2
        >>> body.SetDOFValues([0.5, -0.5])
        >>> body.GetLink("Arm1").GetTransform()
    """

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
    _internal = ("connect", "default_saved", "disconnect", "innermost_block", "restorers", "set_following")
    default_saved = int(SaveParameters.LinkTransformation | SaveParameters.LinkEnable)

    def __init__(self, env: "Environment", state: BodyState) -> None:
        self._env = env
        self._state = state
        self._simulation = state.simulation
        self.annotations = Annotations()
        self.annotations.description = state.scene.description
        self.innermost_block: _Saving | None = None

    def SetName(self, name: str) -> None:
        """Give the body another name.

        Raises:
            openrave_exception: another body of the environment has it (``BodyNameConflict``), or it is empty.

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
        """Return the body's number in its environment, from 1; 0 while it is not added."""
        return self._state.index

    @also_named(reference="ref")
    def Clone(self, ref: "KinBody", cloningoptions: int = 0) -> None:
        """Copy another body, which may be in another environment: its links, joints, name and configuration.

        Args:
            ref: The body to copy; what it holds is not copied.
            cloningoptions: OpenRAVE's; ignored.

        Raises:
            openrave_exception: this body is in an environment.
        """
        del cloningoptions
        original = checked_kind(ref, KinBody, "Clone: ref").simulation_state
        with both_locks(self._simulation, original.simulation):
            self._state.copy(original)

    def Destroy(self) -> None:
        """Take the body out of the environment, and leave nothing of it but its name."""
        with self._simulation.lock:
            self._env.Remove(self)
            self._state.rebuild(empty_body(self._state.scene))

    def connect(self) -> None:
        """Make active connected bodies parts of a robot; the environment calls this before it adds the body."""

    def disconnect(self) -> None:
        """Take the parts of connected bodies away; the environment calls this after it removed the body."""

    SetJointValues = Configuration.SetDOFValues
    GetBodyTransformations = Configuration.GetLinkTransformations
    SetBodyTransformations = Configuration.SetLinkTransformations
    GetEnvironmentId = GetEnvironmentBodyIndex

    def CreateKinBodyStateSaver(self, options: int | None = None) -> StateSaver:
        """Save the body's state.

        Args:
            options: What to save, ``SaveParameters`` combined with ``|``; None: poses, joint values and enabled links.

        Returns:
            A saver: ``with`` it, the state comes back at the end of the block, also after an exception. Otherwise
            ``Restore()`` brings it back; dropping it does nothing.

        Example:
            >>> with body.CreateKinBodyStateSaver():
            ...     body.SetDOFValues([0.5, 0.5])
        """
        return StateSaver(self, options)

    def SetDOFTorques(self, torques: ArrayLike, add: bool = False) -> None:
        """Let torques act on the joints during the next step of simulation time, and not longer.

        They need a physics engine: ``env.SetPhysicsEngine("mujoco")``. Without one they do nothing.

        Args:
            torques: Torques [N m, for sliders N], shape (dof,).
            add: Whether torques that were set for that step stay.

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
            if body is None:  # pyright: ignore[reportUnnecessaryComparison] - OpenRAVE has an error of its own
                raise ArgumentError("Grab: body is None, and should be a KinBody", ErrorCode.Failed)
            held = checked_kind(body, KinBody, "Grab: body").simulation_state
            check_holdable(self._state, held)
            link = self._own_link(grablink, "Grab")
            ignored = [] if linkstoignore is ... else [self._link_index(one) for one in linkstoignore]
            self._state.grab(grab_as_it_stands(self._state, held, link, ignored))
            return True

    def Release(self, body: "KinBody") -> None:
        """Let go of a body; it stays where it is. Nothing happens if it is not held."""
        held = checked_kind(body, KinBody, "Release: body").simulation_state
        with self._simulation.lock:
            self._state.release(held)

    def ReleaseAllGrabbed(self) -> None:
        """Let go of all held bodies."""
        with self._simulation.lock:
            self._state.grabs = []

    def ReleaseAllGrabbedWithLink(self, grablink: Link) -> None:
        """Let go of all bodies that the link ``grablink`` holds."""
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
        """Return whether a body is held in a way, as ``Grab`` would hold it.

        Args:
            body: The body.
            grablink: The link of this body that should hold it.
            linkstoignore: The links that it should not collide with; None: they are not compared.
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
        held = checked_kind(body, KinBody, "IsGrabbing: body").simulation_state
        grab = grab_of(self._state, held)
        return None if grab is None else Link(self._env.wrap(self._state), self._state, grab.link)

    def GetGrabbedInfo(self, grabbedname: str | None = None) -> "list[GrabbedInfo] | GrabbedInfo | None":
        """Return how bodies are held, for ``ResetGrabbed``.

        Args:
            grabbedname: Return that of one body, or None if it is not held; left out: a list of all.
        """
        infos = grabbed_infos(self._state)
        if grabbedname is None:
            return infos
        return next((info for info in infos if info._grabbedname == grabbedname), None)  # pyright: ignore[reportPrivateUsage] - OpenRAVE's field

    def ResetGrabbed(self, grabbedinfos: Sequence[GrabbedInfo]) -> None:
        """Hold the bodies that the infos of ``GetGrabbedInfo`` name, each in the pose that it had, and no others.

        Args:
            grabbedinfos: What ``GetGrabbedInfo`` returned.

        Raises:
            openrave_exception: a body or link is not there. Nothing has changed then.
        """
        with self._simulation.lock:
            infos = [checked_kind(info, GrabbedInfo, "ResetGrabbed: grabbedinfos") for info in grabbedinfos]
            self._state.grabs = [described_grab(self._state, info) for info in infos]
            self._state.moved()

    def GetAttached(self) -> "list[KinBody]":
        """Return this body, those that it holds, those that hold it, and so on."""
        return [self._env.wrap(state) for state in self._simulation.attached(self._state)]

    def HasAttached(self) -> bool:
        """Return whether the body holds others or is held."""
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
        """Return what gives this body, or one like it, its present state back."""
        return body_restorers(self._state, options)

    def __enter__(self) -> Self:
        """Lock the environment and save the body: poses, joint values and enabled links come back at the end.

        A robot's active DOFs and active manipulator come back as well. Limits, velocities and what it holds do not.

        Example:
            >>> with robot:
            ...     robot.SetDOFValues([0.5, 0.5])
            ...     hits = env.CheckCollision(robot)
        """
        saving = _Saving(self)
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
        """Return the tables that notebooks show for a body."""
        from ravemj.rave.tables import body_table  # noqa: PLC0415 - html is slow to import

        return body_table(self)

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:  # noqa: ANN401 - IPython's
        """Print the table of the DOFs in IPython, where ``repr`` would name the body alone."""
        from ravemj.rave.tables import body_text, print_pretty  # noqa: PLC0415 - html is slow to import

        del cycle
        print_pretty(printer, self, body_text(self))

    def __str__(self) -> str:
        kind = self._interface_type.name
        return f"<{kind}:{self.GetXMLId()} - {self.GetName()} ({self.GetKinematicsGeometryHash()})>"


class _Saving(Block["KinBody"]):
    """The block of ``with body:``."""

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
