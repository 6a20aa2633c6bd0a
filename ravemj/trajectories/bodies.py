"""Layouts of bodies: their joints, then their pose."""

from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import Floats, Pose, pose_of
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions.affine import DOFAffine, RaveGetAffineDOF, pose_with_values
from ravemj.trajectories.groups import AFFINE, JOINTS, Group
from ravemj.trajectories.layout import packed


def body_groups(name: str, indices: Sequence[int], affinedofs: int, interpolation: str) -> list[Group]:
    """Return the layout of joints of a body, then of pose components (``DOFAffine``), without empty groups."""
    joints = Group(" ".join([JOINTS[0], name, *map(str, indices)]), 0, len(indices), interpolation)
    if not affinedofs:
        return [joints] if joints.dof else []
    affine = Group(f"{AFFINE[0]} {name} {int(affinedofs)}", 0, RaveGetAffineDOF(affinedofs), interpolation)
    return packed([group for group in (joints, affine) if group.dof])


def configuration_values(joint_values: Floats, T_world_link0: Floats) -> Floats:
    """Return the joint values and the pose (x, y, z, qw, qx, qy, qz) of a body in one vector."""
    position, wxyz = pose_of(T_world_link0)
    return np.concatenate((joint_values, position + wxyz))


def split_configuration(values: Floats, dof: int) -> tuple[Floats, Pose]:
    """Split the values of a whole body into joint values and pose.

    Raises:
        ArgumentError: their number is not ``dof`` + 7.
    """
    if values.shape != (dof + 7,):
        message = f"values: has shape {values.shape}, and should have shape ({dof + 7},)"
        raise ArgumentError(message, ErrorCode.Assert)
    return values[:dof], pose_with_values(Pose(), values[dof:], DOFAffine.Transform)
