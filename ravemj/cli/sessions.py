"""Commands that run scripts and open prompts: ``run``, ``shell`` and ``alias``."""

import argparse
import itertools
import os
import sys
import traceback
from collections.abc import Mapping
from types import ModuleType

import numpy as np

import ravemj
from ravemj.cli.models import load_model
from ravemj.compat import alias as openravepy_alias
from ravemj.compat import python2
from ravemj.core import signals
from ravemj.errors import Source, SourceError

_MODELS = (".xml", ".dae", ".zae", ".json", ".urdf", ".mjcf")
_OUR_FILES = {__file__, *python2.FILES, "<frozen importlib._bootstrap>", "<frozen importlib._bootstrap_external>"}


def run(options: argparse.Namespace) -> int:
    """Run a script that imports openravepy."""
    script = options.script
    if os.path.isdir(script):
        raise SourceError("this is a folder, not a script", Source(script))
    if not os.path.exists(script):
        raise SourceError("there is no such script", Source(script), "check the path")
    if script.lower().endswith(_MODELS):
        raise SourceError("this is a model, not a Python script", Source(script), f"open it with ravemj shell {script}")
    openravepy_alias.install_finder()
    if options.interactive and not options.py2:
        return _start_ipython(["-i", script, "--", *options.arguments])
    sys.argv = [script, *options.arguments]
    folder = os.path.dirname(os.path.abspath(script))
    sys.path.insert(0, folder)
    main = sys.modules["__main__"] = ModuleType("__main__")
    main.__file__ = script
    if options.py2:
        python2.install_finder(folder)
        np.set_printoptions(legacy="1.21")  # lists of numbers print as [1.0], not as [np.float64(1.0)]
    status = _execute(script, main, options.py2)
    if options.interactive:
        main.__dict__.pop("__builtins__", None)  # the prompt is Python 3
        return _start_ipython(["--no-banner"], main.__dict__)
    return status


def _execute(script: str, main: ModuleType, py2: bool) -> int:
    """Run a script as the main module and return the exit code; if it raises, print its traceback and return 1."""
    signals.leave_signals_to_python()
    with open(script, "rb") as file:
        source = file.read()
    if b"\0" in source:
        raise SourceError("this is a binary file, not a Python script", Source(script))
    try:
        if py2:
            python2.execute(source, script, main.__dict__)
        else:
            exec(compile(source, script, "exec", dont_inherit=True), main.__dict__)
    except Exception as error:  # whatever the user's script raises
        _print_traceback(error, script)
        if isinstance(error, SyntaxError) and error.filename and not py2 and python2.is_python2(error.filename):
            print(f"ravemj: {error.filename} is Python 2; ravemj run --py2 {script} translates it", file=sys.stderr)
        elif isinstance(error, NameError) and not py2 and error.name in python2.OLD_NAMES:
            print(f"ravemj: Python 2 has {error.name}; ravemj run --py2 {script} knows its names", file=sys.stderr)
        return 1
    return 0


def _print_traceback(error: Exception, script: str) -> None:
    """Print the traceback as Python does, without the frames of ravemj."""
    shown = traceback.TracebackException.from_exception(error)
    shown.stack[:] = itertools.dropwhile(lambda frame: frame.filename != script, shown.stack)
    link = shown
    while link is not None:
        link.stack[:] = [frame for frame in link.stack if frame.filename not in _OUR_FILES]
        link = link.__cause__ or link.__context__
    sys.stderr.writelines(shown.format())


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

    signals.leave_signals_to_python()
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
