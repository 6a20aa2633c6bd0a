"""Never lost: the ways back to a good view, and the view while others have the bodies."""

import math
import threading

import numpy as np
import pytest
from conftest import REPOSITORY, one_in
from test_interaction import ASLANT, FROM_FRONT, Hand

import ravemj
from ravemj.graphics.rendering import Camera, bounding_sphere
from ravemj.gui.interaction import (
    Button,
    Fingers,
    Key,
    Mode,
    Move,
    Operate,
    Press,
    Release,
    Resize,
    Use,
    ViewButton,
    Wheel,
)
from ravemj.gui.interaction.cube import Cube
from ravemj.gui.interaction.figures import figures
from ravemj.gui.interaction.joint_handle import JointHandle
from ravemj.gui.interaction.navigation import GLIDE, SIDES
from ravemj.gui.interaction.shortcuts import DISPLAY, GESTURES, KEYS, OTHERS, VIEW, as_markdown, key_text
from ravemj.gui.viewers.window_overlay import OverlayPainter

ROLLED = ASLANT @ ravemj.matrixFromAxisAngle([0, 0, 1], 0.4)


@pytest.fixture
def hand(env):
    return Hand(env, ROLLED)


def roll(camera) -> float:
    """How far the image's horizontal is off the world's [rad]."""
    return math.asin(float(camera.rotation[2, 0]))


def go(hand, key):
    """Press a key, and let the view glide to its end."""
    hand.press_key(key)
    hand.gui.advance(100.0)
    hand.gui.advance(100.0 + GLIDE)


def test_home_is_the_first_view_or_that_of_a_script(hand):
    hand.drag((400, 300), (500, 350))
    go(hand, "home")
    np.testing.assert_allclose(hand.view.camera.T_world_camera, ROLLED, atol=1e-12)
    hand.gui.look_from(Camera(FROM_FRONT), 1.0)
    hand.drag((400, 300), (500, 350))
    other = hand.gui.another_view()
    other.handle(Key("home"))
    np.testing.assert_allclose(other.view.camera.T_world_camera, FROM_FRONT, atol=1e-12)
    hand.gui.handle(Resize(400, 300))
    go(hand, "home")
    assert hand.view.size == (400, 300)
    np.testing.assert_allclose(hand.view.camera.T_world_camera, FROM_FRONT, atol=1e-12)


def test_upright_levels_the_view_and_looks_at_the_same_point(hand):
    hand.gui.look_from(Camera(ROLLED), 0.8)
    focus, forward = hand.view.focus, hand.view.camera.rotation[:, 2]
    assert abs(roll(hand.view.camera)) > 0.1
    go(hand, "u")
    assert roll(hand.view.camera) == pytest.approx(0, abs=1e-12)
    assert hand.view.camera.rotation[2, 1] < 0, "z is up in the picture, not down"
    np.testing.assert_allclose(hand.view.focus, focus, atol=1e-12)
    np.testing.assert_allclose(hand.view.camera.rotation[:, 2], forward, atol=1e-6)


def test_upright_changes_nothing_where_there_is_no_upright(hand):
    above = np.array([[0.0, -1, 0, 0], [-1, 0, 0, 0], [0, 0, -1, 3], [0, 0, 0, 1]])
    hand.gui.look_from(Camera(above), 1.0)
    go(hand, "u")
    np.testing.assert_allclose(hand.view.camera.T_world_camera, above, atol=1e-12)


