"""Playing, saving, sliders, the tree and simulation time on the page, in a real browser, with mouse and keys."""

import io
import re

import imageio.v3
import numpy as np
import pytest
from browsers import NEEDS_A_BROWSER, SIZE, Desk, assert_apart
from conftest import MODELS, one_in
from waiting import await_that

import ravemj
from ravemj.gui.interaction.shortcuts import sections

pytestmark = NEEDS_A_BROWSER
LONG = ravemj.Motion.line([0, 0], [2.0, -1.0], 100.0)


def pendulum() -> ravemj.Environment:
    return ravemj.load(MODELS / "env.xml")


@pytest.fixture(scope="module")
def shared_desk(browser):
    desk = Desk(browser, pendulum, permissions=["clipboard-read", "clipboard-write"])
    yield desk
    desk.close()


@pytest.fixture
def desk(shared_desk, tmp_path, monkeypatch):
    """The pendulum as it was loaded, with nothing to play and the sliders folded away."""
    monkeypatch.chdir(tmp_path)
    shared_desk.viewer.playback.clear()
    shared_desk.viewer.playback.speed = 1.0
    shared_desk.reset()
    fold(shared_desk, False)
    yield shared_desk
    assert shared_desk.troubles == []


def button(desk, name):
    return desk.page.get_by_role("button", name=name)


def slider(desk, name):
    return desk.page.get_by_role("slider", name=name, exact=True)


def fold(desk, unfolded: bool) -> None:
    joints = button(desk, "DOFs")
    await_that(lambda: joints.get_attribute("aria-expanded") in {"true", "false"}, "no button for the joints")
    if joints.get_attribute("aria-expanded") != str(unfolded).lower():
        joints.click()
    await_that(lambda: desk.page.locator("#joints").is_visible() == unfolded, "the sliders do not unfold, or fold")


def test_the_motion_is_there_while_there_is_one(desk):
    assert not desk.page.locator("#motion").is_visible()
    desk.page.focus("#view")
    desk.await_picture()
    desk.page.wait_for_selector("[data-crisp=true]")
    plain = desk.picture()
    for key in ("Space", "ArrowLeft", "ArrowRight"):
        desk.page.keyboard.press(key)
    assert np.array_equal(desk.picture(), plain)
    desk.viewer.play(LONG)
    await_that(lambda: desk.page.locator("#motion").is_visible(), "no controls")
    assert button(desk, "Pause").is_visible()
    desk.viewer.playback.clear()
    await_that(lambda: not desk.page.locator("#motion").is_visible(), "the controls stay")


@pytest.mark.stress
def test_the_page_plays_in_real_time_and_shows_it(desk):
    desk.viewer.play(ravemj.Motion.line([0, 0], [2.0, -1.0], 1.0))
    await_that(lambda: not desk.viewer.playback.playing, "it does not end")
    np.testing.assert_allclose(desk.robot.GetDOFValues(), [2.0, -1.0])
    desk.other_robot.SetDOFValues([2.0, -1.0])
    desk.await_robot()
    await_that(lambda: desk.page.text_content("#motion output") == "1.00 / 1.00 s", "the clock shows another time")
    button(desk, "Play").click()  # once more
    await_that(lambda: desk.viewer.playback.playing, "it does not play again")
    await_that(lambda: not desk.viewer.playback.playing, "it does not end again")


def test_buttons_pause_step_and_change_the_speed(desk):
    playback = desk.viewer.play(LONG)
    button(desk, "Pause").click()
    await_that(lambda: not playback.playing, "it does not pause")
    playback.seek(50.0)
    for name, expected in (("One frame forward", 50 + 1 / 30), ("One frame back", 50), ("One frame back", 50 - 1 / 30)):
        button(desk, name).click()
        await_that(lambda expected=expected: playback.time == pytest.approx(expected), name)
    button(desk, "Speed").click()
    await_that(lambda: playback.speed == 2, "the speed stays")
    await_that(lambda: button(desk, "Speed 2x").is_visible(), "the speed is not shown")
    button(desk, "Play").click()
    await_that(lambda: playback.playing, "it does not play")


