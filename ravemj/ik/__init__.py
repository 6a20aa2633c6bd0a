"""Inverse kinematics of arms: all solutions in closed form if the geometry allows it, else by a search.

    solver = make_solver(Chain.of(axes, points, lower=…, upper=…, T_base_tool=…))
    solver.solve(T_base_tool).of(0)

Chains and poses are arrays; this package is independent of robots, files and windows. Nothing is compiled: a family is
detected numerically from the axes (``derive``), validated on random configurations, and solves batches of poses.
"""

import ravemj.engine.mujoco_import  # noqa: F401  # pyright: ignore[reportUnusedImport] - before all that imports mujoco

# isort: split

import warnings

from ravemj.ik.chain import Chain
from ravemj.ik.closed import ClosedForm, Solutions
from ravemj.ik.derive import Validation, derive
from ravemj.ik.numeric import Nearest, NumericSolver
from ravemj.ik.self_motion import null_space, null_space_path, sweep
from ravemj.ik.solver import ArmSolutions, Reachable, make_solver
from ravemj.ik.tasks import Task

__all__ = [
    "ArmSolutions",
    "Chain",
    "ClosedForm",
    "Nearest",
    "NumericSolver",
    "Reachable",
    "Solutions",
    "Task",
    "Validation",
    "derive",
    "make_solver",
    "null_space",
    "null_space_path",
    "sweep",
]
_RENAMED = {"Certificate": Validation, "IKSolver": ArmSolutions}


def __getattr__(name: str) -> object:
    """Return the class of a deprecated name, which will be removed in the next version."""
    if name not in _RENAMED:
        raise AttributeError(f"module 'ravemj.ik' has no attribute '{name}'")
    renamed = _RENAMED[name]
    warnings.warn(f"ravemj.ik.{name} is now called ravemj.ik.{renamed.__name__}", DeprecationWarning, stacklevel=2)
    return renamed
