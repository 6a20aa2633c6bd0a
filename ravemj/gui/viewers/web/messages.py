"""What pages send: JSON objects of a few known kinds, checked before they count."""

import base64
import json
import math
import re
from collections.abc import Callable
from typing import Any, NamedTuple

from ravemj.gui.interaction import (
    Button,
    Event,
    Fingers,
    Key,
    Leave,
    Move,
    Operate,
    Press,
    Release,
    Resize,
    Tool,
    Use,
    Wheel,
)

LONGEST = 1024
"""Longest message of a page [bytes]."""

_FARTHEST = 100_000.0
_LARGEST = 8192
_LONGEST_KEY = 20
_MOST_BRACKETS = 8
_FILE = re.compile(r"[\w(][\w() .+-]{0,99}")
"""Names of files that a page may send; none of them leads to another folder."""


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


class Piece(NamedTuple):
    """A piece of a file that was dropped on the page.

    Attributes:
        name: The file's name, without a folder.
        data: What comes next in it.
        is_last: Whether all files of the drop are complete.
    """

    name: str
    data: bytes
    is_last: bool


class Draws(NamedTuple):
    """The page says who draws.

    Attributes:
        itself: Whether it draws by itself; False: it shows pictures.
    """

    itself: bool


Message = Event | Shape | Ready | Piece | Draws


def parse(text: str | bytes) -> Message:
    """Return what a message says.

    Raises:
        ValueError: it says nothing that is known, or numbers that make no sense; the text is one of a few.
    """
    try:
        text = text if isinstance(text, str) else text.decode()
        # Messages are flat. Deep ones end the parser at Python's limit of recursion, and finalizers that the garbage
        # collector happens to run down there fail.
        if text.count("[") + text.count("{") > _MOST_BRACKETS:
            raise ValueError
        fields = json.loads(text)
        parser = _PARSERS[fields["type"]]
    except (KeyError, TypeError, ValueError):
        raise ValueError("this is not a message of a viewer's page") from None
    try:
        return parser(fields)
    except (KeyError, TypeError):
        raise ValueError("a field is missing, or of another kind") from None


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError("a field is not a number")
    if abs(value) > _FARTHEST:
        raise ValueError("a number is too large")
    return float(value)


def _flag(value: object) -> bool:
    if not isinstance(value, bool):
        raise ValueError("a field is neither true nor false")
    return value


def _button(name: object) -> Button:
    if name not in _BUTTONS:
        raise ValueError("there is no such button of a mouse")
    return _BUTTONS[name]


def _press(fields: dict[str, Any]) -> Press:
    at = _number(fields["x"]), _number(fields["y"])
    return Press(*at, _button(fields["button"]), *(_flag(fields[name]) for name in ("ctrl", "shift", "touch")))


def _release(fields: dict[str, Any]) -> Release:
    return Release(_number(fields["x"]), _number(fields["y"]), _button(fields["button"]))


def _key(fields: dict[str, Any]) -> Key:
    name = fields["name"]
    if not isinstance(name, str) or len(name) > _LONGEST_KEY:
        raise ValueError("there is no such key")
    return Key(name, _flag(fields["pressed"]))


def _fingers(fields: dict[str, Any]) -> Fingers:
    spread = _number(fields["spread"])
    if spread <= 0:
        raise ValueError("fingers are never so near")
    x, y, right, down = (_number(fields[name]) for name in ("x", "y", "right", "down"))
    return Fingers(x, y, right, down, spread)


def _use(fields: dict[str, Any]) -> Use:
    name = fields["tool"]
    if name not in _TOOLS:
        raise ValueError("there is no such tool")
    return Use(_TOOLS[name], _number(fields["amount"]))


def _operate(fields: dict[str, Any]) -> Operate:
    name = fields["name"]
    if not isinstance(name, str) or len(name) > _LONGEST_KEY:
        raise ValueError("there is no such control")
    return Operate(name, _number(fields["value"]))


def _shape(fields: dict[str, Any]) -> Shape:
    width, height, ratio = (_number(fields[name]) for name in ("width", "height", "ratio"))
    if not (1 <= width <= _LARGEST and 1 <= height <= _LARGEST and 0.1 <= ratio <= 10):
        raise ValueError("there are no pages of this size")
    return Shape(Resize(round(width), round(height)), ratio)


def _piece(fields: dict[str, Any]) -> Piece:
    name, data = fields["name"], fields["data"]
    if not isinstance(name, str) or not _FILE.fullmatch(name) or not isinstance(data, str):
        raise ValueError("there are no such files")
    return Piece(name, base64.b64decode(data, validate=True), _flag(fields["last"]))


_BUTTONS: dict[object, Button] = {button.value: button for button in Button}
_TOOLS: dict[object, Tool] = {tool.value: tool for tool in Tool}
_PARSERS: dict[str, Callable[[dict[str, Any]], Message]] = {
    "press": _press,
    "release": _release,
    "move": lambda fields: Move(_number(fields["x"]), _number(fields["y"])),
    "wheel": lambda fields: Wheel(_number(fields["steps"])),
    "fingers": _fingers,
    "use": _use,
    "operate": _operate,
    "key": _key,
    "leave": lambda fields: Leave(),
    "shape": _shape,
    "piece": _piece,
    "ready": lambda fields: Ready(),
    "draws": lambda fields: Draws(_flag(fields["itself"])),
}
