"""Names of Python 2's standard library that Python 3 has renamed or removed."""

# What old scripts pass has no types.
# pyright: reportUnknownMemberType=false, reportUnknownArgumentType=false

import builtins
import collections.abc
import inspect
import math
import os
import platform
import re
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ravemj.compat.python2 import files
from ravemj.compat.python2.division import divide
from ravemj.compat.python2.numpy1 import item

_RENAMED = """
BaseHTTPServer=http.server CGIHTTPServer=http.server commands=subprocess ConfigParser=configparser
Cookie=http.cookies cookielib=http.cookiejar copy_reg=copyreg cPickle=pickle cStringIO=io dumbdbm=dbm.dumb
htmlentitydefs=html.entities HTMLParser=html.parser httplib=http.client Queue=queue repr=reprlib
robotparser=urllib.robotparser ScrolledText=tkinter.scrolledtext SimpleHTTPServer=http.server
SimpleXMLRPCServer=xmlrpc.server SocketServer=socketserver StringIO=io thread=_thread Tix=tkinter.tix
tkColorChooser=tkinter.colorchooser Tkconstants=tkinter.constants tkFileDialog=tkinter.filedialog
tkFont=tkinter.font Tkinter=tkinter tkMessageBox=tkinter.messagebox tkSimpleDialog=tkinter.simpledialog
ttk=tkinter.ttk urllib2=urllib.request urlparse=urllib.parse UserDict=collections UserList=collections
UserString=collections xml.etree.cElementTree=xml.etree.ElementTree xmlrpclib=xmlrpc.client
"""
RENAMED: dict[str, str] = dict(re.findall(r"(\S+)=(\S+)", _RENAMED))
"""Modules that Python 3 has renamed."""


def _same(module: str, names: str) -> dict[str, object]:
    return {name: f"{module}.{name}" for name in names.split()}


class ArgSpec(NamedTuple):
    """What ``inspect.getargspec`` returns."""

    args: list[str]
    varargs: str | None
    keywords: str | None
    defaults: tuple[Any, ...] | None


def _ceil(x: float) -> float:
    return float(np.ceil(x))


def _floor(x: float) -> float:
    return float(np.floor(x))


def _of_items(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that accepts arrays of one element as numbers."""
    return lambda *args: function(*map(item, args))


def _getargspec(func: Callable[..., Any]) -> ArgSpec:
    return ArgSpec(*inspect.getfullargspec(func)[:4])


def _linux_distribution(*_: object, **__: object) -> tuple[str, str, str]:
    try:
        release = platform.freedesktop_os_release()
    except OSError:
        return "", "", ""
    return release["NAME"], release.get("VERSION_ID", ""), release.get("VERSION_CODENAME", "")


def _walk(top: str, func: Callable[[Any, str, list[str]], object], arg: Any) -> None:  # noqa: ANN401 - for func
    for folder, folders, names in os.walk(top):
        both = [*folders, *names]
        func(arg, folder, both)
        folders[:] = [name for name in folders if name in both]


def _join(words: list[str], sep: str = " ") -> str:
    return sep.join(words)


def _nothing(*_: object) -> None:
    """Set what Python 3 does not have."""


_PATH: dict[str, object] = {"walk": _walk}
_METHODS = """
capitalize center count expandtabs find index ljust lower lstrip maketrans replace rfind rindex rjust rsplit rstrip
split strip swapcase translate upper zfill
"""

NAMES: dict[str, dict[str, object]] = {
    "collections": _same("collections.abc", " ".join(collections.abc.__all__)),
    "exceptions": {name: value for name, value in vars(builtins).items() if name.endswith("Error")},
    "fractions": {"gcd": "math.gcd"},
    "imp": {"load_source": "ravemj.compat.python2.finder.load_source", "new_module": "types.ModuleType"},
    "inspect": {"getargspec": _getargspec},
    "itertools": {
        "ifilter": "builtins.filter",
        "ifilterfalse": "itertools.filterfalse",
        "imap": "builtins.map",
        "izip": "builtins.zip",
        "izip_longest": "itertools.zip_longest",
    },
    "math": {
        name: _of_items({"ceil": _ceil, "floor": _floor}.get(name, function))
        for name, function in vars(math).items()
        if callable(function) and not name.startswith("_")
    },
    "md5": {"md5": "hashlib.md5", "new": "hashlib.md5"},
    "ntpath": _PATH,
    "operator": {"div": divide, "isCallable": "builtins.callable", "sequenceIncludes": "operator.contains"},
    "os": {"errno": "errno", "getcwdu": "os.getcwd"},
    "pickle": {"load": files.load, "loads": files.loads, "Unpickler": files.Unpickler},
    "platform": {"dist": _linux_distribution, "linux_distribution": _linux_distribution},
    "posixpath": _PATH,
    "sets": {"Set": set, "ImmutableSet": frozenset},
    "string": {
        **_same("builtins.str", _METHODS),
        **{"atof": float, "atoi": int, "atol": int, "join": _join, "joinfields": _join, "splitfields": str.split},
        "letters": "string.ascii_letters",
        "lowercase": "string.ascii_lowercase",
        "uppercase": "string.ascii_uppercase",
    },
    "sys": {
        "exc_clear": _nothing,
        "maxint": "sys.maxsize",
        "setcheckinterval": _nothing,
        "setdefaultencoding": _nothing,
    },
    "time": {"clock": time.perf_counter if os.name == "nt" else time.process_time},
    "types": {
        **{
            "BooleanType": bool,
            "ComplexType": complex,
            "DictionaryType": dict,
            "DictType": dict,
            "FileType": files.File,
        },
        **{
            "ClassType": type,
            "FloatType": float,
            "IntType": int,
            "ListType": list,
            "LongType": int,
            "SliceType": slice,
        },
        **{"ObjectType": object, "StringType": str, "StringTypes": (str,), "TupleType": tuple, "TypeType": type},
        **{"UnicodeType": str, "XRangeType": range, "UnboundMethodType": "types.FunctionType"},
    },
    "urllib": {
        **_same("urllib.parse", "quote quote_plus unquote unquote_plus urlencode"),
        **_same("urllib.request", "pathname2url url2pathname urlcleanup urlopen urlretrieve"),
    },
    "xml": {},
    "xml.etree": {"cElementTree": "xml.etree.ElementTree"},
}
"""For modules that are there, names that they have no more; for those that are not, all their names.

A text says where the value is now.
"""
