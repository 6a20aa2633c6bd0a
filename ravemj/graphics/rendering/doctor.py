"""Diagnosis of the rendering backends of this machine, with installation hints."""

import importlib
import os
import signal
import subprocess
import sys
from typing import NamedTuple

import mujoco

from ravemj.graphics.rendering.contexts import GL_BACKENDS, RAY, OffscreenContext, attempt, remedy
from ravemj.graphics.rendering.gl import GlRenderer
from ravemj.graphics.rendering.gl_scene import Quality

_TIMEOUT = 60.0
_CHILD = """\
import sys
from ravemj.graphics.rendering.contexts import one_line
from ravemj.graphics.rendering.doctor import driver_name
try:
    sys.stdout.write(driver_name(sys.argv[1]))
except Exception as error:
    sys.exit(one_line(error))
"""


class BackendReport(NamedTuple):
    """Result of probing one backend."""

    name: str  # ``egl``, ``osmesa``, ``glfw`` or ``ray``
    works: bool
    detail: str  # the driver, or the reason of the failure, in one line
    install: str  # what to install after a failure; else empty


def probe_backends() -> list[BackendReport]:
    """Try every backend, in the order in which they are selected.

    Each is tried in a separate process, because a broken driver can crash it. This takes a second or two, and never
    fails.
    """
    reports = [probe(backend) for backend in GL_BACKENDS]
    return [*reports, BackendReport(RAY, True, "ray casting on the CPU, needs no OpenGL", "")]


def driver_name(backend: str) -> str:
    """Open a small renderer with a backend, in this process, and return the name of its driver.

    Raises:
        Exception: any error of the backend.
    """

    def ask(context: OffscreenContext) -> str:
        model = mujoco.MjModel.from_xml_string("<mujoco/>")
        with GlRenderer(model, Quality(16, 16, samples=0), context), context.current():
            gl = importlib.import_module("OpenGL.GL")
            name: bytes | None = gl.glGetString(gl.GL_RENDERER)
        return name.decode(errors="replace") if name else "an unnamed OpenGL driver"

    return attempt(backend, ask)


def probe(backend: str) -> BackendReport:
    """Try one of ``GL_BACKENDS`` in a new process."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path or os.curdir for path in sys.path)}
    environment.pop("MUJOCO_GL", None)
    try:
        child = subprocess.run(
            [sys.executable, "-c", _CHILD, backend],
            env=environment,
            capture_output=True,
            text=True,
            timeout=_TIMEOUT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return BackendReport(backend, False, f"no answer within {_TIMEOUT:g} s", remedy(backend))
    if child.returncode == 0:
        return BackendReport(backend, True, child.stdout.strip(), "")
    return BackendReport(backend, False, _reason(child), remedy(backend))


def _reason(child: "subprocess.CompletedProcess[str]") -> str:
    if child.returncode < 0:
        return f"the driver ended the process ({signal.Signals(-child.returncode).name})"
    lines = child.stderr.strip().splitlines() or [f"exit code {child.returncode}"]
    return lines[-1]
