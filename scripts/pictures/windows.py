"""Takes pictures of windows on a virtual screen (Xvfb): ``python scripts/pictures/windows.py docs/pictures``."""

import os
import subprocess
import sys
import time
from pathlib import Path

from PIL import ImageGrab

import ravemj
from ravemj.gui.interaction import Key, Leave, Operate, Press, Release
from ravemj.gui.viewers import Viewer

SIZE = 640, 480


def main(folder: Path) -> None:
    """Start a screen, take the pictures, stop it."""
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24", "-noreset"]
    with subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL) as server:
        os.environ["DISPLAY"] = f":{os.read(reading, 16).decode().strip()}"
        try:
            take(folder)
        finally:
            server.terminate()


def take(folder: Path) -> None:
    """Select a joint and then the robot, and play a motion, with a picture of each."""
    env = ravemj.load("models/env.xml")
    env.SetViewer("window")
    viewer, robot = env.GetViewer(), env.GetRobots()[0]
    viewer.SetSize(*SIZE)
    viewer.Move(0, 0)
    viewer.SetBkgndColor([0.8, 0.85, 0.9])
    viewer.SetCamera([[-0.643, 0.324, -0.694, 0.755], [0.766, 0.272, -0.583, 0.634], [0, -0.906, -0.423, 0.285]])
    robot.SetDOFValues([0.3, 0.7])
    arm = (robot.GetLinks()[2].GetTransform() @ [0.15, 0, 0, 1])[:3]
    viewer.interaction.handle(Key("escape"))
    for name, with_ctrl in (("joint", True), ("cube", False)):
        while viewer.interaction.view.size != SIZE:
            time.sleep(0.05)
        ((x, y),), _ = viewer.camera.project([arm], *SIZE)
        viewer.interaction.handle(Press(x, y, ctrl=with_ctrl))
        viewer.interaction.handle(Release(x, y))
        grab(viewer, folder / f"window-{name}.png")
    for event in (Press(5, 300), Release(5, 300), Leave(), Key("escape"), Operate("joints")):
        viewer.interaction.handle(event)
    viewer.play(ravemj.Motion.line([-0.5, -0.7], [1.5, 1.5], 2.0)).pause()
    viewer.playback.seek(1.2)
    grab(viewer, folder / "window-playback.png")
    env.Destroy()


def grab(viewer: Viewer, file: Path) -> None:
    """Save what the screen shows of a window."""
    viewer.EnvironmentSync()
    time.sleep(0.5)  # until the screen has it
    ImageGrab.grab(xdisplay=os.environ["DISPLAY"]).crop((0, 0, *SIZE)).save(file)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
