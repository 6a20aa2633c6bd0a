"""Bodies, and their common MuJoCo model."""

from ravemj.engine.compiled import Compiled
from ravemj.engine.simulation.body import BodyState
from ravemj.engine.simulation.world import DEFAULT_GRAVITY, Simulation, both_locks

__all__ = ["DEFAULT_GRAVITY", "BodyState", "Compiled", "Simulation", "both_locks"]
