"""``openravepy.pyANN``: the older name of ``pyANN_int``."""

from ravemj.compat.pyANN_int import KDTree, max_pts_visit

__all__ = ["KDTree", "max_pts_visit"]
