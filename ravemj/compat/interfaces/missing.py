"""Helpers that ravemj does not have; their constructors raise ``UnsupportedError``, a ``NotImplementedError``."""

from collections.abc import Callable

from ravemj.errors import UnsupportedError


class TaskCaging:
    """Opens doors by caging their handles."""

    def __init__(self, robot: object, plannername: str | None = None, maxvelmult: float | None = None) -> None:
        raise UnsupportedError("interfaces.TaskCaging", "caging of handles")


class VisualFeedback:
    """Moves a camera to where it sees an object."""

    def __init__(
        self, robot: object, maxvelmult: float | None = None, ignoresensorcollision: bool | None = None
    ) -> None:
        raise UnsupportedError("interfaces.VisualFeedback", "visual feedback")


class Grasper:
    """Simulates how a hand closes around a body, and rates the grasp."""

    def __init__(
        self, robot: object, friction: float = 0.3, avoidlinks: object = None, plannername: str | None = None
    ) -> None:
        raise UnsupportedError("interfaces.Grasper", "planning of grasps")


def _refused(name: str, capability: str) -> Callable[..., None]:
    def refuse(*args: object, **named: object) -> None:
        raise UnsupportedError(name, capability)

    refuse.__doc__ = f"Raise ``UnsupportedError``: ravemj does no {capability}."
    return refuse


_COMMANDS = {
    VisualFeedback: (
        "visual feedback",
        "ComputeVisibility ComputeVisibleConfiguration MoveToObserveTarget ProcessVisibilityExtents "
        "SampleVisibilityGoal SetCameraAndTarget SetCameraTransforms SetParameter VisualFeedbackGrasping clone",
    ),
    Grasper: ("planning of grasps", "ConvexHull Grasp GraspThreaded clone"),
}
for _kind, (_capability, _names) in _COMMANDS.items():
    for _name in _names.split():
        setattr(_kind, _name, _refused(f"interfaces.{_kind.__name__}.{_name}", _capability))
