"""OpenRAVE's enumerations, with OpenRAVE's numbers."""

from ravemj.core.enumerations import NamedFlag, NamedInt


class CheckLimitsAction(NamedInt):
    """What setters of joint values and velocities do with values outside the limits."""

    Nothing = 0
    """Set them as they are."""
    CheckLimits = 1
    """Move them to the limit, with a warning."""
    CheckLimitsSilent = 2
    """Move them to the limit."""
    CheckLimitsThrow = 3
    """Raise, and change nothing."""


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
    """What ``env.Add`` does when the name is taken; True and False in its place are OpenRAVE 0.9's ``anonymous``."""

    AllowRenaming = 0
    """Add it under a name of its own."""
    StrictNameChecking = 1
    """Raise."""
    StrictIdChecking = 2
    """Add it under a name of its own; ids are never changed here."""
    StrictNameIdChecking = 3
    """Raise."""


class SaveParameters(NamedFlag):
    """What a state saver keeps and restores."""

    LinkTransformation = 0x1
    """Poses of the links and joint values."""
    LinkEnable = 0x2
    """Which links collision checking looks at."""
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
    """Which connected bodies are active."""


class EnvironmentCreateOptions(NamedFlag):
    """What ``Environment`` begins with; without meaning here, since time begins to pass once it is wanted."""

    ECO_StartSimulationThread = 1


class CloningOptions(NamedFlag):
    """What a clone of an environment takes over."""

    Bodies = 1
    Viewer = 2
    Simulation = 4
    RealControllers = 8
    Sensors = 16
    Modules = 32
    PassOnMissingBodyReferences = 0x8000
    IgnoreGrabbedBodies = 0x10000
    """Copies hold nothing."""


class UpdateFromInfoMode(NamedInt):
    """What ``env.UpdateFromInfo`` does with bodies that the info does not name."""

    Exact = 0
    """Remove them."""
    OnlySpecifiedBodiesExact = 1
    """Leave them."""


class UpdateFromInfoResult(NamedInt):
    """How an object took over an info."""

    NoChange = 0
    Success = 1
    RequireRemoveFromEnvironment = 2
    RequireReinitialize = 3


class GrabbedInfoCheckResult(NamedInt):
    """What ``body.CheckGrabbedInfo`` finds."""

    Identical = 0
    BodyNotGrabbed = 1
    GrabbingLinkNotMatch = 2
    IgnoredLinksNotMatch = 3


class DebugLevel(NamedInt):
    """How much is logged; each level includes those before it."""

    Fatal = 0
    Error = 1
    Warn = 2
    Info = 3
    Debug = 4
    Verbose = 5
    VerifyPlans = 0x80000000
    """A bit beside the level."""


class IkFilterOptions(NamedFlag):
    """Which solutions of inverse kinematics are left out."""

    CheckEnvCollisions = 1
    IgnoreSelfCollisions = 2
    IgnoreJointLimits = 4
    IgnoreCustomFilters = 8
    IgnoreEndEffectorEnvCollisions = 0x10
    IgnoreEndEffectorCollisions = 0x10
    """The name of version 0.9."""
    IgnoreEndEffectorSelfCollisions = 0x20


class IkReturnAction(NamedFlag):
    """What a filter says about a solution of inverse kinematics, and why it was rejected."""

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
    """What collision checking looks for and reports; combine them with ``|``."""

    Distance = 0x1
    """``report.minDistance`` is the least distance of what is tested."""
    UseTolerance = 0x2
    """``report.numWithinTol`` is the number of pairs of shapes that are nearer than the tolerance."""
    Contacts = 0x4
    """Reports have contact points."""
    RayAnyHit = 0x8
    """For rays any hit will do; here it is the nearest all the same."""
    ActiveDOFs = 0x10
    """Only links that the robot's active DOFs move are tested."""
    AllLinkCollisions = 0x20
    """Reports have all pairs of links that collide, not only the first."""
    AllGeometryCollisions = 0x40
    """Reports have each pair of geometries by itself."""
    AllGeometryContacts = 0x80
    """Reports have contact points of all pairs of geometries."""
    IgnoreCallbacks = 0x100
    """Functions of ``env.RegisterCollisionCallback`` are not called."""


class CollisionAction(NamedInt):
    """What a function of ``env.RegisterCollisionCallback`` says about a collision."""

    DefaultAction = 0
    """It counts."""
    Ignore = 1
    """It does not count."""


class AdjacentOptions(NamedFlag):
    """Which pairs of links ``GetNonAdjacentLinks`` returns; combine them with ``|``."""

    Enabled = 1
    """Those of enabled links."""
    ActiveDOFs = 2
    """Those that the active DOFs move against each other."""


class TriangulateOptions(NamedInt):
    """Which bodies ``TriangulateScene`` takes; also called ``SelectionOptions``."""

    Obstacles = 1
    NoRobots = 1
    Robots = 2
    Everything = 3
    Body = 4
    AllExceptBody = 5


SelectionOptions = TriangulateOptions


class SerializationOptions(NamedFlag):
    """What of a body goes into its hash."""

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
    """What ``sensor.Configure`` is asked to do; ``Sensor.ConfigureCommand``."""

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
    """How planning ended."""

    Failed = 0
    HasSolution = 1
    Interrupted = 2
    InterruptedWithSolution = 3


class PhysicsEngineOptions(NamedFlag):
    """What physics engines look at."""

    SelfCollisions = 1
    """Links of one body collide with one another."""


class PlannerAction(NamedInt):
    """What a function of ``planner.RegisterPlanCallback`` says."""

    vars()["None"] = 0  # OpenRAVE's name, which Python keeps for itself
    Interrupt = 1
    """Stop."""
    ReturnWithAnySolution = 2
    """Stop if there is a path already, however long."""


class Interval(NamedFlag):
    """Which ends of an interval belong to it; and how values between waypoints are interpolated."""

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
    """What tests of configurations look at."""

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
