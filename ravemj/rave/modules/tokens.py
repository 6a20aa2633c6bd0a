"""The arguments of commands: texts and numbers, taken off a line one after the other."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError


class Tokens:
    """The tokens of a text, taken one after the other.

    Attributes:
        words: The tokens that are left.
    """

    def __init__(self, text: str) -> None:
        self.words = text.split()

    def next(self, wanted: str = "a word") -> str:
        """Return the next token.

        Raises:
            ArgumentError: there is none.
        """
        if not self.words:
            raise ArgumentError(f"the text ends where {wanted} should follow")
        return self.words.pop(0)

    def __bool__(self) -> bool:
        return bool(self.words)

    def number(self) -> float:
        """Return the next token as a number.

        Raises:
            ArgumentError: the token is not a number.
        """
        word = self.next("a number")
        try:
            return float(word)
        except ValueError:
            raise ArgumentError(f"'{word}' should be a number") from None

    def integer(self) -> int:
        """Return the next token as an integer."""
        number = self.number()
        if not number.is_integer():
            raise ArgumentError(f"{number:g} should be a whole number")
        return int(number)

    def count(self) -> int:
        """Return the next token as a number of things that follow."""
        count = self.integer()
        if count < 0:
            raise ArgumentError(f"{count} should be how many follow, 0 or more")
        return count

    def numbers(self, count: int) -> Floats:
        """Return the next tokens as numbers, shape (count,)."""
        return np.array([self.number() for _ in range(count)])

    def rows(self, width: int) -> Floats:
        """Return rows of numbers, shape (n, width); the number of rows is the first token."""
        return self.numbers(self.count() * width).reshape(-1, width)

    def list(self) -> Floats:
        """Return numbers, shape (n,); the number of them is the first token."""
        return self.numbers(self.count())

    def matrix(self) -> Floats:
        """Return a pose, shape (4, 4), from 12 numbers by columns, as OpenRAVE writes it."""
        pose = np.eye(4)
        pose[:3] = self.numbers(12).reshape(4, 3).T
        return pose


Reader = Callable[[Tokens], Any]


def read_options(text: str, readers: Mapping[str, Reader]) -> dict[str, Any]:
    """Return the options in a text: names, each followed by the tokens that its reader takes.

    Raises:
        ArgumentError: an option is unknown, or is followed by wrong tokens.
    """
    tokens, found = Tokens(text), dict[str, Any]()
    while tokens:
        name = tokens.next().lower()
        if name not in readers:
            raise ArgumentError(f"the command has no argument '{name}'; it takes {', '.join(readers)}")
        try:
            found[name] = readers[name](tokens)
        except ArgumentError as error:
            raise ArgumentError(f"{name}: {error.message}") from None
    return found


def switch(tokens: Tokens) -> bool:
    """Return True for an option without a value."""
    del tokens
    return True


def flag(tokens: Tokens) -> bool:
    """Return whether the next token is not 0."""
    return bool(tokens.number())


def text(tokens: Tokens) -> str:
    """Return the next token."""
    return tokens.next()
