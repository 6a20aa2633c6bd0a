"""The package itself: what may import what, what is exported, what an import costs."""

import ast
import re
import subprocess
import sys
import tokenize
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
from rooms import blocks, statements

import ravemj
from ravemj.compat import names

PACKAGE = Path(ravemj.__file__).parent


ROOMS = [
    "errors",
    "core",
    "geometry_functions",
    "model",
    "formats",
    "engine",
    "trajectories",
    "ik",
    "planning",
    "manipulation",
    "robots",
    "graphics",
    "gui",
    "rave",
    "learn",
    "sweeps",
    "compat",
    "__init__",
    "cli",
    "__main__",
]
"""The boxes of docs/architecture.md from the ground up: each may import the earlier ones, and itself."""

NO_CODE = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}

WITHOUT_MUJOCO = {"errors", "core", "geometry_functions", "model", "formats", "trajectories", "planning"}


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def modules():
    return sorted(path for path in PACKAGE.rglob("*.py"))


def room(path: Path) -> str:
    """The box of a module; those that give packages of ``compat`` the names of ``ravemj`` belong to its front."""
    first = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
    return "__init__" if first in names.PUBLIC else first


def imports(path: Path):
    """Names of all modules that a file imports, anywhere in it."""
    for node in statements(tree(path)):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute"
            names = [f"{node.module}.{name.name}" for name in node.names]
            yield from names if node.module == "ravemj" else [node.module]


def goes_up(path: Path, name: str) -> bool:
    """Return whether a module imports one of a room above its own, without a stated reason."""
    here, parts = room(path), name.split(".")
    if parts[0] != "ravemj":
        return False
    there = parts[1] if len(parts) > 1 and parts[1] in ROOMS else "__init__"
    if (here, there) == ("compat", "__init__"):  # openravepy gives what ravemj does
        return False
    if name.startswith("ravemj.engine.mjcf_reading") and path.name == "readers.py":  # MuJoCo reads MJCF
        return False
    return ROOMS.index(there) > ROOMS.index(here)


def test_imports_go_down():
    assert [(module_name(path), name) for path in modules() for name in imports(path) if goes_up(path, name)] == []


def module_name(path: Path) -> str:
    """Name of a module behind the package's: ``rave.kinbody`` for ``ravemj/rave/kinbody.py``."""
    return ".".join(path.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__")


MODULES = {module_name(path): path for path in modules()}


def modules_imported(node: ast.AST, typing: bool) -> set[str]:
    """Names of the package's modules that the code under a node imports, in functions too.

    Args:
        node: What to look through.
        typing: Whether imports for type checkers count.
    """
    if isinstance(node, ast.Import):
        names = {name.name for name in node.names}
    elif isinstance(node, ast.ImportFrom):
        members = {f"{node.module}.{name.name}" for name in node.names}
        names = {name if name.removeprefix("ravemj.") in MODULES else node.module for name in members}
    else:
        below = blocks(node)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING" and not typing:
            below = node.orelse
        return set().union(*(modules_imported(child, typing) for child in below))
    return {name.removeprefix("ravemj.") for name in names} & MODULES.keys()


def with_packages(name: str, imported: set[str]) -> set[str]:
    """Return modules with the packages around them, whose ``__init__`` is run first, except those around ``name``."""
    around = {one.rpartition(".")[0] for one in imported} & MODULES.keys()
    return imported | {one for one in around if not name.startswith(one)}


@cache
def circles(typing: bool) -> list[set[str]]:
    """Sets of more than one module that all lead to each other by imports: strongly connected components."""
    imported = {name: with_packages(name, modules_imported(tree(path), typing)) for name, path in MODULES.items()}

    def reached(start: str) -> set[str]:
        found, pending = set(), [start]
        while pending:
            new = imported[pending.pop()] - found
            found |= new
            pending += new
        return found

    reach = {name: reached(name) for name in imported}
    found = {frozenset(other for other in reach[name] if name in reach[other]) for name in reach}
    return [set(circle) for circle in found if len(circle) > 1]


def test_no_imports_go_round_in_the_api():
    assert not [circle for circle in circles(typing=False) if any(name.startswith("rave.") for name in circle)]


def test_few_modules_of_the_api_name_each_other():
    """Classes of the API take and return one another. What more is in their circle is read together with them."""
    found = [circle for circle in circles(typing=True) if any(name.startswith("rave.") for name in circle)]
    assert len(set().union(*found)) <= 31
    assert all(name.split(".")[0] == "rave" for circle in found for name in circle)


def test_the_api_says_its_types():
    """``Any``, ``cast`` and annotations in quotes hide types; of each there may be fewer than today."""
    nodes = [node for path in modules() if room(path) == "rave" for node in ast.walk(tree(path))]
    names = Counter(node.id for node in nodes if isinstance(node, ast.Name))
    calls = Counter(node.func.id for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Name))
    assert names["Any"] <= 100
    assert calls["cast"] <= 18
    assert sum(map(quoted, nodes)) <= 286


def quoted(node: ast.AST) -> int:
    """Return the number of annotations in quotes that a node has itself."""
    annotations = [node.annotation] if isinstance(node, ast.arg | ast.AnnAssign) else []
    annotations += [node.returns] if isinstance(node, ast.FunctionDef) else []
    parts = [part for annotation in annotations if annotation is not None for part in ast.walk(annotation)]
    literals = [part for part in parts if isinstance(part, ast.Subscript) and ast.unparse(part.value) == "Literal"]
    values = {one for literal in literals for one in ast.walk(literal.slice)}
    return sum(isinstance(part, ast.Constant) and isinstance(part.value, str) for part in set(parts) - values)


