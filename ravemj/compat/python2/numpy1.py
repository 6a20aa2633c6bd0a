"""NumPy 1's names, result types and conversions that NumPy 2 has removed."""

# Values of old scripts have no types.
# pyright: reportUnknownMemberType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownParameterType=false

import builtins
import functools
import re
from collections.abc import Callable, Iterable
from types import GeneratorType
from typing import Any

import numpy as np

from ravemj.compat.python2.files import as_bytes

_RENAMED = """
alltrue=all bool8=bool_ bytes0=bytes_ cfloat=complex128 clongfloat=clongdouble complex_=complex128 cumproduct=cumprod
float_=float64 Inf=inf infty=inf Infinity=inf int0=intp issubsctype=issubdtype longcomplex=clongdouble
longfloat=longdouble mat=asmatrix NAN=nan NaN=nan object0=object_ PINF=inf product=prod rank=ndim round_=round
row_stack=vstack singlecomplex=complex64 sometrue=any str0=str_ string0=str_ string_=str_ trapz=trapezoid
typeDict=sctypeDict uint0=uintp unicode0=str_ unicode_=str_ void0=void
"""
_MOVED = {
    np.char: "chararray compare_chararrays",
    np.exceptions: "AxisError ComplexWarning ModuleDeprecationWarning TooHardError VisibleDeprecationWarning",
    np.rec: "format_parser",
}
_ADDED = """
abs acos acosh asin asinh astype atan atan2 atanh bitwise_count bitwise_invert bitwise_left_shift
bitwise_right_shift bool concat core cumulative_prod cumulative_sum divmod dtypes exceptions f2py isdtype lib long
matrix_transpose matvec max min permute_dims polynomial pow round strings test testing trapezoid typing ulong
unique_all unique_counts unique_inverse unique_values unstack vecdot vecmat
"""
"""Names that NumPy 1 did not export by ``from numpy import *``; they would hide those of Python and ``math``."""

_OF_ARRAYS = ("repeat", "reshape", "resize", "tile")
"""Functions whose second argument is a size or shape."""

_SIZED = ("empty", "eye", "identity", "ones", "zeros", *_OF_ARRAYS)
"""Functions that take a size or shape: as first argument, or as second if in ``_OF_ARRAYS``."""

_SIZES = {"M", "N", "n", "newshape", "repeats", "reps", "shape"}
"""Keyword arguments that are sizes or shapes."""

_WHERE_NEEDED = None if np.lib.NumpyVersion(np.__version__) >= "2.0.0" else False


def item(a: Any) -> Any:
    """Return the element of a one-element array; return anything else unchanged."""
    return a.item() if isinstance(a, np.ndarray) and a.size == 1 else a


def _alen(a: Any) -> int:
    return len(np.atleast_1d(a))


def _array(object: Any, dtype: Any = None, copy: bool = True, *args: Any, **options: Any) -> Any:
    """Return an array as in NumPy 1: ``copy=False`` may copy, and ragged lists become object arrays."""
    may_copy: Any = True if copy else _WHERE_NEEDED
    try:
        return np.array(object, dtype, *args, copy=may_copy, **options)
    except ValueError as error:
        if dtype is not None or "inhomogeneous" not in str(error):
            raise
    return np.array(object, np.object_, *args, copy=may_copy, **options)


def _asfarray(a: Any, dtype: Any = np.float64) -> Any:
    return np.asarray(a, dtype if np.issubdtype(dtype, np.inexact) else np.float64)


def _asscalar(a: Any) -> Any:
    return a.item()


def _divide(x1: Any, x2: Any, *args: Any, **options: Any) -> Any:
    is_whole = all(np.asarray(x).dtype.kind in "biu" for x in (x1, x2))
    return (np.floor_divide if is_whole else np.divide)(x1, x2, *args, **options)


def _find_common_type(array_types: Iterable[Any], scalar_types: Iterable[Any]) -> Any:
    return np.result_type(*array_types, *(np.dtype(scalar).type(0).item() for scalar in scalar_types))


def _as_floats(function: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap a function to return floats for integer and boolean arrays."""

    @functools.wraps(function)
    def call(x: Any, *args: Any, **options: Any) -> Any:
        x = np.asanyarray(x)
        return function(x.astype(float) if x.dtype.kind in "biu" else x, *args, **options)

    return call


def _with_sizes(name: str) -> Callable[..., Any]:
    """Wrap NumPy's function ``name`` so that sizes given as floats are truncated, as NumPy did up to 1.11."""
    function, first = getattr(np, name), int(name in _OF_ARRAYS)

    @functools.wraps(function)
    def call(*args: Any, **options: Any) -> Any:
        sizes = [_whole(value) for value in args[first : first + 1]]
        options |= {name: _whole(options[name]) for name in _SIZES & options.keys()}
        return function(*args[:first], *sizes, *args[first + 1 :], **options)

    return call


def _whole(size: Any) -> Any:
    """Truncate a float size, or each float in a list or tuple of sizes, to an integer."""
    if isinstance(size, float):
        return int(size)
    return type(size)(map(_whole, size)) if isinstance(size, list | tuple) else size


def _fromstring(string: Any, dtype: Any = float, count: int = -1, sep: str = "") -> Any:
    return np.fromstring(string, dtype, count, sep=sep) if sep else np.frombuffer(as_bytes(string), dtype, count).copy()


def _in1d(ar1: Any, ar2: Any, **options: Any) -> Any:
    return np.isin(np.ravel(ar1), ar2, **options)


def _msort(a: Any) -> Any:
    return np.sort(a, axis=0)


def _sum(a: Any, *args: Any, **options: Any) -> Any:
    return builtins.sum(a) if isinstance(a, GeneratorType) else np.sum(a, *args, **options)


def _names() -> dict[str, object]:
    """Return the NumPy 1 names that replace or extend numpy's, and ``__all__`` for ``from numpy import *``."""
    renamed: dict[str, str] = dict(re.findall(r"(\S+)=(\S+)", _RENAMED))
    names: dict[str, object] = {old: getattr(np, new) for old, new in renamed.items() if hasattr(np, new)}
    names |= {name: getattr(module, name) for module, text in _MOVED.items() for name in text.split()}
    names |= {"math": "math", "NINF": -np.inf, "NZERO": -0.0, "PZERO": 0.0}
    own = (_alen, _array, _asfarray, _asscalar, _divide, _find_common_type, _fromstring, _in1d, _msort, _sum)
    names |= {function.__name__[1:]: function for function in own}
    names |= {name: _with_sizes(name) for name in _SIZED}
    names |= {function.__name__: _as_floats(function) for function in (np.ceil, np.fix, np.floor, np.trunc)}
    star = ({*np.__all__} - {*_ADDED.split()}) | {*names}
    types = {kind.__name__: kind for kind in (bool, complex, float, int, object, str)}
    return {**names, **types, "long": int, "unicode": str, "__all__": sorted(star)}


NAMES = _names()
"""Names that replace numpy's for scripts."""