@pytest.mark.parametrize("size", [(800, 600), (300, 900)])
@pytest.mark.parametrize("selected", [False, True])
def test_fit_shows_all_or_what_is_selected_as_large_as_it_fits(boxes_apart, size, selected):
    hand = Hand(boxes_apart)
    hand.gui.handle(Resize(*size))
    if selected:
        hand.in_interaction().click(hand.at([0.1, 1, 0]))
        assert hand.selection.body.scene.name == "right"
    go(hand, "f")
    corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (0.95, 1.05) for z in (-0.15, 0.15)])
    if not selected:
        corners = np.concatenate([corners, corners * [1, -1, 1]])
    pixels, depths = hand.view.camera.project(corners, *size)
    assert (depths > 0).all()
    assert (pixels >= 0).all()
    assert (pixels <= size).all()
    spread = (pixels.max(axis=0) - pixels.min(axis=0)) / size
    assert spread.max() > 0.25, "it is small"
    np.testing.assert_allclose(hand.view.focus, corners.mean(axis=0), atol=1e-9)
    np.testing.assert_allclose(hand.view.camera.rotation, FROM_FRONT[:3, :3], atol=1e-12)


@pytest.fixture
def boxes_apart():
    env = ravemj.Environment()
    for name, y in (("left", -1.0), ("right", 1.0)):
        body = ravemj.RaveCreateKinBody(env, "")
        body.InitFromBoxes(np.array([[0, 0, 0, 0.1, 0.05, 0.15]]), True)
        body.SetName(name)
        env.Add(body)
        body.SetTransform([1, 0, 0, 0, 0, y, 0])
    return env


