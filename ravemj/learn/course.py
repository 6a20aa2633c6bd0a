"""Courses and exercises as files, and a student's folder."""

import shutil
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path

from ravemj.core.output import new_file
from ravemj.errors import ArgumentError, OutputError, RavemjError

CHECK_PREFIX = "check_"
PAGE = "index.md"


@dataclass(frozen=True)
class Exercise:
    """One exercise of a course.

    Attributes:
        name: Its name, such as ``fk-2``.
        original: The course's version of the file that a student completes.
        check: The file of its check.
    """

    name: str
    original: Path
    check: Path

    @property
    def title(self) -> str:
        """The first line of the file: the task."""
        first = self.original.read_text(encoding="utf-8").splitlines()[0]
        return first.strip().strip('"<!->').strip().removeprefix(f"{self.name}: ")


@dataclass(frozen=True)
class Lesson:
    """A lesson: a page and its exercises, in order."""

    folder: Path
    title: str
    exercises: tuple[Exercise, ...]

    @property
    def number(self) -> str:
        """The number at the start of the folder's name."""
        return self.folder.name.partition("-")[0].lstrip("0")


@dataclass(frozen=True)
class Course:
    """A folder of lessons."""

    folder: Path

    @cached_property
    def lessons(self) -> tuple[Lesson, ...]:
        """The lessons, sorted by folder name.

        Raises:
            RavemjError: there are none, or an exercise has no check.
        """
        pages = sorted(self.folder.glob(f"*/{PAGE}"))
        if not pages:
            raise RavemjError(f"{self.folder} is no course: none of its folders has a page {PAGE}")
        return tuple(_lesson(page) for page in pages)

    @property
    def exercises(self) -> tuple[Exercise, ...]:
        """All exercises, in order."""
        return tuple(exercise for lesson in self.lessons for exercise in lesson.exercises)

    def exercise(self, name: str) -> Exercise:
        """Return the exercise with a name, or with a file of this name.

        Raises:
            ArgumentError: it does not exist.
        """
        wanted = Path(name).stem.replace("_", "-")
        for exercise in self.exercises:
            if exercise.name == wanted:
                return exercise
        names = [exercise.name for exercise in self.exercises]
        near = [known for known in names if known.startswith(wanted)] or get_close_matches(wanted, names)
        raise ArgumentError(f"there is no exercise {name!r}; there are {', '.join(near or names)}")


def our_course() -> Course:
    """Return the course that is shipped with ravemj."""
    package = Path(__file__).parents[1]
    installed = package / "course"  # the wheel holds it there; a clone has it among the pages
    return Course(installed if installed.is_dir() else package.parent / "docs" / "course")


def start(course: Course, folder: Path) -> list[Exercise]:
    """Copy the exercises that are missing in a folder into it; return these exercises."""
    missing = [exercise for exercise in course.exercises if not (folder / exercise.original.name).exists()]
    for exercise in missing:
        _copy(exercise, folder)
    return missing


def start_again(exercise: Exercise, folder: Path) -> Path | None:
    """Restore the original file of an exercise in a folder.

    If the folder has the student's version, this is renamed; return its new path, else None.
    """
    own, kept = folder / exercise.original.name, None
    if own.exists():
        number = 1
        while (kept := own.with_name(f"{own.stem}.old{number}{own.suffix}")).exists():
            number += 1
        own.replace(kept)
    _copy(exercise, folder)
    return kept


def _copy(exercise: Exercise, folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"cannot make {folder}: {(error.strerror or str(error)).lower()}") from None
    with new_file(folder / exercise.original.name) as path:
        shutil.copyfile(exercise.original, path)


def _lesson(page: Path) -> Lesson:
    heading = next((line for line in page.read_text(encoding="utf-8").splitlines() if line.startswith("# ")), "# ")
    exercises: list[Exercise] = []
    for check in sorted(page.parent.glob(f"{CHECK_PREFIX}*.py")):
        stem = check.stem.removeprefix(CHECK_PREFIX)
        originals = [path for path in page.parent.glob(f"{stem}.*") if path.suffix in {".py", ".xml"}]
        if len(originals) != 1:
            raise RavemjError(f"{check} needs one file {stem}.py or {stem}.xml beside it; there are {len(originals)}")
        exercises.append(Exercise(stem.replace("_", "-"), originals[0], check))
    return Lesson(page.parent, heading.removeprefix("# "), tuple(exercises))
