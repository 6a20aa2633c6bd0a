"""What goes wrong with windows: a message or quiet recovery, and the script goes on."""

import time

import numpy as np
import pytest
from command_line import TUTORIAL, colour_at, finish, on_terminal
from conftest import one_in
from desk import SIZE, Desk
from screens import NEEDS_A_SCREEN, Started, virtual_screen
from waiting import await_that

from ravemj.gui.interaction import ViewButton, button_rects
from ravemj.gui.interaction.cube import Cube

pytestmark = NEEDS_A_SCREEN

LOSES_ITS_DISPLAY = """
import sys, time, ravemj
env = ravemj.load('env.xml')
env.SetViewer('window')
robot, viewer = env.GetRobots()[0], env.GetViewer()
viewer.EnvironmentSync()
print('ready', flush=True)
step = 0
while viewer.is_open:
    step += 1
    robot.SetDOFValues([STEP * step, 0])
    time.sleep(0.01)
viewer.SetSize(200, 100)
viewer.EnvironmentSync()
print(env.render(64, 48).std() > 1, robot.GetDOFValues()[1] == 0)
print(env.SetViewer('window'), env.GetViewer().render(64, 48).std() > 1)
"""


@pytest.mark.stress
@pytest.mark.parametrize("step", one_in(2, [0.01, 0]))
def test_a_display_that_goes_away_takes_the_window_and_not_the_script(folder, step):
    (folder / "loses.py").write_text(LOSES_ITS_DISPLAY.replace("STEP", str(step)))
    with virtual_screen() as (display, server), Started(display, folder, "loses.py") as command:
        assert command.process.stdout.readline() == "ready\n"
        display.await_window()
        time.sleep(0.5)
        server.kill()
        code, printed, complaints = command.end()
    assert (code, printed) == (0, "True True\nTrue True\n")
    assert "the connection to the display broke" in complaints


@pytest.mark.stress
def test_opengl_that_fails_closes_the_window_and_not_the_script(display, folder):
    (folder / "fails.py").write_text("""
import mujoco, time, ravemj
from ravemj.gui.viewers import window_renderer

def fail(*arguments):
    raise mujoco.FatalError('OpenGL version 1.5 or higher required')

window_renderer.GlScene = fail
env = ravemj.load('env.xml')
env.SetViewer('window')
viewer = env.GetViewer()
viewer.EnvironmentSync()
while viewer.is_open:
    time.sleep(0.01)
print(env.render(64, 48).std() > 1)
""")
    with Started(display, folder, "fails.py") as command:
        assert command.end()[:2] == (0, "True\n")
    await_that(lambda: not display.windows(), "the window stays")


def test_a_window_that_the_user_closes_leaves_the_script_running(display, folder):
    (folder / "runs.py").write_text("""
import time, ravemj
env = ravemj.load('env.xml')
env.SetViewer('window')
robot, viewer = env.GetRobots()[0], env.GetViewer()
viewer.EnvironmentSync()
print('ready')
while viewer.is_open:
    robot.SetDOFValues([time.monotonic(), 0])
    handle = env.plot3([0, 0, 1], 5)
    time.sleep(0.01)
viewer.SetCamera(viewer.GetCameraTransform())
viewer.SetSize(300, 200), viewer.Move(1, 2), viewer.Show(1), viewer.SetTitle('gone'), viewer.EnvironmentSync()
print(env.GetViewer() is viewer, viewer.render().shape, viewer.GetSelectedBody(), viewer.main(True))
viewer.quitmainloop()
env.Destroy()
print('end')
""")
    terminal = on_terminal(folder, "runs.py", DISPLAY=display.name)
    terminal.expect("ready")
    display.close(display.await_window())
    terminal.expect(r"True \(200, 300, 3\) None 0\r?\nend")
    assert finish(terminal)[1] == 0


