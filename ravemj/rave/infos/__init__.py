"""Infos: descriptions of bodies that scripts read, change, and make bodies from.

Their fields have OpenRAVE's names; numbers may be lists or arrays. ``SerializeJSON`` and ``DeserializeJSON`` convert
infos to OpenRAVE's JSON and back.
"""

from ravemj.rave.infos.body import (
    AttachedSensorInfo,
    ConnectedBodyInfo,
    EnvironmentBaseInfo,
    ExtractInfoOptions,
    GrabbedInfo,
    GripperInfo,
    KinBodyInfo,
    ManipulatorInfo,
    RobotBaseInfo,
    body_of,
)
from ravemj.rave.infos.geometry import AxialSlice, GeometryInfo, SideWall, SideWallType
from ravemj.rave.infos.joint import (
    ElectricMotorActuatorInfo,
    JointControlInfo_ExternalDevice,
    JointControlInfo_IO,
    JointControlInfo_RobotController,
    JointControlMode,
    JointInfo,
)
from ravemj.rave.infos.link import LinkInfo

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
