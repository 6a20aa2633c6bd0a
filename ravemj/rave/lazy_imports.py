"""Where the names of ``ravemj.rave`` are, so that ``import ravemj`` imports none of their modules."""

_NAMES = {
    "ravemj.geometry_functions.ik_types": "IkParameterizationType",
    "ravemj.rave.connected_body": "ConnectedBody",
    "ravemj.rave.body.saving": "KinBodyStateSaver RobotStateSaver StateRestoreContext StateSaver",
    "ravemj.rave.collision": "CollisionChecker CollisionOptionsStateSaver RaveCreateCollisionChecker",
    "ravemj.rave.controllers": """
        Controller IdealController MultiController RaveCreateController RaveCreateMultiController
        VelocityController
    """,
    "ravemj.rave.creation": "RaveCreateKinBody RaveCreateRobot RaveCreateTrajectory",
    "ravemj.rave.enums": """
        AdjacentOptions CheckLimitsAction CloningOptions CollisionAction CollisionOptions
        ConstraintFilterOptions DebugLevel EnvironmentCreateOptions GeometryType GrabbedInfoCheckResult
        IkFilterOptions IkReturnAction InterfaceAddMode InterfaceType Interval JointType PhysicsEngineOptions
        PlannerAction PlannerStatusCode SaveParameters SelectionOptions SensorType SerializationOptions
        TriangulateOptions UpdateFromInfoMode UpdateFromInfoResult
    """,
    "ravemj.rave.environment": """
        Environment RaveDestroy RaveGetEnvironment RaveGetEnvironmentId RaveGetEnvironments load
    """,
    "ravemj.rave.geometry": "Geometry",
    "ravemj.rave.graph_handle": "GraphHandle",
    "ravemj.rave.ikreturn": "IkFailureAccumulatorBase IkFailureInfo IkReturn",
    "ravemj.rave.iksolver": "IkSolver RaveCreateIkSolver",
    "ravemj.rave.infos": """
        AttachedSensorInfo AxialSlice ConnectedBodyInfo ElectricMotorActuatorInfo EnvironmentBaseInfo
        ExtractInfoOptions GeometryInfo GrabbedInfo GripperInfo JointControlInfo_ExternalDevice
        JointControlInfo_IO JointControlInfo_RobotController JointControlMode JointInfo KinBodyInfo LinkInfo
        ManipulatorInfo RobotBaseInfo SideWall SideWallType
    """,
    "ravemj.rave.infos.sensor": """
        ActuatorGeomData CameraGeomData CameraIntrinsics FlashLidarGeomData Force6DGeomData IMUGeomData
        JointEncoderGeomData LaserGeomData OdometryGeomData SensorGeometry SpinningLaserGeomData TactileGeomData
    """,
    "ravemj.rave.interface": "Interface",
    "ravemj.rave.joint": "Joint",
    "ravemj.rave.kinbody": "KinBody",
    "ravemj.rave.library": """
        GetMicroTime GetMilliTime GetNanoTime RaveFindDatabaseFile RaveFindLocalFile RaveGetDataAccess
        RaveGetDefaultViewerType RaveGetHomeDirectory RaveGetPluginInfo RaveInitialize RaveInvertFileLookup
        RaveLoadPlugin RaveReloadPlugins RaveSetDataAccess
    """,
    "ravemj.rave.link": "Link",
    "ravemj.rave.logs": """
        RaveGetDebugLevel RaveLog RaveLogDebug RaveLogError RaveLogFatal RaveLogInfo RaveLogVerbose RaveLogWarn
        RaveSetDebugLevel
    """,
    "ravemj.rave.manipulator": "Manipulator",
    "ravemj.rave.module": "Module",
    "ravemj.rave.modules": "RaveCreateModule RaveCreateProblem",
    "ravemj.rave.physics": "PhysicsEngine RaveCreatePhysicsEngine",
    "ravemj.rave.planning": "Planner PlannerProgress PlannerStatus PlanningError RaveCreatePlanner",
    "ravemj.rave.readables": "Readable ReadableInterface SerializableData stringreaders xmlreaders",
    "ravemj.rave.registry": """
        ManageData PluginInfo RaveClone RaveCreateInterface RaveCreateSensorSystem RaveCreateViewer
        RaveGetLoadedInterfaces RaveHasInterface SensorSystem
    """,
    "ravemj.rave.report": "CollisionPairInfo CollisionReport Contact",
    "ravemj.rave.robot": "Robot",
    "ravemj.rave.samplers": "RaveCreateSpaceSampler SampleDataType SpaceSampler",
    "ravemj.rave.sensor_data": "CameraSensorData SensorData",
    "ravemj.rave.attached_sensor": "AttachedSensor",
    "ravemj.rave.sensors": "RaveCreateSensor Sensor",
    "ravemj.rave.specification": """
        ConfigurationSpecification IkParameterization RaveGetAffineConfigurationSpecification
    """,
    "ravemj.rave.trajectory": "Trajectory",
    "ravemj.rave.trimesh": "TriMesh",
    "ravemj.rave.units": """
        AngleUnit GetAngleUnitConversionScale GetAngleUnitFromString GetAngleUnitStandardValue
        GetAngleUnitString GetLengthUnitConversionScale GetLengthUnitFromString GetLengthUnitStandardValue
        GetLengthUnitString GetMassUnitConversionScale GetMassUnitFromString GetMassUnitStandardValue
        GetMassUnitString GetTimeDurationUnitConversionScale GetTimeDurationUnitFromString
        GetTimeDurationUnitStandardValue GetTimeDurationUnitString GetTimeStampUnitString LengthUnit MassUnit
        TimeDurationUnit TimeStampUnit UnitInfo
    """,
}

MODULE_OF = {name: module for module, names in _NAMES.items() for name in names.split()}
"""The module of each name."""
