"""OpenRAVE's enumerations, with OpenRAVE's numbers."""

from ravemj.core.enumerations import NamedFlag, NamedInt


class CheckLimitsAction(NamedInt):
    """Treatment of joint values and velocities outside the limits."""

    Nothing = 0
    """Accept values outside the limits."""
    CheckLimits = 1
    """Clamp values to the limits, with a warning."""
    CheckLimitsSilent = 2
    """Clamp values to the limits."""
    CheckLimitsThrow = 3
    """Raise an error for a value outside the limits, and change nothing."""


class JointType(NamedInt):
    """Kinds of joints."""

    vars()["None"] = 0  # OpenRAVE's name, which Python keeps for itself
    Hinge = Revolute = 0x01
    Slider = Prismatic = 0x11
    RR = 0x02
    RP = 0x12
    PR = 0x22
    PP = 0x32
    Universal = 0x80000001
    Hinge2 = 0x80000002
    Spherical = 0x80000003
    Trajectory = 0x80000004


class GeometryType(NamedInt):
    """Kinds of shapes."""

    vars()["None"] = 0  # OpenRAVE's name, which Python keeps for itself
    None_ = 0
    Box = 1
    Sphere = 2
    Cylinder = 3
    Trimesh = 4
    Container = 5
    Cage = 6
    CalibrationBoard = 7
    Axial = 8
    ConicalFrustum = 9
    Prism = 10
    Capsule = 11


class SensorType(NamedInt):
    """Kinds of sensors."""

    Invalid = 0
    Laser = 1
    Camera = 2
    JointEncoder = 3
    Force6D = 4
    IMU = 5
    Odometry = 6
    Tactile = 7
    Actuator = 8


class InterfaceType(NamedInt):
    """Kinds of objects that OpenRAVE's plugins make."""

    planner = 1
    robot = 2
    sensorsystem = 3
    controller = 4
    module = 5
    probleminstance = 5
    iksolver = 6
    kinbody = 7
    physicsengine = 8
    sensor = 9
    collisionchecker = 10
    trajectory = 11
    viewer = 12
    spacesampler = 13


class InterfaceAddMode(NamedInt):
    """Treatment of a name that is already taken in ``env.Add``; True and False are OpenRAVE 0.9's ``anonymous``."""

    AllowRenaming = 0
    """Add the object under a new, unique name."""
    StrictNameChecking = 1
    """Raise an error."""
    StrictIdChecking = 2
    """Add the object under a new, unique name; ravemj never changes ids."""
    StrictNameIdChecking = 3
    """Raise an error."""


class SaveParameters(NamedFlag):
    """Parts of the state that a state saver saves and restores."""

    LinkTransformation = 0x1
    """Poses of the links and joint values."""
    LinkEnable = 0x2
    """Whether each link takes part in collision checks."""
    LinkVelocities = 0x4
    JointMaxVelocityAndAcceleration = 0x8
    JointWeights = 0x10
    JointLimits = 0x20
    JointResolutions = 0x40
    ActiveDOF = 0x10000
    ActiveManipulator = 0x20000
    GrabbedBodies = 0x40000
    ActiveManipulatorToolTransform = 0x80000
    ManipulatorsToolTransform = 0x100000
    ConnectedBodies = 0x200000
    """Whether each connected body is active."""


class EnvironmentCreateOptions(NamedFlag):
    """Options of a new ``Environment``; without effect, since simulation time starts on demand."""

    ECO_StartSimulationThread = 1


class CloningOptions(NamedFlag):
    """Parts of an environment that a clone copies."""

    Bodies = 1
    Viewer = 2
    Simulation = 4
    RealControllers = 8
    Sensors = 16
    Modules = 32
    PassOnMissingBodyReferences = 0x8000
    IgnoreGrabbedBodies = 0x10000
    """Robots of the copy grab no bodies."""


class UpdateFromInfoMode(NamedInt):
    """Treatment of bodies that the info of ``env.UpdateFromInfo`` does not name."""

    Exact = 0
    """Remove bodies that the info does not name."""
    OnlySpecifiedBodiesExact = 1
    """Keep bodies that the info does not name."""


class UpdateFromInfoResult(NamedInt):
    """Result of updating an object from an info."""

    NoChange = 0
    Success = 1
    RequireRemoveFromEnvironment = 2
    RequireReinitialize = 3


class GrabbedInfoCheckResult(NamedInt):
    """Result of ``body.CheckGrabbedInfo``."""

    Identical = 0
    BodyNotGrabbed = 1
    GrabbingLinkNotMatch = 2
    IgnoredLinksNotMatch = 3


class DebugLevel(NamedInt):
    """Log levels; each includes those before it."""

    Fatal = 0
    Error = 1
    Warn = 2
    Info = 3
    Debug = 4
    Verbose = 5
    VerifyPlans = 0x80000000
    """Flag that can be added to a level; it has no effect."""


class IkFilterOptions(NamedFlag):
    """Tests of IK solutions to apply or to skip; combine them with ``|``."""

    CheckEnvCollisions = 1
    IgnoreSelfCollisions = 2
    IgnoreJointLimits = 4
    IgnoreCustomFilters = 8
    IgnoreEndEffectorEnvCollisions = 0x10
    IgnoreEndEffectorCollisions = 0x10
    """OpenRAVE 0.9's name of ``IgnoreEndEffectorEnvCollisions``."""
    IgnoreEndEffectorSelfCollisions = 0x20


