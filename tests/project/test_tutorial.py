"""The tutorials: every block runs, says what the page says and draws the page's pictures; they are notebooks, too."""

import base64
import io
import json
import re
import shlex
import sys
from pathlib import Path

import nbformat
import numpy as np
import pytest
import tutorial
from command_line import note_on_rays, ravemj_command
from conftest import REPOSITORY
from nbclient import NotebookClient
from PIL import Image

import ravemj
from ravemj.graphics.simulation_renderer import Format

DOCS = REPOSITORY / "docs"
PAGES = {name: (DOCS / f"{name}.md").read_text() for name in tutorial.PAGES}


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


def pictures_are_those_of_the_page(name: str, folder: Path) -> None:
    shown = re.findall(rf"!\[.+\]\(pictures/({name}-.+)\)", PAGES[name])
    pages = re.findall(rf"\]\(motions/({name}-[^)]+)\)", PAGES[name])
    assert sorted([*shown, *pages]) == sorted(path.name for path in folder.glob(f"{name}-*"))
    rays_draw = ravemj.Environment().renderer.backend(Format()) == "ray"
    limit = 10 if rays_draw else 0.5  # rays cast no shadows, and have other edges
    for picture in shown:
        drawn, kept = (np.asarray(Image.open(path / picture), float) for path in (folder, DOCS / "pictures"))
        assert drawn.shape == kept.shape
        assert np.abs(drawn - kept).mean() < limit, f"{picture} looks different now: run scripts/docs"


@pytest.mark.stress
@pytest.mark.filterwarnings("ignore")  # Jupyter's own
def test_the_first_tutorial_runs_in_a_notebook(folder):
    blocks = tutorial.outputs(tutorial.as_json(tutorial.cells_of(PAGES["tutorial"])), folder)
    assert len(blocks) > 20
    for printed, said in blocks:
        assert printed.replace(note_on_rays(), "") == said
    pictures_are_those_of_the_page("tutorial", folder)


@pytest.mark.stress
@pytest.mark.filterwarnings("ignore")  # Jupyter's own
@pytest.mark.parametrize("name", tutorial.PAGES)
def test_the_cells_of_a_notebook_show_what_is_stored_in_them(name, folder):
    kept, run = (nbformat.read(DOCS / "notebooks" / f"{name}.ipynb", as_version=4) for _ in range(2))
    NotebookClient(run, timeout=300, resources={"metadata": {"path": str(folder)}}).execute()
    pairs = [(now, then) for now, then in zip(run.cells, kept.cells, strict=True) if "SetViewer" not in now.source]
    for cells in pairs:
        shown, stored = ([sorted(one.data) for one in cell.get("outputs", []) if "data" in one] for cell in cells)
        kinds = [[kind for kind in data if kind not in {"text/plain", "image/jpeg"}] for data in shown]  # Pillow's JPEG
        assert [data for data in kinds if data] == stored, cells[0].source


@pytest.mark.stress
@pytest.mark.parametrize("name", [name for name in tutorial.PAGES if name != "tutorial"])
def test_the_other_tutorials_run(name, folder, monkeypatch, capsys):
    """As scripts, which is quicker."""
    monkeypatch.chdir(folder)
    session: dict[str, object] = {"__name__": "__main__"}
    for cell in tutorial.cells_of(PAGES[name]):
        first, _, rest = (source := cell["source"]).partition("\n")
        if cell["cell_type"] != "code":
            continue
        if first.startswith("%%writefile "):
            (folder / first.split()[1]).write_text(rest)
            continue
        if first.startswith("!ravemj "):
            assert not rest
            done = ravemj_command(folder, *shlex.split(first)[1:], COLUMNS="100")
            printed = done.stdout
            assert done.stderr in {"", note_on_rays()}
        else:
            exec(compile(source, f"{name}.md", "exec"), session)
            printed = capsys.readouterr().out
        said = "".join(output["text"] for output in cell["outputs"])
        assert [line.rstrip() for line in printed.strip().splitlines()] == said.strip().splitlines()
    pictures_are_those_of_the_page(name, folder)


@pytest.mark.parametrize("name", tutorial.PAGES)
def test_the_notebook_is_the_page(name):
    made = tutorial.notebook(PAGES[name], DOCS / "pictures")
    assert (DOCS / "notebooks" / f"{name}.ipynb").read_text() == made, "run scripts/docs"


@pytest.mark.parametrize("name", tutorial.PAGES)
def test_the_notebook_holds_all_pictures_of_the_page_and_is_small(name):
    path = DOCS / "notebooks" / f"{name}.ipynb"
    text = path.read_text()
    assert path.stat().st_size <= 300_000
    assert "pictures/" not in text
    assert not re.search(r"\.save\(|^video = ", text, re.MULTILINE), "cells show their pictures"
    cells = json.loads(text)["cells"]
    attached = [file for cell in cells for file in cell.get("attachments", {})]
    shown = [output["data"] for cell in cells for output in cell.get("outputs", []) if "data" in output]
    assert len(attached) + len(shown) == len(re.findall(r"!\[.*\]\(pictures/", PAGES[name]))
    for data in [*shown, *(data for cell in cells for data in cell.get("attachments", {}).values())]:
        ((kind, content),) = data.items()
        source = content if kind != "text/html" else re.search(r'src="data:image/webp;base64,([^"]+)"', content)[1]
        with Image.open(io.BytesIO(base64.b64decode(source))) as picture:
            assert f"image/{picture.format.lower()}" == kind or picture.is_animated


@pytest.mark.parametrize("name", tutorial.PAGES)
def test_links_of_the_notebook_lead_somewhere(name):
    path = DOCS / "notebooks" / f"{name}.ipynb"
    cells = json.loads(path.read_text())["cells"]
    prose = "\n".join(cell["source"] for cell in cells if cell["cell_type"] == "markdown")
    for target in re.findall(r"\]\(([^)#]+)", prose):
        assert target.startswith("attachment:") or "://" in target or (path.parent / target).exists(), target


def test_both_sides_of_the_law_of_cosines_agree():
    """What stands beside the formulas stands in the function."""
    page = PAGES["tip"]
    lines = re.findall(r"^\| .+ \| `(.+)` \|$", page, re.MULTILINE)
    assert len(lines) == 5
    for line in lines:
        assert f"    {line}\n" in page


def test_what_is_explained_stands_in_the_file():
    """Fragments of XML are pieces of the file that the page saves before."""
    fragments = re.findall(r"^```xml\n(.*?)^```", PAGES["tutorial"], re.MULTILINE | re.DOTALL)
    assert len(fragments) > 4
    models = DOCS.parent / "models"
    for name in ("env.xml", "double-pendulum.xml"):
        assert f"```xml {name}\n{(models / name).read_text()}```" in PAGES["tutorial"]
    for fragment in fragments:
        assert fragment in (models / "double-pendulum.xml").read_text()


def test_the_biped_moves_in_mink(capsys):
    """The block runs where mink is installed; the hand gets to its target."""
    pytest.importorskip("mink")
    (block,) = re.findall(r"^```py\n(.*?)^```", PAGES["humanoids"], re.MULTILINE | re.DOTALL)
    exec(compile(block, "humanoids.md", "exec"), {})
    error = [float(number) for number in capsys.readouterr().out.strip(" []\n").split()]
    assert np.abs(error).max() < 1e-3
