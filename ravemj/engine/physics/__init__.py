"""Physics: MuJoCo's dynamics of bodies."""

from ravemj.engine.physics.loads import Loads, Motor, Spring
from ravemj.engine.physics.world import Physics

__all__ = ["Loads", "Motor", "Physics", "Spring"]
