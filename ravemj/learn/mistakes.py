"""Recognition of classical mistakes in wrong answers."""

import warnings
from collections.abc import Callable, Iterator, Sequence
from itertools import permutations

import numpy as np

from ravemj.learn.check import Arguments, Check, Floats

Transformation = Callable[[Floats], Floats]

_MOST_PERMUTED = 4
"""Maximum number of joints for which all orders are tried; for more joints, only the reversed order is tried."""

_CONJUGATE = np.array([1.0, -1, -1, -1])
_TRANSPOSED = "The rotation is transposed: R_world_link turns link coordinates into world ones."


def _with_transposed_rotation(T: Floats) -> Floats:
    changed = T.copy()
    changed[:3, :3] = T[:3, :3].T
    return changed


def _inverse(T: Floats) -> Floats:
    inverse: Floats = np.linalg.inv(T).astype(float)
    return inverse


_ANSWERS: dict[str, tuple[tuple[str, Transformation], ...]] = {
    "rotation": ((_TRANSPOSED, lambda R: R.T),),
    "pose": (
        ("The pose is inverted: it is that of the world in the frame, not of the frame in the world.", _inverse),
        (_TRANSPOSED, _with_transposed_rotation),
    ),
    "quaternion": (
        ("The quaternion is in the order x y z w; here it is w x y z.", lambda q: np.roll(q, -1)),
        (
            "The quaternion is that of the inverse rotation: its vector part has the other sign.",
            lambda q: q * _CONJUGATE,
        ),
    ),
    "joint values": (("The result is in degrees; joint values are in radians.", np.rad2deg),),
}
"""Typical mistakes by kind of answer: message, and function that applies the mistake to the right answer."""

_LENGTHS: tuple[tuple[str, Transformation], ...] = (
    ("It is in millimetres; lengths here are in metres.", lambda answer: answer * 1000),
    ("It is a thousandth of the right length: millimetres are taken for metres.", lambda answer: answer / 1000),
    ("It is half of the right answer: half extents, or a radius, in place of the whole.", lambda answer: answer / 2),
    ("It is twice the right answer: extents in OpenRAVE are half the size of a box.", lambda answer: answer * 2),
)


_ANGLES: tuple[tuple[str, Transformation], ...] = (
    ("Angles are taken for degrees: np.sin, np.cos and joint values want radians.", np.deg2rad),
    ("Angles in radians are converted as if they were degrees, the wrong way round.", np.rad2deg),
)

_NEGATIVE: tuple[str, Transformation] = (
    "The sign is wrong: each number is the negative of the right one.",
    lambda answer: -answer,
)

_WITH_LENGTHS = {"position", "number", "vector"}


def recognized(check: Check, asked: Sequence[Arguments], given: Sequence[object]) -> str | None:
    """Return the mistake that explains all answers, as a sentence; None if none does.

    Args:
        check: The check.
        asked: The arguments of each question.
        given: The student's answer to each question.
    """
    try:
        answers = [np.asarray(answer, dtype=float) for answer in given]
        right = [np.asarray(check.answer(*arguments), dtype=float) for arguments in asked]
    except (TypeError, ValueError):
        return None
    for sentence, wrong in _candidates(check, asked, right, answers):
        if _agree(check, answers, wrong) and not _agree(check, right, wrong):
            return sentence
    return None


def _candidates(
    check: Check, asked: Sequence[Arguments], right: Sequence[Floats], given: Sequence[Floats]
) -> Iterator[tuple[str, list[Floats] | None]]:
    """Yield the message of each typical mistake, and the answers it would give; None if the mistake is impossible."""
    for sentence, function in check.mistakes.items():
        yield sentence, _answers(function, asked)
    for sentence, convert in _ANGLES if check.angles else ():
        yield sentence, _answers(check.answer, [_converted(check, arguments, convert) for arguments in asked])
    if check.kind == "joint values":
        yield "Angles are off by whole turns: bring them into the limits.", _by_turns(right, given)
    changes = [*_ANSWERS.get(check.kind, ()), *(_LENGTHS if check.kind in _WITH_LENGTHS else ()), _NEGATIVE]
    for sentence, change in changes if check.kind != "boolean" else ():
        yield sentence, [change(answer) for answer in right]
    if check.kind in {"vector", "joint values"} and right[0].ndim == 1:
        yield from _reordered(right)


def _by_turns(right: Sequence[Floats], given: Sequence[Floats]) -> list[Floats] | None:
    """Return the right answers, shifted by full turns to be nearest to the given ones; None if shapes differ."""
    if any(answer.shape != other.shape for answer, other in zip(right, given, strict=True)):
        return None
    turn = 2 * np.pi
    return [answer + turn * np.round((other - answer) / turn) for answer, other in zip(right, given, strict=True)]


def _reordered(right: Sequence[Floats]) -> Iterator[tuple[str, list[Floats]]]:
    count = len(right[0])
    orders = permutations(range(count)) if count <= _MOST_PERMUTED else iter([tuple(range(count))[::-1]])
    for order in orders:
        yield (
            f"The numbers are in another order: {list(order)} in place of {list(range(count))}.",
            [answer[list(order)] for answer in right],
        )


def _answers(function: Callable[..., object], asked: Sequence[Arguments]) -> list[Floats] | None:
    """Return the results of a function for all arguments; None if one call fails."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore"):
            return [np.asarray(function(*arguments), dtype=float) for arguments in asked]
    except (ArithmeticError, TypeError, ValueError, LookupError):
        return None


def _converted(check: Check, arguments: Arguments, convert: Transformation) -> Arguments:
    return tuple(
        convert(np.asarray(argument, dtype=float)) if index in check.angles else argument
        for index, argument in enumerate(arguments)
    )


def _agree(check: Check, answers: Sequence[Floats], wrong: Sequence[Floats] | None) -> bool:
    tolerance = max(check.tolerance, 1e-5)
    return wrong is not None and all(
        answer.shape == other.shape
        and check.distance(answer, other) <= tolerance * max(1.0, float(np.abs(other).max(initial=0)))
        for answer, other in zip(answers, wrong, strict=True)
    )
