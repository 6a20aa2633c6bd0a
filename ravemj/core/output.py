"""Atomic writing of files and folders.

They are written under a temporary name beside the target and renamed at the end. If writing fails, nothing is left
behind, and an existing target is unchanged. If a process is killed, the next process that writes into the folder
removes its temporary files.
"""

import os
import platform
import shutil
import tempfile
from collections.abc import Collection, Generator, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from ravemj.core.forks import in_this_process
from ravemj.core.signals import on_signal, signals_delayed
from ravemj.errors import OutputError

AnyPath = str | os.PathLike[str]


def check_file(path: AnyPath) -> None:
    """Check that a file can be written, without touching anything.

    Raises:
        OutputError: The folder around it is missing or cannot be written, or something other than a file is there.
    """
    with _output_errors(path):
        target = _real(path)
        _check_permissions(path, target)
        if target.exists() and not target.is_file():
            raise OutputError(f"cannot write {os.fspath(path)}: it exists and is not a file")


def check_folder(path: AnyPath, *patterns: str) -> None:
    """Check that a folder of files can be written, without touching anything.

    An existing folder may only contain files that match ``patterns``, such as ``frame_*.png``.

    Raises:
        OutputError: The folder around it is missing or cannot be written, or something else is there.
    """
    with _output_errors(path):
        target = _real(path)
        if target == Path.cwd() or target.is_mount():
            raise OutputError(f"cannot write {os.fspath(path)}: it is the current folder or a mounted disk")
        _check_permissions(path, target)
        if not target.exists():
            return
        if not target.is_dir():
            raise OutputError(f"cannot write {os.fspath(path)}: it exists and is not a folder")
        foreign = next(_foreign_entries(target, patterns), None)
        if foreign is not None:
            ours = " and ".join(patterns)
            raise OutputError(f"cannot replace {os.fspath(path)}: it contains {foreign}, not only {ours}")


@contextmanager
def new_file(path: AnyPath) -> Generator[Path]:
    """Context manager that yields a temporary path for writing a file, and renames the file at the end.

    Raises:
        OutputError: ``check_file`` fails, or the temporary file cannot be created or renamed.
    """
    check_file(path)
    with _temporary(path) as temporary:
        with _output_errors(path):
            temporary.touch(exist_ok=False)
        with _output_errors(path, (OSError,)):
            yield temporary
        with _output_errors(path):
            os.replace(temporary, _real(path))


@contextmanager
def new_folder(path: AnyPath, *patterns: str) -> Generator[Path]:
    """Context manager that yields a temporary folder for writing files, and renames the folder at the end.

    Raises:
        OutputError: ``check_folder`` fails, or the temporary folder cannot be created or renamed.
    """
    check_folder(path, *patterns)
    with _temporary(path) as temporary:
        with _output_errors(path):
            temporary.mkdir()
        with _output_errors(path, (OSError,)):
            yield temporary
        check_folder(path, *patterns)  # while the files were written, others may have come
        with _output_errors(path):
            _replace_folder(temporary, _real(path))


@contextmanager
def added_files(path: AnyPath) -> Generator[Path]:
    """Context manager that yields a temporary folder for writing files, and moves the files at the end.

    The end of the block moves all of them, or none; it creates the folder if necessary. Files of the same names are
    replaced.

    Raises:
        OutputError: The folder around it is missing or cannot be written, or something other than a folder is there.
    """
    target = _real(path)
    with _output_errors(path):
        _check_permissions(path, target)
        if target.exists() and not target.is_dir():
            raise OutputError(f"cannot write {os.fspath(path)}: it exists and is not a folder")
    with _temporary(path) as temporary:
        with _output_errors(path):
            temporary.mkdir()
        with _output_errors(path, (OSError,)):
            yield temporary
        with _output_errors(path), signals_delayed():
            _move_all(temporary, target)


def _move_all(source: Path, target: Path) -> None:
    """Move the files of a folder into another one, all or none."""
    is_new = not target.exists()
    target.mkdir(exist_ok=True)
    made: list[Path] = []
    try:
        for file in sorted(source.iterdir()):
            place = target / file.name
            if not place.exists():
                made.append(place)
            os.replace(file, place)
    except BaseException:
        for place in made:
            place.unlink(missing_ok=True)
        if is_new:
            target.rmdir()
        raise


