"""``openravepy.databases``: data that OpenRAVE precomputes for a robot and stores.

Models can be constructed and queried, and are empty until ``autogenerate`` is called. If ravemj does not support that,
it raises ``UnsupportedError``, a ``NotImplementedError``, with the missing capability.
"""

from ravemj.compat.databases import (
    convexdecomposition,
    grasping,
    inversekinematics,
    inversereachability,
    kinematicreachability,
    linkstatistics,
    visibilitymodel,
)
from ravemj.compat.databases.model import DatabaseGenerator

__all__ = [
    "DatabaseGenerator",
    "convexdecomposition",
    "grasping",
    "inversekinematics",
    "inversereachability",
    "kinematicreachability",
    "linkstatistics",
    "visibilitymodel",
]
