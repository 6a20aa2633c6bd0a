"""Check that EGL works on this machine, without side effects: a libEGL that fails is unloaded.

MuJoCo loads its OpenGL functions from the first platform library of the process. A loaded libEGL that does not work
would therefore prevent OSMesa from working, and PyOpenGL, which mujoco.egl uses, selects its platform on import. So
EGL is tried with ctypes first.
"""

import _ctypes
import contextlib
import ctypes
import os
from collections.abc import Generator

_EGL_PLATFORM_DEVICE_EXT = 0x313F
_MAX_DEVICES = 32


def check_egl() -> None:
    """Raise RuntimeError with the reason if EGL cannot render without a display."""
    library = _load(("libEGL.so.1",))
    try:
        _load(("libOpenGL.so.0", "libGL.so.1"))
        with variable_restored("EGL_LOG_LEVEL", "fatal"):  # else Mesa writes its own warnings to stderr
            _initialize_a_device(library)
    except BaseException:
        _ctypes.dlclose(library._handle)  # pyright: ignore[reportPrivateUsage] - documented in the manual
        raise


def _load(names: tuple[str, ...]) -> ctypes.CDLL:
    for name in names:
        with contextlib.suppress(OSError):
            return ctypes.CDLL(name)
    raise RuntimeError(f"{' or '.join(names)} is not installed")


def _initialize_a_device(library: ctypes.CDLL) -> None:
    """Initialize an EGL display on any device as mujoco.egl does; raise if none works."""
    query = ctypes.CFUNCTYPE(
        ctypes.c_uint, ctypes.c_int, ctypes.POINTER(ctypes.c_void_p), ctypes.POINTER(ctypes.c_int)
    )(_address(library, b"eglQueryDevicesEXT"))
    get_display = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p)(
        _address(library, b"eglGetPlatformDisplayEXT")
    )
    devices = (ctypes.c_void_p * _MAX_DEVICES)()
    count = ctypes.c_int(0)
    query(_MAX_DEVICES, devices, ctypes.byref(count))
    if count.value == 0:
        raise RuntimeError("EGL finds no device: no OpenGL driver is installed")
    for device in devices[: count.value]:
        display = get_display(_EGL_PLATFORM_DEVICE_EXT, device, None)
        if display and library.eglInitialize(ctypes.c_void_p(display), None, None):
            return
    raise RuntimeError("EGL cannot initialize any device: the OpenGL driver is missing or does not work")


def _address(library: ctypes.CDLL, name: bytes) -> int:
    get_address = library.eglGetProcAddress
    get_address.restype = ctypes.c_void_p
    get_address.argtypes = [ctypes.c_char_p]
    address = get_address(name)
    if not address:
        raise RuntimeError(f"this EGL is too old: it has no {name.decode()}")
    return int(address)


@contextlib.contextmanager
def variable_restored(name: str, meanwhile: str | None = None) -> Generator[None]:
    """Set an unset environment variable during the block, and unset it at the end, even if other code changed it."""
    if name in os.environ:
        yield
        return
    if meanwhile is not None:
        os.environ[name] = meanwhile
    try:
        yield
    finally:
        os.environ.pop(name, None)
