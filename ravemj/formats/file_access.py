"""Policy on which files a model may read; ``docs/files.md`` documents it for users.

Every reader checks it before opening a file that another file names, however the path is spelled.
"""

import os
from collections.abc import Iterable
from dataclasses import replace

from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.formats.data_folders import data_folders


class FileAccess:
    """File access while reading a model: permitted files, and files read so far.

    Attributes:
        diagnostics: Receives diagnostics of the reading.
        files: Paths of the files that were read, in order, each with the element that names it; None for the file
            that was loaded.
        is_dropped: Whether the model was dropped on a viewer; otherwise its user opened it.
    """

    def __init__(self, trees: Iterable[str], *, is_dropped: bool) -> None:
        self.diagnostics = Diagnostics()
        self.files: dict[str, Source | None] = {}
        self.is_dropped = is_dropped
        self._trees = [os.path.abspath(path) for path in trees]
        self._refused: set[tuple[str, Source]] = set()
        self._dropped = [os.path.realpath(path) for path in self._trees] if is_dropped else []

    @classmethod
    def opened(cls, path: str) -> "FileAccess":
        """Return the access for a model that its user opens.

        If the model is a text in memory, ``path`` is a name in the working folder.
        """
        return cls((os.path.dirname(path), *data_folders()), is_dropped=False)

    @classmethod
    def dropped(cls, path: str, others: Iterable[str] = ()) -> "FileAccess":
        """Return the access for a model that was dropped on a viewer, together with other files."""
        return cls((os.path.dirname(path), path, *others), is_dropped=True)

    def permits(self, path: str) -> bool:
        """Return whether a model or mesh file may be read."""
        if not self.is_dropped:
            return True
        try:
            real = os.path.realpath(path)
        except ValueError:  # no file system has such a name
            return False
        return any(is_inside(real, place) for place in self._dropped)

    def permits_part(self, path: str, folder: str, *, is_raw: bool = False) -> bool:
        """Return whether a file to which a mesh refers may be read.

        Args:
            path: Its absolute path.
            folder: The folder of the mesh file.
            is_raw: Whether the file has no format that could be checked, only raw numbers; it must be in ``folder``
                then.
        """
        places = (folder,) if is_raw else (folder, *self._trees)
        return any(is_inside(path, place) for place in places) and self.permits(path)

    def candidates(self, name: str, *folders: str) -> list[str]:
        """Return the paths at which to search a model or mesh file: in ``folders``, then in ``OPENRAVE_DATA``.

        The list is empty if the file must not be read.
        """
        paths = [os.path.join(folder, name) for folder in (*folders, *data_folders())]
        return [path for path in paths if self.permits(path)]

    def refuse(self, name: str, source: Source, *, is_raw: bool = False) -> SourceError:
        """Report a file that must not be read, and return the report as an error.

        Args:
            name: The file, as written.
            source: The position of its name.
            is_raw: As for ``permits_part``.
        """
        if self.is_dropped:
            reason = "outside of what was dropped"
            hint = "put all files into one folder and drop them together, or open the model with ravemj view or Load"
        elif is_raw:
            reason, hint = "raw data outside of the folder of the mesh", "copy it into that folder"
        else:
            reason, hint = "outside of the folder of the model", "copy it into that folder, or beside the mesh"
        message = f"{name!r} is not read: it is {reason}"
        if (name, source) not in self._refused:
            self._refused.add((name, source))
            report = self.diagnostics.error if is_raw or self.is_dropped else self.diagnostics.warn
            report("refused-file", message, source, hint)
        return SourceError(message, source, hint)

    def report_missing(self, name: str, source: Source) -> None:
        """Report a file that is not among the dropped ones; arguments as for ``refuse``."""
        message = f"there is no file {name!r} with what was dropped"
        self.diagnostics.error("missing-file", message, source, "drop it together with the model")

    def named_diagnostics(self) -> Diagnostics:
        """Return the diagnostics with the names of dropped files in place of their paths."""
        named = Diagnostics()
        for finding in self.diagnostics:
            source = self._named_source(finding.source)
            named.add(replace(finding, message=self.named(finding.message), source=source))
        return named

    def _named_source(self, source: Source) -> Source:
        outer = source.included_from
        included_from = None if outer is None else self._named_source(outer)
        return source._replace(file=self.named(source.file), included_from=included_from)

    def named(self, text: str) -> str:
        """Return a text with the names of dropped files in place of their paths."""
        folder = os.path.join(self._trees[0], "")
        return text.replace(folder, "") if self.is_dropped and folder != os.path.dirname(folder) else text


def is_inside(path: str, place: str) -> bool:
    """Return whether an absolute path is ``place`` or below it; symbolic links are not resolved."""
    path, place = os.path.normcase(path), os.path.normcase(place)
    return path == place or path.startswith(os.path.join(place, ""))
