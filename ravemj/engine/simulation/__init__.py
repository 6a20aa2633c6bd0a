"""Bodies, and the MuJoCo model made of them."""

from ravemj.engine.compiled import Compiled
from ravemj.engine.simulation.body import BodyState
from ravemj.engine.simulation.world import DEFAULT_GRAVITY, Simulation

__all__ = ["DEFAULT_GRAVITY", "BodyState", "Compiled", "Simulation"]
