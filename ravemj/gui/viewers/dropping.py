"""Files dropped on a window or a page, which are added to the environment."""

import logging
import os
import shutil
import tempfile
import threading
import weakref
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from ravemj.core.forks import in_this_process
from ravemj.errors import Source, SourceError
from ravemj.gui.interaction import Notices
from ravemj.gui.viewers.host import Host

_LOG = logging.getLogger("ravemj")

_MODELS = {".xml", ".dae", ".zae", ".json", ".urdf", ".xacro"}
_MANIFEST = "package.xml"  # of a package of ROS: no model
_NAMED = 5
_SHOWN = 20.0
"""Display time of messages about files that cannot be added [s]."""


def add_files(
    env: Host | None,
    paths: Sequence[str],
    notices: Notices,
    at_end: Callable[[], object] = lambda: None,
) -> None:
    """Add files to an environment, in a new thread, since reading and waiting for the lock may take long.

    Args:
        env: The environment; None if it no longer exists.
        paths: Files, folders and zip archives. If there are models among them, meshes and pictures are treated as
            their parts and not added themselves.
        notices: Receives messages about added files and errors.
        at_end: Called at the end.
    """

    def add() -> None:
        if env is not None:
            _add(env, paths, notices)
        at_end()

    threading.Thread(target=add, name="ravemj drop", daemon=True).start()


def _add(env: Host, paths: Sequence[str], notices: Notices) -> None:
    with tempfile.TemporaryDirectory(prefix="ravemj-") as folder:
        try:
            paths = [_unpacked(path, os.path.join(folder, str(place))) for place, path in enumerate(paths)]
            models = [model for path in paths for model in _models(path)]
        except SourceError as error:
            notices.say(str(error), _SHOWN)
            return
        for path in models or paths:
            try:
                trouble = env.add_file(path, paths)
            except Exception as error:
                _LOG.exception("a file that was dropped cannot be added")
                trouble = f"{os.path.basename(path)}: {error}"
            if trouble:
                notices.say(trouble, _SHOWN)
            else:
                notices.say(f"Added {os.path.basename(path)}")


def _unpacked(path: str, folder: str) -> str:
    """Unpack a zip archive and return ``folder``; return any other path unchanged.

    Raises:
        SourceError: the archive is damaged or too large, or contains names outside of the folder.
    """
    if not path.lower().endswith(".zip"):
        return path
    from ravemj.formats.collada.archive import Archive  # noqa: PLC0415 - lxml is slow to import

    Archive(path).unpack(folder)
    return folder


def _models(path: str) -> list[str]:
    """Return the models in a path: the file itself, the only URDF of a folder, or the models directly in the folder.

    Raises:
        SourceError: a folder has several URDFs.
    """
    if not os.path.isdir(path):
        return [path] if Path(path).suffix.lower() in _MODELS else []
    robots = sorted(str(file) for file in Path(path).rglob("*.urdf"))
    if len(robots) > 1:
        names = ", ".join(os.path.basename(robot) for robot in robots[:_NAMED])
        raise SourceError(f"there are {len(robots)} robots in it: {names}", Source(path), "leave one of them there")
    files = sorted(str(file) for file in Path(path).iterdir() if file.name != _MANIFEST)
    return robots or [file for file in files if Path(file).suffix.lower() in _MODELS]


class Upload:
    """Files that a page uploads in chunks, in a temporary folder that is removed with this object."""

    _LARGEST = 64 * 2**20

    def __init__(self) -> None:
        self._folder = tempfile.mkdtemp(prefix="ravemj-")
        self._remove = weakref.finalize(self, in_this_process(partial(shutil.rmtree, self._folder, ignore_errors=True)))
        self._size = 0
        self.paths: list[str] = []

    def append(self, name: str, chunk: bytes) -> bool:
        """Append a chunk to a file; the name may include folders. Return False if the upload is too large."""
        self._size += len(chunk)
        if self._size > self._LARGEST:
            return False
        path = os.path.join(self._folder, *name.split("/"))
        top = os.path.join(self._folder, name.split("/", maxsplit=1)[0])
        if top not in self.paths:
            self.paths.append(top)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "ab") as file:
            file.write(chunk)
        return True

    def add_to(self, env: Host | None, notices: Notices) -> None:
        """Add the files to an environment, if it still exists, and then remove them."""

        def remove() -> None:
            self._remove()  # ``self`` is referenced until then; else its folder would be removed before it is read

        add_files(env, self.paths, notices, remove)
