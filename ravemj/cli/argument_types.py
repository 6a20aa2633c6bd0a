"""Converters of command-line arguments, whose errors name the valid values."""

import argparse
import math
import os

TO_STANDARD_OUTPUT = "-"
"""File name that means standard output."""

_LONGEST_SIDE = 16384  # limit of OpenGL's framebuffers on most machines
_LARGEST = 1e100  # squares and products of larger numbers overflow
_MOST_DIGITS = 9  # so that a seed fits into 32 bits


def file_name(text: str) -> str:
    """Return the name of a file or folder."""
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return text


def package(text: str) -> str:
    """Check ``NAME=FOLDER`` of a package."""
    name, _, folder = text.partition("=")
    if not name or not os.path.isdir(folder):
        reason = f"'{folder}' is no folder" if folder else "should be NAME=FOLDER"
        raise argparse.ArgumentTypeError(f"'{text}': {reason}")
    return text


def argument(text: str) -> str:
    """Check ``NAME:=VALUE`` of a xacro argument."""
    name, separator, _ = text.partition(":=")
    if not name or not separator or len(text.split()) != 1:
        raise argparse.ArgumentTypeError(f"'{text}' should be NAME:=VALUE, without blanks")
    return text


def vector(text: str) -> list[float]:
    """Parse numbers separated by commas or blanks."""
    return [_number(part) for part in text.replace(",", " ").split()]


def limb_goal(text: str) -> tuple[str, list[float]]:
    """Parse the goal of a limb: ``NAME=x,y,z``, or with a quaternion ``NAME=x,y,z,qw,qx,qy,qz``."""
    name, equals, numbers = text.rpartition("=")
    if not (equals and name.strip() and numbers.strip()):
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=x,y,z or NAME=x,y,z,qw,qx,qy,qz")
    return name.strip(), vector(numbers)


def names(text: str) -> list[str]:
    """Parse names separated by commas."""
    return [part.strip() for part in text.split(",") if part.strip()]


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"'{text}' is not a finite number")
    if abs(number) > _LARGEST:
        raise argparse.ArgumentTypeError(f"'{text}' is too large: expected at most {_LARGEST:g}")
    return number


def positive(text: str) -> float:
    """Parse a number above 0."""
    number = _number(text)
    if number <= 0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return number


def tilt(text: str) -> float:
    """Parse an angle above 0 and at most 180 [degrees]."""
    number = positive(text)
    if number > 180:
        raise argparse.ArgumentTypeError(f"{text} is more than 180 degrees")
    return number


def rate(text: str) -> float | None:
    """Parse a number of points per second; the word ``waypoints`` gives None."""
    try:
        return None if text == "waypoints" else positive(text)
    except argparse.ArgumentTypeError as error:
        raise argparse.ArgumentTypeError(f"{error}, and not the word waypoints") from None


def seed(text: str) -> int:
    """Parse the seed of random numbers: a whole number, at least 0."""
    if not (text.isascii() and text.isdecimal() and len(text) <= _MOST_DIGITS):
        raise argparse.ArgumentTypeError(
            f"'{text}' is not a whole number from 0 on, with {_MOST_DIGITS} digits or less"
        )
    return int(text)


def port(text: str) -> int:
    """Parse a port number."""
    if not (text.isascii() and text.isdecimal() and int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"'{text}' is not the number of a port, from 0 to 65535")
    return int(text)


def size(text: str) -> tuple[int, int]:
    """Parse width and height of a picture [pixels]."""
    width, cross, height = text.lower().partition("x")
    if not (cross and all(side.isdecimal() and 0 < int(side) <= _LONGEST_SIDE for side in (width, height))):
        wanted = f"a size such as 640x480, at most {_LONGEST_SIDE}x{_LONGEST_SIDE}"
        raise argparse.ArgumentTypeError(f"'{text}' is not {wanted}")
    return int(width), int(height)


def colour(text: str) -> list[float]:
    """Parse a colour, three numbers from 0 to 1, a CSS name or #rrggbb; return red, green and blue."""
    if text[:1].isalpha() or text.startswith("#"):
        return _colour_of_name(text)
    parts = vector(text)
    if len(parts) != 3 or not all(0 <= part <= 1 for part in parts):
        raise _no_colour(text)
    return parts


def _colour_of_name(text: str) -> list[float]:
    """Return the RGB colour, in [0, 1], of a CSS name or hexadecimal digits."""
    from PIL import ImageColor  # noqa: PLC0415 - slow to import

    try:
        return [part / 255 for part in ImageColor.getrgb(text)[:3]]
    except ValueError:
        raise _no_colour(text) from None


def _no_colour(text: str) -> argparse.ArgumentTypeError:
    return argparse.ArgumentTypeError(f"'{text}' is not a colour such as red, #d9e2e6 or 0.8,0.85,0.9")
