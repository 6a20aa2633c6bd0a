"""The OpenRAVE API: familiar objects over a ``Simulation``.

``CamelCase`` methods are OpenRAVE's, with OpenRAVE's meaning, argument names and defaults; ``snake_case`` on the same
objects is ravemj's own.
"""

from ravemj.rave.enums import CheckLimitsAction, GeometryType, JointType, SensorType
from ravemj.rave.environment import Environment, RaveGetEnvironment, load
from ravemj.rave.geometry import Geometry, TriMesh
from ravemj.rave.joint import Joint
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.physics import PhysicsEngine
from ravemj.rave.robot import Robot
from ravemj.rave.sensors import AttachedSensor, CameraGeomData, CameraIntrinsics, Sensor
from ravemj.rave.specification import ConfigurationSpecification, RaveGetAffineConfigurationSpecification
from ravemj.rave.trajectory import RaveCreateTrajectory, Trajectory

__all__ = [
    "AttachedSensor",
    "CameraGeomData",
    "CameraIntrinsics",
    "CheckLimitsAction",
    "ConfigurationSpecification",
    "Environment",
    "Geometry",
    "GeometryType",
    "Joint",
    "JointType",
    "KinBody",
    "Link",
    "Manipulator",
    "PhysicsEngine",
    "RaveCreateTrajectory",
    "RaveGetAffineConfigurationSpecification",
    "RaveGetEnvironment",
    "Robot",
    "Sensor",
    "SensorType",
    "Trajectory",
    "TriMesh",
    "load",
]
