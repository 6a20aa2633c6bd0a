"""Descriptions of bodies that a robot holds, or that are connected to it."""

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.model import hashes, scene
from ravemj.rave.infos.base import IdentifiedInfo, info_class, json_field
from ravemj.rave.infos.joint import JointInfo
from ravemj.rave.infos.json import POSE, TEXT, infos
from ravemj.rave.infos.link import LinkInfo
from ravemj.rave.infos.robot import AttachedSensorInfo, GripperInfo, ManipulatorInfo


@info_class
class ConnectedBodyInfo(IdentifiedInfo):
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

    _name: str | None = json_field("name", TEXT, default=None)
    _linkname: str | None = json_field("linkName", TEXT, default=None)
    _uri: str = json_field("uri", TEXT, default="", optional=True)
    _trelative: ArrayLike = json_field("transform", POSE, default=np.eye(4))
    _linkInfos: Sequence[LinkInfo] = json_field("links", infos(LinkInfo), default=[], optional=True)
    _jointInfos: Sequence[JointInfo] = json_field("joints", infos(JointInfo), default=[], optional=True)
    _manipulatorInfos: Sequence[ManipulatorInfo] = json_field(
        "tools", infos(ManipulatorInfo), default=[], optional=True
    )
    _attachedSensorInfos: Sequence[AttachedSensorInfo] = json_field(
        "attachedSensors", infos(AttachedSensorInfo), default=[], optional=True
    )
    _gripperInfos: Sequence[GripperInfo] = json_field("gripperInfos", infos(GripperInfo), default=[], optional=True)
    _bIsActive: int = json_field("isActive", default=0)


@info_class
class GrabbedInfo(IdentifiedInfo):
    """A grabbed body, and how its holder holds it; ``ResetGrabbed`` restores it from this.

    Attributes:
        _grabbedname: The name of the held body.
        _robotlinkname: The name of the link that holds it.
        _trelative: ``T_link_body``, shape (4, 4).
        _setIgnoreRobotLinkNames: The names of the holder's links that are not tested against the held body.
        _grabbedUserData: Data of the user, anything that JSON can hold. ravemj only stores it.
    """

    _id: str | None = json_field("id", TEXT, default="", optional=True, kw_only=True)
    _grabbedname: str = json_field("grabbedName", TEXT, default="")
    _robotlinkname: str = json_field("robotLinkName", TEXT, default="")
    _trelative: Floats = json_field("transform", POSE, default=np.eye(4))
    _setIgnoreRobotLinkNames: Sequence[str] = json_field("ignoreRobotLinkNames", default=[], optional=True)
    _grabbedUserData: Any = json_field("grabbedUserData", default=None, optional=True)

    @classmethod
    def of(cls, holder: scene.KinBody, grab: GrabbedBody) -> Self:
        """Return the info of one body that ``holder`` holds."""
        links = [link.name for link in holder.links]
        ignored = sorted(links[index] for index in grab.ignored)
        return cls(grab.body.scene.name, links[grab.link], grab.T_link_body.copy(), ignored)

    def GetGrabbedInfoHash(self) -> str:
        """Return a hash of the info, 32 hexadecimal digits; equal infos have equal hashes."""
        return hashes.of_text(repr(self.SerializeJSON()))
