"""Imports mujoco before all else, also where ``MUJOCO_GL`` names a library that is not there.

MuJoCo loads that library while it is imported, and fails without it. Whoever wants no picture does not need it, and
whoever wants one gets ravemj's own message when it is drawn (``ravemj.rendering.contexts``).

On the way MuJoCo may import glfw, which asks its library for its version in a process of its own. Signals wait until
that process has ended: Ctrl-C, which reaches both, would have it print a traceback.

What MuJoCo warns of goes to the log; by itself it writes a file ``MUJOCO_LOG.TXT`` into the working folder.
"""

import importlib
import logging
import os
import signal
import sys
from contextlib import suppress

if sys.platform == "linux" and os.environ.get("MUJOCO_GL", "") in ("", "glfw"):  # elsewhere it imports others
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM, signal.SIGHUP})
    try:
        with suppress(ImportError):
            importlib.import_module("glfw")
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)

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

import mujoco


def _log(text: str) -> None:
    logging.getLogger("ravemj").warning("MuJoCo: %s", text)


mujoco.set_mju_user_warning(_log)
