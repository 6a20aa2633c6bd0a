"""OpenRAVE's example programs, which ravemj does not include: their modules can be imported, but not used."""

from types import ModuleType
from typing import NoReturn

from ravemj.errors import UnsupportedError

__path__: list[str] = []
"""Empty search path, which makes this module a package, so that examples can be imported as its submodules."""

_PLACE = "https://github.com/rdiankov/openrave/tree/master/python/examples"


def fill(module: ModuleType) -> None:
    """Make all attributes of a module raise an error that names the location of the example.

    Args:
        module: The module, which has the name of an example.
    """
    name = module.__name__

    def look_up(attribute: str) -> NoReturn:
        if attribute.startswith("__"):
            raise AttributeError(f"module '{name}' has no attribute '{attribute}'")
        remedy = f"put {name.rpartition('.')[2]}.py of {_PLACE} beside your script"
        raise UnsupportedError(f"{name}.{attribute} ({remedy})", "examples of OpenRAVE")

    vars(module)["__getattr__"] = look_up


def __getattr__(name: str) -> ModuleType:
    """Return the module of an example, for ``from openravepy.examples import …``."""
    if name.startswith("__"):
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    module = ModuleType(f"openravepy.examples.{name}")
    fill(module)
    return module
