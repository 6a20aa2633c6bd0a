"""The runtime: bodies, and the MuJoCo model made of them."""

from ravemj.simulation.body import BodyState
from ravemj.simulation.compiled import Compiled
from ravemj.simulation.world import DEFAULT_GRAVITY, Simulation

__all__ = ["DEFAULT_GRAVITY", "BodyState", "Compiled", "Simulation"]
