"""``openravepy.databases``: what OpenRAVE computes once for a robot and keeps.

Models can be made and asked, and have nothing until ``autogenerate`` is called; where ravemj lacks what that takes, it
raises ``UnsupportedError``, which is a ``NotImplementedError``, with the name of the missing capability.
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
