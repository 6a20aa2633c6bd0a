"""Access to joint values, poses and times in the data of one configuration."""

from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import Floats, Pose
from ravemj.geometry_functions.affine import (
    DOFAffine,
    RaveGetAffineDOF,
    RaveGetAffineDOFFromIndex,
    RaveGetIndexFromAffineDOF,
    pose_with_values,
)
from ravemj.trajectories.groups import AFFINE, DELTATIME, IK, JOINTS, Group, affine_parts, joint_indices


def _of_body(groups: Sequence[Group], kind: str, body: str | None) -> list[Group]:
    return [group for group in groups if group.kind == kind and (body is None or group.body == body)]


def joint_values(
    groups: Sequence[Group], data: Floats, body: str | None, indices: Sequence[int], order: int
) -> Floats | None:
    """Return joint values or their derivatives; missing ones are 0.

    Returns:
        One value for each index, or None if there is no group of the body or no index is given.
    """
    matching = _of_body(groups, JOINTS[order], body)
    if not matching or not indices:
        return None
    values = np.zeros(len(indices))
    for group in matching:
        first_columns: dict[int, int] = {}  # many look-ups; a list would be slow
        for column, index in enumerate(joint_indices(group), group.offset):
            first_columns.setdefault(index, column)
        for place, index in enumerate(indices):
            if index in first_columns:
                values[place] = data[first_columns[index]]
    return values


def insert_joint_values(
    groups: Sequence[Group], data: Floats, values: Floats, body: str | None, indices: Sequence[int], order: int
) -> bool:
    """Write joint values into data; return False if there is no group of the body or no index is given."""
    matching = _of_body(groups, JOINTS[order], body)
    for group in matching if indices else ():
        for place, index in enumerate(joint_indices(group)):
            if index in indices:
                data[group.offset + place] = values[indices.index(index)]
    return bool(matching and indices)


def affine_values(groups: Sequence[Group], data: Floats, body: str | None, parts: int, order: int) -> Floats | None:
    """Return pose components (``DOFAffine``) or their derivatives; missing ones are 0."""
    matching = _of_body(groups, AFFINE[order], body)
    if not matching or not parts:
        return None
    values = np.zeros(RaveGetAffineDOF(parts))
    for group in matching:
        present = affine_parts(group)[0]
        for index in range(len(values)):
            part = RaveGetAffineDOFFromIndex(parts, index)
            if part & present:
                within = index - RaveGetIndexFromAffineDOF(parts, part)
                values[index] = data[group.offset + RaveGetIndexFromAffineDOF(present, part) + within]
    return values


def pose(groups: Sequence[Group], data: Floats, body: str | None, start: Pose) -> Pose | None:
    """Return the pose ``start`` with the components that the data has for the body; None if it has none."""
    matching = _of_body(groups, AFFINE[0], body)
    for group in matching:
        parts, axis = affine_parts(group)
        start = pose_with_values(start, data[group.columns], parts, axis)
    return start if matching else None


def ik_group(groups: Sequence[Group], robot: str, manipulator: str, order: int) -> Group | None:
    """Return the first IK goal of a robot and a manipulator, or None; empty names match any."""
    for group in groups:
        _, *owner = group.name.split()[1:] or [""]
        fits = all(name in {"", word} for name, word in zip((robot, manipulator), [*owner, "", ""], strict=False))
        if group.kind == IK[order] and fits:
            return group
    return None


def time_column(groups: Sequence[Group]) -> int | None:
    """Return the column of the time since the last waypoint."""
    return next((group.offset for group in groups if group.name == DELTATIME), None)


def used_bodies(groups: Sequence[Group]) -> list[str]:
    """Return the names of the bodies that have values in the data."""
    of_bodies = [group for group in groups if group.kind.startswith(("joint_", "affine_", "grabbody"))]
    return list(dict.fromkeys(group.body for group in of_bodies if group.body is not None))


def used_indices(groups: Sequence[Group], body: str) -> tuple[list[int], list[int]]:
    """Return the DOF indices of a body in the data, and the column of each."""
    places: dict[int, int] = {}
    for group in groups:
        if group.kind.startswith("joint_") and group.body == body and len(group.name.split()) > 2:
            for place, index in enumerate(joint_indices(group)):
                places.setdefault(index, group.offset + place)
    return list(places), list(places.values())


def rotation_columns(group: Group) -> tuple[DOFAffine, slice]:
    """Return the rotation type of an affine group (0: none), and the slice of its values."""
    kind = DOFAffine(affine_parts(group)[0] & DOFAffine.RotationMask)
    return kind, slice(group.dof - RaveGetAffineDOF(kind), group.dof)
