"""Shows what each gesture does, in a window and on a page: ``python scripts/pictures/gestures.py docs/pictures``.

Real mouse and keys: xdotool on a virtual screen (Xvfb), Playwright in Chromium.
"""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image, ImageGrab
from playwright.sync_api import Page, sync_playwright

import ravemj
from ravemj.gui.interaction.cube import Cube
from ravemj.gui.interaction.joint_handle import JointHandle

SIZE = 480, 360
SIDE = [[-0.643, 0.324, -0.694, 0.755], [0.766, 0.272, -0.583, 0.634], [0, -0.906, -0.423, 0.285]]
POSE = [0.3, 0.7]


class _ScreenHand:
    """Hand on the virtual screen."""

    def _do(self, *words: object) -> None:
        subprocess.run(["xdotool", *map(str, words)], check=True)
        time.sleep(0.1)

    def move(self, x: float, y: float) -> None:
        self._do("mousemove", round(x), round(y))

    def button(self, number: int, down: bool) -> None:
        self._do("mousedown" if down else "mouseup", number)

    def key(self, name: str, down: bool) -> None:
        self._do("keydown" if down else "keyup", name)

    def wheel(self) -> None:
        for _ in range(5):
            self._do("click", 5)

    def picture(self) -> Image.Image:
        time.sleep(0.6)  # until the screen has it
        return ImageGrab.grab(xdisplay=os.environ["DISPLAY"]).crop((0, 0, *SIZE))


class _PageHand:
    """Hand in the browser."""

    def __init__(self, page: Page) -> None:
        self._page = page

    def move(self, x: float, y: float) -> None:
        self._page.mouse.move(round(x), round(y))
        time.sleep(0.1)  # or the page would tell of some of them only

    def button(self, number: int, down: bool) -> None:
        (self._page.mouse.down if down else self._page.mouse.up)(button={1: "left", 2: "middle"}[number])

    def key(self, name: str, down: bool) -> None:
        (self._page.keyboard.down if down else self._page.keyboard.up)(name)

    def wheel(self) -> None:
        for _ in range(5):
            self._page.mouse.wheel(0, 100)

    def picture(self) -> Image.Image:
        time.sleep(0.3)  # until the view has begun to change
        self._page.wait_for_selector("[data-crisp=true]")
        self._page.screenshot(path="gesture.png")
        picture = Image.open("gesture.png").convert("RGB")
        Path("gesture.png").unlink()
        return picture


class Desk:
    """A pendulum in a viewer, and a hand on it."""

    def __init__(self, env: ravemj.Environment, hand: _ScreenHand | _PageHand) -> None:
        self.viewer, self.robot, self.hand = env.GetViewer(), env.GetRobots()[0], hand
        self.viewer.SetBkgndColor([0.8, 0.85, 0.9])
        self.reset()

    def reset(self) -> None:
        """Go back to the first view and pose."""
        self.viewer.SetCamera(SIDE, 1.0)
        self.robot.SetTransform(ravemj.matrixFromAxisAngle([0, 1, 0], np.pi / 2))
        self.robot.SetDOFValues(POSE)
        self.viewer.EnvironmentSync()
        time.sleep(0.3)

    def at(self, point: object) -> tuple[float, float]:
        """Return where a point of the world is in the picture."""
        ((x, y),), _ = self.viewer.camera.project([point], *SIZE)
        return x, y

    @property
    def arm(self) -> tuple[float, float]:
        """A place on the blue arm."""
        return self.at((self.robot.GetLinks()[2].GetTransform() @ [0.15, 0, 0, 1])[:3])

    def on_cube(self, *place: float) -> tuple[float, float]:
        """A place on the cube, in parts of half its sides."""
        cube = Cube.around(self.robot.simulation_state)
        return self.at((cube.T_world_cube @ [*(cube.half * place), 1])[:3])

    @property
    def on_cylinder(self) -> tuple[float, float]:
        """A place on the cylinder."""
        handle = JointHandle.at(self.robot.simulation_state, 1)
        return self.at((handle.T_world_handle @ [0, 0.8 * handle.radius, handle.height / 2, 1])[:3])

    def drag(self, start: tuple[float, float], right: float, down: float, *buttons: int, key: str = "") -> None:
        """Drag with some buttons, and perhaps a key."""
        if key:
            self.hand.key(key, down=True)
        self.hand.move(*start)
        for button in buttons or (1,):
            self.hand.button(button, down=True)
        for part in (0.25, 0.5, 0.75, 1):
            self.hand.move(start[0] + part * right, start[1] + part * down)
        for button in buttons or (1,):
            self.hand.button(button, down=False)
        if key:
            self.hand.key(key, down=False)

    def escape(self) -> None:
        """Press Esc."""
        self.hand.key("Escape", down=True)
        self.hand.key("Escape", down=False)


