"""Texts for students about their answers."""

from collections.abc import Iterator

from ravemj.learn.child import Verdict
from ravemj.learn.course import Exercise

_WORDS = {"solved": "solved", "wrong": "not yet", "error": "it does not run", "untouched": "to do"}


def report(exercise: Exercise, verdict: Verdict) -> str:
    """Return a verdict as text of several lines."""
    return "\n".join([f"{exercise.name}: {exercise.title}", *(f"  {line}" for line in _lines(verdict))])


def state(verdict: Verdict) -> str:
    """Return the state of an exercise in one or two words."""
    return _WORDS[verdict.status]


def _lines(verdict: Verdict) -> Iterator[str]:
    if verdict.status == "solved":
        yield f"Solved: {verdict.right} of {verdict.asked} answers are right."
        return
    if verdict.status == "wrong":
        yield f"Not yet: {verdict.right} of {verdict.asked} answers are right."
    for name, text in (("tried", verdict.tried), ("yours", verdict.yours), ("expected", verdict.expected)):
        if text:
            yield f"{name:<10}{text}"
    if verdict.message:
        yield verdict.message
    if verdict.mistake:
        yield f"Probably: {verdict.mistake}"
    if verdict.output.strip():
        yield "printed:"
        yield from (f"  {line}" for line in verdict.output.strip().splitlines()[-10:])
