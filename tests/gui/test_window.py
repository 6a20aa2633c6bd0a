"""Windows on a virtual display: what they show, that they move, and how they close."""

import signal
import time

import numpy as np
import pytest
from command_line import (
    PRINTED_BY_THE_SCRIPT,
    colour_of,
    finish,
    on_terminal,
    ravemj_command,
)
from file_drops import drop
from screens import NEEDS_A_SCREEN, Display, Started
from waiting import await_that

pytestmark = NEEDS_A_SCREEN
PLAY = ("-m", "ravemj", "play", "env.xml", "--camera", "camera.json", "--background", "1,1,0")
BACKGROUND = (255, 255, 0)


def test_play_opens_a_window_moves_and_stays_until_it_is_closed(display, folder):
    rests = [(0, 0), (1.5, 0), (1.7, np.pi / 2), (3.2, np.pi / 2), (3.4, np.pi)]
    (folder / "rests.csv").write_text("time,Joint0\n" + "\n".join(f"{time},{angle}" for time, angle in rests))
    with Started(display, folder, *PLAY, "--trajectory", "rests.csv") as command:
        window = display.await_window()
        first = display.await_pose(window, "hanging")
        assert np.abs(np.median(first[:20, :20], axis=(0, 1)) - BACKGROUND).max() <= 1
        display.await_pose(window, "level")
        display.await_pose(window, "upright")
        await_that(lambda: is_still(display, window), "it does not come to rest")
        assert command.runs
        display.await_pose(window, "upright")
        display.close(window)
        assert command.end() == (0, "", "")
    assert not list(folder.glob("*.mp4"))


def is_still(display: Display, window: int) -> bool:
    """Whether the picture stays for half a second; on a busy machine the last pictures of a motion may be late."""
    picture = display.picture(window)
    time.sleep(0.5)
    return np.array_equal(display.picture(window), picture)


@pytest.mark.stress
def test_play_ends_by_ctrl_c_and_by_closing_while_it_moves(display, folder):
    with Started(display, folder, *PLAY, "--duration", "6000") as command:
        display.await_pose(display.await_window(), "hanging")
        command.process.send_signal(signal.SIGINT)
        assert command.end() == (130, "", "ravemj: interrupted\n")
    await_that(lambda: not display.windows(), "the window stays")
    with Started(display, folder, *PLAY, "--duration", "60") as command:
        display.close(display.await_window())
        assert command.end() == (0, "", "")
    await_that(lambda: not display.windows(), "the window stays")


@pytest.mark.stress
def test_a_window_that_grows_has_no_black_bands_before_it_is_drawn(display, folder):
    with Started(display, folder, *PLAY, "--duration", "6000") as command:
        window = display.await_window()
        display.await_pose(window, "hanging")
        command.process.send_signal(signal.SIGSTOP)
        display.tool("windowsize", str(window), "1100", "850")
        await_that(lambda: display.picture(window).shape == (850, 1100, 3), "it does not grow")
        grown = display.picture(window)
        assert np.abs(grown[:, 970:].astype(int) - BACKGROUND).max() <= 1
        assert np.abs(grown[730:].astype(int) - BACKGROUND).max() <= 1
        command.process.send_signal(signal.SIGCONT)
        display.await_pose(window, "hanging")


@pytest.mark.stress
def test_points_are_as_wide_while_pictures_are_coarse_as_when_they_are_crisp(display, folder):
    (folder / "coarse.py").write_text("""
import ravemj
from ravemj.gui.viewers import sharpness
sharpness.Sharpness.level_while_moving = lambda self, now: sharpness.LEVELS[-1]
sharpness.Sharpness.is_due = lambda self, now: False
env = ravemj.Environment()
env.SetViewer('window')
viewer = env.GetViewer()
viewer.SetSize(320, 240)
viewer.SetCamera([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
point = env.plot3([0, 0, 0], 40, [1, 0, 0])
viewer.wait()
""")
    with Started(display, folder, "-m", "ravemj", "run", "coarse.py"):
        window = display.await_window()
        await_that(lambda: display.picture(window)[120, 160].tolist() == [255, 0, 0], "the point does not come")
        await_that(lambda: display.picture(window).shape == (240, 320, 3), "it is not resized")
        red = (display.picture(window)[:, :200] < [256, 128, 128]).all(axis=2)
        assert abs(red.any(axis=0).sum() - 40) <= 6
        assert abs(red.any(axis=1).sum() - 40) <= 6


def test_files_that_are_dropped_on_a_window_are_added_or_the_window_says_why_not(display, folder):
    (folder / "bad file.xml").write_text("<Environment>\n<KinBody></Body>")
    script = folder / "waits.py"
    script.write_text("""
import ravemj
env = ravemj.load('env.xml')
env.SetViewer('window')
print('ready', flush=True)
while input():
    print(len(env.GetBodies()), env.GetViewer().interaction.overlay().lines, flush=True)
""")
    terminal = on_terminal(folder, "waits.py", DISPLAY=display.name)
    terminal.expect("ready")
    window = display.await_window()
    for files, answer in (
        (["env.xml"], r"2 \('Added env.xml'"),
        (["bad file.xml"], r"2 \(.*bad file.xml:2"),
        (["env.xml", "double-pendulum.xml"], "4 "),
    ):
        drop(display, window, [folder / file for file in files])

        def is_answered(answer=answer) -> bool:
            terminal.sendline("?")
            return terminal.expect([answer, r"[0-9] \("]) == 0

        await_that(is_answered, f"it does not answer {answer}")
    terminal.close(force=True)