def wheel(desk: Desk) -> None:
    """Turn the wheel of the mouse over the robot."""
    desk.hand.move(*desk.arm)
    desk.hand.wheel()


CONTROL, SHIFT = "Control", "Shift"
EMPTY = 100, 60
IN_CAMERA_MODE: dict[str, Callable[[Desk], None]] = {
    "turn": lambda desk: desk.drag(EMPTY, 90, -20),
    "rotx": lambda desk: desk.drag((17, 280), 0, 40),
    "roty": lambda desk: desk.drag((90, 347), 40, 0),
    "translate": lambda desk: desk.drag(EMPTY, 80, 30, key=SHIFT),
    "translate-middle": lambda desk: desk.drag(EMPTY, -80, 30, 2),
    "zoom": wheel,
    "zoom-both": lambda desk: desk.drag(EMPTY, 0, 60, 1, 2),
    "dolly": lambda desk: desk.drag((463, 280), 0, 40),
    "centre": lambda desk: desk.drag(desk.arm, 0, 0, key="s"),
}
IN_INTERACTION_MODE: dict[str, Callable[[Desk], None]] = {
    "mode": Desk.escape,
    "select": lambda desk: desk.drag(desk.arm, 0, 0),
    "face": lambda desk: desk.drag(desk.on_cube(0, 0, 1), 40, -25),
    "edge": lambda desk: desk.drag(desk.on_cube(1, 0, 1), 35, 10),
    "unselect": lambda desk: desk.drag(desk.arm, 0, 0),
    "joint": lambda desk: desk.drag(desk.arm, 0, 0, key=CONTROL),
    "joint-turned": lambda desk: desk.drag(desk.on_cylinder, 10, -25),
    "joint-larger": lambda desk: desk.drag(desk.on_cylinder, 0, 0, key=CONTROL),
}


def pictures(desk: Desk) -> Iterator[tuple[str, Image.Image]]:
    """Make each gesture and yield its name and what it leads to."""
    for name, gesture in IN_CAMERA_MODE.items():
        desk.reset()
        gesture(desk)
        yield name, desk.hand.picture()
    desk.reset()
    for name, gesture in IN_INTERACTION_MODE.items():
        gesture(desk)
        yield name, desk.hand.picture()


def of_window() -> dict[str, Image.Image]:
    """Return the pictures of a window."""
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24", "-noreset"]
    with subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL) as server:
        os.environ["DISPLAY"] = f":{os.read(reading, 16).decode().strip()}"
        try:
            env = ravemj.load("models/env.xml")
            env.SetViewer("window")
            env.GetViewer().SetSize(*SIZE)
            env.GetViewer().Move(0, 0)
            taken = dict(pictures(Desk(env, _ScreenHand())))
            env.Destroy()
        finally:
            server.terminate()
    return taken


def of_page() -> dict[str, Image.Image]:
    """Return the pictures of a page."""
    env = ravemj.load("models/env.xml")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]})
        page.goto(env.serve_viewer().url)
        page.wait_for_selector("[data-crisp=true]")
        taken = dict(pictures(Desk(env, _PageHand(page))))
        browser.close()
    env.Destroy()
    return taken


def main(folder: Path) -> None:
    """Put the picture of the window and that of the page beside each other, for each gesture."""
    windows, pages = of_window(), of_page()
    for name, window in windows.items():
        both = Image.new("RGB", (2 * SIZE[0] + 8, SIZE[1]), "white")
        both.paste(window, (0, 0))
        both.paste(pages[name], (SIZE[0] + 8, 0))
        both.quantize(128).save(folder / f"gesture-{name}.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
