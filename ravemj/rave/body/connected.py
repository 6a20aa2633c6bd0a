"""The bodies that can be connected to a robot."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, cast

from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.body.active import ActiveChoice
from ravemj.rave.body.building import Building
from ravemj.rave.connected_body import ConnectedBody
from ravemj.rave.infos import ConnectedBodyInfo, GripperInfo, KinBodyInfo, RobotBaseInfo
from ravemj.rave.infos.connecting import with_connected

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot


class Connected(Building):
    """Connected bodies: bodies that are parts of the robot while they are active and it is in an environment."""

    active_choice: ActiveChoice
    _grippers: tuple[GripperInfo, ...]
    _connected: tuple[ConnectedBody, ...] = ()
    _own_parts: RobotBaseInfo | None = None
    """The description of the robot alone, while connected bodies are parts of it."""

    def GetConnectedBodies(self) -> list[ConnectedBody]:
        """Return the bodies that can be connected, active or not."""
        return list(self._connected)

    def GetConnectedBody(self, bodyname: str) -> ConnectedBody | None:
        """Return the connected body of a name, or None.

        Args:
            bodyname: The name.
        """
        return next((body for body in self._connected if body.GetName() == bodyname), None)

    def GetConnectedBodyActiveStates(self) -> list[int]:
        """Return for each connected body whether it is active: 1, or 0 for no, -1 for undecided."""
        return [body.IsActive() for body in self._connected]

    def SetConnectedBodyActiveStates(self, activestates: Sequence[int]) -> None:
        """Set for each connected body whether it is active; see ``ConnectedBody.SetActive``.

        Args:
            activestates: As many states as there are connected bodies.
        """
        if len(activestates) != len(self._connected):
            message = f"SetConnectedBodyActiveStates: {len(activestates)} states for {len(self._connected)} bodies"
            raise ArgumentError(message)
        for body, active in zip(self._connected, activestates, strict=True):
            body.SetActive(active)

    def AddConnectedBody(self, connectedbodyinfo: ConnectedBodyInfo, removeduplicate: bool = False) -> ConnectedBody:
        """Add a body that can be connected. If it is active, the next ``env.Add`` makes it a part of the robot.

        Args:
            connectedbodyinfo: The description of the body.
            removeduplicate: Whether it replaces a connected body of the same name.

        Returns:
            The body.

        Raises:
            openrave_exception: the robot is in an environment (``InvalidState``); or the description has no name, has
                the name of another connected body, or names no link of the robot.

        Example:
            >>> env.Remove(robot)
            True
            >>> tool = robot.AddConnectedBody(info)
            >>> tool.SetActive(True)
            True
            >>> env.Add(robot)
        """
        info = checked_kind(connectedbodyinfo, ConnectedBodyInfo, "AddConnectedBody: connectedbodyinfo")
        self._check_removed("AddConnectedBody")
        if not info._name or (self.GetConnectedBody(info._name) is not None and not removeduplicate):
            problem = f"has a connected body '{info._name}' already" if info._name else "needs a name for the body"
            raise ArgumentError(f"AddConnectedBody: '{self.GetName()}' {problem}; set another _name")
        if info._linkname not in {link.name for link in self._state.scene.links}:
            raise ArgumentError(f"AddConnectedBody: '{self.GetName()}' has no link '{info._linkname}'")
        added = ConnectedBody(cast("Robot", self), info)
        self._connected = (*(body for body in self._connected if body.GetName() != info._name), added)
        return added

    def RemoveConnectedBody(self, connectedbody: ConnectedBody) -> bool:
        """Remove a body that can be connected, and return whether the robot had it.

        Args:
            connectedbody: The body.

        Raises:
            openrave_exception: the robot is in an environment (``InvalidState``).
        """
        self._check_removed("RemoveConnectedBody")
        before = len(self._connected)
        self._connected = tuple(body for body in self._connected if body is not connectedbody)
        return len(self._connected) < before

    def InitFromKinBodyInfo(self, info: KinBodyInfo) -> bool:
        """Replace the robot, including its name, by the one of a description.

        Args:
            info: The description, for instance a result of ``ExtractInfo``. A ``RobotBaseInfo`` has grippers and
                connected bodies as well.

        Returns:
            True.
        """
        super().InitFromKinBodyInfo(info)
        if isinstance(info, RobotBaseInfo):
            self._grippers = tuple(info._vGripperInfos)
            self._connected = tuple(ConnectedBody(cast("Robot", self), one) for one in info._vConnectedBodyInfos)
        return True

    def connect(self) -> None:
        """Make the active connected bodies parts of the robot. The environment calls this before it adds the robot."""
        active = [body.GetInfo() for body in self._connected if body.IsActive() == 1]
        if active and self._own_parts is None:
            own = cast("Robot", self).ExtractInfo()
            self._remake(with_connected(own, active))
            self._own_parts = own

    def disconnect(self) -> None:
        """Remove the parts of connected bodies. The environment calls this after it has removed the robot."""
        if self._own_parts is not None:
            own = cast("Robot", self).ExtractInfo()
            self._own_parts = None
            self._remake(own)

    def _remake(self, info: RobotBaseInfo) -> None:
        super().InitFromKinBodyInfo(replace(info, _uri=self._uri, _id=self._id))
        self._grippers = tuple(info._vGripperInfos)
        self.active_choice = ActiveChoice()

    def _check_removed(self, caller: str) -> None:
        if self._state.index:
            message = f"{caller}: '{self.GetName()}' is in an environment; remove it first"
            raise RavemjError(message, ErrorCode.InvalidState)
