"""What bodies do in time: MuJoCo's dynamics."""

from ravemj.physics.loads import Loads, Motor
from ravemj.physics.world import Physics

__all__ = ["Loads", "Motor", "Physics"]
