"""The page of the viewer in a real browser, with its mouse, keys and fingers.

The server draws; but in tests of ``BOTH`` the page does, with WebGL, and the server only with ``-m stress``.
"""

import contextlib
import math
import re
import signal
import socket

import numpy as np
import pytest
from browsers import ASLANT, CLEAR, NEEDS_A_BROWSER, SIZE, Desk, assert_apart
from command_line import Served, colour_of
from conftest import MODELS, REPOSITORY, one_in
from waiting import await_that

import ravemj
from ravemj.gui.interaction import Button, Move, Press, Release, Use, ViewButton
from ravemj.gui.interaction.cube import Cube
from ravemj.gui.interaction.joint_handle import JointHandle
from ravemj.gui.interaction.shortcuts import TOUCH_GESTURES

pytestmark = NEEDS_A_BROWSER
BOTH = pytest.mark.parametrize("desk", one_in(2, ["webgl_browser", "browser"]), indirect=True)
SLIDING = """<Robot name="Sliding"><KinBody>
<Body name="Base"><Geom type="box"><extents>0.05 0.05 0.05</extents></Geom></Body>
<Body name="Block"><Translation>0 0.2 0</Translation>
  <Geom type="box"><extents>0.05 0.05 0.05</extents><diffuseColor>0 1 0</diffuseColor></Geom></Body>
<Joint name="Slide" type="slider"><Body>Base</Body><Body>Block</Body><axis>0 1 0</axis>
  <limits>-0.05 0.15</limits></Joint>
</KinBody></Robot>"""


def pendulum() -> ravemj.Environment:
    return ravemj.load(MODELS / "env.xml")


def sliding() -> ravemj.Environment:
    env = ravemj.Environment()
    env.LoadData(SLIDING)
    return env


@pytest.fixture(scope="module")
def desks(browser, webgl_browser):
    """The desk of each browser, made for the first test that wants it."""
    desks = {}

    def desk_of(name):
        if name not in desks:
            desks[name] = Desk({"browser": browser, "webgl_browser": webgl_browser}[name], pendulum)
        return desks[name]

    yield desk_of
    for desk in desks.values():
        desk.close()


@pytest.fixture
def desk(desks, request):
    """The pendulum as it was loaded, in camera mode, with nothing selected."""
    desk = desks(getattr(request, "param", "browser"))
    desk.reset()
    yield desk
    assert desk.troubles == []


@pytest.fixture(params=[(pendulum, {})], ids=[""])
def own_desk(browser, request):
    """A desk that a test may break, or with another environment or another browser."""
    load, context = request.param
    desk = Desk(browser, load, **context)
    yield desk
    desk.close()
    assert desk.troubles == []


def is_colour(desk, point, name) -> bool:
    x, y = desk.at(point)
    return colour_of(desk.picture()[y - 1 : y + 2, x - 1 : x + 2]) == name


