"""The MuJoCo model of all bodies, and computations with it."""

import ravemj.engine.mujoco_import  # noqa: F401  # pyright: ignore[reportUnusedImport] - before all that imports mujoco
