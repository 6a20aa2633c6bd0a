"""Scripts written for Python 2, translated while they are read, with the names that they knew.

fissix changes the syntax (``translation``); what Python 3 reads, but takes for something else, is changed after it
(``statements``, ``division``). Such scripts, and no other code, have the names of Python 2 and NumPy 1: built-in ones
(``builtin``, ``files``), those of objects (``methods``), and those of modules (``modules``, ``library``, ``numpy1``).
"""

from pathlib import Path

from ravemj.compat.python2.finder import execute, install_finder, is_python2

__all__ = ["FILES", "execute", "install_finder", "is_python2"]

FILES = {str(path) for path in Path(__file__).parent.glob("*.py")}
"""Files whose frames tracebacks do not show."""
