"""Takes pictures of windows on a virtual screen (Xvfb): ``python scripts/pictures/windows.py docs/pictures``."""

import os
import subprocess
import sys
import time
from pathlib import Path

from PIL import ImageGrab

import ravemj
from ravemj.gui.interaction import Button, Key, Leave, Move, Operate, Press, Release
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
    take_forces(folder / "window-forces.png")
    take_branches(folder / "window-branches.png")
    take_pins(folder / "window-pins.png")


BOXES = """<Environment>
<KinBody name="floor"><Body type="static"><Geom type="box"><translation>0 0 -0.02</translation>
<extents>0.6 0.6 0.02</extents><diffuseColor>0.75 0.72 0.66</diffuseColor></Geom></Body></KinBody>
{}</Environment>"""
BOX = """<KinBody name="box{0}"><translation>{1}</translation><Body type="dynamic">
<Geom type="box"><extents>0.08 0.08 0.08</extents><diffuseColor>{2}</diffuseColor></Geom>
<mass type="custom"><total>1</total><inertia>0.004 0 0 0 0.004 0 0 0 0.004</inertia></mass></Body></KinBody>"""


def take_forces(file: Path) -> None:
    """Pull one of three boxes while physics runs, and take a picture."""
    env = ravemj.Environment()
    places = (("0 -0.2 0.08", "0.2 0.4 0.7"), ("0 0.15 0.08", "0.3 0.6 0.35"), ("0.02 0.17 0.24", "0.8 0.45 0.2"))
    env.LoadData(BOXES.format("".join(BOX.format(number, *box) for number, box in enumerate(places))))
    env.StopSimulation()
    env.SetPhysicsEngine("mujoco")
    env.GetPhysicsEngine().SetGravity([0, 0, -9.8])
    viewer = opened(env, [1.3, 0.5, 0.75], [0, 0, 0.12])
    for _ in range(100):
        env.StepSimulation(0.01)
    ((x, y),), _ = viewer.camera.project([[0.08, -0.2, 0.1]], *SIZE)
    for event in (Key("c"), Press(x, y, Button.RIGHT), Move(x - 10, y - 110)):
        viewer.interaction.handle(event)
    for _ in range(100):
        env.StepSimulation(0.01)
    grab(viewer, file)
    env.Destroy()


def take_branches(file: Path) -> None:
    """Pull the flange of an arm, and take a picture of its other configurations."""
    env = ravemj.load("models/puma560.xml")
    robot = env.GetRobots()[0]
    robot.SetDOFValues([0.1, -0.5, -1.2, 0.3, 0.6, 0.2])
    viewer = opened(env, [2.2, 1.4, 1.0], [0.35, 0.05, 0.45])
    ((x, y),), _ = viewer.camera.project([robot.GetLinks()[6].GetTransform()[:3, 3]], *SIZE)
    x, y = next((x + i, y + j) for i in range(-20, 21) for j in range(-20, 21) if link_at(viewer, x + i, y + j) == 6)
    for event in (Key("escape"), Press(x, y, ctrl=True, shift=True), Move(x + 10, y - 10), Move(x + 20, y - 15)):
        viewer.interaction.handle(event)
    grab(viewer, file)
    env.Destroy()


def take_pins(file: Path) -> None:
    """Pin the feet of a humanoid, pull a hand, and take a picture."""
    env = ravemj.load("models/biped.robot.xml")
    robot = env.GetRobots()[0]
    viewer = opened(env, [1.7, -1.3, 1.0], [0.05, 0, 0.5])
    viewer.interaction.handle(Key("escape"))

    def at(name: str) -> tuple[float, float]:
        """Return a point of the window where a link is seen."""
        ((x, y),), _ = viewer.interaction.view.camera.project([robot.GetLink(name).ComputeAABB().pos()], *SIZE)
        return x, y

    for foot in ("LFoot", "RFoot"):
        while link_at(viewer, *at(foot)) != robot.GetLink(foot).GetIndex():
            time.sleep(0.05)
        x, y = at(foot)
        for event in (Press(x, y), Release(x, y), Operate("pin"), Press(5, 300), Release(5, 300)):
            viewer.interaction.handle(event)
    x, y = at("RHand")
    for event in (Press(x, y, ctrl=True, shift=True), Move(x - 30, y + 40), Release(x - 60, y + 90)):
        viewer.interaction.handle(event)
    viewer.interaction.handle(Press(5, 300))  # selects nothing
    viewer.interaction.handle(Release(5, 300))
    grab(viewer, file)
    env.Destroy()


def link_at(viewer: Viewer, x: float, y: float) -> int | None:
    """Return the index of the link that is seen at a point of the window."""
    viewer.interaction.handle(Move(x, y))
    hit = viewer.interaction.hover
    return None if hit is None else hit.link


def opened(env: ravemj.Environment, eye: list[float], middle: list[float]) -> Viewer:
    """Open a window that looks from a point to another one."""
    env.SetViewer("window")
    viewer = env.GetViewer()
    viewer.SetSize(*SIZE)
    viewer.Move(0, 0)
    viewer.SetBkgndColor([0.8, 0.85, 0.9])
    viewer.SetCamera(ravemj.transformLookat(lookat=middle, camerapos=eye, cameraup=[0, 0, -1]))
    while viewer.interaction.view.size != SIZE:
        time.sleep(0.05)
    time.sleep(0.5)  # until the window has told where the pointer is
    return viewer


def grab(viewer: Viewer, file: Path) -> None:
    """Save what the screen shows of a window."""
    viewer.EnvironmentSync()
    time.sleep(0.5)  # until the screen has it
    ImageGrab.grab(xdisplay=os.environ["DISPLAY"]).crop((0, 0, *SIZE)).save(file)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
