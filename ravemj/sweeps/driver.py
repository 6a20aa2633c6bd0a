"""The loop that submits shards to an executor and collects their results."""

import contextlib
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from pathlib import Path
from typing import Any, TypeVar

from ravemj.core.processes import Workers
from ravemj.errors import RavemjError
from ravemj.sweeps.folder import Failure, forget_failure, note_failure
from ravemj.sweeps.shards import shard_path
from ravemj.sweeps.worker import ShardOutcome, ShardTask, ravemj_shard

Progress = Callable[[int, int, int], object]
"""Callback with the numbers of finished, of all and of failed shards."""

Told = Callable[[ShardOutcome], object]

_Result = TypeVar("_Result")

_MOST_OUTPUT_ERRORS = 3
"""Number of consecutive output errors after which a sweep ends."""

_PATIENCE = 0.5  # s, between checks of the time limit


class SweepError(RavemjError):
    """A sweep is incomplete; repeating the call computes the missing shards.

    Attributes:
        failures: The shards that failed.
    """

    def __init__(self, message: str, failures: Sequence[Failure] = ()) -> None:
        super().__init__(message)
        self.failures = tuple(failures)

    def __str__(self) -> str:
        return self.message


class Here(Executor):
    """Executor that calls functions immediately, in this process."""

    def submit(self, fn: Callable[..., _Result], /, *args: Any, **kwargs: Any) -> Future[_Result]:  # noqa: ANN401 - as the base class
        """Call a function, and return a completed future."""
        future: Future[_Result] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


class Driver:
    """Computes the shards of a sweep.

    Args:
        executor: Executor of the shards.
        folder: The folder of the sweep.
        retries: Number of retries of a shard whose process died.
        timeout: Time limit of a shard [s]; for a user's executor, the maximum time without a finished shard. None: no
            limit.
        progress: Called after each shard.
        told: Called with the outcome of each shard.
    """

    def __init__(
        self,
        executor: Executor,
        folder: Path,
        retries: int,
        timeout: float | None,
        progress: Progress | None,
        told: Told | None,
    ) -> None:
        self._executor, self._folder = executor, folder
        self._retries, self._timeout = retries, timeout
        self._progress, self._told = progress, told
        self._running: dict[Future[ShardOutcome], tuple[ShardTask, float]] = {}
        self._losses: dict[int, int] = {}
        self._overdue: set[int] = set()
        self._failures: list[Failure] = []
        self._output_errors = 0
        self._done = self._total = 0

    def run(self, tasks: Iterator[ShardTask], count: int, total: int, most: int) -> None:
        """Compute shards.

        Args:
            tasks: The missing shards.
            count: The number of missing shards.
            total: The number of all shards.
            most: Maximum number of submitted shards at a time.

        Raises:
            SweepError: shards failed, the executor broke, or files cannot be written.
        """
        self._done, self._total = total - count, total
        again: deque[ShardTask] = deque()
        try:
            while True:
                while len(self._running) < most:
                    task = again.popleft() if again else next(tasks, None)
                    if task is None:
                        break
                    self._submit(task)
                if not self._running:
                    break
                again.extend(self._finished())
        finally:
            for future in self._running:
                future.cancel()
        if self._failures:
            first = self._failures[0]
            count = len(self._failures)
            shards = f"{count} of {total} shards" if count > 1 else f"shard {first.start}-{first.stop}"
            raise SweepError(f"{shards} failed; the first error: {first.error}", self._failures)

    def _submit(self, task: ShardTask) -> None:
        if shard_path(self._folder, task.job.what, task.start, task.stop).exists():  # another driver was faster
            self._finish(ShardOutcome(task.start, task.stop, 0.0))
            return
        try:
            future = self._executor.submit(ravemj_shard, task)
        except Exception as error:  # of whatever kind executors have
            self._collect()
            raise self._broken(error) from error
        self._running[future] = task, time.monotonic()

    def _finished(self) -> list[ShardTask]:
        """Wait until shards end; return the shards to be computed again."""
        wait([*self._running], timeout=_PATIENCE, return_when=FIRST_COMPLETED)
        if any(future.done() for future in self._running):
            return self._collect()
        self._look_at_clock()
        return []

    def _collect(self) -> list[ShardTask]:
        """Collect the outcomes of shards that ended; return the shards to be computed again."""
        again: list[ShardTask] = []
        for future in [future for future in self._running if future.done()]:
            task, _ = self._running.pop(future)
            if isinstance(self._executor, Workers):
                self._executor.release(future)
            try:
                outcome = future.result()
            except Exception as error:
                again += self._lost(task, error)
            else:
                self._finish(outcome)
        now = time.monotonic()
        if not isinstance(self._executor, Workers):
            self._running = {future: (task, now) for future, (task, _) in self._running.items()}
        return again

    def _finish(self, outcome: ShardOutcome) -> None:
        if outcome.error:
            self._fail(Failure(outcome.start, outcome.stop, outcome.error, outcome.details))
        else:
            self._done += 1
            with contextlib.suppress(OSError):
                forget_failure(self._folder, outcome.start, outcome.stop)
        if self._told is not None:
            self._told(outcome)
        if self._progress is not None:
            self._progress(self._done, self._total, len(self._failures))
        self._output_errors = self._output_errors + 1 if outcome.is_output else 0
        if self._output_errors == _MOST_OUTPUT_ERRORS:
            message = f"stopped after {_MOST_OUTPUT_ERRORS} shards that could not be written: {outcome.error}"
            raise SweepError(message, self._failures)

    def _fail(self, failure: Failure) -> None:
        self._failures.append(failure)
        with contextlib.suppress(OSError):  # the disk may be full; the final error contains the failure
            note_failure(self._folder, failure)

    def _lost(self, task: ShardTask, error: Exception) -> list[ShardTask]:
        """Handle a shard that raised or whose process died; return the shards to be computed again."""
        if not isinstance(self._executor, Workers):
            if isinstance(error, BrokenExecutor):
                raise self._broken(error) from error
            self._finish(ShardOutcome(task.start, task.stop, 0.0, f"{type(error).__name__}: {error}"))
            return []
        times = self._losses[task.start] = self._losses.get(task.start, 0) + 1
        if task.start in self._overdue:
            message = f"TimeoutError: it took longer than {self._timeout:g} s"
        elif times <= self._retries:
            return [task]
        else:
            message = f"its process died, {times} times"
        self._finish(ShardOutcome(task.start, task.stop, 0.0, message))
        return []

    def _look_at_clock(self) -> None:
        """Stop shards that exceed the time limit."""
        if self._timeout is None:
            return
        now = time.monotonic()
        for future, (task, begin) in [*self._running.items()]:
            if isinstance(self._executor, Workers) and not self._executor.has_begun(future):
                self._running[future] = task, now
            elif now - begin > self._timeout:
                if not isinstance(self._executor, Workers):
                    raise self._broken(TimeoutError(f"no shard ended within {self._timeout:g} s"))
                self._overdue.add(task.start)
                self._executor.kill(future)

    def _broken(self, error: Exception) -> SweepError:
        missing = self._total - self._done
        hint = "run it again with a working executor"
        text = " ".join(f"{type(error).__name__}: {error}".split())
        return SweepError(f"{missing} of {self._total} shards are missing: {hint} ({text})", self._failures)
