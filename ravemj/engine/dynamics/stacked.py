"""Stacked Jacobians of several points and of the centre of mass, optionally with columns of the base motion."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.kinematics import BodyKinematics

if TYPE_CHECKING:
    from ravemj.engine.dynamics.body import DerivativeRows

_BASE = 6
_STILL = np.eye(_BASE).ravel()
"""Columns of a point at the base's origin, row by row."""
_PLACES = np.array([_BASE * row + 3 + column for row in range(3) for column in range(3) if row != column])
_COMPONENTS = np.array([2, 1, 2, 0, 1, 0])
_SIGNS = np.array([1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
"""Nonzero entries of -[arm]x: positions, component of the arm, and sign."""


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


class StackedJacobians:
    """Buffer for Jacobians of several points, which MuJoCo fills row by row."""

    def __init__(self, kinematics: BodyKinematics, rows: "DerivativeRows") -> None:
        """Allocate for rows of shape (k, 6, nv)."""
        self._kinematics, self.rows = kinematics, rows
        self._views = [(block[:3], block[3:]) for block in rows.matrix]  # created once, since that takes time
        self._body_ids: list[int] = kinematics.body_ids.tolist()

    def fill(self, links: Sequence[int], points: Floats) -> None:
        """Write the derivatives of world points (k, 3) fixed to links, by MuJoCo's velocities."""
        self._kinematics.place_coms()
        model, data, ids = self._kinematics.model, self._kinematics.data, self._body_ids
        for (moving, turning), link, point in zip(self._views, links, points, strict=True):
            mujoco.mj_jac(model, data, moving, turning, point, ids[link])
