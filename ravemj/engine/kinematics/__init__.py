"""Joint values and link poses of one body."""

from ravemj.engine.kinematics.body import NO_QPOS, BodyKinematics, Configuration, fixed_view
from ravemj.engine.kinematics.spherical import SphericalJoint

__all__ = ["NO_QPOS", "BodyKinematics", "Configuration", "SphericalJoint", "fixed_view"]
