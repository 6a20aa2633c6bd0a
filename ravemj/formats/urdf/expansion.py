"""Program that expands a xacro; ``xacro.expand`` runs it in a separate process.

It reads a request from standard input and writes the text and the names of included files to standard output.
"""

import contextlib
import importlib
import json
import os
import sys
from typing import Any


def _main() -> None:
    request = json.load(sys.stdin)
    sys.path[:] = [*request["modules"], *sys.path]
    from ravemj.formats.file_access import FileAccess  # noqa: PLC0415 - the path is known only now
    from ravemj.formats.urdf.packages import Packages, given_packages  # noqa: PLC0415

    path, given = request["path"], request["given"]
    packages = Packages(path, FileAccess.opened(path), given_packages(given.get("packages", "")))
    arguments = dict(word.split(":=", 1) for word in given.get("args", "").split())

    def folder_of(package: str) -> str:
        roots = packages.roots(package)
        if not roots:
            raise LookupError(f"there is no package '{package}'; --package {package}=FOLDER says where it is")
        return roots[0]

    with contextlib.redirect_stdout(sys.stderr):
        xacrodoc: Any = importlib.import_module("xacrodoc")
        substitution: Any = importlib.import_module("xacro.substitution_args")
        substitution._eval_find = folder_of
        try:
            document = xacrodoc.XacroDoc.from_file(path, subargs=arguments, walk_up=False, resolve_packages=False)
        except Exception as error:  # whatever an expression raises
            sys.exit(f"{type(error).__name__}: {' '.join(str(error).split())}")
    text = document.dom.toprettyxml(indent=" ")
    if len(text) > request["most"]:
        sys.exit("the expanded text is too large")
    included = getattr(importlib.import_module("xacro"), "all_includes", [])
    files = [os.path.abspath(file) for file in included]
    json.dump({"text": text, "files": files}, sys.stdout)


if __name__ == "__main__":
    _main()
