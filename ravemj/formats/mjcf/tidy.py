"""Removal of rounding noise from vectors."""

import functools
import math
import re

_VECTOR = re.compile(r'(?<= )(pos|quat|axis|dir|size|gravity|rgba)="([^"]*\d{9}[^"]*)"')  # with a long number in it
_NOISE = 8
"""Maximum rounding of a vector's numbers, in units in the last place of the largest one."""


def tidy(line: str) -> str:
    """Return a line of MJCF in which long numbers of vectors are replaced by the shortest decimals near them.

    The tolerance is 8 units in the last place of the vector's largest number. Masses, inertias and limits are kept.
    """
    return _VECTOR.sub(_tidied, line)


def _tidied(match: re.Match[str]) -> str:
    return f'{match[1]}="{tidy_vector(match[2])}"'


@functools.lru_cache(maxsize=10_000)
def tidy_vector(text: str) -> str:
    """Return numbers, separated by spaces, as the shortest decimals within the noise of the largest one."""
    numbers = [float(word) for word in text.split()]
    largest = max(map(abs, numbers))
    if not math.isfinite(largest):
        return text
    return " ".join(_shortest(number, _NOISE * math.ulp(largest)) for number in numbers)


def _shortest(number: float, noise: float) -> str:
    """Return the shortest decimal within ``noise`` of a number."""
    if abs(number) <= noise:
        return "0"
    few, enough = 0, 17  # insufficient and sufficient numbers of digits; more digits are never less accurate
    while enough - few > 1:
        middle = (few + enough) // 2
        if abs(float(f"{number:.{middle}g}") - number) <= noise:
            enough = middle
        else:
            few = middle
    return repr(float(f"{number:.{enough}g}")).removesuffix(".0")
