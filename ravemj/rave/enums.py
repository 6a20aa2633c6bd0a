"""OpenRAVE's enumerations, with OpenRAVE's numbers."""

from enum import IntEnum, IntFlag


class CheckLimitsAction(IntEnum):
    """What setters of joint values and velocities do with values outside the limits."""

    Nothing = 0
    """Set them as they are."""
    CheckLimits = 1
    """Move them to the limit, with a warning."""
    CheckLimitsSilent = 2
    """Move them to the limit."""
    CheckLimitsThrow = 3
    """Raise, and change nothing."""


class JointType(IntEnum):
    """Kinds of joints."""

    Hinge = 0x01
    Slider = 0x11
    Universal = 0x80000001
    Hinge2 = 0x80000002
    Spherical = 0x80000003
    Trajectory = 0x80000004


class GeometryType(IntEnum):
    """Kinds of shapes."""

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


class SensorType(IntEnum):
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


class InterfaceType(IntEnum):
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


class InterfaceAddMode(IntEnum):
    """What ``env.Add`` does when the name is taken."""

    StrictNameChecking = 0
    """Raise."""
    AllowRenaming = 1
    """Add it under a name of its own."""


class SaveParameters(IntFlag):
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


class CloningOptions(IntFlag):
    """What a clone of an environment takes over."""

    Bodies = 1
    Viewer = 2
    Simulation = 4
    RealControllers = 8
    Sensors = 16
    Modules = 32
    PassOnMissingBodyReferences = 0x8000
