"""Descriptions of bodies that a robot holds, or that are connected to it."""

# JSON and users put anything into the fields that the functions of forms take.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence
from dataclasses import field
from typing import Any, Self

from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.model import hashes, scene
from ravemj.rave.infos.base import Info, identity, info_class
from ravemj.rave.infos.joint import JointInfo
from ravemj.rave.infos.json import PLAIN, POSE, TEXT, Entry, Json, infos
from ravemj.rave.infos.link import LinkInfo
from ravemj.rave.infos.robot import AttachedSensorInfo, GripperInfo, ManipulatorInfo


@info_class
class ConnectedBodyInfo(Info):
    """A body that can be connected to a link of a robot. Once connected, it is part of the robot.

    Attributes:
        _name: The name of the body. With an underscore, it is the prefix of the names of its parts.
        _linkname: The name of the robot's link that carries the body.
        _trelative: ``T_link_body``, shape (4, 4).
        _uri: The file that the description comes from; ravemj does not read it.
        _linkInfos: The links; the first one is fixed to the robot.
        _jointInfos: The joints.
        _manipulatorInfos: The manipulators.
        _attachedSensorInfos: The sensors.
        _gripperInfos: The grippers.
        _bIsActive: Whether the body is connected: 1 yes, 0 no, -1 undecided.
    """

    _called = "ConnectedBodyInfo"

    _id: str | None = None
    _name: str | None = None
    _linkname: str | None = None
    _uri: str = ""
    _trelative: ArrayLike = field(default_factory=identity)
    _linkInfos: Sequence[LinkInfo] = field(default_factory=list[LinkInfo])
    _jointInfos: Sequence[JointInfo] = field(default_factory=list[JointInfo])
    _manipulatorInfos: Sequence[ManipulatorInfo] = field(default_factory=list[ManipulatorInfo])
    _attachedSensorInfos: Sequence[AttachedSensorInfo] = field(default_factory=list[AttachedSensorInfo])
    _gripperInfos: Sequence[GripperInfo] = field(default_factory=list[GripperInfo])
    _bIsActive: int = 0

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        del obj
        return _CONNECTED_JSON


_CONNECTED_JSON = (
    Entry("id", "_id", TEXT),
    Entry("name", "_name", TEXT),
    Entry("linkName", "_linkname", TEXT),
    Entry("uri", "_uri", TEXT, optional=True),
    Entry("transform", "_trelative", POSE),
    Entry("links", "_linkInfos", infos(lambda item: LinkInfo()), optional=True),
    Entry("joints", "_jointInfos", infos(lambda item: JointInfo()), optional=True),
    Entry("tools", "_manipulatorInfos", infos(lambda item: ManipulatorInfo()), optional=True),
    Entry("attachedSensors", "_attachedSensorInfos", infos(lambda item: AttachedSensorInfo()), optional=True),
    Entry("gripperInfos", "_gripperInfos", infos(lambda item: GripperInfo()), optional=True),
    Entry("isActive", "_bIsActive", PLAIN),
)


@info_class
class GrabbedInfo(Info):
    """A grabbed body, and how its holder holds it; ``ResetGrabbed`` restores it from this.

    Attributes:
        _grabbedname: The name of the held body.
        _robotlinkname: The name of the link that holds it.
        _trelative: ``T_link_body``, shape (4, 4).
        _setIgnoreRobotLinkNames: The names of the holder's links that are not tested against the held body.
        _grabbedUserData: Data of the user, anything that JSON can hold. ravemj only stores it.
    """

    _called = "GrabbedInfo"

    _grabbedname: str = ""
    _robotlinkname: str = ""
    _trelative: Floats = field(default_factory=identity)
    _setIgnoreRobotLinkNames: Sequence[str] = field(default_factory=list[str])
    _grabbedUserData: Any = None
    _id: str = ""

    @classmethod
    def of(cls, holder: scene.KinBody, grab: GrabbedBody) -> Self:
        """Return the info of one body that ``holder`` holds."""
        links = [link.name for link in holder.links]
        ignored = sorted(links[index] for index in grab.ignored)
        return cls(grab.body.scene.name, links[grab.link], grab.T_link_body.copy(), ignored)

    def GetGrabbedInfoHash(self) -> str:
        """Return a hash of the info, 32 hexadecimal digits; equal infos have equal hashes."""
        return hashes.of_text(repr(self.SerializeJSON()))

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        del obj
        return _GRABBED_JSON


_GRABBED_JSON = (
    Entry("id", "_id", TEXT, optional=True),
    Entry("grabbedName", "_grabbedname", TEXT),
    Entry("robotLinkName", "_robotlinkname", TEXT),
    Entry("transform", "_trelative", POSE),
    Entry("ignoreRobotLinkNames", "_setIgnoreRobotLinkNames", PLAIN, optional=True),
    Entry("grabbedUserData", "_grabbedUserData", PLAIN, optional=True),
)