@pytest.mark.stress
def test_play_with_an_output_opens_no_window(display, folder):
    words = ("play", "env.xml", "-o", "frames", "--size", "96x72", "--fps", "2")
    seen = []
    with Started(display, folder, "-m", "ravemj", *words) as command:
        while command.runs:
            seen += display.windows()
        assert command.end()[0] == 0
    assert not seen
    assert len(list((folder / "frames").iterdir())) == 3


@pytest.mark.stress
def test_the_tutorials_script_shows_a_window_and_finishes(display, folder):
    colours = set()
    for _ in range(4):  # the window is there for a second, which a busy machine may miss
        with Started(display, folder, "-m", "ravemj", "run", "myscript.py") as command:
            colours |= colours_while_it_runs(display, command)
            assert command.end() == (0, PRINTED_BY_THE_SCRIPT, "")
        if {"red", "blue"} <= colours:
            await_that(lambda: not display.windows(), "the window stays")
            return
    pytest.fail(f"only {colours} was seen")


def colours_while_it_runs(display: Display, command: Started) -> set[str]:
    """Return the colours that are seen in the window of a command, until its end."""
    colours: set[str] = set()
    while command.runs:
        try:
            picture = display.picture(display.windows()[0])
        except (IndexError, KeyError, ValueError):  # there is none yet, or no more
            continue
        colours |= {colour_of(pixel) for pixel in np.unique(picture.reshape(-1, 3)[::7], axis=0)}
    return colours


@pytest.mark.stress
def test_the_prompt_and_the_window_do_not_wait_for_each_other(display, folder):
    (folder / "still.py").write_text((folder / "myscript.py").read_text().rpartition("    play_trajectory")[0])
    terminal = on_terminal(folder, "-m", "ravemj", "run", "-i", "still.py", DISPLAY=display.name)
    terminal.expect(r"In \[1\]: ")
    window = display.await_window()
    for number, (values, name) in enumerate([("0, 0", "hanging"), ("pi, 0", "upright"), ("pi/2, 0", "level")], 1):
        terminal.sendline(f"robot.SetDOFValues([{values}])")
        terminal.expect(rf"In \[{number + 1}\]: ")
        display.await_pose(window, name)
    display.close(window)
    await_that(lambda: not display.windows(), "the window stays")
    terminal.sendline("viewer.is_open, robot.SetDOFValues([0, 0]), env.SetViewer('qtcoin')")
    terminal.expect(r"\(False, None, True\)")
    display.await_window()
    terminal.sendline("exit()")
    assert finish(terminal)[1] == 0
    await_that(lambda: not display.windows(), "the window stays")


@pytest.mark.stress
def test_a_window_shows_what_a_script_publishes_while_it_has_the_environment(display, folder):
    (folder / "publishes.py").write_text("""
import json, math
import openravepy
env = openravepy.Environment()
env.Load('env.xml')
env.SetViewer('qtcoin')
viewer, robot = env.GetViewer(), env.GetRobots()[0]
camera = json.load(open('camera.json'))
viewer.SetCamera(camera)
input()
with env:
    while not env.simulation.published.is_wanted:
        pass
    robot.SetDOFValues([math.pi / 2, 0])
    env.UpdatePublishedBodies()
    robot.SetDOFValues([math.pi, 0])  # nobody publishes this
    input()
    robot.SetDOFValues([0, 0])
input()
""")
    terminal = on_terminal(folder, "-m", "ravemj", "run", "publishes.py", DISPLAY=display.name)
    window = display.await_window()
    for name in ("hanging", "level", "hanging"):
        display.await_pose(window, name)
        terminal.sendline("")
    assert finish(terminal)[1] == 0


@pytest.mark.stress
def test_viewers_replace_each_other_and_two_environments_have_two_windows(display, folder):
    (folder / "two.py").write_text("""
import time, openravepy
envs = [openravepy.Environment(), openravepy.Environment()]
for env in envs:
    env.Load('env.xml')
    env.SetViewer('qtcoin')
first = envs[0].GetViewer()
envs[0].SetViewer('qtosg')
print(first.is_open, [env.GetViewer().is_open for env in envs], first is envs[0].GetViewer())
for step in range(50):
    for env in envs:
        env.GetRobots()[0].SetDOFValues([step / 25, 0])
    time.sleep(0.01)
for env in envs:  # beside its window, each draws pictures
    print(env.render(64, 48).std() > 1, env.GetViewer().render(64, 48).std() > 1)
input()
envs[0].SetViewer('')
input()
envs[1].Destroy()
input()
""")
    terminal = on_terminal(folder, "-m", "ravemj", "run", "two.py", DISPLAY=display.name)
    terminal.expect(r"False \[True, True\] False\r?\nTrue True\r?\nTrue True")
    for count in (2, 1, 0):
        await_that(lambda count=count: len(display.windows()) == count, f"there are not {count} windows")
        terminal.sendline("")
    assert finish(terminal)[1] == 0


