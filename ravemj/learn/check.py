"""Check of an exercise: questions, right answers, and comparison of answers."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Arguments: TypeAlias = tuple[object, ...]
Function: TypeAlias = Callable[..., object]

Kind = Literal["number", "vector", "position", "rotation", "pose", "quaternion", "direction", "joint values", "boolean"]
"""Kind of an answer, by which mistakes are recognized: such as a position [m], a pose (4, 4), a quaternion wxyz."""

_POINTS = {"position", "joint values"}

SINGLE_PRECISION = 1e-4
"""Tolerance of answers in float32."""


@dataclass(frozen=True)
class Scene:
    """Content of a picture of an answer.

    Attributes:
        model: File or shipped name of a model with one robot; "" for none.
        values: Joint values of the robot [rad or m]. None: the values of the model, or the answer if it is joint
            values.
        frame: Name of the link whose frame the answer refers to; "" for the world.
        line: Points of a line [m], such as the links of an arm, each of two or three numbers.
    """

    model: str = ""
    values: Sequence[float] | None = None
    frame: str = ""
    line: Sequence[Sequence[float]] = ()


@dataclass(frozen=True)
class Check:
    """The check of one exercise.

    Attributes:
        function: Name of the function that the student writes. For a file that is not Python, a loader instead: it
            takes the file's path, and returns the function to check.
        question: Returns the arguments of one call, given a random generator.
        answer: Returns the right answer for these arguments.
        hints: Three hints; the last one nearly gives the answer.
        kind: Meaning of the answer.
        angles: Indices of the arguments that are angles [rad], which might be mistaken for degrees.
        mistakes: Further mistakes: a sentence that names the mistake, and a function that returns the wrong answer.
        judge: Judges answers if several are right: called with the answer, an array, and the arguments, it returns None
            if the answer is right, else the error as a sentence. The array is float32 if the student's is, so that
            ``precision`` gives its tolerance.
        any_length: Whether an answer may have any number of rows, such as a path; otherwise it has as many as the right
            answer.
        scene: Returns the content of a picture of the answer for given arguments; None if there is no picture.
        questions: Number of questions.
        tolerance: Maximum error of each number.
    """

    function: str | Callable[[Path], Function]
    question: Callable[[np.random.Generator], Arguments]
    answer: Function
    hints: tuple[str, str, str]
    kind: Kind = "vector"
    angles: tuple[int, ...] = ()
    mistakes: Mapping[str, Function] = field(default_factory=dict[str, Function])
    judge: Callable[..., str | None] | None = None
    any_length: bool = False
    scene: Callable[..., Scene] | None = None
    questions: int = 20
    tolerance: float = 1e-6

    def complaint(self, given: object, arguments: Arguments) -> str | None:
        """Return the error of an answer as a sentence, or None if it is right."""
        wrong = self.misshapen(given, arguments)
        if wrong is not None:
            return wrong
        numbers = np.asarray(given, dtype=float)
        if self.judge is not None:
            return self.judge(np.float32(numbers) if _is_single(given) else numbers, *arguments)
        right = np.asarray(self.answer(*arguments), dtype=float)
        if self.kind == "boolean" and numbers != right:
            return f"it should be {bool(right)}"
        off = self.distance(numbers, right)
        if off <= (SINGLE_PRECISION if _is_single(given) else self.tolerance):
            return None
        if self.kind == "boolean":
            return f"it returns {numbers == 1}, and should return {right == 1}"
        return f"off by {off:.3g}" + {"position": " m", "joint values": " rad"}.get(self.kind, "")

    def misshapen(self, given: object, arguments: Arguments) -> str | None:
        """Return the error in an answer's form as a sentence, or None: type, shape, or numbers that are not finite."""
        if given is None:
            return "it returns None; is there a return at its end?"
        if given is ...:
            return "it still returns ...: put your code in its place"
        try:
            numbers = np.asarray(given, dtype=float)
        except (TypeError, ValueError):
            kind = type(given).__name__
            return f"it returns {shortened(given)}, a {kind}, and should return {self._expected(arguments)}"
        if not np.isfinite(numbers).all():
            return "it returns NaN or infinity; is something divided by zero, or out of the domain of acos or sqrt?"
        right = np.asarray(self.answer(*arguments))
        if self._shape(numbers) != self._shape(right) and (numbers.size or right.size):
            returned = f"an array of shape {numbers.shape}" if numbers.size else "an empty list"
            return f"it returns {returned}, and should return {self._expected(arguments)}"
        return None

    def distance(self, answer: Floats, other: Floats) -> float:
        """Return the maximum difference of two answers, regardless of the signs of quaternions.

        If the check has a ``judge``, rows of points or joint values may be in any order, except in paths
        (``any_length``).
        """
        if not answer.size:
            return 0.0
        if self.judge is not None and self.kind in _POINTS and answer.ndim == 2 and not self.any_length:
            between = np.abs(answer[:, np.newaxis] - other).max(axis=-1)
            return float(max(between.min(axis=0).max(), between.min(axis=1).max()))
        if self.kind == "quaternion":
            return float(min(np.abs(answer - other).max(), np.abs(answer + other).max()))
        return float(np.abs(answer - other).max())

    def _shape(self, answer: object) -> tuple[int | str, ...]:
        shape = np.asarray(answer).shape
        return ("n", *shape[1:]) if self.any_length and shape and shape[0] else shape

    def _expected(self, arguments: Arguments) -> str:
        shape = self._shape(self.answer(*arguments))
        if self.kind == "boolean":
            return "True or False"
        if 0 in shape:
            return "an empty list"
        return f"an array of shape ({', '.join(map(str, shape))}{',' * (len(shape) == 1)})" if shape else "a number"


def precision(given: object) -> float:
    """Return the tolerance of an answer for judges: 1e-6, or 1e-4 for numbers in float32."""
    return SINGLE_PRECISION if _is_single(given) else 1e-6


def shortened(thing: object, length: int = 60) -> str:
    """Return the text of an object, or the name of a robot, in one line of limited length.

    An array and a list of the same numbers give the same text.
    """
    name = getattr(thing, "GetName", None)
    if callable(name):
        return str(name())
    numbers = None
    if not isinstance(thing, bool | int | str | None):
        with suppress(TypeError, ValueError):
            numbers = None if np.asarray(thing).dtype == bool else np.asarray(thing, dtype=float)
    with np.printoptions(precision=4, suppress=True, threshold=20):
        text = str(thing) if numbers is None else str(numbers) if numbers.ndim else f"{float(numbers):.4g}"
    text = " ".join(text.split())
    return text if len(text) <= length else f"{text[: length - 1]}…"


def _is_single(given: object) -> bool:
    return np.asarray(given).dtype == np.float32
