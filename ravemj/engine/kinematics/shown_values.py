"""Joint values computed from link poses, for all joints at once."""

import math
from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import ZERO, Floats, Ints, pose_of
from ravemj.model.joints import ROUNDING, measured_values
from ravemj.model.scene import Joint

_VALUE_ROUNDING = 1e-12
"""Accuracy of joint values [rad or m] computed from link poses, for links up to some metres apart."""

_EYE = np.eye(4).ravel()


class ShownValues:
    """Computes the values of a body's active joints from link poses.

    It is a vectorized ``measured_values`` with precomputed constants.
    """

    def __init__(self, joints: Sequence[Joint], first_dofs: Sequence[int]) -> None:
        pairs = list(zip(joints, first_dofs, strict=True))
        self._hinges = _SingleAxes([pair for pair in pairs if _has_one_axis(pair[0]) and pair[0].kind == "hinge"])
        self._sliders = _SingleAxes([pair for pair in pairs if _has_one_axis(pair[0]) and pair[0].kind == "slider"])
        fixed = [range(first, first + len(joint.axes)) for joint, first in pairs if joint.static]
        self._fixed_dofs = np.array([dof for dofs in fixed for dof in dofs], dtype=int)
        self._others = [pair for pair in pairs if not (pair[0].static or _has_one_axis(pair[0]))]

    def read(self, T_world_links: Floats, last_values: Floats) -> Floats:
        """Return the values [rad or m], shape (dof,), near ``last_values``.

        Values that differ from the last ones only by rounding are not changed, to avoid drift; hinge values are shifted
        by full turns towards the last ones.
        """
        values = last_values.copy()
        if len(dofs := self._hinges.dofs):
            shown, last = self._hinges.angles(T_world_links), last_values[dofs]
            values[dofs] = _settled(shown + math.tau * np.rint((last - shown) / math.tau), last)
        if len(dofs := self._sliders.dofs):
            values[dofs] = _settled(self._sliders.ways(T_world_links), last_values[dofs])
        if len(dofs := self._fixed_dofs):
            values[dofs] = _settled(np.zeros(len(dofs)), last_values[dofs])
        for joint, first in self._others:
            dofs = slice(first, first + len(joint.axes))
            parent, child = (pose_of(T_world_links[link]) for link in (joint.parent, joint.child))
            values[dofs] = _settled(np.array(measured_values(joint, parent.inverse() @ child)), last_values[dofs])
        return values


class _SingleAxes:
    """Converter from link poses to the values of joints with one axis."""

    def __init__(self, joints: Sequence[tuple[Joint, int]]) -> None:
        self.dofs = np.array([dof for _, dof in joints], dtype=int)
        self._parents: Ints = np.array([joint.parent for joint, _ in joints], dtype=int)
        self._children: Ints = np.array([joint.child for joint, _ in joints], dtype=int)
        self._directions = np.array([joint.axes[0].direction for joint, _ in joints]).reshape(-1, 3)
        self._references = np.array([joint.axes[0].reference for joint, _ in joints])
        rest = np.array([joint.T_parent_child.matrix() for joint, _ in joints]).reshape(-1, 4, 4)
        self._anchors = np.array([joint.anchor for joint, _ in joints]).reshape(-1, 3)
        self._arms = self._anchors - rest[:, :3, 3]
        self._R_child_parent = rest[:, :3, :3].transpose(0, 2, 1)

    def _turned(self, T_world_links: Floats) -> tuple[Floats, Floats]:
        """Return the rotation of each child link from its rest orientation, and the inverse rotation of its parent."""
        R_parent_world = T_world_links[self._parents, :3, :3].transpose(0, 2, 1)
        return R_parent_world @ T_world_links[self._children, :3, :3] @ self._R_child_parent, R_parent_world

    def angles(self, T_world_links: Floats) -> Floats:
        """Return the values of revolute joints [rad], within [-pi, pi]."""
        turned, _ = self._turned(T_world_links)
        products = turned.reshape(-1, 9) @ _PRODUCTS + _EYE
        largest = products[:, ::5].argmax(axis=1)  # scaled by the squares, for accuracy
        quaternions = products.reshape(-1, 4, 4)[np.arange(len(turned)), largest]
        moved = 2 * np.arctan2((quaternions[:, 1:] * self._directions).sum(axis=1), quaternions[:, 0])
        moved -= math.tau * np.rint((self._references + moved) / math.tau)
        return self._references + np.where(np.abs(moved) > ROUNDING, moved, 0.0)

    def ways(self, T_world_links: Floats) -> Floats:
        """Return the values of prismatic joints [m]."""
        turned, R_parent_world = self._turned(T_world_links)
        apart = T_world_links[self._children, :3, 3] - T_world_links[self._parents, :3, 3]
        motions = R_parent_world @ apart[:, :, None] + turned @ self._arms[:, :, None]
        moved = ((motions[:, :, 0] - self._anchors) * self._directions).sum(axis=1)
        return self._references + np.where(np.abs(moved) > ROUNDING, moved, 0.0)


def _has_one_axis(joint: Joint) -> bool:
    return joint.kind in {"hinge", "slider"} and not joint.static and joint.axes[0].direction != ZERO


def _settled(shown: Floats, last: Floats) -> Floats:
    return np.where(np.abs(shown - last) < _VALUE_ROUNDING, last, shown)


def _products() -> Floats:
    """Return the matrix, (9, 16), from rotation matrix entries to four times the products of quaternion components.

    The products are those of all pairs of w, x, y, z; squares are reduced by 1, as in 4 w² - 1.
    """
    xx, xy, xz, yx, yy, yz, zx, zy, zz = np.eye(9)
    return (
        np.array(
            [
                [xx + yy + zz, zy - yz, xz - zx, yx - xy],
                [zy - yz, xx - yy - zz, yx + xy, xz + zx],
                [xz - zx, yx + xy, yy - zz - xx, zy + yz],
                [yx - xy, xz + zx, zy + yz, zz - xx - yy],
            ]
        )
        .reshape(16, 9)
        .T
    )


_PRODUCTS = _products()
