"""Names of OpenRAVE's API that scripts use, counted in 308 scripts of 26 public projects."""

SCRIPTS = """
    Environment Load SendCommand RaveCreateModule RaveInitialize RaveDestroy RaveLoadPlugin matrixFromAxisAngle
    GetTransform GetBodies with_env SetViewer plot3 SetTransform GetRobots GetActiveManipulator
    IkParameterizationType IkParameterization model.load autogenerate InverseKinematicsModel SetDOFValues
    GetArmIndices __openravepy_build_doc__ SetActiveDOFs SetActiveDOFValues GetDOFValues GetJoint GetDOFIndex
    GetController Reset SetDesired IsDone matrixFromPose CheckCollision GetLinks Destroy GetName GetActiveDOFValues
    GetDOF SetLocalToolTransform SetLocalToolDirection GetManipulator SetName RaveCreateKinBody InitFromBoxes
    AddKinBody Remove GetRobot RaveCreateCollisionChecker SetCollisionChecker drawlinestrip StopSimulation
    SetDebugLevel StartSimulation SetController RaveCreateController UpdatePublishedBodies SetCamera GetViewer
    AddModule GetEndEffectorTransform GetActiveManipulatorIndex GetEnv GetKinBody CheckSelfCollision GetNumWaypoints
    GetWaypoint GetActiveConfigurationSpecification GetLink Enable CreateRobotStateSaver extents ComputeAABB Release
    Grab with_robot SetPath RaveCreateTrajectory planningutils RetimeActiveDOFTrajectory Insert
    GetConfigurationSpecification Init SetActiveManipulator GetJoints GetDOFLimits IkFilterOptions FindIKSolution
    GetPhysicsEngine SetGravity StepSimulation WaitForController SetStatic DrawAxes Ray CollisionReport Add
    ReadKinBodyXMLFile SetVisible GetActiveDOFIndices Sample ExtractJointValues GetManipulators ReadRobotURI
    DOFAffine poseFromMatrix RetimeAffineTrajectory FindIKSolutions SetDefaultViewer ComputeJacobianTranslation
    ComputeJacobianAxisAngle TaskManipulation CloseFingers PlannerParameters RaveCreatePlanner PlanPath InitPlan
    SetRobotActiveJoints Planner SetGoalConfig SetExtraParameters ReleaseFingers RaveCreateProblem LoadProblem
    rotationMatrixFromQuat GetLoadedProblems DebugLevel RaveSetDebugLevel serialize PlannerStatus SetPostProcessing
    SetMaxIterations rotationMatrixFromAxisAngle GetDuration GetActiveDOF GetActiveDOFLimits BaseManipulation
    MoveActiveJoints SetDOFAccelerationLimits GetDOFVelocityLimits SetDOFVelocityLimits GetDOFAccelerationLimits
    setRobotWeights setRobotResolutions LinkStatisticsModel RobotStateSaver MoveToHandPosition MoveManipulator
    GetConfigurationValues Unlock Lock GetKinematicsGeometryHash GetDOFWeights SetDOFLimits GetDOFMaxTorque
    openrave_exception GetCollisionChecker GetParent GetLimits plink1 plink2 InitFromSpheres vLinkColliding GetValue
    ReachabilityModel drawarrow ComputeInverseDynamics SetActiveDOFVelocities GetActiveDOFMaxVel GetDOFTorqueLimits
    GetActiveDOFMaxAccel ExtractDeltaTime contacts GetCenterOfMass CollisionOptions SetCollisionOptions
    GetGripperIndices GetJointFromDOFIndex GetAxis quatFromRotationMatrix matrixFromQuat quatFromAxisAngle
    RaveGetEnvironment GetArmJoints quatSlerp Robot SaveParameters GetIndex RetimeTrajectory AddGroup GetArmDOF
    CalculateJacobian CalculateAngularVelocityJacobian InitOpenRAVELogging InsertJointValues GetLinkAccelerations
    SetDOFVelocities AddDeltaTimeGroup ConfigurationSpecification AddDerivativeGroups GetDOFMaxAccel GetDOFMaxVel
    ComputeHessianTranslation GetDOFResolutions CheckLimitsAction KinBody GetArmDOFValues GetGeometries
    SetDiffuseColor SetAmbientColor SetTransparency GetGlobalCOM ConvertTrajectorySpecification GetJointIndex
    CollisionOptionsStateSaver raveLogInfo drawlinelist AttachController SetPhysicsEngine RaveCreatePhysicsEngine
    GetSimulationTime GetEndEffector drawtrimesh LoadData GetChildDOFIndices GetHierarchyChildLink SetBkgndColor
    GetArmConfigurationSpecification GetActiveDOFResolutions GetTransformPose CalculateRotationJacobian IsEnabled
    axisAngleFromRotationMatrix SetUserData SetJointTorques SetForce GetAnchor DoesAffect GetMass SetVelocity
    ReverseTrajectory ReadRobotXMLFile GetGroupFromName GetWaypoints GetCylinderHeight CheckCollisionRays
    GetJointForceTorque GetDOFVelocities GetBoxExtents
""".split()  # noqa: SIM905 - as a list it has a line for each name
"""The first 250, in an order in which whole scripts become possible early; ``with_env`` stands for ``with env:``."""

