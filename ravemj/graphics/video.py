"""Pictures and videos on disk.

A frame is a uint8 array, shape (height, width, 3): sRGB, top row first. The suffix of the target selects the format:

======================  =====================================================================================
``.mp4``                H.264, which every browser plays
``.avi``, ``.mpg``      H.264 and MPEG-2 for scripts that were written for OpenRAVE; browsers do not play them. MPG
                        has 30 frames per second; frames are repeated to keep the duration
``.gif``                256 colours per frame; delays are multiples of 10 ms, so the frames of a 30 fps video take
                        30 or 40 ms, and the total duration is kept
``.webp``               all colours, smaller than GIF; delays are multiples of 1 ms
no suffix or a final /  a folder of ``frame_00000.png``, ``frame_00001.png``, …
======================  =====================================================================================

MP4, AVI, MPG and PNG take the same memory for any number of frames; GIF and WebP hold all of them.

Targets are written atomically; see ``ravemj.core.output``.
"""

# PyAV and imageio leave some types open.
# pyright: reportUnknownMemberType=false

import io
import itertools
import logging
import math
import os
import threading
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ravemj.core.flags import Flag, Handover
from ravemj.core.output import AnyPath, check_file, check_folder, new_file, new_folder, output_error
from ravemj.errors import ArgumentError

if TYPE_CHECKING:
    from PIL.Image import Image

Frame = NDArray[np.uint8]

logger = logging.getLogger("ravemj")

_FRAMES_BETWEEN_THREADS = 4
_LOWEST_FPS = 0.01
_FOLDER = ""  # the suffix for a folder of PNG files
_FILES_OF_FOLDER = "frame_*.png"
_MPG_FPS = 30
_BT709, _SRGB = 1, 13  # ITU-T H.273
_LIMITED, _FULL = 1, 2  # FFmpeg's AVColorRange
_MANY_FRAMES = 300
_MANY_PIXELS = 100_000_000


def check_target(path: AnyPath) -> None:
    """Check that a video can be written to a path, without touching anything.

    Call it before long computations; ``write_frames`` calls it as well.

    Raises:
        ArgumentError: The suffix is not one of those in the module's docstring.
        OutputError: The folder around it is missing or cannot be written, or the path exists and is of another kind.
    """
    if known_suffix(path, VIDEO_FORMATS) == _FOLDER:
        check_folder(path, _FILES_OF_FOLDER)
    else:
        check_file(path)


def write_frames(
    path: AnyPath, frames: Iterable[Frame], fps: float, *, on_frame: Callable[[int], None] | None = None
) -> Path:
    """Write a video.

    Frames are drawn in the caller's thread, to which the GL context belongs, while a second thread encodes. Each frame
    is copied when it arrives, so that one buffer may be used for all of them.

    Args:
        path: The target, which is returned unchanged; its suffix selects the format.
        frames: uint8 arrays (height, width, 3) of one size. Videos repeat the last row or column of an odd size.
        fps: Frames per second, from 0.01 to 1000; at most 50 for GIF and 90 for WebP, since browsers play shorter
            delays at 10 frames per second; at most 30 for MPG.
        on_frame: Called in the caller's thread after each frame with the number of frames so far.

    Raises:
        ArgumentError: Unknown suffix, invalid fps, a frame of wrong type or size, or no frames.
        OutputError: The target cannot be written; most causes are found before the first frame is drawn.
    """
    suffix = known_suffix(path, VIDEO_FORMATS)
    encoder, highest_fps = VIDEO_FORMATS[suffix]
    rate = frame_rate(fps, highest_fps)
    with new_folder(path, _FILES_OF_FOLDER) if suffix == _FOLDER else new_file(path) as temporary:
        _overlap(_checked(frames), lambda arriving: _encode(encoder, arriving, temporary, rate, path), on_frame)
    return Path(path)


def check_picture(path: AnyPath) -> None:
    """Check that a single picture can be written to a path, without touching anything.

    Raises:
        ArgumentError: The suffix is not ``.png``, ``.jpg``, ``.jpeg`` or ``.webp``.
        OutputError: The folder around it is missing or cannot be written, or the path exists and is of another kind.
    """
    known_suffix(path, STILL_FORMATS)
    check_file(path)


def write_picture(path: AnyPath, frame: Frame) -> Path:
    """Write a picture, uint8 of shape (height, width, 3), as ``.png``, ``.jpg``, ``.jpeg`` or ``.webp``.

    The suffix of the path selects the format; the path is returned unchanged.

    Raises:
        ArgumentError: Unknown suffix, or the frame has a wrong type or shape.
        OutputError: The target cannot be written.
    """
    suffix = known_suffix(path, STILL_FORMATS)
    (picture,) = _checked([frame])
    with new_file(path) as temporary:
        try:
            _imwrite(temporary, picture, extension=suffix, **STILL_FORMATS[suffix])
        except Exception as error:
            raise output_error(path, error) from error
    return Path(path)


