"""``openravepy.interfaces``: helpers that plan, move and grasp."""

from ravemj.compat.interfaces import missing
from ravemj.compat.interfaces.base_manipulation import BaseManipulation
from ravemj.compat.interfaces.missing import Grasper, VisualFeedback
from ravemj.compat.interfaces.task_manipulation import TaskManipulation

__all__ = ["BaseManipulation", "Grasper", "TaskManipulation", "VisualFeedback"]


def __getattr__(name: str) -> object:
    """Return a helper that only OpenRAVE 0.9 has."""
    if name == "TaskCaging":
        return missing.TaskCaging
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
