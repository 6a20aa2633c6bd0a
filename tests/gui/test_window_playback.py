"""Playing a motion, saving and the joints' sliders in a window, with a real mouse and keys."""

import ast
import re

import imageio.v3
import numpy as np
import pytest
from command_line import TUTORIAL, on_terminal
from desk import SETTLE
from screens import NEEDS_A_SCREEN
from waiting import await_that

from ravemj.gui.interaction import Control, ControlLayout

pytestmark = NEEDS_A_SCREEN
SIZE = 640, 480
SCRIPT = """
import numpy, openravepy, ravemj
env = openravepy.Environment()
env.Load('env.xml')
env.SetViewer('window')
robot, viewer = env.GetRobots()[0], env.GetViewer()
pictures = []
kept = viewer.RegisterViewerImageCallback(lambda picture: pictures.append(1))
viewer.SetSize(640, 480)
viewer.Move(0, 0)
viewer.SetCamera([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
def play(duration=100.0):
    viewer.play(ravemj.Motion.line([0, 0], [2, -1], duration))
def reset():
    viewer.playback.clear()
    viewer.playback.speed = 1.0
    viewer.interaction.controls.notices.advance(float('inf'))
    robot.SetDOFValues([0, 0])
    pictures.clear()
    settle()
print('ready')
while True:
    try:
        print('=', eval(input()), '.', sep='')
    except Exception as error:
        print('=', error, '.', sep='')
"""


class Desk:
    """A window that is driven by real events, and the script behind it."""

    def __init__(self, display, folder) -> None:
        self.display, self.folder = display, folder
        (folder / "script.py").write_text(SETTLE + SCRIPT)
        self.terminal = on_terminal(folder, "-m", "ravemj", "run", "script.py", DISPLAY=display.name)
        self.terminal.expect("ready")
        self.window = display.await_window()
        await_that(lambda: self.picture().shape == (480, 640, 3), "the window has another size")

    def picture(self) -> np.ndarray:
        return self.display.picture(self.window)

    def ask(self, expression: str):
        """What the script answers."""
        self.terminal.sendline(expression)
        self.terminal.expect(r"=(.*?)\.\r?\n")
        return self.terminal.match[1]

    def value(self, expression: str):
        return ast.literal_eval(self.ask(expression))

    def rect(self, name):
        text = self.ask("[(c.name, c.lower, c.upper, c.group) for c in viewer.interaction.overlay().controls]")
        controls = tuple(
            Control(found, found, lower=lower, upper=upper, group=group)
            for found, lower, upper, group in ast.literal_eval(text)
        )
        places = ControlLayout.arrange(controls, SIZE).places
        return next(rect for control, rect in places.items() if control.name == name)

    def point(self, name, part: float = 0.5) -> tuple[str, str]:
        x, y, width, height = self.rect(name)
        return str(round(x + part * width)), str(round(y + height / 2))

    def click(self, name, part: float = 0.5) -> None:
        self.display.tool("mousemove", "--window", str(self.window), *self.point(name, part), "click", "1")

    def drag(self, name, *parts: float) -> None:
        first, *others = (self.point(name, part) for part in parts)
        self.display.tool("mousemove", "--window", str(self.window), *first, "mousedown", "1")
        for point in others:
            self.display.tool("mousemove", "--window", str(self.window), *point)
        self.display.tool("mouseup", "1")

    def await_value(self, expression: str, condition, otherwise: str) -> None:
        await_that(lambda: condition(self.value(expression)), otherwise)


@pytest.fixture(scope="module")
def process(display, tmp_path_factory):
    folder = tmp_path_factory.mktemp("desk")
    for path in TUTORIAL.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    desk = Desk(display, folder)
    yield desk
    desk.display.close(desk.window)
    desk.terminal.close(force=True)


@pytest.fixture
def desk(process) -> Desk:
    """The window as it was at first, with nothing under the pointer."""
    process.display.tool("mousemove", "--window", str(process.window), "320", "5")
    process.ask("reset()")
    return process


