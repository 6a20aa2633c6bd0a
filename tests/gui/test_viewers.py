"""Which viewer a name gives, what its methods do without a window, and what they refuse."""

import logging
import math
import sys
import types

import numpy as np
import pytest

import ravemj
from ravemj.errors import RenderingError
from ravemj.gui.interaction import Key, Move, Press, Release
from ravemj.gui.viewers import Viewer, notebook

FROM_FRONT = np.array([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
BOX = '<KinBody name="{}"><Body><Geom type="box"><extents>1 2 3</extents></Geom></Body></KinBody>'


@pytest.fixture
def viewer(env) -> Viewer:
    env.SetViewer("offscreen")
    return env.GetViewer()


class Bare(Viewer):
    """Stands for a window or a page."""

    url = "http://nowhere/"


@pytest.fixture
def opened(monkeypatch):
    """What was opened, where windows and pages are only pretended; there is neither a display nor a notebook."""
    kinds = []

    def pretend(kind):
        class Pretended(Bare):
            def __init__(self, simulation, renderer, name, **more):
                kinds.append(kind)
                super().__init__(simulation, renderer, name)

        return Pretended

    monkeypatch.setitem(sys.modules, "ravemj.gui.viewers.window", types.SimpleNamespace(WindowViewer=pretend("window")))
    monkeypatch.setitem(sys.modules, "ravemj.gui.viewers.web", types.SimpleNamespace(WebViewer=pretend("web")))
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(notebook, "show", lambda viewer: None)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    return kinds


def in_notebook(monkeypatch):
    shell = types.SimpleNamespace(kernel=None)
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))


class TestChoice:
    @pytest.mark.parametrize(
        ("name", "with_display", "in_a_notebook", "without"),
        [
            ("window", "window", "offscreen", "offscreen"),
            ("web", "web", "web", "web"),
            ("offscreen", "offscreen", "offscreen", "offscreen"),
            ("qtcoin", "window", "web", "offscreen"),
            ("qtosg", "window", "web", "offscreen"),
            ("qtogre", "window", "web", "offscreen"),
        ],
    )
    def test_a_name_gives_the_best_there_is(self, env, opened, monkeypatch, name, with_display, in_a_notebook, without):
        def kind():
            opened.clear()
            assert env.SetViewer(name) is True
            assert env.GetViewer().GetXMLId() == name
            return opened[0] if opened else "offscreen"

        assert kind() == without
        monkeypatch.setenv("WAYLAND_DISPLAY", "wayland-0")
        assert kind() == with_display
        monkeypatch.delenv("WAYLAND_DISPLAY")
        in_notebook(monkeypatch)
        assert kind() == in_a_notebook

    def test_a_terminal_of_ipython_is_no_notebook(self, env, opened, monkeypatch):
        shell = types.SimpleNamespace(config={})
        monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
        env.SetViewer("qtcoin")
        assert opened == []

    @pytest.mark.parametrize("name", ["window", "qtcoin", "web"])
    def test_on_macos_the_page_stands_for_windows(self, env, opened, monkeypatch, caplog, name):
        monkeypatch.setattr(sys, "platform", "darwin")
        monkeypatch.setenv("DISPLAY", ":0")
        with caplog.at_level(logging.INFO, "ravemj"):
            env.SetViewer(name)
        assert opened == ["web"]
        assert ("main thread on macOS" in caplog.text) == (name != "web")

    @pytest.mark.parametrize("name", ["window", "web", "qtcoin"])
    def test_without_showing_it_no_name_opens_anything(self, env, opened, monkeypatch, caplog, name):
        monkeypatch.setenv("DISPLAY", ":0")
        env.SetViewer(name, showviewer=False)
        assert opened == []
        assert not caplog.records

    def test_the_log_says_which_it_is(self, env, opened, monkeypatch, caplog):
        def said(name):
            caplog.clear()
            with caplog.at_level(logging.INFO, "ravemj"):
                env.SetViewer(name)
            return [record.getMessage() for record in caplog.records]

        assert said("qtcoin") == ["viewer 'qtcoin' has no window"]
        assert said("window")[0].startswith("no window can be opened: there is no display")
        in_notebook(monkeypatch)
        assert said("qtosg") == [
            "viewer 'qtosg' is a page in a browser: this is a notebook, and there is no display",
        ]
        assert said("web") == []
        monkeypatch.setenv("DISPLAY", ":0")
        assert said("qtcoin") == ["viewer 'qtcoin' is a window"]

    def test_a_display_that_fails_is_said_and_pictures_go_on(self, env, opened, monkeypatch, caplog):
        def fail(*arguments):
            raise RenderingError("no window can be opened: the display offers no OpenGL")

        monkeypatch.setenv("DISPLAY", ":0")
        monkeypatch.setitem(sys.modules, "ravemj.gui.viewers.window", types.SimpleNamespace(WindowViewer=fail))
        assert env.SetViewer("qtcoin") is True
        assert "the display offers no OpenGL; pictures are drawn without a window" in caplog.text
        assert env.GetViewer().render(64, 48).std() > 1

    def test_an_unknown_name_is_an_error_in_the_log_and_no_viewer(self, env, opened, caplog):
        assert env.SetViewer("qtcoins") is True
        assert env.GetViewer() is None
        assert "there is no viewer 'qtcoins'; the viewers are: window, web" in caplog.text


