"""The command ``learn``."""

import argparse
import dataclasses
import json
import shlex
import sys
import time
import webbrowser
from collections.abc import Callable, Sequence
from pathlib import Path

from ravemj.cli.console import console, table
from ravemj.core.output import check_file, new_file
from ravemj.errors import ArgumentError, OutputError, RavemjError
from ravemj.learn.child import Verdict, load_check
from ravemj.learn.course import Course, Exercise, our_course, start, start_again
from ravemj.learn.grading import as_csv, grades
from ravemj.learn.reports import report, state
from ravemj.learn.running import Progress

_PAUSE = 0.2
"""Interval between checks of the watched files [s]."""


def learn(options: argparse.Namespace) -> int:
    """List, start, check, show or grade exercises."""
    course = our_course() if options.course is None else Course(Path(options.course))
    return _ACTIONS[options.action](course, options)


def _list(course: Course, options: argparse.Namespace) -> int:
    progress = Progress(Path(options.folder))
    verdicts = dict(progress.check_all(course.exercises))
    listed = table("", "lesson", "exercise", "question", "state")
    for lesson in course.lessons:
        for number, exercise in enumerate(lesson.exercises):
            verdict = verdicts.get(exercise)
            listed.add_row(
                "" if number else f"{lesson.number} {lesson.title}",
                exercise.name,
                exercise.title,
                "-" if verdict is None else state(verdict),
            )
    console().print(listed)
    solved = sum(verdict.status == "solved" for verdict in verdicts.values())
    print(f"{solved} of {len(course.exercises)} solved")
    if not verdicts:
        print(f"no exercises in {progress.folder.resolve()}; begin with: ravemj learn start FOLDER")
    return 0


def _start(course: Course, options: argparse.Namespace) -> int:
    folder = Path(options.names[0] if options.names else options.folder)
    if options.again:
        exercise = course.exercise(options.again)
        kept = start_again(exercise, folder)
        print(f"wrote {folder / exercise.original.name}" + (f"; your own file is {kept}" if kept else ""))
        return 0
    if options.notebooks:
        return _write_notebooks(course, folder)
    made = start(course, folder)
    there = len(course.exercises) - len(made)
    print(f"wrote {len(made)} exercises into {folder}" + (f"; {there} were there already, and stay" if there else ""))
    first = course.exercises[0].original.name
    enter = "" if folder == Path() else f"cd {shlex.quote(str(folder))}; "
    print(f"open {first} in an editor, then: {enter}ravemj learn check --watch")
    return 0


def _write_notebooks(course: Course, folder: Path) -> int:
    from ravemj.learn.magic import notebook  # noqa: PLC0415 - rarely wanted

    for lesson in course.lessons:
        path = folder / f"{lesson.folder.name}.ipynb"
        if path.exists():
            print(f"{path} is there already, and stays")
            continue
        with new_file(path) as temporary:
            temporary.write_text(notebook(lesson), encoding="utf-8")
        print(f"wrote {path}")
    return 0


def _check(course: Course, options: argparse.Namespace) -> int:
    progress = Progress(Path(options.folder))
    wanted = [course.exercise(name) for name in options.names]
    if options.watch:
        return _watch(course, progress, wanted)
    status = 0
    for exercise in wanted or [_next(course, progress)]:
        verdict = _checked(progress, exercise)
        print(report(exercise, verdict))
        status = status or int(verdict.status != "solved")
        if verdict.status in {"wrong", "error"}:
            print(f"  (ravemj learn hint {exercise.name} helps)")
    return status


def _checked(progress: Progress, exercise: Exercise) -> Verdict:
    if not progress.file(exercise).exists():
        where = progress.folder.resolve()
        raise ArgumentError(f"{exercise.original.name} is not in {where}; ravemj learn start {where} puts it there")
    return progress.check(exercise)


def _next(course: Course, progress: Progress) -> Exercise:
    """Return the first unsolved exercise, or the last one if all are solved."""
    present = [exercise for exercise in course.exercises if progress.file(exercise).exists()]
    if not present:
        raise ArgumentError(f"no exercises in {progress.folder.resolve()}; begin with: ravemj learn start FOLDER")
    for exercise in present:
        verdict = progress.known(exercise)
        if (verdict or progress.check(exercise)).status != "solved":
            return exercise
    return present[-1]


