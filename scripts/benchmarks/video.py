"""Frames per second of videos, against drawing alone and encoding alone.

Start-up does not count: each clock starts when ``_STEADY`` frames are through and stops when the last one is, for
a video when the file is complete. Opening the OpenGL context and the encoder and filling the encoder's queue lie
before that. The row of the whole command includes them, and the start of Python.
"""

import contextlib
import functools
import itertools
import tempfile
import time
from collections.abc import Callable, Generator, Iterator
from fractions import Fraction
from pathlib import Path

import av
import mujoco
import numpy as np

import ravemj
from benchmarks.measure import CAMERA, MODEL, Row, run_python, take_turns
from ravemj.graphics.rendering import Renderer, open_renderer
from ravemj.graphics.rendering.camera_file import read_camera
from ravemj.graphics.rendering.contexts import RAY, OffscreenContext
from ravemj.graphics.rendering.gl_scene import GlScene, Quality
from ravemj.graphics.simulation_renderer import Format, Frame
from ravemj.graphics.video import write_frames
from ravemj.rave.recording import Shot, draw_frames, followed_motion

_STEADY = 30
_FRAMES = 241
_FPS = 30
_ROUNDS = 3


def rows() -> list[Row]:
    """Compare what ``ravemj play -o`` does with the slower of its two halves, each alone, at the same settings."""
    with tempfile.TemporaryDirectory() as folder:
        return _Play(Path(folder)).rows()


