"""Stacked Jacobians of several points and of the centre of mass, optionally with columns of the base motion."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.engine.kinematics import BodyKinematics

if TYPE_CHECKING:
    from ravemj.engine.dynamics.body import DerivativeRows

_BASE = 6
_STILL = np.eye(_BASE).ravel()
"""Columns of base velocities in the Jacobian of a point at the base's origin, row by row."""
_PLACES = np.array([_BASE * row + 3 + column for row in range(3) for column in range(3) if row != column])
_COMPONENTS = np.array([2, 1, 2, 0, 1, 0])
_SIGNS = np.array([1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
"""Nonzero entries of the cross product matrix -[arm]x: position, component of the lever arm, and sign."""


def with_base_columns(jacobians: Floats, arms: Floats) -> Floats:
    """Append the columns of a base twist to Jacobians of points, shape (k, 6, n).

    Args:
        jacobians: Rows of the velocity of each point, then of its link's angular velocity, in world axes.
        arms: The points relative to the base's origin, in world axes [m], shape (k, 3).

    Returns:
        Shape (k, 6, n + 6): the last columns are the velocity of the base's origin and its angular velocity in world
        axes: [I, -[p - o]x] above [0, I] for a point p and the base's origin o.
    """
    columns = np.empty((len(arms), _BASE * _BASE))
    columns[:] = _STILL
    columns[:, _PLACES] = arms.take(_COMPONENTS, 1) * _SIGNS
    return np.concatenate((jacobians, columns.reshape(-1, _BASE, _BASE)), axis=2)


class WholeBodyRows:
    """Jacobians of several points and of the centre of mass, by joints and a base twist, in one array.

    A buffer contains MuJoCo's Jacobians, the numbers 0 and 1, and the components of the points relative to the base
    with both signs. Columns of the joints and of the base then need only a single indexing by ``numpy.take``.
    """

    def __init__(self, kinematics: BodyKinematics, count: int, columns: Ints, *, base: bool) -> None:
        """Allocate the buffer for a body with one root.

        Args:
            kinematics: The body.
            count: Number of points.
            columns: Index of each joint variable in MuJoCo's velocities; ``nv`` for none.
            base: Whether there are columns of a base twist.
        """
        nv, rows = kinematics.model.nv, _BASE * count + 3
        zero = rows * nv
        self._kinematics = kinematics
        self._numbers = np.zeros(zero + 2 + _BASE * (count + 1))
        self._numbers[zero + 1] = 1.0
        matrix = self._numbers[:zero].reshape(rows, nv)
        blocks = matrix[:-3].reshape(count, _BASE, nv)
        self._views, self._com_rows = [(block[:3], block[3:]) for block in blocks], matrix[-3:]
        arms = self._numbers[zero + 2 :].reshape(count + 1, 2, 3)
        self._arms, self._negative_arms = arms[:, 0], arms[:, 1]
        self._point_arms, self._com_arm = arms[:-1, 0], arms[-1, 0]
        self._root = int(kinematics.body_ids[kinematics.roots[0]])
        joints = np.where(columns < nv, nv * np.arange(rows)[:, None] + columns, zero)
        twists = zero + np.tile(_STILL.reshape(_BASE, _BASE).astype(int), (count + 1, 1))
        signed = _COMPONENTS + 3 * (_SIGNS < 0)
        for point in range(count + 1):
            twists[_BASE * point : _BASE * (point + 1)].put(_PLACES, zero + 2 + _BASE * point + signed)
        self._places = np.hstack([joints, twists[:rows]]) if base else joints

    def filled(self, body_ids: Sequence[int], points: Floats) -> Floats:
        """Return six rows for each of the world points (k, 3) fixed to bodies, then three of the centre of mass."""
        self._kinematics.place_coms()
        model, data = self._kinematics.model, self._kinematics.data
        for (moving, turning), point, body_id in zip(self._views, points, body_ids, strict=True):
            mujoco.mj_jac(model, data, moving, turning, point, body_id)
        mujoco.mj_jacSubtreeCom(model, data, self._com_rows, self._root)
        origin = data.xpos[self._root]
        np.subtract(points, origin, self._point_arms)
        np.subtract(data.subtree_com[0], origin, self._com_arm)
        np.negative(self._arms, self._negative_arms)
        return self._numbers.take(self._places)


class StackedJacobians:
    """Buffer for Jacobians of several points, which MuJoCo fills row by row."""

    def __init__(self, kinematics: BodyKinematics, rows: "DerivativeRows") -> None:
        """Allocate for rows of shape (k, 6, nv)."""
        self._kinematics, self.rows = kinematics, rows
        self._views = [(block[:3], block[3:]) for block in rows.matrix]  # created once, since that takes time
        self._body_ids: list[int] = kinematics.body_ids.tolist()

    def fill(self, links: Sequence[int], points: Floats) -> None:
        """Write the Jacobians of world points (k, 3) fixed to links, with respect to MuJoCo's velocities."""
        self._kinematics.place_coms()
        model, data, ids = self._kinematics.model, self._kinematics.data, self._body_ids
        for (moving, turning), link, point in zip(self._views, links, points, strict=True):
            mujoco.mj_jac(model, data, moving, turning, point, ids[link])
