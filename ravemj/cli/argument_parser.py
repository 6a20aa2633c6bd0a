"""Argument parser of all commands, which reports an invalid argument in one line, with a suggestion."""

import argparse
import difflib
import re
from collections.abc import Iterable, Sequence
from typing import NoReturn

_LIKENESS = 0.7  # minimum similarity of a misspelt word: excludes "help" for "shell"


class Parser(argparse.ArgumentParser):
    """Argument parser that reports an invalid argument in one line."""

    def error(self, message: str) -> NoReturn:
        """Exit with a one-line message about an invalid argument."""
        self.exit(2, f"{self.prog}: error: {message}; see {self.prog} --help\n")

    def parse_known_args(  # pyright: ignore[reportIncompatibleMethodOverride] - its overloads
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Reject unknown arguments, with the name of the command in the message.

        Unknown options are checked first: argparse accepts abbreviated options, and reports missing arguments before
        unknown ones.
        """
        self._refuse(self._unknown_options(args or ()))
        parsed, unknown = super().parse_known_args(args, namespace or argparse.Namespace())
        self._refuse(unknown)
        return parsed, unknown

    def _refuse(self, unknown: Sequence[str]) -> None:
        if unknown:
            self.error(f"unknown: {' '.join(unknown)}{did_you_mean(unknown[0], self._option_string_actions)}")

    def _unknown_options(self, words: Sequence[str]) -> list[str]:
        # The words after the first positional one are for a subparser or a script.
        passes_on = any(action.nargs in {argparse.PARSER, argparse.REMAINDER} for action in self._actions)
        unknown: list[str] = []
        for word in words:
            if word == "--" or (passes_on and not word.startswith("-")):
                break
            name = word.partition("=")[0] if word.startswith("--") else word[:2]
            if re.match(r"--?[a-z]", word, re.IGNORECASE) and " " not in word:
                unknown += [] if name in self._option_string_actions else [word]
        return unknown

    def _check_value(self, action: argparse.Action, value: object) -> None:
        """Reject a value outside the choices, suggesting the closest one."""
        if action.choices is not None and value not in action.choices:
            choices = [str(choice) for choice in action.choices]
            guess = did_you_mean(str(value), choices)
            raise argparse.ArgumentError(action, f"'{value}' is none of {', '.join(choices)}{guess}")


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return a suggestion of the closest known word, or an empty text."""
    close = difflib.get_close_matches(word, known, 1, _LIKENESS)
    return f"; did you mean {close[0]}?" if close else ""
