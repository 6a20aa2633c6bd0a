"""Helpers that ravemj does not have; their constructors raise ``UnsupportedError``, a ``NotImplementedError``."""

from ravemj.errors import UnsupportedError


class TaskCaging:
    """Opens doors by caging their handles."""

    def __init__(self, robot: object, plannername: str | None = None, maxvelmult: float | None = None) -> None:
        raise UnsupportedError("interfaces.TaskCaging", "caging of handles")


class VisualFeedback:
    """Moves a camera to where it sees an object."""

    def __init__(self, robot: object, maxvelmult: float | None = None) -> None:
        raise UnsupportedError("interfaces.VisualFeedback", "visual feedback")


class Grasper:
    """Simulates how a hand closes around a body, and rates the grasp."""

    def __init__(
        self, robot: object, friction: float = 0.3, avoidlinks: object = None, plannername: str | None = None
    ) -> None:
        raise UnsupportedError("interfaces.Grasper", "planning of grasps")
