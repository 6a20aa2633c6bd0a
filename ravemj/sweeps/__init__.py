"""Sweeps: a computation over many items, in shards that processes of one or many machines compute and write.

    sweep("panda", "collides", 1_000_000, "labels", executor=8).arrays("collides")

A sweep is a folder of atomically written files, and a manifest of all inputs of their numbers. Repeating the call
computes what is missing. Any ``concurrent.futures.Executor`` can run the work: there is no scheduler here.
"""

import ravemj.engine.mujoco_import  # noqa: F401  # pyright: ignore[reportUnusedImport] - before all that imports mujoco

# isort: split

from ravemj.sweeps.driver import SweepError
from ravemj.sweeps.folder import Failure, Sweep
from ravemj.sweeps.sweep import sweep

__all__ = ["Failure", "Sweep", "SweepError", "sweep"]