def settled_box(desk, element) -> dict[str, float]:
    """Return where an element is, once the layout of the controls has settled."""
    boxes = [element.bounding_box()]

    def is_settled() -> bool:
        desk.page.evaluate("() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 100)))")
        boxes.append(element.bounding_box())
        return boxes[-1] is not None and boxes[-1] == boxes[-2]

    await_that(is_settled, "the controls do not come to rest")
    return boxes[-1]


def test_the_time_is_dragged_and_the_robot_follows(desk):
    playback = desk.viewer.play(LONG)
    time = slider(desk, "Time")
    box = settled_box(desk, time)
    y = box["y"] + box["height"] / 2
    desk.page.mouse.move(box["x"] + 10, y)
    desk.page.mouse.down()
    for part in (0.3, 0.5, 0.75):
        desk.page.mouse.move(box["x"] + part * box["width"], y)
    await_that(lambda: 60 < playback.time < 90, "the time does not follow")
    assert not playback.playing
    desk.page.mouse.up()
    np.testing.assert_allclose(desk.robot.GetDOFValues(), LONG.sample(playback.time))
    desk.other_robot.SetDOFValues(desk.robot.GetDOFValues())
    desk.await_picture()
    await_that(lambda: float(time.input_value()) == pytest.approx(playback.time), "the slider is elsewhere")
    assert time.get_attribute("aria-valuetext") == f"{playback.time:.2f} / 100.00 s"


def test_everything_can_be_reached_and_done_by_keys(desk):
    playback = desk.viewer.play(LONG)
    playback.pause()
    playback.seek(50.0)
    await_that(lambda: button(desk, "Play").is_visible(), "no controls")
    desk.page.evaluate("document.activeElement.blur()")  # as when the page has been opened, before any click
    desk.page.keyboard.press("ArrowRight")
    await_that(lambda: playback.time == pytest.approx(50 + 1 / 30), "the arrow does not step")
    desk.page.keyboard.press("Space")
    await_that(lambda: playback.playing, "the space bar does not play")
    desk.page.keyboard.press("Space")
    await_that(lambda: not playback.playing, "the space bar does not pause")
    names = []
    for _ in range(19):
        desk.page.keyboard.press("Tab")
        names.append(desk.page.evaluate("document.activeElement.dataset.name || document.activeElement.type"))
        if names[-1] == "play":
            desk.page.keyboard.press("Space")
            await_that(lambda: playback.playing, "the button does not play")
            desk.page.keyboard.press("Enter")
            await_that(lambda: not playback.playing, "the button does not pause")
        if names[-1] == "range":
            before = playback.time
            desk.page.keyboard.press("ArrowRight")
            await_that(lambda before=before: playback.time > before, "the slider does not move")
    wanted = [
        "back",
        "play",
        "forward",
        "range",
        "speed",
        "picture",
        "video",
        "camera",
        "view",
        "display",
        "tree",
        "help",
        "pull",
        "joints",
    ]
    assert [name for name in names if name in wanted] == wanted


def test_sliders_turn_joints_and_show_what_scripts_do(desk):
    assert not desk.page.locator("#joints").is_visible()
    fold(desk, True)
    joint = slider(desk, "Joint1")
    box = joint.bounding_box()
    desk.page.mouse.click(box["x"] + 0.75 * box["width"], box["y"] + box["height"] / 2)
    await_that(lambda: desk.robot.GetDOFValues()[1] == pytest.approx(np.pi / 2, abs=0.5), "the joint does not turn")
    turned = desk.robot.GetDOFValues()
    assert turned[0] == 0
    desk.other_robot.SetDOFValues(turned)
    desk.page.mouse.move(1, 1)
    text = f"{turned[1]:.3f} rad"
    await_that(lambda: joint.get_attribute("aria-valuetext") == text, "the slider has another text")
    for page_side in (desk.page.locator("#joints"), desk.page.locator("#modes")):
        assert page_side.is_visible()
    desk.robot.SetDOFValues([-1.0, 0.5])
    await_that(lambda: float(slider(desk, "Joint0").input_value()) == pytest.approx(-1), "it shows another value")
    fold(desk, False)
    desk.other_robot.SetDOFValues([-1.0, 0.5])
    desk.await_robot()


