"""A script that moves a robot 100 times a second, a user who drags, and others who look: whole states, and no hang."""

import math
import time

import numpy as np
import pytest
from command_line import finish, on_terminal
from desk import ASLANT, DISTANCE, SIZE
from screens import NEEDS_A_SCREEN
from waiting import await_that

import ravemj
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import Viewpoint
from ravemj.gui.interaction.cube import Cube

pytestmark = NEEDS_A_SCREEN

BOX = """
box = ravemj.RaveCreateKinBody(env, '')
box.InitFromBoxes([[0, 0, 0, 0.05, 0.05, 0.05]])
box.SetName('box')
env.Add(box)
box.SetTransform([1, 0, 0, 0, 0.2, -0.05, 0.05])
"""
SCRIPT = """
import threading, time
import numpy as np
import ravemj
from ravemj.gui.interaction import Key
env = ravemj.load('env.xml')
robot = env.GetRobots()[0]
BOX
def turn(T_one, T_other):
    rotation = T_one[:3, :3].T @ T_other[:3, :3]
    return np.arctan2(rotation[1, 0], rotation[0, 0])

torn, looks, pictures, ending = [], [0], [0], threading.Event()

def look():
    while not ending.is_set():
        first, second = robot.GetDOFValues()
        base, upper, lower = robot.GetLinkTransformations()
        with env:
            pose, T_links = robot.GetDOFValues(), robot.GetLinkTransformations()
            together = abs(turn(T_links[0], T_links[1]) - pose[0]) < 1e-9
        whole = abs(turn(upper, lower) + 2 * turn(base, upper)) < 1e-9
        if not (abs(second + 2 * first) < 1e-12 and whole and together):
            torn.append([first, second])
        looks[0] += 1
        time.sleep(0.005)

def draw():
    while not ending.is_set():
        pictures[0] += other.render(160, 120).std() > 1
        time.sleep(0.2)

def wait():
    input()
    while np.linalg.norm(box.GetTransform()[:3, 3] - [0.2, -0.05, 0.05]) < 0.005:  # until the user's moves have come
        time.sleep(0.01)
    ending.set()

env.SetViewer('window')
viewer, other = env.GetViewer(), ravemj.RaveCreateViewer(env, 'offscreen')
viewer.SetSize(*SIZE)
viewer.Move(0, 0)
viewer.SetCamera(CAMERA, DISTANCE)
viewer.interaction.handle(Key('escape'))
viewer.EnvironmentSync()
workers = [threading.Thread(target=work) for work in (look, draw)]
for worker in workers:
    worker.start()
threading.Thread(target=wait).start()
turns, steps = [], 0
counting = viewer.RegisterViewerThreadCallback(lambda: turns.append(1))
print('ready', flush=True)
while not ending.is_set():
    angle = np.sin(time.monotonic())
    robot.SetDOFValues([angle, -2 * angle])
    steps += 1
    time.sleep(0.01)
print('=', steps, len(turns))
for worker in workers:
    worker.join()
print('=', torn[:3], looks[0] > 0, pictures[0] > 0)
print('=', box.GetTransform().tolist())
env.Destroy()
"""


@pytest.mark.stress
@pytest.mark.parametrize("moves", [50, pytest.param(1000, marks=pytest.mark.stress)])
def test_a_script_a_user_and_another_viewer_at_once(display, folder, moves):
    values = {"BOX": BOX, "SIZE": repr(SIZE), "CAMERA": repr(ASLANT.tolist()), "DISTANCE": repr(DISTANCE)}
    text = SCRIPT
    for name, value in values.items():
        text = text.replace(name, value)
    (folder / "moves.py").write_text(text)
    terminal = on_terminal(folder, "moves.py", DISPLAY=display.name)
    terminal.expect("ready")
    window = display.await_window()
    await_that(lambda: display.picture(window).shape == (SIZE[1], SIZE[0], 3), "the window has another size")
    drag_about(display, window, moves)
    terminal.sendline("")
    terminal.expect(r"= (\d+) (\d+)\r?\n")
    steps, turns = map(int, terminal.match.groups())
    assert steps > turns, "the script has too little time beside its viewers"
    terminal.expect(r"= (\[.*?\]) (\w+) (\w+)\r?\n")
    assert terminal.match.groups() == ("[]", "True", "True")
    terminal.expect(r"= (\[\[.*?\]\])")
    moved = np.array(eval(terminal.match[1]))
    np.testing.assert_allclose(moved[:3, :3], np.eye(3), atol=1e-9)
    assert finish(terminal)[1] == 0


def drag_about(display, window, moves) -> None:
    """Select the box and drag it about."""
    env = ravemj.Environment()
    exec(BOX, {"env": env, "ravemj": ravemj})
    box = env.GetKinBody("box")
    view = Viewpoint(Camera(ASLANT), DISTANCE, SIZE)
    place = ["mousemove", "--window", str(window)]

    def at(point):
        ((x, y),), _ = view.camera.project([point], *SIZE)
        return round(x), round(y)

    display.tool(*place, *map(str, at(box.GetTransform()[:3, 3])), "click", "1")
    cube = Cube.around(box.simulation_state)
    x, y = at((cube.T_world_cube @ [cube.half[0], 0, 0, 1])[:3])  # the middle of a face
    display.tool(*place, str(x), str(y), "mousedown", "1")
    for count in range(moves):
        angle = 0.1 * count
        display.tool(*place, str(round(x + 30 * math.sin(angle))), str(round(y + 20 * math.sin(angle))))
        time.sleep(0.02)
    display.tool(*place, str(x + 25), str(y + 15), "mouseup", "1")
