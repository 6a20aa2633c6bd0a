"""Mouse and keys in a window on a virtual display: they do what the core does, and the picture shows it."""

import ast
import math
import time

import numpy as np
import pytest
from command_line import on_terminal
from screens import NEEDS_A_SCREEN, Display, await_that

import ravemj
from ravemj.interaction import Button, Interaction, Key, Move, Press, Release, Tool, Wheel, tools
from ravemj.interaction.cube import Cube
from ravemj.interaction.joint_handle import JointHandle
from ravemj.rendering import Camera

pytestmark = NEEDS_A_SCREEN
SIZE = 640, 480
ASLANT = np.array(
    [[-0.643, 0.324, -0.694, 0.943], [0.766, 0.272, -0.583, 0.792], [0, -0.906, -0.423, 0.474], [0, 0, 0, 1]]
)
SCRIPT = """
import numpy, openravepy
env = openravepy.Environment()
env.Load('env.xml')
env.SetViewer('window')
robot, viewer = env.GetRobots()[0], env.GetViewer()
pictures, turns = [], []
kept = viewer.RegisterViewerImageCallback(lambda picture: pictures.append(1))
viewer.SetSize(640, 480)
viewer.Move(0, 0)
viewer.SetCamera(numpy.array(CAMERA), 0.8)
print('ready')
while True:
    try:
        print('=', eval(input()), '.', sep='')
    except Exception as error:
        print('=', error, '.', sep='')
"""
XDOTOOL_BUTTON = {Button.LEFT: "1", Button.MIDDLE: "2", Button.RIGHT: "3"}


class Desk:
    """A window that is driven by real events, and the core on its own that is driven by the same ones."""

    def __init__(self, display: Display, folder) -> None:
        self.display = display
        (folder / "script.py").write_text(SCRIPT.replace("CAMERA", repr(ASLANT.tolist())))
        self.terminal = on_terminal(folder, "-m", "ravemj", "run", "script.py", DISPLAY=display.name)
        self.terminal.expect("ready")
        self.window = str(display.await_window())
        await_that(lambda: self.picture().shape == (480, 640, 3), "the window has another size")
        self.env = ravemj.load(folder / "env.xml")
        self.robot = self.env.GetRobots()[0]
        self.core = Interaction(self.env._simulation, Camera(ASLANT), SIZE)
        self.core.look_from(Camera(ASLANT), 0.8)

    def picture(self) -> np.ndarray:
        return self.display.picture(int(self.window))

    def ask(self, expression: str) -> str:
        """What the script answers."""
        self.terminal.sendline(expression)
        self.terminal.expect(r"=(.*?)\.\r?\n")
        return self.terminal.match[1]

    def array(self, expression: str) -> np.ndarray:
        return np.array(ast.literal_eval(self.ask(f"({expression}).tolist()")))

    def at(self, point) -> tuple[int, int]:
        ((x, y),), _ = self.core.view.camera.project([point], *SIZE)
        return round(x), round(y)

    def move(self, x, y):
        self.display.tool("mousemove", "--window", self.window, str(x), str(y))
        self.core.handle(Move(x, y))

    def press(self, at, button=Button.LEFT, keys=()):
        self.move(*at)
        for key in keys:
            self.display.tool("keydown", key)
            self.core.handle(Key(key))
        self.display.tool("mousedown", XDOTOOL_BUTTON[button])
        self.core.handle(Press(*at, button, "ctrl" in keys, "shift" in keys))

    def release(self, at, button=Button.LEFT, keys=()):
        self.display.tool("mouseup", XDOTOOL_BUTTON[button])
        self.core.handle(Release(*at, button))
        for key in keys:
            self.display.tool("keyup", key)
            self.core.handle(Key(key, False))

    def drag(self, *stops, button=Button.LEFT, keys=()):
        self.press(stops[0], button, keys)
        for stop in stops[1:]:
            self.move(*stop)
        self.release(stops[-1], button, keys)

    def escape(self):
        self.display.tool("key", "Escape")
        self.core.handle(Key("escape"))
        self.core.handle(Key("escape", False))

    def await_camera(self) -> None:
        expected = self.core.view.camera.T_world_camera
        await_that(
            lambda: np.allclose(self.array("viewer.GetCameraTransform()"), expected, atol=1e-6),
            f"the camera does not come to {expected}",
            seconds=10,
        )

    def await_values(self, expected) -> None:
        await_that(
            lambda: np.allclose(self.array("robot.GetDOFValues()"), expected, atol=1e-6),
            f"the joints do not come to {expected}",
            seconds=10,
        )


@pytest.fixture
def desk(display, folder):
    desk = Desk(display, folder)
    yield desk
    desk.display.close(int(desk.window))
    desk.terminal.close(force=True)