def test_escape_ends_typing_and_leaves_the_mode(desk):
    fold(desk, unfolded=True)
    number = desk.page.get_by_role("textbox", name="Joint1, value")
    await_that(lambda: number.input_value().endswith(" rad"), "no value")
    before, values = number.input_value(), desk.robot.GetDOFValues().tolist()
    number.fill("0.5")
    number.press("Escape")
    assert number.input_value() == before
    assert desk.page.evaluate("document.activeElement.id") == "view"
    desk.page.keyboard.press("b")
    search = desk.page.get_by_role("searchbox")
    search.fill("arm1")
    assert not row(desk, "Base").is_visible()
    search.press("Escape")
    assert search.input_value() == ""
    assert row(desk, "Base").is_visible()
    assert desk.page.evaluate("document.activeElement.id") == "view"
    desk.page.keyboard.press("b")
    await_that(lambda: not desk.page.locator("#tree").is_visible(), "keys are for the view again")
    assert desk.page.get_attribute("body", "data-mode") == "camera"
    assert desk.robot.GetDOFValues().tolist() == values
    desk.page.keyboard.press("h")
    desk.page.locator("#help").wait_for(state="visible")
    desk.page.keyboard.press("Escape")
    desk.page.locator("#help").wait_for(state="hidden")
    assert desk.page.get_attribute("body", "data-mode") == "camera"


def test_numbers_are_typed_in_the_unit_that_is_shown(desk):
    fold(desk, True)
    number = desk.page.get_by_role("textbox", name="Joint1, value")
    number.fill("0.5")
    number.press("Enter")
    await_that(lambda: desk.robot.GetDOFValues()[1] == pytest.approx(0.5), "the joint does not turn")
    desk.page.locator("#joint-tools").get_by_role("button", name="degrees").click()
    await_that(lambda: number.input_value() == "28.6 deg", "there are no degrees")
    number.fill("-90")
    number.press("Enter")
    await_that(lambda: desk.robot.GetDOFValues()[1] == pytest.approx(-np.pi / 2), "these are no degrees")
    button(desk, "Bring all joints to 0").click()
    await_that(lambda: not desk.robot.GetDOFValues().any(), "the joints stay")
    desk.page.locator("#joint-tools").get_by_role("button", name="degrees").click()


def test_letters_that_are_typed_are_no_keys_of_the_view(desk):
    camera = desk.viewer.GetCameraTransform()
    fold(desk, True)
    desk.page.get_by_role("textbox", name="Joint1, value").press_sequentially("1h0f2g")
    desk.page.get_by_role("textbox", name="Joint1, value").press("Tab")
    await_that(lambda: desk.robot.GetDOFValues()[1], "the number before the letters does not count")
    assert np.array_equal(desk.viewer.GetCameraTransform(), camera)
    assert desk.page.locator("#help").is_hidden()


def test_the_help_has_every_gesture_and_key_and_goes_away_by_a_click(desk):
    desk.page.focus("#view")
    desk.page.keyboard.press("?")
    await_that(lambda: desk.page.locator("#help").is_visible(), "there is no help")
    text = desk.page.inner_text("#help")
    for title, rows in sections():
        assert title in text
        for to, how in rows:
            assert to in text
            assert how in text
    box = desk.page.locator("#help").bounding_box()
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= SIZE[0]
    desk.page.locator("#help").click()
    await_that(lambda: desk.page.locator("#help").is_hidden(), "it stays")


def test_a_picture_is_downloaded_as_it_is_seen_without_buttons(desk):
    desk.viewer.SetBkgndColor([0.2, 0.3, 0.4])
    desk.await_picture()
    with desk.page.expect_download() as download:
        button(desk, "PNG").click()
    await_that(lambda: "Saved ravemj-" in desk.page.inner_text("#toast"), "the page does not say it")
    assert re.fullmatch(r"ravemj-\d{8}-\d{6}\.png", download.value.suggested_filename)
    saved = imageio.v3.imread(io.BytesIO(download.value.path().read_bytes()))
    assert np.array_equal(saved, desk.expected(shadows=True))


@pytest.mark.stress
def test_a_video_is_downloaded_too(desk, tmp_path):
    desk.viewer.play(ravemj.Motion.line([0, 0], [2.0, -1.0], 0.3))
    with desk.page.expect_download() as download:
        button(desk, "MP4").click()
    await_that(lambda: "Saved ravemj-" in desk.page.inner_text("#toast"), "the page does not say it")
    assert re.fullmatch(r"ravemj-\d{8}-\d{6}\.mp4", download.value.suggested_filename)
    download.value.save_as(tmp_path / "a.mp4")
    assert imageio.v3.imread(tmp_path / "a.mp4").shape == (10, SIZE[1], SIZE[0], 3)
    assert [file.name for file in tmp_path.iterdir()] == ["a.mp4"], "the server keeps none"


