"""Each row of the summary of controls, with real mouse and keys: the window does what the core does, and shows it."""

import math

import numpy as np
import pytest
from command_line import TUTORIAL, colour_of
from conftest import one_in
from desk import ASLANT, DISTANCE, SIZE, Desk
from screens import NEEDS_A_SCREEN
from test_interaction import SLIDING
from waiting import await_that

from ravemj.gui.interaction import Button, Key, Resize, ViewButton, button_rects
from ravemj.gui.interaction.cube import Cube
from ravemj.gui.interaction.joint_handle import SIZES, JointHandle
from ravemj.gui.interaction.shortcuts import KEYS

pytestmark = NEEDS_A_SCREEN
ARMS = (1, "red"), (2, "blue")
HELD = """
box = ravemj.RaveCreateKinBody(env, '')
box.InitFromBoxes(__import__('numpy').array([[0, 0, 0, 0.03, 0.03, 0.03]]))
box.SetName('held')
box.GetLinks()[0].GetGeometries()[0].SetDiffuseColor([0, 1, 0])
env.Add(box)
box.SetTransform([1, 0, 0, 0, 0, 0, -0.42])
robot.Grab(box, robot.GetLinks()[2])
"""


@pytest.fixture(scope="module")
def process(display, tmp_path_factory):
    folder = tmp_path_factory.mktemp("desk")
    for path in TUTORIAL.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    (folder / "sliding.xml").write_text(SLIDING)
    desk = Desk(display, folder)
    yield desk
    desk.close()


@pytest.fixture
def desk(process) -> Desk:
    return process.show()


def await_arms(desk):
    """Wait until both arms are seen where they should be; what is under the pointer has other colours."""
    desk.move(5, 240)
    for link, colour in ARMS:
        desk.await_colour(desk.on_link(link), colour)


# --- camera mode


def is_turned(before, after):
    """The focus stays where it is, as far from the camera as before."""
    focus = (before @ [0, 0, DISTANCE, 1])[:3]
    np.testing.assert_allclose((after @ [0, 0, DISTANCE, 1])[:3], focus, atol=1e-5)
    assert np.trace(before[:3, :3].T @ after[:3, :3]) < 2.95


def is_turned_about_image_right(before, after):
    is_turned(before, after)
    np.testing.assert_allclose(before[:3, 0], after[:3, 0], atol=1e-5)


def is_turned_about_image_down(before, after):
    is_turned(before, after)
    np.testing.assert_allclose(before[:3, 1], after[:3, 1], atol=1e-5)


def is_shifted(before, after):
    way = before[:3, :3].T @ (after - before)[:3, 3]
    np.testing.assert_allclose(before[:3, :3], after[:3, :3], atol=1e-5)
    assert np.linalg.norm(way[:2]) > 0.02
    assert abs(way[2]) < 1e-5


def is_nearer(before, after, sign=1):
    way = before[:3, :3].T @ (after - before)[:3, 3]
    np.testing.assert_allclose(before[:3, :3], after[:3, :3], atol=1e-5)
    np.testing.assert_allclose(way[:2], 0, atol=1e-5)
    assert sign * way[2] > 0.05


def is_farther(before, after):
    is_nearer(before, after, -1)


def left_and_middle(desk):
    desk.press((300, 100))
    desk.press((300, 100), Button.MIDDLE)
    desk.move(300, 140)
    desk.release((300, 140), Button.MIDDLE)
    desk.release((300, 140))


def on_wheel(tool, right, down):
    def drag(desk):
        rect = button_rects(SIZE)[tool]
        start = rect.x + 6, rect.y + 6
        desk.drag(start, (start[0] + right, start[1] + down))

    return drag


