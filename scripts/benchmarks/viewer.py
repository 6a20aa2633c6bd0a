"""The viewer's page: how fast pictures come, to a connection that throws them away and to a browser."""

import contextlib
import importlib.util
import json
import shutil
import statistics
import time
import warnings
from collections.abc import Callable, Generator
from itertools import count

import mujoco
import numpy as np
from websockets.sync.client import ClientConnection, connect

import ravemj
from benchmarks.kinematics import PR2
from benchmarks.measure import CAMERA, MODEL, Row, take_turns
from benchmarks.reading import CORPUS
from ravemj.graphics.rendering import Camera
from ravemj.graphics.rendering.camera_file import read_camera
from ravemj.graphics.rendering.contexts import RAY, OffscreenContext
from ravemj.graphics.rendering.gl_scene import GlScene, Quality
from ravemj.graphics.simulation_renderer import Format
from ravemj.gui.viewers.sharpness import CRISP, Level, Sharpness

_SIZE = 800, 600
_FRAMES = 60
_ROUNDS = 3
_WHEELS = 40
_IDLE = 3.0
_LARGE = 960, 720
_WARM, _PICTURES = 10, 15
_FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-webgl"]
_NOTE_FIRST_FRAME = """
new MutationObserver(() => { window.firstFrame ??= performance.now(); })
    .observe(document, { attributes: true, attributeFilter: ["data-crisp"], subtree: true });
"""
_TIME_WHEEL = """
() => new Promise((done) => {
  const draw = paint.drawImage, start = performance.now();
  paint.drawImage = (...what) => {
    draw.apply(paint, what);
    paint.drawImage = draw;
    done(performance.now() - start);
  };
  view.dispatchEvent(new WheelEvent("wheel", { deltaY: (Math.random() - 0.5) * 100, cancelable: true }));
})
"""


def rows() -> list[Row]:
    """Measure the page at 800x600."""
    env = ravemj.load(MODEL)
    pictures = [row for name, robot in robots() for row in _picture_rows(name, robot)]
    viewer = env.serve_viewer()
    viewer.SetCamera(read_camera(CAMERA).T_world_camera)
    try:
        return [*pictures, *_connection_rows(env, viewer.url), *_browser_rows(viewer.url)]
    finally:
        env.Destroy()


def robots() -> Generator[tuple[str, ravemj.Environment]]:
    """Yield the pendulum, and the PR2 where the corpus of published models is."""
    for name, path in (("pendulum", MODEL), ("PR2", CORPUS / PR2)):
        if path.exists():
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                env = ravemj.load(path)
            yield name, env
            env.Destroy()


def _picture_rows(name: str, env: ravemj.Environment) -> list[Row]:
    """Measure what a picture takes of the processor: crisp, and as it is while things move."""
    camera, sharpness = env.renderer.camera_for_stills(_LARGE[0] / _LARGE[1]), Sharpness()

    def draw(level: Level) -> float:
        begin, used = time.monotonic(), time.process_time()
        width, height = (int(level.scale * length) for length in _LARGE)
        env.renderer.render(camera, (1.0, 1.0, 1.0), Format(width, height, samples=level.samples))
        sharpness.add_measurement(level, time.monotonic() - begin)
        return 1e3 * (time.process_time() - used)

    for _ in range(_WARM):
        draw(sharpness.level_while_moving(0.0))
    level = sharpness.level_while_moving(0.0)
    moving = statistics.median(draw(level) for _ in range(_PICTURES))
    resting = statistics.median(draw(CRISP) for _ in range(_PICTURES))
    note = f"{_LARGE[0]}x{_LARGE[1]}; moving at {level.scale:g} of that, {level.samples} samples"
    return [Row(f"processor for a picture of the {name} while it moves : at rest", "ms", moving, resting, note=note)]


