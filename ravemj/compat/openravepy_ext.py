"""``openravepy.openravepy_ext``: OpenRAVE's Python extensions of its classes, which are in ``openravepy`` here."""

from ravemj.compat.legacy import *  # noqa: F403 - what its __all__ lists
from ravemj.geometry_functions import *  # noqa: F403 - what its __all__ lists
from ravemj.rave import *  # noqa: F403 - what ravemj/rave/__init__.py lists
