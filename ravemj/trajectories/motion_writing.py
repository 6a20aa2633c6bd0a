"""Writing of motion files, which ``motion_reading`` reads."""

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ravemj.core.output import check_file, new_file, output_error
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.motion_reading import MOTION_SUFFIXES


def check_motion_file(path: str | os.PathLike[str]) -> None:
    """Check that a motion can be written to a path; nothing is written.

    Raises:
        ArgumentError: the suffix is neither ``.csv`` nor ``.npz``.
        OutputError: the folder around it is missing or cannot be written, or the path is not a file.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in MOTION_SUFFIXES:
        raise ArgumentError(f"cannot write {os.fspath(path)}: a motion is a .csv or a .npz file, not '{suffix}'")
    check_file(path)


def write_motion(
    path: str | os.PathLike[str], motion: Motion, joint_names: Sequence[str], notes: Sequence[str] = ()
) -> Path:
    """Write a motion as ``.csv`` or ``.npz``; ``read_motion`` restores the exact numbers.

    Args:
        path: The file.
        motion: The motion.
        joint_names: Names of its columns.
        notes: Lines that readers ignore: comments at the end of a table, else the array ``notes``.

    Returns:
        The given path.

    Raises:
        ArgumentError: the suffix is neither ``.csv`` nor ``.npz``, or the numbers of names and columns differ.
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
                    names, texts = np.array(joint_names, dtype=str), np.array(notes, dtype=str)
                    np.savez(file, time=motion.times, values=motion.values, joints=names, notes=texts)
            else:
                table = csv_table(["time", *joint_names], np.column_stack([motion.times, motion.values]))
                temporary.write_text(table + comments(notes), encoding="utf-8")
        except OSError as error:
            raise output_error(path, error) from error
    return Path(path)


def csv_table(header: Sequence[str], table: Floats) -> str:
    """Return a table of numbers as CSV."""
    import csv  # noqa: PLC0415 - slow to import
    import io  # noqa: PLC0415

    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(header)
    rows.writerows(table.tolist())
    return text.getvalue()


def comments(notes: Sequence[str]) -> str:
    """Return lines of text as comments of tables and of YAML."""
    return "".join(f"# {line}\n" for note in notes for line in note.splitlines())
