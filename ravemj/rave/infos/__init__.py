"""Infos: descriptions of bodies that scripts read, change, and make bodies from.

Their fields have OpenRAVE's names; numbers may be lists or arrays. ``SerializeJSON`` and ``DeserializeJSON`` convert
infos to OpenRAVE's JSON and back.
"""

from ravemj.rave.infos.body import ExtractInfoOptions, KinBodyInfo, RobotBaseInfo, body_of
from ravemj.rave.infos.connected import ConnectedBodyInfo, GrabbedInfo
from ravemj.rave.infos.environment import EnvironmentBaseInfo
from ravemj.rave.infos.geometry import GeometryInfo
from ravemj.rave.infos.geometry_sizes import AxialSlice, SideWall, SideWallType
from ravemj.rave.infos.joint import JointInfo
from ravemj.rave.infos.link import LinkInfo
from ravemj.rave.infos.motor import (
    ElectricMotorActuatorInfo,
    JointControlInfo_ExternalDevice,
    JointControlInfo_IO,
    JointControlInfo_RobotController,
    JointControlMode,
)
from ravemj.rave.infos.robot import AttachedSensorInfo, GripperInfo, ManipulatorInfo

__all__ = [
    "AttachedSensorInfo",
    "AxialSlice",
    "ConnectedBodyInfo",
    "ElectricMotorActuatorInfo",
    "EnvironmentBaseInfo",
    "ExtractInfoOptions",
    "GeometryInfo",
    "GrabbedInfo",
    "GripperInfo",
    "JointControlInfo_ExternalDevice",
    "JointControlInfo_IO",
    "JointControlInfo_RobotController",
    "JointControlMode",
    "JointInfo",
    "KinBodyInfo",
    "LinkInfo",
    "ManipulatorInfo",
    "RobotBaseInfo",
    "SideWall",
    "SideWallType",
    "body_of",
]
