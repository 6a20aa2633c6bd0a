"""Quadratic programs with box constraints: MuJoCo's solver, and a check of its result.

``mujoco.mju_boxQP`` takes a sixth of the time of general solvers. It stops at an absolute gradient, so the objective is
scaled; it stalls beside bounds that almost touch its start, so these are snapped to it; and it has no status, so the
optimality conditions of W. Karush, H. Kuhn and A. Tucker are checked.
"""

import math

import mujoco
import numpy as np

from ravemj.ik.vectors import Bools, Floats

_SCALE = 1e6
"""Norm to which the gradient is scaled before MuJoCo's QP solver, whose stopping threshold is absolute."""
_SNAP = 1e-9
_ACCURATE = 1e-9
"""Gradient that counts as zero, relative to the initial one."""
_REGULAR = 1e-12
_ROUNDS = 60


class BoxProblem:
    """Minimise x^T H x / 2 + g^T x for several g, within lower <= x <= upper."""

    def __init__(self, hessian: Floats, lower: Floats, upper: Floats) -> None:
        """Store a symmetric positive semidefinite matrix (n, n), which is regularized in place, and bounds (n,)."""
        bounds = np.array((lower, upper))
        bounds *= np.abs(bounds) >= _SNAP
        lower, upper = bounds
        room = upper - lower
        self._has_fixed = len(room) > 0 and float(room.min()) <= _SNAP
        self._lower, self._upper = lower, upper
        self._hessian = hessian
        if self._has_fixed:
            is_fixed = room <= _SNAP
            self._free = np.flatnonzero(~is_fixed)
            self._rest = np.where(is_fixed, lower, 0.0)
            self._hessian = hessian[np.ix_(self._free, self._free)]
            self._coupling = hessian[self._free] @ self._rest
            self._lower, self._upper = lower[self._free], upper[self._free]
        count = len(self._lower)
        diagonal = self._hessian.ravel()[:: count + 1]
        diagonal += _REGULAR * float(diagonal.sum()) / max(count, 1) + 1e-300
        self._factor = np.empty((count, count + 7))

    def minimise(self, gradient: Floats) -> Floats:
        """Return the minimizer, shape (n,)."""
        if not self._has_fixed:
            return self._minimise_free(gradient)
        x = self._rest.copy()
        if len(self._free):
            x[self._free] = self._minimise_free(gradient[self._free] + self._coupling)
        return x

    def _minimise_free(self, gradient: Floats) -> Floats:
        lower, upper = self._lower, self._upper
        x = np.minimum(np.maximum(lower, 0.0), upper)
        length = math.sqrt(float(gradient.dot(gradient)))
        if not length:
            return x
        scale = _SCALE / length
        hessian, scaled = self._hessian * scale, gradient * scale
        solved = mujoco.mju_boxQP(x, self._factor, None, hessian, scaled, lower, upper) >= 0
        if solved and is_optimal(hessian, scaled, lower, upper, x):
            return x
        return active_set(hessian, scaled, lower, upper)


def is_optimal(hessian: Floats, gradient: Floats, lower: Floats, upper: Floats, x: Floats) -> bool:
    """Return whether x is optimal: the gradient is 0 for free variables, and points out of the box at bounds."""
    slope = hessian.dot(x)
    slope += gradient
    most = _ACCURATE * math.sqrt(float(gradient.dot(gradient)))
    if slope.dot(slope) <= most * most:
        return True
    most += 1e-13 * float(np.abs(slope - gradient).max())  # rounding of the product
    inward = np.minimum(slope, 0.0) * (x < upper), np.maximum(slope, 0.0) * (x > lower)
    return max(float(inward[1].max()), -float(inward[0].min())) <= most


def active_set(hessian: Floats, gradient: Floats, lower: Floats, upper: Floats) -> Floats:
    """Return the minimizer by an active-set method: fix variables that leave the box, release those that would return.

    The step to the minimum of the free variables is cut at the first bound.
    """
    x = np.minimum(np.maximum(np.zeros(len(gradient)), lower), upper)
    free: Bools = np.ones(len(x), dtype=bool)
    for _ in range(_ROUNDS * len(x)):
        step = np.zeros(len(x))
        slope = hessian @ x + gradient
        if free.any():
            step[free] = -np.linalg.solve(hessian[np.ix_(free, free)], slope[free])
        room = np.where(step > 0, upper - x, np.where(step < 0, x - lower, np.inf))
        with np.errstate(divide="ignore", invalid="ignore"):
            part = np.where(step != 0, room / np.abs(step), np.inf)
        first = int(part.argmin())
        if part[first] < 1:
            x = x + part[first] * step
            x[first] = upper[first] if step[first] > 0 else lower[first]
            free[first] = False
            continue
        x = np.minimum(np.maximum(x + step, lower), upper)
        slope = hessian @ x + gradient
        inward = np.where(free, 0.0, np.where(x >= upper, slope, -slope))
        inward[(lower == upper) | free] = 0.0
        best = int(inward.argmax())
        if inward[best] <= _ACCURATE * np.abs(gradient).max():
            break
        free[best] = True
    return x
