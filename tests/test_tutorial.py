"""The tutorial: every block runs, says what the page says and draws the page's pictures; it is a notebook, too."""

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest
import tutorial
from command_line import note_on_rays
from PIL import Image

DOCS = Path(__file__).resolve().parent.parent / "docs"
PAGE = (DOCS / "tutorial.md").read_text()
NOTEBOOK = DOCS / "notebooks" / "tutorial.ipynb"


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """An empty folder; ``ravemj`` is on the path there, and there is no display."""
    program = tmp_path / "bin" / "ravemj"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m ravemj "$@"\n')
    program.chmod(0o755)
    monkeypatch.setenv("PYTHONPATH", str(DOCS.parent))
    monkeypatch.setenv("PATH", str(program.parent), prepend=":")
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("COLUMNS", "100")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.mark.filterwarnings("ignore")  # Jupyter's own
def test_every_block_prints_what_the_page_says_and_draws_its_pictures(folder):
    blocks = tutorial.outputs(tutorial.notebook(PAGE), folder)
    assert len(blocks) > 20
    for printed, said in blocks:
        assert printed.replace(note_on_rays(), "") == said
    shown = re.findall(r"!\[.+\]\(pictures/(tutorial-.+)\)", PAGE)
    pages = re.findall(r"\]\(motions/(tutorial-[^)]+)\)", PAGE)
    assert sorted([*shown, *pages]) == sorted(path.name for path in folder.glob("tutorial-*"))
    for name in shown:
        drawn, kept = (np.asarray(Image.open(path / name), float) for path in (folder, DOCS / "pictures"))
        assert drawn.shape == kept.shape
        assert np.abs(drawn - kept).mean() < 0.5, f"{name} looks different now: run scripts/docs"


def test_the_notebook_is_the_page():
    assert NOTEBOOK.read_text() == tutorial.notebook(PAGE), "run scripts/docs"


def test_links_of_the_notebook_lead_somewhere():
    cells = json.loads(NOTEBOOK.read_text())["cells"]
    prose = "\n".join(cell["source"] for cell in cells if cell["cell_type"] == "markdown")
    for target in re.findall(r"\]\(([^)#]+)", prose):
        assert "://" in target or (NOTEBOOK.parent / target).exists(), target


def test_what_is_explained_stands_in_the_file():
    """Fragments of XML are pieces of the file that the page saves before."""
    fragments = re.findall(r"^```xml\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    assert len(fragments) > 4
    models = DOCS.parent / "models"
    for name in ("env.xml", "double-pendulum.xml"):
        assert f"```xml {name}\n{(models / name).read_text()}```" in PAGE
    for fragment in fragments:
        assert fragment in (models / "double-pendulum.xml").read_text()
