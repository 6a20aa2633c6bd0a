"""``ravemj.sweep``: checks the arguments and computes the missing shards."""

import json
import operator
import os
import pickle
import sys
import time
from collections.abc import Mapping
from concurrent.futures import Executor, ProcessPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple, SupportsIndex

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.processes import Workers
from ravemj.core.version import __version__
from ravemj.engine.simulation.record import WorldRecord
from ravemj.errors import ArgumentError
from ravemj.formats.shipped import SHIPPED_MODELS, model_path
from ravemj.rave import Environment, Robot, load
from ravemj.sweeps.digests import digest, source_digest
from ravemj.sweeps.driver import Driver, Here, Progress, Told
from ravemj.sweeps.folder import FORMAT, Sweep, prepare, read_manifest
from ravemj.sweeps.jobs import BLOCK, JOBS, Function, Job, Work, checked_items
from ravemj.sweeps.pictures import check_options
from ravemj.sweeps.shards import PICTURES, is_sound, shard_path
from ravemj.sweeps.worker import ShardTask, compute, state_restored

Model = str | os.PathLike[str] | Environment | Robot
Items = ArrayLike | str | os.PathLike[str]

_SECONDS = 20.0
"""Target duration of a shard [s], unless the shard would be too large or shards too few."""
_BYTES = 100e6
"""Maximum size of a shard [bytes]."""
_EACH = 4
"""Minimum number of shards per process, so that all processes end at about the same time."""


def sweep(  # noqa: PLR0913 - keyword arguments
    model: Model,
    what: str | Function,
    items: Items,
    out: str | os.PathLike[str],
    *,
    executor: int | Executor | None = None,
    seed: int = 0,
    manip: str | None = None,
    options: Mapping[str, Any] | None = None,
    shard: int | None = None,
    block: int | None = None,
    ahead: int = 256,
    retries: int = 1,
    timeout: float | None = None,
    check: bool = False,
    progress: Progress | None = None,
    told: Told | None = None,
) -> Sweep:
    """Compute a function of many items, in shards, and write the results to a folder.

    Repeating the call computes only what is missing. The results do not depend on executor and shards, since random
    generators belong to blocks of items.

    Args:
        model: A file, the name of a shipped model, an environment or a robot, which are sent in their present state.
        what: ``collides`` or ``poses`` of joint values, shape (N, dof); ``ik`` of tool poses in the world, shape
            (N, 4, 4) or (N, 7); ``plan`` of starts and goals, shape (N, 2, dof); ``pictures`` of joint values, as tar
            files; or a function of an environment, the items of a block and a random generator that returns a dict of
            arrays with a row for each item.
        items: The items; or the path of a ``.npy``, ``.npz`` (its first array) or ``.csv`` file; or a number of items
            that are drawn within the joint limits, and written beside the results.
        out: The folder, which is created if it is missing.
        executor: None: this process. A number: number of processes, with one thread each. Or an ``Executor`` whose
            processes can access the folder; it is not shut down.
        seed: The seed of random numbers.
        manip: The name of the manipulator; None: the active one for ``ik``, else the whole robot.
        options: For ``ik``: ``type`` of the goals, and whether ``collisions`` exclude solutions. For ``plan``: maximum
            number of ``iterations``. For ``pictures``: ``camera`` (``T_world_camera``), ``size`` (width, height),
            ``outputs`` (some of rgb, depth and links), and ``prepare``, a function of an environment, joint values and
            a random generator that changes the environment before a picture, and may return another camera. For a
            function: its further arguments, by name.
        shard: Items per shard; None: as many as take 20 s or fill 100 MB. A function gets whole blocks.
        block: Items that share a random generator; None: 1 for ``plan``, else 1000.
        ahead: Maximum number of shards submitted to an ``Executor`` at a time; choose more than it has processes.
        retries: Number of retries of a shard whose process died.
        timeout: Time limit of a shard [s]; for an ``Executor``, the maximum time without a finished shard. None: no
            limit.
        check: Whether to recompute shards with damaged files.
        progress: Called with the numbers of finished, of all and of failed shards.
        told: Called with the ``start``, ``stop``, ``seconds`` and ``error`` of each shard.

    Returns:
        The complete results.

    Raises:
        ArgumentError: an argument is wrong, or the folder contains another sweep.
        OutputError: the folder cannot be written.
        SweepError: shards failed, or the executor did; all other shards are finished.

    Example:
        >>> labels = ravemj.sweep("panda", "collides", 1_000_000, "labels", executor=8)
        >>> labels.arrays("collides").mean()
    """
    folder = Path(out)
    env, robot = _environment(model)
    job = _job(env, robot, what, manip, options or {})
    _check_sendable(job, executor)
    plan = _plan(env, job, items, _at_least("seed", seed, 0), block, folder)
    workers = executor if isinstance(executor, int) else 1
    plan = plan._replace(shard=_shard_size(plan, folder, shard, _at_least("executor", workers, 1)))
    _at_least("ahead", ahead, 1)
    _at_least("retries", retries, 0)
    if timeout is not None and (executor is None or not timeout > 0):
        raise ArgumentError(f"sweep: timeout is {timeout}; expected None, or more than 0 with processes")
    prepare(folder, plan.manifest(env))
    result = Sweep.open(folder)
    missing = [span for span in result.spans if not _is_done(shard_path(folder, what, *span), check=check)]
    tasks = (plan.task(*span, threads=executor is not None) for span in missing)
    if isinstance(executor, int):
        needs_main = any(b"__main__" in content for content in (plan.first.content, pickle.dumps(job)))
        with Workers(min(workers, max(1, len(missing))), needs_main=needs_main) as pool:
            driver = Driver(pool, folder, retries, timeout, progress, told)
            driver.run(tasks, len(missing), len(result.spans), min(workers, max(1, len(missing))))
    else:
        driver = Driver(executor or Here(), folder, retries, timeout, progress, told)
        driver.run(tasks, len(missing), len(result.spans), ahead if executor else 1)
    return result