def picture_bytes(frame: Frame, suffix: str = ".png") -> bytes:
    """Return a picture, uint8 of shape (height, width, 3), as file content; suffixes as for ``write_picture``."""
    content = io.BytesIO()
    _imwrite(content, frame, extension=suffix, **STILL_FORMATS[suffix])
    return content.getvalue()


def _imwrite(target: Path | io.BytesIO, frame: Frame, **options: Any) -> None:  # noqa: ANN401 - the encoder decides
    import imageio.v3  # noqa: PLC0415 - slow to import

    imageio.v3.imwrite(target, frame, plugin="pillow", **options)


_H264: dict[str, str] = {"crf": "20", "preset": "veryfast"}
_Codec = Literal["libx264", "mpeg2video"]
_CONTAINERS: dict[str, tuple[_Codec, dict[str, str], dict[str, str]]] = {  # codec, its options, options of the file
    "mp4": ("libx264", _H264, {"movflags": "+faststart"}),
    "avi": ("libx264", _H264 | {"bf": "0"}, {}),  # AVI has no times for frames that are stored out of order
    "mpeg": ("mpeg2video", {"b": "8M"}, {}),
}


def _write_video(frames: Iterator[Frame], temporary: Path, rate: Fraction, kind: str) -> None:
    import av  # noqa: PLC0415 - slow to import

    first = next(frames)
    codec_name, codec_options, options = _CONTAINERS[kind]
    with av.open(str(temporary), "w", format=kind, options=options) as container:
        stream = container.add_stream(codec_name, rate, codec_options)
        stream.height, stream.width = (size + size % 2 for size in first.shape[:2])
        stream.pix_fmt = "yuv420p"
        codec = stream.codec_context
        codec.thread_count = 1  # more threads would take the processor from drawing
        codec.color_range, codec.colorspace = _LIMITED, _BT709
        codec.color_primaries, codec.color_trc = _BT709, _SRGB
        for number, frame in enumerate(itertools.chain([first], frames)):
            even = np.pad(frame, [(0, size % 2) for size in frame.shape[:2]] + [(0, 0)], mode="edge")
            picture = av.VideoFrame.from_ndarray(even, format="rgb24").reformat(
                format="yuv420p", dst_colorspace=_BT709, src_color_range=_FULL, dst_color_range=_LIMITED
            )
            picture.pts = number
            container.mux(stream.encode(picture))
        container.mux(stream.encode(None))


def _write_mpg(frames: Iterator[Frame], temporary: Path, rate: Fraction) -> None:
    """Write an MPEG-2 video; the format allows few frame rates, so frames are repeated to reach its most common one."""

    def repeated() -> Iterator[Frame]:
        for number, frame in enumerate(frames):
            begin, end = (math.ceil(count * _MPG_FPS / rate) for count in (number, number + 1))
            yield from itertools.repeat(frame, end - begin)

    _write_video(repeated(), temporary, Fraction(_MPG_FPS), "mpeg")


def _write_gif(frames: Iterator[Frame], temporary: Path, rate: Fraction) -> None:
    images = _images(frames, rate, 10)
    next(images).save(temporary, format="GIF", save_all=True, append_images=images, loop=0)


def _write_webp(frames: Iterator[Frame], temporary: Path, rate: Fraction) -> None:
    images = list(_images(frames, rate, 1))
    delays = [image.info["duration"] for image in images]
    options = {"duration": delays, "quality": 85, "method": 0}  # 0: the fastest
    images[0].save(temporary, format="WEBP", save_all=True, append_images=images[1:], loop=0, **options)


def _images(frames: Iterator[Frame], rate: Fraction, grain: int) -> "Iterator[Image]":
    """Yield frames as images with display times in multiples of ``grain`` [ms]; the total duration is kept."""
    from PIL import Image  # noqa: PLC0415 - slow to import

    pixels = 0
    warned = False
    for number, frame in enumerate(frames):
        pixels += frame.shape[0] * frame.shape[1]
        if not warned and (number >= _MANY_FRAMES or pixels > _MANY_PIXELS):
            logger.warning("a long GIF or WebP holds all frames in memory and becomes a large file; .mp4 does not")
            warned = True
        image = Image.fromarray(frame)
        begin, end = (round(count * 1000 / rate / grain) for count in (number, number + 1))
        image.info["duration"] = (end - begin) * grain
        yield image


def _write_png_folder(frames: Iterator[Frame], temporary: Path, _: Fraction) -> None:
    for number, frame in enumerate(frames):
        _imwrite(temporary / f"frame_{number:05d}.png", frame, compress_level=1)