@pytest.mark.parametrize(("key", "side"), [("1", "front"), ("2", "behind"), ("3", "left"), ("4", "right")])
def test_the_sides_are_level_and_keep_the_focus(hand, key, side):
    hand.gui.look_from(Camera(ROLLED), 0.8)
    focus = hand.view.focus
    go(hand, key)
    np.testing.assert_allclose(hand.view.camera.rotation[:, 2], SIDES[side], atol=1e-12)
    np.testing.assert_allclose(hand.view.camera.rotation[:, 1], [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(hand.view.focus, focus, atol=1e-12)
    assert hand.view.distance == pytest.approx(0.8)


@pytest.mark.parametrize(("key", "forward"), [("5", -1), ("6", 1)])
def test_above_and_below_have_y_up(hand, key, forward):
    go(hand, key)
    np.testing.assert_allclose(hand.view.camera.rotation[:, 2], [0, 0, forward], atol=1e-12)
    np.testing.assert_allclose(hand.view.camera.rotation[:, 1], [0, -1, 0], atol=1e-12)


def test_the_view_glides_and_scripts_read_its_end_at_once(hand):
    hand.gui.look_from(Camera(ROLLED), 0.8)
    hand.press_key("1")
    end = hand.view.camera.T_world_camera
    versions, angles = [], []
    for part in (0, 0.25, 0.5, 0.75, 1.0, 1.5):
        hand.gui.advance(7.0 + part * GLIDE)
        versions.append(hand.gui.appearance)
        drawn = hand.gui.drawn_view.camera
        np.testing.assert_allclose(drawn.rotation.T @ drawn.rotation, np.eye(3), atol=1e-9)
        angles.append(math.acos(min(float(drawn.rotation[:, 2] @ end[:3, 2]), 1)))
        assert np.array_equal(hand.view.camera.T_world_camera, end)
    np.testing.assert_allclose(angles[0], math.acos(float(ROLLED[:3, 2] @ end[:3, 2])), atol=1e-3)
    assert (np.diff(angles[:5]) < 0).all()
    assert angles[4] == angles[5] == 0
    assert versions[4] == versions[5], "at rest nothing is drawn"
    assert len(set(versions[:5])) == 5


def test_a_hand_on_the_view_ends_its_gliding(hand):
    hand.press_key("1")
    hand.gui.advance(1.0)
    hand.gui.handle(Wheel(1))
    assert hand.gui.drawn_view is hand.view


# --- keep upright


def test_the_trackball_rolls_and_the_turntable_does_not(hand):
    hand.gui.look_from(Camera(ASLANT), 0.8)
    drags = [((400, 300), (520, 390)), ((300, 100), (700, 380)), ((200, 500), (320, 110))]
    for drag in drags:
        hand.drag(*drag)
    assert abs(math.degrees(roll(hand.view.camera))) > 10, "the tutorial's view turns freely"
    go(hand, "k")
    focus = hand.view.focus
    for drag in drags:
        hand.drag(*drag)
        assert roll(hand.view.camera) == pytest.approx(0, abs=1e-9)
        assert hand.view.camera.rotation[2, 1] <= 1e-9
    np.testing.assert_allclose(hand.view.focus, focus, atol=1e-9)
    assert next(control for control in unfolded(hand, "view") if control.name == "turntable").is_on
    go(hand, "k")
    hand.drag(*drags[0])
    assert abs(roll(hand.view.camera)) > 1e-3


def unfolded(hand, name):
    hand.gui.handle(Operate(name))
    return hand.gui.overlay().controls


def test_the_turntable_stops_at_the_poles_and_comes_back(hand):
    go(hand, "1")
    go(hand, "k")
    for down in (4000, 30, 7):
        hand.drag((400, 300), (400, 300 + down))
    np.testing.assert_allclose(hand.view.camera.rotation[:, 2], [0, 0, -1], atol=1e-6)
    up = hand.view.camera.rotation[:, 1]
    np.testing.assert_allclose(up, [1, 0, 0], atol=1e-6)  # the robot's front is at the lower edge
    hand.drag((400, 300), (700, 300))  # a quarter of a turn: half of it is the height of the view
    np.testing.assert_allclose(hand.view.camera.rotation[:, 1], [0, -1, 0], atol=1e-6)
    hand.drag((400, 300), (400, 0))
    np.testing.assert_allclose(hand.view.camera.rotation[:, 2], [0, 1, 0], atol=1e-6)


@pytest.mark.parametrize("way", [(9, 0), (0, 9), (-7, 5)])
def test_on_the_turntable_what_is_before_the_focus_follows_the_pointer(hand, way):
    hand.gui.look_from(Camera(ASLANT), 0.8)
    go(hand, "k")
    near = hand.view.focus - 0.05 * hand.view.camera.rotation[:, 2]
    before = np.array(hand.at(near))
    hand.drag((400, 300), (400 + way[0], 300 + way[1]))
    assert (np.array(hand.at(near)) - before) @ way > 0


def test_centring_on_the_turntable_stays_level(hand):
    go(hand, "k")
    hand.gui.handle(Key("s"))
    hand.click(hand.at([0.01, 0, -0.3]))
    assert roll(hand.view.camera) == pytest.approx(0, abs=1e-9)
    np.testing.assert_allclose(hand.at(hand.view.focus), (400, 300), atol=1e-6)


# --- the floor


def test_the_floor_is_shown_and_hidden_and_says_where_metres_are(hand):
    assert len(hand.gui.overlay().primitives) == 0
    version = hand.gui.appearance
    hand.press_key("g")
    assert hand.gui.appearance != version
    shown = hand.gui.overlay()
    corners = shown.primitives.lines.corners
    center, radius = bounding_sphere(hand.env.model, hand.env.data)
    assert np.abs(corners[..., :2]).max() >= np.abs(center[:2]).max() + radius, "it goes beyond what stands on it"
    assert corners[..., 2].min() < 0, "below a floor of the model"
    for label in shown.labels:
        if label.text.endswith(" m"):
            assert float(label.text[:-2]) == pytest.approx(np.abs(label.point).max())
    assert {"x", "y", "z"} < {label.text for label in shown.labels}
    hand.press_key("g")
    assert len(hand.gui.overlay().primitives) == 0
    assert hand.gui.overlay().labels == ()


@pytest.mark.parametrize("radius", [1e-4, 0.1, 1.0, 30.0, 5000.0, 1e7])
def test_the_floor_has_few_lines_whatever_the_size_of_the_scene(radius):
    from ravemj.gui.interaction.figures import floor_grid, floor_labels

    lines = floor_grid(np.zeros(3), radius).lines
    assert 4 <= len(lines.sizes) < 120
    assert len(floor_labels(np.zeros(3), radius)) < 60


# --- while a script has the bodies


@pytest.fixture
def held(hand):
    """The view while another thread has the simulation."""
    hand.gui.overlay()
    hand.sphere = bounding_sphere(hand.env.model, hand.env.data)
    taken, done = threading.Event(), threading.Event()

    def hold():
        with hand.env:
            taken.set()
            done.wait(60)

    thread = threading.Thread(target=hold)
    thread.start()
    taken.wait(60)
    yield hand
    done.set()
    thread.join(60)


def test_the_camera_moves_while_others_have_the_bodies(held):
    gui = held.gui
    events = [Press(400, 300), Move(450, 310), Release(450, 310), Wheel(2), Use(ViewButton.ROT_X, 10)]
    events += [Fingers(400, 300, 5, 5, 1.1), Resize(500, 400), Key("1"), Key("1", False), Key("f"), Operate("home")]
    for event in events:
        before = gui.view
        assert gui.handle_view_events([event]) == []
        if not isinstance(event, Press | Release) and getattr(event, "pressed", True):
            assert gui.view is not before, event
    np.testing.assert_allclose(gui.view.camera.T_world_camera, ROLLED, atol=1e-12)


def test_the_view_turns_about_the_scene_also_where_no_focus_was_set(held):
    center, _ = held.sphere
    depth = float((center - ROLLED[:3, 3]) @ ROLLED[:3, 2])
    held.gui.handle_view_events([Use(ViewButton.ROT_X, 10)])
    assert held.view.distance == pytest.approx(depth, rel=1e-3)


def test_modes_change_and_clicks_wait_while_others_have_the_bodies(held):
    gui = held.gui
    click = [Press(400, 300), Release(400, 300)]
    assert gui.handle_view_events([Key("escape"), Key("escape", False), *click]) == click
    assert gui.mode is Mode.INTERACTION
    assert gui.handle_view_events([*click, Move(3, 3)]) == [*click, Move(3, 3)]
    assert gui.handle_view_events([*click, Key("1")]) == [], "it would point at what was there before"
    assert gui.handle_view_events([*click, Operate("joints")]) == [*click, Operate("joints")]
    turn = [Press(400, 300), Move(420, 300), Release(420, 300)]
    before = gui.view
    assert gui.handle_view_events([*click, Key("escape"), Key("escape", False), *turn]) == []
    assert gui.view is not before


def test_what_is_dragged_is_let_go_only_once_the_bodies_are_free(env):
    hand = Hand(env, FROM_FRONT).in_interaction()
    hand.click(hand.at([0.01, 0, -0.3]), ctrl=True)
    events = [Move(3, 3), Release(3, 3)]
    at = hand.at(JointHandle.at(hand.selection.body, 1).center)
    hand.gui.handle(Press(*at))
    hand.gui.handle(Move(at[0] + 30, at[1]))
    thread = threading.Thread(target=lambda: waiting.extend(hand.gui.handle_view_events(events)))
    waiting: list[object] = []
    thread.start()
    thread.join(60)
    assert waiting == events
    hand.gui.handle(Release(3, 3))
    assert hand.gui.handle_view_events(events) == []


def test_a_key_that_waited_is_up_again_afterwards(hand):
    for event in hand.gui.handle_view_events([Key("g"), Key("g", False)]):
        hand.gui.handle(event)
    assert hand.gui.controls.display.shown == {"floor"}
    hand.press_key("g")
    assert not hand.gui.controls.display.shown


def test_right_clicks_and_panels_wait(held):
    gui = held.gui
    rect = next(iter(gui._controller.layout.places.values()))
    on_panel = Press(rect.x + 2, rect.y + 2)
    assert gui.handle_view_events([on_panel]) == [on_panel]
    pull = Press(400, 300, Button.RIGHT)
    assert gui.handle_view_events([pull]) == [pull]


def test_static_bodies_have_no_ellipsoids_which_would_cover_all(hand):
    def extent(names):
        shown = figures(env.simulation, frozenset(names), 1.0)
        corners = np.concatenate([figure.triangles.corners.reshape(-1, 3) for figure in shown])
        return np.ptp(corners, axis=0).max()

    env = ravemj.load(ravemj.model_path("pendulum"))
    before = extent({"masses"})
    env.LoadData(
        '<KinBody name="floor"><Body name="a" type="dynamic"><Geom type="box"><extents>30 30 0.1</extents></Geom>'
        "<Mass type='mimicgeom'/></Body></KinBody>"
    )
    floor = env.GetKinBody("floor")
    assert extent({"masses"}) > 10 * before, "what moves has one"
    floor.GetLinks()[0].SetStatic(True)
    assert extent({"masses"}) < 3 * before


# --- help


def test_every_key_is_a_control_and_in_the_help(hand):
    hand.press_key("h")
    rows = [row for _, rows in hand.gui.overlay().help for row in rows]
    for shortcut in (*VIEW, *DISPLAY, *OTHERS):
        assert (shortcut.label, key_text(shortcut.keys)) in rows
    for title in GESTURES:
        assert title in [title for title, _ in hand.gui.overlay().help]
    keys = [key for shortcut in (*VIEW, *DISPLAY, *OTHERS) for key in shortcut.keys]
    assert len(keys) == len(set(keys)) == len(KEYS), "two have one key"
    assert not {"s", "escape"} & KEYS.keys(), "these are the tutorial's"
    hand.press_key("f1")
    assert hand.gui.overlay().help == ()


def test_escape_closes_the_help_and_leaves_the_mode(hand):
    hand.press_key("h")
    for is_repeated in (False, True):  # a key that is held repeats
        hand.gui.handle(Key("escape"))
        assert (hand.gui.overlay().help, hand.gui.mode) == ((), Mode.CAMERA), is_repeated
    hand.gui.handle(Key("escape", False))
    hand.press_key("escape")
    assert hand.gui.mode is Mode.INTERACTION
    hand.press_key("b")
    hand.press_key("escape")
    assert hand.gui.mode is Mode.CAMERA, "the tree is no cover"
    assert hand.gui.overlay().tree


@pytest.mark.parametrize("size", one_in(5, [(320, 240), (480, 320), (655, 500), (960, 720), (1920, 1080)]))
def test_a_window_has_all_of_the_help_which_scrolls_and_goes_away_by_a_click(hand, size):
    hand.gui.handle(Resize(*size))
    hand.press_key("?")
    hand.gui.handle(Move(size[0] / 2, size[1] / 2))
    seen = set()
    for _ in range(100):
        texts = [panel for panel in hand.gui._controller.layout.help if panel.text]
        seen |= {word for panel in texts for word in panel.text.split()}
        for panel in texts:
            assert panel.rect.y + panel.rect.height <= size[1]
            assert panel.rect.x + OverlayPainter()._width(panel.text) <= size[0] - 8, panel.text
        hand.gui.handle(Wheel(-1))
    assert seen == {
        word for _, rows in hand.gui.overlay().help for row in rows for part in row for word in part.split()
    } | {word for title, _ in hand.gui.overlay().help for word in title.split()}
    camera = hand.view.camera
    hand.click((size[0] / 2, size[1] / 2))
    assert hand.gui.overlay().help == ()
    assert hand.view.camera is camera


def test_lines_are_wrapped_to_the_window():
    painter = OverlayPainter()
    line = "link3: (x, y, z) = (0.355, -0.107, 0.991), n = (-0.188, -0.017, 0.982)"
    rows = painter._wrapped(line, 230)
    assert " ".join(rows) == line
    assert 1 < len(rows) < 4
    assert all(painter._width(row) <= 230 for row in rows)
    assert painter._wrapped("a_name_that_has_no_place_to_be_broken_at", 50) == [
        "a_name_that_has_no_place_to_be_broken_at"
    ]
    assert painter._wrapped("", 50) == [""]
    assert len(painter._wrapped(line, 230, 26)) > len(rows)


@pytest.mark.parametrize("shortcut", DISPLAY, ids=lambda shortcut: shortcut.name)
def test_what_is_shown_is_switched_by_its_key_and_its_button(hand, shortcut):
    hand.press_key(shortcut.keys[0])
    assert shortcut.name in hand.gui.controls.display.shown
    (entry,) = [control for control in unfolded(hand, "display") if control.name == shortcut.name]
    assert entry.is_on
    hand.gui.another_view().handle(Operate(shortcut.name))
    assert shortcut.name not in hand.gui.controls.display.shown


def test_a_press_is_for_what_is_there_now(env):
    other, hand = Hand(env), Hand(env)
    other.gui.overlay()
    rect = next(rect for control, rect in other.gui._controller.layout.places.items() if control.name == "view")
    hand.click((rect.x + 2, rect.y + 2))  # before anything was drawn
    assert "home" in {control.name for control in hand.gui.overlay().controls}


def test_menus_unfold_one_at_a_time(hand):
    assert {"front", "home"} <= {control.name for control in unfolded(hand, "view")}
    assert "floor" in {control.name for control in unfolded(hand, "display")}
    assert "front" not in {control.name for control in hand.gui.overlay().controls}
    assert "floor" not in {control.name for control in unfolded(hand, "display")}


def test_the_manual_has_the_same_table():
    page = REPOSITORY / "docs" / "viewer.md"
    assert as_markdown() in page.read_text(encoding="utf-8"), f"the table should be:\n{as_markdown()}"


# --- what a click or a drag would take


def test_in_interaction_mode_the_link_under_the_pointer_is_lit(hand, env):
    hand.gui.look_from(Camera(FROM_FRONT))
    at = hand.at([0.01, 0, -0.3])
    hand.lines(at)
    assert hand.gui.overlay().style.lit == -1, "in camera mode nothing is taken"
    assert hand.gui.overlay().cursor == "grab"
    hand.in_interaction()
    hand.lines(at)
    over = hand.gui.overlay()
    link = hand.gui.hover.body.scene.links[hand.gui.hover.link].name
    assert env.model.body(over.style.lit).name.endswith(link)
    assert over.cursor == "pointer"
    hand.lines((3, 300))
    assert hand.gui.overlay().style.lit == -1
    assert hand.gui.overlay().cursor == "default"


def test_faces_edges_and_cylinders_are_marked_under_the_pointer(hand):
    hand.gui.look_from(Camera(FROM_FRONT))
    hand.in_interaction().click(hand.at([0.01, 0, -0.3]))
    cube = Cube.around(hand.selection.body)
    plain = len(hand.gui.overlay().primitives.triangles.sizes)
    center, (x, y, _) = cube.T_world_cube[:3, 3], np.abs(cube.T_world_cube[:3, :3]) @ cube.half
    hand.lines(hand.at(center + np.array([x, 0, 0])))
    over = hand.gui.overlay()
    marked = over.primitives.triangles.corners[plain:].reshape(-1, 3)
    np.testing.assert_allclose(marked[:, 0], center[0] + x, atol=1e-9)
    assert over.cursor == "move"
    assert over.style.lit == -1
    edge_x, edge_y = hand.at(center + np.array([x, y, 0]))
    hand.lines((edge_x + 11, edge_y))  # edges catch within 12 points
    ends = hand.gui.overlay().primitives.lines.corners[-1]
    np.testing.assert_allclose(ends[:, :2], np.tile([center[0] + x, center[1] + y], (2, 1)), atol=1e-9)
    hand.lines((edge_x + 14, edge_y))
    assert hand.gui.overlay().cursor != "move"
    hand.click(hand.at([0.01, 0, -0.3]), ctrl=True)
    plain = len(hand.gui.overlay().primitives)
    hand.lines(hand.at(JointHandle.at(hand.selection.body, hand.selection.dof).center))
    assert len(hand.gui.overlay().primitives) > plain
    assert hand.gui.overlay().cursor == "move"
