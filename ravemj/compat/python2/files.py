"""Files, pickles and processes of Python 2, which did not distinguish text and bytes."""

# Pickles and streams may contain any type.
# pyright: reportUnknownMemberType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownLambdaType=false

import codecs
import hashlib
import os
import pickle
import subprocess
from collections.abc import Callable, Iterable
from typing import Any, Self

_ENCODING, _ERRORS = "utf-8", "surrogateescape"  # invalid UTF-8 survives a round trip through text


def as_bytes(text: Any) -> Any:
    """Return text as bytes; return anything else unchanged."""
    return text.encode(_ENCODING, _ERRORS) if isinstance(text, str) else text


def as_text(data: bytes) -> str:
    """Return bytes as text."""
    return data.decode(_ENCODING, _ERRORS)


class File:
    r"""Result of ``open`` and ``file``: accepts text and bytes in every mode, since both are ``str`` in Python 2.

    Lines are text in every mode, as ``csv`` requires. ``read`` returns text, too, but bytes from a binary file, since
    scripts unpack them.

    Args:
        name: Path.
        mode: As in Python 2; with ``"U"`` each line ends with ``"\n"``.
        buffering: 0 for none, 1 for lines, else a size in bytes.
    """

    encoding = newlines = None

    def __init__(self, name: str, mode: str = "r", buffering: int = -1) -> None:
        self.name, self.mode = name, mode
        letters = "".join(letter for letter in mode if letter not in "btU") or "r"
        self.buffer: Any = open(name, f"{letters}b", 0 if buffering == 1 else buffering)  # noqa: SIM115 - scripts close it
        self._is_binary = "b" in mode
        self._is_universal = "U" in mode or (os.linesep != "\n" and not self._is_binary)

    def __getattr__(self, name: str) -> Any:
        """Forward other attributes to the file of Python 3."""
        return getattr(self.buffer, name)

    def _text(self, data: bytes) -> str:
        text = as_text(data)
        return text.replace("\r\n", "\n") if self._is_universal else text

    def read(self, size: int = -1) -> str | bytes:
        """Return the rest, or at most ``size`` bytes of it."""
        data = self.buffer.read(size)
        return data if self._is_binary else self._text(data)

    def readline(self, size: int = -1) -> str:
        """Return the next line."""
        return self._text(self.buffer.readline(size))

    def readlines(self, size: int = -1) -> list[str]:
        """Return the remaining lines, or the first ones with at least ``size`` bytes."""
        return [self._text(line) for line in self.buffer.readlines(size)]

    def __iter__(self) -> Self:
        return self

    xreadlines = __iter__

    def __next__(self) -> str:
        return self._text(next(self.buffer))

    def write(self, text: object) -> None:
        """Write text or bytes."""
        self.buffer.write(as_bytes(text))

    def writelines(self, lines: Iterable[object]) -> None:
        """Write several lines."""
        for line in lines:
            self.write(line)

    def __del__(self) -> None:
        """Close without a warning, as Python 2 did."""
        if "buffer" in vars(self):
            self.buffer.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.buffer.close()


class Unpickler(pickle.Unpickler):
    """Unpickler for files of text and of bytes, and for pickles of Python 2."""

    def __init__(self, file: Any) -> None:
        super().__init__(getattr(file, "buffer", file), encoding="latin-1")  # as numpy's arrays ask for


def load(file: Any) -> Any:
    """Load like ``pickle.load``, also pickles of Python 2."""
    return Unpickler(file).load()


def loads(data: str | bytes) -> Any:
    """Load like ``pickle.loads``, also pickles of Python 2."""
    return pickle.loads(as_bytes(data), encoding="latin-1")


def new_hash(name: str, string: object = b"") -> Any:
    """Replacement of ``hashlib.new`` that also accepts text."""
    return hashlib.new(name, as_bytes(string))


def getwriter(encoding: str) -> Callable[..., Any]:
    """Replacement of ``codecs.getwriter``, which ``sys.stdout`` no longer needs."""
    return lambda stream, *args: stream if hasattr(stream, "encoding") else codecs.getwriter(encoding)(stream, *args)


class Popen(subprocess.Popen[str]):
    """Process with text pipes."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **{"encoding": _ENCODING, "errors": _ERRORS, **options})


def check_output(*args: Any, **options: Any) -> str:
    """Replacement of ``subprocess.check_output``."""
    return subprocess.check_output(*args, **{"encoding": _ENCODING, "errors": _ERRORS, **options})
