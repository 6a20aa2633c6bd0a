"""The folder of a sweep: a manifest of all inputs of the results, shard files, and failure files."""

import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ravemj.core.output import new_file
from ravemj.errors import ArgumentError, OutputError
from ravemj.sweeps.shards import FAILED, SHARDS, joined, read_shard, shard_path, span_name

MANIFEST = "manifest.json"
FORMAT = 1

_OURS = {MANIFEST, SHARDS, FAILED}

_DIGESTS = {"scene": "the model or its state", "function": "the text of the function", "items": "the array of items"}
"""Descriptions of the digests in the manifest, for messages."""


class Failure(NamedTuple):
    """A shard that could not be computed.

    Attributes:
        start: The first item.
        stop: One past the last item.
        error: The error in one line.
        details: Traceback, host and process.
    """

    start: int
    stop: int
    error: str
    details: str


class Sweep:
    """The results of ``ravemj.sweep``, complete or not; iteration yields the arrays of each shard.

    Attributes:
        folder: The folder.
        manifest: All inputs of the results, as JSON data.

    Example:
        >>> sweep = ravemj.Sweep.open("labels")
        >>> sweep.arrays("collides").mean()
    """

    def __init__(self, folder: Path, manifest: Mapping[str, Any]) -> None:
        self.folder, self.manifest = folder, manifest

    @classmethod
    def open(cls, folder: str | os.PathLike[str]) -> Self:
        """Return the sweep in a folder, which may still be in progress.

        Raises:
            ArgumentError: the folder has no manifest, or a manifest of another format.
        """
        manifest = read_manifest(Path(folder))
        if manifest is None:
            raise ArgumentError(f"Sweep.open: there is no {MANIFEST} in {os.fspath(folder)}; ravemj.sweep writes it")
        return cls(Path(folder), manifest)

    @property
    def total(self) -> int:
        """The number of items."""
        return self.manifest["total"]

    @property
    def spans(self) -> list[tuple[int, int]]:
        """First item and one past the last item of each shard."""
        shard = self.manifest["shard"]
        return [(start, min(start + shard, self.total)) for start in range(0, self.total, shard)]

    @property
    def files(self) -> list[Path]:
        """The files of the finished shards, in order."""
        present = set(os.listdir(self.folder / SHARDS))
        paths = [shard_path(self.folder, self.manifest["what"], *span) for span in self.spans]
        return [path for path in paths if path.name in present]

    @property
    def done(self) -> int:
        """The number of finished items."""
        names = {path.stem for path in self.files}
        return sum(stop - start for start, stop in self.spans if span_name(start, stop) in names)

    @property
    def failed(self) -> list[Failure]:
        """The shards whose last computation failed."""
        paths = sorted((self.folder / FAILED).glob("*.json"))
        return [Failure(**json.loads(path.read_text(encoding="utf-8"))) for path in paths]

    def arrays(self, name: str | None = None, partial: bool = False) -> Any:  # noqa: ANN401 - one array, or all by name
        """Return the concatenated arrays of all shards; shorter rows are padded with NaN, 0 or False.

        Args:
            name: The name of an array; None: all arrays, by name.
            partial: Whether shards may be missing; their items are omitted.

        Raises:
            ArgumentError: shards are missing, or no array has this name.
        """
        if self.done < self.total and not partial:
            hint = "run the sweep again, or pass partial=True"
            raise ArgumentError(f"arrays: {self.done} of {self.total} items are done; {hint}")
        parts = list(self)
        if name is None:
            return joined(parts)
        if parts and name not in parts[0]:
            raise ArgumentError(f"arrays: name is {name!r}; expected one of {', '.join(parts[0])}")
        return joined([{name: part[name]} for part in parts]).get(name, np.zeros(0))

    def __iter__(self) -> Iterator[dict[str, NDArray[Any]]]:
        """Yield the arrays of each finished shard, in order."""
        return map(read_shard, self.files)

    def __repr__(self) -> str:
        failed = f", {len(self.failed)} shards failed" if self.failed else ""
        what = self.manifest["what"]
        return f"<Sweep '{what}' in {self.folder}: {self.done} of {self.total} items{failed}>"


def read_manifest(folder: Path) -> dict[str, Any] | None:
    """Return the manifest of a folder, or None if it has none.

    Raises:
        ArgumentError: it cannot be read.
    """
    path = folder / MANIFEST
    try:
        manifest: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        known = manifest["format"]
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ArgumentError(f"{path} is damaged ({type(error).__name__}); choose another folder") from error
    if known != FORMAT:
        raise ArgumentError(f"{path} has format {known}, and this version of ravemj reads {FORMAT}")
    return manifest


def prepare(folder: Path, manifest: Mapping[str, Any]) -> None:
    """Create the folder of a sweep with a manifest; if the folder exists, check that it has the same manifest.

    Raises:
        ArgumentError: it belongs to another sweep; the message names the difference.
        OutputError: it cannot be written, or contains other files.
    """
    before = read_manifest(folder)
    if before is not None:
        for key, value in manifest.items():
            if before.get(key) != value:
                difference = f"{key} is {value!r}, and {before.get(key)!r}"
                if key in _DIGESTS:
                    difference = f"{_DIGESTS[key]} differs from that"
                raise ArgumentError(f"sweep: {difference} in {folder / MANIFEST}; choose another folder")
    elif folder.is_dir() and any(name not in _OURS and not name.startswith(".ravemj-") for name in os.listdir(folder)):
        raise OutputError(f"cannot write {folder}: it holds something else than a sweep")
    try:
        for part in (SHARDS, FAILED):
            (folder / part).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"cannot write {folder}: {(error.strerror or str(error)).lower()}") from error
    with new_file(folder / MANIFEST) as temporary:
        temporary.write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")


def note_failure(folder: Path, failure: Failure) -> None:
    """Record that a shard failed."""
    with new_file(_failure_path(folder, failure.start, failure.stop)) as temporary:
        temporary.write_text(json.dumps(failure._asdict(), indent=1) + "\n", encoding="utf-8")


def forget_failure(folder: Path, start: int, stop: int) -> None:
    """Remove the record that a shard failed."""
    _failure_path(folder, start, stop).unlink(missing_ok=True)


def _failure_path(folder: Path, start: int, stop: int) -> Path:
    return folder / FAILED / f"{span_name(start, stop)}.json"
