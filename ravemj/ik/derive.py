"""Derivation of a validated closed-form solver from a chain, or of the reasons why there is none."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.closed import ClosedForm
from ravemj.ik.families.search import families, general_families
from ravemj.ik.families.snapping import nominal
from ravemj.ik.tasks import Task
from ravemj.ik.vectors import Floats

SAMPLES = 64
"""Number of configurations in a validation."""
_FEW = 8
_SOLVED = (Task.TRANSFORM, Task.PLACE, Task.PLACE_XY, Task.PLANAR)
"""Tasks that solver families solve directly; ``reductions`` reduces all others to these."""
_TRIED = 32
"""Maximum number of solver families tried for one choice of locked joints."""


@dataclass(frozen=True)
class Validation:
    """Result of validating a solver on random configurations.

    Attributes:
        configurations: Number of configurations.
        found: Number of configurations that are among the solutions.
        error: The worst error of a solution: position divided by the reach, angle in rad.
        solutions: The mean number of solutions.
    """

    configurations: int
    found: int
    error: float
    solutions: float

    @property
    def holds(self) -> bool:
        """Whether all configurations were found accurately."""
        return self.found == self.configurations and self.error <= 1e-9


def certify(solver: ClosedForm, *, count: int = SAMPLES, seed: int = 64) -> Validation:
    """Validate a solver: random configurations must be among the solutions for their tool poses.

    Angles are in ±pi regardless of limits, since closed-form solvers ignore limits.
    """
    chain = solver.chain
    values = random_values(chain, count, np.random.default_rng(seed))
    poses = chain.forward(values)
    solutions = solver.solve(poses, values[:, solver.locked])
    away = solutions.values - values[:, None]
    away[:, :, ~chain.prismatic] = np.abs(np.sin(away[:, :, ~chain.prismatic] / 2)) * 2
    near = (np.abs(away).max(axis=2, initial=0.0) < 1e-5) & solutions.valid
    rows, pose, _ = solutions.rows
    error = solver.errors(rows, poses[pose]).max(initial=0.0)
    return Validation(count, int(near.any(axis=1).sum()), float(error), len(rows) / count)


def random_values(chain: Chain, count: int, rng: np.random.Generator) -> Floats:
    """Return random joint values, shape (count, n): any angle, and distances within the limits."""
    bound = np.where(chain.prismatic, chain.reach, np.pi)
    low = np.where(chain.prismatic & np.isfinite(chain.lower), np.maximum(chain.lower, -bound), -bound)
    high = np.where(chain.prismatic & np.isfinite(chain.upper), np.minimum(chain.upper, bound), bound)
    return rng.uniform(np.minimum(low, high), high, (count, chain.dof))


def derive(
    chain: Chain, task: Task = Task.TRANSFORM, locked: Sequence[int] = (), *, general: bool = False
) -> tuple[ClosedForm, Validation] | None:
    """Find and validate a closed-form solver.

    Args:
        chain: The arm.
        task: The constrained components of the tool pose.
        locked: Joints whose values will be given; at most ``task.dof`` joints remain.
        general: Whether to try the eigenvalue problem of general arms, instead of the special families.

    Returns:
        The solver and its validation; None if no family fits.
    """
    free = [joint for joint in range(chain.dof) if joint not in locked]
    if task not in _SOLVED:
        return None
    if not free or len(free) > task.dof or not _regular(chain, task, free):
        return None
    exact = nominal(chain)
    if (task is Task.PLANAR and not _is_planar(exact, free)) or (general and task is not Task.TRANSFORM):
        return None
    deviation = np.abs(exact.axes - chain.axes).max() + _sideways(exact, chain)
    candidates = general_families(exact, locked) if general else families(exact, task, locked)
    for family in itertools.islice(candidates, _TRIED):
        solver = ClosedForm(chain, task, family, snapped=deviation > 1e-12)
        certificate = _prove(solver)
        if certificate is not None:
            return solver, certificate
    return None


def _prove(solver: ClosedForm) -> Validation | None:
    try:
        if certify(solver, count=_FEW).holds:
            certificate = certify(solver)
            return certificate if certificate.holds else None
    except np.linalg.LinAlgError:  # only singular matrices
        pass
    return None


def _regular(chain: Chain, task: Task, free: Sequence[int]) -> bool:
    """Return whether the joints ``free``, which are not locked, move the tool independently.

    Then the number of solutions is finite.
    """
    values = random_values(chain, 4, np.random.default_rng(4))
    _, jacobians = chain.forward_and_jacobian(values)
    scale = np.array([1 / chain.reach] * 3 + [1.0] * 3)
    part = (jacobians * scale[:, None])[:, list(task.rows)][:, :, list(free)]
    part = part / np.maximum(np.linalg.norm(part, axis=1, keepdims=True), 1e-12)
    return bool(np.linalg.svd(part, compute_uv=False)[:, -1].max() > 1e-4)


def _is_planar(chain: Chain, free: Sequence[int]) -> bool:
    """Return whether the joints ``free``, which are not locked, keep the tool in an xy plane.

    Locked prismatic joints may move this plane along z.
    """
    upright = np.abs(chain.axes[:, 2])
    lifted = np.isin(np.arange(chain.dof), free, invert=True)
    return bool(np.where(chain.prismatic, (upright < 1e-9) | lifted, upright > 1 - 1e-12).all())


def _sideways(exact: Chain, chain: Chain) -> float:
    """Return the largest distance between a nominal revolute axis and the true one, divided by the reach."""
    away = np.cross(exact.points - chain.points / chain.reach, exact.axes)[~chain.prismatic]
    return float(np.abs(away).max(initial=0.0))
