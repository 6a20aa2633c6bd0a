"""COLLADA robots: how long reading one takes, by its parts, and how much memory."""

import os
import runpy
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

from lxml import etree

from benchmarks.measure import ROOT, Row, microseconds, peak_memory, take_turns
from benchmarks.reading import CORPUS
from ravemj.engine.simulation import Compiled
from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.collada.archive import Archive
from ravemj.formats.meshes.collada.document import ColladaDocument
from ravemj.formats.meshes.collada.triangles import triangle_meshes
from ravemj.formats.readers import read_file
from ravemj.formats.writers import ModelFormat, save

_ROBOTS = CORPUS / "rdiankov+collada_robots"
_CORNERS = 1000  # of the circles of the SCARA: meshes as large as those of real robots
_BOX = "<box><half_extents>0.1 0.1 0.1</half_extents></box>"
_INFO = f"<extra type='geometry_info'><technique profile='OpenRAVE'>{_BOX}</technique></extra>"
_IMPORT = (
    "import sys, hashlib; from ravemj.formats import collada, readers; "
    "from ravemj.formats.meshes.collada import triangles; "
)
_ROUNDS = 5


def rows() -> list[Row]:
    """Measure a robot of our own and, where the corpus of published models is, two of the largest in it."""
    with tempfile.TemporaryDirectory() as folder:
        scara = Path(folder) / "scara.zae"
        script = runpy.run_path(str(ROOT / "scripts" / "models" / "scara.py"))
        script["outline"].__globals__["CORNERS"] = _CORNERS
        _write(scara, script["document"]().encode())
        found = [*_times("SCARA, 5 links", scara, Path(folder)), _memory("SCARA", scara)]
        found += _published("PR2, 88 links", "willowgarage-pr2.zae", Path(folder), 1.5)
        return found + _published("WAM with hand, 17 links", "barrett-wamhand.zae", Path(folder))


def _published(name: str, file: str, folder: Path, limit: float | None = None) -> list[Row]:
    path = _ROBOTS / file
    if not path.is_file():
        return [Row(f"{name}: left out", "", 0.0, note=f"there is no {path}; it belongs to another project")]
    return [*_times(name, path, folder, limit), *_saved(name, path, folder), _memory(name, path)]


def _saved(name: str, path: Path, folder: Path) -> list[Row]:
    """Measure saving and reading back in both formats, without a cache, against reading."""
    scene = read_file(path).scene
    files: dict[ModelFormat, Path] = {"collada": folder / "saved.dae", "openrave": folder / "saved.robot.xml"}

    def there_and_back(kind: ModelFormat) -> None:
        save(files[kind], scene, Diagnostics(), kind)
        read_file(files[kind])

    os.environ["RAVEMJ_CACHE"] = "off"
    reading, collada, xml = take_turns(
        [
            microseconds(lambda: read_file(path)),
            microseconds(lambda: there_and_back("collada")),
            microseconds(lambda: there_and_back("openrave")),
        ],
        _ROUNDS,
    )
    return [
        Row(f"{name}, save as COLLADA and read back : read", "µs", collada, reading, 3.0),
        Row(f"{name}, save as OpenRAVE XML and read back : read", "µs", xml, reading, 3.0),
    ]


def _times(name: str, path: Path, folder: Path, limit: float | None = None) -> list[Row]:
    """Measure the parts of the first reading, without a cache, and the second reading."""
    data = _document(path)
    boxed = folder / f"boxed-{path.name}"
    _write(boxed, _without_meshes(data))
    document = ColladaDocument(data, "document")
    geometries = list(document.root.iter("{*}geometry"))
    scene = read_file(path).scene
    os.environ["RAVEMJ_CACHE"] = "off"
    whole, parse, meshes, write, compiled = take_turns(
        [
            microseconds(lambda: Compiled(read_file(path).scene, Diagnostics())),
            microseconds(lambda: ColladaDocument(_document(path), "document")),
            microseconds(lambda: [triangle_meshes(document, geometry, 1.0) for geometry in geometries]),
            microseconds(lambda: mjcf.write(scene, Diagnostics())),
            microseconds(lambda: Compiled(scene, Diagnostics())),
        ],
        _ROUNDS,
    )
    os.environ["RAVEMJ_CACHE"] = str(folder / "cache")
    warm, plain = take_turns([_translation(path), _translation(boxed)], _ROUNDS)
    os.environ["RAVEMJ_CACHE"] = "off"
    note = "OpenRAVE takes 0.48 s on another machine" if name.startswith("PR2") else ""
    return [
        Row(f"{name}, first time, from file to compiled model", "µs", whole, note=note),
        Row("  unzip and parse", "µs", parse),
        Row("  meshes", "µs", meshes),
        Row("  the rest of reading", "µs", max(whole - parse - meshes - compiled, 0)),
        Row("  translate", "µs", write),
        Row("  compile", "µs", max(compiled - write, 0)),
        Row(f"{name}, meshes in the cache, read and translate : boxes for meshes", "µs", warm, plain, limit),
    ]


def _translation(path: Path) -> Callable[[], float]:
    return microseconds(lambda: mjcf.write(read_file(path).scene, Diagnostics()))


def _document(path: Path) -> bytes:
    archive = Archive(str(path))
    return archive.read(archive.root())


def _write(path: Path, document: bytes) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("robot.dae", document)


def _without_meshes(document: bytes) -> bytes:
    """Return a document with a box in place of each mesh."""
    root = etree.fromstring(document, etree.XMLParser(huge_tree=True))
    for geometry in root.iter("{*}geometry"):
        for mesh in geometry.findall("{*}mesh"):
            geometry.replace(mesh, etree.fromstring(_INFO))
    return etree.tostring(root)


def _memory(name: str, path: Path) -> Row:
    """Compare what reading takes beyond the imports with the unpacked file."""
    imports = peak_memory("-c", _IMPORT)
    reading = peak_memory("-c", f"{_IMPORT}readers.read_file(sys.argv[1])", str(path))
    what = f"{name}, first time, peak memory of reading beyond that of the imports : the unpacked file"
    return Row(what, "MB", reading - imports, len(_document(path)) / 1e6, 20.0)