CAMERA_ROWS = {
    "left drag rotates": (lambda desk: desk.drag((320, 100), (350, 120), (400, 130)), is_turned),
    "RotX rotates": (on_wheel(ViewButton.ROT_X, 40, 50), is_turned_about_image_right),
    "RotY rotates": (on_wheel(ViewButton.ROT_Y, 50, 40), is_turned_about_image_down),
    "Shift + left translates": (lambda desk: desk.drag((320, 100), (340, 90), (370, 80), keys=["shift"]), is_shifted),
    "middle translates": (lambda desk: desk.drag((320, 100), (300, 90), button=Button.MIDDLE), is_shifted),
    "wheel zooms in": (lambda desk: desk.wheel(3), is_nearer),
    "wheel zooms out": (lambda desk: desk.wheel(-3), is_farther),
    "left + middle zooms": (left_and_middle, is_nearer),
    "Dolly zooms": (on_wheel(ViewButton.DOLLY, 20, 40), is_nearer),
}


@pytest.mark.parametrize("row", one_in(6, list(CAMERA_ROWS)))
def test_camera_mode(desk, row):
    gesture, judge = CAMERA_ROWS[row]
    await_arms(desk)
    places = [np.array(desk.at(desk.on_link(link))) for link, _ in ARMS]
    before = desk.camera
    gesture(desk)
    desk.await_camera()
    judge(before, desk.camera)
    await_arms(desk)
    moved = [np.linalg.norm(desk.at(desk.on_link(link)) - place) for (link, _), place in zip(ARMS, places, strict=True)]
    assert max(moved) > 10, "the picture would be the same"
    assert not desk.array("robot.GetDOFValues()").any()
    assert desk.ask("viewer.GetSelectedBody()") == "None"


def test_s_and_left_click_centre_and_later_turns_are_about_the_point(desk):
    target = desk.on_link(2)
    assert desk.at(target) != (320, 240)
    desk.click(desk.at(target), keys=["s"])
    T_world_camera = desk.await_camera()
    np.testing.assert_allclose(
        T_world_camera[:3, 2] @ (target - T_world_camera[:3, 3]), desk.core.view.distance, atol=0.02
    )
    desk.await_colour(desk.core.view.focus, "blue")
    for stop in ((420, 300), (250, 330)):
        desk.drag((320, 100), stop)
        desk.await_camera()
        assert np.hypot(*np.subtract(desk.at(desk.core.view.focus), (320, 240))) < 2
        await_that(lambda: colour_of(desk.picture()[238:243, 318:323]) == "blue", "the arm is not in the middle")


@pytest.mark.stress
def test_the_first_view_is_from_above(desk):
    desk.ask("[env.SetViewer('window'), exec('viewer = env.GetViewer()'), viewer.SetSize(640, 480), viewer.Move(0, 0)]")
    camera = desk.camera
    np.testing.assert_array_equal(camera[:3, :3], np.diag([1, -1, -1]))
    assert camera[2, 3] > 0.1
    desk.window = str(desk.display.await_window())
    await_that(lambda: desk.picture().shape == (480, 640, 3), "the window has another size")
    seen = desk.settled_picture()[100:400, 100:500].astype(int)  # apart from buttons and wheels
    rows, columns = np.nonzero(np.ptp(seen, axis=2) > 60)
    assert np.hypot(rows.mean() - 140, columns.mean() - 220) < 10, "the pendulum, which hangs, is in the middle"


@pytest.mark.stress
def test_what_the_camera_was_gives_the_same_picture_in_another_session(desk):
    desk.drag((320, 100), (350, 120), (400, 130))
    desk.await_camera()
    desk.move(5, 240)
    saved, picture = desk.camera, desk.settled_picture()
    desk.show(camera=saved)
    np.testing.assert_array_equal(desk.camera, saved)
    assert np.array_equal(desk.settled_picture(), picture)


# --- modes


def chosen(desk) -> str:
    """The mode by the brighter one of the two buttons."""
    rects = button_rects(SIZE)
    picture = desk.picture()
    bright = [
        tool.value
        for tool in (ViewButton.CAMERA, ViewButton.INTERACT)
        if picture[int(rects[tool].y) + 2, int(rects[tool].x) + 2].min() > 200
    ]
    return " and ".join(bright)


