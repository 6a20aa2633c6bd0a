"""Imports mujoco before all else, also where ``MUJOCO_GL`` names a library that is not there.

MuJoCo loads that library while it is imported, and fails without it. Whoever wants no picture does not need it, and
whoever wants one gets ravemj's own message when it is drawn (``ravemj.rendering.contexts``).
"""

import importlib
import os

try:
    importlib.import_module("mujoco")
except Exception:  # whatever PyOpenGL raises
    if "MUJOCO_GL" not in os.environ:
        raise
    requested = {name: os.environ.pop(name) for name in ("MUJOCO_GL", "PYOPENGL_PLATFORM") if name in os.environ}
    try:
        importlib.import_module("mujoco")
    finally:
        os.environ.update(requested)
