"""Robots of the packages ``robot_descriptions`` and ``mujoco-menagerie`` by name (extra ``robots``).

Names and paths are read from the packages' source files without importing them, since importing a module of
``robot_descriptions`` fetches a repository. Nothing is fetched unless the caller requests it.
"""

import ast
import difflib
import importlib
import importlib.util
import json
import os
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, cast

from ravemj.errors import ArgumentError, RavemjError

INSTALL = 'pip install "ravemj[robots]" adds robots by name'
_DESCRIPTIONS, _MENAGERIE = "robot_descriptions", "mujoco_menagerie"
_SUFFIX = "_description"
_FILES = ("MJCF_PATH", "URDF_PATH", "XACRO_PATH")
"""Variables with the model's path in a module of ``robot_descriptions``, in order of preference."""

_LIKENESS = 0.7


class RobotFile(NamedTuple):
    """A robot of a package.

    Attributes:
        path: Its file, or None if it is not on this machine.
        origin: Address to fetch it from.
        arguments: Arguments of a xacro.
        fetch: Fetches it and returns its path.
    """

    path: str | None
    origin: str
    arguments: Mapping[str, str]
    fetch: Callable[[], str]


def robot_names() -> list[str]:
    """Return the names of the robots of the installed packages."""
    folder = _folder(_DESCRIPTIONS)
    modules = [] if folder is None else [path.stem for path in folder.glob(f"[!_]*{_SUFFIX}.py")]
    return sorted({*modules, *_registry()})


def is_robot_name(word: str) -> bool:
    """Return whether a word may be the name of a robot: it has neither a suffix nor a slash."""
    return bool(word) and not set(word) & {".", "/", os.sep} and word in robot_names()


def robot_file(name: str, *, download: bool = False, say: Callable[[str], None] | None = None) -> RobotFile:
    """Return a robot of a package, fetching it if necessary.

    Args:
        name: Its name, for instance ``ur5e_mj_description`` or ``universal_robots_ur5e``.
        download: Whether it may be fetched.
        say: Receives a message before a download.

    Raises:
        ArgumentError: there is no such robot, or it is not on this machine and may not be fetched.
        RavemjError: it cannot be fetched.
    """
    package = _described(name) or _in_menagerie(name)
    if package is None:
        close = difflib.get_close_matches(name, robot_names(), 1, _LIKENESS)
        hint = f"; did you mean {close[0]}?" if close else ""
        reason = hint or (f"; {INSTALL}" if not robot_names() else "")
        raise ArgumentError(f"there is no robot '{name}'{reason}")
    if package.path is not None:
        return package
    if not download:
        message = f"'{name}' is not on this machine; with --download (in Python download=True) it is fetched from"
        raise ArgumentError(f"{message} {package.origin}")
    if say is not None:
        say(f"fetching '{name}' from {package.origin}")
    try:
        return package._replace(path=package.fetch())
    except Exception as error:  # of git, of the network, of the packages
        reason = " ".join(str(error).split()) or type(error).__name__
        raise RavemjError(f"cannot fetch '{name}' from {package.origin}: {reason[:200]}") from None


def _folder(package: str) -> Path | None:
    """Return the folder of an installed package without importing it; None if it is not installed."""
    spec = importlib.util.find_spec(package)
    places = None if spec is None else spec.submodule_search_locations
    return Path(next(iter(places))) if places else None


# robot_descriptions


def _described(name: str) -> RobotFile | None:
    folder = _folder(_DESCRIPTIONS)
    module = None if folder is None else folder / f"{name}.py"
    if folder is None or module is None or not name.endswith(_SUFFIX) or not module.is_file():
        return None
    values = _Assignments(_repositories(str(folder)))
    values.visit(ast.parse(module.read_text(encoding="utf-8")))
    path = next((values.texts[key] for key in _FILES if key in values.texts), None)
    here = path if path is not None and os.path.isfile(path) else None

    def fetch() -> str:
        module: Any = importlib.import_module(f"{_DESCRIPTIONS}.{name}")
        return next(str(getattr(module, key)) for key in _FILES if hasattr(module, key))

    return RobotFile(here, values.origin, values.arguments, fetch)


