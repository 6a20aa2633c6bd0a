"""Physics engines, as far as gravity."""

from numpy.typing import ArrayLike

from ravemj.arrays import checked_vector
from ravemj.simulation import Simulation
from ravemj.transforms import Floats


class PhysicsEngine:
    """Holds gravity; ``env.GetPhysicsEngine()`` makes it. Nothing falls by itself."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def SetGravity(self, gravity: ArrayLike) -> None:
        """Set the acceleration of free fall in the world [m/s^2], shape (3,)."""
        x, y, z = checked_vector(gravity, 3, "gravity").tolist()
        self._simulation.set_gravity((x, y, z))

    def GetGravity(self) -> Floats:
        """Return the acceleration of free fall in the world [m/s^2], shape (3,)."""
        return checked_vector(self._simulation.gravity, 3, "gravity")

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the engine."""
        return "GenericPhysicsEngine"
