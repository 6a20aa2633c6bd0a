"""Execution of Python 2 scripts: translation at import, and the names of Python 2.

fissix converts the syntax (``translation``); then constructs with another meaning in Python 3 are converted
(``statements``, ``division``). Only such scripts see the names of Python 2 and NumPy 1: built-in ones (``builtin``,
``files``), methods (``methods``), and those of modules (``modules``, ``library``, ``numpy1``).
"""

from pathlib import Path

from ravemj.compat.python2.builtin import OLD_NAMES
from ravemj.compat.python2.finder import execute, install_finder, is_python2

__all__ = ["FILES", "OLD_NAMES", "execute", "install_finder", "is_python2"]

FILES = {str(path) for path in Path(__file__).parent.glob("*.py")}
"""Files whose frames are hidden in tracebacks."""