@pytest.mark.stress
def test_a_video_ends_with_the_last_tab_and_the_tab_that_comes_back_gets_it(desk, tmp_path, caplog):
    desk.viewer.playback.clear()
    await_that(lambda: not desk.page.locator("#motion").is_visible(), "there is a motion")
    notices = desk.viewer.interaction.controls.notices
    other = desk.open_page()
    button(desk, "MP4").click()
    await_that(lambda: notices.recording, "no recording")
    other.close()
    await_that(lambda: len(desk.viewer._clients) == 1, "the other tab stays")
    assert notices.recording, "a tab is there"
    desk.page.goto("about:blank")
    await_that(lambda: not desk.viewer._clients, "the last tab stays")
    with desk.page.expect_download() as download:
        desk.page.go_back()
    assert download.value.suggested_filename.endswith(".mp4")
    await_that(lambda: not notices.recording, "the recording goes on")
    assert list(tmp_path.iterdir()) == []
    desk.page.wait_for_selector("[data-crisp]")


def test_the_camera_is_copied_as_a_line_to_paste(desk):
    button(desk, "Copy").click()
    await_that(lambda: "Copied" in desk.page.inner_text("#toast"), "the page does not say it")
    line = desk.page.evaluate("navigator.clipboard.readText()")
    expected = desk.viewer.GetCameraTransform()
    desk.viewer.SetCamera(np.eye(4))
    eval(line, {"viewer": desk.viewer})
    np.testing.assert_allclose(desk.viewer.GetCameraTransform(), expected, atol=1e-8)


def test_the_camera_is_copied_where_pages_have_no_clipboard(desk):
    desk.page.evaluate("() => { navigator.clipboard.writeText = () => Promise.reject(new Error('none')); }")
    desk.page.evaluate("() => { document.execCommand = () => false; }")
    shown = []
    desk.page.once("dialog", lambda dialog: (shown.append(dialog.default_value), dialog.dismiss()))
    button(desk, "Copy").click()
    await_that(lambda: desk.page.evaluate("1") and shown, "the line is not shown")
    assert shown[0].startswith("viewer.SetCamera([[")
    desk.page.reload()
    desk.page.wait_for_selector("[data-crisp]")


@pytest.mark.stress
def test_tabs_share_the_motion(desk):
    other = desk.open_page()
    playback = desk.viewer.play(LONG)
    other.get_by_role("button", name="Pause").click()
    await_that(lambda: not playback.playing, "it does not pause")
    await_that(lambda: button(desk, "Play").is_visible(), "the other tab does not show it")


@pytest.mark.parametrize("size", one_in(3, [(400, 700), (640, 400), (900, 640)]))
def test_controls_do_not_cover_each_other(desk, size):
    desk.viewer.play(LONG).pause()
    desk.page.set_viewport_size({"width": size[0], "height": size[1]})
    fold(desk, True)
    assert_apart(desk.page, "#motion, #tools, #joints, #modes, .wheel", 7)


@pytest.mark.stress
@pytest.mark.parametrize("is_mobile", [True, False])
def test_on_a_small_phone_the_tools_and_the_sliders_leave_the_wheels_free(desk, is_mobile):
    size = {"width": 320, "height": 480}
    with desk.context.browser.new_context(viewport=size, has_touch=True, is_mobile=is_mobile) as context:
        page = context.new_page()
        page.goto(desk.viewer.url)
        page.wait_for_selector("[data-crisp]")
        page.get_by_text("DOFs", exact=True).click()
        page.wait_for_selector("#joints", state="visible")
        assert_apart(page, "#tools, #joints, #modes, .wheel", 6)
        texts = page.locator("#joint-tools button")
        assert texts.count() == 4
        assert texts.evaluate_all("all => all.every((one) => one.scrollWidth <= one.clientWidth)")


