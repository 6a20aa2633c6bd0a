"""Runs the commands as users do: in processes of their own, on pipes and on terminals."""

import functools
import os
import re
import signal
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pexpect
from forks import Forks
from waiting import PATIENCE

import ravemj
from ravemj.graphics.rendering import Camera
from ravemj.graphics.rendering.contexts import requested_backend

PACKAGE_ROOT = Path(ravemj.__file__).resolve().parent.parent
TUTORIAL = Path(__file__).resolve().parent / "data" / "tutorial"
TUTORIAL_CAMERA = np.array([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
PRINTED_BY_THE_SCRIPT = "2\n[0. 0.]\n[[ 0.  0. -1.  1.]\n [ 1.  0.  0.  0.]\n [ 0. -1.  0.  0.]\n [ 0.  0.  0.  1.]]\n"
RAYS_DREW = "ravemj: no OpenGL here, so rays drew the picture; faster: apt-get install libegl1 libgl1\n"


def environment(folder: Path, **changes: str) -> dict[str, str]:
    """The variables of a command: this ravemj, no display, and a fresh IPython."""
    dropped = {"DISPLAY", "WAYLAND_DISPLAY", "OPENRAVE_DATA", "PYTHONUNBUFFERED", "PYTHONPATH", "LINES", "COLUMNS"}
    inherited = {name: value for name, value in os.environ.items() if name not in dropped}
    of_python = {"PYTHONPATH": str(PACKAGE_ROOT), "PYTHONDONTWRITEBYTECODE": "1", "TERM": "xterm", "PAGER": "cat"}
    of_ipython = {"IPYTHONDIR": str(folder / ".ipython"), "IPY_TEST_SIMPLE_PROMPT": "1"}
    return {**inherited, **of_python, **of_ipython, **changes}


def run(
    folder: Path, *arguments: str | Path, variables: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Run Python on some arguments and return what came of it; modules without variables in a fork, which is quick."""
    words, made = [str(argument) for argument in arguments], environment(folder, **(variables or {}))
    if words[0] == "-m" and not variables:
        return _forks().run(words[1], words[2:], folder, made)
    return subprocess.run(
        [sys.executable, *words],
        cwd=folder,
        env=made,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        stdin=subprocess.DEVNULL,
        check=False,
    )


@functools.cache
def _forks() -> Forks:
    return Forks(environment(PACKAGE_ROOT), PATIENCE)


def ravemj_command(folder: Path, *arguments: str | Path, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run ``ravemj ARGUMENTS`` in a folder.

    Where there is no OpenGL, a line says so once a picture is drawn: it is checked here, and taken away.
    """
    done = run(folder, "-m", "ravemj", *arguments, variables=variables)
    is_drawn = done.stdout.startswith("wrote ") and not re.search(r"\.html \(|points in", done.stdout)
    if is_drawn and arguments[0] in {"play", "render"}:
        note = note_on_rays()
        assert note in done.stderr
        done.stderr = done.stderr.replace(note, "", 1)
    if arguments[:1] == ("plan",):  # which draws only where it should
        done.stderr = done.stderr.replace(RAYS_DREW, "")
    return done


class Served:
    """A command that serves a page and runs on until a signal ends it.

    Attributes:
        url: The address that it prints.
    """

    def __init__(self, folder: Path, *words: str):
        heed_interrupts()
        command = [sys.executable, "-m", "ravemj", *words]
        variables = environment(folder, PYTHONFAULTHANDLER="1")  # so that one that crashes says where
        self._process = subprocess.Popen(command, cwd=folder, env=variables, stdout=-1, stderr=-1, text=True)

    def __enter__(self) -> "Served":
        self.url = self._process.stdout.readline().strip()
        return self

    def __exit__(self, *reason: object) -> None:
        self._process.kill()
        self._process.communicate()

    def next_message(self) -> str:
        """Return the next line of standard error."""
        return self._process.stderr.readline()

    def end(self, number: int) -> tuple[int, str, str]:
        """Send a signal; return the exit code and what else was printed."""
        self._process.send_signal(number)
        return self._process.wait(PATIENCE), *self._process.communicate()


@functools.cache
def note_on_rays() -> str:
    """What commands say where rays drew for want of OpenGL; nothing where it works, or ``MUJOCO_GL`` has chosen."""
    if requested_backend() is not None:
        return ""
    code = "from ravemj.graphics.rendering import doctor; print(*(r.name for r in doctor.probe_backends() if r.works))"
    return RAYS_DREW if run(PACKAGE_ROOT, "-c", code).stdout == "ray\n" else ""


def on_terminal(folder: Path, *arguments: str, simple: bool = True, **variables: str) -> pexpect.spawn:
    """Start Python on a terminal of its own; simple: where IPython prompts, it does so without colours."""
    changed = environment(folder, **variables)
    if not simple:
        del changed["IPY_TEST_SIMPLE_PROMPT"]
    return pexpect.spawn(
        sys.executable,
        list(arguments),
        cwd=str(folder),
        env=changed,
        encoding="utf-8",
        timeout=PATIENCE,
        dimensions=(50, 160),
        echo=False,
    )


def heed_interrupts() -> None:
    """Let the processes that we start hear Ctrl-C and SIGHUP, also if a shell or nohup has these ignored."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:  # as nohup leaves it
        signal.signal(signal.SIGHUP, signal.SIG_DFL)


def finish(terminal: pexpect.spawn) -> tuple[str, int | None]:
    """Wait for the end; return what was printed since the last expectation, and the exit code."""
    terminal.expect(pexpect.EOF)
    terminal.close()
    return plain(terminal.before), terminal.exitstatus


def plain(text: str) -> str:
    """Return text without what steers terminals."""
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b[=>]|\r", "", text)


def colour_of(pixels: np.ndarray) -> str:
    """Name the colour of most of some pixels."""
    red, green, blue = np.median(np.asarray(pixels, dtype=float).reshape(-1, 3), axis=0)
    names = {"red": red - max(green, blue), "green": green - max(red, blue), "blue": blue - max(red, green)}
    name = max(names, key=names.__getitem__)
    return name if names[name] > 40 else "none"


def colour_at(frame: np.ndarray, point: tuple[float, float, float], size: tuple[int, int] | None = None) -> str:
    """Name the colour where a point of the world is seen from the tutorial's camera.

    Args:
        frame: The picture, (height, width, 3).
        point: World coordinates [m].
        size: Width and height that the camera had, where the picture was padded.
    """
    width, height = size or (frame.shape[1], frame.shape[0])
    ((x, y),), _ = Camera(TUTORIAL_CAMERA).project([point], width, height)
    return colour_of(frame[int(y) - 1 : int(y) + 2, int(x) - 1 : int(x) + 2])


def pose(frame: np.ndarray, size: tuple[int, int] | None = None) -> str:
    """Say how the tutorial's pendulum hangs or stands, by the colours half along its red and its blue arm."""
    for name, direction in {"hanging": (0, 0, -1), "upright": (0, 0, 1), "level": (0, 1, 0)}.items():
        y, z = direction[1:]
        seen = [colour_at(frame, (0, along * y, along * z), size) for along in (0.1, 0.3)]
        if seen == ["red", "blue"]:
            return name
    return "otherwise"