class TestCameraMode:
    @BOTH
    def test_left_drag_turns_the_view(self, desk):
        before = desk.core.view.camera.T_world_camera
        desk.drag((320, 100), (350, 120), (400, 130))
        assert not np.allclose(before, desk.core.view.camera.T_world_camera)
        desk.await_camera()
        assert is_colour(desk, desk.point(1, 0.1, 0, 0), "red")
        assert is_colour(desk, desk.point(2, 0.15, 0, 0), "blue")

    @pytest.mark.stress
    def test_shift_and_middle_drags_shift_the_view(self, desk):
        for how in ({"keys": ["Shift"]}, {"button": Button.MIDDLE}):
            before = desk.core.view.camera
            desk.drag((320, 100), (330, 110), (350, 120), **how)
            assert np.allclose(before.rotation, desk.core.view.camera.rotation)
            assert np.linalg.norm(before.position - desk.core.view.camera.position) > 0.02
            desk.await_camera()
            assert is_colour(desk, desk.point(2, 0.15, 0, 0), "blue")

    @BOTH
    def test_the_wheel_zooms(self, desk):
        for steps in (1, -2, 3):
            desk.wheel(steps)
            desk.await_camera()
        assert desk.core.view.distance == pytest.approx(0.8 * 0.9**2)

    @pytest.mark.stress
    def test_left_and_middle_together_zoom(self, desk):
        desk.press((300, 100))
        desk.press((300, 100), Button.MIDDLE)
        desk.move(300, 140)
        desk.release((300, 140), Button.MIDDLE)
        desk.release((300, 140))
        assert desk.core.view.distance == pytest.approx(0.8 * math.exp(-4 * 40 / 480))
        desk.await_camera()

    @pytest.mark.stress
    def test_s_and_a_click_centre_on_the_surface_and_later_turns_are_about_it(self, desk):
        target = desk.point(2, 0.1, 0, 0)
        desk.click(desk.at(target), keys=["s"])
        assert np.linalg.norm(desk.core.view.focus - target) < 0.03
        desk.await_camera()
        focus = desk.core.view.focus
        desk.drag((300, 100), (380, 140))
        desk.await_camera()
        assert np.allclose(desk.core.view.focus, focus)
        assert colour_of(desk.picture()[238:243, 318:323]) == "blue"

    def test_wheels_on_the_page_turn_and_zoom(self, desk):
        for tool, amount in ((ViewButton.ROT_X, 40), (ViewButton.ROT_Y, -50), (ViewButton.DOLLY, 30)):
            desk.roll(tool, amount)
            desk.await_camera()

    @pytest.mark.stress
    def test_clicks_and_other_keys_do_nothing(self, desk):
        desk.click(desk.at(desk.point(2, 0.15, 0, 0)))
        desk.drag((300, 100), (340, 120), button=Button.RIGHT)
        for key in ("a", "Enter", "F2", "Delete", "Space", "Home", "r"):
            desk.page.keyboard.press(key)
        desk.page.mouse.move(300, 100)
        desk.await_picture()
        assert np.allclose(desk.viewer.GetCameraTransform(), ASLANT, atol=1e-3)
        assert desk.viewer.GetSelectedBody() is None


