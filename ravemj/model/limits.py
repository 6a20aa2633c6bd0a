"""Limits of joint values: comparison and clamping."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.model.scene import Axis

LARGEST = float(np.finfo(np.float64).max)

_FEW = 12  # number of values up to which a loop over floats is faster than numpy


class Limits:
    """Limits of several axes; circular axes allow every finite number.

    Attributes:
        lower: Lower limits [rad or m], shape (axes,).
        upper: Upper limits, shape (axes,).
    """

    def __init__(self, axes: Sequence[Axis]) -> None:
        self.lower = np.array([-LARGEST if axis.circular else axis.lower for axis in axes])
        self.upper = np.array([LARGEST if axis.circular else axis.upper for axis in axes])
        self._plain_limits = self.lower.tolist(), self.upper.tolist()
        self._few = range(len(axes)) if len(axes) <= _FEW else None
        self._contained = np.ones(len(axes), dtype=bool)  # buffer for each comparison
        self._all = self._contained.tobytes()

    def contain(self, values: Floats) -> bool:
        """Return whether all values, shape (axes,), are finite numbers within the limits."""
        if self._few is None:  # comparison of bytes is faster than ``all``
            contained, every = self._contained, self._all
            above = np.greater_equal(values, self.lower, contained).tobytes() == every
            return above and np.less_equal(values, self.upper, contained).tobytes() == every
        plain, (lower, upper) = values.tolist(), self._plain_limits
        for axis in self._few:  # noqa: SIM110 - faster than ``all`` and ``zip``
            if not lower[axis] <= plain[axis] <= upper[axis]:
                return False
        return True

    def clamp(self, values: Floats) -> Floats:
        """Return values, shape (..., axes), clamped to the limits; NaN stays.

        If a lower limit is above the upper one, values below the lower limit move to it, as in OpenRAVE.
        """
        return np.where(values < self.lower, self.lower, np.minimum(values, self.upper))


def clamp(axis: Axis, value: float) -> float:
    """Return a value [rad or m] clamped to the limits of an axis, unless it is circular; NaN stays."""
    return value if axis.circular else axis.lower if value < axis.lower else min(value, axis.upper)


def with_fields(axes: Sequence[Axis], indices: Sequence[int], fields: Mapping[str, Sequence[float]]) -> list[Axis]:
    """Return axes with changed fields; ``fields`` has by field name a value for each of ``indices``."""
    changed = list(axes)
    for place, index in enumerate(indices):
        changes: dict[str, Any] = {name: values[place] for name, values in fields.items()}
        changed[index] = replace(changed[index], **changes)
    return changed
