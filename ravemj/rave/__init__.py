"""The OpenRAVE API: familiar objects over a ``Simulation``.

``CamelCase`` methods are OpenRAVE's, with OpenRAVE's meaning, argument names and defaults; ``snake_case`` on the same
objects is ravemj's own.
"""

import importlib
from types import FunctionType
from typing import TYPE_CHECKING

from ravemj.core.argument_errors import explained
from ravemj.core.handles import Handle as UserData
from ravemj.core.signatures import show_as_written
from ravemj.errors import ErrorCode, RavemjError
from ravemj.rave.lazy_imports import MODULE_OF

if TYPE_CHECKING:  # at run time as MODULE_OF says
    from ravemj.geometry_functions.ik_types import IkParameterizationType
    from ravemj.rave.attached_sensor import AttachedSensor
    from ravemj.rave.body.saving import KinBodyStateSaver, RobotStateSaver, StateRestoreContext, StateSaver
    from ravemj.rave.collision import CollisionChecker, CollisionOptionsStateSaver, RaveCreateCollisionChecker
    from ravemj.rave.connected_body import ConnectedBody
    from ravemj.rave.controllers import (
        Controller,
        IdealController,
        MultiController,
        RaveCreateController,
        RaveCreateMultiController,
        VelocityController,
    )
    from ravemj.rave.creation import RaveCreateKinBody, RaveCreateRobot, RaveCreateTrajectory
    from ravemj.rave.enums import (
        AdjacentOptions,
        CheckLimitsAction,
        CloningOptions,
        CollisionAction,
        CollisionOptions,
        ConstraintFilterOptions,
        DebugLevel,
        EnvironmentCreateOptions,
        GeometryType,
        GrabbedInfoCheckResult,
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
        UpdateFromInfoMode,
        UpdateFromInfoResult,
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
    from ravemj.rave.ikreturn import IkFailureAccumulatorBase, IkFailureInfo, IkReturn
    from ravemj.rave.iksolver import IkSolver, RaveCreateIkSolver
    from ravemj.rave.infos import (
        AttachedSensorInfo,
        AxialSlice,
        ConnectedBodyInfo,
        ElectricMotorActuatorInfo,
        EnvironmentBaseInfo,
        ExtractInfoOptions,
        GeometryInfo,
        GrabbedInfo,
        GripperInfo,
        JointControlInfo_ExternalDevice,
        JointControlInfo_IO,
        JointControlInfo_RobotController,
        JointControlMode,
        JointInfo,
        KinBodyInfo,
        LinkInfo,
        ManipulatorInfo,
        RobotBaseInfo,
        SideWall,
        SideWallType,
    )
    from ravemj.rave.infos.sensor import (
        ActuatorGeomData,
        CameraGeomData,
        CameraIntrinsics,
        FlashLidarGeomData,
        Force6DGeomData,
        IMUGeomData,
        JointEncoderGeomData,
        LaserGeomData,
        OdometryGeomData,
        SensorGeometry,
        SpinningLaserGeomData,
        TactileGeomData,
    )
    from ravemj.rave.interface import Interface
    from ravemj.rave.joint import Joint
    from ravemj.rave.kinbody import KinBody
    from ravemj.rave.library import (
        GetMicroTime,
        GetMilliTime,
        GetNanoTime,
        RaveFindDatabaseFile,
        RaveFindLocalFile,
        RaveGetDataAccess,
        RaveGetDefaultViewerType,
        RaveGetHomeDirectory,
        RaveGetPluginInfo,
        RaveInitialize,
        RaveInvertFileLookup,
        RaveLoadPlugin,
        RaveReloadPlugins,
        RaveSetDataAccess,
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
    from ravemj.rave.module import Module
    from ravemj.rave.modules import RaveCreateModule, RaveCreateProblem
    from ravemj.rave.physics import PhysicsEngine, RaveCreatePhysicsEngine
    from ravemj.rave.planning import (
        Planner,
        PlannerProgress,
        PlannerStatus,
        PlanningError,
        RaveCreatePlanner,
    )
    from ravemj.rave.readables import Readable, ReadableInterface, SerializableData, stringreaders, xmlreaders
    from ravemj.rave.registry import (
        ManageData,
        PluginInfo,
        RaveClone,
        RaveCreateInterface,
        RaveCreateSensorSystem,
        RaveCreateViewer,
        RaveGetLoadedInterfaces,
        RaveHasInterface,
        SensorSystem,
    )
    from ravemj.rave.report import CollisionPairInfo, CollisionReport, Contact
    from ravemj.rave.robot import Robot
    from ravemj.rave.samplers import RaveCreateSpaceSampler, SampleDataType, SpaceSampler
    from ravemj.rave.sensor_data import CameraSensorData, SensorData
    from ravemj.rave.sensors import RaveCreateSensor, Sensor
    from ravemj.rave.specification import (
        ConfigurationSpecification,
        IkParameterization,
        RaveGetAffineConfigurationSpecification,
    )
    from ravemj.rave.trajectory import Trajectory
    from ravemj.rave.trimesh import TriMesh
    from ravemj.rave.units import (
        AngleUnit,
        GetAngleUnitConversionScale,
        GetAngleUnitFromString,
        GetAngleUnitStandardValue,
        GetAngleUnitString,
        GetLengthUnitConversionScale,
        GetLengthUnitFromString,
        GetLengthUnitStandardValue,
        GetLengthUnitString,
        GetMassUnitConversionScale,
        GetMassUnitFromString,
        GetMassUnitStandardValue,
        GetMassUnitString,
        GetTimeDurationUnitConversionScale,
        GetTimeDurationUnitFromString,
        GetTimeDurationUnitStandardValue,
        GetTimeDurationUnitString,
        GetTimeStampUnitString,
        LengthUnit,
        MassUnit,
        TimeDurationUnit,
        TimeStampUnit,
        UnitInfo,
    )

OpenRAVEException = openrave_exception = RavemjError

__all__ = [
    "ActuatorGeomData",
    "AdjacentOptions",
    "AngleUnit",
    "AttachedSensor",
    "AttachedSensorInfo",
    "AxialSlice",
    "CameraGeomData",
    "CameraIntrinsics",
    "CameraSensorData",
    "CheckLimitsAction",
    "CloningOptions",
    "CollisionAction",
    "CollisionChecker",
    "CollisionOptions",
    "CollisionOptionsStateSaver",
    "CollisionPairInfo",
    "CollisionReport",
    "ConfigurationSpecification",
    "ConnectedBody",
    "ConnectedBodyInfo",
    "ConstraintFilterOptions",
    "Contact",
    "Controller",
    "DebugLevel",
    "ElectricMotorActuatorInfo",
    "Environment",
    "EnvironmentBaseInfo",
    "EnvironmentCreateOptions",
    "ErrorCode",
    "ExtractInfoOptions",
    "FlashLidarGeomData",
    "Force6DGeomData",
    "Geometry",
    "GeometryInfo",
    "GeometryType",
    "GetAngleUnitConversionScale",
    "GetAngleUnitFromString",
    "GetAngleUnitStandardValue",
    "GetAngleUnitString",
    "GetLengthUnitConversionScale",
    "GetLengthUnitFromString",
    "GetLengthUnitStandardValue",
    "GetLengthUnitString",
    "GetMassUnitConversionScale",
    "GetMassUnitFromString",
    "GetMassUnitStandardValue",
    "GetMassUnitString",
    "GetMicroTime",
    "GetMilliTime",
    "GetNanoTime",
    "GetTimeDurationUnitConversionScale",
    "GetTimeDurationUnitFromString",
    "GetTimeDurationUnitStandardValue",
    "GetTimeDurationUnitString",
    "GetTimeStampUnitString",
    "GrabbedInfo",
    "GrabbedInfoCheckResult",
    "GraphHandle",
    "GripperInfo",
    "IMUGeomData",
    "IdealController",
    "IkFailureAccumulatorBase",
    "IkFailureInfo",
    "IkFilterOptions",
    "IkParameterization",
    "IkParameterizationType",
    "IkReturn",
    "IkReturnAction",
    "IkSolver",
    "Interface",
    "InterfaceAddMode",
    "InterfaceType",
    "Interval",
    "Joint",
    "JointControlInfo_ExternalDevice",
    "JointControlInfo_IO",
    "JointControlInfo_RobotController",
    "JointControlMode",
    "JointEncoderGeomData",
    "JointInfo",
    "JointType",
    "KinBody",
    "KinBodyInfo",
    "KinBodyStateSaver",
    "LaserGeomData",
    "LengthUnit",
    "Link",
    "LinkInfo",
    "ManageData",
    "Manipulator",
    "ManipulatorInfo",
    "MassUnit",
    "Module",
    "MultiController",
    "OdometryGeomData",
    "OpenRAVEException",
    "PhysicsEngine",
    "PhysicsEngineOptions",
    "Planner",
    "PlannerAction",
    "PlannerProgress",
    "PlannerStatus",
    "PlannerStatusCode",
    "PlanningError",
    "PluginInfo",
    "RaveClone",
    "RaveCreateCollisionChecker",
    "RaveCreateController",
    "RaveCreateIkSolver",
    "RaveCreateInterface",
    "RaveCreateKinBody",
    "RaveCreateModule",
    "RaveCreateMultiController",
    "RaveCreatePhysicsEngine",
    "RaveCreatePlanner",
    "RaveCreateProblem",
    "RaveCreateRobot",
    "RaveCreateSensor",
    "RaveCreateSensorSystem",
    "RaveCreateSpaceSampler",
    "RaveCreateTrajectory",
    "RaveCreateViewer",
    "RaveDestroy",
    "RaveFindDatabaseFile",
    "RaveFindLocalFile",
    "RaveGetAffineConfigurationSpecification",
    "RaveGetDataAccess",
    "RaveGetDebugLevel",
    "RaveGetDefaultViewerType",
    "RaveGetEnvironment",
    "RaveGetEnvironmentId",
    "RaveGetEnvironments",
    "RaveGetHomeDirectory",
    "RaveGetLoadedInterfaces",
    "RaveGetPluginInfo",
    "RaveHasInterface",
    "RaveInitialize",
    "RaveInvertFileLookup",
    "RaveLoadPlugin",
    "RaveLog",
    "RaveLogDebug",
    "RaveLogError",
    "RaveLogFatal",
    "RaveLogInfo",
    "RaveLogVerbose",
    "RaveLogWarn",
    "RaveReloadPlugins",
    "RaveSetDataAccess",
    "RaveSetDebugLevel",
    "Readable",
    "ReadableInterface",
    "Robot",
    "RobotBaseInfo",
    "RobotStateSaver",
    "SampleDataType",
    "SaveParameters",
    "SelectionOptions",
    "Sensor",
    "SensorData",
    "SensorGeometry",
    "SensorSystem",
    "SensorType",
    "SerializableData",
    "SerializationOptions",
    "SideWall",
    "SideWallType",
    "SpaceSampler",
    "SpinningLaserGeomData",
    "StateRestoreContext",
    "StateSaver",
    "TactileGeomData",
    "TimeDurationUnit",
    "TimeStampUnit",
    "Trajectory",
    "TriMesh",
    "TriangulateOptions",
    "UnitInfo",
    "UpdateFromInfoMode",
    "UpdateFromInfoResult",
    "UserData",
    "VelocityController",
    "load",
    "openrave_exception",
    "stringreaders",
    "xmlreaders",
]


def __getattr__(name: str) -> object:
    """Import the module of a name when it is asked for."""
    if name not in MODULE_OF:
        raise AttributeError(f"module 'ravemj.rave' has no attribute '{name}'")
    value = getattr(importlib.import_module(MODULE_OF[name]), name)
    if isinstance(value, FunctionType):
        value = explained(value)
        value.__module__ = __name__  # where pickle finds it
    show_as_written(value)
    return globals().setdefault(name, value)
