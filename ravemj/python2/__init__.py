"""Scripts written for Python 2, translated while they are read.

fissix changes the syntax and the renamed parts of the standard library; here, division of integers is made to round
down, and the lines of the original are kept for tracebacks.
"""

from pathlib import Path

from ravemj.python2.division import HELPERS
from ravemj.python2.finder import install_finder
from ravemj.python2.translation import compile_script, is_python2

__all__ = ["FILES", "HELPERS", "compile_script", "install_finder", "is_python2"]

FILES = {str(path) for path in Path(__file__).parent.glob("*.py")}
"""Files whose frames tracebacks do not show."""
