"""Viewers: pointer and keyboard interaction, windows, and pages in a browser."""

import ravemj.engine.mujoco_import  # noqa: F401  # pyright: ignore[reportUnusedImport] - before all that imports mujoco
