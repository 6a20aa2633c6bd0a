"""Joint values and link poses of one body."""

from ravemj.engine.kinematics.body import WELDED, Ball, BodyKinematics, Configuration, Follower

__all__ = ["WELDED", "Ball", "BodyKinematics", "Configuration", "Follower"]
