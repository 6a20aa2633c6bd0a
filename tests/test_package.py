"""The package itself: what may import what, what is exported, what an import costs."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

import ravemj

PACKAGE = Path(ravemj.__file__).parent


def rooms(names: str) -> set[str]:
    return set(names.split())


LEVELS = [
    rooms(row)
    for row in (
        "_mujoco errors showing transforms",
        "alias api_names arrays clock coverage_notes drawing examples expressions handles metaclass motion ordering "
        "output python2",
        "geometry_functions scene video",
        "adjacency bounds following hierarchy inertia joints making manipulators meshes summary",
        "chains fingerprints",
        "builder mjcf reach",
        "collada",
        "kinematics openrave_xml tessellation",
        "coverage dynamics placement readers rendering trajectories",
        "batch",
        "simulation",
        "collision export studio",
        "physics",
        "interaction",
        "viewers",
        "extension rave",
        "checking databases interfaces misc openravepy_int planningutils recording",
        "__init__ cli",
        "__main__ api_coverage openravepy",
    )
]
"""Rooms from the ground up: each may import those of lower levels only, within its own package what it likes."""

ALLOWED_UPWARD = {("cli", "__init__")}  # the version, at the time of the call

WITHOUT_MUJOCO = rooms(
    """
    adjacency alias arrays bounds builder chains clock collada coverage drawing errors expressions fingerprints
    following geometry_functions handles hierarchy inertia joints making manipulators meshes mjcf motion
    openrave_xml ordering output reach readers scene showing tessellation trajectories transforms video
    """
)


def modules():
    return sorted(path for path in PACKAGE.rglob("*.py"))


def room(path: Path) -> str:
    first = path.relative_to(PACKAGE).parts[0]
    return first.removesuffix(".py")


def imports(path: Path):
    """Names of all modules that a file imports, anywhere in it."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute"
            names = [f"{node.module}.{name.name}" for name in node.names]
            yield from names if node.module == "ravemj" else [node.module]


def level(name: str) -> int:
    return next(number for number, names in enumerate(LEVELS) if name in names)


@pytest.mark.parametrize("path", modules(), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_go_down(path):
    here = room(path)
    for name in imports(path):
        parts = name.split(".")
        if parts[0] != "ravemj":
            continue
        known = len(parts) > 1 and any(parts[1] in names for names in LEVELS)
        there = parts[1] if known else "__init__"
        if there != here and (here, there) not in ALLOWED_UPWARD:
            assert level(there) < level(here), f"{here} imports {there}"


@pytest.mark.parametrize("path", modules(), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_mujoco_is_imported_above_the_scene_only(path):
    if room(path) in WITHOUT_MUJOCO:
        assert not any(name.split(".")[0] == "mujoco" for name in imports(path))


def test_every_room_has_a_level():
    assert {room(path) for path in modules()} <= set().union(*LEVELS)


@pytest.mark.parametrize("name", ["ravemj", "ravemj.rendering", "ravemj.rave", "ravemj.viewers", "ravemj.openrave_xml"])
def test_all_is_what_is_exported(name):
    module = __import__(name, fromlist=["x"])
    assert len(set(module.__all__)) == len(module.__all__)
    for exported in module.__all__:
        assert hasattr(module, exported)


def test_everything_imported_into_the_package_is_exported():
    tree = ast.parse((PACKAGE / "__init__.py").read_text())
    froms = [node for node in tree.body if isinstance(node, ast.ImportFrom) and node.module.startswith("ravemj.")]
    imported = {alias.asname or alias.name for node in froms for alias in node.names} - {"*"}
    parts = {*ravemj.rave.__all__, *ravemj.geometry_functions.__all__}
    assert {"__version__", *imported, *parts} <= set(ravemj.__all__)
    assert len(set(ravemj.__all__)) == len(ravemj.__all__)


def test_modules_of_openrave_are_imported_when_they_are_asked_for():
    code = "import ravemj, sys; print('ravemj.databases' in sys.modules, ravemj.databases.__name__)"
    assert run(code).split() == ["False", "ravemj.databases"]
    assert run("from ravemj import *; print(databases.__name__)") == "ravemj.databases\n"


def run(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=PACKAGE.parent)
    assert done.stderr == ""
    return done.stdout


def test_import_loads_no_slow_or_optional_package():
    slow = {"IPython", "imageio", "av", "PIL", "rich", "trimesh", "coacd", "scipy"}
    loaded = set(run("import ravemj, sys; print(*{name.split('.')[0] for name in sys.modules})").split())
    assert not slow & loaded


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_import_loads_no_gl():
    maps = run("import ravemj; print(open('/proc/self/maps').read())")
    assert not re.findall(r"lib(?:EGL|OSMesa)\S*", maps)


def test_import_shadows_nothing():
    code = (
        "import ravemj, importlib.util as util, sys; "
        "print('openravepy' in sys.modules, util.find_spec('openravepy') is None)"
    )
    assert run(code).split() == ["False", "True"]


def test_import_after_a_missing_gl_library_was_asked_for():
    """MuJoCo itself cannot be imported then; those who want no picture, or rays, still can use ravemj."""
    code = (
        "import os, ctypes, ctypes.util; os.environ['MUJOCO_GL'] = 'egl'; os.environ['PYOPENGL_PLATFORM'] = 'egl'; "
        "load = ctypes.CDLL.__init__\n"
        "def refuse(self, name, *rest, **more):\n"
        "    if name and 'EGL' in str(name): raise OSError(name)\n"
        "    load(self, name, *rest, **more)\n"
        "ctypes.CDLL.__init__ = refuse; ctypes.util.find_library = lambda name: None\n"
        "import ravemj; print(ravemj.load('models/env.xml').GetRobots()[0].GetDOF())"
    )
    assert run(code) == "2\n"


@pytest.mark.parametrize("path", modules(), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_modules_are_rooms_of_readable_size(path):
    assert len(path.read_text().splitlines()) <= 400


def test_typed():
    assert (PACKAGE / "py.typed").is_file()