class IkReturnAction(NamedFlag):
    """Answer of an IK filter about a solution, and reasons of rejection."""

    Success = 0
    Reject = 1
    Quit = 2
    QuitEndEffectorCollision = 0x82
    RejectKinematics = 0x11
    RejectSelfCollision = 0x21
    RejectEnvCollision = 0x41
    RejectJointLimits = 0x101
    RejectKinematicsPrecision = 0x201
    RejectCustomFilter = 0x8001


class CollisionOptions(NamedFlag):
    """Options of collision checks and reports; combine them with ``|``."""

    Distance = 0x1
    """Compute ``report.minDistance``, the smallest distance between the tested geometries."""
    UseTolerance = 0x2
    """Compute ``report.numWithinTol``, the number of geometry pairs closer than the tolerance."""
    Contacts = 0x4
    """Reports have contact points."""
    RayAnyHit = 0x8
    """Any hit of a ray suffices; ravemj returns the nearest one all the same."""
    ActiveDOFs = 0x10
    """Only links that the robot's active DOFs move are tested."""
    AllLinkCollisions = 0x20
    """Reports have all pairs of links that collide, not only the first."""
    AllGeometryCollisions = 0x40
    """Reports have one entry for each pair of geometries."""
    AllGeometryContacts = 0x80
    """Reports have contact points of all pairs of geometries."""
    IgnoreCallbacks = 0x100
    """Do not call the callbacks of ``env.RegisterCollisionCallback``."""


class CollisionAction(NamedInt):
    """Answer of a callback of ``env.RegisterCollisionCallback``."""

    DefaultAction = 0
    """Count the collision."""
    Ignore = 1
    """Ignore the collision."""


class AdjacentOptions(NamedFlag):
    """Selection of the link pairs that ``GetNonAdjacentLinks`` returns; combine with ``|``."""

    Enabled = 1
    """Pairs of enabled links."""
    ActiveDOFs = 2
    """Pairs of links that the active DOFs move relative to each other."""


class TriangulateOptions(NamedInt):
    """Selection of the bodies that ``TriangulateScene`` returns; also called ``SelectionOptions``."""

    Obstacles = 1
    NoRobots = 1
    Robots = 2
    Everything = 3
    Body = 4
    AllExceptBody = 5


SelectionOptions = TriangulateOptions


class SerializationOptions(NamedFlag):
    """Parts of a body that its hash depends on."""

    Kinematics = 1
    Dynamics = 2
    BodyState = 4
    NamesAndFiles = 8
    RobotManipulators = 0x10
    RobotSensors = 0x20
    Geometry = 0x40
    InverseKinematics = 0x80
    JointLimits = 0x100


class SensorCommand(NamedInt):
    """Commands of ``sensor.Configure``; also ``Sensor.ConfigureCommand``."""

    PowerOn = 0x10
    PowerOff = 0x11
    PowerCheck = 0x12
    RenderDataOn = 0x20
    RenderDataOff = 0x21
    RenderDataCheck = 0x23
    RenderGeometryOn = 0x30
    RenderGeometryOff = 0x31
    RenderGeometryCheck = 0x32


class PlannerStatusCode(NamedFlag):
    """Result of planning."""

    Failed = 0
    HasSolution = 1
    Interrupted = 2
    InterruptedWithSolution = 3


class PhysicsEngineOptions(NamedFlag):
    """Options of physics engines."""

    SelfCollisions = 1
    """Links of one body collide with one another."""


class PlannerAction(NamedInt):
    """Answer of a callback of ``planner.RegisterPlanCallback``."""

    vars()["None"] = 0  # OpenRAVE's name, which Python keeps for itself
    Interrupt = 1
    """Stop planning."""
    ReturnWithAnySolution = 2
    """Stop planning if a path, of any length, has been found."""


class Interval(NamedFlag):
    """Flags: which end points belong to an interval, and OpenRAVE's kinds of interpolation, such as ``Cubic``."""

    Open = Default = 0
    OpenStart = 1
    OpenEnd = 2
    Closed = 3
    IntervalMask = 0xFFFF
    AllLinear = 0x10000
    Cubic = 0x20000
    Quintic = 0x40000
    InterpolationMask = 0xFFFF0000


class ConstraintFilterOptions(NamedFlag):
    """Tests that a constraint check applies to configurations."""

    CheckEnvCollisions = 1
    CheckSelfCollisions = 2
    CheckTimeBasedConstraints = 4
    BreakOnFirstValidation = 8
    CheckUserConstraints = 0x8000
    RecommendedOptions = 0xFFFF
    CheckWithPerturbation = 0x10000
    FillCheckedConfiguration = 0x20000
    FillCollisionReport = 0x40000
    FromPathSampling = 0x80000
    FromPathShortcutting = 0x100000
    FromTrajectorySmoother = 0x200000
    FinalValuesNotReached = 0x40000000
    StateSettingError = 0x80000000
