"""Bodies that can be connected to a robot."""

from typing import NoReturn

from ravemj.core.api_object import ApiObject
from ravemj.errors import UnsupportedError

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
