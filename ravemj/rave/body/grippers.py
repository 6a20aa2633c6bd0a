"""Descriptions of grippers, and bodies that can be connected to a robot."""

from typing import NoReturn

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.rave.body.base import BodyPart
from ravemj.rave.infos import ConnectedBodyInfo, GripperInfo

CONNECTED = "connected bodies"


class ConnectedBody(ApiObject):
    """A body that is connected to a robot; ravemj has none yet."""

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise UnsupportedError("ConnectedBody", CONNECTED)


def _refuse(name: str) -> object:
    def refuse(self: object, *arguments: object) -> NoReturn:
        raise UnsupportedError(f"ConnectedBody.{name}", CONNECTED)

    refuse.__name__ = name
    refuse.__doc__ = "Refuse to return anything: ravemj connects no bodies yet, and raises ``UnsupportedError``."
    return refuse


for _name in (
    *("CanProvideManipulator", "GetId", "GetInfo", "GetInfoHash", "GetName", "GetRelativeTransform"),
    *("GetRelativeTransformPose", "GetResolvedAttachedSensors", "GetResolvedGripperInfos", "GetResolvedJoints"),
    *("GetResolvedLinks", "GetResolvedManipulators", "GetTransform", "GetTransformPose", "IsActive", "SetActive"),
    *("SetLinkEnable", "SetLinkVisible"),
):
    setattr(ConnectedBody, _name, _refuse(_name))


class Grippers(BodyPart):
    """Descriptions of a robot's grippers, which manipulators name; they are only kept."""

    _grippers: tuple[GripperInfo, ...] = ()

    def GetGripperInfos(self) -> list[GripperInfo]:
        """Return the descriptions of the grippers."""
        return list(self._grippers)

    def GetGripperInfo(self, name: str) -> GripperInfo | None:
        """Return the description of a gripper, or None.

        Args:
            name: Its name.
        """
        return next((info for info in self._grippers if info._name == name), None)  # pyright: ignore[reportPrivateUsage] - OpenRAVE's field

    def AddGripperInfo(self, gripperInfo: GripperInfo, removeduplicate: bool = False) -> bool:
        """Add the description of a gripper.

        Args:
            gripperInfo: The description.
            removeduplicate: Whether it replaces one of the same name.

        Returns:
            True.

        Raises:
            openrave_exception: there is one of that name, or it has none. Nothing has changed then.
        """
        name = checked_kind(gripperInfo, GripperInfo, "AddGripperInfo: gripperInfo")._name  # pyright: ignore[reportPrivateUsage] - as above
        if not name or (self.GetGripperInfo(name) is not None and not removeduplicate):
            raise ArgumentError(f"AddGripperInfo: a gripper cannot be called '{name}': that is empty, or taken")
        self.RemoveGripperInfo(name)
        self._grippers = (*self._grippers, gripperInfo)
        return True

    def RemoveGripperInfo(self, name: str) -> bool:
        """Forget the description of a gripper; return whether it was there.

        Args:
            name: Its name.
        """
        gone = self.GetGripperInfo(name)
        self._grippers = tuple(info for info in self._grippers if info is not gone)
        return gone is not None

    def GetConnectedBodies(self) -> list[ConnectedBody]:
        """Return the connected bodies: none."""
        return []

    def GetConnectedBody(self, bodyname: str) -> None:
        """Return the connected body of a name: None.

        Args:
            bodyname: The name.
        """

    def GetConnectedBodyActiveStates(self) -> list[int]:
        """Return for each connected body whether it is active: an empty list."""
        return []

    def SetConnectedBodyActiveStates(self, activestates: list[int]) -> None:
        """Accept no states, since there are no connected bodies.

        Args:
            activestates: An empty list.

        Raises:
            UnsupportedError: it has members.
        """
        if len(activestates):
            raise UnsupportedError("SetConnectedBodyActiveStates", CONNECTED)

    def AddConnectedBody(self, connectedbodyinfo: ConnectedBodyInfo, removeduplicate: bool = False) -> NoReturn:
        """Refuse to connect a body, and to return it.

        Args:
            connectedbodyinfo: Its description.
            removeduplicate: Whether it replaces one of the same name.

        Raises:
            UnsupportedError: always; ``InitFromRobotInfo`` makes a robot of all its links and joints.
        """
        raise UnsupportedError("AddConnectedBody", CONNECTED)

    def RemoveConnectedBody(self, connectedbody: ConnectedBody) -> bool:
        """Return False: no body is connected.

        Args:
            connectedbody: The body.
        """
        del connectedbody
        return False
