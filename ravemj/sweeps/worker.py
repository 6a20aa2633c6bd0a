"""The computation of a shard, in any process."""

import hashlib
import os
import pickle
import platform
import threading
import time
import traceback
from collections import OrderedDict
from collections.abc import Generator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from ravemj.core.threads import batch_threads, set_batch_threads
from ravemj.errors import ArgumentError
from ravemj.rave import Environment, RaveGetEnvironments
from ravemj.sweeps.jobs import JOBS, Job, Work, joint_values
from ravemj.sweeps.shards import Arrays, joined, shard_path, write_shard

_MOST_ENVIRONMENTS = 4
_environments: OrderedDict[str, Environment] = OrderedDict()
_lock = threading.Lock()


class ShardTask(NamedTuple):
    """A shard to compute.

    Attributes:
        content: The pickled environment.
        job: The job.
        seed: The seed of the sweep.
        block: Number of items that share a random generator.
        start: The first item.
        stop: One past the last item.
        items: The items from ``start`` to ``stop``; None means random items.
        folder: The folder of the sweep.
        threads: Number of threads; 0 for the setting of the process.
    """

    content: bytes
    job: Job
    seed: int
    block: int
    start: int
    stop: int
    items: NDArray[Any] | None
    folder: str
    threads: int


class ShardOutcome(NamedTuple):
    """The result of a shard.

    Attributes:
        start: The first item.
        stop: One past the last item.
        seconds: Duration [s].
        error: The error in one line; empty if the shard is written.
        details: Traceback, host and process.
        is_output: Whether the file could not be written.
    """

    start: int
    stop: int
    seconds: float
    error: str = ""
    details: str = ""
    is_output: bool = False


def ravemj_shard(task: ShardTask) -> ShardOutcome:
    """Compute a shard and write its file. Errors are returned in the result, so that every executor transmits them."""
    begin = time.perf_counter()
    span = task.start, task.stop
    try:
        arrays = compute(task, task.start, task.stop)
        write_shard(shard_path(Path(task.folder), task.job.what, *span), arrays, task.start)
    except Exception as error:
        line = f"{type(error).__name__}: {' '.join(str(error).split())}"
        details = f"{traceback.format_exc()}on {platform.node()}, process {os.getpid()}"
        return ShardOutcome(*span, time.perf_counter() - begin, line, details, isinstance(error, OSError))
    return ShardOutcome(*span, time.perf_counter() - begin)


def compute(task: ShardTask, start: int, stop: int) -> Arrays:
    """Compute a range of items of a task, block by block."""
    work = Work.for_job(task.job, _environment(task.content))
    before, set_threads = batch_threads(), bool(task.threads)
    parts: list[Arrays] = []
    try:
        if set_threads:
            set_batch_threads(task.threads)
        for number in range(start // task.block, -(-stop // task.block)):
            first, last = number * task.block, (number + 1) * task.block
            parts.append(_block(task, work, number, slice(max(start, first), min(stop, last))))
    finally:
        if set_threads:
            set_batch_threads(before)
    return joined(parts)


def _block(task: ShardTask, work: Work, number: int, part: slice) -> Arrays:
    """Compute the items of block ``number`` that are in ``part``, the shard's slice of all items."""
    random = np.random.default_rng(np.random.SeedSequence(task.seed, spawn_key=(number,)))
    what, drawn = task.job.what, task.items is None
    with state_restored(work.env):
        if task.items is not None:
            items = task.items[part.start - task.start : part.stop - task.start]
        else:
            sample = JOBS[what].sample if isinstance(what, str) else joint_values
            items = sample(work, random, task.block)[part.start - number * task.block :][: part.stop - part.start]
        if isinstance(what, str):
            arrays = JOBS[what].compute(work, items, random)
        else:
            arrays = _checked(what(work.env, items, random, **work.options), len(items))
    return {"items": items, **arrays} if drawn else arrays


def _checked(result: object, count: int) -> Arrays:
    """Convert the result of a user's function to arrays; raise if they do not have ``count`` rows."""
    if not isinstance(result, Mapping):
        raise ArgumentError(f"the function returned {type(result).__name__}; expected a dict of arrays")
    named = cast("Mapping[object, NDArray[Any]]", result)
    arrays = {str(name): np.asarray(array) for name, array in named.items()}
    for name, array in arrays.items():
        if array.dtype == object or array.ndim == 0 or len(array) != count:
            given = f"shape {array.shape} and type {array.dtype}"
            raise ArgumentError(f"the function returned '{name}' of {given}; expected {count} rows, one for each item")
    return arrays


@contextmanager
def state_restored(env: Environment) -> Generator[None]:
    """Hold the lock of an environment, and restore the poses and joint values of bodies at the end of the block."""
    with ExitStack() as stack:
        stack.enter_context(env)
        for body in env.GetBodies():
            stack.enter_context(body)
        yield


def _environment(content: bytes) -> Environment:
    """Unpickle an environment, or return the one already unpickled for an earlier shard of the sweep."""
    key = hashlib.sha256(content).hexdigest()
    with _lock:
        known = _environments.get(key)
        if not any(env is known for env in RaveGetEnvironments()):  # RaveDestroy may have destroyed it
            _environments[key] = pickle.loads(content)
            while len(_environments) > _MOST_ENVIRONMENTS:
                _environments.popitem(last=False)
        _environments.move_to_end(key)
        return _environments[key]
