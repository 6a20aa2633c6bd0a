"""The MuJoCo model of all bodies, and what is computed with it."""

import ravemj.engine.mujoco_import  # noqa: F401  # pyright: ignore[reportUnusedImport] - before all that imports mujoco
