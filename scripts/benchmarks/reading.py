"""Reading and translating larger models: how the time grows, and what meshes cost."""

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import mujoco

from benchmarks.measure import ROOT, Row, microseconds, take_turns
from ravemj.engine.simulation import Compiled
from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.readers import read_file

CORPUS = ROOT.parent / "shared" / "corpus" / "models"
WAM = CORPUS / "rdiankov+openrave" / "src" / "robots" / "barrettwam.robot.xml"
_BODIES = 500


def rows() -> list[Row]:
    """Measure rows of boxes and, where the corpus of published models is, the Barrett WAM with its meshes."""
    with tempfile.TemporaryDirectory() as folder:
        return _boxes(Path(folder)) + (_wam(Path(folder)) if WAM.is_file() else [])


def _boxes(folder: Path) -> list[Row]:
    small, middle, large, most = (_box_file(folder, count) for count in (10, 100, _BODIES, 1000))
    text = _box_mjcf(_BODIES)
    compile_floor = microseconds(lambda: mujoco.MjModel.from_xml_string(text))
    times = take_turns([_translation(path) for path in (small, middle, large, most)] + [compile_floor], 10)
    ten, hundred, five_hundred, thousand, bare = times
    return [
        Row("read and translate 1000 boxes : ten times 100 boxes", "µs", thousand, 10 * hundred, 1.5),
        Row("read and translate 100 boxes : ten times 10 boxes", "µs", hundred, 10 * ten, 1.5),
        Row("read and translate 500 boxes : MuJoCo compiles them", "µs", five_hundred, bare, 6.0),
    ]


def _translation(path: Path) -> Callable[[], float]:
    return microseconds(lambda: mjcf.write(read_file(path).scene, Diagnostics()))


def _box_file(folder: Path, count: int) -> Path:
    bodies = "".join(
        f'<KinBody name="k{i}"><Translation>{i} 0 0</Translation><Body name="b{i}" type="dynamic">'
        f'<Geom type="box"><extents>0.1 0.2 0.3</extents><diffuseColor>1 0 0</diffuseColor></Geom>'
        f'<Mass type="mimicgeom"><density>1000</density></Mass></Body></KinBody>\n'
        for i in range(count)
    )
    path = folder / f"boxes{count}.env.xml"
    path.write_text(f"<Environment>{bodies}</Environment>")
    return path


def _box_mjcf(count: int) -> str:
    bodies = "".join(
        f'<body name="b{i}" pos="{i} 0 0"><geom type="box" size="0.1 0.2 0.3" rgba="1 0 0 1"/></body>\n'
        for i in range(count)
    )
    return f"<mujoco><worldbody>{bodies}</worldbody></mujoco>"


def _wam(folder: Path) -> list[Row]:
    """Measure the parts of the first loading, without a cache, and of the second one."""
    os.environ["OPENRAVE_DATA"] = str(CORPUS / "rdiankov+openrave" / "src")
    os.environ["RAVEMJ_CACHE"] = str(folder / "cache")
    boxed = _without_meshes(folder)
    scene = read_file(WAM).scene
    warm, plain, write, whole = take_turns(
        [
            _translation(WAM),
            _translation(boxed),
            microseconds(lambda: mjcf.write(scene, Diagnostics())),
            microseconds(lambda: Compiled(read_file(WAM).scene, Diagnostics())),
        ],
        7,
    )
    os.environ["RAVEMJ_CACHE"] = "off"
    cold, cold_whole = take_turns(
        [_translation(WAM), microseconds(lambda: Compiled(read_file(WAM).scene, Diagnostics()))], 5
    )
    return [
        Row("WAM, meshes in the cache, read and translate : boxes for meshes", "µs", warm, plain, 1.5),
        Row("  WAM, first time, read and translate", "µs", cold),
        Row("  WAM, first time, from file to compiled model", "µs", cold_whole, 1e6, 1.0),
        Row("  WAM, from file to compiled model, meshes in the cache", "µs", whole),
        Row("  WAM, translate alone", "µs", write),
    ]


def _without_meshes(folder: Path) -> Path:
    """Write the WAM with a box in place of each mesh."""
    target = folder / "boxed"
    target.mkdir()
    for name in ("barrettwam.robot.xml", "wam7.kinbody.xml", "barretthand.kinbody.xml"):
        text = (WAM.parent / name).read_text()
        lines = [line for line in text.splitlines() if "<render>" not in line.lower() and "<data>" not in line.lower()]
        text = "\n".join(lines).replace('"trimesh"', '"box"')
        for end in ("</Geom>", "</geom>"):
            text = text.replace(end, f"<extents>.1 .1 .1</extents>{end}")
        (target / name).write_text(text)
    return target / "barrettwam.robot.xml"