class TestFirstView:
    def test_bodies_that_come_after_the_viewer_are_looked_at_from_above(self, models):
        late, early = ravemj.Environment(), ravemj.load(models / "env.xml")
        for env in (late, early):
            env.SetViewer("offscreen")
        late.Load(models / "env.xml")
        T_world_camera = late.GetViewer().GetCameraTransform()
        np.testing.assert_array_equal(T_world_camera, early.GetViewer().GetCameraTransform())
        np.testing.assert_array_equal(T_world_camera[:3, :3], np.diag([1, -1, -1]))

    def test_a_body_made_in_code_is_looked_at_and_the_next_ones_change_nothing(self):
        env = ravemj.Environment()
        env.SetViewer("offscreen")
        heights = []
        for number in (1, 2):
            body = ravemj.RaveCreateKinBody(env, "")
            body.InitFromBoxes(np.array([[10 * number, 0, 0, 1, 2, 3]]))
            body.SetName(f"box{number}")
            env.Add(body)
            T_world_camera = env.GetViewer().GetCameraTransform()
            heights.append(T_world_camera[2, 3])
            np.testing.assert_allclose(T_world_camera[:2, 3], [10, 0], atol=1e-9)
        assert heights[0] == heights[1] > 3

    def test_a_camera_that_somebody_chose_stays(self):
        env = ravemj.Environment()
        env.SetViewer("offscreen")
        env.GetViewer().SetCamera(FROM_FRONT)
        env.LoadData(BOX.format("a"))
        np.testing.assert_array_equal(env.GetViewer().GetCameraTransform(), FROM_FRONT)

    def test_a_file_s_camera_and_background_go_to_the_viewer_as_openrave_s_do(self, viewer, env):
        viewer.SetBkgndColor([0, 1, 0])
        env.LoadData(BOX.format("a"))
        assert viewer.background == (0, 1, 0), "a body says nothing about it"
        before = viewer.GetCameraTransform()
        env.LoadData("<Environment><bkgndcolor>1 0 0</bkgndcolor></Environment>")
        assert viewer.background == (1, 0, 0)
        np.testing.assert_array_equal(viewer.GetCameraTransform(), before)
        env.LoadData(
            "<Environment><camtrans>1 2 3</camtrans><camrotationaxis>1 0 0 180</camrotationaxis></Environment>"
        )
        np.testing.assert_allclose(viewer.GetCameraTransform()[:3, 3], [1, 2, 3])
        assert viewer.background == (1, 1, 1)


class TestWrongArguments:
    @pytest.mark.parametrize("focal", [math.nan, math.inf, "near", None, [1, 2]])
    def test_focal_distances(self, viewer, focal):
        before = viewer.GetCameraTransform()
        with pytest.raises(ravemj.ArgumentError, match="focalDistance"):
            viewer.SetCamera(FROM_FRONT, focal)
        np.testing.assert_array_equal(viewer.GetCameraTransform(), before)

    def test_no_focal_distance_keeps_the_old_one(self, viewer):
        viewer.SetCamera(FROM_FRONT, 0.7)
        for nothing in (0, -1):
            viewer.SetCamera(FROM_FRONT, nothing)
            assert viewer.GetCameraDistanceToFocus() == 0.7

    @pytest.mark.parametrize(
        "camera",
        [np.full((4, 4), math.nan), np.zeros((4, 4)), np.diag([1, 1, -1, 1]), [1, 2], "x", None, 1e300 * FROM_FRONT],
    )
    def test_cameras(self, viewer, camera):
        before = viewer.GetCameraTransform()
        with pytest.raises(ravemj.ArgumentError):
            viewer.SetCamera(camera)
        np.testing.assert_array_equal(viewer.GetCameraTransform(), before)

    @pytest.mark.parametrize("size", [(-1, 5), (5, 0), (1e9, 10), ("a", 1), (math.nan, 1), (None, None), (0.5, 10)])
    def test_sizes(self, viewer, size):
        viewer.SetSize(64, 48)
        with pytest.raises(ravemj.ArgumentError, match="SetSize"):
            viewer.SetSize(*size)
        assert viewer.render().shape == (48, 64, 3)

    @pytest.mark.parametrize("size", [(-1, 5), (10**6, 10**6), ("a", 1), (5, math.inf)])
    def test_sizes_of_pictures(self, viewer, size):
        with pytest.raises(ravemj.ArgumentError, match="GetCameraImage"):
            viewer.GetCameraImage(*size, FROM_FRONT, [10, 10, 5, 5])
        with pytest.raises(ravemj.ArgumentError, match="render"):
            viewer.render(*size)


