"""The modules of ``ravemj.compat.misc`` under the names that scripts import."""

from ravemj.compat.misc import *  # noqa: F403 - as its __all__ lists them
from ravemj.compat.names import share

share(__name__)
