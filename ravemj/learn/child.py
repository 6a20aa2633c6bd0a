"""Checks one exercise in a separate process: ``python -m ravemj.learn.child EXERCISE CHECK VERDICT SEED SECONDS``."""

import ast
import copy
import dataclasses
import faulthandler
import json
import os
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, TypeAlias, cast

import numpy as np

from ravemj.learn.check import Arguments, Check, Function, shortened
from ravemj.learn.mistakes import recognized

Status: TypeAlias = Literal["solved", "wrong", "error", "untouched"]

_WIDTH = 200
"""Maximum length of the text of an answer."""

_MEMORY = 4 << 30
"""Memory limit of a process that runs students' code [bytes]."""


@dataclasses.dataclass(frozen=True)
class Verdict:
    """Result of checking an exercise.

    Attributes:
        status: Status of the exercise, such as ``solved``; ``untouched`` while the placeholder ``...`` is in the file.
        message: The error as a sentence; "" if solved.
        mistake: The classical mistake that explains the error; "" if none does.
        tried: The call that shows the error.
        yours: The student's result.
        expected: The right result; "" if several are right.
        right: Number of right answers.
        asked: Number of questions.
        seed: Seed of the questions.
        question: Index of the question that ``message`` refers to.
        answer: The student's result as numbers; None if it is not numbers.
        output: Printed output of the student's code.
    """

    status: Status
    message: str = ""
    mistake: str = ""
    tried: str = ""
    yours: str = ""
    expected: str = ""
    right: int = 0
    asked: int = 0
    seed: int = 0
    question: int = 0
    answer: object = None
    output: str = ""


def check_file(exercise: Path, check: Check, seed: int) -> Verdict:
    """Check a file in this process.

    Args:
        exercise: The student's file.
        check: Its check.
        seed: Seed of the questions.
    """
    try:
        function = student_function(exercise, check)
    except _RefusalError as refusal:
        return Verdict(*refusal.args, seed=seed)
    asked, process = questions(check, seed), os.getpid()
    given: list[object] = []
    for number, arguments in enumerate(asked):
        try:
            given.append(function(*_copied(arguments)))
        except BaseException as error:  # of the student's; SystemExit as well
            tried = call_text(check, arguments)
            text = error_text(error, exercise)
            return Verdict("error", text, tried=tried, asked=len(asked), seed=seed, question=number)
        finally:
            if os.getpid() != process:  # the student's code forked
                os._exit(0)
    return _verdict(check, asked, given, seed)


def _copied(arguments: Arguments) -> Arguments:
    """Copy the arrays among arguments, since a student's function may change them."""
    return tuple(copy.copy(argument) if hasattr(argument, "dtype") else argument for argument in arguments)


def _verdict(check: Check, asked: Sequence[Arguments], given: Sequence[object], seed: int) -> Verdict:
    complaints = [check.complaint(returned, arguments) for returned, arguments in zip(given, asked, strict=True)]
    wrong = [number for number, complaint in enumerate(complaints) if complaint is not None]
    right = len(asked) - len(wrong)
    if not wrong:
        return Verdict("solved", right=right, asked=len(asked), seed=seed, answer=_numbers(given[0]))
    worst = wrong[0]
    arguments = asked[worst]
    if given[worst] is ...:
        return Verdict("untouched", "it still returns ...: put your code in its place", asked=len(asked), seed=seed)
    return Verdict(
        "wrong",
        complaints[worst] or "",
        recognized(check, asked, given) or "",
        call_text(check, arguments),
        shortened(given[worst], _WIDTH),
        shortened(check.answer(*arguments), _WIDTH) if check.judge is None else "",
        right,
        len(asked),
        seed,
        worst,
        _numbers(given[worst]),
    )


def _numbers(given: object) -> object:
    try:
        return np.asarray(given, dtype=float).tolist()
    except (TypeError, ValueError):
        return None


def questions(check: Check, seed: int) -> list[Arguments]:
    """Return the arguments of all questions for a seed."""
    random = np.random.default_rng(seed)
    return [check.question(random) for _ in range(check.questions)]


