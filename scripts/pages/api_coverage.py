"""Which of the names that OpenRAVE's users use ravemj has, and where each is tested: ``docs/api-coverage.md``."""

import ast
import importlib
import inspect
import re
import sys
import textwrap
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import NamedTuple

from api_names import BEHIND, PYMANOID, SCRIPTS

import ravemj
from ravemj.compat import databases, interfaces, misc, planningutils

_TESTS = Path(__file__).resolve().parents[2] / "tests"
_CASES = "data/api-conformance"
_STATEMENTS = {"with_env": ravemj.Environment, "with_robot": ravemj.KinBody}
_SHOWN = {"with_env": "with env:", "with_robot": "with robot:"}

_HEAD = """\
# Which names of OpenRAVE's API are there

Made by `scripts/docs`, or `python scripts/pages/api_coverage.py > docs/api-coverage.md` alone, from the program itself;
a test compares.

The names are the 250 that make most of 308 published scripts possible, in an order in which whole scripts become
possible early, and those that pymanoid needs. *yes*: it is there. *no*: it raises `NotImplementedError` and names the
capability that ravemj lacks. *missing*: it is not there. The last column has the first test that uses the name, and how
many of the scripts in `tests/data/api-conformance/` do, which have OpenRAVE's own answers.
"""


class Place(NamedTuple):
    """Where a name is.

    Attributes:
        owner: The class or module that has it.
        capability: What is missing where it only raises, else empty.
    """

    owner: str
    capability: str


def markdown() -> str:
    """Return the page."""
    more = [name for name in PYMANOID if name not in SCRIPTS]
    rows = [_row(str(rank), name) for rank, name in enumerate(SCRIPTS, start=1)]
    rows += [_row("pymanoid", name) for name in more]
    counts = {state: sum(f"| {state}" in row for row in rows) for state in ("yes", "no", "missing")}
    summary = f"Of {len(rows)}: {counts['yes']} yes, {counts['no']} no, {counts['missing']} missing.\n"
    table = ["| rank | name | where | | tests |", "|--:|---|---|---|---|", *rows]
    return "\n".join([_HEAD, summary, *table]) + "\n"


def _row(rank: str, name: str) -> str:
    places = find(name)
    missing = {place.capability for place in places if place.capability}
    served = any(not place.capability for place in places)
    state = "yes" if served else f"no: {', '.join(sorted(missing))}" if places else "missing"
    owners = ", ".join(f"`{place.owner}`" for place in places)
    return f"| {rank} | `{_SHOWN.get(name, name)}` | {owners} | {state} | {_tested(name)} |"


def find(name: str) -> list[Place]:
    """Return the places that have a name of OpenRAVE's: top-level names, classes, sub-modules."""
    if name in BEHIND:
        return [Place(BEHIND[name], _capability(_attribute(BEHIND[name])))]
    if name == "__openravepy_build_doc__":
        return [Place("openravepy", "")]
    if name in _STATEMENTS:
        owner = _STATEMENTS[name]
        return [Place(owner.__name__, "")] if hasattr(owner, "__enter__") else []
    of_modules = [Place(owner, _capability(names[name])) for owner, names in _modules().items() if name in names]
    return of_modules + [Place(owner.__name__, _capability(thing)) for owner, thing in _of_classes(name)]


@cache
def _modules() -> Mapping[str, Mapping[str, object]]:
    """Return the modules of the API under the names that the page shows, each with its own names."""
    modules = {"interfaces": interfaces, "planningutils": planningutils}
    modules |= {f"databases.{name}": getattr(databases, name) for name in databases.__all__ if name.islower()}
    own = {
        title: {
            name: thing
            for name, thing in vars(module).items()
            if f"{getattr(thing, '__module__', '')}.".startswith(f"{module.__name__}.")
        }
        for title, module in modules.items()
    }
    of_all = {"openravepy": ravemj, "misc": misc}
    return {title: {name: getattr(module, name) for name in module.__all__} for title, module in of_all.items()} | own


def _of_classes(name: str) -> Iterator[tuple[type, object]]:
    """Yield the classes that have an attribute, without those that have it from another one."""
    exported = [thing for thing in _modules()["openravepy"].values() if isinstance(thing, type)]
    owners = {owner: inspect.getattr_static(owner, name) for owner in exported if name in dir(owner)}
    for owner, thing in owners.items():
        if not any(owners.get(base) is thing for base in owner.__mro__[1:]):
            yield owner, thing


def _attribute(path: str) -> object:
    """Return what a dotted name of the API stands for."""
    thing: object = ravemj
    for part in path.split("."):
        thing = getattr(thing, part)
    return thing


def _capability(thing: object) -> str:
    """Return what a function or class lacks that does nothing but raise ``UnsupportedError``; empty for others."""
    if isinstance(thing, type):
        return _capability_of_class(thing)
    if not isinstance(thing, FunctionType):
        return ""
    definition = ast.parse(textwrap.dedent(inspect.getsource(thing))).body[0]
    assert isinstance(definition, ast.FunctionDef)
    last = definition.body[-1]
    if not (isinstance(last, ast.Raise) and isinstance(last.exc, ast.Call)):
        return ""
    function = last.exc.func
    if not (isinstance(function, ast.Name) and function.id == "UnsupportedError" and len(definition.body) <= 2):
        return ""
    argument = last.exc.args[1]
    if isinstance(argument, ast.Constant):
        return str(argument.value)
    return str(vars(importlib.import_module(thing.__module__))[ast.unparse(argument)])


def _capability_of_class(thing: type[object]) -> str:
    if issubclass(thing, databases.DatabaseGenerator):
        return "" if "autogenerate" in vars(thing) else thing.capability
    made = vars(thing).get("__init__")
    return _capability(made) if made else ""


def _tested(name: str) -> str:
    """Return the first test that uses a name, and how many cases do."""
    if name in _STATEMENTS:
        used = re.compile(_SHOWN[name].replace(":", r"\b"))
        found = [path for path, text in _texts().items() if used.search(text)]
    else:
        found = [path for path, words in _words().items() if name in words]
    tests = [f"`{path}`" for path in found if not path.startswith(_CASES)][:1]
    cases = sum(path.startswith(_CASES) for path in found)
    return ", ".join(tests + ([f"{cases} case{'s' * (cases > 1)}"] if cases else []))


@cache
def _texts() -> Mapping[str, str]:
    paths = [*sorted(_TESTS.glob("test_*.py")), *sorted((_TESTS / _CASES).glob("*.py"))]
    return {path.relative_to(_TESTS).as_posix(): path.read_text(encoding="utf-8") for path in paths}


@cache
def _words() -> Mapping[str, set[str]]:
    return {path: set(re.findall(r"\w+", text)) for path, text in _texts().items()}


if __name__ == "__main__":
    sys.stdout.write(markdown())
