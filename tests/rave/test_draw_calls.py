"""Draw calls and viewers as scripts use them: arguments, handles, threads, pictures and videos."""

import gc
import math
import threading
import time

import numpy as np
import pytest
from conftest import MODELS
from PIL import Image
from waiting import PATIENCE

import ravemj
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.gui.interaction import Key, Press, Release
from ravemj.gui.viewers import Viewer

P = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
T_AHEAD = np.array([[0, 0, 1, -3], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])  # from -3 m along world x
PINK = [255, 128, 128]


@pytest.fixture
def env():
    """An environment without bodies, seen along x on white by a viewer without a window."""
    env = ravemj.Environment()
    env.SetViewer("offscreen")
    env.GetViewer().SetCamera(T_AHEAD)
    env.GetViewer().SetBkgndColor([1, 1, 1])
    yield env
    env.Destroy()


def middle(picture):
    height, width, _ = picture.shape
    return picture[height // 2, width // 2].tolist()


def drawn(env):
    return len(env.simulation.drawings.primitives())


CALLS = {
    "plot3": lambda env: env.plot3(P, 4),
    "spheres": lambda env: env.plot3(points=P, pointsize=0.1, colors=[1, 0, 0], drawstyle=1),
    "one point": lambda env: env.plot3([1, 2, 3], 4.0),
    "flat": lambda env: env.plot3(np.zeros(9), 4, colors=np.ones((3, 4))),
    "strip": lambda env: env.drawlinestrip(P, 2.0, np.eye(3)),
    "strip of one point": lambda env: env.drawlinestrip(P[:1], 1),
    "list": lambda env: env.drawlinelist(points=P, linewidth=2, colors=[[0, 0, 1]], drawstyle=1),
    "arrow": lambda env: env.drawarrow([0, 0, 0], [1, 0, 0]),
    "arrow without length": lambda env: env.drawarrow(p1=[0, 0, 0], p2=[0, 0, 0], linewidth=0.1, color=[1, 0, 0, 1]),
    "box": lambda env: env.drawbox([0, 0, 0], [1, 1, 1], [0, 1, 0, 0.5]),
    "plane": lambda env: env.drawplane(np.eye(4), [1, 1], np.zeros((2, 2, 3))),
    "plane of bytes": lambda env: env.drawplane([1, 0, 0, 0, 0, 0, 0], [1, 1, 0], np.zeros((2, 2), dtype=np.uint8)),
    "mesh": lambda env: env.drawtrimesh(P),
    "indexed mesh": lambda env: env.drawtrimesh(P, np.array([[0, 1, 2]], dtype=np.int64), np.ones((3, 4))),
    "label": lambda env: env.drawlabel(label="goal", worldPosition=[1, 2, 3], color=[1, 0, 0], height=0.1),
    "flat mesh": lambda env: env.drawtrimesh(P.reshape(-1), [0, 1, 2, 2, 1, 0], [1, 0, 0]),
}


@pytest.mark.parametrize("name", CALLS)
def test_every_call_gives_a_handle_with_a_viewer_and_none_without(env, name):
    handle = CALLS[name](env)
    assert isinstance(handle, ravemj.GraphHandle)
    assert drawn(env) > 0 or "without" in name or "of one" in name
    del handle
    assert drawn(env) == 0
    assert CALLS[name](ravemj.Environment()) is None


WRONG = {
    "no points": (lambda env: env.plot3(np.zeros((0, 3)), 4), "points: has shape", "InvalidArguments"),
    "two columns": (lambda env: env.plot3(np.zeros((3, 2)), 4), r"has shape \(3, 2\)", "InvalidArguments"),
    "flat": (lambda env: env.drawlinestrip(np.zeros(8), 4), r"has shape \(8,\)", "InvalidArguments"),
    "words": (lambda env: env.plot3("here", 4), "should be numbers", "InvalidArguments"),
    "infinite": (lambda env: env.drawlinelist([0, 0, np.inf], 4), "finite", "InvalidArguments"),
    "number of colours": (lambda env: env.plot3(P, 4, P[:2]), "should be one colour or 3", "Failed"),
    "colour of two": (lambda env: env.plot3(P, 4, [1, 0]), "3 or 4 numbers", "Failed"),
    "colour": (lambda env: env.plot3(P, 4, [1, 0, np.nan]), "colors: should be finite", "InvalidArguments"),
    "size": (lambda env: env.plot3(P, -1), "pointsize: is -1", "InvalidArguments"),
    "sizes": (lambda env: env.plot3(P, [1, 2, 3]), "pointsize: has shape", "InvalidArguments"),
    "style": (lambda env: env.plot3(P, 1, None, 2), "drawstyle: is 2", "InvalidArguments"),
    "arrow": (lambda env: env.drawarrow([0, 0], [0, 0, 1]), "p1: has shape", "InvalidArguments"),
    "box": (lambda env: env.drawbox([0, 0, 0], 1), "extents: has shape", "InvalidArguments"),
    "plane": (
        lambda env: env.drawplane(np.ones((4, 4)), [1, 1], np.ones((2, 2, 3))),
        "transform: ",
        "InvalidArguments",
    ),
    "texture": (lambda env: env.drawplane(np.eye(4), [1, 1], np.ones((2, 2, 2))), "texture: ", "InvalidArguments"),
    "indices": (lambda env: env.drawtrimesh(P, [[0, 1, 3]]), "integers from 0 to 2", "InvalidArguments"),
    "pairs": (lambda env: env.drawtrimesh(P, [[0, 1]]), r"indices: has shape \(1, 2\)", "InvalidArguments"),
    "fractions": (lambda env: env.drawtrimesh(P, [[0, 1, 1.5]]), "integers", "InvalidArguments"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_arguments_raise_with_and_without_a_viewer(env, name):
    call, words, code = WRONG[name]
    for environment in (env, ravemj.Environment()):
        with pytest.raises(ArgumentError, match=words) as caught:
            call(environment)
        assert caught.value.GetCode() == code
    assert drawn(env) == 0


def test_handles_place_show_and_close(env):
    handle = env.plot3([0, 0, 0], 9)
    assert middle(env.render(160, 120)) == PINK
    for matrix in (np.eye(4), np.array([[1, 0, 0, 0], [0, 0, -1, 0.2], [0, 1, 0, 0]])):
        handle.SetTransform(matrix)
    assert middle(env.render(160, 120)) == [255, 255, 255]
    (column, row), *_ = env.GetViewer().camera.project([[0, 0.2, 0]], 160, 120)[0]
    assert env.render(160, 120)[int(row), int(column)].tolist() == PINK
    handle.SetTransform([1, 0, 0, 0, 0, 0, 0])
    assert middle(env.render(160, 120)) == PINK
    handle.SetShow(False)
    assert middle(env.render(160, 120)) == [255, 255, 255]
    handle.SetShow(1)
    assert middle(env.render(160, 120)) == PINK
    with pytest.raises(ArgumentError, match="SetTransform: transform: "):
        handle.SetTransform(np.diag([1, 2, 1, 1]))
    handle.Close()
    handle.Close()
    handle.SetShow(True)
    assert middle(env.render(160, 120)) == [255, 255, 255]
    with env.drawbox([0, 0, 0], [0.1, 0.1, 0.1]):
        assert middle(env.render(160, 120)) != [255, 255, 255]
    assert drawn(env) == 0


def test_drawings_vanish_with_their_handles_and_their_viewer(env):
    handles = [env.plot3(P, 3), env.drawarrow([0, 0, 0], [0, 0, 1])]
    circle = [env.plot3(P, 3)]
    circle.append(circle)
    assert drawn(env) > 6
    del circle
    gc.collect()
    handles.pop()
    assert drawn(env) == 3
    env.SetViewer("offscreen")
    assert drawn(env) == 0
    handles[0].Close()


def test_what_the_caller_changes_afterwards_changes_nothing(env):
    points, colors = np.zeros((1, 3)), np.array([0, 0, 1.0])
    handle = env.plot3(points, 9, colors)
    points[:], colors[:] = 5, 1
    assert middle(env.render(160, 120)) == [0, 0, 255]
    handle.Close()


def test_drawings_are_in_videos(models, tmp_path):
    env = ravemj.load(models / "env.xml")
    env.SetViewer("offscreen")
    env.GetViewer().SetCamera([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    handle = env.plot3([0, 0.3, 0.3], 7, [0, 1, 1])
    motion = ravemj.Motion.line([0, 0], [1, 0], 0.2)
    ravemj.record(env, tmp_path / "frames", motion, width=96, height=72, fps=10)
    (column, row), *_ = env.GetViewer().camera.project([[0, 0.3, 0.3]], 96, 72)[0]
    frames = sorted((tmp_path / "frames").iterdir())
    assert len(frames) > 1
    for frame in frames:
        assert np.asarray(Image.open(frame).convert("RGB"))[int(row), int(column)].tolist() == [0, 255, 255]
    handle.Close()


# --- threads


@pytest.mark.stress
def test_threads_draw_and_drop_while_pictures_are_drawn(env):
    failures, stop = [], threading.Event()

    def draw(seed):
        rng = np.random.default_rng(seed)
        kept = []
        try:
            while not stop.is_set():
                kept.append(env.plot3(rng.uniform(-1, 1, (5, 3)), 3))
                kept[-1].SetTransform(np.eye(4))
                kept[rng.integers(len(kept))].SetShow(False)
                cycle = [env.drawarrow([0, 0, 0], [0, 0, 1])]
                cycle.append(cycle)
                kept = kept[-20:]
                time.sleep(0.001)
        except Exception as error:
            failures.append(error)

    threads = [threading.Thread(target=draw, args=(seed,)) for seed in range(3)]
    for thread in threads:
        thread.start()
    try:
        for _ in range(8):
            env.render(64, 48)
    finally:
        stop.set()
    for thread in threads:
        thread.join(PATIENCE)
        assert not thread.is_alive()
    assert not failures
    gc.collect()
    assert drawn(env) == 0


def test_dropping_a_handle_waits_for_no_lock(env):
    handles = [env.plot3(P, 3)]
    with env:
        thread = threading.Thread(target=lambda: (env.plot3(P, 3), handles.pop()))
        thread.start()
        thread.join(PATIENCE)
        assert not thread.is_alive()
    assert drawn(env) == 0


# --- viewers


def test_the_log_says_which_viewer_was_chosen(env, caplog, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    caplog.set_level("INFO", "ravemj")
    for name, level, text in (
        ("qtcoin", "INFO", "viewer 'qtcoin' has no window"),
        ("offscreen", "INFO", "viewer 'offscreen' has no window"),
        ("window", "WARNING", "there is no display"),
    ):
        caplog.clear()
        assert env.SetViewer(name)
        assert env.GetViewer().GetXMLId() == name
        assert caplog.records[0].levelname == level
        assert text in caplog.records[0].message


def test_what_is_selected_is_told_and_may_be_refused():
    env = ravemj.load(MODELS / "env.xml")
    env.SetViewer("offscreen")
    viewer, robot = env.GetViewer(), env.GetRobots()[0]
    viewer.SetCamera([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    assert (viewer.GetSelectedBody(), viewer.GetSelectedLink(), viewer.GetSelectedJoint()) == (None, None, None)
    told = []
    handle = viewer.RegisterItemSelectionCallback(lambda *what: told.append(what))
    click(viewer, [0.01, 0, -0.3], Key("escape"), ctrl=True)
    assert viewer.GetSelectedBody() is robot
    assert viewer.GetSelectedLink() == robot.GetLinks()[2]
    assert viewer.GetSelectedJoint() == robot.GetJoints()[1]
    ((link, point, direction),) = told
    assert link == robot.GetLinks()[2]
    np.testing.assert_allclose(point, [0.01, 0, -0.3], atol=1e-9)
    np.testing.assert_allclose(direction, np.array([-0.99, 0, -0.3]) / np.hypot(0.99, 0.3), atol=1e-9)
    with_cylinder = viewer.render(96, 72)
    click(viewer, [0.01, 0, -0.3])
    assert viewer.GetSelectedJoint() is None
    handle.close()
    kept = viewer.RegisterItemSelectionCallback(lambda *_: True)
    click(viewer, [0.01, 0, -0.1], ctrl=True)
    assert viewer.GetSelectedBody() is None, "a callback that returns True has dealt with the click"
    kept.close()
    click(viewer, [0.01, 0, -0.1])
    env.Remove(robot)
    assert viewer.GetSelectedBody() is None
    assert len(told) == 2
    env.Add(robot)
    assert not np.array_equal(viewer.render(96, 72), with_cylinder)


def click(viewer, point, *events, **modifiers):
    ((x, y),), _ = viewer.camera.project([point], 640, 480)
    for event in (*events, Press(x, y, **modifiers), Release(x, y)):
        viewer.interaction.handle(event)


def test_viewers_are_found_by_name(env, caplog, monkeypatch):
    viewer = env.GetViewer()
    assert viewer.GetEnv() is env
    assert env.GetViewer("offscreen") is viewer
    assert env.GetViewer("") is viewer
    assert env.GetViewer("qtcoin") is None
    assert env.SetViewer("no-such-viewer") is True
    assert env.GetViewer() is viewer, "it stays"
    assert "there is no viewer 'no-such-viewer'" in caplog.text
    assert env.SetViewer("") is False
    monkeypatch.setenv("OPENRAVE_DEFAULT_VIEWER", "qtosg")
    assert env.SetDefaultViewer(showviewer=False) is True
    assert env.GetViewer().GetXMLId() == "qtosg"
    env.UpdatePublishedBodies()


def test_size_title_and_the_calls_of_windows(env):
    viewer = env.GetViewer()
    assert viewer.GetName() == "offscreen"
    viewer.SetTitle("mine")
    assert viewer.GetName() == "mine"
    viewer.SetName("ours")
    assert viewer.GetName() == "ours"
    viewer.SetSize(96, 48)
    assert viewer.render().shape == (48, 96, 3)
    assert viewer.render(32, 16).shape == (16, 32, 3)
    with pytest.raises(ArgumentError, match="0 x 5"):
        viewer.SetSize(0, 5)
    viewer.Move(1, 2)
    viewer.Show(0)
    viewer.EnvironmentSync()
    assert viewer.main(True) == 0
    viewer.quitmainloop()
    assert viewer.GetCameraDistanceToFocus() == 0
    viewer.SetCamera(T_AHEAD, 2.5)
    viewer.SetCamera(T_AHEAD)
    assert viewer.GetCameraDistanceToFocus() == 2.5


def test_camera_images_have_the_intrinsics_that_are_asked_for(env):
    viewer = env.GetViewer()
    viewer.SetSize(96, 72)
    handle = env.plot3([0, 0.5, 0.25], 5, [1, 0, 0])
    T = np.eye(4)
    T[:3, 3] = -0.1, 0.3, -2
    K = [120.0, 60.0, 70.0, 20.0]
    column, row = 120 * (0.1 / 2.25) + 70, 60 * (0.2 / 2.25) + 20
    assert (viewer.GetCameraImage(96, 72, T, K) == 255).all()
    assert viewer.SupportsCommand("SetFiguresInCamera")
    viewer.SendCommand("SetFiguresInCamera 1")
    image = viewer.GetCameraImage(96, 72, T, K)
    assert image.dtype == np.uint8
    assert image.shape == (72, 96, 3)
    assert image[int(row), int(column)].tolist() == [255, 0, 0]
    assert np.array_equal(viewer.GetCameraImage(0, 0, T, K), image)
    K = viewer.GetCameraIntrinsics().K
    own = viewer.GetCameraImage(96, 72, viewer.GetCameraTransform(), [K[0, 0], K[1, 1], K[0, 2], K[1, 2]])
    assert np.array_equal(own, viewer.render())
    viewer.SendCommand("SetFiguresInCamera 0")
    assert (viewer.GetCameraImage(96, 72, T, [60, 60, 9, 9]) == 255).all()
    for wrong, words in (([1, 2, 3], "K: has shape"), ([0, 1, 2, 3], "focal lengths"), ("none", "numbers")):
        with pytest.raises(ArgumentError, match=words):
            viewer.GetCameraImage(96, 72, T, wrong)
    handle.Close()


def test_commands_that_are_not_known(env):
    viewer = env.GetViewer()
    assert not viewer.SupportsCommand("Dance")
    for command in ("Dance", ""):
        with pytest.raises(RavemjError) as caught:
            viewer.SendCommand(command)
        assert caught.value.GetCode() == ErrorCode.CommandNotSupported.name
    with pytest.raises(ArgumentError, match="followed by 'yes'"):
        viewer.SendCommand("SetFiguresInCamera yes")


def test_callbacks_live_as_long_as_their_handles(env, caplog):
    viewer: Viewer = env.GetViewer()
    seen: list[tuple[int, ...]] = []
    handle = viewer.RegisterViewerImageCallback(lambda picture: seen.append(picture.shape))
    viewer.render(32, 16)
    with viewer.RegisterViewerImageCallback(lambda picture: seen.append("too many", picture)):
        viewer.render(32, 8)
    assert "callback failed" in caplog.text
    handle.Close()
    viewer.render(32, 16)
    assert seen == [(16, 32, 3), (8, 32, 3)]
    for register in (viewer.RegisterItemSelectionCallback, viewer.RegisterViewerThreadCallback):
        register(print).Close()
        with pytest.raises(ArgumentError, match="cannot be called"):
            register(None)


def test_labels_go_with_their_handles(env):
    def labels():
        return [(label.point.tolist(), label.text) for label in env.GetViewer().interaction.overlay().labels]

    handle = env.drawlabel("goal", [0.5, 0, 0], [1, 0, 0])
    other = ravemj.misc.DrawLabel(env, "start", [1, 2, 3])
    assert labels() == [([0.5, 0, 0], "goal"), ([1, 2, 3], "start")]
    handle.SetTransform([1, 0, 0, 0, 0, 0, 2])
    other.SetShow(False)
    assert labels() == [([0.5, 0, 2], "goal")]
    del handle
    gc.collect()
    assert labels() == []
    with pytest.raises(RavemjError, match="worldPosition"):
        env.drawlabel("goal", [1, 2])


def test_a_viewer_shows_one_text_of_the_user(env):
    viewer = env.GetViewer()
    viewer.SetUserText("one\ntwo")
    viewer.interaction.advance(time.monotonic() + 1e6)
    assert viewer.interaction.overlay().lines == ("one", "two")
    viewer.SetUserText(userText="three")
    assert viewer.interaction.overlay().lines == ("three",)
    viewer.SetUserText("")
    assert viewer.interaction.overlay().lines == ()


def test_the_text_in_the_corner_has_another_size(env):
    viewer = env.GetViewer()
    assert viewer.interaction.overlay().text_size is None
    before = viewer.interaction.appearance
    viewer.SetTextSize(size=20)
    assert viewer.interaction.overlay().text_size == 20
    assert viewer.interaction.appearance != before, "windows and pages draw it"
    for size in (0, -1, 1e9, math.nan, "large"):
        with pytest.raises(RavemjError, match="SetTextSize"):
            viewer.SetTextSize(size)
    assert viewer.interaction.overlay().text_size == 20
