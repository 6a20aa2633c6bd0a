"""Offscreen OpenGL contexts, created when the first picture is rendered.

Importing this module loads no OpenGL library, requires no environment variable, and works whether or not mujoco was
imported before. A backend counts as working only after a renderer was created with it, because libraries can be
present without a driver.

Order of the attempts: EGL (headless, the driver of the graphics card or Mesa), OSMesa (software), GLFW (an
invisible window, if there is a display). If all fail, pictures are ray-cast without OpenGL.
"""

import atexit
import contextlib
import ctypes
import importlib
import logging
import os
import sys
import threading
import warnings
import weakref
from collections.abc import Callable, Generator
from typing import Protocol, TypeVar

from ravemj.core.forks import NEW_PROCESS, in_child
from ravemj.core.locks import end
from ravemj.errors import RenderingError
from ravemj.graphics.rendering.egl_check import check_egl, variable_restored

RAY = "ray"
GL_BACKENDS = ("egl", "osmesa", "glfw")
INSTALL = {
    "egl": "apt-get install libegl1 libgl1",
    "osmesa": "apt-get install libosmesa6",
    "glfw": "a desktop, or apt-get install xvfb libgl1 and run under xvfb-run",
}
"""Installation commands of the backends on Debian and Ubuntu."""

_BY_ENVIRONMENT = {
    **{name: None for name in ("", "enable", "enabled", "on", "true", "1")},
    **{name: RAY for name in ("disable", "disabled", "off", "false", "0")},
    **{name: name for name in GL_BACKENDS},
    **{name: "glfw" for name in ("glx", "wgl", "cgl")},
}
_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "software", "swiftshader", "basic render")
"""Substrings in renderer names of software OpenGL drivers."""

_DEVICE = "MUJOCO_EGL_DEVICE_ID"
"""Environment variable for the index of the GPU."""

_LOG = logging.getLogger("ravemj")

_Made = TypeVar("_Made")


class _GLContext(Protocol):
    """Common interface of the contexts of mujoco.egl, mujoco.osmesa and mujoco.glfw."""

    def __init__(self, max_width: int, max_height: int) -> None: ...
    def as_current(self) -> contextlib.AbstractContextManager[None]: ...
    def free(self) -> None: ...


class OffscreenContext:
    """An offscreen OpenGL context of this process.

    Attributes:
        backend: ``egl``, ``osmesa`` or ``glfw``.

    Raises:
        Exception: any error of the platform's libraries if they are missing or do not work.
    """

    def __init__(self, backend: str) -> None:
        self.backend = backend
        if _is_fork:
            raise RenderingError(f"OpenGL cannot draw in a fork of a process in which it drew: {NEW_PROCESS}")
        if {backend, *_used} > {"osmesa"}:
            raise RenderingError(f"{backend} cannot draw in a process that {' and '.join(_used)} draws in already")
        if backend not in _used:
            _CHECKS[backend]()
        with variable_restored("PYOPENGL_PLATFORM"):  # mujoco sets it; children would inherit it and fail
            context_class: type[_GLContext] = importlib.import_module(f"mujoco.{backend}").GLContext
            self._context = _make_glfw(context_class) if backend == "glfw" else context_class(64, 64)
        _used.add(backend)
        _not_freed.add(self._context)

    @contextlib.contextmanager
    def current(self) -> Generator[None]:
        """Make the context current in this thread; at the end of the block restore the previous one.

        Raises:
            RenderingError: the driver refuses, as EGL does in a thread where the context of an X11 window is
                current; it must be released first.
        """
        with contextlib.ExitStack() as stack:
            try:
                stack.enter_context(self._context.as_current())
            except Exception as error:
                reason = f"{type(error).__name__}; does a window draw in this thread?"
                raise RenderingError(f"cannot use the {self.backend} context in this thread: {reason}") from None
            yield

    def close(self) -> None:
        """Free the context; its OpenGL objects must be freed before."""
        self._context.free()
        _not_freed.discard(self._context)


class Closeable(Protocol):
    """An object with OpenGL resources."""

    def close(self) -> None:
        """Free the resources; a second call does nothing."""


def close_at_exit(resource: Closeable) -> None:
    """Close a resource at the exit of Python, if it still exists then.

    Call it only after a context was created: the platform's own exit handlers are then registered before this one, and
    so run after it.
    """
    if not _open:
        atexit.register(_close_all)
    _open.add(resource)


def requested_backend() -> str | None:
    """Return the backend that ``MUJOCO_GL`` requests; None if it is not set.

    Raises:
        RenderingError: the variable has a value that MuJoCo does not know.
    """
    value = os.environ.get("MUJOCO_GL", "").strip().lower()
    if value not in _BY_ENVIRONMENT:
        raise RenderingError(f"MUJOCO_GL is {value!r}, expected egl, osmesa, glfw or disable")
    return _BY_ENVIRONMENT[value]


