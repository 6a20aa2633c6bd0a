"""Columns of a grasp table, by OpenRAVE's names."""

from collections.abc import Mapping

SIZES: Mapping[str, int | None] = {
    "igraspdir": 3,
    "igrasppos": 3,
    "igrasproll": 1,
    "igraspstandoff": 1,
    "igrasppreshape": None,
    "igrasptrans": 12,
    "imanipulatordirection": 3,
    "forceclosure": 1,
    "grasptrans_nocol": 12,
    "performance": 1,
    "vintersectplane": 4,
    "igraspfinalfingers": None,
    "ichuckingdirection": None,
    "graspikparam_nocol": 8,
    "approachdirectionmanip": 3,
    "igrasptranslationoffset": 3,
}
"""Number of columns of each property of a grasp; None means one for each gripper joint."""


def table_columns(joints: int, more: Mapping[str, int] | None = None) -> tuple[dict[str, range], int]:
    """Return the columns of each property of a grasp, and the total number of columns.

    Args:
        joints: Number of gripper joints.
        more: User-defined properties, with their numbers of columns.
    """
    columns: dict[str, range] = {}
    start = 0
    for name, size in {**SIZES, **(more or {})}.items():
        stop = start + (joints if size is None else size)
        columns[name] = range(start, stop)
        start = stop
    return columns, start