def _watch(course: Course, progress: Progress, wanted: list[Exercise]) -> int:
    """Check the next unsolved exercise, or the wanted ones, after each save until Ctrl-C."""
    stamps: dict[Exercise, int] = {}
    while True:
        present = {exercise: _stamp(progress.file(exercise)) for exercise in wanted or course.exercises}
        saved = [exercise for exercise in present if stamps and present[exercise] != stamps[exercise]]
        if present != stamps:
            stamps = present
            try:
                _report_saved(course, progress, saved or wanted, [] if wanted else course.exercises)
            except ArgumentError as error:  # a file is gone, as while an editor saves it
                print(f"{error.message}\n", flush=True)
        time.sleep(_PAUSE)


def _report_saved(course: Course, progress: Progress, saved: list[Exercise], others: Sequence[Exercise]) -> None:
    """Check the saved exercises; if all are solved or none was saved, name the next exercise of ``others``."""
    verdicts = [_checked(progress, exercise) for exercise in saved]
    for exercise, verdict in zip(saved, verdicts, strict=True):
        print(f"{report(exercise, verdict)}\n", flush=True)
    if others and all(verdict.status == "solved" for verdict in verdicts):
        following = _next(course, progress)
        known = progress.known(following)
        if known is not None and known.status == "solved":
            print("all exercises in this folder are solved\n", flush=True)
        else:
            print(f"next: {progress.file(following)}: {following.title}\n", flush=True)


def _stamp(file: Path) -> int:
    try:
        return file.stat().st_mtime_ns
    except OSError:  # gone, as while an editor saves it
        return 0


def _hint(course: Course, options: argparse.Namespace) -> int:
    exercise = course.exercise(_one_name(options))
    for number, hint in enumerate(load_check(exercise.check).hints[: options.number], 1):
        print(f"{number}. {hint}")
    if options.number < 3:
        print(f"ravemj learn hint {exercise.name} --number {options.number + 1} tells more")
    return 0


def _show(course: Course, options: argparse.Namespace) -> int:
    from ravemj.learn.pictures import save_picture  # noqa: PLC0415 - slow to import

    exercise = course.exercise(_one_name(options))
    output = options.output or f"{exercise.name}.{'html' if options.web else 'png'}"
    check_file(output)
    verdict = _checked(Progress(Path(options.folder)), exercise)
    if verdict.status in {"error", "untouched"}:
        raise RavemjError(f"{exercise.name}: {verdict.message}")
    save_picture(load_check(exercise.check), verdict, Path(output))
    print(f"wrote {output}: yours is red, or solid; the right one is green, or transparent")
    print(report(exercise, verdict))
    if options.web:
        webbrowser.open(Path(output).resolve().as_uri())
    return 0


def _grade(course: Course, options: argparse.Namespace) -> int:
    folders = [Path(name) for name in options.names]
    if not folders:
        raise ArgumentError("grade needs folders: ravemj learn grade students/*")
    readable = [folder for folder in folders if folder.is_dir()]
    rows = list(grades(course, readable))
    if options.csv:
        sys.stdout.write(as_csv(rows))
    elif options.json:
        print(json.dumps([dataclasses.asdict(row) for row in rows], indent=2))
    else:
        listed = table("", "student", "exercise", "state", "message")
        for row in rows:
            listed.add_row(row.student, row.exercise, row.status, row.message[:70])
        console().print(listed)
    for folder in set(folders) - set(readable):
        print(OutputError(f"{folder} is no folder that can be read").message, file=sys.stderr)
    return 0 if len(readable) == len(folders) else 1


def _one_name(options: argparse.Namespace) -> str:
    if len(options.names) != 1:
        raise ArgumentError(f"{options.action} needs the name of one exercise; ravemj learn lists them")
    return options.names[0]


_ACTIONS: dict[str, Callable[[Course, argparse.Namespace], int]] = {
    "list": _list,
    "start": _start,
    "check": _check,
    "hint": _hint,
    "show": _show,
    "grade": _grade,
}
