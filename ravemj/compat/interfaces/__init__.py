"""``openravepy.interfaces``: helpers that plan motions and grasps."""

from ravemj.compat.interfaces import missing
from ravemj.compat.interfaces.base_manipulation import BaseManipulation
from ravemj.compat.interfaces.grasper import Grasper
from ravemj.compat.interfaces.missing import VisualFeedback
from ravemj.compat.interfaces.task_manipulation import TaskManipulation

__all__ = ["BaseManipulation", "Grasper", "TaskManipulation", "VisualFeedback"]


def __getattr__(name: str) -> object:
    """Return a helper that exists only in OpenRAVE 0.9."""
    if name == "TaskCaging":
        return missing.TaskCaging
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