def test_escape_and_the_two_buttons_switch_modes(desk):
    desk.ask("viewer.SetBkgndColor([0.2, 0.2, 0.2])")
    rects = button_rects(SIZE)
    centres = {tool: (rect.x + rect.width / 2, rect.y + rect.height / 2) for tool, rect in rects.items()}
    assert centres[ViewButton.INTERACT][1] < centres[ViewButton.CAMERA][1], "the arrow is above the camera"

    def await_mode(tool):
        await_that(lambda: chosen(desk) == tool.value, f"the {tool.value} button is not lit")
        assert desk.ask("viewer.interaction.mode.value") == tool.value.split()[0].lower()

    await_mode(ViewButton.CAMERA)
    arrow = button_rects(SIZE)[ViewButton.INTERACT]
    inside = desk.picture()[int(arrow.y) : int(arrow.y + arrow.height), int(arrow.x) : int(arrow.x + arrow.width)]
    assert ((inside[..., 0] > 150) & (inside[..., 1] < 90)).sum() > 100, "the arrow is red"
    for _ in range(2):
        desk.escape()
        await_mode(ViewButton.INTERACT)
        desk.escape()
        await_mode(ViewButton.CAMERA)
    for tool in (ViewButton.INTERACT, ViewButton.INTERACT, ViewButton.CAMERA):
        desk.click(centres[tool])
        await_mode(tool)
    assert np.allclose(desk.camera, ASLANT, atol=1e-6)


# --- interaction mode


def cube_is_seen(desk) -> bool:
    """Whether the nearest corner of the cube around the robot is green."""
    cube = Cube.around(desk.robot.simulation_state)
    corners = [(cube.T_world_cube @ [*(cube.half * (2 * np.array(signs) - 1)), 1])[:3] for signs in np.ndindex(2, 2, 2)]
    eye = desk.core.view.camera.position
    x, y = desk.at(min(corners, key=lambda corner: np.linalg.norm(corner - eye)))
    around = desk.picture()[y - 3 : y + 4, x - 3 : x + 4].astype(int)
    return bool((around[..., 1] - np.maximum(around[..., 0], around[..., 2]) > 60).any())


def select_robot(desk):
    desk.escape()
    desk.click(desk.at(desk.on_link(2)))
    await_that(lambda: desk.ask("viewer.GetSelectedBody().GetName()") == "Pendulum", "the robot is not selected")
    await_that(lambda: cube_is_seen(desk), "the cube is not seen")


def test_left_click_selects_and_a_second_one_hides_the_cube(desk):
    assert not cube_is_seen(desk)
    select_robot(desk)
    assert desk.lines[1] == "Robot Pendulum"
    assert desk.ask("viewer.GetSelectedLink().GetName()") == "Arm1"
    assert desk.ask("viewer.GetSelectedJoint()") == "None"
    desk.click(desk.at(desk.on_link(1)))
    await_that(lambda: desk.ask("viewer.GetSelectedBody()") == "None", "it stays selected")
    await_that(lambda: not cube_is_seen(desk), "the cube stays")
    await_arms(desk)
    desk.click(desk.at(desk.on_link(1)))
    await_that(lambda: cube_is_seen(desk), "the cube does not come back")
    desk.click((40, 100))
    await_that(lambda: not cube_is_seen(desk), "a click on nothing does not end it")


def test_dragging_a_face_translates(desk):
    select_robot(desk)
    cube = Cube.around(desk.robot.simulation_state)
    held = (cube.T_world_cube @ [0.3 * cube.half[0], 0.3 * cube.half[1], cube.half[2], 1])[:3]
    before, old = desk.robot.GetTransform(), desk.on_link(2)
    x, y = desk.at(held)
    desk.press((x, y))
    for stop in ((x + 30, y), (x + 60, y + 20)):  # it follows while the button is held
        desk.move(*stop)
        desk.await_bodies()
    desk.release((x + 60, y + 20))
    desk.await_bodies()
    after = desk.array("robot.GetTransform()")
    np.testing.assert_allclose(after[:3, :3], before[:3, :3], atol=1e-9)
    way = cube.T_world_cube[:3, :3].T @ (after - before)[:3, 3]
    assert np.linalg.norm(way[:2]) > 0.03
    assert abs(way[2]) < 1e-9, "in the two directions of the face"
    await_arms(desk)
    assert desk.colour(old) != "blue"
    assert cube_is_seen(desk)
    assert not desk.array("robot.GetDOFValues()").any()