@cache
def _repositories(folder: str) -> dict[str, dict[str, str]]:
    """Return address, commit and cache folder of each repository that ``robot_descriptions`` lists, by name."""
    repositories: dict[str, dict[str, str]] = {}
    for node in ast.walk(ast.parse(Path(folder, "_repositories.py").read_text(encoding="utf-8"))):
        if not isinstance(node, ast.Dict):
            continue
        for key, value in zip(node.keys, node.values, strict=True):
            if isinstance(key, ast.Constant) and isinstance(value, ast.Call):
                fields = [(word.arg, word.value) for word in value.keywords]
                texts = {
                    str(arg): str(constant.value) for arg, constant in fields if isinstance(constant, ast.Constant)
                }
                repositories[str(key.value)] = texts
    return repositories


class _Assignments(ast.NodeVisitor):
    """Evaluator of the assignments in a module of ``robot_descriptions``.

    Attributes:
        texts: Paths by variable name.
        origin: Address of the repository.
        arguments: Arguments of a xacro.
    """

    def __init__(self, repositories: dict[str, dict[str, str]]) -> None:
        self.texts: dict[str, str] = {}
        self.origin = ""
        self.arguments: dict[str, str] = {}
        self._repositories = repositories

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        self._assign(node.target, node.value)

    def visit_Assign(self, node: ast.Assign) -> None:
        self._assign(node.targets[0], node.value)

    def _assign(self, target: ast.expr, value: ast.expr | None) -> None:
        if not isinstance(target, ast.Name) or value is None:
            return
        if isinstance(value, ast.Dict):
            pairs = zip(value.keys, value.values, strict=True)
            self.arguments = {str(_constant(key)): str(_constant(constant)) for key, constant in pairs}
            return
        text = self._text(value)
        if text is not None:
            self.texts[target.id] = text

    def _text(self, value: ast.expr) -> str | None:
        """Evaluate an expression for a path; return None if the expression is not supported."""
        if isinstance(value, ast.Constant):
            return str(value.value)
        if isinstance(value, ast.Name):
            return self.texts.get(value.id)
        if not isinstance(value, ast.Call):
            return None
        function = ast.unparse(value.func)
        if function.endswith("clone_to_cache"):
            return self._cached(str(_constant(value.args[0])))
        parts = [self._text(argument) for argument in value.args]
        return os.path.join(*cast("list[str]", parts)) if function.endswith("join") and None not in parts else None

    def _cached(self, repository: str) -> str:
        known = self._repositories.get(repository, {})
        self.origin = f"{known.get('url', repository)} (package robot_descriptions)"
        cache_folder = os.path.expanduser(os.environ.get("ROBOT_DESCRIPTIONS_CACHE", "~/.cache/robot_descriptions"))
        place, commit = known.get("cache_path", repository), os.environ.get("ROBOT_DESCRIPTION_COMMIT")
        return os.path.join(cache_folder, *([place] if commit is None else [f"{place}-{commit}", place]))


def _constant(node: ast.expr | None) -> object:
    return node.value if isinstance(node, ast.Constant) else ""


# mujoco-menagerie


def _registry() -> dict[str, dict[str, Any]]:
    """Return the menagerie package's records of its robots, by name; empty if the package is not installed."""
    folder = _folder(_MENAGERIE)
    return {} if folder is None else _registry_in(str(folder))


@cache
def _registry_in(folder: str) -> dict[str, dict[str, Any]]:
    content: dict[str, Any] = json.loads(Path(folder, "registry.json").read_text(encoding="utf-8"))
    return content["robots"]


def _in_menagerie(name: str) -> RobotFile | None:
    if name not in _registry():
        return None
    menagerie: Any = importlib.import_module(_MENAGERIE)
    robot, store = menagerie.get(name), menagerie.Cache()
    size = int(_registry()[name].get("download_size", 0)) / 1e6

    def fetch() -> str:
        return str(robot.xml(robot.default_model))

    is_here = bool(os.environ.get("MENAGERIE_ROOT")) or bool(store.is_cached(robot))
    origin = f"the releases of github.com/google-deepmind/mujoco_menagerie, {size:.1f} MB (package mujoco-menagerie)"
    return RobotFile(fetch() if is_here else None, origin, {}, fetch)
