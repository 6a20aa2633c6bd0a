"""Whole-body tasks: errors with their Jacobians, weights and priorities; and inequalities."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ravemj.ik.residuals import rotation_between
from ravemj.ik.vectors import Floats

_HALF_TURN = 1e-6
"""Sine below which a rotation by about pi is computed from the symmetric part of its matrix."""


class TaskRows(NamedTuple):
    """Error and Jacobian of a task in one configuration.

    Attributes:
        error: Goal minus present value, shape (m,).
        jacobian: Derivative of the value with respect to the displacements, shape (m, n).
        is_identity: Whether the Jacobian is the identity, for the first m variables.
    """

    error: Floats
    jacobian: Floats
    is_identity: bool = False


class Inequality(NamedTuple):
    """Constraint of a displacement x: jacobian @ x >= least; shapes (m, n) and (m,)."""

    jacobian: Floats
    least: Floats


@dataclass(eq=False)
class WeightedTask:
    """Task with weight and priority.

    Attributes:
        name: The name in reports.
        measure: Returns error and Jacobian in the present configuration.
        describe: Returns a sentence about a remaining error.
        weight: Factor of the squared error in the cost.
        gain: Fraction of the error that one step removes, 0 to 1.
        priority: Level; a level must not degrade those with smaller numbers.
        tolerance: Error, in m and rad, below which the task is met; infinite for soft tasks such as a posture.
        is_contact: Whether it is a contact, which steps enforce exactly.
        enabled: Whether it is used.
        residual: The last measured error.
    """

    name: str
    measure: Callable[[], TaskRows]
    describe: Callable[[Floats], str]
    weight: float
    gain: float = 1.0
    priority: int = 1
    tolerance: float = 1e-4
    is_contact: bool = False
    enabled: bool = True
    residual: Floats = field(default_factory=lambda: np.zeros(0))

    def rows(self) -> TaskRows:
        """Return error and Jacobian in the present configuration, and store the error."""
        rows = self.measure()
        self.residual = rows.error
        return rows

    @property
    def is_met(self) -> bool:
        """Whether the last error is within the tolerance."""
        return bool((np.abs(self.residual) <= self.tolerance).all())


def pose_rows(T_world_frame: Floats, jacobian: Floats, T_world_goal: Floats) -> TaskRows:
    """Return error and Jacobian of a pose task, six rows: translation [m], then rotation vector [rad].

    Plain Python takes a third of the time of numpy for one pose.
    """
    (a, b, c, x), (d, e, f, y), (g, h, i, z), _ = T_world_frame.tolist()
    (p, q, r, u), (s, t, v, w), (k, m, n, o), _ = T_world_goal.tolist()
    # The rotation goal @ frame^T: twice the sine of its angle along the axis, and twice the cosine.
    along = k * d + m * e + n * f - s * g - t * h - v * i, p * g + q * h + r * i - k * a - m * b - n * c
    along = *along, s * a + t * b + v * c - p * d - q * e - r * f
    sine = math.sqrt(along[0] ** 2 + along[1] ** 2 + along[2] ** 2)
    cosine = p * a + q * b + r * c + s * d + t * e + v * f + k * g + m * h + n * i - 1
    if cosine < 0 and sine < _HALF_TURN:
        turn = rotation_between(T_world_frame[:3, :3], T_world_goal).tolist()
    else:
        factor = math.atan2(sine, cosine) / sine if sine > _HALF_TURN else 0.5
        turn = [part * factor for part in along]
    return TaskRows(np.array([u - x, w - y, o - z, *turn]), jacobian)