@pytest.mark.stress
def test_the_prompt_of_ipython_stays_free_and_sees_what_the_user_drags(display, folder):
    script = (folder / "myscript.py").read_text().rpartition("    play_trajectory")[0]
    (folder / "still.py").write_text(script.replace("import openravepy", "import ravemj as openravepy"))
    terminal = on_terminal(folder, "-m", "IPython", "-i", "still.py", DISPLAY=display.name)
    terminal.expect(r"In \[1\]: ")
    window = display.await_window()
    terminal.sendline("viewer.SetSize(640, 480), viewer.Move(0, 0), robot.SetDOFValues([pi / 2, 0])")
    terminal.expect(r"In \[2\]: ")
    await_that(lambda: display.picture(window).shape == (480, 640, 3), "the window has another size")
    display.await_pose(window, "level")
    terminal.sendline("print([viewer.camera.project([[0, y, 0]], 640, 480)[0][0].tolist() for y in (0.19, 0.3)])")
    terminal.expect(r"\[\[(\S+), (\S+)\], \[(\S+), (\S+)\]\]")
    elbow, arm = np.array([float(word) for word in terminal.match.groups()]).reshape(2, 2).round().astype(int)
    place = ["mousemove", "--window", str(window)]
    display.tool(*place, *map(str, arm), "key", "Escape", "keydown", "Control_L", "click", "1", "keyup", "Control_L")

    def says(expression: str) -> str:
        terminal.sendline(f"print('=', {expression}, '.')")
        terminal.expect(r"= (.*) \.")
        return terminal.match[1]

    await_that(lambda: "Joint1" in says("viewer.GetSelectedJoint()"), "the joint is not selected")
    start, end = elbow + np.array([10, 0]), elbow + np.array([40, 30])
    display.tool(*place, *map(str, start), "mousedown", "1", *place, *map(str, end), "mouseup", "1")
    await_that(lambda: says("abs(robot.GetDOFValues()[1]) > 0.1") == "True", "it is not dragged")
    assert says("robot.GetDOFValues()[0] == pi / 2") == "True"
    terminal.sendline("play_trajectory(robot, get_swing_trajectory(robot))")  # from where the user has left it
    # The text about the joint covers the upper arm.
    await_that(lambda: colour_at(display.picture(window), (0, 0, 0.1)) == "red", "the pendulum never was upright")
    await_that(lambda: says("robot.GetDOFValues()[1] == 0") == "True", "the upper arm does not follow")
    terminal.sendline("exit()")
    assert finish(terminal)[1] == 0


@pytest.fixture(scope="module")
def process(display, tmp_path_factory):
    folder = tmp_path_factory.mktemp("desk")
    for path in TUTORIAL.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    desk = Desk(display, folder)
    yield desk
    desk.close()


def drag_begun(desk):
    """Select the robot and take hold of its cube; return where."""
    desk.escape()
    desk.click(desk.at(desk.on_link(2)))
    await_that(lambda: desk.ask("viewer.GetSelectedBody().GetName()") == "Pendulum", "the robot is not selected")
    cube = Cube.around(desk.robot.simulation_state)
    x, y = desk.at((cube.T_world_cube @ [0.3 * cube.half[0], 0.3 * cube.half[1], cube.half[2], 1])[:3])
    desk.press((x, y))
    desk.move(x + 30, y)
    desk.await_bodies()
    return x, y


@pytest.mark.stress
def test_a_body_that_is_removed_while_it_is_dragged(process):
    desk = process.show()
    x, y = drag_begun(desk)
    before = desk.array("robot.GetTransform()")
    assert desk.ask("env.Remove(robot)") == "True"
    desk.display.tool("mousemove", "--window", desk.window, str(x + 60), str(y + 20))
    await_that(lambda: desk.ask("viewer.interaction.overlay().lines") == "()", "the text stays")
    assert desk.ask("viewer.GetSelectedBody()") == "None"
    desk.display.tool("mouseup", "1")
    assert np.array_equal(desk.array("robot.GetTransform()"), before)
    assert desk.ask("[env.Add(robot), viewer.is_open]") == "[None, True]"
    desk.await_colour(desk.on_link(2), "blue")


@pytest.mark.stress
def test_an_environment_that_is_destroyed_while_the_user_drags(process):
    desk = process.show()
    drag_begun(desk)
    assert desk.ask("env.Destroy()") == "None"
    await_that(lambda: not desk.display.windows(), "the window stays")
    desk.display.tool("mouseup", "1")
    assert desk.ask("[viewer.is_open, viewer.GetSelectedBody(), viewer.EnvironmentSync()]") == "[False, None, None]"
    assert "is destroyed" in desk.ask("env.SetViewer('window')")
    assert desk.ask("exec('env = ravemj.Environment()')") == "None"


