"""Models that are written in a format, read again, and written once more."""

from pathlib import Path

from ravemj.errors import Diagnostics
from ravemj.formats.readers import read_file
from ravemj.formats.writers import ModelFormat, save
from ravemj.model.comparison import compare
from ravemj.model.scene import Scene

NAMES: dict[ModelFormat, str] = {"openrave": "model.env.xml", "collada": "model.dae"}
_REPORTS = {"unknown-tag", "unknown-attribute", "ignored-tag"}


def check_round_trip(scene: Scene, kind: ModelFormat, folder: Path) -> set[str]:
    """Write and read a scene, and write it again; return what quantities differ. The second files equal the first."""
    first, second = folder / "first", folder / "second"
    for target in (first, second):
        target.mkdir(exist_ok=True)
    save(first / NAMES[kind], scene, Diagnostics(), kind)
    reading = read_file(first / NAMES[kind])
    assert reading.failure is None
    assert not {finding.code for finding in reading.diagnostics} & _REPORTS
    save(second / NAMES[kind], reading.scene, Diagnostics(), kind)
    assert contents(second) == contents(first)
    return {difference.quantity for difference in compare(scene, reading.scene)}


def contents(folder: Path) -> dict[str, bytes]:
    """Return the content of all files in a folder, by their paths in it."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
