"""Which of the names that OpenRAVE's users use ravemj has, and where each is tested: ``docs/api-coverage.md``."""

import ast
import importlib
import inspect
import sys
import textwrap
from collections.abc import Iterator, Mapping
from functools import cache
from types import FunctionType
from typing import NamedTuple

import api_surface
from api_names import BEHIND

import ravemj
from ravemj.compat import databases, interfaces, misc, planningutils

_STATEMENTS = {"with_env": ravemj.Environment, "with_robot": ravemj.KinBody}

_HEAD = """\
# Coverage of OpenRAVE's API

<!-- scripts/docs, or python scripts/pages/api_coverage.py > docs/api-coverage.md alone, makes this page from the
program itself; a test compares. -->

The names are all public ones of openravepy 0.149.1: modules, classes, methods, properties, arguments and members of
enumerations. A name is *there* when it exists, members of enumerations with OpenRAVE's number. What only raises
`NotImplementedError`, since ravemj lacks a capability, is *refused*; its row says which.
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
    owners: dict[str, list[api_surface.Name]] = {}
    for name in api_surface.names():
        owners.setdefault(name.owner, []).append(name)
    there = sum(map(api_surface.is_there, api_surface.names()))
    rows = [row for owner, names in owners.items() for row in _rows(owner, names)]
    summary = f"Of {len(api_surface.names())}: {there} there, {len(api_surface.names()) - there} missing.\n"
    table = ["| class or module | names | there | refused | missing |", "|---|--:|--:|---|---|", *rows]
    return "\n".join([_HEAD, summary, *table]) + "\n"


def _rows(owner: str, names: list[api_surface.Name]) -> Iterator[str]:
    """Yield the row of a class or module."""
    present = [name for name in names if api_surface.is_there(name)]
    missing = ", ".join(f"`{_last(name)}`" for name in names if name not in present)
    lacking: dict[str, list[str]] = {}
    for name in present:
        capability = _capability(api_surface.thing_of(name))
        if capability:
            lacking.setdefault(capability, []).append(f"`{_last(name)}`")
    refused = "; ".join(f"{capability}: {', '.join(which)}" for capability, which in sorted(lacking.items()))
    yield f"| `{owner}` | {len(names)} | {len(present)} | {refused} | {missing} |"


def _last(name: api_surface.Name) -> str:
    return name.path.rpartition(".")[2]


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
    if not isinstance(thing, FunctionType) or not thing.__module__.startswith("ravemj"):
        return ""
    return str(vars(thing).get("capability", "")) or _raised(inspect.unwrap(thing))


def _raised(function: FunctionType) -> str:
    """Return the capability that a function's only statement names as lacking; empty where it does something else."""
    try:
        definition = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    except OSError:  # made by a dataclass
        return ""
    last = definition.body[-1] if isinstance(definition, ast.FunctionDef) and len(definition.body) <= 2 else None
    if not (isinstance(last, ast.Raise) and isinstance(last.exc, ast.Call)):
        return ""
    raised = last.exc.func
    if not (isinstance(raised, ast.Name) and raised.id == "UnsupportedError"):
        return ""
    argument = last.exc.args[1]
    if isinstance(argument, ast.Constant):
        return str(argument.value)
    return str(vars(importlib.import_module(function.__module__)).get(ast.unparse(argument), ""))


def _capability_of_class(thing: type[object]) -> str:
    if issubclass(thing, databases.DatabaseGenerator):
        return "" if "autogenerate" in vars(thing) else thing.capability
    made = vars(thing).get("__init__")
    return _capability(made) if made else ""


if __name__ == "__main__":
    sys.stdout.write(markdown())
