"""Worker processes on this machine, which can die or be killed without effect on each other."""

import contextlib
import os
import signal
import threading
import warnings
from collections.abc import Callable, Generator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context, parent_process
from typing import Any, TypeVar

from ravemj.errors import RavemjError, RavemjWarning

_Result = TypeVar("_Result")

_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def _begin() -> None:
    """Initialize a worker: the driver handles Ctrl-C, and has already shown warnings."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore", RavemjWarning)
    threading.Thread(target=_end_with_driver, daemon=True).start()


def _end_with_driver() -> None:
    driver = parent_process()
    if driver is not None:
        driver.join()
        os._exit(1)


class _Worker:
    """A process in its own pool."""

    def __init__(self) -> None:
        self.pool = ProcessPoolExecutor(1, mp_context=get_context("spawn"), initializer=_begin)
        self.process = self.pool.submit(os.getpid)

    def kill(self) -> None:
        """Kill the process immediately."""
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
    """

    def __init__(self, count: int) -> None:
        with _one_thread():
            self._idle = [_Worker() for _ in range(count)]
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
        return _Worker()


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
