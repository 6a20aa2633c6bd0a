"""Files of motions, as ``motion_reading`` reads them."""

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ravemj.core.output import check_file, new_file, output_error
from ravemj.errors import ArgumentError
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.motion_reading import MOTION_SUFFIXES


def check_motion_file(path: str | os.PathLike[str]) -> None:
    """Check that a motion can be written to a path, without touching anything.

    Raises:
        ArgumentError: the suffix is neither ``.csv`` nor ``.npz``.
        OutputError: the folder around it is missing or cannot be written, or something is in the way.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in MOTION_SUFFIXES:
        raise ArgumentError(f"cannot write {os.fspath(path)}: a motion is a .csv or a .npz file, not '{suffix}'")
    check_file(path)


def write_motion(path: str | os.PathLike[str], motion: Motion, joint_names: Sequence[str]) -> Path:
    """Write a motion as ``.csv`` or ``.npz``, by the suffix; ``read_motion`` reads back the very numbers.

    Args:
        path: The file.
        motion: The motion.
        joint_names: Names of its columns.

    Returns:
        The path, as it was given.

    Raises:
        ArgumentError: the suffix is neither ``.csv`` nor ``.npz``, or there are not as many names as columns.
        OutputError: the file cannot be written.

    Example:
        >>> names = [joint.GetName() for joint in robot.GetJoints()]
        >>> ravemj.write_motion("swing.csv", ravemj.Motion.line([0, 0], [3.14, 0]), names)
    """
    check_motion_file(path)
    if len(joint_names) != motion.dof:
        raise ArgumentError(f"joint_names: are {len(joint_names)}, and the motion has {motion.dof} joints")
    with new_file(path) as temporary:
        try:
            if Path(path).suffix.lower() == ".npz":
                with temporary.open("wb") as file:
                    np.savez(file, time=motion.times, values=motion.values, joints=np.array(joint_names, dtype=str))
            else:
                temporary.write_text(_table(motion, joint_names), encoding="utf-8")
        except OSError as error:
            raise output_error(path, error) from error
    return Path(path)


def _table(motion: Motion, joint_names: Sequence[str]) -> str:
    import csv  # noqa: PLC0415 - slow to import
    import io  # noqa: PLC0415

    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["time", *joint_names])
    rows.writerows(np.column_stack([motion.times, motion.values]).tolist())
    return text.getvalue()
