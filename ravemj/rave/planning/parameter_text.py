"""Reads and writes planner parameters as OpenRAVE's XML."""

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.trajectories.groups import Group
from ravemj.trajectories.serialization import groups_of, layout_text

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.tree import Element

VECTORS = (
    "_vinitialconfig",
    "_vinitialconfigvelocities",
    "_vgoalconfig",
    "_vgoalconfigvelocities",
    "_vconfiglowerlimit",
    "_vconfigupperlimit",
    "_vconfigvelocitylimit",
    "_vconfigaccelerationlimit",
    "_vconfigjerklimit",
    "_vconfigresolution",
)
NUMBERS = ("_nmaxiterations", "_nmaxplanningtime", "_fsteplength", "_nrandomgeneratorseed")

CHAIN = (
    "linearsmoother",
    "<_nmaxiterations>20</_nmaxiterations>"
    '<_postprocessing planner="parabolicsmoother"><_nmaxiterations>100</_nmaxiterations>'
    "<verifyinitialpath>0</verifyinitialpath></_postprocessing>",
)
"""The default post-processing of paths: the first planner, and its parameters, which name the second planner."""

_ROOT = "plannerparameters"
_POSTPROCESSING = "_postprocessing"


class Tags(NamedTuple):
    """The content of a text of planner parameters.

    Attributes:
        numbers: Scalars, by the names of ``NUMBERS``.
        vectors: Vectors, by the names of ``VECTORS``.
        groups: The layout of a configuration; None if the text has none.
        postprocessing: The planner that processes the path, and its parameters; None if the text has none.
        others: The content of all other elements as text, by their names.
    """

    numbers: dict[str, float]
    vectors: dict[str, Floats]
    groups: list[Group] | None
    postprocessing: tuple[str, str] | None
    others: dict[str, str]


def parameters_text(
    groups: Sequence[Group],
    vectors: Mapping[str, Floats],
    numbers: Mapping[str, float],
    postprocessing: tuple[str, str],
    extra: str,
) -> str:
    """Return planner parameters as a ``<plannerparameters>`` element; ``extra`` are further elements as text."""
    planner, inner = postprocessing
    lines = [f"<{name}>{' '.join(repr(float(value)) for value in vectors[name])}</{name}>" for name in VECTORS]
    lines += [f"<{name}>{_number_text(numbers[name])}</{name}>" for name in NUMBERS]
    chain = f'<{_POSTPROCESSING} planner="{planner}">{inner}</{_POSTPROCESSING}>'
    return "\n".join([f"<{_ROOT}>", layout_text(groups).rstrip(), *lines, chain, extra, f"</{_ROOT}>", ""])


def _number_text(number: float) -> str:
    return str(int(number)) if number == int(number) else repr(float(number))


@lru_cache(maxsize=64)
def read_tags(text: str) -> Tags:
    """Return the content of a text of planner parameters. A text without elements is empty, as in OpenRAVE.

    Args:
        text: Elements, or a whole ``<plannerparameters>``.

    Raises:
        ArgumentError: the text is not well-formed XML, or an element of numbers contains something else.
    """
    groups: list[Group] | None = None
    postprocessing: tuple[str, str] | None = None
    numbers, vectors, others = dict[str, float](), dict[str, Floats](), dict[str, str]()
    for element in _elements(text):
        name, content = element.tag, (element.text or "").strip()
        if name in NUMBERS:
            numbers[name] = _numbers(name, content, 1)[0]
        elif name in VECTORS:
            vectors[name] = np.array(_numbers(name, content))
        elif name == "configuration":
            groups = groups_of(element)
        elif name == _POSTPROCESSING:
            postprocessing = element.attributes.get("planner", ""), _inner(element)
        else:
            others[name] = _inner(element) if element.children else content
    return Tags(numbers, vectors, groups, postprocessing, others)


def _elements(text: str) -> "Sequence[Element]":
    from ravemj.formats.openrave_xml.tree import parse  # noqa: PLC0415 - slow to import

    stripped = text.strip()
    if "<" not in stripped:
        return ()
    document = parse(f"<all>{stripped}</all>".encode(), "planner parameters")
    root = document.root
    if document.error is not None:
        raise ArgumentError(f"planner parameters: {document.error.message}: {stripped!r}")
    return next((child for child in root.children if child.tag == _ROOT), root).children


def _inner(element: "Element") -> str:
    """Return the content of an element as XML text."""
    from xml.sax.saxutils import escape, quoteattr  # noqa: PLC0415 - imports urllib, which is slow

    parts = [escape((element.text or "").strip())]
    for child in element.children:
        attributes = "".join(f" {name}={quoteattr(value)}" for name, value in child.attributes.items())
        parts.append(f"<{child.tag}{attributes}>{_inner(child)}</{child.tag}>")
    return "".join(parts)


def _numbers(name: str, content: str, count: int = 0) -> list[float]:
    try:
        numbers = [float(word) for word in content.split()]
    except ValueError:
        raise ArgumentError(f"<{name}>: '{content}' should be numbers") from None
    if (count and len(numbers) != count) or any(math.isnan(number) for number in numbers):
        raise ArgumentError(f"<{name}>: '{content}' should be {count or 'any number of'} numbers")
    return numbers