@pytest.mark.parametrize("edge", one_in(3, [(0.2, 1, 1), (1, 0.2, 1), (1, 1, 0.2)]))
def test_dragging_an_edge_rotates_about_its_axis_through_the_centre(desk, edge):
    select_robot(desk)
    cube = Cube.around(desk.robot.simulation_state)
    axis = edge.index(0.2)
    signs = np.sign(cube.T_world_cube[:3, :3].T @ (desk.core.view.camera.position - cube.T_world_cube[:3, 3]))
    held = (cube.T_world_cube @ [*(cube.half * signs * edge), 1])[:3]
    x, y = desk.at(held)
    before = desk.robot.GetTransform()
    desk.drag((x, y), (x + 20, y + 10), (x + 35, y + 25))
    desk.await_bodies()
    motion = desk.array("robot.GetTransform()") @ np.linalg.inv(before)
    centre, direction = cube.T_world_cube[:3, 3], cube.T_world_cube[:3, axis]
    np.testing.assert_allclose((motion @ [*centre, 1])[:3], centre, atol=1e-6)
    np.testing.assert_allclose(motion[:3, :3] @ direction, direction, atol=1e-6)
    assert np.trace(motion[:3, :3]) < 2.98, "it does turn"
    await_arms(desk)


def is_orange(pixels) -> np.ndarray:
    red, green, blue = np.moveaxis(pixels.astype(int), -1, 0)
    return (red > green + 25) & (green > blue + 25)


def orange_pixels(desk) -> int:
    return int(is_orange(desk.picture()[90:440, 60:580]).sum())


def select_joint(desk, link=2, name="Joint1"):
    desk.escape()
    desk.click(desk.at(desk.on_link(link, (0.15, 0, 0))), keys=["ctrl"])
    await_that(lambda: desk.ask("viewer.GetSelectedJoint().GetName()") == name, "the joint is not selected")


def test_ctrl_and_left_click_select_the_parent_joint(desk):
    assert orange_pixels(desk) == 0
    select_joint(desk)
    await_that(lambda: orange_pixels(desk) > 100, "the cylinder is not seen")
    handle = JointHandle.at(desk.robot.simulation_state, 1)
    np.testing.assert_allclose(desk.array("robot.GetJoints()[1].GetAnchor()"), handle.center, atol=1e-9)
    rows, columns = np.nonzero(is_orange(desk.picture()[90:440, 60:580]))
    assert np.hypot(*(np.array(desk.at(handle.center)) - (columns.mean() + 60, rows.mean() + 90))) < 6
    assert desk.lines[1:] == ("Robot Pendulum", "Joint Joint1, DOF 1: 0.000 rad, 0.0 deg")
    assert desk.ask("viewer.GetSelectedLink().GetName()") == "Arm1"
    desk.click(desk.at(desk.on_link(1, (0.05, 0, 0))), keys=["ctrl"])
    await_that(lambda: desk.ask("viewer.GetSelectedJoint().GetName()") == "Joint0", "the other joint is not selected")


def test_dragging_the_cylinder_turns_the_joint_and_the_text_is_live(desk):
    select_joint(desk)
    handle = JointHandle.at(desk.robot.simulation_state, 1)
    grip = handle.hit(desk.core.view.ray(*desk.at(handle.center + 0.02 * handle.T_world_handle[:3, 1])))
    x, y = desk.at(grip)
    desk.press((x, y))
    texts, seen = [], []
    for stop in ((x + 15, y + 5), (x + 20, y + 30)):
        desk.move(*stop)
        desk.await_bodies()
        value = desk.robot.GetDOFValues()[1]
        assert desk.lines[-1] == f"Joint Joint1, DOF 1: {value:.3f} rad, {math.degrees(value):.1f} deg"
        texts.append(desk.lines[-1])
        seen.append(desk.settled_picture()[50:75, 5:300])
    desk.release((x + 20, y + 30))
    assert texts[0] != texts[1]
    assert not np.array_equal(*seen), "the text does not change while it is dragged"
    assert abs(desk.array("robot.GetDOFValues()")[1]) > 0.2
    assert desk.array("robot.GetDOFValues()")[0] == 0
    desk.await_colour(desk.on_link(2, (0.17, 0, 0)), "blue")


