"""Tables of the results in students' folders."""

import csv
import dataclasses
import io
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from ravemj.learn.course import Course, Exercise
from ravemj.learn.running import run_check

_FORMULAS = ("=", "+", "-", "@", "\t", "\r")
"""First characters of cells that spreadsheets interpret as formulas."""


@dataclasses.dataclass(frozen=True)
class Grade:
    """Result of a student's exercise.

    Attributes:
        student: Name of the folder.
        exercise: Name of the exercise.
        status: ``solved``, ``wrong``, ``error``, ``untouched`` or ``missing``.
        message: The error; "" if there is none.
    """

    student: str
    exercise: str
    status: str
    message: str


def grades(course: Course, folders: Sequence[Path]) -> Iterator[Grade]:
    """Check all exercises of students' folders, each in a separate process; yield the results in order."""
    exercises = course.exercises
    owners = [folder for folder in folders for _ in exercises]
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        yield from pool.map(_grade, owners, exercises * len(folders))
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def _grade(folder: Path, exercise: Exercise) -> Grade:
    file, student = folder / exercise.original.name, folder.resolve().name
    if not file.is_file():
        return Grade(student, exercise.name, "missing", "there is no such file")
    verdict = run_check(exercise, file)
    return Grade(student, exercise.name, verdict.status, verdict.mistake or verdict.message)


def as_csv(rows: Sequence[Grade]) -> str:
    """Return rows as CSV; cells that a spreadsheet would interpret as formulas begin with an apostrophe."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([field.name for field in dataclasses.fields(Grade)])
    for row in rows:
        writer.writerow([f"'{cell}" if cell.startswith(_FORMULAS) else cell for cell in dataclasses.astuple(row)])
    return text.getvalue()
