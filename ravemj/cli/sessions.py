"""Commands that give ravemj to scripts and to people at a prompt: ``run``, ``shell`` and ``alias``."""

import argparse
import os
import runpy
import sys
import traceback
from collections.abc import Mapping
from types import TracebackType

import numpy as np

import ravemj
from ravemj import alias as openravepy_alias
from ravemj.cli.models import load_model
from ravemj.errors import Source, SourceError


def run(options: argparse.Namespace) -> int:
    """Run a script that imports openravepy."""
    script = options.script
    if not os.path.isfile(script):
        raise SourceError("there is no such script", Source(script))
    openravepy_alias.install_finder()
    if options.interactive:
        return _start_ipython(["-i", script, "--", *options.arguments])
    sys.argv = [script, *options.arguments]
    sys.path.insert(0, os.path.dirname(os.path.abspath(script)))
    try:
        runpy.run_path(script, run_name="__main__")
    except Exception as error:  # whatever the user's script raises
        traceback.print_exception(type(error), error, _from_script(error.__traceback__, script))
        return 1
    return 0


def _from_script(trace: TracebackType | None, script: str) -> TracebackType | None:
    """Return the traceback without our own frames at its start."""
    inner = trace
    while inner is not None and inner.tb_frame.f_code.co_filename != script:
        inner = inner.tb_next
    return inner  # None: the script could not even be parsed, and the error itself says where


def shell(options: argparse.Namespace) -> int:
    """Open IPython with the environment of a model."""
    env = load_model(options)
    env.SetViewer("qtcoin")
    robots = env.GetRobots()
    names = {"env": env, "robot": robots[0] if robots else None, "viewer": env.GetViewer(), "ravemj": ravemj, "np": np}
    openravepy_alias.install_finder()
    print(f"ravemj {ravemj.__version__}: {', '.join(names)} are here; env.<TAB> and env.SetViewer? help")
    status = _start_ipython(["--no-banner"], names)
    env.Destroy()
    return status


def _start_ipython(arguments: list[str], names: Mapping[str, object] | None = None) -> int:
    from IPython import start_ipython  # noqa: PLC0415 - slow to import  # pyright: ignore[reportUnknownVariableType]

    status: object = start_ipython(argv=arguments, user_ns=dict(names or {}))
    return status if isinstance(status, int) else 0


def alias(options: argparse.Namespace) -> int:
    """Install or remove the package openravepy that forwards to ravemj."""
    if options.install:
        print(f"import openravepy now gives ravemj, by {openravepy_alias.install_package()}")
        return 0
    removed = openravepy_alias.remove_package()
    print("there was nothing to remove" if removed is None else f"removed {removed}")
    return 0