def test_mouse_and_keys_play_pause_step_and_go_through_the_time(desk):
    row = slice(450, 472), slice(220, 300)
    assert np.ptp(desk.picture()[row]) < 50, "there is nothing to play"
    desk.ask("play()")
    desk.await_value("viewer.playback.time", lambda time: time > 0.2, "it does not play")
    await_that(lambda: np.ptp(desk.picture()[row]) > 100, "there is nothing to stop it")
    desk.click("play")
    desk.await_value("viewer.playback.playing", lambda playing: not playing, "it does not pause")
    time = desk.value("viewer.playback.time")
    desk.click("forward")
    desk.await_value("viewer.playback.time", lambda now: now == pytest.approx(time + 1 / 30), "it does not step")
    desk.display.tool("key", "Left")
    desk.await_value("viewer.playback.time", lambda now: now == pytest.approx(time), "the arrow does not step back")
    desk.click("speed")
    desk.await_value("viewer.playback.speed", lambda speed: speed == 2, "the speed stays")
    before = desk.picture()
    desk.drag("seek", 0.1, 0.3, 0.5)
    desk.await_value("viewer.playback.time", lambda now: 40 < now < 60, "the time does not follow")
    time, values = desk.value("viewer.playback.time"), desk.value("robot.GetDOFValues().tolist()")
    np.testing.assert_allclose(values, [0.02 * time, -0.01 * time], atol=1e-9)
    await_that(lambda: np.abs(desk.picture()[100:400].astype(int) - before[100:400]).max() > 100, "it is not drawn")
    desk.display.tool("key", "space")
    desk.await_value("viewer.playback.playing", lambda playing: playing, "the space bar does not play")


@pytest.mark.stress
def test_a_paused_motion_is_not_drawn_and_a_playing_one_is(desk):
    desk.ask("play(2.0)")
    desk.await_value("viewer.playback.playing", lambda playing: not playing, "it does not end")
    assert 4 <= int(desk.ask("len(pictures)")) < 400  # a pause between two of them counts as half a second at most

    def is_still():
        drawn = desk.ask("len(pictures)")
        desk.ask("time.sleep(1)")
        return desk.ask("len(pictures)") == drawn

    await_that(is_still, "it is drawn again and again")


def test_sliders_unfold_and_turn_joints_and_numbers_are_typed(desk):
    desk.ask("settle()")
    plain = desk.picture()
    desk.click("joints")
    desk.await_value("len(viewer.interaction.overlay().controls)", lambda count: count == 15, "no sliders")
    desk.drag("dof 1", 0.5, 0.6, 0.75)
    desk.await_value("robot.GetDOFValues().tolist()", lambda q: q[0] == 0 and 1.2 < q[1] < 2.1, "the joint stays")
    desk.click("dof 0", part=1.3)
    desk.display.tool("type", "--delay", "50", "0.257")
    desk.display.tool("key", "BackSpace", "Return")
    desk.await_value("robot.GetDOFValues()[0].item()", lambda value: value == 0.25, "the number does not come in")
    desk.click("joints")
    desk.await_value("len(viewer.interaction.overlay().controls)", lambda count: count == 9, "the sliders stay")
    desk.ask("robot.SetDOFValues([0, 0])")
    desk.display.tool("mousemove", "--window", str(desk.window), "320", "5")
    await_that(lambda: np.array_equal(desk.picture(), plain), "something of them stays")


def test_a_picture_and_a_video_are_saved_and_the_window_says_where(desk):
    folder = desk.folder
    desk.ask("[viewer.SetBkgndColor([0, 0.4, 0.2]), viewer.EnvironmentSync()]")
    desk.click("picture")
    await_that(lambda: list(folder.glob("ravemj-*.png")), "no picture is saved")
    (file,) = folder.glob("ravemj-*.png")
    saved = imageio.v3.imread(file)
    clear = slice(100, 300), slice(60, 530)
    brighter = (saved[clear].astype(int) - desk.picture()[clear]).max(axis=2)
    assert (brighter > 0).mean() < 0.005, "another renderer may draw other edges, no more"
    assert (brighter < 0).mean() < 0.05, "there are shadows in it, no more"
    assert np.ptp(saved[clear]) > 100
    assert (saved[10, 10] == saved[470, 100]).all(), "there are no buttons in it"
    await_that(lambda: f"Saved {file.name} in" in desk.ask("viewer.interaction.overlay().lines"), "nothing is said")
    desk.ask("play(0.5)")
    desk.click("video")
    await_that(lambda: list(folder.glob("*.mp4")), "no video is saved")
    (file,) = folder.glob("*.mp4")
    assert imageio.v3.imread(file).shape == (16, 480, 640, 3)


def test_the_camera_is_copied_as_a_line_to_paste(desk):
    desk.click("camera")
    desk.await_value(
        "[line for line in viewer.interaction.overlay().lines if 'Copied' in line]", bool, "the window does not say it"
    )
    line = desk.ask("__import__('glfw').get_clipboard_string(None).decode()")
    assert re.fullmatch(r"viewer\.SetCamera\(\[\[.*\]\]\)", line)
    desk.ask("viewer.SetCamera(numpy.eye(4))")
    desk.ask(line)
    assert desk.value("viewer.GetCameraTransform().tolist()") == [
        [0, 0, -1, 1],
        [1, 0, 0, 0],
        [0, -1, 0, 0],
        [0, 0, 0, 1],
    ]