def output_error(path: AnyPath, error: Exception) -> OutputError:
    """Return the one-line error with the reason why a target cannot be written."""
    reason = (getattr(error, "strerror", None) or "").lower() or " ".join(str(error).split()) or type(error).__name__
    return OutputError(f"cannot write {os.fspath(path)}: {reason}")


@contextmanager
def _output_errors(path: AnyPath, kinds: tuple[type[Exception], ...] = (OSError, ValueError)) -> Generator[None]:
    """Convert errors in the block to ``OutputError``; by default also ``ValueError``, as for paths with null bytes."""
    try:
        yield
    except (OutputError, BrokenPipeError):  # a pipe is not the target
        raise
    except kinds as error:
        raise output_error(path, error) from error


def _real(path: AnyPath) -> Path:
    """Return the absolute path with symbolic links resolved, so that writing replaces their targets."""
    return Path(os.path.realpath(path))


def _foreign_entries(folder: Path, patterns: Collection[str]) -> Iterator[str]:
    """Yield the files and folders in a folder, recursively, whose relative path matches none of the patterns.

    A folder that contains the files of a pattern is not yielded.
    """
    folders = {pattern.rpartition("/")[0] for pattern in patterns}
    for entry in folder.rglob("*"):
        name = entry.relative_to(folder).as_posix()
        depth = name.count("/")
        if entry.is_dir() and not entry.is_symlink():
            is_ours = name in folders
        else:
            is_ours = entry.is_file() and any(depth == p.count("/") and entry.match(p) for p in patterns)
        if not is_ours:
            yield name


@contextmanager
def _temporary(path: AnyPath) -> Generator[Path]:
    """Yield a temporary path beside a target; a file or folder left there is removed at the end."""
    temporary = _real(path).with_name(f".ravemj-{_realm()}-{os.getpid()}-{os.urandom(4).hex()}.tmp")
    _remove_left_over(temporary.parent)
    remove = in_this_process(lambda: _remove(temporary))
    with on_signal(remove):
        try:
            yield temporary
        finally:
            remove()


@contextmanager
def temporary_folder() -> Generator[str]:
    """Yield a folder that this process alone removes at the end of the block."""
    folder = tempfile.mkdtemp(prefix="ravemj-")
    remove = in_this_process(lambda: shutil.rmtree(folder, ignore_errors=True))
    with on_signal(remove):
        try:
            yield folder
        finally:
            remove()


@cache
def _realm() -> str:
    """Return eight hexadecimal digits that identify the namespace of process ids: the machine and its container."""
    import hashlib  # noqa: PLC0415 - slow to import

    try:
        processes = os.readlink("/proc/self/ns/pid")
    except OSError:  # not Linux
        processes = ""
    return hashlib.sha256(f"{platform.node()} {processes}".encode(errors="replace")).hexdigest()[:8]


def _remove_left_over(folder: Path) -> None:
    """Remove temporary files and folders of the user's killed processes."""
    if os.name != "posix":  # there is no harmless way to ask for a process
        return
    for path in folder.glob(f".ravemj-{_realm()}-*"):
        process = path.name.split("-")[2]
        with suppress(OSError):  # another process was faster
            if path.lstat().st_uid == os.getuid() and process.isdecimal() and not _is_running(int(process)):
                _remove(path)


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)  # sends nothing
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):  # another user's, or nobody's
        return True
    return True


def _remove(path: Path) -> None:
    """Remove a file or a folder if it exists, even if another thread is writing into it."""
    with suppress(OSError):
        if path.is_dir() and not path.is_symlink():
            doomed = path.with_name(f"{path.name}-")  # where nothing new gets in
            os.replace(path, doomed)
            shutil.rmtree(doomed, ignore_errors=True)
        else:
            path.unlink()


def _check_permissions(path: AnyPath, target: Path) -> None:
    if not target.parent.is_dir():
        raise OutputError(f"cannot write {os.fspath(path)}: there is no folder {target.parent}")
    for place in (target.parent, target):
        if place.exists() and not os.access(place, os.W_OK):
            raise OutputError(f"cannot write {os.fspath(path)}: no permission to change {place}")


def _replace_folder(temporary: Path, target: Path) -> None:
    if not target.exists():
        os.replace(temporary, target)
        return
    with _temporary(target) as old, signals_delayed():
        os.replace(target, old)
        try:
            os.replace(temporary, target)
        except BaseException:
            os.replace(old, target)
            raise
