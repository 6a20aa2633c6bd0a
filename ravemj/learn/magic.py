"""``%learn`` in IPython and notebooks, which checks the function defined in a cell."""

import inspect
import json
import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FunctionType, ModuleType
from typing import Any

from ravemj.errors import ArgumentError, RavemjError
from ravemj.learn.child import Verdict, load_check
from ravemj.learn.course import Exercise, Lesson, our_course
from ravemj.learn.reports import report
from ravemj.learn.running import run_check

_USAGE = "%learn check NAME, %learn hint NAME [1-3] or %learn list"


def register(ipython: Any) -> None:  # noqa: ANN401 - IPython's shell; IPython is not imported here
    """Register ``%learn`` in a session."""

    def magic(words: str) -> object:
        try:
            return learn(words, ipython.user_ns)
        except RavemjError as error:
            _say(error.message)
            return None

    ipython.register_magic_function(magic, magic_name="learn")


def learn(words: str, namespace: Mapping[str, object]) -> object:
    """Run ``%learn`` with the functions in a notebook's namespace; return a picture or None.

    Raises:
        ArgumentError: the words are invalid, or the function does not exist.
    """
    match words.split():
        case ["list"] | []:
            for exercise in our_course().exercises:
                _say(f"{exercise.name:<16}{exercise.title}")
        case ["hint", name, *number]:
            hints = load_check(our_course().exercise(name).check).hints
            _say(hints[min(max(int(number[0]) if number else 1, 1), len(hints)) - 1])
        case ["check", name]:
            exercise = our_course().exercise(name)
            verdict = _check(exercise, namespace)
            _say(report(exercise, verdict))
            return _picture(exercise, verdict)
        case _:
            raise ArgumentError(f"%learn {words}: is not understood; there are {_USAGE}")
    return None


def _check(exercise: Exercise, namespace: Mapping[str, object]) -> Verdict:
    function = load_check(exercise.check).function
    if not isinstance(function, str):
        raise ArgumentError(f"{exercise.name} is a file; ravemj learn check {exercise.name} checks it")
    defined = namespace.get(function)
    if not isinstance(defined, FunctionType):
        raise ArgumentError(f"this notebook has no function {function} yet; run the cell that defines it")
    with TemporaryDirectory(prefix="ravemj-learn-") as folder:
        file = Path(folder) / exercise.original.name
        file.write_text("\n\n".join(_sources(defined, namespace)) + "\n", encoding="utf-8")
        return run_check(exercise, file)


def _picture(exercise: Exercise, verdict: Verdict) -> object:
    """Return a notebook picture of a wrong answer; None if the answer is not wrong or cannot be drawn."""
    from IPython.core.display import Image  # noqa: PLC0415 - only in IPython

    from ravemj.graphics.video import picture_bytes  # noqa: PLC0415
    from ravemj.learn.pictures import answer_scene, has_picture  # noqa: PLC0415 - slow to import

    check = load_check(exercise.check)
    if verdict.status != "wrong" or not has_picture(check):
        return None
    try:
        shown = answer_scene(check, verdict)
    except RavemjError:  # an answer of another shape
        return None
    try:
        return Image(picture_bytes(shown.env.render(480, 360, camera=shown.camera, floor=shown.floor)))
    finally:
        shown.env.Destroy()


def _sources(function: FunctionType, namespace: Mapping[str, object]) -> Iterator[str]:
    """Yield the source code of a function and of the notebook's modules, numbers and functions that it uses."""
    waiting, seen = [function], {function.__name__}
    parts: list[str] = []
    while waiting:
        current = waiting.pop()
        parts.append(inspect.getsource(current))
        for name in set(_names(current)) - seen:
            seen.add(name)
            used = namespace.get(name)
            if isinstance(used, FunctionType) and used.__module__ == "__main__":
                waiting.append(used)
            elif isinstance(used, ModuleType):
                yield f"import {used.__name__} as {name}"
            elif isinstance(used, bool | int | float | str):
                yield f"{name} = {used!r}"
            elif (module := getattr(used, "__module__", None)) and hasattr(sys.modules.get(module), name):
                yield f"from {module} import {name}"
    yield from reversed(parts)


def _names(function: FunctionType) -> Iterator[str]:
    """Yield the global names and attributes that a function and its inner functions use."""
    codes = [function.__code__]
    while codes:
        code = codes.pop()
        yield from code.co_names
        codes += [part for part in code.co_consts if inspect.iscode(part)]


def notebook(lesson: Lesson) -> str:
    """Return a lesson as a notebook: its page, and for each exercise in Python its file and its check."""
    texts = [*_page_cells((lesson.folder / "index.md").read_text(encoding="utf-8")), ("code", "%load_ext ravemj")]
    for exercise in lesson.exercises:
        if exercise.original.suffix == ".py":
            texts.append(("code", exercise.original.read_text(encoding="utf-8").rstrip()))
            texts.append(("code", f"%learn check {exercise.name}"))
    cells: list[dict[str, Any]] = [
        {
            "cell_type": kind,
            "id": f"cell-{number}",
            "metadata": {},
            "source": text.splitlines(keepends=True),
            **({"execution_count": None, "outputs": []} if kind == "code" else {}),
        }
        for number, (kind, text) in enumerate(texts)
    ]
    return json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}, indent=1)


def _page_cells(page: str) -> Iterator[tuple[str, str]]:
    """Yield a lesson's page as notebook cells (type, text); a figure of a shipped model becomes code that shows it."""
    parts = re.split(r'<iframe src="[^"]*/move-(\w+)\.html".*?</iframe>\n\n`.*\n', page)
    for number, part in enumerate(parts):
        figure = f'import ravemj\n\nravemj.load(ravemj.model_path("{part}")).animation()'
        yield ("code", figure) if number % 2 else ("markdown", part.strip("\n"))


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
