"""Convex parts of the links; MuJoCo makes its own hulls."""

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.rave.robot import Robot


class ConvexDecompositionModel(DatabaseGenerator):
    """Convex parts of the links, which need no computing here: collisions use hulls anyway.

    Args:
        robot: The robot.
        padding: For OpenRAVE.
    """

    def __init__(self, robot: Robot, padding: float = 0.0) -> None:
        del padding
        super().__init__(robot)

    def load(self) -> bool:
        """Return whether there is something to use: True."""
        return True

    def autogenerate(self, options: object = None) -> None:
        """Do nothing."""

    def save(self) -> None:
        """Do nothing."""
