"""Numbers and rotations in the text of an element, by OpenRAVE's rules, with warnings if these are surprising."""

import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from ravemj.core.transforms import (
    UNIT_WXYZ,
    UNMOVED,
    UNSCALED,
    ZERO,
    Pose,
    Vec3,
    Wxyz,
    add,
    multiply,
    normalize,
    rows_from_wxyz,
    wxyz_from_axis_angle,
    wxyz_from_rows,
)
from ravemj.errors import Diagnostics, SourceError
from ravemj.formats.openrave_xml.tree import Element

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+|(?![eE])))", re.ASCII)
_WORD = re.compile(r"\S+", re.ASCII)
"""Pattern of words: in C++, only ASCII digits are digits and only ASCII white space is space."""

_OF_FEW_DIGITS = 0.01
"""Maximum deviation of an entry of a rotation matrix that was written with two digits."""


class Numbers(NamedTuple):
    """The leading numbers of a text.

    Attributes:
        values: The numbers, in order.
        rest: The text after the numbers, normally empty.
    """

    values: list[float]
    rest: str


def leading_numbers(text: str) -> Numbers:
    """Return the numbers at the start of a text, as C++ streams would read them."""
    plain = _plain_numbers(text)
    if plain is not None:
        return Numbers(plain, "")
    values: list[float] = []
    position = 0
    while (match := _NUMBER.match(text, position)) and math.isfinite(value := float(match[1])):
        values.append(value)
        position = match.end()
    return Numbers(values, text[position:].strip())


def _plain_numbers(text: str) -> list[float] | None:
    """Return the numbers of a text that contains only numbers, else None."""
    if "_" in text or not text.isascii():  # float() takes 1_0 and digits of other scripts
        return None
    try:
        plain = list(map(float, text.split()))
    except ValueError:  # signs or points in odd places
        return None
    return plain if math.isfinite(sum(plain)) else None


def numbers(element: Element, count: int, diagnostics: Diagnostics, before: Sequence[float] = ZERO) -> list[float]:
    """Return exactly ``count`` numbers from an element's text.

    A word that is not a number is read as 0 and ends the reading (``bad-number``); missing numbers keep their values
    (tests gap-14, gap-15), and excess numbers are ignored (``number-count``). OpenRAVE reports neither.

    Args:
        element: The element.
        count: The expected number of numbers.
        diagnostics: Receives a warning.
        before: The values of missing numbers; 0 beyond its end.
    """
    plain = _plain_numbers(element.text)
    if plain is not None and len(plain) == count:
        return plain
    values, rest = leading_numbers(element.text)
    given = len(values)
    if given == count and not rest:  # numbers whose sum is too large for ``_plain_numbers``
        return values
    if given < count and rest:
        values.append(0.0)
    kept = [*before[len(values) :], *[0.0] * count]
    values = (values + kept)[:count]
    taken = " ".join(f"{value:g}" for value in values)
    expected = "a number" if count == 1 else f"{count} numbers separated by spaces"
    diagnostics.warn(
        "bad-number" if given < count and rest else "number-count",
        f"<{element.spelled}> holds '{' '.join(element.text.split())}' where {expected} should stand; "
        f"OpenRAVE reads {taken}",
        element.source,
    )
    return values


def number_list(element: Element, diagnostics: Diagnostics) -> list[float]:
    """Return the numbers at the start of an element's text; a following word is reported (``bad-number``)."""
    values, rest = leading_numbers(element.text)
    if rest:
        taken = " ".join(f"{value:g}" for value in values) or "none"
        message = f"<{element.spelled}> holds '{rest}' where only numbers should stand; OpenRAVE reads {taken}"
        diagnostics.warn("bad-number", message, element.source)
    return values


def number(element: Element, diagnostics: Diagnostics, before: float = 0.0) -> float:
    """Return the single number in an element's text; ``before`` if the text has none."""
    return numbers(element, 1, diagnostics, (before,))[0]


def vector(element: Element, diagnostics: Diagnostics, before: Vec3 = ZERO) -> Vec3:
    """Return the three numbers in an element's text; missing ones are those of ``before``."""
    x, y, z = numbers(element, 3, diagnostics, before)
    return (x, y, z)


def scale_attribute(element: Element, diagnostics: Diagnostics) -> Vec3:
    """Return the ``scalegeometry`` of an element: one number for all axes, or three; of two, the first is used."""
    if "scalegeometry" not in element.attributes:
        return UNSCALED
    text = element.attributes["scalegeometry"]
    values, rest = leading_numbers(text)
    if rest or len(values) not in {1, 3}:
        message = f'scalegeometry="{text}" should be one number or three'
        diagnostics.warn("bad-number" if rest else "number-count", message, element.source)
    if len(values) == 3:
        return (values[0], values[1], values[2])
    uniform = values[0] if values else 1.0
    return (uniform, uniform, uniform)