def _connection_rows(env: ravemj.Environment, url: str) -> list[Row]:
    address, origin = url.replace("http", "ws", 1) + "socket", url.rsplit("/", 2)[0]
    with connect(address, origin=origin, compression=None) as connection:
        _send(connection, type="shape", width=_SIZE[0], height=_SIZE[1], ratio=1)
        _send(connection, type="ready")
        _receive(connection)
        backend = env.renderer.backend(Format(*_SIZE))
        with _bare_drawing(env, backend) as bare:
            drawing = [lambda: _rate(lambda: _turn(connection)), *([lambda: _rate(bare)] if bare else [])]
            ours, *floor = take_turns(drawing, _ROUNDS)
        time.sleep(1)  # until the last picture is crisp
        begin = time.process_time()
        time.sleep(_IDLE)
        idle = 100 * (time.process_time() - begin) / _IDLE
    what = f"page {_SIZE[0]}x{_SIZE[1]} to a connection : mjr_render and mjr_readPixels alone"
    return [
        Row(what, "fps", ours, next(iter(floor), None), 0.4, more_is_better=True, note=backend),
        Row("processor while a page is open and nothing changes", "% of one", idle),
    ]


def _turn(connection: ClientConnection) -> None:
    """Throw a picture away, and have the next one look different."""
    _send(connection, type="use", tool="RotY", amount=1)
    _receive(connection)


def _receive(connection: ClientConnection) -> None:
    connection.recv(60)
    connection.recv(60)
    _send(connection, type="ready")


def _send(connection: ClientConnection, **message: object) -> None:
    connection.send(json.dumps(message))


def _rate(draw: Callable[[], object]) -> float:
    begin = time.perf_counter()
    for _ in range(_FRAMES):
        draw()
    return _FRAMES / (time.perf_counter() - begin)


@contextlib.contextmanager
def _bare_drawing(env: ravemj.Environment, backend: str) -> Generator[Callable[[], object] | None]:
    """Yield what draws one picture with MuJoCo's own calls, from another side each time; None where rays draw."""
    if backend == RAY:
        yield None
        return
    context, camera, numbers = OffscreenContext(backend), read_camera(CAMERA), count()
    viewport = mujoco.MjrRect(0, 0, *_SIZE)
    picture = np.empty((_SIZE[1], _SIZE[0], 3), dtype=np.uint8)
    with context.current():
        stage = GlScene(env.model, Quality(*_SIZE))
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, stage.context)

    def draw() -> None:
        with context.current():
            turned = camera.T_world_camera @ ravemj.matrixFromAxisAngle([0, 0.01 * next(numbers), 0])
            stage.fill(env.data, Camera(turned), _SIZE)
            mujoco.mjr_render(viewport, stage.scene, stage.context)
            mujoco.mjr_readPixels(picture, None, viewport, stage.context)

    try:
        yield draw
    finally:
        with context.current():
            stage.close()
        context.close()


def _browser_rows(url: str) -> list[Row]:
    """Measure what a browser shows, where there is one."""
    program = shutil.which("chromium")
    if program is None or importlib.util.find_spec("playwright") is None:
        return []
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - optional

    with sync_playwright() as playwright, playwright.chromium.launch(executable_path=program, args=_FLAGS) as browser:
        firsts: list[float] = []
        for _ in range(_ROUNDS):
            page = browser.new_page(viewport={"width": _SIZE[0], "height": _SIZE[1]})
            page.add_init_script(_NOTE_FIRST_FRAME)
            page.goto(url)
            page.wait_for_selector("[data-crisp=true]")
            firsts.append(page.evaluate("firstFrame"))
        times = sorted(page.evaluate(_TIME_WHEEL) for _ in range(_WHEELS))
    note = f"Chromium without a graphics card, {_SIZE[0]}x{_SIZE[1]}"
    return [
        Row("first picture in a browser after navigation", "ms", statistics.median(firsts), note=note),
        Row("wheel of the mouse to new picture in a browser, median", "ms", statistics.median(times), note=note),
        Row("the same, 95th percentile", "ms", times[round(0.95 * (_WHEELS - 1))], note=note),
    ]
