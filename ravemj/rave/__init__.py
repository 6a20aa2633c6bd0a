"""The OpenRAVE API: familiar objects over a ``Simulation``.

``CamelCase`` methods are OpenRAVE's, with OpenRAVE's meaning, argument names and defaults; ``snake_case`` on the same
objects is ravemj's own.
"""

from ravemj.rave.body.grabbing import GrabbedInfo
from ravemj.rave.body.saving import StateSaver
from ravemj.rave.creation import RaveCreateKinBody, RaveCreateRobot
from ravemj.rave.enums import (
    CheckLimitsAction,
    CloningOptions,
    GeometryType,
    InterfaceAddMode,
    InterfaceType,
    JointType,
    SaveParameters,
    SensorType,
)
from ravemj.rave.environment import (
    Environment,
    RaveDestroy,
    RaveGetEnvironment,
    RaveGetEnvironmentId,
    RaveGetEnvironments,
    load,
)
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import ElectricMotorActuatorInfo, ExtractInfoOptions
from ravemj.rave.joint import Joint
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.physics import PhysicsEngine
from ravemj.rave.robot import Robot
from ravemj.rave.sensors import AttachedSensor, CameraGeomData, CameraIntrinsics, Sensor
from ravemj.rave.specification import ConfigurationSpecification, RaveGetAffineConfigurationSpecification
from ravemj.rave.trimesh import TriMesh

__all__ = [
    "AttachedSensor",
    "CameraGeomData",
    "CameraIntrinsics",
    "CheckLimitsAction",
    "CloningOptions",
    "ConfigurationSpecification",
    "ElectricMotorActuatorInfo",
    "Environment",
    "ExtractInfoOptions",
    "Geometry",
    "GeometryType",
    "GrabbedInfo",
    "InterfaceAddMode",
    "InterfaceType",
    "Joint",
    "JointType",
    "KinBody",
    "Link",
    "Manipulator",
    "PhysicsEngine",
    "RaveCreateKinBody",
    "RaveCreateRobot",
    "RaveDestroy",
    "RaveGetAffineConfigurationSpecification",
    "RaveGetEnvironment",
    "RaveGetEnvironmentId",
    "RaveGetEnvironments",
    "Robot",
    "SaveParameters",
    "Sensor",
    "SensorType",
    "StateSaver",
    "TriMesh",
    "load",
]