_Encoder = Callable[[Iterator[Frame], Path, Fraction], None]
VIDEO_FORMATS: dict[str, tuple[_Encoder, int]] = {
    ".mp4": (partial(_write_video, kind="mp4"), 1000),
    ".avi": (partial(_write_video, kind="avi"), 1000),
    ".mpg": (_write_mpg, _MPG_FPS),
    ".gif": (_write_gif, 50),
    ".webp": (_write_webp, 90),
    _FOLDER: (_write_png_folder, 1000),
}
"""Encoder and maximum frame rate of each suffix; the empty suffix is a folder."""
STILL_FORMATS: dict[str, dict[str, str | int]] = {  # with the encoder's options
    ".png": {},
    ".jpg": {"quality": 95},
    ".jpeg": {"quality": 95},
    ".webp": {"quality": 95},
}


class _Stopped(Exception):  # noqa: N818 - no error of its own: it ends an encoder that nobody needs any more
    pass


def _arriving(handed_over: "Handover[Frame | None]", stopped: Flag) -> Iterator[Frame]:
    """Yield the frames of the drawing thread until None arrives; raise ``_Stopped`` if that thread failed."""
    while (frame := handed_over.get()) is not None and not stopped.is_set():
        yield frame
    if stopped.is_set():
        raise _Stopped


def _overlap(
    frames: Iterable[Frame], encode: Callable[[Iterator[Frame]], None], on_frame: Callable[[int], None] | None
) -> None:
    """Encode in a second thread while this thread draws; an exception in either ends both."""
    handed_over = Handover["Frame | None"](_FRAMES_BETWEEN_THREADS)
    ended, stopped = Flag(), Flag()
    errors: list[BaseException] = []

    def work() -> None:
        try:
            encode(_arriving(handed_over, stopped))
        except BaseException as error:
            errors.append(error)
        ended.set()
        handed_over.give_room()  # else the drawing thread could wait for ever

    # No executor: a process waits for the threads of these before its main thread counts as ended, which tells those
    # who hand in frames that there will be no more.
    thread = threading.Thread(target=work, name="ravemj-encoder")
    thread.start()
    try:
        for number, frame in enumerate(frames, 1):
            handed_over.put(frame)
            if ended.is_set():
                break  # the encoder has failed
            if on_frame is not None:
                on_frame(number)
        handed_over.put_at_once(None)
        ended.wait()
    except BaseException:
        stopped.set()
        handed_over.put_at_once(None)
        raise
    finally:
        thread.join()
    if errors:
        raise errors[0]


def _encode(encoder: _Encoder, frames: Iterator[Frame], temporary: Path, rate: Fraction, path: AnyPath) -> None:
    try:
        encoder(frames, temporary, rate)
    except _Stopped:
        raise
    except Exception as error:  # FFmpeg and Pillow raise many types of exceptions
        raise output_error(path, error) from error


def _checked(frames: Iterable[Frame]) -> Iterator[Frame]:
    """Yield copies of the frames; raise if there is none, or not all are uint8 of one shape (H, W, 3)."""
    shape: tuple[int, ...] = ()
    for number, frame in enumerate(frames):
        copy = np.array(frame, order="C")
        fits = copy.ndim == 3 and copy.shape[2] == 3 and copy.size and copy.shape == (shape or copy.shape)
        if copy.dtype != np.uint8 or not fits:
            expected = f"uint8 of shape {shape or '(height, width, 3)'}"
            raise ArgumentError(f"frame {number}: expected {expected}, found {copy.dtype} of shape {copy.shape}")
        shape = copy.shape
        yield copy
    if not shape:
        raise ArgumentError("expected one frame or more, found none")


def known_suffix(path: AnyPath, known: Iterable[str]) -> str:
    """Return the suffix of a file to write, in lower case; empty for a folder.

    Raises:
        ArgumentError: It is not one of ``known``.
    """
    text = os.fspath(path)
    suffix = _FOLDER if text.endswith(("/", os.sep)) else Path(text).suffix.lower()
    if suffix not in known:
        names = ", ".join(name or "a folder (no suffix or a final /)" for name in known)
        mistake = f"'{suffix}' is none of" if suffix else "its name has no suffix, and should end with one of"
        raise ArgumentError(f"cannot write {text}: {mistake} {names}")
    return suffix


def frame_rate(fps: float, highest: int) -> Fraction:
    """Return a frame rate as the fraction stored in a video.

    Raises:
        ArgumentError: It is invalid, or higher than the format allows.
    """
    if not (math.isfinite(fps) and _LOWEST_FPS <= fps <= highest):
        raise ArgumentError(f"expected from {_LOWEST_FPS} to {highest} frames a second for this format, found {fps}")
    return Fraction(fps).limit_denominator(1001)
