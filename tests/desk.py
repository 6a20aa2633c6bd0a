"""A window that is driven by real events, and beside it the core on its own that is driven by the same ones."""

import ast
import signal
from pathlib import Path

import numpy as np
from command_line import colour_of, on_terminal
from screens import Display
from waiting import await_that

import ravemj
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import Button, Interaction, Key, Move, Press, Release, Wheel

SIZE = 640, 480
ASLANT = ravemj.transformLookat(lookat=[0.386, 0.325, 0.136], camerapos=[0.943, 0.792, 0.474], cameraup=[0, 0, -1])
DISTANCE = 0.8
SETTLE = """
import time
from ravemj.gui.viewers import sharpness, window

def settle():
    count, usual, window._LONGEST_SYNC = -1, window._LONGEST_SYNC, 60.0
    while count != len(pictures):  # the last one is crisp
        count = len(pictures)
        viewer.EnvironmentSync()
        time.sleep(1.5 * sharpness.REST)
        viewer.EnvironmentSync()
    window._LONGEST_SYNC = usual
"""
"""Waits until a window draws nothing more, also on a busy machine; ``pictures`` has an entry for each picture."""

_SCRIPT = """
import ravemj
env = ravemj.Environment()
pictures = []

def show(model, camera, distance, width, height):
    global robot, viewer, kept
    env.Reset()
    env.Load(model)
    env.SetViewer('window')
    robot, viewer = env.GetRobots()[0], env.GetViewer()
    pictures.clear()
    kept = viewer.RegisterViewerImageCallback(lambda picture: pictures.append(1))
    viewer.SetSize(width, height)
    viewer.Move(0, 0)
    viewer.SetCamera(camera, distance)


print('=ready.')
while True:
    try:
        print('=', eval(input()), '.', sep='')
    except Exception as error:
        print('=', error, '.', sep='')
"""
_XDOTOOL_BUTTON = {Button.LEFT: "1", Button.MIDDLE: "2", Button.RIGHT: "3"}


