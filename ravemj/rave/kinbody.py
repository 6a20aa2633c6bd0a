"""Bodies."""

from types import TracebackType
from typing import TYPE_CHECKING, Self

from ravemj.core.arguments import also_named, checked_kind
from ravemj.engine.simulation import BodyState
from ravemj.model.shape_bodies import empty_body
from ravemj.rave.body.base import both_locks
from ravemj.rave.body.building import Building
from ravemj.rave.body.collision import BodyCollision
from ravemj.rave.body.configuration import Configuration
from ravemj.rave.body.dynamics import Dynamics
from ravemj.rave.body.geometry_groups import GeometryGroups
from ravemj.rave.body.grabbing import Grabbing
from ravemj.rave.body.limits import Limits
from ravemj.rave.body.saving import Restorer, StateSaver, body_restorers
from ravemj.rave.body.velocities import Velocities
from ravemj.rave.enums import CheckLimitsAction, InterfaceType, JointType, SaveParameters
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo, JointInfo, KinBodyInfo, LinkInfo
from ravemj.rave.interface import Annotations
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class KinBody(Building, GeometryGroups, Grabbing, BodyCollision, Velocities, Dynamics, Limits, Configuration):
    """A body: links connected by joints. ``env.GetBodies()`` makes it.

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
    _internal = ("default_saved", "restorers", "set_following")
    default_saved = int(SaveParameters.LinkTransformation | SaveParameters.LinkEnable)

    def __init__(self, env: "Environment", state: BodyState) -> None:
        self._env = env
        self._state = state
        self._simulation = state.simulation
        self._annotations = Annotations()
        self._open_savers: list[StateSaver] = []

    def SetName(self, name: str) -> None:
        """Give the body another name.

        Raises:
            openrave_exception: another body of the environment has it (``BodyNameConflict``), or it is empty.

        Example:
            >>> robot.SetName("swing")
            >>> env.GetRobot("swing") == robot
            True
        """
        self._simulation.rename(self._state, name)

    def IsRobot(self) -> bool:
        """Return whether the body is a robot."""
        return self._state.scene.is_robot

    def GetEnvironmentBodyIndex(self) -> int:
        """Return the body's number in its environment, from 1; 0 while it is not added."""
        return self._state.index

    @also_named(reference="ref")
    def Clone(self, ref: "KinBody", cloningoptions: int = 0) -> None:
        """Become like another body, which may be in another environment: links, joints, name and configuration.

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
        self._simulation.lock.acquire()
        self._open_savers.append(StateSaver(self, None))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Restore the body, and let go of the lock."""
        try:
            self._open_savers.pop().Restore()
        finally:
            self._simulation.lock.release()

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

    def __str__(self) -> str:
        kind = self._interface_type.name
        return f"<{kind}:{self.GetXMLId()} - {self.GetName()} ({self.GetKinematicsGeometryHash()})>"