@pytest.mark.stress
def test_ctrl_and_left_click_on_the_cylinder_change_its_size(desk):
    select_joint(desk)
    await_that(lambda: orange_pixels(desk) > 100, "the cylinder is not seen")
    areas = [orange_pixels(desk)]
    for size in SIZES[1:]:
        desk.click(desk.at(JointHandle.at(desk.robot.simulation_state, 1).center), keys=["ctrl"])
        await_that(lambda size=size: desk.ask("viewer.interaction.selection.size") == str(SIZES.index(size)), "no size")
        desk.settled_picture()
        areas.append(orange_pixels(desk))
    assert areas[1] > 1.5 * areas[0]
    assert areas[2] > 1.5 * areas[1]
    assert areas[3] < areas[0]


@pytest.mark.stress
def test_limits_hold_followers_follow_and_sliders_are_in_metres(process):
    desk = process.show("sliding.xml", [[0.0, 0, -1, 1.2], [1, 0, 0, 0.1], [0, -1, 0, 0.2], [0, 0, 0, 1]])
    desk.escape()
    desk.click(desk.at([0.05, 0.2, 0]), keys=["ctrl"])
    await_that(lambda: desk.ask("viewer.GetSelectedJoint().GetName()") == "Slide", "the slider is not selected")
    handle = JointHandle.at(desk.robot.simulation_state, 0)
    held = handle.hit(desk.core.view.ray(*desk.at(handle.center)))
    desk.press(desk.at(held))
    for way, expected in ((0.1, 0.1), (0.3, 0.25), (0.2, 0.2), (-0.3, -0.05)):
        desk.move(*desk.at(held + np.array([0, way, 0])))
        desk.await_bodies()
        assert desk.array("robot.GetDOFValues()")[0] == pytest.approx(expected, abs=2e-3)
        follower = desk.array("robot.GetLink('Follower').GetTransform()")
        assert follower[2, 3] == pytest.approx(0.3 + 2 * expected, abs=4e-3)
    assert desk.lines[-1] == "Joint Slide, DOF 0: -0.050 m"
    desk.release(desk.at(held))


@pytest.mark.stress
def test_what_is_held_follows_the_joint(desk):
    desk.do(HELD)
    box = desk.env.GetKinBody("held")
    desk.await_colour(box.GetTransform()[:3, 3], "green")
    select_joint(desk)
    T_link_box = np.linalg.inv(desk.robot.GetLinks()[2].GetTransform()) @ box.GetTransform()
    handle = JointHandle.at(desk.robot.simulation_state, 1)
    grip = handle.hit(desk.core.view.ray(*desk.at(handle.center + 0.02 * handle.T_world_handle[:3, 1])))
    x, y = desk.at(grip)
    desk.drag((x, y), (x + 10, y + 5), (x + 15, y + 20))
    desk.await_bodies()
    assert abs(desk.robot.GetDOFValues()[1]) > 0.1
    there = desk.array("robot.GetLinks()[2].GetTransform()"), desk.array("env.GetKinBody('held').GetTransform()")
    np.testing.assert_allclose(there[1], there[0] @ T_link_box, atol=1e-6)
    desk.await_colour(box.GetTransform()[:3, 3], "green")


# --- text


@pytest.mark.parametrize(
    "background", one_in(5, [[0, 0, 0], [0.5, 0.5, 0.5], [1, 0.9, 0.2], [1, 1, 1], [0.8, 0.85, 0.9]])
)
def test_hovering_tells_the_link_readably_on_any_background(desk, background):
    desk.ask(f"viewer.SetBkgndColor({background})")
    corner = slice(8, 24), slice(5, 300)
    plain = 255 * np.array(background)
    await_that(lambda: np.abs(desk.picture()[corner] - plain).max() <= 1, "the background is another one")
    for link, name in ((1, "Arm0"), (2, "Arm1")):
        point = desk.on_link(link)
        desk.move(*desk.at(point))
        await_that(lambda name=name: desk.lines[:1] and desk.lines[0].startswith(f"{name}: (x, y, z) = ("), "no text")
        assert desk.lines == desk.core.overlay().lines
        assert len(desk.lines) == 1, "nothing is selected"
    await_that(lambda: contrast(desk.picture()[corner]) > 4.5, "the text cannot be read")
    desk.move(5, 240)
    await_that(lambda: np.abs(desk.picture()[corner] - plain).max() <= 1, "the text stays")


