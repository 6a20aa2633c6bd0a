"""Import of mujoco, also if ``MUJOCO_GL`` names a missing library.

MuJoCo's import loads that library, and fails without it. It is only necessary for pictures; their drawing then reports
the error (``ravemj.graphics.rendering.contexts``).

MuJoCo may import glfw, which runs a subprocess to query its library's version. Signals are blocked until it ends:
otherwise Ctrl-C, which reaches both, makes it print a traceback.

MuJoCo's warnings go to the log, instead of a file ``MUJOCO_LOG.TXT`` in the working folder.
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
