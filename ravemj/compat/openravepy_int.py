"""``openravepy.openravepy_int``: OpenRAVE's classes and functions, which old scripts import from here."""

from ravemj.compat.legacy import *  # noqa: F403 - what its __all__ lists
from ravemj.rave import *  # noqa: F403 - what ravemj/rave/__init__.py lists