def make_with_backend(backend: str, make: Callable[[OffscreenContext], _Made]) -> _Made:
    """Call ``make`` with a new context of one of ``GL_BACKENDS``; its result is responsible for closing the context.

    Raises:
        RenderingError: the backend does not work; the message says why and how to install it.
    """
    try:
        return attempt(backend, make)
    except RenderingError:
        raise
    except Exception as error:
        reason = one_line(error)
        raise RenderingError(f"cannot draw with {backend}: {reason} (try: {remedy(backend)})") from None


def remedy(backend: str) -> str:
    """Return advice on how to make an unavailable backend work."""
    if backend == "egl" and _DEVICE in os.environ:
        return f"unset {_DEVICE}, or set it to the number of a GPU"
    return INSTALL[backend]


def make_with_any_backend(make: Callable[[OffscreenContext], _Made]) -> _Made | None:
    """Call ``make`` with a new context of the first backend that works; return None if none does.

    Later calls try this backend first. The result of ``make`` is responsible for closing the context.
    """
    for backend in _order():
        try:
            made = attempt(backend, make)
        except Exception as error:
            _LOG.info("no pictures with %s: %s", backend, one_line(error))
        else:
            _remembered[:] = [backend]
            return made
    return None


def attempt(backend: str, make: Callable[[OffscreenContext], _Made]) -> _Made:
    """Call ``make`` with a new context of one backend, like :func:`make_with_backend` but with the original errors.

    Raises:
        Exception: any error of the platform's libraries if they are missing or do not work.
    """
    with _lock:
        context = OffscreenContext(backend)
        try:
            return make(context)
        except BaseException:
            context.close()
            raise


def draws_with_hardware() -> bool:
    """Return whether a graphics card renders the current OpenGL context; False if unknown."""
    try:
        with variable_restored("PYOPENGL_PLATFORM"):
            gl = importlib.import_module("OpenGL.GL")
            name = bytes(gl.glGetString(gl.GL_RENDERER)).decode(errors="replace").lower()
    except Exception as error:  # PyOpenGL raises exceptions of many kinds
        _LOG.info("OpenGL does not say what draws: %s", one_line(error))
        return False
    return not any(part in name for part in _SOFTWARE)


def one_line(error: BaseException) -> str:
    """Return the message of an exception as one line; its type if the message is empty."""
    return " ".join(str(error).split()) or type(error).__name__


def _order() -> tuple[str, ...]:
    known = GL_BACKENDS if sys.platform == "linux" else ("glfw",)
    return tuple(dict.fromkeys((*_remembered, *known)))


def _close_all() -> None:
    end()  # no thread may draw from here on
    for resource in list(_open):
        resource.close()


@in_child
def _disown_all() -> None:
    """Disown the contexts in a forked child: freeing them, even at exit, would need threads of the parent."""
    global _is_fork, _lock
    _is_fork, _lock = _is_fork or bool(_used), threading.RLock()
    for thing in (*_open, *_not_freed):
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(thing))
    _open.clear()
    _not_freed.clear()
    if "mujoco.egl" in sys.modules:
        atexit.unregister(sys.modules["mujoco.egl"]._terminate_display)
    libc = ctypes.CDLL(None)
    if _is_fork and hasattr(libc, "on_exit"):  # OSMesa would wait for its threads
        libc.on_exit(libc._exit, None)


def _check_osmesa() -> None:
    for name in ("libOSMesa.so.8", "libOSMesa.so.6"):
        with contextlib.suppress(OSError):
            ctypes.CDLL(name)
            return
    raise RuntimeError("libOSMesa is not installed")


def _check_glfw() -> None:
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise RuntimeError("there is no display (DISPLAY and WAYLAND_DISPLAY are not set)")


def _make_glfw(context_class: type[_GLContext]) -> _GLContext:
    """Create the context of an invisible GLFW window; raise if it fails, since GLFW only warns."""
    glfw = importlib.import_module("glfw")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        context = context_class(64, 64)
        with context.as_current():
            if glfw.get_current_context():
                return context
    raise RuntimeError(str(caught[0].message) if caught else "GLFW makes no context")


_CHECKS: dict[str, Callable[[], None]] = {"egl": check_egl, "osmesa": _check_osmesa, "glfw": _check_glfw}
_open: "weakref.WeakSet[Closeable]" = weakref.WeakSet()
_used: set[str] = set()
_is_fork = False  # in a process that has rendered
_not_freed: set[_GLContext] = set()  # else garbage collection could free a context before its objects
_remembered: list[str] = []
_lock = threading.RLock()