class TestEndings:
    def test_a_second_viewer_replaces_the_first(self, env, viewer):
        handle = env.plot3([0, 0, 0], 5)
        env.SetViewer("offscreen")
        assert env.GetViewer() is not viewer
        del handle
        assert viewer.render(64, 48).std() > 1, "who has kept it can use it"

    def test_a_viewer_of_a_destroyed_environment_shows_an_empty_world(self, env, viewer):
        viewer.SetCamera(FROM_FRONT)
        viewer.SetBkgndColor([1, 1, 1])
        viewer.interaction.handle(Key("escape"))
        env.Destroy()
        for event in (Move(320, 300), Press(320, 300), Move(350, 320), Release(350, 320)):
            viewer.interaction.handle(event)
        assert viewer.interaction.overlay().lines == ()
        assert (viewer.GetSelectedBody(), viewer.GetSelectedLink(), viewer.GetSelectedJoint()) == (None, None, None)
        assert viewer.render(64, 48).std() == 0
        viewer.SetCamera(FROM_FRONT)
        assert viewer.main() == 0
        viewer.quitmainloop()

    def test_a_body_that_is_removed_while_it_is_selected(self, env, robot, viewer):
        viewer.SetCamera(FROM_FRONT)
        viewer.SetBkgndColor([1, 1, 1])
        viewer.SetSize(640, 480)
        ((x, y),), _ = viewer.camera.project([(0.01, 0, -0.3)], 640, 480)
        viewer.interaction.handle(Key("escape"))
        for event in (Press(x, y, ctrl=True), Release(x, y)):
            viewer.interaction.handle(event)
        selected = viewer.GetSelectedBody(), viewer.GetSelectedLink().GetName(), viewer.GetSelectedJoint().GetName()
        assert selected == (robot, "Arm1", "Joint1")
        env.Remove(robot)
        assert viewer.GetSelectedJoint() is None
        viewer.interaction.handle(Press(x, y))
        assert viewer.render(64, 48).std() == 0


class TestSeveral:
    def test_each_has_a_camera_and_all_show_the_same_world(self, env, robot, viewer):
        other = ravemj.RaveCreateViewer(env, "offscreen")
        assert env.GetViewer() is viewer is not other
        env.Add(other)  # it is there already
        viewer.SetCamera(FROM_FRONT)
        other.SetCamera([[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 2]])
        pictures = [one.render(240, 180) for one in (viewer, other)]
        assert not np.array_equal(*pictures)
        robot.SetDOFValues([1, 1])
        for one, before in zip((viewer, other), pictures, strict=True):
            assert not np.array_equal(one.render(240, 180), before)
        viewer.interaction.handle(Key("escape"))
        ((x, y),), _ = viewer.camera.project([(0, 0, 0.02)], 640, 480)
        for event in (Press(x, y), Release(x, y)):
            viewer.interaction.handle(event)
        assert viewer.GetSelectedBody() is robot
        assert other.GetSelectedBody() is None

    def test_they_come_by_name_and_go_one_by_one_or_together(self, env, opened, viewer):
        page, second = (ravemj.RaveCreateViewer(env, name) for name in ("web", "offscreen"))
        assert [env.GetViewer(name) for name in ("", "web", "offscreen", "qtcoin")] == [viewer, page, viewer, None]
        assert env.Remove(viewer) is True
        assert env.Remove(viewer) is False
        assert env.GetViewer() is page
        with pytest.raises(ravemj.ArgumentError):
            env.Add(viewer)
        env.SetViewer("qtcoin")
        assert env.GetViewer("web") is env.GetViewer("offscreen") is None
        assert second.render(8, 8).shape == (8, 8, 3)
        assert ravemj.RaveCreateViewer(env, "qtcoins") is None
        env.Destroy()
        assert env.GetViewer() is None
        with pytest.raises(ravemj.openrave_exception):
            ravemj.RaveCreateViewer(env, "web")
