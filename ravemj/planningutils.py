"""The modules of ``ravemj.compat.planningutils`` under the names that scripts import."""

from ravemj.compat.names import share
from ravemj.compat.planningutils import *  # noqa: F403 - as its __all__ lists them

share(__name__)
