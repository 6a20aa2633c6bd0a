"""``openravepy.interfaces``: helpers that plan, move and grasp in OpenRAVE; ravemj has none yet.

Every constructor raises ``UnsupportedError``, which is a ``NotImplementedError``.
"""

from ravemj.errors import UnsupportedError
from ravemj.rave.plugins import PLANNING


class BaseManipulation:
    """Plans and executes motions of an arm."""

    def __init__(self, robot: object, plannername: str | None = None, maxvelmult: float | None = None) -> None:
        raise UnsupportedError("interfaces.BaseManipulation", PLANNING)


class TaskManipulation:
    """Opens and closes a gripper, and grasps."""

    def __init__(
        self,
        robot: object,
        plannername: str | None = None,
        maxvelmult: float | None = None,
        graspername: str | None = None,
    ) -> None:
        raise UnsupportedError("interfaces.TaskManipulation", PLANNING)


class TaskCaging:
    """Opens doors by caging their handles."""

    def __init__(self, robot: object, plannername: str | None = None, maxvelmult: float | None = None) -> None:
        raise UnsupportedError("interfaces.TaskCaging", PLANNING)


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
