"""IK solver names in model files."""

from collections.abc import Sequence

from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType


def named_in_file(name: str, dof: int) -> tuple[IkParameterizationType, list[float] | None] | None:
    """Parse the name of an IK solver in a file; return the goal type and the steps of free joints.

    The result is None if OpenRAVE's plugin ikfastsolvers has no solver of this name for an arm of ``dof`` joints.
    """
    first, *rest = name.split()
    words = [goal_type for goal_type in GOAL_TYPES if any(goal_type.name in word.split(".") for word in rest)]
    steps = numbers_in([word for word in rest if not words or word[0].isdigit()])
    kind = words[0] if words else _KINDS.get(min(dof, _POSE_JOINTS))
    return None if kind is None or steps is None or "ikfast" not in first.lower() else (kind, steps or None)


_POSE_JOINTS = 6
_KINDS = {
    _POSE_JOINTS: IkParameterizationType.Transform6D,
    5: IkParameterizationType.TranslationDirection5D,
    3: IkParameterizationType.Translation3D,
}
"""Default goal type by number of arm joints."""


def numbers_in(words: Sequence[str]) -> list[float] | None:
    """Convert words to numbers; return None if a word is not a number."""
    try:
        return [float(word) for word in words]
    except ValueError:
        return None
