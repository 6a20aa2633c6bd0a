"""Robust standard streams, which may be closed, full, or lack characters."""

import codecs
import io
import os
import sys
from contextlib import suppress
from typing import cast

_PLAIN = {"…": "...", "─": "-", "│": "|", "├": "|", "└": "`", "╴": "-", "←": "<-", "²": "^2", "³": "^3", "±": "+-"}
_CHOSEN = {"replace", "ignore", "xmlcharrefreplace", "namereplace"}
"""Encoding error handlers that never fail; if the user has set one of them, it is kept."""


def prepare_streams() -> None:
    """Configure the standard streams of this process so that any text can be printed.

    Characters outside the encoding are escaped in ASCII. Writing to a closed standard output fails like writing to a
    full one. Messages that standard error rejects are lost.
    """
    codecs.register_error("ravemj", _in_ascii)
    # In this order they get the numbers 0, 1 and 2, where no other file would be safe from what C libraries print.
    for name, flags, mode in (("stdin", os.O_RDONLY, "r"), ("stdout", os.O_RDONLY, "w"), ("stderr", os.O_WRONLY, "w")):
        if getattr(sys, name) is None:
            stream = os.fdopen(os.open(os.devnull, flags), mode)
            setattr(sys, name, stream)
            setattr(sys, f"__{name}__", stream)
    if sys.stdout.errors not in _CHOSEN:
        cast(io.TextIOWrapper, sys.stdout).reconfigure(errors="ravemj")
    sys.stderr = _Messages(sys.stderr.buffer, sys.stderr.encoding, "ravemj", line_buffering=True)


def _in_ascii(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    character = error.object[error.start]
    return _PLAIN.get(character) or ascii(character)[1:-1], error.start + 1


class _Messages(io.TextIOWrapper):
    """A stream that never fails: text that cannot be written is lost, and the command continues."""

    def write(self, text: str) -> int:
        with suppress(OSError):
            super().write(text)
        return len(text)

    def flush(self) -> None:
        with suppress(OSError):
            super().flush()