def load_check(path: Path) -> Check:
    """Return the check that a file defines as ``CHECK``."""
    space: dict[str, object] = {"__name__": path.stem, "__file__": str(path)}
    exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), space)  # a course is code, as its page says
    return cast("Check", space["CHECK"])


class _RefusalError(Exception):
    """Raised for a file that cannot be checked; contains status and message of the verdict."""


def student_function(path: Path, check: Check) -> Function:
    """Run a student's file, and return the function that it defines."""
    try:
        text = path.read_text(encoding="utf-8-sig")  # editors on Windows may write a byte order mark
    except (OSError, UnicodeDecodeError) as error:
        raise _RefusalError("error", f"the file cannot be read: {error}") from None
    try:
        if callable(check.function):
            if "..." in text:
                raise _RefusalError("untouched", "the file still has ... in it: put your tags in its place")
            return check.function(path)
        space = _defined(path, text, check.function)
    except _RefusalError:
        raise
    except BaseException as error:
        raise _RefusalError("error", error_text(error, path)) from None
    function = space.get(check.function)
    if not callable(function):
        raise _RefusalError("error", f"the file defines no function {check.function}; it must keep this name")
    return function


def _defined(path: Path, text: str, function: str) -> dict[str, object]:
    """Execute a student's file and return its global names; refuse it if ``function`` still has a placeholder."""
    tree = ast.parse(text, str(path))
    if _has_hole(tree, function):
        message = f"{function} still has ... in it: put your code in its place"
        raise _RefusalError("untouched", message)
    space: dict[str, object] = {"__name__": "exercise", "__file__": str(path)}
    exec(compile(tree, str(path), "exec"), space)
    return space


def _has_hole(tree: ast.Module, name: str) -> bool:
    """Return whether a function still contains the placeholder ``...``, as a statement or as a value."""
    functions = (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name == name)
    values = (
        node
        for function in functions
        for node in ast.walk(function)
        if isinstance(node, ast.Expr | ast.Return | ast.Assign)
    )
    return any(isinstance(node.value, ast.Constant) and node.value.value is ... for node in values)


def call_text(check: Check, arguments: Arguments) -> str:
    """Return a call of the student's function as text; "" if it has no arguments."""
    if not arguments:
        return ""
    name = check.function if isinstance(check.function, str) else "joint values"
    return f"{name}({', '.join(shortened(argument, 80) for argument in arguments)})"


def error_text(error: BaseException, path: Path) -> str:
    """Return an exception with the lines of its traceback that are in the student's file."""
    if path.suffix != ".py":  # a model: its errors name file and line
        return " ".join(str(error).split())
    name = type(error).__name__
    if isinstance(error, SyntaxError) and error.filename == str(path):
        return f"line {error.lineno}: {name}: {error.msg}: {(error.text or '').strip()}"
    if isinstance(error, SystemExit):
        name = "the code ends Python (SystemExit)"
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
    place = f"line {frames[-1].lineno}, `{frames[-1].line}`: " if frames else ""
    return " ".join(f"{place}{name}: {error}".split())


def main(arguments: Sequence[str]) -> None:
    """Check an exercise, and write the verdict as JSON."""
    exercise, check, result, seed, seconds = arguments
    faulthandler.dump_traceback_later(float(seconds), exit=True, file=2)
    _limit_memory()
    try:
        verdict = check_file(Path(exercise), load_check(Path(check)), int(seed))
    except Exception as error:
        verdict = Verdict("error", f"the check {check} does not work: {error_text(error, Path(check))}")
    sys.stdout.flush()
    Path(result).write_text(json.dumps(dataclasses.asdict(verdict)), encoding="utf-8")
    os._exit(0)


def _limit_memory() -> None:
    try:
        import resource  # noqa: PLC0415 - not on Windows
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_DATA, (_MEMORY, resource.getrlimit(resource.RLIMIT_DATA)[1]))


if __name__ == "__main__":
    main(sys.argv[1:])
