"""Strict priorities and general inequalities by ``daqp`` (D. Arnström), a solver of quadratic programs.

A level is least squares in the null space of the levels before (O. Kanoun et al., "Kinematic control of redundant
manipulators: generalizing the task-priority framework to inequality tasks", 2011). Its variables are coordinates z of
that space, so z = 0 keeps the errors of earlier levels and is always feasible: no level can fail, however many bounds
are active.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ravemj.errors import RavemjError
from ravemj.ik.vectors import Floats
from ravemj.ik.whole_body.tasks import Inequality, TaskRows

_RANK = 1e-9
"""Singular value, relative to the largest, up to which a direction belongs to the null space."""
_SOLVED = 1
"""Exit flag of daqp for an optimal solution."""
_CAUTION = 1e-2
"""Damping of the motion that corrects violated inequalities, since the Jacobian of a distance is 0 at its maximum."""
_SETTINGS = {"primal_tol": 1e-11, "dual_tol": 1e-11, "iter_limit": 2000}


def daqp() -> Any:  # noqa: ANN401 - it has no types
    """Return the module ``daqp``, or raise an error if it is missing.

    Raises:
        RavemjError: it is not installed.
    """
    try:
        import daqp as package  # noqa: PLC0415 - an extra  # pyright: ignore[reportMissingImports]
    except ImportError:
        text = "several priorities, distances and supports need daqp: pip install 'ravemj[wholebody]'"
        raise RavemjError(text) from None
    return package


def minimise_levels(
    levels: Sequence[TaskRows], damping: float, lower: Floats, upper: Floats, inequalities: Sequence[Inequality]
) -> Floats:
    """Return the displacement that minimizes each level's errors as far as earlier levels allow, shape (n,).

    Args:
        levels: Weighted rows, the most important ones first.
        damping: Weight of the squared displacement in a level's cost, as a multiple of ``squared`` of the level's
            error.
        lower: Minimum displacements, shape (n,).
        upper: Maximum displacements, shape (n,).
        inequalities: Inequality constraints; unsatisfiable ones are violated as little as possible.
    """
    x = np.minimum(np.maximum(np.zeros(len(lower)), lower), upper)
    basis = np.eye(len(lower))[:, upper > lower]
    rows = (
        np.vstack([inequality.jacobian for inequality in inequalities]) if inequalities else np.zeros((0, len(lower)))
    )
    least = np.concatenate([inequality.least for inequality in inequalities]) if inequalities else np.zeros(0)
    violated = rows @ x < least
    if violated.any():
        present = rows @ x
        room = _room(x, lower, upper, rows, np.minimum(least, present), basis)
        away = _coordinates(rows[violated] @ basis, (least - present)[violated], _CAUTION + damping, room)
        x = np.minimum(np.maximum(x + basis @ away, lower), upper)
        least = np.minimum(least, rows @ x)
    for level in levels:
        if not basis.shape[1]:
            break
        jacobian = level.jacobian @ basis
        x = x + basis @ _coordinates(
            jacobian,
            level.error - level.jacobian @ x,
            damping * squared(level.error),
            _room(x, lower, upper, rows, least, basis),
        )
        x = np.minimum(np.maximum(x, lower), upper)
        basis = basis @ _null_space(jacobian)
    return x


def squared(error: Floats) -> float:
    """Return the squared length of an error, at most 1, to which damping is proportional (T. Sugihara, 2011)."""
    return min(float(error.dot(error)), 1.0)


_Room = tuple[Floats, Floats, Floats]


def _room(x: Floats, lower: Floats, upper: Floats, rows: Floats, least: Floats, basis: Floats) -> _Room:
    """Return a matrix and bounds of its product with z that keep ``x + basis @ z`` feasible; z = 0 satisfies them.

    The constraints are ``lower``, ``upper`` and ``rows @ x >= least``; those that ``x`` violates may not get worse.
    """
    below = np.concatenate([np.minimum(lower - x, 0.0), np.minimum(least - rows @ x, 0.0)])
    above = np.concatenate([np.maximum(upper - x, 0.0), np.full(len(least), 1e30)])
    matrix = np.vstack([basis, rows @ basis])
    used = np.abs(matrix).max(axis=1, initial=0.0) > _RANK
    return matrix[used], below[used], above[used]


def _coordinates(jacobian: Floats, error: Floats, damping: float, room: _Room) -> Floats:
    """Return the change z, in null-space coordinates, that minimizes a level's cost; zeros if daqp fails."""
    hessian = jacobian.T @ jacobian
    gradient = -(jacobian.T @ error)
    count = len(hessian)
    hessian += (damping + 1e-10 * np.trace(hessian) / count + 1e-14) * np.eye(count)
    z = np.asarray(np.linalg.solve(hessian, -gradient), dtype=float)
    matrix, below, above = room
    product = matrix @ z
    if (product >= below).all() and (product <= above).all():
        return z
    z, _, flag, _ = _solve(hessian, gradient, matrix, below, above)
    return z if flag == _SOLVED and np.isfinite(z).all() else np.zeros(count)


def _solve(
    hessian: Floats, gradient: Floats, matrix: Floats, below: Floats, above: Floats
) -> tuple[Floats, float, int, object]:
    scale = 1 / np.abs(hessian).max()
    arrays = (np.ascontiguousarray(array) for array in (hessian * scale, gradient * scale, matrix, above, below))
    return daqp().solve(*arrays, np.zeros(len(below), dtype=np.int32), **_SETTINGS)


def _null_space(jacobian: Floats) -> Floats:
    """Return an orthonormal basis of the null space of the rows, shape (n, k)."""
    _, sizes, rows = np.linalg.svd(jacobian)
    rank = int((sizes > _RANK * max(float(sizes.max(initial=0.0)), 1e-12)).sum())
    return rows[rank:].T
