"""OpenRAVE's enumerations, with OpenRAVE's numbers."""

from enum import IntEnum


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
