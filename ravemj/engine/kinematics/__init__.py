"""Joint values and link poses of one body."""

from ravemj.engine.kinematics.body import NO_QPOS, BodyKinematics, Configuration, SphericalJoint, fixed_view

__all__ = ["NO_QPOS", "BodyKinematics", "Configuration", "SphericalJoint", "fixed_view"]