def test_camera_mode(desk):
    for how in ({}, {"keys": ["shift"]}, {"button": Button.MIDDLE}):
        before = desk.core.view.camera.T_world_camera
        desk.drag((320, 100), (350, 120), (400, 130), **how)
        assert not np.allclose(before, desk.core.view.camera.T_world_camera)
        desk.await_camera()
    for button, steps in (("4", 1), ("5", -1), ("4", 1)):
        desk.display.tool("click", button)
        desk.core.handle(Wheel(steps))
        desk.await_camera()
    desk.press((300, 100))
    desk.press((300, 100), Button.MIDDLE)
    desk.move(300, 130)
    desk.release((300, 130), Button.MIDDLE)
    desk.release((300, 130))
    desk.await_camera()
    target = (desk.robot.GetLinks()[2].GetTransform() @ [0.1, 0, 0, 1])[:3]
    desk.drag(desk.at(target), desk.at(target), keys=["s"])
    assert np.linalg.norm(desk.core.view.focus - target) < 0.03
    desk.await_camera()
    for tool in (Tool.ROT_X, Tool.ROT_Y, Tool.DOLLY):
        rect = tools(SIZE)[tool]
        start = int(rect.x) + 6, int(rect.y) + 6
        desk.drag(start, (start[0] + 20, start[1] + 30))
        desk.await_camera()


def test_interaction_mode(desk):
    desk.escape()
    arm = (desk.robot.GetLinks()[2].GetTransform() @ [0.15, 0, 0, 1])[:3]
    plain = desk.picture()
    desk.drag(desk.at(arm), desk.at(arm))
    await_that(lambda: desk.ask("viewer.GetSelectedBody().GetName()") == "Pendulum", "no cube")
    cube = Cube.around(desk.robot._state)
    corner = (cube.T_world_cube @ [*cube.half, 1])[:3]
    x, y = desk.at(corner)
    around = slice(y - 3, y + 4), slice(x - 3, x + 4)
    await_that(lambda: np.ptp(desk.picture()[around].astype(int), axis=2).max() > 60, "the cube is not seen")
    await_that(lambda: np.abs(desk.picture()[10:30, 10:200].astype(int) - plain[10:30, 10:200]).max() > 50, "no text")
    face = (cube.T_world_cube @ [0.3 * cube.half[0], 0.3 * cube.half[1], cube.half[2], 1])[:3]
    start = desk.at(face)
    before = desk.robot.GetTransform()
    desk.drag(start, (start[0] + 30, start[1]), (start[0] + 50, start[1] + 20))
    assert np.linalg.norm(desk.robot.GetTransform()[:3, 3] - before[:3, 3]) > 0.01
    await_that(
        lambda: np.allclose(desk.array("robot.GetTransform()"), desk.robot.GetTransform(), atol=1e-6), "it stays there"
    )
    arm = (desk.robot.GetLinks()[2].GetTransform() @ [0.15, 0, 0, 1])[:3]
    desk.drag(desk.at(arm), desk.at(arm))
    await_that(lambda: desk.ask("viewer.GetSelectedBody()") == "None", "the cube stays")


def test_joints_are_turned_by_the_mouse_and_by_the_script(desk):
    desk.escape()
    arm = (desk.robot.GetLinks()[2].GetTransform() @ [0.15, 0, 0, 1])[:3]
    desk.drag(desk.at(arm), desk.at(arm), keys=["ctrl"])
    await_that(lambda: desk.ask("viewer.GetSelectedJoint().GetName()") == "Joint1", "no joint")
    assert desk.ask("viewer.GetSelectedLink().GetName()") == "Arm1"
    handle = JointHandle.at(desk.robot._state, 1)
    grip = handle.hit(desk.core.view.ray(*desk.at(handle.center + 0.02 * handle.T_world_handle[:3, 1])))
    start = desk.at(grip)
    desk.drag(start, (start[0] + 15, start[1] + 5), (start[0] + 20, start[1] + 30))
    turned = desk.robot.GetDOFValues()
    assert abs(turned[1]) > 0.2
    desk.await_values(turned)
    desk.ask("robot.SetDOFValues([0.5, -1])")
    desk.robot.SetDOFValues([0.5, -1])
    tip = (desk.robot.GetLinks()[2].GetTransform() @ [0.18, 0, 0, 1])[:3]
    x, y = desk.at(tip)

    def is_blue() -> bool:
        red, green, blue = desk.picture()[y, x].astype(int)
        return blue > max(red, green) + 40

    await_that(is_blue, "the window does not show it")


def test_nothing_is_drawn_while_nothing_changes_and_little_is_computed(desk):
    desk.move(5, 240)
    time.sleep(1)
    drawn = desk.ask("len(pictures)")
    used = float(desk.ask("__import__('time').process_time()"))
    time.sleep(2)
    assert desk.ask("len(pictures)") == drawn
    assert float(desk.ask("__import__('time').process_time()")) - used < 0.4
    desk.ask("robot.GetLinks()[2].GetGeometries()[0].SetDiffuseColor([0, 1, 0])")
    await_that(lambda: desk.ask("len(pictures)") != drawn, "a new colour is not drawn")


def test_a_viewer_closes_while_the_script_holds_the_environment(desk):
    desk.ask("[env.Lock(), viewer.EnvironmentSync(), env.SetViewer(''), env.Unlock()][2]")
    await_that(lambda: not desk.display.windows(), "the window stays")
    assert desk.ask("env.SetViewer('window')") == "True"
    desk.window = str(desk.display.await_window())


def test_turning_numbers_stay_finite_while_the_window_is_tiny(desk):
    desk.ask("viewer.SetSize(1, 1)")
    desk.ask("viewer.EnvironmentSync()")
    desk.ask("viewer.SetSize(640, 480)")
    await_that(lambda: desk.picture().shape == (480, 640, 3), "the size does not come back")
    assert math.isfinite(desk.array("viewer.GetCameraTransform()").sum())
