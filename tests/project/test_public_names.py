"""All public names with their arguments and defaults, and what wrong calls raise, as ``public-names.txt`` lists them.

A move of code changes nothing there. If a name, a default or a message changes on purpose, write the list anew, and
read its difference: ``PYTHONPATH=tests .venv/bin/python tests/project/test_public_names.py``. The texts of ``--help``
are held by ``docs/cli.md``.
"""

import inspect
import os
import re
import tempfile
from collections.abc import Iterator
from enum import Enum

from conftest import DATA
from wrong_calls import KINDS, calls_with_one_argument

import ravemj

LIST = DATA / "public-names.txt"

MODULES = (ravemj, ravemj.databases, ravemj.interfaces, ravemj.misc, ravemj.planningutils)

WRONG = (None, [], {}, object())


def dump() -> list[str]:
    """Return a line for each public name, and one for each message of a wrong call."""
    return [line for module in MODULES for line in names_of(module)] + sorted(set(messages()))


def names_of(module) -> Iterator[str]:
    """Yield the names of a module and of its classes, with the arguments of what can be called."""
    for name in sorted(set(getattr(module, "__all__", dir(module)))):
        value = getattr(module, name)
        place = f"{module.__name__}.{name}"
        if not name.startswith("_") and not inspect.ismodule(value):
            yield f"{place}{arguments(value)}"
        if inspect.isclass(value) and not issubclass(value, Enum):
            for member in sorted(dir(value)):
                if not member.startswith("_"):
                    yield f"{place}.{member}{arguments(inspect.getattr_static(value, member))}"
        elif inspect.isclass(value):
            yield from (f"{place}.{member.name} = {member.value!r}" for member in value)


def arguments(value) -> str:
    """Return the arguments of what can be called, without their types; nothing for the rest."""
    function = value.__func__ if isinstance(value, staticmethod | classmethod) else value
    if not callable(function):
        return ""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # written in C
        return "(...)"
    bare = [one.replace(annotation=one.empty) for one in signature.parameters.values()]
    return without_addresses(str(signature.replace(parameters=bare, return_annotation=signature.empty)))


def messages() -> Iterator[str]:
    """Yield what each method of scripts' objects says to wrong values of an argument."""
    for kind, make in KINDS.items():
        env = ravemj.Environment()
        env.Load(ravemj.model_path("puma560"))
        thing = make(env, env.GetRobots()[0])
        for method, argument in calls_with_one_argument(thing):
            for wrong in WRONG:
                try:
                    getattr(thing, method)(**{argument: wrong})
                except ravemj.RavemjError as error:
                    yield without_addresses(f"{kind}.{method}({argument}={wrong!r}): {' '.join(str(error).split())}")
                except (TypeError, ValueError, LookupError) as error:  # whose texts depend on Python's version
                    yield without_addresses(f"{kind}.{method}({argument}={wrong!r}): {type(error).__name__}")
        env.Destroy()


def without_addresses(text: str) -> str:
    return re.sub(r" at 0x[0-9a-f]+", "", text)


def test_names_defaults_and_messages_stay(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some calls write files
    assert dump() == LIST.read_text(encoding="utf-8").splitlines()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        lines = dump()
    LIST.write_text("\n".join(lines) + "\n", encoding="utf-8")
