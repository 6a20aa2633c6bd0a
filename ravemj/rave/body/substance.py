"""What a body weighs, and whether it is drawn."""

from ravemj.rave.body.structure import Mechanism


class Substance(Mechanism):
    """Mass and visibility of all links together."""

    def GetMass(self) -> float:
        """Return the mass of all links [kg]."""
        return sum(link.inertial.mass for link in self._state.scene.links)

    def IsVisible(self) -> bool:
        """Return whether any shape of the body is drawn."""
        return any(link.IsVisible() for link in self.GetLinks())

    def SetVisible(self, visible: bool) -> bool:
        """Draw all shapes of the body, or none; they collide all the same.

        Args:
            visible: Whether to draw them.

        Returns:
            Whether that changed something.
        """
        with self._simulation.lock:
            return any([link.SetVisible(visible) for link in self.GetLinks()])