class Desk:
    """A process with a window, and an environment here that should always be in the same state."""

    def __init__(self, display: Display, folder: Path) -> None:
        self.display, self.folder = display, folder
        (folder / "script.py").write_text(SETTLE + _SCRIPT)
        self.terminal = on_terminal(folder, "script.py", DISPLAY=display.name)
        self.answer()

    def show(self, model: str = "env.xml", camera=ASLANT, size=SIZE) -> "Desk":
        """Open a new window with the model as it is in the file."""
        self.ask(f"show({model!r}, {np.asarray(camera).tolist()}, {DISTANCE}, {size[0]}, {size[1]})")
        await_that(lambda: len(self.display.windows()) == 1, "there is not one window")
        self.window = str(self.display.windows()[0])
        await_that(lambda: self.picture().shape == (size[1], size[0], 3), "the window has another size")
        self.env = ravemj.load(self.folder / model)
        self.robot = self.env.GetRobots()[0]
        self.core = Interaction.first_view(self.env.simulation, Camera(np.asarray(camera)), size)
        self.core.look_from(Camera(np.asarray(camera)), DISTANCE)
        self.move(5, size[1] // 2)
        return self

    def close(self) -> None:
        self.terminal.kill(signal.SIGKILL)
        self.terminal.wait()
        self.terminal.close()

    # --- the process

    def answer(self) -> str:
        self.terminal.expect(r"=(.*?)\.\r?\n")
        return self.terminal.match[1]

    def ask(self, expression: str) -> str:
        """Return what the script answers."""
        self.terminal.sendline(expression)
        return self.answer()

    def do(self, statements: str) -> None:
        """Run statements about ``env`` and ``robot`` there and here."""
        assert self.ask(f"exec({statements!r})") == "None"
        exec(statements, {"env": self.env, "robot": self.robot, "ravemj": ravemj})

    def array(self, expression: str) -> np.ndarray:
        return np.array(ast.literal_eval(self.ask(f"({expression}).tolist()")))

    @property
    def camera(self) -> np.ndarray:
        return self.array("viewer.GetCameraTransform()")

    @property
    def lines(self) -> tuple[str, ...]:
        """The text in the window."""
        return ast.literal_eval(self.ask("viewer.interaction.overlay().lines"))

    # --- the screen

    def picture(self) -> np.ndarray:
        return self.display.picture(int(self.window))

    def settled_picture(self) -> np.ndarray:
        """Return the pixels once the screen has what the environment has, and no more is drawn."""
        self.ask("settle()")
        return self.picture()

    def at(self, point) -> tuple[int, int]:
        """Where a point of the world is in the window."""
        ((x, y),), _ = self.core.view.camera.project([point], *self.core.view.size)
        return round(x), round(y)

    def colour(self, point) -> str:
        """The colour where a point of the world is seen."""
        x, y = self.at(point)
        assert 3 <= x < SIZE[0] - 3, "the test looks beside the window"
        assert 3 <= y < SIZE[1] - 3, "the test looks beside the window"
        return colour_of(self.picture()[y - 1 : y + 2, x - 1 : x + 2])

    def await_colour(self, point, name: str) -> None:
        await_that(lambda: self.colour(point) == name, f"it is not {name} at {self.at(point)}")

    def on_link(self, index: int, point=(0.1, 0, 0)) -> np.ndarray:
        """A point of a link in the world; at first the middle of an arm of the pendulum."""
        return (self.robot.GetLinks()[index].GetTransform() @ [*point, 1])[:3]

    # --- the mouse and the keys

    def move(self, x: float, y: float) -> None:
        self.display.tool("mousemove", "--window", self.window, str(round(x)), str(round(y)))
        self.core.handle(Move(round(x), round(y)))

    def press(self, at, button=Button.LEFT, keys=()) -> None:
        self.move(*at)
        for key in keys:
            self.display.tool("keydown", key)
            self.core.handle(Key(key))
        self.display.tool("mousedown", _XDOTOOL_BUTTON[button])
        self.core.handle(Press(*at, button, "ctrl" in keys, "shift" in keys))

    def release(self, at, button=Button.LEFT, keys=()) -> None:
        self.display.tool("mouseup", _XDOTOOL_BUTTON[button])
        self.core.handle(Release(*at, button))
        for key in keys:
            self.display.tool("keyup", key)
            self.core.handle(Key(key, False))

    def drag(self, *stops, button=Button.LEFT, keys=()) -> None:
        self.press(stops[0], button, keys)
        for stop in stops[1:]:
            self.move(*stop)
        self.release(stops[-1], button, keys)

    def click(self, at, **how) -> None:
        self.drag(at, at, **how)

    def wheel(self, steps: int) -> None:
        for _ in range(abs(steps)):
            self.display.tool("click", "4" if steps > 0 else "5")
            self.core.handle(Wheel(1 if steps > 0 else -1))

    def escape(self) -> None:
        self.display.tool("key", "Escape")
        self.core.handle(Key("escape"))
        self.core.handle(Key("escape", False))

    # --- what should come of it

    def await_camera(self) -> np.ndarray:
        expected = self.core.view.camera.T_world_camera
        await_that(lambda: np.allclose(self.camera, expected, atol=1e-6), f"the camera does not come to {expected}")
        return expected

    def await_bodies(self) -> None:
        """Wait until poses and joint values there are those that they are here."""
        for body in self.env.GetBodies():
            there = f"env.GetKinBody({body.GetName()!r})"
            for what in ("GetDOFValues()", "GetTransform()"):
                expected = eval(f"body.{what}")
                await_that(
                    lambda there=there, what=what, expected=expected: np.allclose(
                        self.array(f"{there}.{what}"), expected, atol=1e-6
                    ),
                    f"{body.GetName()} does not come to {expected}",
                )
