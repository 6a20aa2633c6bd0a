"""The examples of planning: the page has all of them, and each makes its video."""

import runpy
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import run
from conftest import REPOSITORY
from PIL import Image, ImageSequence

DOCS = REPOSITORY / "docs"
FOLDER = DOCS / "examples"
NAMES = sorted(path.stem for path in FOLDER.glob("*.py") if path.stem != "stage")


def frames(path: Path) -> np.ndarray:
    with Image.open(path) as video:
        return np.array([frame.convert("RGB").resize((100, 75)) for frame in ImageSequence.Iterator(video)], float)


@pytest.mark.parametrize("name", NAMES)
def test_the_page_has_every_example_with_its_video(name, monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    page = (DOCS / "examples.md").read_text()
    assert f"[{name}.py](examples/{name}.py)" in page
    assert f"](pictures/example-{name}.webp)" in page
    assert callable(runpy.run_path(str(FOLDER / f"{name}.py"))["main"])
    sys.modules.pop("stage")


@pytest.mark.stress
@pytest.mark.parametrize("name", NAMES)
def test_an_example_makes_its_video(name, tmp_path):
    done = run(tmp_path, FOLDER / f"{name}.py", "made.webp")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("wrote made.webp\n")
    made, kept = frames(tmp_path / "made.webp"), frames(DOCS / "pictures" / f"example-{name}.webp")
    assert made.shape == kept.shape
    assert np.abs(made - kept).mean() < 0.5, "it looks different now: run scripts/docs"
