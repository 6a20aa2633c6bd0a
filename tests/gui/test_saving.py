"""Pictures and videos that people save from a viewer: where they go, and what is in them."""

import gc
import re
import threading
import time
import weakref
from pathlib import Path
from types import SimpleNamespace

import imageio.v3
import numpy as np
import pytest
from command_line import colour_of
from waiting import PATIENCE, await_that

import ravemj
from ravemj.gui.viewers import recorder
from ravemj.gui.viewers.recorder import FrameSource, Recorder, free_path
from ravemj.gui.viewers.window import WindowViewer

SIZE = 320, 240
SWING = ravemj.Motion.line([0, 0], [np.pi, 0], 0.4)


@pytest.fixture
def viewer(env, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    env.SetViewer("offscreen")
    viewer = env.GetViewer()
    viewer.SetSize(*SIZE)
    viewer.SetCamera([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    yield viewer
    viewer.close()


def look(viewer) -> FrameSource:
    return FrameSource(viewer.interaction, viewer._renderer, viewer.look)


def record(viewer) -> None:
    viewer._recorder.record(look(viewer), viewer.playback)


def wait_for(viewer) -> str:
    """Wait until something is saved, and return what the viewer says about it."""
    notices = viewer.interaction.controls.notices
    await_that(lambda: notices.lines and not notices.recording)
    return notices.lines[-1]


def shows(viewer, frame, angle: float) -> bool:
    """Whether a frame shows the pendulum's blue arm where the first joint has an angle."""
    tip = 0.35 * np.array([0, np.sin(angle), -np.cos(angle)])
    ((x, y),), _ = viewer.camera.project([tip], *SIZE)
    return colour_of(frame[round(y), round(x)]) == "blue"


def test_names_are_free(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    then = time.mktime((2026, 1, 2, 3, 4, 5, 0, 0, -1))
    names = []
    for _ in range(3):
        names.append(str(free_path(".png", lambda: then)))
        Path(names[-1]).touch()
    assert names == [f"ravemj-20260102-030405{more}.png" for more in ("", "-2", "-3")]
    assert str(free_path(".mp4", lambda: then)) == "ravemj-20260102-030405.mp4"


def test_a_picture_is_saved_whole_and_the_viewer_says_where(viewer, tmp_path):
    picture = viewer.render()
    viewer._recorder.save_picture(look(viewer))
    said = wait_for(viewer)
    (file,) = tmp_path.iterdir()
    assert said == f"Saved {file.name} in {tmp_path}"
    assert re.fullmatch(r"ravemj-\d{8}-\d{6}\.png", file.name)
    assert np.array_equal(imageio.v3.imread(file), picture)


def test_what_cannot_be_saved_is_said_and_leaves_nothing(viewer, tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("imageio.v3.imwrite", full)
    viewer._recorder.save_picture(look(viewer))
    assert re.fullmatch(r"cannot write ravemj-[-\d]+\.png: no space left on device", wait_for(viewer))
    assert not list(tmp_path.iterdir())


def test_a_video_of_a_motion_has_each_frame_at_its_time(viewer, robot, tmp_path):
    viewer.play(SWING, speed=0.5)
    viewer.playback.seek(0.3)
    record(viewer)
    said = wait_for(viewer)
    (file,) = tmp_path.iterdir()
    assert said == f"Saved {file.name} in {tmp_path}"
    video = imageio.v3.imread(file)
    assert video.shape == (25, 240, 320, 3)  # 0.8 s, both ends
    assert imageio.v3.immeta(file)["fps"] == 30
    for frame in (0, 6, 12, 18, 24):
        assert shows(viewer, video[frame], frame / 24 * np.pi), frame
    np.testing.assert_allclose(robot.GetDOFValues(), [np.pi, 0])
    assert not viewer.playback.playing


class Clock(threading.Event):
    """A clock that waiting turns, in no time."""

    now = 0.0

    def wait(self, timeout=None):
        self.now += timeout or 0
        return self.is_set()


def test_without_a_motion_a_video_is_what_happens_until_it_is_stopped(viewer, robot, tmp_path):
    clock, notices = Clock(), viewer.interaction.controls.notices
    viewer._recorder = Recorder(notices, lambda: clock.now)
    viewer._recorder._stop = clock
    record(viewer)
    assert notices.recording
    assert viewer.interaction.controls.all()[1].label == "Stop recording"
    await_that(lambda: clock.now > 0.5)
    robot.SetDOFValues([np.pi, 0])
    seen = clock.now
    await_that(lambda: clock.now > seen + 0.5)
    assert list(tmp_path.glob("*.mp4")) == []
    record(viewer)
    wait_for(viewer)
    (file,) = tmp_path.iterdir()
    video = imageio.v3.imread(file)
    assert len(video) == pytest.approx(30 * clock.now, abs=2)
    assert shows(viewer, video[0], 0.0)
    assert shows(viewer, video[-1], np.pi)
    assert viewer.interaction.controls.all()[1].label == "Record a video (MP4)"


@pytest.mark.stress
def test_another_motion_ends_a_video(viewer, tmp_path):
    viewer.play(ravemj.Motion.line([0, 0], [np.pi, 0], 600.0))
    record(viewer)
    await_that(lambda: viewer.playback.time > 0.1)
    viewer.play(SWING)
    wait_for(viewer)
    (file,) = tmp_path.iterdir()
    assert 3 <= len(imageio.v3.imread(file)) < 30 * 600


@pytest.mark.stress
def test_a_viewer_that_closes_ends_its_video_and_leaves_whole_files(viewer, tmp_path, monkeypatch):
    monkeypatch.setattr(recorder, "_LONGEST_END", PATIENCE)
    record(viewer)
    await_that(lambda: list(tmp_path.iterdir()))
    viewer._recorder.save_picture(look(viewer))
    viewer.close()
    assert sorted(file.suffix for file in tmp_path.iterdir()) == [".mp4", ".png"]
    for file in tmp_path.iterdir():
        assert imageio.v3.imread(file).size
    assert not any(thread.name == "ravemj saving" for thread in threading.enumerate())


def test_a_video_that_no_page_takes_is_logged(viewer, env, caplog):
    page = env.serve_viewer()
    page._keep_video(page.interaction, "ravemj-1.mp4", b"")
    env.SetViewer("")
    assert "the video ravemj-1.mp4 is lost: no page was there to take it" in caplog.text


def test_copying_raises_no_warning(viewer):
    re.purge()  # which has compiled expressions, and warns while it compiles them
    copied = []
    window = SimpleNamespace(pixel_ratio=1.0, copy_text=copied.append)
    WindowViewer._grant(viewer, "viewer.SetCamera([[1, 0], [0, 1]])", window)
    assert copied == ["viewer.SetCamera([[1, 0], [0, 1]])"]
    assert "Copied viewer.SetCamera([...])" in viewer.interaction.controls.notices.lines


def test_a_video_does_not_keep_a_forgotten_environment(models, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    env = ravemj.load(models / "env.xml")
    env.SetViewer("offscreen")
    env.GetViewer().SetSize(64, 48)
    source, drawn = look(env.GetViewer()), []
    frame = source.frame
    source.frame = lambda: drawn.append(frame()) or drawn[-1]
    env.GetViewer()._recorder.record(source, env.GetViewer().playback)
    await_that(lambda: drawn)
    reference = weakref.ref(env)
    del env

    def is_gone():
        gc.collect()
        return reference() is None and not any(thread.name == "ravemj saving" for thread in threading.enumerate())

    await_that(is_gone)
    assert len(list(tmp_path.glob("*.mp4"))) == 1
