"""Parsing of long number lists in text, in pieces: a list of all words would take thirty times the memory."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ravemj.formats.limits import MOST_NUMBERS

_PIECE = 1 << 20  # characters
_SPACE = re.compile(r"\s")


def parse_list(text: str, number: Callable[[str], float]) -> NDArray[Any]:
    """Apply a conversion function to each word of a text.

    Raises:
        ValueError: The function rejects a word.
        OverflowError: There are more than ``MOST_NUMBERS`` words, or an integer is too large.
    """
    parts: list[NDArray[Any]] = []
    count = 0
    for words in _pieces(text):
        count += len(words)
        if count > MOST_NUMBERS:
            raise OverflowError(f"a list has more than {MOST_NUMBERS:,} numbers")
        parts.append(np.array(list(map(number, words))))
    return np.concatenate(parts) if len(parts) > 1 else parts[0]


def _pieces(text: str) -> Iterator[list[str]]:
    """Yield the words of a text in lists of about a megabyte; an empty text yields one empty list."""
    start = 0
    while True:
        space = _SPACE.search(text, start + _PIECE)
        end = len(text) if space is None else space.start()
        yield text[start:end].split()
        if space is None:
            return
        start = end
