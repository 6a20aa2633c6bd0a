"""The command ``sweep``."""

import argparse
import importlib
import json
import os
import sys
import time
from collections.abc import Callable, Generator, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ravemj.cli.console import progress
from ravemj.cli.models import chosen_robots, load_model
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering.camera_file import read_camera
from ravemj.sweeps.driver import Progress, Told
from ravemj.sweeps.folder import read_manifest
from ravemj.sweeps.jobs import JOBS, Function
from ravemj.sweeps.sweep import Items
from ravemj.sweeps.sweep import sweep as run
from ravemj.sweeps.worker import ShardOutcome

_BETWEEN_LINES = 30.0  # s


def sweep(options: argparse.Namespace) -> int:
    """Compute the missing result files (shards) of a sweep, and report progress."""
    env = load_model(options)
    robots = chosen_robots(env, options.robot) if env.GetRobots() else []
    before = read_manifest(Path(options.output)) or {}
    with _executor(options) as executor, _shown(options) as (advance, told):
        done = run(
            robots[0] if robots else env,
            options.what if options.what in JOBS else _function(options.what, "WHAT"),
            _items(options, before),
            options.output,
            executor=executor,
            seed=before.get("seed", 0) if options.seed is None else options.seed,
            manip=options.manip,
            options=_job_options(options),
            shard=options.shard,
            ahead=options.ahead,
            retries=options.retries,
            timeout=options.timeout,
            check=options.check,
            progress=advance,
            told=told,
        )
    if not options.json:
        print(f"{len(done.files)} of {len(done.spans)} shards, {done.done} items in {done.folder}")
    return 0


def _job_options(options: argparse.Namespace) -> dict[str, Any]:
    camera = None if options.camera is None else read_camera(options.camera).T_world_camera
    given = {
        "type": options.type,
        "collisions": options.collisions or None,
        "iterations": options.iterations,
        "camera": camera,
        "size": options.size,
        "outputs": options.outputs,
    }
    return {name: value for name, value in given.items() if value is not None}


def _items(options: argparse.Namespace, before: Mapping[str, Any]) -> Items:
    """Return ``--items``, ``--count`` or, if a sweep is continued, its item count; raise if there is none of these."""
    given = options.items or options.count
    if given is None and before.get("items", "") is None:
        given = before["total"]
    if given is None:
        raise ArgumentError("sweep: one of --items and --count says what the items are")
    return given


@contextmanager
def _executor(options: argparse.Namespace) -> Generator[int | Executor | None]:
    """Yield the user's executor and shut it down at the end; without one yield the number of jobs, None if it is 1."""
    if options.executor is None:
        yield options.jobs if options.jobs > 1 else None
        return
    made = _function(options.executor, "--executor")()
    if not isinstance(made, Executor):
        raise ArgumentError(f"--executor: {options.executor} returned {type(made).__name__}, expected an Executor")
    try:
        yield made
    finally:
        made.shutdown(wait=False, cancel_futures=True)


def _function(name: str, option: str) -> Callable[..., Any]:
    """Import the function ``MODULE:FUNCTION``, in the working folder first; raise if there is none."""
    module, colon, attribute = name.partition(":")
    if not (module and colon and attribute):
        names = f"{', '.join(JOBS)} or MODULE:FUNCTION" if option == "WHAT" else "MODULE:FUNCTION"
        raise ArgumentError(f"{option}: found '{name}', expected {names}")
    if os.getcwd() not in sys.path:
        sys.path.insert(0, os.getcwd())
    try:
        function: Function = getattr(importlib.import_module(module), attribute)
    except (ImportError, AttributeError) as error:
        raise ArgumentError(f"{option}: cannot import {name}: {error}") from error
    return function


@contextmanager
def _shown(options: argparse.Namespace) -> Generator[tuple[Progress, Told | None]]:
    """Show progress: a bar on a terminal, else a line every half minute; with ``--json`` a line for each shard."""
    begin = last = time.monotonic()
    first: int | None = None  # shards that were done before

    def tell(outcome: ShardOutcome) -> None:
        entry = {name: getattr(outcome, name) for name in ("start", "stop", "seconds", "error")}
        print(json.dumps(entry), flush=True)

    with progress("shards", 100.0, "%") as bar:

        def advance(done: int, total: int, failed: int) -> None:
            nonlocal last, first
            bar(100.0 * (done + failed) / total)
            now, first = time.monotonic(), done - 1 if first is None else first
            if not sys.stderr.isatty() and now - last > _BETWEEN_LINES:
                last = now
                left = (now - begin) / max(1, done - first) * (total - done - failed)
                print(f"{done} of {total} shards, {failed} failed, {left:.0f} s left", file=sys.stderr, flush=True)

        yield advance, tell if options.json else None