class _SweepInputs(NamedTuple):
    """Everything that determines the results of a sweep."""

    first: ShardTask  # all items
    job: Job
    drawn: bool
    shard: int

    def manifest(self, env: Environment) -> dict[str, Any]:
        what = self.job.what
        for body in env.simulation.bodies:
            body.configuration()  # so that the manifest always contains it
        return {
            "format": FORMAT,
            **versions(),
            "scene": digest((WorldRecord.from_simulation(env.simulation), _choices(env))),
            "what": what if isinstance(what, str) else f"{what.__module__}:{what.__qualname__}",
            "function": None if isinstance(what, str) else source_digest(what),
            "robot": self.job.robot,
            "manip": self.job.manip,
            "options": {name: _plain(value) for name, value in self.job.options.items()},
            "items": None if self.drawn else digest(self.first.items),
            "seed": self.first.seed,
            "total": self.first.stop,
            "block": self.first.block,
            "shard": self.shard,
        }

    def task(self, start: int, stop: int, *, threads: bool) -> ShardTask:
        items = None if self.first.items is None else self.first.items[start:stop]
        return self.first._replace(start=start, stop=stop, items=items, threads=int(threads))


def versions() -> dict[str, str]:
    """Return the versions of the packages that compute results, by name."""
    return {"ravemj": __version__, "mujoco": mujoco.__version__, "numpy": np.__version__}


def _plain(value: object) -> object:
    """Convert an option to JSON data; a function to its name and the digest of its source."""
    if callable(value):
        return f"{value.__module__}:{value.__qualname__} {source_digest(value)}"
    return json.loads(json.dumps(np.asarray(value).tolist()))


def _choices(env: Environment) -> list[object]:
    return [(robot.GetName(), robot.GetActiveDOFIndices().tolist()) for robot in env.GetRobots()]


def _environment(model: Model) -> tuple[Environment, Robot | None]:
    """Return the environment of a model, and the robot if the model is a ``Robot``; load the model if it is a path."""
    if isinstance(model, Robot):
        return model.GetEnv(), model
    if isinstance(model, Environment):
        return model, None
    try:
        path = os.fspath(model)
    except TypeError:
        raise ArgumentError(f"sweep: model: is {model!r}; expected a file, an environment or a robot") from None
    return load(model_path(path) if path in SHIPPED_MODELS and not os.path.exists(path) else path), None


def _job(env: Environment, robot: Robot | None, what: object, manip: str | None, options: Mapping[str, Any]) -> Job:
    if not callable(what) and what not in JOBS:
        raise ArgumentError(f"sweep: what is {what!r}; expected a function, or one of {', '.join(JOBS)}")
    if what == PICTURES:
        check_options(options)
    robots = env.GetRobots()
    if robot is None and len(robots) > 1 and not callable(what):
        names = ", ".join(candidate.GetName() for candidate in robots)
        raise ArgumentError(f"sweep: model: there are several robots ({names}); pass one of them")
    chosen = robot or (robots[0] if robots else None)
    arms = [] if chosen is None else chosen.GetManipulators()
    if manip is not None and manip not in [arm.GetName() for arm in arms]:
        names = ", ".join(arm.GetName() for arm in arms) or "none"
        raise ArgumentError(f"sweep: manip is {manip!r}; there are: {names}")
    if what == "ik" and manip is None and chosen is not None:
        active = chosen.GetActiveManipulator()
        manip = None if active is None else active.GetName()
    known = JOBS[what].options if isinstance(what, str) else options.keys()
    if options.keys() - known:
        expected = ", ".join(sorted(known)) or "none"
        raise ArgumentError(f"sweep: options: found {', '.join(sorted(options.keys() - known))}; expected {expected}")
    return Job(what, "" if chosen is None else chosen.GetName(), manip, dict(options))  # pyright: ignore[reportArgumentType]


