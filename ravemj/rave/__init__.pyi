"""The public names of ``ravemj.rave``, their only list: ``__init__.py`` imports each from its module on first use."""

from ravemj.core.handles import Handle
from ravemj.errors import ErrorCode as ErrorCode, RavemjError
from ravemj.geometry_functions.ik_types import IkParameterizationType as IkParameterizationType
from ravemj.rave.robot.equipment import AttachedSensor as AttachedSensor
from ravemj.rave.kinbody.state_saver import (
    KinBodyStateSaver as KinBodyStateSaver,
    RobotStateSaver as RobotStateSaver,
    StateRestoreContext as StateRestoreContext,
    StateSaver as StateSaver,
)
from ravemj.rave.collision import (
    CollisionChecker as CollisionChecker,
    CollisionOptionsStateSaver as CollisionOptionsStateSaver,
    RaveCreateCollisionChecker as RaveCreateCollisionChecker,
)
from ravemj.rave.robot.equipment import ConnectedBody as ConnectedBody
from ravemj.rave.controllers import (
    Controller as Controller,
    IdealController as IdealController,
    MultiController as MultiController,
    RaveCreateController as RaveCreateController,
    RaveCreateMultiController as RaveCreateMultiController,
    VelocityController as VelocityController,
)
from ravemj.rave.registry import (
    RaveCreateIkSolver as RaveCreateIkSolver,
    RaveCreateKinBody as RaveCreateKinBody,
    RaveCreateRobot as RaveCreateRobot,
    RaveCreateTrajectory as RaveCreateTrajectory,
)
from ravemj.rave.enums import (
    AdjacentOptions as AdjacentOptions,
    CheckLimitsAction as CheckLimitsAction,
    CloningOptions as CloningOptions,
    CollisionAction as CollisionAction,
    CollisionOptions as CollisionOptions,
    ConstraintFilterOptions as ConstraintFilterOptions,
    DebugLevel as DebugLevel,
    EnvironmentCreateOptions as EnvironmentCreateOptions,
    GeometryType as GeometryType,
    GrabbedInfoCheckResult as GrabbedInfoCheckResult,
    IkFilterOptions as IkFilterOptions,
    IkReturnAction as IkReturnAction,
    InterfaceAddMode as InterfaceAddMode,
    InterfaceType as InterfaceType,
    Interval as Interval,
    JointType as JointType,
    PhysicsEngineOptions as PhysicsEngineOptions,
    PlannerAction as PlannerAction,
    PlannerStatusCode as PlannerStatusCode,
    SaveParameters as SaveParameters,
    SelectionOptions as SelectionOptions,
    SensorType as SensorType,
    SerializationOptions as SerializationOptions,
    TriangulateOptions as TriangulateOptions,
    UpdateFromInfoMode as UpdateFromInfoMode,
    UpdateFromInfoResult as UpdateFromInfoResult,
)
from ravemj.rave.environment import (
    Environment as Environment,
    RaveDestroy as RaveDestroy,
    RaveGetEnvironment as RaveGetEnvironment,
    RaveGetEnvironmentId as RaveGetEnvironmentId,
    RaveGetEnvironments as RaveGetEnvironments,
    load as load,
)
from ravemj.rave.geometry import Geometry as Geometry
from ravemj.rave.env.viewing import GraphHandle as GraphHandle
from ravemj.rave.ikreturn import (
    IkFailureAccumulatorBase as IkFailureAccumulatorBase,
    IkFailureInfo as IkFailureInfo,
    IkReturn as IkReturn,
)
from ravemj.rave.iksolver import IkSolver as IkSolver
from ravemj.rave.infos import (
    AttachedSensorInfo as AttachedSensorInfo,
    AxialSlice as AxialSlice,
    ConnectedBodyInfo as ConnectedBodyInfo,
    ElectricMotorActuatorInfo as ElectricMotorActuatorInfo,
    EnvironmentBaseInfo as EnvironmentBaseInfo,
    ExtractInfoOptions as ExtractInfoOptions,
    GeometryInfo as GeometryInfo,
    GrabbedInfo as GrabbedInfo,
    GripperInfo as GripperInfo,
    JointControlInfo_ExternalDevice as JointControlInfo_ExternalDevice,
    JointControlInfo_IO as JointControlInfo_IO,
    JointControlInfo_RobotController as JointControlInfo_RobotController,
    JointControlMode as JointControlMode,
    JointInfo as JointInfo,
    KinBodyInfo as KinBodyInfo,
    LinkInfo as LinkInfo,
    ManipulatorInfo as ManipulatorInfo,
    RobotBaseInfo as RobotBaseInfo,
    SideWall as SideWall,
    SideWallType as SideWallType,
)
from ravemj.rave.infos.sensor import (
    ActuatorGeomData as ActuatorGeomData,
    CameraGeomData as CameraGeomData,
    CameraIntrinsics as CameraIntrinsics,
    FlashLidarGeomData as FlashLidarGeomData,
    Force6DGeomData as Force6DGeomData,
    IMUGeomData as IMUGeomData,
    JointEncoderGeomData as JointEncoderGeomData,
    LaserGeomData as LaserGeomData,
    OdometryGeomData as OdometryGeomData,
    SensorGeometry as SensorGeometry,
    SpinningLaserGeomData as SpinningLaserGeomData,
    TactileGeomData as TactileGeomData,
)
from ravemj.rave.interface import Interface as Interface
from ravemj.rave.joint import Joint as Joint
from ravemj.rave.kinbody import KinBody as KinBody
from ravemj.rave.library import (
    GetMicroTime as GetMicroTime,
    GetMilliTime as GetMilliTime,
    GetNanoTime as GetNanoTime,
    RaveFindDatabaseFile as RaveFindDatabaseFile,
    RaveFindLocalFile as RaveFindLocalFile,
    RaveGetDataAccess as RaveGetDataAccess,
    RaveGetDefaultViewerType as RaveGetDefaultViewerType,
    RaveGetHomeDirectory as RaveGetHomeDirectory,
    RaveGetPluginInfo as RaveGetPluginInfo,
    RaveInitialize as RaveInitialize,
    RaveInvertFileLookup as RaveInvertFileLookup,
    RaveLoadPlugin as RaveLoadPlugin,
    RaveReloadPlugins as RaveReloadPlugins,
    RaveSetDataAccess as RaveSetDataAccess,
)
from ravemj.rave.link import Link as Link
from ravemj.rave.logs import (
    RaveGetDebugLevel as RaveGetDebugLevel,
    RaveLog as RaveLog,
    RaveLogDebug as RaveLogDebug,
    RaveLogError as RaveLogError,
    RaveLogFatal as RaveLogFatal,
    RaveLogInfo as RaveLogInfo,
    RaveLogVerbose as RaveLogVerbose,
    RaveLogWarn as RaveLogWarn,
    RaveSetDebugLevel as RaveSetDebugLevel,
)
from ravemj.rave.manipulator import Manipulator as Manipulator
from ravemj.rave.interface import Module as Module
from ravemj.rave.modules import RaveCreateModule as RaveCreateModule, RaveCreateProblem as RaveCreateProblem
from ravemj.rave.physics import PhysicsEngine as PhysicsEngine, RaveCreatePhysicsEngine as RaveCreatePhysicsEngine
from ravemj.rave.planning import (
    Planner as Planner,
    PlannerProgress as PlannerProgress,
    PlannerStatus as PlannerStatus,
    PlanningError as PlanningError,
    RaveCreatePlanner as RaveCreatePlanner,
)
from ravemj.rave.interface import (
    Readable as Readable,
    ReadableInterface as ReadableInterface,
    SerializableData as SerializableData,
    stringreaders as stringreaders,
    xmlreaders as xmlreaders,
)
from ravemj.rave.region import Region as Region, all_of as all_of, any_of as any_of
from ravemj.rave.registry import (
    ManageData as ManageData,
    PluginInfo as PluginInfo,
    RaveClone as RaveClone,
    RaveCreateInterface as RaveCreateInterface,
    RaveCreateSensorSystem as RaveCreateSensorSystem,
    RaveCreateViewer as RaveCreateViewer,
    RaveGetLoadedInterfaces as RaveGetLoadedInterfaces,
    RaveHasInterface as RaveHasInterface,
    SensorSystem as SensorSystem,
)
from ravemj.rave.report import (
    CollisionPairInfo as CollisionPairInfo,
    CollisionReport as CollisionReport,
    Contact as Contact,
)
from ravemj.rave.robot import Robot as Robot
from ravemj.rave.samplers import (
    RaveCreateSpaceSampler as RaveCreateSpaceSampler,
    SampleDataType as SampleDataType,
    SpaceSampler as SpaceSampler,
)
from ravemj.rave.instruments import CameraSensorData as CameraSensorData, SensorData as SensorData
from ravemj.rave.sensors import RaveCreateSensor as RaveCreateSensor, Sensor as Sensor
from ravemj.rave.specification import (
    ConfigurationSpecification as ConfigurationSpecification,
    IkParameterization as IkParameterization,
    RaveGetAffineConfigurationSpecification as RaveGetAffineConfigurationSpecification,
)
from ravemj.rave.streaming_controller import StreamingController as StreamingController
from ravemj.rave.trajectory import Trajectory as Trajectory
from ravemj.rave.trimesh import TriMesh as TriMesh
from ravemj.rave.units import (
    AngleUnit as AngleUnit,
    GetAngleUnitConversionScale as GetAngleUnitConversionScale,
    GetAngleUnitFromString as GetAngleUnitFromString,
    GetAngleUnitStandardValue as GetAngleUnitStandardValue,
    GetAngleUnitString as GetAngleUnitString,
    GetLengthUnitConversionScale as GetLengthUnitConversionScale,
    GetLengthUnitFromString as GetLengthUnitFromString,
    GetLengthUnitStandardValue as GetLengthUnitStandardValue,
    GetLengthUnitString as GetLengthUnitString,
    GetMassUnitConversionScale as GetMassUnitConversionScale,
    GetMassUnitFromString as GetMassUnitFromString,
    GetMassUnitStandardValue as GetMassUnitStandardValue,
    GetMassUnitString as GetMassUnitString,
    GetTimeDurationUnitConversionScale as GetTimeDurationUnitConversionScale,
    GetTimeDurationUnitFromString as GetTimeDurationUnitFromString,
    GetTimeDurationUnitStandardValue as GetTimeDurationUnitStandardValue,
    GetTimeDurationUnitString as GetTimeDurationUnitString,
    GetTimeStampUnitString as GetTimeStampUnitString,
    LengthUnit as LengthUnit,
    MassUnit as MassUnit,
    TimeDurationUnit as TimeDurationUnit,
    TimeStampUnit as TimeStampUnit,
    UnitInfo as UnitInfo,
)
from ravemj.rave.whole_body import (
    WholeBodyIK as WholeBodyIK,
    WholeBodyLimits as WholeBodyLimits,
    WholeBodyResult as WholeBodyResult,
    WholeBodyTask as WholeBodyTask,
)

OpenRAVEException = openrave_exception = RavemjError
UserData = Handle

__all__: list[str]
