"""Bodies."""

from typing import TYPE_CHECKING

from ravemj.engine.simulation import BodyState
from ravemj.rave.body.base import both_locks
from ravemj.rave.body.building import Building
from ravemj.rave.body.collision import BodyCollision
from ravemj.rave.body.dynamics import Motion
from ravemj.rave.body.grabbing import Grabbing
from ravemj.rave.body.graph import Graph
from ravemj.rave.body.limits import Limits
from ravemj.rave.body.saving import Saving, StateSaver
from ravemj.rave.body.substance import Substance
from ravemj.rave.body.torques import Torques
from ravemj.rave.configured import Configured
from ravemj.rave.enums import CheckLimitsAction, InterfaceType, JointType, SaveParameters
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo, JointInfo, KinBodyInfo, LinkInfo
from ravemj.rave.interface import checked_kind
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class KinBody(Saving, Configured, Grabbing, BodyCollision, Limits, Graph, Substance, Motion, Torques, Building):
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

    def __init__(self, env: "Environment", state: BodyState) -> None:
        super().__init__(env, state)
        self._open_savers = []

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

    def Clone(self, reference: "KinBody", cloningoptions: int = 0) -> None:
        """Become like another body, which may be in another environment: links, joints, name and configuration.

        Args:
            reference: The body to copy; what it holds is not copied.
            cloningoptions: OpenRAVE's; ignored.

        Raises:
            openrave_exception: this body is in an environment.
        """
        del cloningoptions
        original = checked_kind(reference, KinBody, "Clone: reference").simulation_state
        with both_locks(self._simulation, original.simulation):
            self._state.copy(original)

    GetEnvironmentId = GetEnvironmentBodyIndex

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
