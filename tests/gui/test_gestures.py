"""Gestures that are interrupted, and keys of other alphabets: nothing goes on by itself, nothing is forgotten."""

import types

import numpy as np
import pytest

import ravemj
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import Button, Interaction, Key, Leave, Move, Press, Release, Resize, Type, Wheel
from ravemj.gui.interaction.cube import Cube
from ravemj.gui.viewers.glfw_window import GlfwWindow

SIZE = 800, 600
FROM_FRONT = np.array([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
START, WAY = (100, 100), (150, 130)


@pytest.fixture
def gui(env) -> Interaction:
    gui = Interaction.first_view(env.simulation, Camera(FROM_FRONT), SIZE)
    gui.look_from(Camera(FROM_FRONT), 1.0)
    return gui


def do(gui, *events) -> None:
    for event in events:
        gui.handle(event)


def camera(gui):
    return gui.view.camera.T_world_camera.copy()


@pytest.mark.parametrize("press", [Press(*START), Press(*START, shift=True), Press(*START, Button.MIDDLE)])
def test_who_leaves_the_window_ends_a_drag(gui, press):
    do(gui, press, Move(*WAY))
    moved = camera(gui)
    assert not np.array_equal(moved, FROM_FRONT)
    do(gui, Leave(), Move(300, 300), Move(400, 10))
    np.testing.assert_array_equal(camera(gui), moved)


def test_who_leaves_the_window_has_let_go_of_s(gui):
    do(gui, Key("s"), Leave(), Press(400, 400), Release(400, 400))
    np.testing.assert_array_equal(camera(gui), FROM_FRONT)


def test_a_release_ends_a_drag_and_one_of_another_button_does_nothing(gui):
    do(gui, Press(*START), Move(*WAY), Release(*WAY))
    moved = camera(gui)
    do(gui, Move(10, 10), Release(10, 10, Button.RIGHT), Move(20, 300))
    np.testing.assert_array_equal(camera(gui), moved)


@pytest.mark.parametrize("buttons", [(Button.LEFT, Button.MIDDLE), (Button.MIDDLE, Button.LEFT)])
def test_left_and_middle_zoom_in_either_order(gui, buttons):
    do(gui, *(Press(*START, button) for button in buttons), Move(100, 200))
    np.testing.assert_allclose(camera(gui)[:3, :3], FROM_FRONT[:3, :3], atol=1e-12)
    np.testing.assert_allclose(camera(gui)[:3, 3], [np.exp(-4 * 100 / 600), 0, 0], atol=1e-12)


def test_a_script_s_camera_goes_before_the_mouse_s(gui):
    other = FROM_FRONT.copy()
    other[0, 3] = 3
    do(gui, Press(*START), Move(*WAY))
    gui.look_from(Camera(other))
    do(gui, Move(300, 300), Release(300, 300))
    np.testing.assert_array_equal(camera(gui), other)


def test_another_mode_in_the_middle_of_a_drag_ends_it(gui, robot):
    do(gui, Press(*START), Move(*WAY))
    moved = camera(gui)
    do(gui, Key("escape"), Move(300, 300), Release(300, 300))
    np.testing.assert_array_equal(camera(gui), moved)
    assert gui.selection is None
    assert not robot.GetDOFValues().any()


def test_a_view_that_is_resized_in_the_middle_of_a_drag_keeps_its_new_size(gui):
    do(gui, Press(*START), Resize(400, 300), Move(*WAY), Release(*WAY))
    assert gui.view.size == (400, 300)


def test_a_body_that_the_script_moves_while_the_user_drags_it_follows_the_pointer(gui, robot):
    def at(point):
        ((x, y),), _ = gui.view.camera.project([point], *SIZE)
        return float(x), float(y)

    inside = at([0.01, 0, -0.3])
    do(gui, Key("escape"), Press(*inside), Release(*inside))
    cube = Cube.around(robot.simulation_state)
    held = at(cube.T_world_cube[:3, 3])
    T = robot.GetTransform()
    do(gui, Press(*held), Move(held[0] + 30, held[1]))
    robot.SetTransform([1, 0, 0, 0, 5, 5, 5])
    do(gui, Move(held[0] + 60, held[1]), Release(held[0] + 60, held[1]))
    assert robot.GetTransform()[1, 3] > 0.05
    np.testing.assert_allclose(robot.GetTransform()[[0, 2], 3], T[[0, 2], 3], atol=1e-9)


def test_any_sequence_of_events_leaves_numbers_that_are_finite(gui, robot):
    rng = np.random.default_rng(3)
    names = ["escape", "s", "x"]

    def some_event():
        x, y = rng.uniform(-100, 900, 2).tolist()
        button = list(Button)[rng.integers(3)]
        ctrl, shift = (rng.random(2) < 0.3).tolist()
        kinds = [
            Press(x, y, button, ctrl, shift),
            Release(x, y, button),
            *[Move(x, y)] * 4,
            Wheel(float(rng.normal())),
            Key(names[rng.integers(3)], bool(rng.random() < 0.5)),
            Resize(*map(int, rng.integers(0, 900, 2))),
            Leave(),
        ]
        return kinds[rng.integers(len(kinds))]

    for _ in range(1500):
        gui.handle(some_event())
        T_world_camera = gui.view.camera.T_world_camera
        np.testing.assert_allclose(T_world_camera[:3, :3].T @ T_world_camera[:3, :3], np.eye(3), atol=1e-6)
        assert np.isfinite(T_world_camera).all()
        assert np.isfinite(robot.GetDOFValues()).all()
        assert np.isfinite(robot.GetTransform()).all()
        gui.overlay()


@pytest.mark.parametrize(
    ("key", "on_keyboard", "expected"),
    [
        (256, None, ["escape"]),
        (83, "s", ["s"]),
        (59, "s", ["s"]),  # Dvorak
        (83, "ы", ["S"]),
        (341, None, []),
    ],
)
def test_keys_are_named_on_every_keyboard(key, on_keyboard, expected):
    window = GlfwWindow.__new__(GlfwWindow)
    window.events, window._keys = [], {256: "escape"}
    window._glfw = types.SimpleNamespace(
        KEY_ESCAPE=256,
        KEY_SPACE=32,
        KEY_LEFT=263,
        KEY_RIGHT=262,
        PRESS=1,
        REPEAT=2,
        MOD_CONTROL=2,
        MOD_ALT=4,
        MOD_SUPER=8,
        get_key_name=lambda *_: on_keyboard,
    )
    for action in (1, 2, 2, 0):
        window._on_key(None, key, 0, action, 0)
    assert window.events == [Key(name, pressed) for pressed in (True, False) for name in expected]


def test_letters_with_ctrl_or_alt_are_no_keys_of_the_view():
    window = GlfwWindow.__new__(GlfwWindow)
    window.events, window._keys = [], {}
    names = {"MOD_CONTROL": 2, "MOD_ALT": 4, "MOD_SUPER": 8, "PRESS": 1, "REPEAT": 2}
    window._glfw = types.SimpleNamespace(**names, get_key_name=lambda *_: "f")
    for mods in (2, 4, 8, 1):
        window._on_key(None, 70, 0, 1, mods)
    assert window.events == [Key("f")]


def test_letters_are_typed_and_backspace_repeats_while_it_is_held():
    window = GlfwWindow.__new__(GlfwWindow)
    window.events, window._keys = [], {259: "backspace"}
    names = {"MOD_CONTROL": 2, "MOD_ALT": 4, "MOD_SUPER": 8, "PRESS": 1, "REPEAT": 2}
    window._glfw = types.SimpleNamespace(**names)
    for letter in "é?":
        window._on_letter(None, ord(letter))
    assert window.events == [Type("é"), Type("?"), Key("?"), Key("?", False)]
    window.events = []
    for action in (1, 2, 2, 0):
        window._on_key(None, 259, 0, action, 0)
    assert window.events == [Key("backspace")] * 3 + [Key("backspace", False)]


def test_a_camera_comes_back_as_it_was_given(env):
    rng = np.random.default_rng(5)
    env.SetViewer("offscreen")
    viewer = env.GetViewer()
    for _ in range(50):
        pose = np.append(rng.normal(size=4), rng.normal(size=3))
        pose[:4] /= np.linalg.norm(pose[:4])
        T = ravemj.matrixFromPose(pose)
        viewer.SetCamera(T)
        np.testing.assert_array_equal(viewer.GetCameraTransform(), T)
        viewer.SetCamera(viewer.GetCameraTransform().tolist(), 0.3)
        np.testing.assert_array_equal(viewer.GetCameraTransform(), T)
        viewer.SetCamera(pose)
        np.testing.assert_allclose(viewer.GetCameraTransform(), T, atol=1e-12)
        viewer.SetCamera(T[:3])
        np.testing.assert_array_equal(viewer.GetCameraTransform(), T)
