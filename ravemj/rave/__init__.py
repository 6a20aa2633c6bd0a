"""The OpenRAVE API: familiar objects over a ``Simulation``.

``CamelCase`` methods are OpenRAVE's, with OpenRAVE's meaning, argument names and defaults; ``snake_case`` on the same
objects is ravemj's own.
"""

from ravemj.errors import ErrorCode, RavemjError
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.rave.body.grabbing import GrabbedInfo
from ravemj.rave.body.saving import StateSaver
from ravemj.rave.collision import CollisionChecker, CollisionOptionsStateSaver, RaveCreateCollisionChecker
from ravemj.rave.controllers import (
    Controller,
    IdealController,
    MultiController,
    RaveCreateController,
    RaveCreateMultiController,
    VelocityController,
)
from ravemj.rave.creation import RaveCreateKinBody, RaveCreateRobot
from ravemj.rave.enums import (
    AdjacentOptions,
    CheckLimitsAction,
    CloningOptions,
    CollisionAction,
    CollisionOptions,
    ConstraintFilterOptions,
    DebugLevel,
    GeometryType,
    IkFilterOptions,
    IkReturnAction,
    InterfaceAddMode,
    InterfaceType,
    Interval,
    JointType,
    PhysicsEngineOptions,
    PlannerAction,
    PlannerStatusCode,
    SaveParameters,
    SelectionOptions,
    SensorType,
    SerializationOptions,
    TriangulateOptions,
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
from ravemj.rave.graph_handle import GraphHandle
from ravemj.rave.ikreturn import IkFailureInfo, IkReturn
from ravemj.rave.iksolver import IkSolver, RaveCreateIkSolver
from ravemj.rave.infos import ElectricMotorActuatorInfo, ExtractInfoOptions
from ravemj.rave.joint import Joint
from ravemj.rave.kinbody import KinBody
from ravemj.rave.library import (
    RaveFindDatabaseFile,
    RaveFindLocalFile,
    RaveGetHomeDirectory,
    RaveGetPluginInfo,
    RaveInitialize,
    RaveLoadPlugin,
    RaveReloadPlugins,
)
from ravemj.rave.link import Link
from ravemj.rave.logs import (
    RaveGetDebugLevel,
    RaveLog,
    RaveLogDebug,
    RaveLogError,
    RaveLogFatal,
    RaveLogInfo,
    RaveLogVerbose,
    RaveLogWarn,
    RaveSetDebugLevel,
)
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.modules import Module
from ravemj.rave.physics import PhysicsEngine, RaveCreatePhysicsEngine
from ravemj.rave.planning import (
    Planner,
    PlannerProgress,
    PlannerStatus,
    PlanningError,
    RaveCreatePlanner,
)
from ravemj.rave.plugins import (
    RaveCreateModule,
    RaveCreateProblem,
    RaveCreateSensor,
    RaveCreateSpaceSampler,
    RaveCreateViewer,
    RaveGetLoadedInterfaces,
)
from ravemj.rave.report import CollisionReport
from ravemj.rave.robot import Robot
from ravemj.rave.sensors import AttachedSensor, CameraGeomData, CameraIntrinsics, CameraSensorData, Sensor
from ravemj.rave.specification import (
    ConfigurationSpecification,
    IkParameterization,
    RaveGetAffineConfigurationSpecification,
)
from ravemj.rave.trajectory import RaveCreateTrajectory, Trajectory
from ravemj.rave.trimesh import TriMesh

KinBodyStateSaver = RobotStateSaver = StateSaver

OpenRAVEException = openrave_exception = RavemjError

__all__ = [
    "AdjacentOptions",
    "AttachedSensor",
    "CameraGeomData",
    "CameraIntrinsics",
    "CameraSensorData",
    "CheckLimitsAction",
    "CloningOptions",
    "CollisionAction",
    "CollisionChecker",
    "CollisionOptions",
    "CollisionOptionsStateSaver",
    "CollisionReport",
    "ConfigurationSpecification",
    "ConstraintFilterOptions",
    "Controller",
    "DebugLevel",
    "ElectricMotorActuatorInfo",
    "Environment",
    "ErrorCode",
    "ExtractInfoOptions",
    "Geometry",
    "GeometryType",
    "GrabbedInfo",
    "GraphHandle",
    "IdealController",
    "IkFailureInfo",
    "IkFilterOptions",
    "IkParameterization",
    "IkParameterizationType",
    "IkReturn",
    "IkReturnAction",
    "IkSolver",
    "InterfaceAddMode",
    "InterfaceType",
    "Interval",
    "Joint",
    "JointType",
    "KinBody",
    "KinBodyStateSaver",
    "Link",
    "Manipulator",
    "Module",
    "MultiController",
    "OpenRAVEException",
    "PhysicsEngine",
    "PhysicsEngineOptions",
    "Planner",
    "PlannerAction",
    "PlannerProgress",
    "PlannerStatus",
    "PlannerStatusCode",
    "PlanningError",
    "RaveCreateCollisionChecker",
    "RaveCreateController",
    "RaveCreateIkSolver",
    "RaveCreateKinBody",
    "RaveCreateModule",
    "RaveCreateMultiController",
    "RaveCreatePhysicsEngine",
    "RaveCreatePlanner",
    "RaveCreateProblem",
    "RaveCreateRobot",
    "RaveCreateSensor",
    "RaveCreateSpaceSampler",
    "RaveCreateTrajectory",
    "RaveCreateViewer",
    "RaveDestroy",
    "RaveFindDatabaseFile",
    "RaveFindLocalFile",
    "RaveGetAffineConfigurationSpecification",
    "RaveGetDebugLevel",
    "RaveGetEnvironment",
    "RaveGetEnvironmentId",
    "RaveGetEnvironments",
    "RaveGetHomeDirectory",
    "RaveGetLoadedInterfaces",
    "RaveGetPluginInfo",
    "RaveInitialize",
    "RaveLoadPlugin",
    "RaveLog",
    "RaveLogDebug",
    "RaveLogError",
    "RaveLogFatal",
    "RaveLogInfo",
    "RaveLogVerbose",
    "RaveLogWarn",
    "RaveReloadPlugins",
    "RaveSetDebugLevel",
    "Robot",
    "RobotStateSaver",
    "SaveParameters",
    "SelectionOptions",
    "Sensor",
    "SensorType",
    "SerializationOptions",
    "StateSaver",
    "Trajectory",
    "TriMesh",
    "TriangulateOptions",
    "VelocityController",
    "load",
    "openrave_exception",
]