def contrast(pixels) -> float:
    """The ratio of luminances between letters and what is behind them, as web pages are judged by: 4.5 is enough."""
    linear = (pixels / 255.0) ** 2.2 @ [0.2126, 0.7152, 0.0722]
    return (linear.max() + 0.05) / (np.median(linear) + 0.05)


# --- nothing else


@pytest.mark.stress
def test_other_keys_and_buttons_do_nothing(desk):
    camera, picture = desk.camera, desk.settled_picture()
    keys = [*sorted({*"abcdefghijklmnopqrtuvwxyz0123456789"} - KEYS.keys()), "F5", "F11", "Tab", "Return", "Delete"]
    keys += [
        "BackSpace",
        "space",
        "Up",
        "Down",
        "Left",
        "Right",
        "Prior",
        "Next",
        "plus",
        "minus",
        "ctrl+z",
        "ctrl+s",
        "ctrl+q",
    ]
    for _ in range(2):
        desk.move(320, 100)
        desk.display.tool("key", "--delay", "2", *keys)
        desk.click((320, 100), button=Button.RIGHT)
        desk.drag((320, 100), (350, 130), button=Button.RIGHT)
        assert np.array_equal(desk.camera, camera)
        assert desk.ask("viewer.GetSelectedBody()") == "None"
        assert not desk.array("robot.GetDOFValues()").any()
        desk.escape()
    await_that(lambda: desk.ask("viewer.interaction.mode.value") == "camera", "keys change the mode")
    desk.escape()
    desk.wheel(3)
    for how in ({"keys": ["shift"]}, {"button": Button.MIDDLE}, {"button": Button.RIGHT}, {}):
        desk.drag((320, 100), (350, 130), **how)
    desk.drag(desk.at(desk.on_link(2)), (400, 400))  # a drag is no click
    assert np.array_equal(desk.camera, camera)
    assert desk.ask("viewer.GetSelectedBody()") == "None"
    desk.escape()
    desk.move(5, 240)
    await_that(lambda: np.array_equal(desk.settled_picture(), picture), "the picture has changed")


@pytest.mark.stress
def test_a_drag_goes_on_beyond_the_window(desk):
    desk.press((320, 100))
    desk.move(SIZE[0] + 150, 100)
    desk.release((SIZE[0] + 150, 100))
    desk.await_camera()
    desk.move(320, 240)
    desk.move(300, 200)
    assert np.allclose(desk.camera, desk.core.view.camera.T_world_camera, atol=1e-6), "the button was let go"


# --- the window itself


@pytest.mark.stress
def test_nothing_is_drawn_while_nothing_changes_and_little_is_computed(desk):
    def turns(statement: str) -> tuple[int, float]:
        """Let the window turn often, with something done for each turn; return new pictures and the time computed."""
        desk.ask("[times.clear(), pictures.clear()]")
        while int(desk.ask("len(times)")) <= 30:
            desk.ask(statement)
        first, last = (float(desk.ask(f"repr(times[{index}])").strip("'")) for index in (0, 30))
        return int(desk.ask("len(pictures)")), last - first

    count = "handle = viewer.RegisterViewerThreadCallback(lambda: times.append(time.thread_time()))"
    desk.ask(f"exec('import time; times = []; {count}', globals())")
    _, moving = turns("robot.SetDOFValues([len(times), 0])")
    desk.ask("viewer.EnvironmentSync()")
    await_that(lambda: turns("time.sleep(0.1)")[0] == 0, "it is drawn again and again")
    _, still = turns("time.sleep(0.1)")
    assert still < moving / 2
    desk.ask("robot.GetLinks()[2].GetGeometries()[0].SetDiffuseColor([0, 1, 0])")
    await_that(lambda: desk.ask("len(pictures)") != "0", "a new colour is not drawn")


