"""What ``import openravepy`` gives: OpenRAVE's names, and what its own module lets slip.

Scripts that say ``from openravepy import *`` rely on ``numpy``, ``sys``, ``pickle``, ``logging`` and ``log`` too.
What is ravemj's own (``load``, ``record``, ...) can be asked for, and does not come with the star, where it would hide
names such as ``numpy.load``.
"""

import builtins
import importlib
import itertools
import logging
import os
import pickle
import sys

import numpy

import ravemj
from ravemj.compat import legacy
from ravemj.compat.names import ONLY_OPENRAVEPY
from ravemj.rave.logs import log

__version__ = "0.9.0"
"""That of OpenRAVE's last release, for scripts that compare."""

_OWN = {"load", "read_motion", "record"}
_LEAKS = {
    "numpy": numpy,
    "os": os,
    "sys": sys,
    "itertools": itertools,
    "pickle": pickle,
    "logging": logging,
    "log": log,
}
_NAMES: list[str] = [name for name in dir(ravemj) if name not in _OWN and not name.startswith("_")]

_ELSEWHERE = {  # where earlier versions had these, too
    "OpenRAVEGlobalArguments": ("misc", "OpenRAVEGlobalArguments"),
    "OpenRAVEModel": ("databases", "DatabaseGenerator"),
}

builtins.__dict__["__openravepy_build_doc__"] = __build_doc__ = False
__path__: list[str] = []  # sub-modules are found by ravemj.compat.names
_ALL = [*_NAMES, *legacy.NAMES, *ONLY_OPENRAVEPY, *_ELSEWHERE, *_LEAKS]
globals().update({name: getattr(ravemj, name) for name in _NAMES}, **_LEAKS, **legacy.NAMES, __all__=_ALL)


def __getattr__(name: str) -> object:
    """Import a module of openravepy's when it is asked for, or give what is ravemj's own."""
    if name in _ELSEWHERE:
        module, its_name = _ELSEWHERE[name]
        return getattr(importlib.import_module(f"ravemj.compat.{module}"), its_name)
    if name in ONLY_OPENRAVEPY:
        return importlib.import_module(f"ravemj.compat.{name}")
    return getattr(ravemj, name)


def __dir__() -> list[str]:
    """Return what completion shows."""
    return _ALL