def _check_sendable(job: Job, executor: int | Executor | None) -> None:
    """Raise if worker processes cannot import a user's function."""
    if isinstance(job.what, str) or not isinstance(executor, int | ProcessPoolExecutor):
        return
    main = sys.modules["__main__"]
    is_here_alone = job.what.__module__ == "__main__" and not hasattr(main, "__file__")
    try:
        pickle.dumps(job)
    except Exception as error:  # pickle has several kinds
        raise ArgumentError(_unsendable(str(error))) from error
    if is_here_alone:
        raise ArgumentError(_unsendable(f"{job.what.__qualname__} is not in a file"))


def _unsendable(why: str) -> str:
    hint = "define the function in a module, at its top level, or use an executor that sends functions, as Dask's"
    return f"sweep: what: processes cannot import it ({why}): {hint}"


def _plan(env: Environment, job: Job, items: Items, seed: int, block: int | None, folder: Path) -> _SweepInputs:
    work = Work.for_job(job, env)
    known = JOBS[job.what] if isinstance(job.what, str) else None
    given, total = _items(items)
    with state_restored(env):
        if given is not None and isinstance(job.what, str):
            given = checked_items(work, job.what, given)
        elif isinstance(job.what, str):
            JOBS[job.what].shape(work)  # says what is missing
    size = (BLOCK if known is None else known.block) if block is None else _at_least("block", block, 1)
    task = ShardTask(pickle.dumps(env), job, seed, size, 0, total, given, str(folder.absolute()), 0)
    return _SweepInputs(task, job, given is None, 0)


def _items(items: Items) -> tuple[NDArray[Any] | None, int]:
    """Return the items and their number; the items are None if only a number is given, and they are sampled later."""
    if isinstance(items, str | os.PathLike):
        items = _items_of_file(os.fspath(items))
    array = np.asarray(items)
    if array.ndim == 0:
        if array.dtype.kind not in "iu" or array < 1:
            raise ArgumentError(f"sweep: items is {items!r}; expected an array, a file, or a number of items from 1 on")
        return None, int(array)
    if not len(array) or array.dtype == object:
        raise ArgumentError("sweep: items: should be an array of numbers with at least one row")
    return array, len(array)


def _items_of_file(path: str) -> NDArray[Any]:
    try:
        if path.endswith(".csv"):
            return np.loadtxt(path, delimiter=",", ndmin=2)
        loaded: Any = np.load(path, allow_pickle=False)
        return loaded[loaded.files[0]] if path.endswith(".npz") else loaded
    except (OSError, ValueError, EOFError, IndexError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ArgumentError(f"sweep: items: cannot read {path} as .npy, .npz or .csv: {reason}") from error


def _shard_size(plan: _SweepInputs, folder: Path, shard: int | None, workers: int) -> int:
    """Return the number of items per shard: as given, as in the folder's manifest, or by timing a first block."""
    task, is_function = plan.first, callable(plan.job.what)
    if shard is None:
        before = read_manifest(folder)
        if before is not None:
            return int(before["shard"])
        shard = _suggested(task, workers, 1 if not is_function else task.block)
    _at_least("shard", shard, 1)
    return -(-shard // task.block) * task.block if is_function else shard


def _suggested(task: ShardTask, workers: int, least: int) -> int:
    count = min(task.block, task.stop)
    begin = time.perf_counter()
    try:
        arrays = compute(task, 0, count)
    except Exception:
        return max(least, count)
    seconds = max(time.perf_counter() - begin, 1e-6)
    size = max(1, sum(array.nbytes for array in arrays.values()))
    wanted = min(count * _SECONDS / seconds, count * _BYTES / size, task.stop / (workers * _EACH))
    whole = max(1, int(wanted) // count) * count
    return max(least, min(whole, task.stop))


def _is_done(path: Path, *, check: bool) -> bool:
    """Return whether a shard's file exists; if ``check``, remove a damaged file and return False."""
    if not path.exists():
        return False
    if check and not is_sound(path):
        path.unlink()
        return False
    return True


def _at_least(name: str, number: object, least: int) -> int:
    if isinstance(number, bool) or not isinstance(number, SupportsIndex) or operator.index(number) < least:
        raise ArgumentError(f"sweep: {name} is {number!r}; expected a whole number from {least} on")
    return operator.index(number)