@pytest.mark.stress
def test_it_turns_and_draws_at_most_as_often_as_a_screen_shows(desk):
    for name, statements in {
        "turns": "turns = []; handle = viewer.RegisterViewerThreadCallback(lambda: turns.append(1)); time.sleep(1)",
        "pictures": "pictures.clear(); [(robot.SetDOFValues([i / 500, 0]), time.sleep(0.002)) for i in range(300)]",
    }.items():
        desk.ask(f"exec({'import time; begin = time.monotonic(); ' + statements!r}, globals())")
        rate = float(desk.ask(f"repr(len({name}) / (time.monotonic() - begin))").strip("'"))
        assert 0 < rate < 66, name


@pytest.mark.stress
def test_the_user_s_size_is_the_view_s(desk):
    for size in ((800, 500), (400, 300)):
        desk.display.tool("windowsize", desk.window, *map(str, size))
        await_that(lambda size=size: desk.picture().shape == (size[1], size[0], 3), "the size does not come")
        await_that(lambda size=size: desk.ask("viewer.interaction.view.size") == str(size), "the view does not know")
        desk.core.handle(Resize(*size))
        desk.move(*desk.at(desk.on_link(2)))
        await_that(lambda: desk.lines[:1] and desk.lines[0].startswith("Arm1: "), "the pointer is elsewhere")
        assert desk.ask("viewer.render().shape") == str((size[1], size[0], 3))


@pytest.mark.stress
def test_joints_are_turned_by_the_script_while_they_are_selected(desk):
    select_joint(desk)
    desk.do("robot.SetDOFValues([0.5, -1])")
    await_that(lambda: desk.lines[-1] == "Joint Joint1, DOF 1: -1.000 rad, -57.3 deg", "the text is old")
    desk.await_colour(desk.on_link(2, (0.18, 0, 0)), "blue")


@pytest.mark.stress
def test_the_view_moves_while_the_script_holds_the_environment_and_says_so(desk):
    plain, camera = desk.settled_picture(), desk.camera
    assert desk.ask("env.__enter__() is env") == "True"
    desk.drag((320, 400), (420, 400))
    await_that(lambda: not np.allclose(desk.camera, camera), "the camera stays")
    await_that(lambda: not np.array_equal(desk.picture()[100:], plain[100:]), "the picture stays")
    await_that(lambda: desk.picture()[:40, :200].mean() < 200, "nothing is said")
    desk.display.tool("key", "1")
    assert desk.ask("env.__exit__(None, None, None)") == "None"
    desk.core.handle(Key("1"))
    desk.await_camera()
    await_that(lambda: "ocked" not in desk.ask("viewer.interaction.overlay().lines"), "it is said for ever")


def test_the_help_and_the_floor_are_seen(desk):
    plain = desk.settled_picture()
    desk.display.tool("key", "g")
    await_that(lambda: not np.array_equal(desk.picture(), plain), "there is no floor")
    desk.display.tool("key", "g")
    desk.display.tool("key", "h")
    await_that(lambda: desk.picture()[240:260].mean() < 120, "there is no help")
    desk.display.tool("key", "F1")
    await_that(lambda: np.array_equal(desk.picture(), plain), "it stays")


@pytest.mark.stress
def test_a_viewer_closes_while_the_script_holds_the_environment(desk):
    desk.ask("[env.Lock(), viewer.EnvironmentSync(), env.SetViewer(''), env.Unlock()][2]")
    await_that(lambda: not desk.display.windows(), "the window stays")


@pytest.mark.stress
def test_turning_numbers_stay_finite_while_the_window_is_tiny(desk):
    desk.ask("viewer.SetSize(1, 1)")
    desk.ask("viewer.EnvironmentSync()")
    desk.ask("viewer.SetSize(640, 480)")
    await_that(lambda: desk.picture().shape == (480, 640, 3), "the size does not come back")
    assert math.isfinite(desk.camera.sum())