@pytest.mark.stress
def test_a_window_closes_with_its_forgotten_environment(display, folder):
    (folder / "forgets.py").write_text("""
import gc, openravepy

def show():
    env = openravepy.Environment()
    env.Load('env.xml')
    env.SetViewer('qtcoin')
    env.GetRobots()[0].GetController().SetDesired([0.1, 0.1])
    input()

show()
while input() == 'gc':
    gc.collect()
""")
    terminal = on_terminal(folder, "-m", "ravemj", "run", "forgets.py", DISPLAY=display.name)
    await_that(lambda: len(display.windows()) == 1, "there is no window")
    terminal.sendline("")

    def is_gone():
        terminal.sendline("gc")
        return not display.windows()

    await_that(is_gone, "the window stays")
    terminal.sendline("end")
    assert finish(terminal)[1] == 0


@pytest.mark.stress
def test_a_script_that_fails_or_exits_shows_its_own_end(display, folder):
    start = "import openravepy, sys\nenv = openravepy.Environment()\nenv.Load('env.xml')\nenv.SetViewer('qtcoin')\n"
    for end, code, message in (("sys.exit(3)", 3, ""), ("raise ValueError('mine')", 1, "ValueError: mine\n")):
        (folder / "ends.py").write_text(start + end)
        done = ravemj_command(folder, "run", "ends.py", DISPLAY=display.name)
        assert (done.returncode, done.stdout) == (code, "")
        assert done.stderr.endswith(message)
        assert "ravemj/" not in done.stderr


@pytest.mark.stress
def test_a_display_that_is_not_there_is_said_and_the_script_goes_on(folder):
    done = ravemj_command(folder, "run", "myscript.py", DISPLAY=":9999")
    assert (done.returncode, done.stdout) == (0, PRINTED_BY_THE_SCRIPT)
    (line,) = done.stderr.splitlines()
    assert line.startswith("ravemj: no window can be opened")


def test_drawings_and_viewer_calls_reach_the_window(display, folder):
    (folder / "draws.py").write_text("""
import threading, time, openravepy
env = openravepy.Environment()
env.SetViewer('qtcoin')
viewer = env.GetViewer()
viewer.SetCamera([[0, 0, 1, -3], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
viewer.SetSize(320, 240)
viewer.Move(30, 40)
viewer.SetTitle('ravemj draws')
viewer.SetBkgndColor([1, 1, 1])
pictures, turns = [], []
kept = [viewer.RegisterViewerImageCallback(pictures.append),
        viewer.RegisterViewerThreadCallback(lambda: turns.append(threading.current_thread().name))]
handle = env.plot3([0, 0, 0], 40, [1, 0, 0])
while not (pictures and pictures[-1].shape == (240, 320, 3) and pictures[-1][120, 160, 1] == 0):
    viewer.EnvironmentSync()
print(set(turns), pictures[-1].shape, pictures[-1][120, 160])
input()
handle.SetTransform([1, 0, 0, 0, 0, 0.5, 0])
input()
del handle
input()
viewer.Show(0)
input()
viewer.Show(1)
input()
threading.Timer(0.5, viewer.quitmainloop).start()
print('main', viewer.main(True), viewer.is_open)
""")
    red, white = [255, 0, 0], [255, 255, 255]
    terminal = on_terminal(folder, "-m", "ravemj", "run", "draws.py", DISPLAY=display.name)
    terminal.expect(r"{'ravemj window'} \(240, 320, 3\) \[255\s+0\s+0\]")
    window = display.await_window()
    await_that(lambda: display.picture(window).shape == (240, 320, 3), "it has another size")
    await_that(lambda: "X=30" in display.tool("getwindowgeometry", "--shell", str(window)), "it does not move")
    await_that(lambda: "ravemj draws" in display.tool("getwindowname", str(window)), "it has another title")
    await_that(lambda: display.picture(window)[120, 160].tolist() == red, "the point does not come")
    terminal.sendline("")
    await_that(lambda: display.picture(window)[120, 160].tolist() == white, "the point does not move")
    await_that(
        lambda: abs((display.picture(window) == red).all(axis=2).sum() - 1600) <= 160,  # at rest; softer before
        "the point is not 40 pixels wide",
    )
    terminal.sendline("")
    await_that(lambda: display.picture(window).min() == 255, "the point stays")
    terminal.sendline("")
    await_that(lambda: not display.windows(), "the window does not hide")
    terminal.sendline("")
    display.await_window()
    terminal.sendline("")
    terminal.expect("main 0 False")
    assert finish(terminal)[1] == 0
