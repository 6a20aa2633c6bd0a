"""A virtual screen, windows on it, and the mouse over them."""

import contextlib
import ctypes
import ctypes.util
import json
import os
import select
import shutil
import subprocess
import sys
from collections.abc import Generator
from pathlib import Path

import numpy as np
import pytest
from command_line import TUTORIAL, TUTORIAL_CAMERA, environment, heed_interrupts, pose
from PIL import Image, ImageGrab, features
from waiting import PATIENCE, await_that

NEEDS_A_SCREEN = [
    pytest.mark.gui,
    pytest.mark.skipif(shutil.which("Xvfb") is None, reason="there is no Xvfb: apt-get install xvfb"),
    pytest.mark.skipif(shutil.which("xdotool") is None, reason="there is no xdotool: apt-get install xdotool"),
    pytest.mark.skipif(not features.check("xcb"), reason="this Pillow cannot read an X screen"),
]


class Display:
    """A virtual screen, and the window on it."""

    def __init__(self, name: str) -> None:
        self.name = name

    def tool(self, *words: str) -> str:
        variables = {**os.environ, "DISPLAY": self.name}
        return subprocess.run(["xdotool", *words], env=variables, capture_output=True, text=True, check=False).stdout

    def windows(self) -> list[int]:
        return [int(word) for word in self.tool("search", "--onlyvisible", "--name", "ravemj").split()]

    def picture(self, window: int) -> np.ndarray:
        """Return the pixels of a window, (height, width, 3)."""
        pairs = [line.split("=") for line in self.tool("getwindowgeometry", "--shell", str(window)).split()]
        place = {name: int(value) for name, value in pairs}
        box = (place["X"], place["Y"], place["X"] + place["WIDTH"], place["Y"] + place["HEIGHT"])
        screen: Image.Image = ImageGrab.grab(xdisplay=self.name)
        return np.asarray(screen.convert("RGB").crop(box))

    def close(self, window: int) -> None:
        """Ask a window to close as window managers do."""
        _send_close(self.name, window)

    def set_resource(self, text: str) -> None:
        """Set what desktops tell programs about the screen."""
        _set_resource(self.name, text)

    def await_window(self) -> int:
        await_that(self.windows, "no window came")
        return self.windows()[0]

    def await_pose(self, window: int, name: str) -> np.ndarray:
        await_that(lambda: pose(self.picture(window)) == name, f"the pendulum never was {name}")
        return self.picture(window)


class ClientMessage(ctypes.Structure):
    """What one program sends to the window of another, as large as any event of X."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("window", ctypes.c_ulong),
        ("message_type", ctypes.c_ulong),
        ("format", ctypes.c_int),
        ("data", ctypes.c_long * 5),
        ("rest_of_xevent", ctypes.c_long * 24),
    )


def _set_resource(display_name: str, text: str) -> None:
    xlib = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
    xlib.XOpenDisplay.restype = ctypes.c_void_p
    xlib.XDefaultRootWindow.restype = ctypes.c_ulong
    display = ctypes.c_void_p(xlib.XOpenDisplay(display_name.encode()))
    root = ctypes.c_ulong(xlib.XDefaultRootWindow(display))
    resource_manager, string, replace = ctypes.c_ulong(23), ctypes.c_ulong(31), 0
    xlib.XChangeProperty(display, root, resource_manager, string, 8, replace, text.encode(), len(text))
    xlib.XCloseDisplay(display)


def _send_close(display_name: str, window: int) -> None:
    xlib = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
    xlib.XOpenDisplay.restype = ctypes.c_void_p
    xlib.XInternAtom.restype = ctypes.c_ulong
    xlib.XInternAtom.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
    xlib.XSendEvent.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
    xlib.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display = xlib.XOpenDisplay(display_name.encode())
    protocols, delete = (xlib.XInternAtom(display, name, 0) for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW"))
    client_message = 33
    message = ClientMessage(client_message, 0, 1, display, window, protocols, 32, (ctypes.c_long * 5)(delete))
    assert xlib.XSendEvent(display, window, 0, 0, ctypes.byref(message))
    xlib.XCloseDisplay(display)


@pytest.fixture(scope="module")
def display() -> Generator[Display]:
    """A virtual screen of our own."""
    with virtual_screen() as (display, _):
        yield display


@contextlib.contextmanager
def virtual_screen() -> Generator[tuple[Display, subprocess.Popen[bytes]]]:
    """Start a screen on a number that nobody has; it does not restart whenever its last client leaves."""
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24", "-noreset"]
    server = subprocess.Popen(command, pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(writing)
    try:
        ready, _, _ = select.select([reading], [], [], PATIENCE)
        number = os.read(reading, 16).decode().strip() if ready else ""
        if not number:
            pytest.skip("Xvfb does not start here")
        yield Display(f":{number}"), server
    finally:
        os.close(reading)
        server.terminate()
        server.wait(PATIENCE)


@pytest.fixture
def folder(tmp_path) -> Path:
    """The tutorial's folder, with its camera."""
    for path in TUTORIAL.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "camera.json").write_text(json.dumps(TUTORIAL_CAMERA.tolist()))
    return tmp_path


class Started:
    """A command under way on a display."""

    def __init__(self, display: Display, folder: Path, *words: str) -> None:
        heed_interrupts()
        variables = environment(folder, DISPLAY=display.name)
        self.process = subprocess.Popen(
            [sys.executable, *words], cwd=folder, env=variables, stdout=-1, stderr=-1, stdin=-3, text=True
        )

    def __enter__(self) -> "Started":
        return self

    def __exit__(self, *reason: object) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    @property
    def runs(self) -> bool:
        return self.process.poll() is None

    def end(self) -> tuple[int, str, str]:
        printed = self.process.communicate(timeout=PATIENCE)
        return (self.process.returncode, *printed)