@pytest.mark.parametrize("size", one_in(5, [(320, 480), (480, 320), (480, 640), (700, 400), (1000, 700)]))
def test_the_tools_leave_the_text_free_and_all_sliders_are_on_the_page(desk, size):
    desk.page.set_viewport_size({"width": size[0], "height": size[1]})
    desk.robot.GetEnv().GetViewer().interaction.controls.notices.say("a notice that is longer than a small page", 60)
    await_that(lambda: "a notice" in desk.page.locator("#text").inner_text(), "the notice does not come")
    assert_apart(desk.page, "#text, #tools", 2)
    fold(desk, True)
    assert_apart(desk.page, "#joints", 1)


# --- the tree, simulation time, files that are dropped


def row(desk, name):
    return desk.page.get_by_role("treeitem", name=name)


def selected(desk) -> list[str]:
    return desk.page.evaluate("[...document.querySelectorAll('#tree [aria-selected=true]')].map((row) => row.title)")


def test_the_tree_selects_in_the_picture_and_the_picture_in_the_tree(desk):
    desk.page.get_by_role("button", name="Bodies, links and joints").click()
    await_that(lambda: row(desk, "Arm1").is_visible(), "no tree")
    row(desk, "Joint1").click()
    await_that(lambda: desk.viewer.GetSelectedJoint() is not None, "no joint")
    assert desk.viewer.GetSelectedJoint().GetName() == "Joint1"
    await_that(lambda: selected(desk) == ["body Pendulum", "joint Joint1", "link Arm1"], "other rows are marked")
    desk.viewer.interaction.select(None)
    await_that(lambda: selected(desk) == [], "the marks stay")
    search = desk.page.get_by_role("searchbox")
    indents = "[...document.querySelectorAll('#tree [role=treeitem]')].map(row => getComputedStyle(row).paddingLeft)"
    assert len(set(desk.page.evaluate(indents))) > 1
    search.fill("ARM")
    assert set(desk.page.evaluate(indents)) == {"6px"}, "what is found has no depth"
    assert not row(desk, "Base").is_visible()
    search.press("ArrowDown")
    desk.page.keyboard.press("ArrowDown")
    desk.page.keyboard.press("Enter")
    await_that(lambda: selected(desk) == ["body Pendulum", "link Arm1"], "the keys choose another row")
    search.fill("")
    assert row(desk, "Base").is_visible()
    desk.page.keyboard.press("Control+A")  # keys are for the search while that has the focus
    desk.page.focus("#view")
    desk.page.keyboard.press("b")
    await_that(lambda: not desk.page.locator("#tree").is_visible(), "the tree stays")


def test_time_is_paused_stepped_and_paced(desk):
    clock = desk.viewer.GetEnv().clock
    assert not desk.page.locator("#time").is_visible()
    desk.viewer.GetEnv().SetPhysicsEngine("mujoco")
    desk.viewer.GetEnv().StartSimulation(0.01)
    await_that(lambda: desk.page.locator("#time").is_visible(), "no controls")
    desk.page.get_by_role("button", name="Stop simulation time").click()
    await_that(lambda: not clock.is_running, "time goes on")
    before = clock.now
    desk.page.get_by_role("button", name="One step of simulation time").click()
    await_that(lambda: clock.now == before + 10_000, "no step")
    desk.page.focus("#view")
    desk.page.keyboard.press("-")
    await_that(lambda: clock.pace == 0.5, "the pace stays")
    desk.page.keyboard.press("Space")
    await_that(lambda: clock.is_running, "time stands still")
    await_that(lambda: desk.page.text_content("#time output").endswith("x"), "the clock does not say how fast it is")
    desk.page.keyboard.press("Space")
    await_that(lambda: not clock.is_running, "time goes on")


def test_a_file_that_is_dropped_is_added(desk):
    shape = '<Geom type="sphere"><radius>0.1</radius></Geom>'
    model = f'<KinBody name="cup"><!-- {"long " * 500}--><Body>{shape}</Body></KinBody>'
    dropped = desk.page.evaluate_handle(
        "xml => { const data = new DataTransfer(); data.items.add(new File([xml], 'my cup.xml')); return data; }", model
    )
    desk.page.dispatch_event("#view", "drop", {"dataTransfer": dropped})
    await_that(lambda: desk.env.GetKinBody("cup") is not None, "it is not added")
    await_that(lambda: "Added my cup.xml" in desk.page.text_content("#text"), "the view does not say so")
