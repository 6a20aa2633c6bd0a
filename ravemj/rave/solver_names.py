"""Solvers of inverse kinematics by the names in files."""

from collections.abc import Sequence

from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType


def named_in_file(name: str, dof: int) -> tuple[IkParameterizationType, list[float] | None] | None:
    """Return the type and the steps of the solver that a file names for an arm of ``dof`` joints.

    None if no solver of OpenRAVE's plugin ikfastsolvers has such a name and so many joints.
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
"""The type of goal by the number of joints."""


def numbers_in(words: Sequence[str]) -> list[float] | None:
    """Return words as numbers; None if one is no number."""
    try:
        return [float(word) for word in words]
    except ValueError:
        return None
