"""Conversion of data between layouts."""

from collections.abc import Callable, Sequence

import numpy as np

from ravemj.core.transforms import Floats, Pose
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import arguments
from ravemj.geometry_functions.affine import (
    DOFAffine,
    affine_values,
    pose_with_values,
    rotation_values,
)
from ravemj.trajectories.extraction import rotation_columns
from ravemj.trajectories.groups import AFFINE, JOINTS, Group, affine_parts, joint_indices
from ravemj.trajectories.layout import find_compatible

FindBody = Callable[[str], BodyState | None]
"""Function that returns a body by its name, or None, such as ``Simulation.body``."""


def nobody(name: str) -> None:
    """Return None, as a ``FindBody`` that finds no bodies."""
    del name


def converted(
    source_groups: Sequence[Group],
    source: Floats,
    target_groups: Sequence[Group],
    target: Floats,
    find_body: FindBody | None,
    find_missing: FindBody | None = None,
) -> Floats:
    """Return data converted to another layout.

    Args:
        source_groups: The layout of the data.
        source: The data, a configuration in each row.
        target_groups: The layout of the result.
        target: The initial result, which is copied, with the same number of rows.
        find_body: Finds the bodies whose present state supplies missing values; None keeps those of ``target``.
        find_missing: Finds the bodies that supply entirely missing groups; by default ``find_body``.
    """
    result = target.copy()
    for group in target_groups:
        match = find_compatible(source_groups, group.name)
        into = result[:, group.columns]
        if match is not None:
            convert_group(match, source[:, match.columns], group, into, find_body)
        elif find_body is not None:
            into[:] = _present(group, find_missing or find_body)
    return result


def convert_group(
    source_group: Group, source: Floats, target_group: Group, target: Floats, find_body: FindBody | None
) -> None:
    """Write the values of a group, one configuration per row, into ``target``, the values of a group of the same kind.

    Raises:
        ArgumentError: the groups have nothing in common.
    """
    if source_group.name == target_group.name or target_group.kind.startswith("ikparam_"):
        if source_group.dof != target_group.dof:
            raise ArgumentError(f"group '{target_group.name}' has {source_group.dof} values, and {target_group.dof}")
        target[:] = source
        return
    if find_body is not None:
        target[:] = _present(target_group, find_body)
    if target_group.kind in AFFINE:
        _convert_affine(source_group, source, target_group, target)
        return
    present, wanted = _labels(source_group), _labels(target_group)
    for place, label in enumerate(wanted):
        if label in present:
            target[:, place] = source[:, present.index(label)]


def _labels(group: Group) -> Sequence[int | str]:
    """Return labels that identify the values of a group, such as DOF indices."""
    if group.kind in JOINTS or group.kind in {"joint_torques", "grab"}:
        return joint_indices(group)
    if group.kind == "outputSignals":
        return group.name.split()[1:]
    raise ArgumentError(f"group '{group.name}' cannot be converted")


def _convert_affine(source_group: Group, source: Floats, target_group: Group, target: Floats) -> None:
    source_kind, source_turn = rotation_columns(source_group)
    target_kind, target_turn = rotation_columns(target_group)
    positions = [_positions(group) for group in (source_group, target_group)]
    for place, part in enumerate(positions[1]):
        if part in positions[0]:
            target[:, place] = source[:, positions[0].index(part)]
    if source_kind == target_kind:
        target[:, target_turn] = source[:, source_turn]
    elif source_kind and target_kind:
        if target_group.kind != AFFINE[0]:
            raise ArgumentError(f"group '{source_group.name}' cannot be converted into '{target_group.name}'")
        source_axis, target_axis = affine_parts(source_group)[1], affine_parts(target_group)[1]
        for row, values in enumerate(source[:, source_turn]):
            turned = pose_with_values(Pose(), values, source_kind, source_axis)
            target[row, target_turn] = rotation_values(turned, target_kind, target_axis)


def _positions(group: Group) -> list[DOFAffine]:
    parts = affine_parts(group)[0]
    return [part for part in (DOFAffine.X, DOFAffine.Y, DOFAffine.Z) if part & parts]


def _present(group: Group, find_body: FindBody) -> Floats:
    """Return a group's values in the present scene; unknown numbers are 0, unknown poses the identity."""
    body = None if group.body is None else find_body(group.body)
    if group.kind == AFFINE[0]:
        parts, axis = affine_parts(group)
        return affine_values(Pose() if body is None else _pose(body), parts, axis)
    if group.kind == "outputSignals":
        return np.full(group.dof, -1.0)
    if body is None or group.kind not in JOINTS[:2]:
        return np.zeros(group.dof)
    with body.simulation.lock:
        if group.kind == JOINTS[0]:
            values = body.kinematics.values()
        else:
            values = body.dynamics.dof_velocities(body.link_velocities())
    return np.array([values[index] if 0 <= index < len(values) else 0.0 for index in joint_indices(group)])


def _pose(body: BodyState) -> Pose:
    """Return the pose of the first link, which is OpenRAVE's pose of a body."""
    if not body.scene.links:
        return Pose()
    with body.simulation.lock:
        return arguments.pose(body.link_transform(0), "transform")