def test_mujoco_is_imported_by_the_engine_and_above():
    importing = {module_name(path) for path in modules() for name in imports(path) if name.split(".")[0] == "mujoco"}
    assert importing
    assert {name for name in importing if name.split(".")[0] in WITHOUT_MUJOCO} == set()


def test_fissix_is_imported_by_what_translates_python_2_alone():
    users = {module_name(path) for path in modules() if any(name.split(".")[0] == "fissix" for name in imports(path))}
    assert users == {"compat.python2.translation"}


def test_the_architecture_draws_the_rooms():
    assert {room(path) for path in modules()} == set(ROOMS)
    page = (PACKAGE.parent / "docs" / "architecture.md").read_text(encoding="utf-8")
    drawn = re.findall(r"^\| `(\w+)`", page, re.MULTILINE)
    assert drawn == [name for name in ROOMS if not name.startswith("__")]


@pytest.mark.parametrize(
    "name", ["ravemj", "ravemj.graphics.rendering", "ravemj.rave", "ravemj.gui.viewers", "ravemj.formats.openrave_xml"]
)
def test_all_is_what_is_exported(name):
    module = __import__(name, fromlist=["x"])
    assert len(set(module.__all__)) == len(module.__all__)
    for exported in module.__all__:
        assert hasattr(module, exported)


def test_everything_imported_into_the_package_is_exported():
    tree = ast.parse((PACKAGE / "__init__.py").read_text())
    froms = [node for node in tree.body if isinstance(node, ast.ImportFrom) and node.module.startswith("ravemj.")]
    imported = {alias.asname or alias.name for node in froms for alias in node.names}
    imported -= {"*", "names", "load_ipython_extension", "_published"}
    parts = {*ravemj.rave.__all__, *ravemj.geometry_functions.__all__}
    assert {"__version__", *imported, *parts} <= set(ravemj.__all__)
    assert len(set(ravemj.__all__)) == len(ravemj.__all__)


@pytest.mark.stress
def test_modules_of_openrave_are_imported_when_they_are_asked_for():
    code = "import ravemj, sys; print('ravemj.compat.databases' in sys.modules, ravemj.databases.__name__)"
    assert run(code).split() == ["False", "ravemj.compat.databases"]
    code = "from ravemj import *; import ravemj.databases.grasping as one; print(databases.grasping is one)"
    assert run(code) == "True\n"
    code = "import ravemj.misc, ravemj.interfaces, ravemj.planningutils as utils; print(utils is ravemj.planningutils)"
    assert run(code) == "True\n"


def run(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=PACKAGE.parent)
    assert done.stderr == ""
    return done.stdout


def test_import_loads_no_slow_or_optional_package():
    slow = {"IPython", "imageio", "av", "PIL", "rich", "trimesh", "fcl", "coacd", "scipy"}
    loaded = set(
        run("import ravemj, sys; ravemj.Environment; print(*{name.split('.')[0] for name in sys.modules})").split()
    )
    assert not slow & loaded


def test_import_loads_no_mujoco_before_it_is_needed():
    code = "import ravemj, sys; print('mujoco' in sys.modules); ravemj.Environment; print('mujoco' in sys.modules)"
    assert run(code).split() == ["False", "True"]


def test_mujoco_is_imported_behind_what_prepares_it():
    rooms = {room(path) for path in modules() for node in tree(path).body if "import mujoco" in ast.unparse(node)[:13]}
    assert "engine" in rooms
    for name in rooms:
        assert "ravemj.engine.mujoco_import" in imports(PACKAGE / name / "__init__.py")


def test_public_names_of_the_api_are_those_of_its_stub():
    stub = tree(PACKAGE / "rave" / "__init__.pyi").body
    listed = {name.asname for node in stub if isinstance(node, ast.ImportFrom) for name in node.names if name.asname}
    listed |= {target.id for node in stub if isinstance(node, ast.Assign) for target in node.targets}
    assert set(ravemj.rave.__all__) == listed


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_import_loads_no_gl():
    maps = run("import ravemj; ravemj.Environment; print(open('/proc/self/maps').read())")
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


def code_lines(path: Path) -> set[int]:
    """Return the lines of a module that have code; docstrings explain, and do not count."""
    texts = [node.value for node in ast.walk(tree(path)) if isinstance(node, ast.Expr)]
    texts = [node for node in texts if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    explaining = {line for node in texts for line in range(node.lineno, node.end_lineno + 1)}
    with tokenize.open(path) as file:
        tokens = [token for token in tokenize.generate_tokens(file.readline) if token.type not in NO_CODE]
    return {line for token in tokens for line in range(token.start[0], token.end[0] + 1)} - explaining


def test_modules_are_of_readable_size():
    long = {name: path for name, path in MODULES.items() if len(path.read_text(encoding="utf-8").splitlines()) > 400}
    sizes = {name: len(code_lines(path)) for name, path in long.items()}
    assert {name: lines for name, lines in sizes.items() if lines > 400} == {}


def test_typed():
    assert (PACKAGE / "py.typed").is_file()
