"""The module of ``import openravepy``: OpenRAVE's names, and other names that its module exposes.

Scripts with ``from openravepy import *`` also rely on ``numpy``, ``sys``, ``pickle``, ``logging`` and ``log``. ravemj's
own names (``load``, ``record``, ...) are available, but not exported by the star, where they would hide names such as
``numpy.load``.
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
"""Version of OpenRAVE's last release, for scripts that compare it."""

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

_ELSEWHERE = {  # modules in which earlier versions had these names
    "OpenRAVEGlobalArguments": ("misc", "OpenRAVEGlobalArguments"),
    "OpenRAVEModel": ("databases", "DatabaseGenerator"),
}

builtins.__dict__["__openravepy_build_doc__"] = __build_doc__ = False
__path__: list[str] = []  # sub-modules are found by ravemj.compat.names
_ALL = [*_NAMES, *legacy.NAMES, *ONLY_OPENRAVEPY, *_ELSEWHERE, *_LEAKS]
globals().update({name: getattr(ravemj, name) for name in _NAMES}, **_LEAKS, **legacy.NAMES, __all__=_ALL)


def __getattr__(name: str) -> object:
    """Return a submodule of openravepy, imported on first access, or one of ravemj's own names."""
    if name in _ELSEWHERE:
        module, its_name = _ELSEWHERE[name]
        return getattr(importlib.import_module(f"ravemj.compat.{module}"), its_name)
    if name in ONLY_OPENRAVEPY:
        return importlib.import_module(f"ravemj.compat.{name}")
    return getattr(ravemj, name)


def __dir__() -> list[str]:
    """Return the names shown by completion."""
    return _ALL
