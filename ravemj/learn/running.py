"""Runs checks in separate processes, several at once, with limits, and stores the verdicts."""

import dataclasses
import hashlib
import json
import os
import re
import secrets
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import IO

from ravemj.core.output import new_file
from ravemj.learn.child import Verdict
from ravemj.learn.course import Exercise

SECONDS = 10.0
"""Time limit of one check [s]."""

MOST_OUTPUT = 10_000
"""Maximum stored output of one check [bytes]."""

PROGRESS = ".ravemj-learn.json"
"""File of verdicts in a student's folder."""

_GRACE = 5.0


def run_check(exercise: Exercise, file: Path, seconds: float = SECONDS, seed: int | None = None) -> Verdict:
    """Check a student's file in a separate process, with new questions.

    Args:
        exercise: The exercise.
        file: The student's file.
        seconds: Time limit.
        seed: Seed of the questions; None: a random one.
    """
    seed = secrets.randbelow(1 << 31) if seed is None else seed
    with TemporaryDirectory(prefix="ravemj-learn-") as folder:
        result = Path(folder) / "verdict.json"
        words = [str(file.resolve()), str(exercise.check.resolve()), str(result), str(seed), str(seconds)]
        output = _Output([sys.executable, "-m", "ravemj.learn.child", *words], file.resolve().parent, seconds + _GRACE)
        try:
            verdict = Verdict(**json.loads(result.read_text(encoding="utf-8")))
        except (OSError, ValueError):
            return Verdict("error", output.reason(file.resolve(), seconds), output=output.printed, seed=seed)
        return dataclasses.replace(verdict, output=output.printed)


class _Output:
    """Runs a process to its end or to a time limit, and stores the beginning of its output."""

    def __init__(self, words: list[str], folder: Path, seconds: float) -> None:
        variables = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONUNBUFFERED": "1"}
        variables["PYTHONIOENCODING"] = "utf-8"  # in place of the code page of Windows
        variables["PYTHONPATH"] = os.pathsep.join(
            [str(Path(__file__).parents[2]), *filter(None, [os.environ.get("PYTHONPATH")])]
        )
        self._process = subprocess.Popen(
            words,
            cwd=folder,
            env=variables,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        readers = [_Reader(stream) for stream in (self._process.stdout, self._process.stderr) if stream is not None]
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            pass
        finally:
            self._kill()
        self.printed, self.errors = (reader.text() for reader in readers)

    def _kill(self) -> None:
        """Kill the process and its children."""
        if hasattr(os, "killpg"):
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGKILL)
        self._process.kill()
        self._process.wait()

    def reason(self, file: Path, seconds: float) -> str:
        """Return the reason why the process gave no verdict."""
        if "Timeout (" in self.errors:
            name = str(file).encode("ascii", "backslashreplace").decode()  # as faulthandler writes it
            last_place = re.search(rf'File "{re.escape(name)}", line (\d+)', self.errors)
            where = f": it was in line {last_place[1]}" if last_place else ""
            return f"no end after {seconds:g} s{where}; is there a loop that never ends?"
        if "MemoryError" in self.errors:
            return "out of memory"
        return "the code ended its process without an answer (os._exit, a crash, or out of memory)"


class _Reader:
    """Reads a stream to its end in a thread, and stores its beginning."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._kept = b""
        self._thread = threading.Thread(target=self._read, args=(stream,), daemon=True)
        self._thread.start()

    def _read(self, stream: IO[bytes]) -> None:
        with stream:
            while part := os.read(stream.fileno(), 1 << 16):
                self._kept += part[: MOST_OUTPUT - len(self._kept)]

    def text(self) -> str:
        """Return the beginning of the stream, marked as cut if it was longer."""
        self._thread.join(_GRACE)
        cut = "… (cut)" if len(self._kept) >= MOST_OUTPUT else ""
        return self._kept.decode(errors="replace") + cut


class Progress:
    """The verdicts on the exercises in a student's folder; verdicts on unchanged files are cached there."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._file = folder / PROGRESS
        try:
            self._known: dict[str, tuple[str, Verdict]] = {
                name: (key, Verdict(**verdict))
                for name, (key, verdict) in json.loads(self._file.read_text(encoding="utf-8")).items()
            }
        except (OSError, ValueError, TypeError, AttributeError):  # none yet, or damaged
            self._known = {}

    def file(self, exercise: Exercise) -> Path:
        """Return the student's file of an exercise."""
        return self.folder / exercise.original.name

    def known(self, exercise: Exercise) -> Verdict | None:
        """Return the last verdict on a file if the file and its check have not changed since."""
        known = self._known.get(exercise.name)
        return known[1] if known is not None and known[0] == self._key(exercise) else None

    def check(self, exercise: Exercise) -> Verdict:
        """Check the file of an exercise, and store the verdict."""
        gone = Verdict("error", "there is no such file any more")
        return dict(self.check_all([exercise], fresh=True)).get(exercise, gone)

    def check_all(self, exercises: Iterable[Exercise], *, fresh: bool = False) -> Iterator[tuple[Exercise, Verdict]]:
        """Yield the verdicts on existing files in the order of completion, and store them.

        Args:
            exercises: The exercises.
            fresh: Whether to check unchanged files again.
        """
        present = [exercise for exercise in exercises if self.file(exercise).exists()]
        known = {exercise: verdict for exercise in present if not fresh and (verdict := self.known(exercise))}
        yield from known.items()

        def work(exercise: Exercise) -> tuple[Exercise, str, Verdict]:
            return exercise, self._key(exercise), run_check(exercise, self.file(exercise))

        try:
            for exercise, key, verdict in _side_by_side(
                work, [unchecked for unchecked in present if unchecked not in known]
            ):
                self._known[exercise.name] = key, verdict
                yield exercise, verdict
        finally:
            if present:
                self._save()

    def _key(self, exercise: Exercise) -> str:
        digest = hashlib.sha256()
        for file in (self.file(exercise), exercise.check):
            with suppress(OSError):
                digest.update(file.read_bytes())
        return digest.hexdigest()

    def _save(self) -> None:
        content = {name: (key, dataclasses.asdict(verdict)) for name, (key, verdict) in self._known.items()}
        with new_file(self._file) as path:
            path.write_text(json.dumps(content, indent=1), encoding="utf-8")


def _side_by_side(
    work: Callable[[Exercise], tuple[Exercise, str, Verdict]], exercises: list[Exercise]
) -> Iterator[tuple[Exercise, str, Verdict]]:
    """Call ``work`` for all exercises in parallel; yield the results as they come. An interrupt cancels the rest."""
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        waiting = {pool.submit(work, exercise) for exercise in exercises}
        while waiting:
            done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            for future in done:
                yield future.result()
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
