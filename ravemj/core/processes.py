"""Worker processes on this machine, which can die or be killed without effect on each other."""

import contextlib
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context, parent_process
from types import ModuleType
from typing import Any, TypeVar

from ravemj.errors import RavemjError, RavemjWarning

_Part = TypeVar("_Part")
_Result = TypeVar("_Result")

_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def _begin() -> None:
    """Initialize a worker: it ignores Ctrl-C, which the driver handles, and warnings, which the driver has shown."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore", RavemjWarning)
    threading.Thread(target=_end_with_driver, daemon=True).start()


def _end_with_driver() -> None:
    driver = parent_process()
    if driver is not None:
        driver.join()
        os._exit(1)


class _Worker:
    """A process in its own pool; it runs the main module of the script only if ``needs_main``."""

    def __init__(self, needs_main: bool) -> None:
        self.needs_main = needs_main
        with contextlib.nullcontext() if needs_main else _other_main():
            self.pool = ProcessPoolExecutor(1, mp_context=get_context("spawn"), initializer=_begin)
            self.process = self.pool.submit(os.getpid)

    def kill(self) -> None:
        has_begun = self.process.done() and not self.process.cancelled()
        with contextlib.suppress(ProcessLookupError, BrokenProcessPool):
            if has_begun:
                os.kill(self.process.result(), signal.SIGKILL if os.name == "posix" else signal.SIGTERM)
        # Without waiting for the pool's thread, Python's end could meet it while it closes its pipe.
        self.pool.shutdown(wait=has_begun, cancel_futures=True)


class Workers(Executor):
    """Executor with processes that are restarted when they die; it accepts one call per process at a time.

    Args:
        count: Number of processes.
        needs_main: Whether calls use functions or classes of the script, which each process imports then.
    """

    def __init__(self, count: int, *, needs_main: bool = True) -> None:
        with _one_thread():
            self._idle = [_Worker(needs_main) for _ in range(count)]
            self._busy: dict[Future[Any], _Worker] = {}
            try:
                for worker in self._idle:
                    worker.process.result()
            except BrokenProcessPool:
                hint = "in a script, calls of sweep belong under: if __name__ == '__main__':"
                raise RavemjError(f"a worker process ended before it had begun; {hint}") from None

    def submit(self, fn: Callable[..., _Result], /, *args: Any, **kwargs: Any) -> Future[_Result]:  # noqa: ANN401 - as the base class
        """Call a function in an idle process."""
        worker = self._idle.pop()
        try:
            future = worker.pool.submit(fn, *args, **kwargs)
        except BrokenProcessPool:  # it died while idle
            worker = _restarted(worker)
            future = worker.pool.submit(fn, *args, **kwargs)
        self._busy[future] = worker
        return future

    def release(self, future: Future[Any]) -> None:
        """Release the process of a finished call; a dead process is replaced."""
        worker = self._busy.pop(future)
        if future.cancelled() or isinstance(future.exception(), BrokenProcessPool):
            worker = _restarted(worker)
        self._idle.append(worker)

    def has_begun(self, future: Future[Any]) -> bool:
        """Return whether the process of a call has started, or died."""
        return self._busy[future].process.done()

    def kill(self, future: Future[Any]) -> None:
        """Kill the process of a call."""
        self._busy[future].kill()

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Kill all processes immediately, which is safe since their files are written atomically."""
        del wait, cancel_futures
        for worker in [*self._idle, *self._busy.values()]:
            worker.kill()


def _restarted(worker: _Worker) -> _Worker:
    worker.pool.shutdown(wait=False)
    with _one_thread():
        return _Worker(worker.needs_main)


@contextlib.contextmanager
def _other_main() -> Generator[None]:
    """Prevent processes that start within the block from importing the main module.

    Importing it would repeat what a script does without ``if __name__ == "__main__":``, and fails for Python 2.
    """
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


@contextlib.contextmanager
def _one_thread() -> Generator[None]:
    """Limit processes started within the block to one thread for linear algebra."""
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def map_parts(
    function: Callable[[bytes, _Part], _Result], content: bytes, parts: Sequence[_Part], count: int
) -> Generator[_Result]:
    """Call a function for each part of a computation in several processes; yield the results in the order of the parts.

    Ctrl-C, or closing the generator, kills the processes.

    Args:
        function: A function of a module, called with ``content`` and a part.
        content: Pickled data that all parts need.
        parts: The arguments of the calls.
        count: Number of processes.

    Raises:
        RavemjError: a process died.
    """
    results, running, following = dict[int, _Result](), dict[Future[_Result], int](), 0
    missing = iter(enumerate(parts))
    with Workers(min(count, len(parts)), needs_main=b"__main__" in content) as pool:
        while following < len(parts):
            while len(running) < min(count, len(parts)) and (task := next(missing, None)) is not None:
                running[pool.submit(function, content, task[1])] = task[0]
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                pool.release(future)
                try:
                    results[running.pop(future)] = future.result()
                except BrokenProcessPool:
                    raise RavemjError(
                        "a worker process died, perhaps for lack of memory; use fewer processes"
                    ) from None
            while following in results:
                yield results.pop(following)
                following += 1


def blocks_of(start: int, stop: int, size: int) -> list[tuple[int, int]]:
    """Split a range into blocks of ``size``; return the first index of each, and the one after its last."""
    return [(first, min(first + size, stop)) for first in range(start, stop, size)]
