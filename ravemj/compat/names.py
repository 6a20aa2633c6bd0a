"""Modules that are imported under other names than those of their files.

``ravemj.misc`` always is ``ravemj.compat.misc``; ``openravepy`` is ``ravemj.compat.openravepy`` if
``ravemj.compat.alias`` has installed the alias. All names of a module refer to one module object.
"""

import importlib
import importlib.util
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

OPENRAVEPY = "openravepy"
PUBLIC = ("databases", "interfaces", "misc", "planningutils")
"""Sub-modules of OpenRAVE that are imported from ``ravemj`` as well."""
ONLY_OPENRAVEPY = (
    "convexdecompositionpy",
    "examples",
    "metaclass",
    "openravepy_configurationcache",
    "openravepy_ext",
    "openravepy_int",
    "pyANN",
    "pyANN_int",
)


class Renamed(MetaPathFinder, Loader):
    """Import finder and loader that provides modules of ravemj under other names.

    Args:
        root: The first component of the names.
    """

    def __init__(self, root: str) -> None:
        self.root = root

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return a spec for an alternative name, else None."""
        del path, target
        if fullname.partition(".")[0] != self.root:
            return None
        is_example = fullname.startswith(f"{self.root}.examples.")
        return ModuleSpec(fullname, self) if is_example or _exists(real_name(fullname)) else None

    def exec_module(self, module: ModuleType) -> None:
        """Replace the empty module by ravemj's; modules of examples stay empty."""
        if module.__name__.startswith(f"{self.root}.examples."):
            from ravemj.compat.examples import fill  # noqa: PLC0415 - rarely wanted

            fill(module)
        else:
            take_over(module.__name__)


def real_name(name: str) -> str:
    """Return the name of ravemj's module for ``openravepy`` or one of its modules."""
    rest = name.partition(".")[2]
    if not rest:
        return "ravemj.compat.openravepy"
    return f"ravemj.compat.{rest}" if rest.partition(".")[0] in PUBLIC + ONLY_OPENRAVEPY else f"ravemj.{rest}"


def take_over(name: str) -> None:
    """Register ravemj's module under another name."""
    sys.modules[name] = importlib.import_module(real_name(name))


def share(name: str) -> None:
    """Register a package of ``ravemj.compat``, and its modules, under a name in ``ravemj``."""
    real = name.replace("ravemj.", "ravemj.compat.", 1)
    importlib.import_module(real)
    for known in [known for known in sys.modules if known == real or known.startswith(f"{real}.")]:
        sys.modules[name + known.removeprefix(real)] = sys.modules[known]


def install(root: str) -> None:
    """Handle imports of ``root`` and of its submodules in this process."""
    if not any(isinstance(finder, Renamed) and finder.root == root for finder in sys.meta_path):
        sys.meta_path.insert(0, Renamed(root))


def load_ipython_extension(ipython: Any) -> None:  # noqa: ANN401 - IPython's shell; IPython is not imported here
    """Make ``import openravepy`` import ravemj, and provide ``%learn``; IPython calls it on ``%load_ext ravemj``.

    Args:
        ipython: The session.
    """
    from ravemj.learn.magic import register  # noqa: PLC0415 - only in IPython

    install(OPENRAVEPY)
    register(ipython)


def _exists(name: str) -> bool:
    try:
        return importlib.util.find_spec(name) is not None
    except ModuleNotFoundError:
        return False
