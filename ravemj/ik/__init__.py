"""Inverse kinematics of arms: all solutions in closed form where the geometry allows it, a search where not.

    solver = make_solver(Chain.of(axes, points, lower=…, upper=…, T_base_tool=…))
    solver.solve(T_base_tool).of(0)

Chains and poses are arrays; nothing here knows robots, files or windows. Nothing is compiled: a family is found from
the axes, by numbers (``derive``), proved by random configurations, and answers batches of poses.
"""

import ravemj.engine.mujoco_import  # noqa: F401  # pyright: ignore[reportUnusedImport] - before all that imports mujoco

# isort: split

import warnings

from ravemj.ik.chain import Chain
from ravemj.ik.closed import ClosedForm, Solutions
from ravemj.ik.derive import Certificate, derive
from ravemj.ik.numeric import Nearest, NumericSolver
from ravemj.ik.self_motion import null_space, null_space_path, sweep
from ravemj.ik.solver import ArmSolutions, make_solver
from ravemj.ik.tasks import Task

__all__ = [
    "ArmSolutions",
    "Certificate",
    "Chain",
    "ClosedForm",
    "Nearest",
    "NumericSolver",
    "Solutions",
    "Task",
    "derive",
    "make_solver",
    "null_space",
    "null_space_path",
    "sweep",
]


def __getattr__(name: str) -> object:
    """Return ``ArmSolutions`` for its old name ``IKSolver``, which goes with the next version."""
    if name != "IKSolver":
        raise AttributeError(f"module 'ravemj.ik' has no attribute '{name}'")
    warnings.warn("ravemj.ik.IKSolver is now called ravemj.ik.ArmSolutions", DeprecationWarning, stacklevel=2)
    return ArmSolutions