class _Play:
    """The motion of ``ravemj play`` without options: the first joint to pi."""

    def __init__(self, folder: Path) -> None:
        self.ours, self.bare, self.by_command = (folder / f"{name}.mp4" for name in ("ours", "bare", "command"))
        self.env = ravemj.load(MODEL)
        self.robot = self.env.GetRobots()[0]
        self.motion = ravemj.Motion.line([0.0, 0.0], [np.pi, 0.0], (_FRAMES - 1) / _FPS)
        self.shot = Shot(read_camera(CAMERA), self.env.look(), Format(shadows=False), _FPS)
        self.pictures: list[Frame] = []

    def rows(self) -> list[Row]:
        """Take all measurements in turn."""
        form = self.shot.form
        with open_renderer(self.env.model, form.width, form.height, shadows=form.shadows) as renderer:
            self.pictures = list(self.drawn(renderer))
            drawing = functools.partial(_rate, lambda: self.drawn(renderer))
            with self.bare_drawing(renderer.backend) as bare_drawing:
                whole, draw, encode, command, bare = take_turns(
                    [self.play, drawing, self.encode, self.command, bare_drawing], _ROUNDS, warm_up=False
                )
            backend = renderer.backend
        rows = [self.main_row(whole, draw, encode, backend), *_other_rows(whole, draw, command, bare)]
        return rows if backend == RAY else [*rows, self.shadow_row()]

    def shadow_row(self) -> Row:
        """Return the row of shadows, which has a limit where a graphics card draws."""
        form = self.shot.form
        size = form.width, form.height
        is_hardware = self.env.renderer.has_shadows(form._replace(shadows=None))
        with (
            open_renderer(self.env.model, *size, shadows=True) as shaded,
            open_renderer(self.env.model, *size, shadows=False) as plain,
        ):
            rates = take_turns(
                [functools.partial(_rate, functools.partial(self.drawn, one)) for one in (shaded, plain)],
                _ROUNDS,
                warm_up=False,
            )
        with_shadows, without = (1000 / rate for rate in rates)
        note = "" if is_hardware else "the processor draws, so videos have none"
        limit = 1.5 if is_hardware else None
        return Row("drawing a frame with shadows : without", "ms", with_shadows, without, limit, note=note)

    def main_row(self, whole: float, draw: float, encode: float, backend: str) -> Row:
        """Return the row with the limit; ours and the bare encoder must have written the same file."""
        same = self.ours.read_bytes() == self.bare.read_bytes()
        form = self.shot.form
        note = f"{backend}; drawing alone {draw:.0f}, encoding alone {encode:.0f}"
        return Row(
            f"play -o MP4 {form.width}x{form.height} : the slower of drawing and encoding alone",
            "fps",
            whole,
            min(draw, encode),
            0.6,
            more_is_better=True,
            note=note if same else f"{note}; BUT OTHER FILES",
        )

    @contextlib.contextmanager
    def bare_drawing(self, backend: str) -> Generator[Callable[[], float]]:
        """Yield the measurement of MuJoCo's own drawing, in a context of the same kind; 0 fps where rays draw."""
        if backend == RAY:
            yield lambda: 0.0
            return
        form = self.shot.form
        context = OffscreenContext(backend)
        with context.current():
            stage = GlScene(self.env.model, Quality(form.width, form.height, form.shadows))
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, stage.context)
        try:
            yield functools.partial(_rate, lambda: self.drawn_bare(context, stage))
        finally:
            with context.current():
                stage.close()
            context.close()

    def command(self) -> float:
        """Return the frames per second of the whole command, from the start of Python to its end."""
        begin = time.perf_counter()
        arguments = ("--camera", str(CAMERA), "--fps", str(_FPS), "--duration", str(self.motion.duration))
        run_python("-m", "ravemj", "play", str(MODEL), "-o", str(self.by_command), *arguments)
        return _FRAMES / (time.perf_counter() - begin)

    def play(self) -> float:
        """Return the frames per second of what the command does once the model is loaded."""
        begin = 0.0

        def on_frame(number: int) -> None:
            nonlocal begin
            if number == _STEADY:
                begin = time.perf_counter()

        followed = followed_motion(self.env, self.motion)
        write_frames(self.ours, draw_frames(self.env, followed, self.shot), _FPS, on_frame=on_frame)
        return (_FRAMES - _STEADY) / (time.perf_counter() - begin)

    def drawn(self, renderer: Renderer) -> Iterator[Frame]:
        """Draw the frames of the motion, and nothing else."""
        model, data = self.env.model, self.env.data
        for values in self.motion.frames(_FPS):
            data.qpos[:] = values
            mujoco.mj_kinematics(model, data)
            yield renderer.render(data, self.shot.camera, self.shot.look)

    def drawn_bare(self, context: OffscreenContext, stage: GlScene) -> Iterator[Frame]:
        """Draw the frames with one call after the other into MuJoCo."""
        model, data, form = self.env.model, self.env.data, self.shot.form
        stage.fill(
            data, self.shot.camera, (form.width, form.height), look=self.shot.look
        )  # leaves the camera in the scene
        option, user, every = mujoco.MjvOption(), mujoco.MjvCamera(), mujoco.mjtCatBit.mjCAT_ALL.value
        user.type = mujoco.mjtCamera.mjCAMERA_USER
        viewport = mujoco.MjrRect(0, 0, form.width, form.height)
        picture = np.empty((form.height, form.width, 3), dtype=np.uint8)
        with context.current():
            stage.draw(viewport)  # sets the background
            for values in self.motion.frames(_FPS):
                data.qpos[:] = values
                mujoco.mj_kinematics(model, data)
                mujoco.mjv_updateScene(model, data, option, None, user, every, stage.scene)
                mujoco.mjr_render(viewport, stage.scene, stage.context)
                mujoco.mjr_readPixels(picture, None, viewport, stage.context)
                yield picture

    def encode(self) -> float:
        """Return the frames per second of PyAV alone."""
        height, width = self.pictures[0].shape[:2]
        begin = 0.0
        with av.open(str(self.bare), "w", format="mp4", options={"movflags": "+faststart"}) as container:
            stream = container.add_stream("libx264", Fraction(_FPS), {"crf": "20", "preset": "veryfast"})
            stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
            codec = stream.codec_context
            codec.thread_count = 1
            codec.color_range, codec.colorspace, codec.color_primaries, codec.color_trc = 1, 1, 1, 13
            for number, picture in enumerate(self.pictures):
                if number == _STEADY:
                    begin = time.perf_counter()
                frame = av.VideoFrame.from_ndarray(picture, format="rgb24").reformat(
                    format="yuv420p", dst_colorspace=1, src_color_range=2, dst_color_range=1
                )
                frame.pts = number
                container.mux(stream.encode(frame))
            container.mux(stream.encode(None))
        return (_FRAMES - _STEADY) / (time.perf_counter() - begin)


def _other_rows(whole: float, draw: float, command: float, bare: float) -> list[Row]:
    """Return the rows that only inform."""
    seconds = _FRAMES / command
    note = f"{_FRAMES} frames in {seconds:.1f} s, of which {seconds - _FRAMES / whole:.1f} s start and end"
    rows = [Row("the whole command ravemj play : the same without start-up", "fps", command, whole, note=note)]
    if bare:
        rows.append(Row("drawing alone : MuJoCo's own calls alone", "fps", draw, bare))
    return rows


def _rate(frames: Callable[[], Iterator[Frame]]) -> float:
    """Return how many frames arrive in a second once it is going."""
    arriving = frames()
    for _ in itertools.islice(arriving, _STEADY):
        pass
    begin = time.perf_counter()
    count = sum(1 for _ in arriving)
    return count / (time.perf_counter() - begin)
