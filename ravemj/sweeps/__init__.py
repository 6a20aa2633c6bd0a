"""Sweeps: a computation over many items, which processes on one or many machines compute in parts (shards).

    sweep("panda", "collides", 1_000_000, "labels", executor=8).arrays("collides")

A shard is a range of items with one result file. A sweep is a folder of atomically written shards, with a manifest of
all inputs of the results. Repeating the call computes what is missing. Any ``concurrent.futures.Executor`` can run the
work; there is no scheduler.
"""

import ravemj.engine.mujoco_import  # noqa: F401  # pyright: ignore[reportUnusedImport] - before all that imports mujoco

# isort: split

from ravemj.sweeps.driver import SweepError
from ravemj.sweeps.folder import Failure, Sweep
from ravemj.sweeps.sweep import sweep

__all__ = ["Failure", "Sweep", "SweepError", "sweep"]