@pytest.mark.stress
def test_the_help_of_a_phone_begins_with_what_fingers_do(own_desk):
    def titles(page):
        page.keyboard.press("h")
        page.locator("#help").wait_for(state="visible")
        return page.locator("#help h2").all_inner_texts()

    def opened(**context):
        page = own_desk.context.browser.new_context(**context).new_page()
        page.goto(own_desk.viewer.url)
        page.wait_for_selector("[data-crisp]")
        return page

    with_mouse = opened()
    assert titles(with_mouse)[-1] == "Touch screen"
    with_mouse.close()
    phone = opened(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    assert titles(phone)[0] == "Touch screen"
    first = phone.locator("#help section").first.inner_text()
    for gesture in TOUCH_GESTURES:
        assert gesture.to in first
        assert gesture.do in first
        assert f"| {gesture.to} | {gesture.do} |" in (REPOSITORY / "docs" / "viewer.md").read_text(encoding="utf-8")
    phone.close()


@pytest.mark.stress
def test_long_names_break_behind_what_separates_their_words(own_desk):
    name = "left_gripper/finger.tipLink-0"
    own_desk.page.evaluate("name => { showName(document.getElementById('toast'), name); }", name)
    toast = own_desk.page.locator("#toast")
    assert toast.text_content() == name
    assert toast.inner_html().split("<wbr>") == ["left_", "gripper/", "finger.", "tip", "Link-", "0"]


class TestInteractionMode:
    def test_escape_and_the_buttons_switch_modes(self, desk):
        def is_in(mode):
            pressed = {
                name: desk.page.get_by_role("button", name=name).get_attribute("aria-pressed")
                for name in ("Interaction mode", "Camera mode")
            }
            return pressed == {"Interaction mode": str(not mode).lower(), "Camera mode": str(mode).lower()}

        assert is_in(True)
        desk.page.keyboard.press("Escape")
        await_that(lambda: is_in(False), "no interaction mode")
        desk.page.keyboard.press("Escape")
        await_that(lambda: is_in(True), "no camera mode")
        desk.page.get_by_role("button", name="Interaction mode").click()
        await_that(lambda: is_in(False), "no interaction mode")
        desk.page.keyboard.press("Escape")
        await_that(lambda: is_in(True), "no camera mode, with the focus on a button")
        desk.page.get_by_role("button", name="Interaction mode").click()
        desk.page.get_by_role("button", name="Camera mode").click()
        await_that(lambda: is_in(True), "no camera mode")

    def test_a_click_selects_and_a_second_one_hides_the_cube(self, desk):
        desk.escape()
        arm = desk.at(desk.point(2, 0.15, 0, 0))
        for again in (arm, (300, 100)):  # on the object, and on nothing
            desk.click(arm)
            await_that(lambda: desk.viewer.GetSelectedBody() == desk.robot, "no cube")
            cube = Cube.around(desk.robot.simulation_state)
            x, y = desk.at((cube.T_world_cube @ [*cube.half, 1])[:3])
            around = slice(y - 3, y + 4), slice(x - 3, x + 4)
            await_that(lambda around=around: np.ptp(desk.picture()[around], axis=2).max() > 60, "the cube is not seen")
            desk.await_picture()
            desk.click(again)
            await_that(lambda: desk.viewer.GetSelectedBody() is None, "the cube stays")
            await_that(
                lambda around=around: np.ptp(desk.picture()[around], axis=2).max() < 10, "the cube is still seen"
            )

    @BOTH
    def test_dragging_a_face_moves_the_body(self, desk):
        desk.escape()
        desk.click(desk.at(desk.point(2, 0.15, 0, 0)))
        cube = Cube.around(desk.other_robot.simulation_state)
        start = desk.at((cube.T_world_cube @ [0.3 * cube.half[0], 0.3 * cube.half[1], cube.half[2], 1])[:3])
        desk.drag(start, (start[0] + 30, start[1]), (start[0] + 50, start[1] + 20))
        way = (desk.other_robot.GetTransform() - np.linalg.inv(cube.T_world_cube))[:3, 3]
        assert np.linalg.norm(way) > 0.01
        assert np.allclose(desk.other_robot.GetTransform()[:3, :3], cube.T_world_cube[:3, :3])
        desk.await_robot()
        assert desk.viewer.GetSelectedBody() == desk.robot

    def test_dragging_an_edge_turns_the_body(self, desk):
        desk.escape()
        desk.click(desk.at(desk.point(2, 0.15, 0, 0)))
        cube = Cube.around(desk.other_robot.simulation_state)
        start = desk.at((cube.T_world_cube @ [0.1 * cube.half[0], cube.half[1], cube.half[2], 1])[:3])
        desk.drag(start, (start[0] - 20, start[1] + 10), (start[0] - 40, start[1] + 15))
        turned = desk.other_robot.GetTransform()[:3, :3]
        assert not np.allclose(turned, cube.T_world_cube[:3, :3], atol=0.05)
        assert np.allclose(turned[:, 0], cube.T_world_cube[:3, 0]), "it turns about the direction of the edge"
        desk.await_robot()

    @BOTH
    def test_ctrl_and_a_click_select_the_joint_which_its_cylinder_turns(self, desk):
        desk.escape()
        desk.click(desk.at(desk.point(2, 0.15, 0, 0)), keys=["Control"])
        await_that(lambda: desk.viewer.GetSelectedJoint() == desk.robot.GetJoints()[1], "no joint")
        assert desk.viewer.GetSelectedLink().GetName() == "Arm1"
        handle = JointHandle.at(desk.other_robot.simulation_state, 1)
        grip = handle.hit(desk.core.view.ray(*desk.at(handle.center + 0.02 * handle.T_world_handle[:3, 1])))
        start = desk.at(grip)
        desk.press(start)
        desk.move(start[0] + 15, start[1] + 5)
        values = []
        for y in (15, 30):
            desk.move(start[0] + 20, start[1] + y)
            value = desk.other_robot.GetDOFValues()[1]
            values.append(f"Joint Joint1, DOF 1: {value:.3f} rad, {math.degrees(value):.1f} deg")
            await_that(lambda: desk.lines[1:] == ["Robot Pendulum", values[-1]], f"{desk.lines}, not {values[-1]}")
        desk.release((start[0] + 20, start[1] + 30))
        assert values[0] != values[1]
        desk.await_robot()
        assert abs(desk.robot.GetDOFValues()[1]) > 0.2
        assert is_colour(desk, desk.point(2, 0.18, 0, 0), "blue")

    @pytest.mark.stress
    def test_ctrl_and_a_click_on_the_cylinder_change_its_size(self, desk):
        desk.escape()
        desk.click(desk.at(desk.point(2, 0.15, 0, 0)), keys=["Control"])
        areas = []
        for size in range(3):
            await_that(lambda size=size: getattr(desk.viewer.interaction.selection, "size", -1) == size, "another size")
            desk.await_picture()
            picture = desk.picture()[CLEAR]
            areas.append(int(((picture[..., 0] > picture[..., 2] + 60) & (picture[..., 1] > 40)).sum()))
            desk.click(desk.at(JointHandle.at(desk.robot.simulation_state, 1).center), keys=["Control"])
        assert areas[0] < areas[1] < areas[2]

    @pytest.mark.stress
    @pytest.mark.parametrize("own_desk", [(sliding, {})], indirect=True)
    def test_a_slider_is_slid_up_to_its_limit(self, own_desk):
        own_desk.escape()
        own_desk.click(own_desk.at([0.05, 0.2, 0]), keys=["Control"])
        await_that(lambda: own_desk.lines[1:] == ["Robot Sliding", "Joint Slide, DOF 0: 0.000 m"], f"{own_desk.lines}")
        handle = JointHandle.at(own_desk.other_robot.simulation_state, 0)
        grip = handle.hit(own_desk.core.view.ray(*own_desk.at(handle.center)))
        for way, expected in ((0.05, 0.05), (0.2, 0.15)):
            own_desk.drag(
                own_desk.at(grip),
                own_desk.at(grip + np.array([0, way / 2, 0])),
                own_desk.at(grip + np.array([0, way, 0])),
            )
            own_desk.await_robot()
            assert own_desk.robot.GetDOFValues()[0] == pytest.approx(expected, abs=0.01)
            grip = grip + np.array([0, own_desk.robot.GetDOFValues()[0], 0])
        assert is_colour(own_desk, own_desk.point(1, 0.05, 0, 0), "green")

    @BOTH
    def test_a_joint_set_by_the_script_is_seen_at_once(self, desk):
        desk.robot.SetDOFValues([0.5, -1])
        tip = desk.point(2, 0.18, 0, 0)
        await_that(lambda: is_colour(desk, tip, "blue"), "the page does not show it")
        desk.await_picture()


class TestText:
    def test_it_is_about_what_is_under_the_pointer(self, desk):
        x, y = desk.at(desk.point(1, 0.1, 0, 0))
        desk.page.mouse.move(x, y)
        await_that(lambda: desk.lines[0].startswith("Arm0: (x, y, z) = ("), "no name")
        numbers = np.array([float(word) for word in re.findall(r"-?\d+\.\d+", desk.lines[0])])
        np.testing.assert_allclose(desk.at(numbers[:3]), [x, y], atol=2)
        assert np.linalg.norm(numbers[:3] - desk.point(1, 0.1, 0, 0)) < 0.02
        assert np.linalg.norm(numbers[3:]) == pytest.approx(1, abs=2e-3)
        desk.page.mouse.move(300, 100)
        await_that(lambda: not desk.page.is_visible("#text"), "the text stays")
        desk.page.mouse.move(x, y)
        await_that(lambda: desk.page.is_visible("#text"), "no text")
        desk.page.get_by_role("slider", name="Dolly").hover()
        await_that(lambda: not desk.page.is_visible("#text"), "the pointer is on a wheel")

    @pytest.mark.parametrize("grey", [0.0, 0.5, 1.0])
    def test_it_can_be_read_on_every_background(self, desk, grey):
        desk.viewer.SetBkgndColor([grey] * 3)
        desk.page.mouse.move(*desk.at(desk.point(1, 0.1, 0, 0)))
        await_that(lambda: desk.page.is_visible("#text"), "no text")
        await_that(lambda: abs(desk.picture()[470, 320] - 255 * grey).max() < 2, "another background")
        box = desk.page.locator("#text").bounding_box()
        x, y, width, height = (int(box[name]) for name in ("x", "y", "width", "height"))
        shades = desk.picture()[y + 4 : y + height - 4, x + 8 : x + width - 8].mean(axis=2)
        paper, ink = np.median(shades), shades.max()
        assert (luminance(ink) + 0.05) / (luminance(paper) + 0.05) > 7, "WCAG's contrast for everybody"


def luminance(shade: float) -> float:
    return (shade / 255 / 12.92) if shade < 10.3 else ((shade / 255 + 0.055) / 1.055) ** 2.4


class TestKeyboard:
    def test_everything_can_be_reached_and_is_named(self, desk):
        desk.page.evaluate("view.focus()")
        assert [self.tab(desk, "Tab") for _ in range(5)] == [
            ("Interaction mode", "button"),
            ("Camera mode", "button"),
            ("RotX", "slider"),
            ("RotY", "slider"),
            ("Dolly", "slider"),
        ]
        assert [self.tab(desk, "Shift+Tab") for _ in range(5)][-1] == ("3D view", "application")

    def tab(self, desk, key):
        """Go to another element and return its name and role."""
        desk.page.keyboard.press(key)
        name, role, outline, shadow = desk.page.evaluate(
            "(element => [element.ariaLabel, element.role ?? 'button', getComputedStyle(element).outlineStyle,"
            "getComputedStyle(element).boxShadow])(document.activeElement)"
        )
        assert outline != "none" or "inset" in shadow, f"the focus on {name} is not seen"
        return re.split("[:.]", name)[0], role

    def test_enter_presses_buttons_and_arrows_turn_wheels(self, own_desk):
        own_desk.page.get_by_role("button", name="Interaction mode").focus()
        own_desk.page.keyboard.press("Enter")
        await_that(lambda: own_desk.page.get_attribute("body", "data-mode") == "interaction", "Enter does nothing")
        for tool, key, amount in (
            (ViewButton.ROT_X, "ArrowUp", -10),
            (ViewButton.ROT_X, "ArrowLeft", 10),
            (ViewButton.ROT_X, "PageUp", -60),
            (ViewButton.ROT_Y, "ArrowRight", 10),
            (ViewButton.DOLLY, "ArrowDown", 10),
        ):
            own_desk.page.get_by_role("slider", name=tool.value).focus()
            own_desk.page.keyboard.press(key)
            own_desk.core.handle(Use(tool, amount))
            own_desk.await_camera()
        angle = own_desk.page.get_by_role("slider", name="RotX")
        assert angle.get_attribute("aria-valuetext") == "23 degrees"
        assert own_desk.page.get_by_role("slider", name="Dolly").get_attribute("aria-valuetext") == "10 nearer"


class TestTouch:
    def press(self, at, **more):
        return Press(*at, touch=True, **more)

    @BOTH
    def test_one_finger_turns_the_view(self, desk):
        desk.touch([(320, 100)], [(350, 120)], [(400, 130)])
        desk.touched(self.press((320, 100)), Move(350, 120), Move(400, 130), Release(400, 130))
        desk.await_camera()

    @BOTH
    def test_two_fingers_shift_and_zoom(self, desk):
        moments = [(300, 200), (360, 200)], [(300, 220), (360, 220)], [(280, 220), (380, 230)]
        desk.touch([(300, 200)], *moments)
        desk.pinched(*moments)
        after = desk.core.view
        assert after.distance < 0.55
        await_that(  # browsers join what fingers do at almost the same time
            lambda: np.allclose(desk.viewer.GetCameraTransform(), after.camera.T_world_camera, atol=0.02),
            "two fingers do something else",
        )
        assert desk.viewer.GetCameraDistanceToFocus() == pytest.approx(after.distance, rel=0.02)

    @BOTH
    def test_a_tap_selects_and_a_finger_drags_the_cube(self, desk):
        arm = desk.at(desk.point(2, 0.15, 0, 0))
        desk.touch([arm])
        desk.touched(self.press(arm), Release(*arm))
        await_that(lambda: desk.viewer.GetSelectedBody() == desk.robot, "no cube")
        await_that(lambda: desk.page.get_attribute("body", "data-mode") == "interaction", "another mode")
        cube = Cube.around(desk.other_robot.simulation_state)
        start = desk.at((cube.T_world_cube @ [0.3 * cube.half[0], 0.3 * cube.half[1], cube.half[2], 1])[:3])
        end = start[0] + 40, start[1] + 20
        desk.touch([start], [(start[0] + 20, start[1])], [end])
        desk.touched(self.press(start), Move(start[0] + 20, start[1]), Move(*end), Release(*end))
        assert desk.other_robot.GetTransform()[0, 3] != 0
        desk.await_robot()
        desk.touch([(560, 60)], [(520, 90)])  # beside it the view turns
        desk.touched(self.press((560, 60)), Move(520, 90), Release(520, 90))
        desk.await_camera()

    def test_a_long_press_selects_the_joint(self, desk):
        arm = desk.at(desk.point(2, 0.15, 0, 0))
        session = desk.context.new_cdp_session(desk.page)
        finger = [{"x": arm[0], "y": arm[1], "id": 0}]
        session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": finger})
        await_that(lambda: desk.viewer.GetSelectedJoint() == desk.robot.GetJoints()[1], "no joint")
        session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        desk.page.wait_for_timeout(200)
        assert desk.viewer.GetSelectedJoint() == desk.robot.GetJoints()[1]


class TestPage:
    def test_nothing_comes_from_elsewhere_and_webgl_is_not_needed(self, desk):
        asked = []
        desk.context.on("request", lambda request: asked.append(request.url))
        page = desk.open_page()
        assert asked
        assert all(url.startswith((desk.viewer.url, "data:")) for url in asked), asked
        assert page.evaluate("document.createElement('canvas').getContext('webgl')") is None
        assert [frame.url for frame in page.frames] == [desk.viewer.url]

    def test_nothing_is_sent_while_nothing_changes(self, desk):
        desk.page.wait_for_selector("[data-crisp=true]")
        frames = []
        desk.context.on(
            "page",
            lambda page: page.on(
                "websocket", lambda socket: socket.on("framereceived", lambda frame: frames.append(len(frame)))
            ),
        )
        page = desk.open_page()
        page.wait_for_selector("[data-crisp=true]")

        def is_still():
            count = len(frames)
            page.wait_for_timeout(700)
            return len(frames) == count

        await_that(is_still, "it is sent again and again")
        count = len(frames)
        assert 2 <= count <= 10  # text and picture, once while it moves and once crisp; more often on slow machines
        desk.robot.SetDOFValues([0.5, 0])
        await_that(lambda: (page.wait_for_timeout(20), len(frames) > count)[1], "nothing was sent")

    @pytest.mark.stress
    @pytest.mark.parametrize(
        "own_desk",
        one_in(2, [(pendulum, {"device_scale_factor": 1.5}), (pendulum, {"device_scale_factor": 2})]),
        indirect=True,
    )
    def test_pictures_have_the_pixels_of_the_screen_and_follow_its_size(self, own_desk):
        ratio = own_desk.page.evaluate("devicePixelRatio")
        for size in (SIZE, (500, 420)):
            own_desk.page.set_viewport_size({"width": size[0], "height": size[1]})
            pixels = [round(ratio * length) for length in size]
            await_that(
                lambda pixels=pixels: own_desk.page.evaluate("[view.width, view.height]") == pixels,
                "the canvas has other pixels",
            )
            expected = own_desk.viewer.render(*pixels, shadows=False)
            rows = slice(pixels[1] // 2 - 50, pixels[1] // 2 + 50), slice(pixels[0] // 2 - 80, pixels[0] // 2 + 80)
            await_that(
                lambda rows=rows, expected=expected: np.abs(own_desk.picture()[rows] - expected[rows]).max() <= 1,
                "the picture is not sharp",
            )

    @pytest.mark.parametrize("size", [(320, 568), (390, 844), (844, 390)])
    def test_phones_show_everything(self, desk, size):
        desk.page.set_viewport_size({"width": size[0], "height": size[1]})
        desk.viewer.SetCamera(desk.viewer.GetCameraTransform() - [[0, 0, 0, 0.3], [0] * 4, [0] * 4, [0] * 4])
        desk.page.mouse.move(size[0] / 2, size[1] / 2)
        assert_apart(desk.page, "button, .wheel, #text", 5)

    @pytest.mark.stress
    def test_tabs_have_their_own_cameras_and_keep_them_when_they_are_loaded_again(self, desk):
        other = desk.open_page()
        desk.page.bring_to_front()
        desk.drag((320, 100), (400, 130))
        desk.await_camera()
        desk.page.reload()
        desk.await_picture()
        turned, desk.core = desk.core, desk.fresh_core()
        assert not np.allclose(turned.view.camera.position, desk.core.view.camera.position, atol=0.1)
        other.bring_to_front()
        desk.await_picture(other)
        desk.viewer.SetCamera([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0]])
        desk.core.look_from(desk.viewer.camera)
        desk.await_picture(other)
        desk.page.bring_to_front()
        desk.await_picture()

    @pytest.mark.stress
    def test_a_picture_that_is_decoded_late_does_not_cover_a_newer_one(self, desk):
        page = desk.context.new_page()
        page.add_init_script(
            """
            const decode = createImageBitmap;
            window.isLate = false;
            window.createImageBitmap = async (blob) => {
              const wait = window.isLate ? 1000 : 0;
              window.isLate = false;
              const picture = await decode(blob);
              await new Promise((done) => setTimeout(done, wait));
              return picture;
            };
            """
        )
        page.goto(desk.viewer.url)
        page.wait_for_selector("[data-crisp=true]")
        desk.await_picture(page)
        page.evaluate("window.isLate = true")
        desk.robot.SetDOFValues([0.5, 0.5])
        page.wait_for_timeout(1500)
        desk.await_picture(page)

    def test_the_title_is_the_viewers(self, desk):
        desk.viewer.SetTitle("My robot")
        await_that(lambda: desk.page.title() == "My robot", "another title")


class TestTrouble:
    @pytest.mark.stress
    def test_a_page_comes_back_after_its_connection_is_lost(self, own_desk):
        own_desk.escape()
        own_desk.drag((320, 100), (400, 130))
        own_desk.escape()
        own_desk.drag((320, 100), (400, 130))
        own_desk.await_camera()
        own_desk.escape()
        await_that(lambda: own_desk.page.get_attribute("body", "data-mode") == "interaction", "another mode")
        own_desk.page.evaluate(
            "() => { const say = reconnecting.say.bind(reconnecting);"
            "window.said = []; reconnecting.say = (...words) => { said.push(words[0]); say(...words); }; }"
        )
        for connection in list(own_desk.viewer._clients):
            connection.socket.shutdown(2)
        await_that(lambda: "reconnecting" in own_desk.page.evaluate("said.join()"), "nothing is said")
        own_desk.robot.SetDOFValues([0.4, 0.4])
        await_that(lambda: own_desk.page.inner_text("#notice") == "", "it does not come back")
        own_desk.await_picture()
        assert own_desk.page.get_attribute("body", "data-mode") == "interaction"
        own_desk.click(own_desk.at(own_desk.point(2, 0.15, 0, 0)))
        await_that(lambda: own_desk.viewer.GetSelectedBody() == own_desk.robot, "clicks do nothing any more")

    @pytest.mark.stress
    @pytest.mark.parametrize("how", one_in(3, ["SetViewer", "Destroy", "quitmainloop"]))
    def test_a_page_says_that_its_viewer_is_closed(self, own_desk, how):
        own_desk.drag((320, 100), (340, 130))
        if how == "SetViewer":
            own_desk.env.SetViewer("")
        else:
            (own_desk.env.Destroy if how == "Destroy" else own_desk.viewer.quitmainloop)()
        ended = "The viewer has been closed: its server has ended."
        await_that(lambda: own_desk.page.inner_text("#notice") == ended, "it says nothing")
        assert own_desk.viewer.main() == 0

    def test_it_is_tried_again_from_half_a_second_to_every_ten(self, desk):
        delays = desk.page.evaluate(
            """() => {
              const delays = [], set = window.setTimeout;
              window.setTimeout = (again, delay) => { delays.push(delay); };
              const one = new Reconnecting(() => {}, true);
              for (let i = 0; i < 8; i++) one.fail(i ? 1006 : 1001);
              one.restart();
              one.fail(1006);
              one.succeed();
              window.setTimeout = set;
              return delays;
            }"""
        )
        assert delays == [500, 1000, 2000, 4000, 8000, 10000, 10000, 10000, 500]

    @pytest.mark.stress
    @pytest.mark.parametrize("number", one_in(3, [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]))
    def test_with_port_and_token_it_comes_back_after_any_end(self, browser, folder, number):
        with socket.create_server(("127.0.0.1", 0)) as free:
            options = ["--web", "--port", str(free.getsockname()[1]), "--token", "robots-2026", "env.xml"]
        with contextlib.closing(browser.new_page()) as page:
            with Served(folder, "view", *options) as server:
                page.goto(server.url)
                page.wait_for_selector("[data-crisp=true]")
                server.end(number)
            said = "Connection lost" if number == signal.SIGKILL else "The viewer has been closed"
            page.wait_for_selector(f"#notice >> text={said}, reconnecting")
            page.evaluate("() => { clearTimeout(reconnecting.timer); window.setTimeout = () => 0; }")
            page.wait_for_function("socket.readyState === WebSocket.CLOSED")  # from now on only the button connects
            with Served(folder, "view", *options):
                page.get_by_role("button", name="Try now").click()
                page.wait_for_selector("#notice span", state="hidden")
                page.keyboard.press("Escape")
                page.wait_for_selector("[data-mode=interaction]")

    @pytest.mark.stress
    @pytest.mark.parametrize("number", one_in(2, [signal.SIGKILL, signal.SIGINT]))
    def test_with_another_address_at_each_start_it_says_that_its_server_has_ended(self, browser, folder, number):
        with contextlib.closing(browser.new_page()) as page:
            page.clock.install()
            with Served(folder, "view", "--web", "env.xml") as server:
                page.goto(server.url)
                page.wait_for_selector("[data-crisp=true]")
                server.end(number)

            def is_said():
                page.clock.run_for(10000)
                return "has ended" in page.inner_text("#notice span")

            await_that(is_said, "it is not said")
            assert page.is_visible("#notice button") == (number == signal.SIGKILL), "the way there may be broken"

    @pytest.mark.stress
    def test_a_browser_that_leaves_in_the_middle_harms_nobody(self, own_desk):
        other = own_desk.open_page()
        for step in range(20):
            own_desk.robot.SetDOFValues([0.01 * step, 0])
            if step == 10:
                other.close(run_before_unload=False)
        await_that(lambda: len(own_desk.viewer._clients) == 1, "the other page is still there")
        own_desk.await_picture()

    @pytest.mark.stress
    def test_a_body_is_removed_while_it_is_selected_and_dragged(self, own_desk):
        own_desk.viewer.SetBkgndColor([1, 1, 1])
        own_desk.escape()
        own_desk.click(own_desk.at(own_desk.point(2, 0.15, 0, 0)), keys=["Control"])
        await_that(lambda: own_desk.viewer.GetSelectedJoint() is not None, "no joint")
        x, y = own_desk.at(JointHandle.at(own_desk.robot.simulation_state, 1).center)
        own_desk.page.mouse.move(x + 4, y)
        own_desk.page.mouse.down()
        own_desk.page.mouse.move(x, y + 10)
        own_desk.env.Remove(own_desk.robot)
        own_desk.page.mouse.move(x - 10, y)
        own_desk.page.mouse.up()
        await_that(lambda: own_desk.picture()[CLEAR].min() == 255, "something is still seen")
        assert own_desk.viewer.GetSelectedBody() is None
        assert not own_desk.page.is_visible("#text")

    def test_pages_of_other_sites_cannot_connect(self, desk):
        elsewhere = desk.context.new_page()
        address = desk.viewer.url.replace("http", "ws") + "socket"
        elsewhere.goto("data:text/html,elsewhere")
        outcome = elsewhere.evaluate(
            "address => new Promise(done => { const socket = new WebSocket(address);"
            "socket.onopen = () => done('open'); socket.onerror = () => done('refused'); })",
            address,
        )
        assert outcome == "refused"
