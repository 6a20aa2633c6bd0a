"""Types of IK goals."""

from ravemj.core.enumerations import NamedInt


class IkParameterizationType(NamedInt):
    """Constrained components of the tool pose.

    Each number encodes the degrees of freedom, the number of values, and a unique number.

    Types that end in ``Velocity`` are velocities in trajectories, not goals.
    """

    none = 0
    Transform6D = 0x67000001
    Rotation3D = 0x34000002
    Translation3D = 0x33000003
    Direction3D = 0x23000004
    Ray4D = 0x46000005
    Lookat3D = 0x23000006
    TranslationDirection5D = 0x56000007
    TranslationXY2D = 0x22000008
    TranslationXYOrientation3D = 0x33000009
    TranslationLocalGlobal6D = 0x3600000A
    TranslationXAxisAngle4D = 0x4400000B
    TranslationYAxisAngle4D = 0x4400000C
    TranslationZAxisAngle4D = 0x4400000D
    TranslationXAxisAngleZNorm4D = 0x4400000E
    TranslationYAxisAngleXNorm4D = 0x4400000F
    TranslationZAxisAngleYNorm4D = 0x44000010
    Transform6DVelocity = 0x67008001
    Rotation3DVelocity = 0x34008002
    Translation3DVelocity = 0x33008003
    Direction3DVelocity = 0x23008004
    Ray4DVelocity = 0x46008005
    Lookat3DVelocity = 0x23008006
    TranslationDirection5DVelocity = 0x56008007
    TranslationXY2DVelocity = 0x22008008
    TranslationXYOrientation3DVelocity = 0x33008009
    TranslationLocalGlobal6DVelocity = 0x3600800A
    TranslationXAxisAngle4DVelocity = 0x4400800B
    TranslationYAxisAngle4DVelocity = 0x4400800C
    TranslationZAxisAngle4DVelocity = 0x4400800D
    TranslationXAxisAngleZNorm4DVelocity = 0x4400800E
    TranslationYAxisAngleXNorm4DVelocity = 0x4400800F
    TranslationZAxisAngleYNorm4DVelocity = 0x44008010
    VelocityDataBit = 0x8000
    UniqueIdMask = 0xFFFF
    CustomDataBit = 0x10000


GOAL_TYPES = frozenset(kind for kind in IkParameterizationType if kind >> 24 and not kind & 0x8000)
"""Types of goals."""


def goal_dof(kind: int) -> int:
    """Return the number of degrees of freedom that a goal type constrains."""
    return int(kind) >> 28 & 0xF


def goal_size(kind: int) -> int:
    """Return the number of values of a goal type."""
    return int(kind) >> 24 & 0xF