def words(text: str) -> list[str]:
    """Return the words of a text, as C++ streams would read them."""
    return _WORD.findall(text)


def word(element: Element, diagnostics: Diagnostics) -> str:
    """Return the first word of an element's text, a name; further words are ignored (``extra-words``)."""
    given = words(element.text) or [""]
    if len(given) > 1:
        message = (
            f"<{element.spelled}> holds '{' '.join(given)}' where one name should stand; OpenRAVE reads '{given[0]}'"
        )
        diagnostics.warn("extra-words", message, element.source, "names that others refer to cannot hold spaces")
    return given[0]


def is_true(value: str) -> bool:
    """Return whether a text is ``true`` in any letter case, or ``1``; all other texts are false."""
    return value.lower() in {"true", "1"}


def is_false(value: str) -> bool:
    """Return whether a text is ``false`` in any letter case, or ``0``."""
    return value.lower() in {"false", "0"}


def hadamard(a: Vec3, b: Vec3) -> Vec3:
    """Return the elementwise product of two vectors."""
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


class ChildTransform:
    """The transform defined by the children of an element, applied in document order.

    Translations are added without rotation; rotations multiply from the left. The order of translations relative to
    rotations does not matter.
    """

    __slots__ = ("_position", "_scale", "_wxyz")

    def __init__(self, start: Pose = UNMOVED, scale: Vec3 = UNSCALED) -> None:
        self._position, self._wxyz = start
        self._scale = scale

    @property
    def pose(self) -> Pose:
        """The transform of the elements read so far."""
        wxyz = self._wxyz
        return Pose(self._position, wxyz if wxyz == UNIT_WXYZ else normalize(wxyz))

    @property
    def moves(self) -> bool:
        """Whether a transform element had an effect."""
        return self._position != ZERO or self._wxyz != UNIT_WXYZ

    def translate(self, element: Element, diagnostics: Diagnostics) -> None:
        """Apply a ``<Translation>``: x y z [m]."""
        self._position = add(self._position, hadamard(self._scale, vector(element, diagnostics)))

    def rotate(self, element: Element, diagnostics: Diagnostics) -> None:
        """Apply one of the rotation elements."""
        self._wxyz = multiply(ROTATIONS[element.tag](element, diagnostics), self._wxyz)


def axis_angle(element: Element, diagnostics: Diagnostics) -> Wxyz:
    """Return the rotation of a ``<RotationAxis>``: an axis of any length, then an angle in degrees."""
    x, y, z, degrees = numbers(element, 4, diagnostics)
    if x == y == z == 0.0 != degrees:  # transform-24
        message = f"<{element.spelled}> turns nothing: its axis is 0 0 0"
        diagnostics.warn("bad-rotation", message, element.source, "write x y z of the axis, and then the angle")
    return wxyz_from_axis_angle((x, y, z), math.radians(degrees))


def _matrix(element: Element, diagnostics: Diagnostics) -> Wxyz:
    m = numbers(element, 9, diagnostics)
    try:
        wxyz = wxyz_from_rows((m[0:3], m[3:6], m[6:9]))
    except ZeroDivisionError:
        raise SourceError(f"<{element.spelled}> holds no rotation: {element.text.strip()}", element.source) from None
    taken = [entry for row in rows_from_wxyz(wxyz) for entry in row]
    if any(abs(entry - other) > _OF_FEW_DIGITS for entry, other in zip(taken, m, strict=True)):  # transform-09
        rows = " ".join(f"{entry:.3g}" for entry in taken)
        message = f"<{element.spelled}> holds no rotation; OpenRAVE makes {rows} of it"
        diagnostics.warn("bad-rotation", message, element.source, "its rows have length 1 and are perpendicular")
    return wxyz


def _quaternion(element: Element, diagnostics: Diagnostics) -> Wxyz:
    w, x, y, z = numbers(element, 4, diagnostics, UNIT_WXYZ)
    try:
        return normalize((w, x, y, z))
    except ZeroDivisionError:
        raise SourceError(
            f"<{element.spelled}> holds no rotation: {element.text.strip()}",
            element.source,
            "write a quaternion as w x y z; 1 0 0 0 turns nothing",
        ) from None


ROTATIONS: dict[str, Callable[[Element, Diagnostics], Wxyz]] = {
    "rotationaxis": axis_angle,
    "rotationmat": _matrix,
    "quat": _quaternion,
}