PYMANOID = """
    Environment Load LoadData GetRobot GetBodies Remove with_env GetPhysicsEngine SetGravity GetViewer SetViewer
    RaveCreateKinBody InitFromBoxes Add SetName GetLinks GetDOF GetDOFValues SetDOFValues GetDOFVelocities
    SetDOFVelocities GetDOFLimits SetDOFLimits GetDOFVelocityLimits SetDOFVelocityLimits GetJointFromDOFIndex
    GetLink GetManipulator GetTransform SetTransform GetTransformPose GetIndex GetMass GetGlobalCOM GetLocalCOM
    GetLocalInertia GetVelocity GetGeometries GetName SetVisible SetAmbientColor SetDiffuseColor SetTransparency
    ComputeJacobianTranslation ComputeJacobianAxisAngle CalculateJacobian CalculateRotationJacobian
    ComputeHessianTranslation ComputeHessianAxisAngle GetLinkVelocities GetLinkAccelerations ComputeInverseDynamics
    SetCamera GetCameraTransform SetBkgndColor plot3 drawlinelist drawarrow drawtrimesh Close matrixFromPose
    quatFromRotationMatrix rotationMatrixFromQuat axisAngleFromQuat InterpolateQuatSlerp
""".split()  # noqa: SIM905 - as a list it has a line for each name
"""Those that pymanoid needs, a library for walking robots."""

BEHIND = {
    "CloseFingers": "interfaces.TaskManipulation",
    "InitPlan": "Planner",
    "MoveActiveJoints": "interfaces.BaseManipulation",
    "MoveManipulator": "interfaces.BaseManipulation",
    "MoveToHandPosition": "interfaces.BaseManipulation",
    "PlanPath": "Planner",
    "PlannerParameters": "Planner",
    "ReleaseFingers": "interfaces.TaskManipulation",
    "SetExtraParameters": "Planner.PlannerParameters",
    "SetGoalConfig": "Planner.PlannerParameters",
    "SetMaxIterations": "Planner.PlannerParameters",
    "SetPostProcessing": "Planner.PlannerParameters",
    "SetRobotActiveJoints": "Planner.PlannerParameters",
    "autogenerate": "databases.inversekinematics.InverseKinematicsModel",
    "model.load": "databases.inversekinematics.InverseKinematicsModel",
    "setRobotResolutions": "databases.linkstatistics.LinkStatisticsModel",
    "setRobotWeights": "databases.linkstatistics.LinkStatisticsModel",
}
"""Methods of objects that only planning, inverse kinematics and databases have."""
