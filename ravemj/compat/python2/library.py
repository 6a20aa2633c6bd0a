"""Names of Python 2's standard library that Python 3 has renamed or removed."""

# Values of old scripts have no types.
# pyright: reportUnknownMemberType=false, reportUnknownArgumentType=false

import builtins
import collections.abc
import functools
import inspect
import math
import os
import platform
import re
import sys
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
"""Modules renamed in Python 3."""


def _in(module: str, names: str) -> dict[str, object]:
    """Map Python 2 names to their locations in ``module``; ``names`` contains ``old=new`` for a renamed name."""
    return {name: f"{module}.{now or name}" for name, now in re.findall(r"([^\s=]+)=?(\S*)", names)}


class ArgSpec(NamedTuple):
    """Result of ``inspect.getargspec``."""

    args: list[str]
    varargs: str | None
    keywords: str | None
    defaults: tuple[Any, ...] | None


def _ceil(x: float) -> float:
    return float(np.ceil(x))


def _floor(x: float) -> float:
    return float(np.floor(x))


def _of_items(function: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap a function of numbers so that it also accepts arrays of one element."""
    return lambda *args: function(*map(item, args))


def _getargspec(func: Callable[..., Any]) -> ArgSpec:
    return ArgSpec(*inspect.getfullargspec(func)[:4])


def _linux_distribution(*_: object, **__: object) -> tuple[str, str, str]:
    try:
        release = platform.freedesktop_os_release()
    except OSError:
        return "", "", ""
    return release["NAME"], release.get("VERSION_ID", ""), release.get("VERSION_CODENAME", "")


def _walk(top: str, func: Callable[[Any, str, list[str]], object], arg: Any) -> None:
    for folder, folders, names in os.walk(top):
        both = [*folders, *names]
        func(arg, folder, both)
        folders[:] = [name for name in folders if name in both]


def _join(words: list[str], sep: str = " ") -> str:
    return sep.join(words)


def _nothing(*_: object) -> None:
    """Ignore a call to set something that Python 3 does not have."""


_PATH: dict[str, object] = {"walk": _walk}
_HASHES = {name: functools.partial(files.new_hash, name) for name in ("md5", "sha1", "sha256", "sha512")}
_METHODS = """
capitalize center count expandtabs find index ljust lower lstrip maketrans replace rfind rindex rjust rsplit rstrip
split splitfields=split strip swapcase translate upper zfill
"""
_TYPES = """
BooleanType=bool ClassType=type ComplexType=complex DictionaryType=dict DictType=dict FloatType=float IntType=int
ListType=list LongType=int ObjectType=object SliceType=slice StringType=str TupleType=tuple TypeType=type
UnicodeType=str XRangeType=range
"""

NAMES: dict[str, dict[str, object]] = {
    "codecs": {"getwriter": files.getwriter},
    "collections": _in("collections.abc", " ".join(collections.abc.__all__)),
    "exceptions": {name: value for name, value in vars(builtins).items() if inspect.isclass(value)},
    "fractions": {"gcd": "math.gcd"},
    "hashlib": {**_HASHES, "new": files.new_hash},
    "imp": {
        **_in("importlib", "reload"),
        **_in("ravemj.compat.python2.finder", "load_source"),
        **_in("types", "new_module=ModuleType"),
    },
    "inspect": {"getargspec": _getargspec},
    "itertools": {
        **_in("builtins", "ifilter=filter imap=map izip=zip"),
        **_in("itertools", "ifilterfalse=filterfalse izip_longest=zip_longest"),
    },
    "math": {
        name: _of_items({"ceil": _ceil, "floor": _floor}.get(name, function))
        for name, function in vars(math).items()
        if callable(function) and not name.startswith("_")
    },
    "md5": {"md5": _HASHES["md5"], "new": _HASHES["md5"]},
    "ntpath": _PATH,
    "operator": {"div": divide, "isCallable": callable, "sequenceIncludes": "operator.contains"},
    "os": {"errno": "errno", "getcwdu": os.getcwd},
    "pickle": {"load": files.load, "loads": files.loads, "Unpickler": files.Unpickler},
    "platform": {"dist": _linux_distribution, "linux_distribution": _linux_distribution},
    "posixpath": _PATH,
    "sets": {"Set": set, "ImmutableSet": frozenset},
    "string": {
        **_in("builtins", "atof=float atoi=int atol=int"),
        **_in("builtins.str", _METHODS),
        **_in("string", "letters=ascii_letters lowercase=ascii_lowercase uppercase=ascii_uppercase"),
        **{"join": _join, "joinfields": _join},
    },
    "subprocess": {"check_output": files.check_output, "Popen": files.Popen},
    "sys": {
        "maxint": sys.maxsize,
        **dict.fromkeys(("exc_clear", "setcheckinterval", "setdefaultencoding"), _nothing),
    },
    "time": {"clock": time.perf_counter if os.name == "nt" else time.process_time},
    "types": {**_in("builtins", _TYPES), "FileType": files.File, "StringTypes": (str,)},
    "urllib": {
        **_in("urllib.parse", "quote quote_plus unquote unquote_plus urlencode"),
        **_in("urllib.request", "pathname2url url2pathname urlcleanup urlopen urlretrieve"),
    },
    "xml": {},
    "xml.etree": {"cElementTree": "xml.etree.ElementTree"},
}
"""Values of Python 2 names that Python 3 lacks, by module and name; a string is the value's location in Python 3."""