@pytest.mark.stress
def test_nonsense_is_refused_and_the_window_stays_as_it_is(process):
    desk = process.show()
    picture = desk.settled_picture()
    for call in ("SetSize(-5, 3)", "SetSize(10**9, 10**9)", "SetSize('a', 3)", "Move(10**9, 0)", "Move(None, 0)"):
        assert "(InvalidArguments)" in desk.ask(f"viewer.{call}")
    for call in ("SetCamera([1, 2])", "SetCamera(None)", "SetCamera(viewer.GetCameraTransform(), float('nan'))"):
        assert "(InvalidArguments)" in desk.ask(f"viewer.{call}")
    assert "(InvalidArguments)" in desk.ask("viewer.SetBkgndColor([7, 7, 7])")
    assert np.array_equal(desk.settled_picture(), picture)
    assert desk.ask("viewer.is_open") == "True"


@pytest.mark.stress
def test_setviewer_again_and_again_leaves_one_window(process):
    desk = process.show()
    assert desk.ask("[env.SetViewer('window') for _ in range(5)]") == str([True] * 5)
    await_that(lambda: len(desk.display.windows()) == 1, "there is not one window")
    threads = "sum(thread.name == 'ravemj window' for thread in __import__('threading').enumerate())"
    assert desk.ask(threads) == "1"


@pytest.mark.stress
def test_two_windows_on_one_environment_are_driven_apart(process):
    desk = process.show()
    before, from_above = desk.camera, np.diag([1.0, -1, -1, 1])
    from_above[2, 3] = 1
    assert desk.ask("exec('other = ravemj.RaveCreateViewer(env, \"window\")')") == "None"
    desk.ask("[other.SetName('ravemj other'), other.SetSize(640, 480), other.Move(640, 0)]")
    desk.ask(f"other.SetCamera({from_above.tolist()})")
    search = "search", "--onlyvisible", "--name", "ravemj other"
    await_that(lambda: desk.display.tool(*search), "there is no other window")
    (other,) = (int(word) for word in desk.display.tool(*search).split())
    await_that(lambda: "X=640" in desk.display.tool("getwindowgeometry", "--shell", str(other)), "it does not move")
    desk.move(320, 100)
    under_pointer = "getmouselocation", "--shell"
    await_that(lambda: f"WINDOW={desk.window}\n" in desk.display.tool(*under_pointer) + "\n", "it is in the way")
    desk.drag((320, 100), (360, 130))
    desk.await_camera()
    assert not np.allclose(desk.camera, before, atol=1e-3)
    assert np.allclose(desk.array("other.GetCameraTransform()"), from_above)
    desk.do("robot.SetDOFValues([0.4, 0.4])")
    desk.await_colour(desk.on_link(2), "blue")
    await_that(lambda: np.ptp(desk.display.picture(other)[100:400, 100:500]) > 100, "the other one shows nothing")
    assert desk.ask("env.Remove(other)") == "True"
    await_that(lambda: len(desk.display.windows()) == 1, "the other window stays")


@pytest.mark.stress
def test_small_pixels_have_large_buttons_and_letters(tmp_path):
    for path in TUTORIAL.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    with virtual_screen() as (display, _):
        display.set_resource("Xft.dpi:\t192\n")
        desk = Desk(display, tmp_path)
        try:
            desk.ask("[env.Load('env.xml'), env.SetViewer('window')]")
            desk.ask("exec('viewer, robot = env.GetViewer(), env.GetRobots()[0]')")
            desk.window = str(display.await_window())
            desk.ask("[viewer.SetSize(1280, 960), viewer.Move(0, 0), viewer.SetBkgndColor([0, 0, 0])]")
            await_that(lambda: desk.ask("viewer.interaction.view.size") == str(SIZE), "a point is not two pixels")
            await_that(lambda: desk.picture().shape == (960, 1280, 3), "the window has another size")
            arrow = button_rects(SIZE)[ViewButton.INTERACT]
            place = [str(round(2 * (start + 10))) for start in (arrow.x, arrow.y)]
            desk.display.tool("mousemove", "--window", desk.window, *place, "click", "1")
            await_that(lambda: desk.ask("viewer.interaction.mode.value") == "interaction", "the button is elsewhere")
            target = desk.array("(robot.GetLinks()[2].GetTransform() @ [0.1, 0, 0, 1])")[:3].tolist()
            x, y = desk.array(f"viewer.camera.project([{target}], 1280, 960)[0][0]")
            desk.display.tool("mousemove", "--window", desk.window, str(round(x)), str(round(y)), "click", "1")
            await_that(lambda: desk.ask("viewer.GetSelectedBody().GetName()") == "Pendulum", "the robot is elsewhere")
            rows = np.flatnonzero((desk.settled_picture()[:120, 10:400].min(axis=2) > 150).any(axis=1))
            assert rows[-1] - rows[0] > 50, "two lines of letters twice as high as usual"
        finally:
            desk.close()
