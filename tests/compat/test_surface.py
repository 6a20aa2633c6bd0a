"""OpenRAVE's public names: each exists and takes OpenRAVE's arguments, or stands on a list of those that do not yet.

``surface-missing.txt`` is that list. Whoever makes a name appear removes its line; to write it anew:
``PYTHONPATH=tests:scripts/pages python tests/compat/test_surface.py``.
"""

import api_surface
from conftest import DATA

LIST = DATA / "surface-missing.txt"


def missing() -> list[str]:
    """The names that are not there, and the overloads whose arguments are not taken."""
    found = []
    for name in api_surface.names():
        if not api_surface.is_there(name):
            found.append(f"{name.module}.{name.path}")
        found += [f"arguments {overload}" for overload in api_surface.refused_arguments(name)]
    return found


def test_the_list_is_openraves():
    names = api_surface.names()
    assert len(names) == 2057
    assert {"openravepy", "openravepy.misc", "openravepy.pyANN_int"} <= {name.module for name in names}


def test_all_names_are_there_but_those_on_the_list():
    listed = LIST.read_text(encoding="utf-8").splitlines()
    assert sorted(missing()) == listed, "a name that appears leaves the list; none may come"


if __name__ == "__main__":
    LIST.write_text("\n".join(sorted(missing())) + "\n", encoding="utf-8")
