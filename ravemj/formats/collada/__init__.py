"""COLLADA 1.5: files with kinematics, ``.dae`` and ``.zae``, become bodies.

A document names one scene of nodes that are seen, one of kinematics, and one of physics, and binds them to each other.
``scenes`` walks over it and fills a ``BodyBuilder`` for each robot; the other modules each read one kind of element.
References may lead to other files. Broken references are reported and left out, as in OpenRAVE.
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
        uri: Where it lies; behind ``#``, the id of the only articulated system or model that is wanted.
        access: The files that may be read; takes every finding.
        included_from: The element that names the file, or None.
        scale: What all lengths are multiplied by.
        documents: The COLLADA documents of the model that names the file; None if the file is all of it.

    Raises:
        SourceError: The file is broken, or something in it is impossible.
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
    """Read a document that is no file, as ``read_file`` reads a file.

    Args:
        data: The document; files that it names are looked for in the working folder.
        name: What to call it in messages.
        access: As for ``read_file``.
        scale: What all lengths are multiplied by.
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
