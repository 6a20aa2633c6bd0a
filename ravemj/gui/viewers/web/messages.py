"""Messages of pages: JSON objects of a few kinds, validated during parsing."""

import base64
import json
import logging
import math
import os
import re
from collections.abc import Callable
from enum import Enum
from typing import NamedTuple

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
    Use,
    ViewButton,
    Wheel,
)

_LOG = logging.getLogger("ravemj")

LONGEST = 1536
"""Maximum length of a message [bytes]."""

_FARTHEST = 100_000.0
_LARGEST = 8192
_LONGEST_NAME = 20
_MOST_BRACKETS = 8
_FILE = re.compile(r"[\w(][\w() .+-]{0,99}")
"""Pattern of permitted names of uploaded files; none of them names another folder."""

_DEEPEST = 10  # maximum depth of folders of an uploaded file
_MOST_BYTES = 255
"""Maximum length of file names on most file systems [bytes]; longer names are cut before their suffix."""

_LONGEST_SUFFIX = 20


class PageSize(NamedTuple):
    """The page was resized: size [points], and pixels per point."""

    width: float
    height: float
    ratio: float


class Ready(NamedTuple):
    """The page has shown the last frame and is ready for another."""


class UploadChunk(NamedTuple):
    """A chunk of an uploaded file; with the last chunk all files of the upload are complete."""

    name: str
    data: bytes
    is_last: bool


class DrawingSide(NamedTuple):
    """Whether the page renders the scene itself, or shows pictures of the server."""

    itself: bool


Message = Event | PageSize | Ready | UploadChunk | DrawingSide


def parse(text: str | bytes) -> Message:
    """Parse a message.

    Raises:
        ValueError: its kind is unknown, or a value is invalid; the error text is one of a fixed set.
    """
    try:
        text = text if isinstance(text, str) else text.decode()
        # Messages are flat. Deep ones end the parser at Python's limit of recursion, and finalizers that the garbage
        # collector happens to run down there fail.
        if text.count("[") + text.count("{") > _MOST_BRACKETS:
            raise ValueError
        fields = json.loads(text)
        message, readers = _KINDS[fields["type"]]
    except (KeyError, TypeError, ValueError):
        raise ValueError("this is not a message of a viewer's page") from None
    try:
        return message(*(read(fields[name]) for name, read in readers.items()))
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


def _between(least: float, most: float, trouble: str) -> Callable[[object], float]:
    def read(value: object) -> float:
        number = _number(value)
        if not least <= number <= most:
            raise ValueError(trouble)
        return number

    return read


def _one_of(choices: type[Enum], trouble: str) -> Callable[[object], Enum]:
    known: dict[object, Enum] = {choice.value: choice for choice in choices}

    def read(name: object) -> Enum:
        if name not in known:
            raise ValueError(trouble)
        return known[name]

    return read


def _name(kind: str) -> Callable[[object], str]:
    def read(name: object) -> str:
        if not isinstance(name, str) or len(name) > _LONGEST_NAME:
            raise ValueError(f"there is no such {kind}")
        return name

    return read


def _file_path(path: object) -> str:
    """Return the checked path of an uploaded file, which may include folders."""
    parts = path.split("/") if isinstance(path, str) else []
    if not 0 < len(parts) <= _DEEPEST:
        raise ValueError("there are no such files")
    return "/".join(map(_file_name, parts))


def _file_name(name: str) -> str:
    if not _FILE.fullmatch(name):
        raise ValueError("there are no such files")
    stem, suffix = os.path.splitext(name)
    if len(suffix) > _LONGEST_SUFFIX:
        stem, suffix = name, ""
    return stem.encode()[: _MOST_BYTES - len(suffix.encode())].decode(errors="ignore") + suffix


def _data(text: object) -> bytes:
    if not isinstance(text, str):
        raise ValueError("there are no such files")
    return base64.b64decode(text, validate=True)


_button = _one_of(Button, "there is no such button of a mouse")
_spread = _between(math.ulp(0.0), math.inf, "fingers are never so near")
_length = _between(1, _LARGEST, "there are no pages of this size")
_ratio = _between(0.1, 10, "there are no pages of this size")
_POINT: dict[str, Callable[[object], object]] = {"x": _number, "y": _number}
_KINDS: dict[str, tuple[Callable[..., Message], dict[str, Callable[[object], object]]]] = {
    "press": (Press, {**_POINT, "button": _button, "ctrl": _flag, "shift": _flag, "touch": _flag}),
    "release": (Release, {**_POINT, "button": _button}),
    "move": (Move, _POINT),
    "wheel": (Wheel, {"steps": _number}),
    "fingers": (Fingers, {**_POINT, "right": _number, "down": _number, "spread": _spread}),
    "use": (Use, {"tool": _one_of(ViewButton, "there is no such tool"), "amount": _number}),
    "operate": (Operate, {"name": _name("control"), "value": _number}),
    "key": (Key, {"name": _name("key"), "pressed": _flag}),
    "leave": (Leave, {}),
    "shape": (PageSize, {"width": _length, "height": _length, "ratio": _ratio}),
    "piece": (UploadChunk, {"name": _file_path, "data": _data, "last": _flag}),
    "ready": (Ready, {}),
    "draws": (DrawingSide, {"itself": _flag}),
}
"""For each kind of message its class, and converters of its fields in the order of the constructor."""


class Rejections:
    """Logs each kind of invalid message once, so that the log cannot be flooded."""

    def __init__(self) -> None:
        self._known: set[str] = set()

    def __call__(self, kind: str, detail: object = "") -> None:
        """Log a kind of problem, a fixed text, with the beginning of the message; each kind is logged once."""
        if kind not in self._known:
            self._known.add(kind)
            _LOG.warning("viewer's page: %s%s (further cases are not logged)", kind, detail and f": {detail!r:.80}")
