"""Descriptions that scripts read, change, and make bodies of.

The fields have the names that OpenRAVE gives them; numbers may be lists or arrays.
"""

from ravemj.rave.infos.body import ExtractInfoOptions, KinBodyInfo, RobotBaseInfo, body_of
from ravemj.rave.infos.geometry import GeometryInfo
from ravemj.rave.infos.joint import ElectricMotorActuatorInfo, JointInfo
from ravemj.rave.infos.link import LinkInfo
from ravemj.rave.infos.robot import AttachedSensorInfo, ManipulatorInfo

__all__ = [
    "AttachedSensorInfo",
    "ElectricMotorActuatorInfo",
    "ExtractInfoOptions",
    "GeometryInfo",
    "JointInfo",
    "KinBodyInfo",
    "LinkInfo",
    "ManipulatorInfo",
    "RobotBaseInfo",
    "body_of",
]
