"""Videos and pictures, read back with the libraries that players use."""

import errno
import logging
import os
import re
import signal
import subprocess
import sys
import textwrap
import threading
import time
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import av
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from waiting import PATIENCE

import ravemj.graphics.video
from ravemj.errors import ArgumentError, OutputError
from ravemj.graphics.video import check_target, write_frames, write_picture

TARGETS = ["video.mp4", "video.avi", "video.mpg", "video.gif", "video.webp", "video"]
SKY = (204, 217, 230)


def flat(colour=SKY, size=(48, 64)):
    return np.full((*size, 3), colour, np.uint8)


def shades(count, size=(48, 64)):
    """Frames that all differ."""
    return [flat((10 + 20 * (k % 12), 100, k // 12), size) for k in range(count)]


def decode(path):
    with av.open(str(path)) as container:
        pictures = list(container.decode(video=0))
        stream = container.streams.video[0]  # a closed one says nothing in newer versions of PyAV
        names = ("width", "height", "average_rate", "codec_context")
        return SimpleNamespace(**{name: getattr(stream, name) for name in names}), pictures


def rgb(picture):
    """Convert by the definition of BT.709 in limited range, as browsers do; PyAV before 17 takes BT.601."""
    height, width = picture.height, picture.width
    y, u, v = np.split(picture.to_ndarray().astype(float).ravel(), [height * width, height * width * 5 // 4])
    cb, cr = (np.kron(plane.reshape(height // 2, width // 2) - 128, np.ones((2, 2))) / 224 for plane in (u, v))
    y = (y.reshape(height, width) - 16) / 219
    red, blue = y + 1.5748 * cr, y + 1.8556 * cb
    green = (y - 0.2126 * red - 0.0722 * blue) / 0.7152
    return 255 * np.stack([red, green, blue], axis=-1)


@pytest.fixture(autouse=True)
def nothing_left_behind(tmp_path):
    yield
    assert not [entry for entry in tmp_path.rglob("*") if entry.name.startswith(".ravemj")]
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("ravemj")]


@pytest.fixture(params=TARGETS)
def target(request, tmp_path):
    return tmp_path / request.param


def content(target):
    if target.is_dir():
        return {entry.name: entry.read_bytes() for entry in target.iterdir()}
    return target.read_bytes()


@pytest.fixture
def old(target):
    """The target as an earlier run left it."""
    write_frames(target, shades(2, (8, 8)), 10)
    return content(target)


# MP4


@pytest.mark.parametrize("colour", [SKY, (255, 255, 255), (0, 0, 0), (255, 0, 0), (0, 128, 0), (10, 20, 200)])
def test_mp4_has_true_colours(tmp_path, colour):
    write_frames(tmp_path / "a.mp4", [flat(colour)] * 5, 30)
    stream, pictures = decode(tmp_path / "a.mp4")
    np.testing.assert_allclose(rgb(pictures[3]).mean(axis=(0, 1)), colour, atol=2)
    codec = stream.codec_context
    tags = (codec.colorspace, codec.color_range, codec.color_primaries, codec.color_trc)
    assert tags == (1, 1, 1, 13)  # BT.709, limited, BT.709, sRGB


@pytest.mark.parametrize("fps", [30, 29.97, Fraction(30000, 1001), 12.5, 0.01, 1000])
def test_mp4_is_what_browsers_play(tmp_path, fps):
    assert write_frames(tmp_path / "a.mp4", shades(9), fps) == tmp_path / "a.mp4"
    stream, pictures = decode(tmp_path / "a.mp4")
    assert (stream.codec_context.name, pictures[0].format.name) == ("h264", "yuv420p")
    assert (stream.width, stream.height) == (64, 48)
    assert float(stream.average_rate) == pytest.approx(float(fps))
    assert [picture.time for picture in pictures] == pytest.approx([k / float(fps) for k in range(9)], rel=1e-3)
    reds = [rgb(picture)[..., 0].mean() for picture in pictures]
    assert reds == pytest.approx([10 + 20 * k for k in range(9)], abs=2)
    data = (tmp_path / "a.mp4").read_bytes()
    assert data.index(b"moov") < data.index(b"mdat")  # players can start before the end has arrived


@pytest.mark.parametrize("size", [(47, 63), (1, 1), (48, 63), (47, 64)])
def test_odd_sizes_are_padded_not_scaled(tmp_path, size):
    rng = np.random.default_rng(0)
    frame = np.kron(rng.integers(0, 2, (size[0] // 8 + 1, size[1] // 8 + 1, 1)) * 255, np.ones((8, 8, 3)))
    frame = frame[: size[0], : size[1]].astype(np.uint8)
    write_frames(tmp_path / "a.mp4", [frame] * 3, 30)
    picture = rgb(decode(tmp_path / "a.mp4")[1][-1])
    assert picture.shape[:2] == tuple(n + n % 2 for n in size)
    padded = np.pad(frame, [(0, n % 2) for n in size] + [(0, 0)], mode="edge")
    assert np.abs(picture - padded).mean() < 6


@pytest.mark.parametrize(("suffix", "codec"), [(".avi", "h264"), (".mpg", "mpeg2video")])
@pytest.mark.parametrize("fps", [30, 12.5, 0.5])
def test_formats_of_old_scripts_keep_colours_and_time(tmp_path, suffix, codec, fps):
    write_frames(tmp_path / f"a{suffix}", shades(9), fps)
    stream, pictures = decode(tmp_path / f"a{suffix}")
    assert stream.codec_context.name == codec
    assert suffix == ".avi" or stream.average_rate == 30
    times = np.array([picture.time for picture in pictures[:-1]])  # the last one of an MPG has no exact time
    reds = [rgb(picture)[..., 0].mean() for picture in pictures[:-1]]
    shown = np.floor((times - times[0]) * fps + 1e-6)
    assert reds == pytest.approx(10 + 20 * shown, abs=3)
    assert len(pictures) == pytest.approx(9 * float(stream.average_rate) / fps, abs=1)


# GIF, WebP, PNG


@pytest.mark.parametrize(("suffix", "fps"), [(".gif", 30), (".gif", 50), (".webp", 30), (".webp", 60)])
def test_gif_and_webp(tmp_path, suffix, fps):
    path = tmp_path / f"a{suffix}"
    write_frames(path, shades(12), fps)
    grain = 10 if suffix == ".gif" else 1
    begin = 0
    with Image.open(path) as image:
        assert (image.size, image.n_frames, image.info["loop"]) == ((64, 48), 12, 0)
        for k, frame in enumerate(shades(12)):
            image.seek(k)
            shown = np.asarray(image.convert("RGB")).astype(float)
            np.testing.assert_allclose(shown.mean(axis=(0, 1)), frame[0, 0], atol=3)
            assert begin == pytest.approx(1000 * k / fps, abs=grain / 2)
            begin += image.info["duration"]
    assert begin == pytest.approx(1000 * 12 / fps, abs=grain / 2)


def test_gif_palette_is_good_enough_for_shading(tmp_path):
    y, x = np.mgrid[0:96, 0:128]
    frame = np.stack([x * 2, y * 2, 255 - x], axis=-1).astype(np.uint8)
    write_frames(tmp_path / "a.gif", [frame], 10)
    with Image.open(tmp_path / "a.gif") as image:
        assert np.abs(np.asarray(image.convert("RGB")).astype(int) - frame).mean() < 8


@pytest.mark.parametrize(("suffix", "frames"), [(".gif", 301), (".webp", 301), (".mp4", 301), (".gif", 300)])
def test_long_gif_and_webp_are_logged_once(tmp_path, caplog, suffix, frames):
    with caplog.at_level(logging.WARNING, "ravemj"):
        write_frames(tmp_path / f"a{suffix}", shades(frames, (2, 2)), 30)
    assert len(caplog.records) == (suffix != ".mp4" and frames > 300)


@pytest.mark.parametrize("name", ["folder", "folder/", "folder.mp4/"])
def test_folder_of_png(tmp_path, name):
    write_frames(f"{tmp_path}/{name}", shades(11), 30)
    folder = tmp_path / name
    assert sorted(os.listdir(folder)) == [f"frame_{k:05d}.png" for k in range(11)]
    for k, frame in enumerate(shades(11)):
        with Image.open(folder / f"frame_{k:05d}.png") as image:
            np.testing.assert_array_equal(np.asarray(image), frame)


def test_folder_is_replaced_only_if_it_is_one_of_ours(tmp_path):
    folder = tmp_path / "frames"
    write_frames(folder, shades(5), 30)
    write_frames(folder, shades(2), 30)
    assert len(content(folder)) == 2
    (folder / "notes.txt").write_text("mine")
    before = content(folder)
    with pytest.raises(OutputError, match=r"contains notes\.txt, not only frame_\*\.png"):
        check_target(folder)
    with pytest.raises(OutputError, match=r"notes\.txt"):
        write_frames(folder, shades(1), 30)
    assert content(folder) == before


def test_what_others_put_into_the_folder_meanwhile_stays(tmp_path):
    folder = tmp_path / "frames"
    write_frames(folder, shades(5), 30)

    def frames():
        yield from shades(2)
        (folder / "notes.txt").write_text("mine")

    with pytest.raises(OutputError, match=r"notes\.txt"):
        write_frames(folder, frames(), 30)
    assert len(content(folder)) == 6


def test_the_old_folder_comes_back_if_the_new_one_cannot_take_its_place(tmp_path, monkeypatch):
    folder = tmp_path / "frames"
    write_frames(folder, shades(5), 30)
    before = content(folder)
    renamed = []

    def replace(source, target):
        renamed.append(target)
        if len(renamed) == 2:
            raise PermissionError(errno.EACCES, "Permission denied")
        os.rename(source, target)

    monkeypatch.setattr(os, "replace", replace)
    with pytest.raises(OutputError, match=r"frames: permission denied$"):
        write_frames(folder, shades(2), 30)
    assert content(folder) == before


# Stills


@pytest.mark.parametrize(("suffix", "error"), [(".png", 0), (".PNG", 0), (".jpg", 3), (".jpeg", 3), (".webp", 3)])
def test_write_picture(tmp_path, suffix, error):
    path = tmp_path / f"still{suffix}"
    path.write_bytes(b"old")
    frame = flat()[::-1]
    assert write_picture(str(path), frame) == path
    with Image.open(path) as image:
        assert image.format == {".png": "PNG", ".webp": "WEBP"}.get(suffix.lower(), "JPEG")
        np.testing.assert_allclose(np.asarray(image).astype(int), frame, atol=error)


def test_write_picture_refuses(tmp_path):
    with pytest.raises(ArgumentError, match=r"'.bmp' is none of .png, .jpg, .jpeg, .webp"):
        write_picture(tmp_path / "a.bmp", flat())
    with pytest.raises(ArgumentError, match=r"frame 0: expected uint8 .*, found float64 of shape \(2, 2, 3\)"):
        write_picture(tmp_path / "a.png", np.zeros((2, 2, 3)))
    with pytest.raises(OutputError, match="no folder"):
        write_picture(tmp_path / "missing" / "a.png", flat())
    (tmp_path / "a.webp").write_bytes(b"old")
    with pytest.raises(OutputError, match=r"^cannot write .*a\.webp: .+$"):
        write_picture(tmp_path / "a.webp", flat(size=(1, 17_000)))  # WebP ends at 16383 pixels
    assert content(tmp_path) == {"a.webp": b"old"}


# Arguments


def test_unknown_suffix_lists_the_known_ones(tmp_path):
    for call in (check_target, lambda path: write_frames(path, shades(1), 30)):
        with pytest.raises(ArgumentError, match=r"'.ogg' is none of .mp4, .avi, .mpg, .gif, .webp, a folder"):
            call(tmp_path / "a.ogg")


@pytest.mark.parametrize("fps", [0, -1, float("nan"), float("inf"), 0.001, 1001])
def test_unusable_fps(target, old, fps):
    with pytest.raises(ArgumentError, match="frames a second for this format, found"):
        write_frames(target, shades(1), fps)
    assert content(target) == old


def test_gif_and_webp_refuse_what_browsers_slow_down(tmp_path):
    with pytest.raises(ArgumentError, match="to 50 frames a second"):
        write_frames(tmp_path / "a.gif", shades(1), 60)
    with pytest.raises(ArgumentError, match="to 90 frames a second"):
        write_frames(tmp_path / "a.webp", shades(1), 100)


@pytest.mark.parametrize(
    ("frames", "message"),
    [
        ([], "found none"),
        (
            [flat(), flat(size=(48, 66))],
            r"frame 1: expected uint8 of shape \(48, 64, 3\), found uint8 of shape \(48, 66",
        ),
        ([flat() / 255], "found float64"),
        ([flat()[..., 0]], r"found uint8 of shape \(48, 64\)"),
        ([np.zeros((4, 4, 4), np.uint8)], r"found uint8 of shape \(4, 4, 4\)"),
        ([np.zeros((0, 4, 3), np.uint8)], r"found uint8 of shape \(0, 4, 3\)"),
        ([None], "found object"),
    ],
)
def test_wrong_frames(target, old, frames, message):
    with pytest.raises(ArgumentError, match=message):
        write_frames(target, iter(frames), 30)
    assert content(target) == old


def test_one_buffer_may_serve_for_all_frames(tmp_path):
    buffer = flat()

    def frames():
        for k in range(20):
            buffer[:] = 10 * k
            yield buffer[::-1]

    write_frames(tmp_path / "a", frames(), 30)
    for k in range(20):
        with Image.open(tmp_path / "a" / f"frame_{k:05d}.png") as image:
            assert np.asarray(image).mean() == 10 * k


def test_progress_is_told_in_the_callers_thread(target):
    told = []
    write_frames(target, shades(4), 30, on_frame=lambda n: told.append((n, threading.current_thread())))
    assert told == [(n, threading.main_thread()) for n in (1, 2, 3, 4)]


# Places that cannot be written


def never():
    raise AssertionError("a frame was drawn")
    yield


@pytest.fixture(params=["no folder", "something in the way", "no permission", "null", "proc"])
def unwritable(request, tmp_path, target, monkeypatch):
    if request.param == "no folder":
        return tmp_path / "missing" / target.name
    if request.param == "something in the way":
        if target.suffix:
            target.mkdir()
        else:
            target.write_bytes(b"a file")
    if request.param == "no permission":
        monkeypatch.setattr(os, "access", lambda *_: False)
    if request.param == "null":
        return f"{tmp_path}/nu\0ll{target.suffix}"
    if request.param == "proc":
        return pytest.skip("no /proc") if not Path("/proc/self").exists() else Path("/proc") / target.name
    return target


def test_unwritable_targets_are_found_before_the_first_frame(unwritable):
    with pytest.raises(OutputError, match=r"^cannot write [^\n]+: [^\n]+$"):
        write_frames(unwritable, never(), 30)
    if not str(unwritable).startswith("/proc"):  # only an attempt shows that nobody can write there
        with pytest.raises(OutputError):
            check_target(unwritable)


def test_check_target_touches_nothing(target, tmp_path):
    check_target(target)
    assert not list(tmp_path.iterdir())


def test_current_folder_is_not_replaced(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for path in (".", "./", "", tmp_path):
        with pytest.raises(OutputError, match="current folder"):
            check_target(path)


def test_a_link_stays_a_link(tmp_path, target):
    link = tmp_path / f"link{target.suffix}"
    write_frames(target, shades(2, (8, 8)), 10)
    before = content(target)
    link.symlink_to(target)
    write_frames(link, shades(3), 10)
    assert link.is_symlink()
    assert content(target) != before


def test_permissions_are_those_of_a_new_file(target):
    write_frames(target, shades(1), 10)
    target.parent.joinpath("new").touch()
    expected = target.parent.joinpath("new").stat().st_mode & 0o777
    assert (target.stat().st_mode & 0o666) == expected


# Failures under way


class TroubleError(Exception):
    pass


@pytest.mark.parametrize("trouble", [TroubleError, KeyboardInterrupt, OSError, OutputError])
@pytest.mark.parametrize("after", [0, 1, 30])
def test_what_the_drawing_raises_comes_through(target, old, trouble, after):
    def frames():
        yield from shades(after)
        raise trouble("while drawing")

    with pytest.raises(trouble, match="while drawing"):
        write_frames(target, frames(), 30)
    assert content(target) == old


def test_what_on_frame_raises_comes_through(target, old):
    def stop(number):
        if number == 3:
            raise TroubleError

    with pytest.raises(TroubleError):
        write_frames(target, shades(10), 30, on_frame=stop)
    assert content(target) == old


def use_encoder(monkeypatch, encoder):
    monkeypatch.setitem(ravemj.graphics.video.VIDEO_FORMATS, ".mp4", (encoder, 1000))


def test_an_encoder_that_fails_frees_a_waiting_producer(tmp_path, monkeypatch):
    drawn = []

    def full_disk(frames, temporary, rate):
        next(frames)
        while len(drawn) < 6:  # one is here, four wait, the sixth does not fit
            time.sleep(0.001)
        time.sleep(0.02)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    use_encoder(monkeypatch, full_disk)
    (tmp_path / "a.mp4").write_bytes(b"old")
    with pytest.raises(OutputError, match=r"^cannot write .*a\.mp4: no space left on device$"):
        write_frames(tmp_path / "a.mp4", (drawn.append(1) or flat() for _ in range(100)), 30)
    assert len(drawn) == 6
    assert content(tmp_path) == {"a.mp4": b"old"}


def test_an_encoder_that_fails_at_the_end(tmp_path, monkeypatch):
    def fails(frames, temporary, rate):
        list(frames)
        raise RuntimeError("two\nlines")

    use_encoder(monkeypatch, fails)
    with pytest.raises(OutputError, match=r": two lines$"):
        write_frames(tmp_path / "a.mp4", shades(9), 30)
    assert content(tmp_path) == {}


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.parametrize("at_the_end", [False, True])
def test_an_interrupt_while_waiting_for_the_encoder(tmp_path, monkeypatch, at_the_end):
    seen = []

    def slow(frames, temporary, rate):
        seen.append(next(frames))
        if at_the_end:
            seen.extend(frames)
        time.sleep(0.05)
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.05)
        seen.extend(frames)

    use_encoder(monkeypatch, slow)
    with pytest.raises(KeyboardInterrupt):
        write_frames(tmp_path / "a.mp4", shades(20), 30)
    assert len(seen) == 20 if at_the_end else len(seen) < 7  # one, and those that were drawn before
    assert content(tmp_path) == {}


@pytest.mark.stress
@pytest.mark.skipif(not hasattr(signal, "SIGXFSZ"), reason="POSIX limits")
def test_a_disk_that_fills(target, old):
    script = """
        import resource, sys
        import numpy as np
        from ravemj.errors import OutputError
        from ravemj.graphics.video import write_frames
        resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))
        noise = np.random.default_rng(0)
        try:
            write_frames(sys.argv[1], (noise.integers(0, 255, (64, 64, 3), np.uint8) for _ in range(40)), 30)
        except OutputError as error:
            print(error)
    """
    result = run_script(script, str(target))
    assert re.fullmatch(r"cannot write [^\n]+: [^\n]+\n", result)
    assert content(target) == old


def run_script(script, *arguments):
    command = [sys.executable, "-W", "error", "-c", textwrap.dedent(script), *arguments]
    environment = {**os.environ, "PYTHONPATH": str(Path(ravemj.graphics.video.__file__).parents[1])}
    return subprocess.run(command, check=True, capture_output=True, text=True, env=environment, timeout=PATIENCE).stdout


# Resources


@pytest.mark.stress
@pytest.mark.parametrize("name", ["a.mp4", "a"])
def test_memory_does_not_grow_with_the_number_of_frames(tmp_path, name):
    script = """
        import sys, tracemalloc
        import numpy as np
        from ravemj.graphics.video import write_frames
        frame = np.random.default_rng(0).integers(0, 255, (96, 128, 3), np.uint8)
        tracemalloc.start()
        for count in 50, 400:
            tracemalloc.reset_peak()
            write_frames(sys.argv[1], (np.roll(frame, k, axis=1) for k in range(count)), 30)
            print(tracemalloc.get_traced_memory()[1])
    """
    few, many = map(int, run_script(script, str(tmp_path / name)).split())
    assert many - few < 1_000_000  # bytes of frames and whatever else Python holds; 350 frames are 12,900,000


def test_drawing_and_encoding_overlap(tmp_path, monkeypatch):
    meeting = threading.Barrier(2, timeout=PATIENCE)
    met = []

    def encode(frames, temporary, rate):
        next(frames)
        for _ in range(9):
            met.append(meeting.wait())
            next(frames)

    def drawing():
        for number, frame in enumerate(shades(10)):
            if number:
                meeting.wait()  # while the one before is encoded
            yield frame

    use_encoder(monkeypatch, encode)
    write_frames(tmp_path / "a.mp4", drawing(), 30)
    assert len(met) == 9


def test_importing_is_cheap():
    script = "import sys, ravemj.graphics.video; print([m for m in ('av', 'PIL', 'imageio') if m in sys.modules])"
    assert run_script(script) == "[]\n"


@given(fps=st.floats(0.01, 1000))
def test_every_fps_is_a_usable_fraction(fps):
    assert float(ravemj.graphics.video.frame_rate(fps, 1000)) == pytest.approx(fps, rel=0.1)
