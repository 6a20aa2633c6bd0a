"""Pages that draw by themselves, in a browser without a graphics card: the first picture, and how many follow."""

import importlib.util
import shutil
import statistics
import sys
from collections.abc import Generator
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.kinematics import PR2
from benchmarks.measure import MODEL, ROOT, Row
from benchmarks.page import opened
from benchmarks.reading import CORPUS

sys.path.append(str(ROOT / "tests"))
from slow_link import SlowLink

if TYPE_CHECKING:
    from playwright.sync_api import Browser

_FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
_VIEW = {"width": 800, "height": 600}
_LATEST = {"pendulum": 1000.0, "PR2": 3000.0}
"""When the first picture is to be there [ms]."""

_ROUNDS = 5
_DELAY = 0.05
"""Of either direction [s]: a request takes twice as long."""

_RATE = 10e6 / 8
"""Bytes a second."""

_NOTE_FIRST_PICTURE = """new MutationObserver(() => {
  window.firstPicture ||= document.body?.dataset.crisp ? performance.now() : 0;
}).observe(document, { subtree: true, attributes: true })"""

_COUNT_PICTURES = """new Promise((resolve) => {
  const start = performance.now();
  let pictures = 0;
  const next = () => {
    const seconds = (performance.now() - start) / 1000;
    if (seconds > 3) return resolve(pictures / seconds);
    pictures += 1;
    drawing.answer = drawing.view.turned(3, 0, view.clientHeight);
    draw();
    requestAnimationFrame(next);
  };
  next();
})"""


def rows() -> list[Row]:
    """Measure pages of the pendulum and of a PR2, where there are Chromium and Playwright."""
    if shutil.which("chromium") is None or importlib.util.find_spec("playwright") is None:
        return []
    return [
        row for name, path in (("pendulum", MODEL), ("PR2", CORPUS / PR2)) if path.exists() for row in _of(name, path)
    ]


def _of(name: str, path: Path) -> Generator[Row]:
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - optional

    with opened(path) as (_, viewer), SlowLink(viewer.server.port, rate=_RATE, delay=_DELAY) as link:
        rule = f"--host-resolver-rules=MAP 127.0.0.1:{viewer.server.port} 127.0.0.1:{link.port}"
        with sync_playwright() as playwright:
            start = playwright.chromium.launch
            with start(executable_path=shutil.which("chromium"), args=[*_FLAGS, rule]) as browser:
                yield from _measured(name, viewer.url, browser, link)


def _measured(name: str, url: str, browser: "Browser", link: SlowLink) -> Generator[Row]:
    firsts: list[float] = []
    for _ in range(_ROUNDS):
        context = browser.new_context(viewport=_VIEW)  # which has fetched nothing yet
        page = context.new_page()
        page.add_init_script(_NOTE_FIRST_PICTURE)
        before = link.received
        page.goto(url)
        page.wait_for_selector("[data-crisp]", state="attached")
        firsts.append(page.evaluate("firstPicture"))
        received = link.received - before
        if len(firsts) < _ROUNDS:
            context.close()
    rate = page.evaluate(_COUNT_PICTURES)
    note = f"10 Mbit/s, {2e3 * _DELAY:g} ms there and back, {received / 1e3:.0f} kB"
    what = f"first picture of the {name} in a browser, slow link : latest"
    yield Row(what, "ms", statistics.median(firsts), _LATEST[name], 1.0, note=note)
    note = f"{_VIEW['width']}x{_VIEW['height']} by SwiftShader, while the view turns"
    yield Row(f"pictures of the {name} that a browser draws", "1/s", rate, note=note)
