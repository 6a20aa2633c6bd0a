"""What pages send: JSON objects of a few known kinds, checked before they count."""

import json
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from ravemj.interaction import Button, Event, Key, Leave, Move, Press, Release, Resize, Wheel

LONGEST = 1024
"""Longest message of a page [bytes]."""

_FARTHEST = 100_000.0
_LARGEST = 8192
_LONGEST_KEY = 20


class Shape(NamedTuple):
    """The page has another size.

    Attributes:
        resize: The size [points].
        ratio: Pixels of the screen for each point.
    """

    resize: Resize
    ratio: float


class Ready(NamedTuple):
    """The page has shown the last picture and takes another."""


Message = Event | Shape | Ready


def parse(text: str | bytes) -> Message:
    """Return what a message says.

    Raises:
        ValueError: it says nothing that is known, or numbers that make no sense.
    """
    try:
        fields = json.loads(text)
        return _PARSERS[fields["type"]](fields)
    except (KeyError, TypeError, AttributeError, RecursionError, json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"no message of a viewer's page: {type(error).__name__}") from None


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError("a number is missing")
    if abs(value) > _FARTHEST:
        raise ValueError("a number is too large")
    return float(value)


def _flag(value: object) -> bool:
    if not isinstance(value, bool):
        raise TypeError("a flag is missing")
    return value


def _press(fields: dict[str, Any]) -> Press:
    at = _number(fields["x"]), _number(fields["y"])
    return Press(*at, Button(fields["button"]), _flag(fields["ctrl"]), _flag(fields["shift"]))


def _release(fields: dict[str, Any]) -> Release:
    return Release(_number(fields["x"]), _number(fields["y"]), Button(fields["button"]))


def _key(fields: dict[str, Any]) -> Key:
    name = fields["name"]
    if not isinstance(name, str) or len(name) > _LONGEST_KEY:
        raise ValueError("the name of a key is missing")
    return Key(name, _flag(fields["pressed"]))


def _shape(fields: dict[str, Any]) -> Shape:
    width, height, ratio = (_number(fields[name]) for name in ("width", "height", "ratio"))
    if not (1 <= width <= _LARGEST and 1 <= height <= _LARGEST and 0.1 <= ratio <= 10):
        raise ValueError("there are no pages of this size")
    return Shape(Resize(round(width), round(height)), ratio)


_PARSERS: dict[str, Callable[[dict[str, Any]], Message]] = {
    "press": _press,
    "release": _release,
    "move": lambda fields: Move(_number(fields["x"]), _number(fields["y"])),
    "wheel": lambda fields: Wheel(_number(fields["steps"])),
    "key": _key,
    "leave": lambda fields: Leave(),
    "shape": _shape,
    "ready": lambda fields: Ready(),
}
