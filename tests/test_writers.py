"""Models that are written and read again: the same numbers, and the same bytes when they are written once more."""

import csv
import io
import os
import warnings
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from agreement import CORPUS, NEEDS_THE_CORPUS
from conftest import MODELS, REPOSITORY
from hypothesis import given
from strategies import Taste, examples, scene_node, scenes, xml

import ravemj
from ravemj.errors import Diagnostics, OutputError
from ravemj.formats.openrave_xml.writer import write as openrave_document
from ravemj.formats.readers import read_file
from ravemj.formats.writers import save
from ravemj.model.comparison import compare
from ravemj.model.scene import Scene, TriMesh

pytestmark = pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")

INPUTS = sorted(
    path.relative_to(REPOSITORY).as_posix()
    for folder in (MODELS, REPOSITORY / "tests" / "conformance" / "cases", REPOSITORY / "tests" / "data")
    for path in folder.rglob("*")
    if path.suffix in {".xml", ".dae", ".zae"}
)
KNOWN_LOSSES = {
    ("collada", "errors-38-manipulator-unknown-link"): {"manipulators"},  # COLLADA has none without both links
    ("collada", "errors-39-manipulator-empty"): {"manipulators"},
    ("collada", "errors-46-mimic-circular"): {"follows DOFs"},  # an equation that OpenRAVE throws away
    ("openrave", "calibration_board.dae"): {"shapes"},  # OpenRAVE XML has no such shape; a box stands for it
}
NAMES = {"openrave": "model.env.xml", "collada": "model.dae"}


def corpus() -> list[str]:
    if not (CORPUS / "index.csv").is_file():
        return []
    with open(CORPUS / "index.csv", encoding="utf8") as file:
        return [row["file"] for row in csv.DictReader(file)]


def check_round_trip(scene: Scene, kind: str, folder: Path) -> set[str]:
    """Write and read a scene, and write it again; return what quantities differ. The second files equal the first."""
    first, second = folder / "first", folder / "second"
    for target in (first, second):
        target.mkdir(exist_ok=True)
    save(first / NAMES[kind], scene, Diagnostics(), kind)
    reading = read_file(first / NAMES[kind])
    assert reading.failure is None
    save(second / NAMES[kind], reading.scene, Diagnostics(), kind)
    assert contents(second) == contents(first)
    return {difference.quantity for difference in compare(scene, reading.scene)}


def contents(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def losses(kind: str, name: str) -> set[str]:
    return next((lost for (form, part), lost in KNOWN_LOSSES.items() if form == kind and part in name), set())


@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("name", INPUTS)
def test_inputs_survive(kind, name, tmp_path, monkeypatch):
    monkeypatch.delenv("OPENRAVE_DATA", raising=False)
    reading = read_file(REPOSITORY / name)
    if reading.failure is not None or not reading.scene.bodies:
        pytest.skip("it does not load")
    assert check_round_trip(reading.scene, kind, tmp_path) == losses(kind, name)


@pytest.mark.corpus
@pytest.mark.skipif(not CORPUS.is_dir(), reason="there are no published models in ../shared/corpus")
@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("name", corpus())
def test_published_models_survive(kind, name, tmp_path, monkeypatch):
    monkeypatch.setenv("OPENRAVE_DATA", str(CORPUS / "models" / "rdiankov+openrave" / "src"))
    reading = read_file(CORPUS / "models" / name)
    if reading.failure is not None or not reading.scene.bodies:
        pytest.skip("it does not load")
    assert check_round_trip(reading.scene, kind, tmp_path) == losses(kind, name)


@pytest.mark.parametrize("kind", NAMES)
@examples(100)
@given(scene=scenes(Taste(bodies=2)))
def test_random_scenes_survive(kind, tmp_path, scene):
    (tmp_path / "model.xml").write_text(xml(scene_node(scene)))
    reading = read_file(tmp_path / "model.xml")
    if reading.failure is None:
        assert check_round_trip(reading.scene, kind, tmp_path) == set()
