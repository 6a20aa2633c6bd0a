"""What bodies do in time: MuJoCo's dynamics."""

from ravemj.engine.physics.loads import Loads, Motor
from ravemj.engine.physics.spring import Spring
from ravemj.engine.physics.world import Physics

__all__ = ["Loads", "Motor", "Physics", "Spring"]
