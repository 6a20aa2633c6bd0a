"""COLLADA 1.5 files with kinematics, ``.dae`` and ``.zae``.

A document has a visual scene, a kinematics scene and a physics scene, and binds their elements to each other.
``scenes`` traverses it and fills a ``BodyBuilder`` for each robot; the other modules each read one kind of element.
References may name other files. As in OpenRAVE, elements with broken references are skipped; they are reported.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ravemj.errors import Source, SourceError
from ravemj.formats.collada.documents import Documents
from ravemj.formats.file_access import FileAccess
from ravemj.formats.suffixes import SUFFIXES as MODEL_SUFFIXES

if TYPE_CHECKING:
    from ravemj.formats.collada.library import Library
    from ravemj.formats.collada.scenes import Content
    from ravemj.formats.meshes.collada.document import ColladaDocument

SUFFIXES = MODEL_SUFFIXES["collada"]
"""File suffixes, in lower case."""


def read_file(
    uri: str,
    access: FileAccess,
    included_from: Source | None = None,
    scale: float = 1.0,
    documents: Documents | None = None,
) -> "Content":
    """Read a ``.dae`` or ``.zae`` file.

    Args:
        uri: The path; ``#`` and the id of an articulated system or model select a single body.
        access: The files that may be read; receives diagnostics.
        included_from: The element that names the file, or None.
        scale: Factor of all lengths.
        documents: The COLLADA documents of the model that names the file; None if the file is the whole model.

    Raises:
        SourceError: The file is malformed or has impossible content.
    """
    from ravemj.formats.collada.library import Library  # noqa: PLC0415 - lxml is slow to import

    path, wanted = split_uri(uri)
    library = Library(access, included_from, scale, documents)
    return _read(library, path, lambda: library.open_file(path), wanted)


def is_collada(uri: str) -> bool:
    """Return whether a URI refers to a COLLADA file, or an element in one."""
    return split_uri(uri)[0].lower().endswith(SUFFIXES)


def split_uri(uri: str) -> tuple[str, str]:
    """Split a URI into the path of a COLLADA file and the id after ``#``, which may be empty."""
    path, _, name = uri.rpartition("#")
    return (path, name) if path.lower().endswith(SUFFIXES) else (uri, "")


def read_text(data: bytes, name: str, access: FileAccess, scale: float = 1.0) -> "Content":
    """Read a document from memory, like ``read_file``.

    Args:
        data: The document; files that it names are searched in the working folder.
        name: Its name in messages.
        access: As for ``read_file``.
        scale: Factor of all lengths.
    """
    from ravemj.formats.collada.library import Library  # noqa: PLC0415 - lxml is slow to import

    library = Library(access, None, scale)
    return _read(library, name, lambda: library.open_text(data, name))


def _read(library: "Library", path: str, opened: "Callable[[], ColladaDocument]", wanted: str = "") -> "Content":
    from ravemj.formats.collada.scenes import read_document  # noqa: PLC0415 - lxml is slow to import

    try:
        with np.errstate(all="ignore"):  # what is not finite in the end is refused
            return read_document(library, opened(), wanted)
    except (RecursionError, MemoryError, OverflowError) as error:
        message = f"the file is too large or nested too deep ({error or type(error).__name__})"
        raise SourceError(message, Source(path)) from error
    except ArithmeticError as error:
        raise SourceError("a number in the file is too large or too small to compute with", Source(path)) from error
