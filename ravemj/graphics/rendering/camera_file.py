"""Camera files, as read by ``--camera view.json``."""

import json
import os
from pathlib import Path
from typing import Any, cast

from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.formats.limits import json_bytes
from ravemj.graphics.rendering.camera import DEFAULT_FOVY, Camera

_EXPECTED = "expected a 4x4 matrix as JSON, as a Python list or as rows of numbers"
_PUNCTUATION = str.maketrans("[](),;", "      ")


def read_camera(path: str | Path) -> Camera:
    """Read a camera in OpenRAVE's convention from a file.

    The file contains T_world_camera as JSON (a nested list, or ``{"camera": [[...], ...]}`` with an optional
    ``"fovy"`` in radians), as the list printed in OpenRAVE's tutorial, or as rows of numbers; ``#`` starts a
    comment. 3x4 matrices and poses [w, x, y, z, tx, ty, tz] are accepted, too.

    Raises:
        SourceError: the file cannot be read, or does not contain a camera; the message says why.
    """
    source = Source(str(path))
    try:
        text = json_bytes(os.fspath(path)).decode()
    except OSError as error:
        raise SourceError(f"cannot read the camera: {str(error.strerror).lower()}", source, "check the path") from None
    except UnicodeDecodeError:
        raise SourceError("cannot read the camera: this is not a text file", source, _EXPECTED) from None
    try:
        document = json.loads(text)
    except (RecursionError, ValueError):
        document = _read_numbers(text, source)
    try:
        return _camera_from_document(document)
    except ArgumentError as error:
        hint = "" if "expected" in error.message else _EXPECTED  # most say already what they expect
        raise SourceError(error.message, source, hint) from None


def _camera_from_document(document: Any) -> Camera:  # noqa: ANN401 - what JSON can hold
    if not isinstance(document, dict):
        return Camera.from_matrix(document)
    entries = cast(dict[str, Any], document)
    if "camera" not in entries:
        raise ArgumentError('camera: found a JSON object without the entry "camera"')
    fovy = entries.get("fovy", DEFAULT_FOVY)
    if not isinstance(fovy, int | float):
        raise ArgumentError(f'camera: "fovy" is {json.dumps(fovy)}, expected a number of radians')
    return Camera.from_matrix(entries["camera"], fovy)


def _read_numbers(text: str, source: Source) -> list[list[float]] | list[float]:
    numbers: list[float] = []
    for line_number, line in enumerate(text.splitlines(), start=1):
        for word in line.partition("#")[0].replace("array", " ").translate(_PUNCTUATION).split():
            try:
                numbers.append(float(word))
            except ValueError:
                place = Source(source.file, line_number)
                raise SourceError(f"the camera holds {word!r}, which is not a number", place, _EXPECTED) from None
    if len(numbers) not in (12, 16):
        return numbers
    return [numbers[start : start + 4] for start in range(0, len(numbers), 4)]
