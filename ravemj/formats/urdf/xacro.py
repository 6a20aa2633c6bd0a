"""Expansion of xacro files to URDF.

xacro evaluates Python expressions, so it is restricted to files that the user opens, in a separate process, for a
limited time.
"""

import importlib.util
import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping

from ravemj.errors import Source, SourceError
from ravemj.formats.file_access import FileAccess
from ravemj.formats.limits import check_bytes, most_bytes

SUFFIX = ".xacro"

LIMIT = 10.0
"""Time limit of an expansion [s]."""

_LONGEST = 300  # characters of an error that another program prints
_COMMENT = re.compile(b"<!--.*?-->", re.DOTALL)  # expanded files keep what their xacro had as comments
_HEAD = 20_000  # bytes in which the first element of xacro stands


def is_xacro(path: str, content: bytes) -> bool:
    """Return whether a file is a xacro: by its suffix, or because it contains xacro elements."""
    if path.lower().endswith(SUFFIX):
        return True
    return b"<xacro:" in content and b"<robot" in content[:_HEAD] and b"<xacro:" in _COMMENT.sub(b"", content)


def expand(path: str, given: Mapping[str, str], access: FileAccess) -> bytes:
    """Expand a xacro file to URDF, and record the files that it includes.

    Args:
        path: The file.
        given: Attributes passed by the caller: ``args`` and ``packages``, see ``ravemj.formats.urdf.GIVEN``.
        access: The files that may be read; records those that were read.

    Raises:
        SourceError: it was dropped on a viewer, the extra ``xacro`` is missing, the expansion fails, or it takes too
            long.
    """
    source = Source(path)
    if access.is_dropped:
        hint = f"open it with ravemj view, or drop the URDF that xacro {os.path.basename(path)} prints"
        raise SourceError("a xacro that was dropped is not expanded, since that runs Python", source, hint)
    if importlib.util.find_spec("xacrodoc") is None:
        hint = 'pip install "ravemj[xacro]", or write the URDF with the program xacro of ROS'
        raise SourceError("this is a xacro, which has to be expanded to a URDF", source, hint)
    place = os.path.abspath(path)
    request = {"path": place, "given": dict(given), "most": most_bytes(), "modules": sys.path[1:]}
    command = [sys.executable, "-P", os.path.join(os.path.dirname(__file__), "expansion.py")]
    asked, folder = json.dumps(request).encode(), os.path.dirname(place)
    try:
        done = subprocess.run(command, input=asked, capture_output=True, timeout=LIMIT, cwd=folder, check=False)
    except subprocess.TimeoutExpired:
        raise SourceError(f"the xacro is not expanded after {LIMIT:g} s", source) from None
    if done.returncode:
        lines = done.stderr.decode(errors="replace").strip().splitlines() or ["no reason given"]
        raise SourceError(f"the xacro cannot be expanded: {lines[-1][:_LONGEST]}", source, "--arg NAME:=VALUE sets one")
    check_bytes(len(done.stdout), "the expanded file has", source)
    answer = json.loads(done.stdout)
    for file in answer["files"]:
        access.files.setdefault(file, source)
    return answer["text"].encode()
