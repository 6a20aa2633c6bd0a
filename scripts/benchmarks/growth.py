"""Large models: what takes a time t for n parts takes about 2 t for 2 n, whatever they are."""

import contextlib
import io
import os
import re
import tempfile
from collections.abc import Callable
from pathlib import Path

import ravemj
from benchmarks.measure import ROOT, Row, microseconds, take_turns
from ravemj.cli import main
from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.openrave_xml import writer as openrave_xml
from ravemj.formats.readers import read_file
from ravemj.model.comparison import compare

_LIMIT = 1.4
"""Ratio of the time for 2 n parts to twice that for n parts; 2 if it grew with the square."""
_BOX = '<Geom type="box"><extents>0.1 0.1 0.1</extents></Geom>'
_ARM = ROOT / "tests" / "data" / "collada" / "arm.dae"


def rows() -> list[Row]:
    """Measure each kind of large model at two sizes."""
    os.environ["RAVEMJ_CACHE"] = "off"
    with tempfile.TemporaryDirectory() as folder:
        return [
            _row("read links on one base", _links, _read, 1000, Path(folder)),
            _row("read links in a chain, listed from its end", _chain, _read, 1000, Path(folder)),
            _row("compare links on one base", _links, _compare, 250, Path(folder)),
            _row("save links on one base as COLLADA", _links, _save_collada, 500, Path(folder)),
            _row("save links on one base as OpenRAVE XML", _links, _save_xml, 500, Path(folder)),
            _row("read links on one base from JSON", _json_links, _load, 500, Path(folder)),
            _row("ravemj info of links", _links, _info, 500, Path(folder)),
            _row("read joints that follow another one", _followers, _read, 500, Path(folder)),
            _row("read unknown tags", _unknown_tags, _read, 5000, Path(folder)),
            _row("ravemj info of bodies", _bodies, _info, 500, Path(folder)),
            _row("add and remove bodies", _bodies, _remove, 1000, Path(folder)),
            _row("read groups of triangles in COLLADA", _groups, _read, 500, Path(folder)),
            _row("read bodies from COLLADA", _collada_bodies, _read, 100, Path(folder)),
        ]


def _row(what: str, make: Callable[[int], str], use: Callable[[str], object], count: int, folder: Path) -> Row:
    suffix = {"_groups": ".dae", "_collada_bodies": ".dae", "_json_links": ".json"}.get(make.__name__, ".xml")
    paths = [folder / f"{make.__name__}{number}{suffix}" for number in (count, 2 * count)]
    for path, number in zip(paths, (count, 2 * count), strict=True):
        path.write_text(make(number))
    small, large = take_turns([microseconds(lambda path=path: use(str(path))) for path in paths], 5)
    return Row(f"{what}: {2 * count} : twice {count}", "µs", large, 2 * small, _LIMIT)


def _read(path: str) -> object:
    return mjcf.write(read_file(path).scene, Diagnostics())


def _load(path: str) -> object:
    return ravemj.Environment().Load(path)


def _compare(path: str) -> object:
    return compare(read_file(path).scene, read_file(path).scene)


def _info(path: str) -> object:
    with contextlib.redirect_stdout(io.StringIO()):
        return main(["info", path])


def _remove(path: str) -> object:
    env = ravemj.Environment()
    env.Load(path)
    return [env.Remove(body) for body in env.GetBodies()]


def _saved(path: str, suffix: str) -> str:
    env = ravemj.Environment()
    env.Load(path)
    target = f"{path}.saved{suffix}"
    env.Save(target)
    return target


def _save_collada(path: str) -> object:
    return _saved(path, ".dae")


def _save_xml(path: str) -> object:
    return openrave_xml.write(read_file(path).scene, Diagnostics())


def _links(count: int) -> str:
    return _body(count, lambda number: (0, number))


def _chain(count: int) -> str:
    return _body(count, lambda number: (count - number, count - number - 1))


def _body(count: int, joint: Callable[[int], tuple[int, int]]) -> str:
    links = "".join(f'<Body name="b{number}" type="dynamic">{_BOX}</Body>' for number in range(count))
    joints = "".join(_joint(number, *joint(number)) for number in range(1, count))
    return f'<Robot name="r"><KinBody>{links}{joints}</KinBody></Robot>'


def _joint(number: int, first: int, second: int, attributes: str = "") -> str:
    return f'<Joint name="j{number}" type="hinge"{attributes}><Body>b{first}</Body><Body>b{second}</Body></Joint>'


def _followers(count: int) -> str:
    joints = (_joint(number, 0, number, f' mimic_pos="j1*{number}"' * (number > 1)) for number in range(1, count))
    links = "".join(f'<Body name="b{number}"/>' for number in range(count))
    return f'<Robot name="r"><KinBody>{links}{"".join(joints)}</KinBody></Robot>'


def _unknown_tags(count: int) -> str:
    tags = "".join(f"<tag{number}/>" for number in range(count))
    return f'<KinBody name="k"><Body name="b">{tags}</Body></KinBody>'


def _bodies(count: int) -> str:
    bodies = (f'<KinBody name="k{number}"><Body name="b">{_BOX}</Body></KinBody>' for number in range(count))
    return f"<Environment>{''.join(bodies)}</Environment>"


def _json_links(count: int) -> str:
    return _written(_links(count), ".json")


def _collada_bodies(count: int) -> str:
    return _written(_bodies(count), ".dae")


def _written(text: str, suffix: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "model.xml")
        path.write_text(text)
        return Path(_saved(str(path), suffix)).read_text()


def _groups(count: int) -> str:
    """Return an arm, one of whose shapes has its triangles in groups with a material each."""
    text = _ARM.read_text()
    for pattern in (r"<triangles .*?</triangles>", r"<instance_material .*?/>"):
        text = re.sub(
            pattern,
            lambda found: "".join(found[0].replace('"paint"', f'"paint{number}"') for number in range(count)),
            text,
            count=1,
            flags=re.DOTALL,
        )
    return text
