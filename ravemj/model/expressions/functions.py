"""OpenRAVE's multivalued functions: roots of polynomials, and triangle functions for linkages.

Their values are sorted best first; the tuple is empty if there is none. In the names of the triangle functions, S is a
side and A an angle, in the order around the triangle; the last letter is the result. In OpenRAVE, only the names are
documented; arguments and order follow from the geometry.
"""

import functools
import math
import operator
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats

IMAGINARY_NOISE = 1e-6  # imaginary part of double roots due to rounding


@functools.lru_cache(maxsize=4096)  # each root is requested separately
def real_roots(*coefficients: float) -> tuple[float, ...]:
    """Return the real roots of a polynomial in ascending order.

    Args:
        coefficients: The highest power first: ``polyroots2(1, -3, 2)`` has the roots 1 and 2.
    """
    if not all(map(math.isfinite, coefficients)):
        return ()
    with np.errstate(all="ignore"):
        try:
            roots = np.roots(coefficients)
        except np.linalg.LinAlgError:
            return ()  # the leading coefficient is relatively too small
        is_real = np.abs(roots.imag) <= IMAGINARY_NOISE * np.maximum(1.0, np.abs(roots))
        polished = _polished(np.array(coefficients), roots.real[is_real])
    return tuple(sorted(polished))


def _polished(coefficients: np.ndarray[tuple[int], np.dtype[np.float64]], roots: object) -> list[float]:
    """Refine real roots by two Newton steps, since the eigenvalues of ``np.roots`` are less accurate."""
    slope = np.polyder(coefficients)
    distinct: list[float] = []
    for root in np.asarray(roots, dtype=np.float64).tolist():
        x = float(root)
        for _ in range(2):
            step = float(np.polyval(coefficients, x)) / (float(np.polyval(slope, x)) or math.inf)
            x -= step if abs(step) < IMAGINARY_NOISE * max(1.0, abs(x)) else 0.0
        distinct.append(x)
    return distinct


def opposite_angle(a: float, b: float, c: float) -> tuple[float, ...]:
    """Return the angle opposite to side a, between the sides b and c, with both signs [rad] (``SSSA``)."""
    try:
        foot = (a * a + b * b - c * c) / (2 * b)  # the projection of a on b
        angle = math.atan2(math.sqrt((a - foot) * (a + foot)), b - foot)
    except (ValueError, ZeroDivisionError):
        return ()
    return () if math.isnan(angle) else (angle, -angle)


def next_angle(a: float, gamma: float, b: float) -> tuple[float, ...]:
    """Return the angle opposite to side a of a triangle whose sides a and b enclose ``gamma`` [rad] (``SASA``)."""
    if not (math.isfinite(gamma) and math.isfinite(a) and math.isfinite(b)):
        return ()
    return (math.atan2(a * math.sin(gamma), b - a * math.cos(gamma)),)


def third_side(a: float, gamma: float, b: float) -> tuple[float, ...]:
    """Return the side opposite to the angle ``gamma`` that the sides a and b enclose (``SASS``)."""
    if not math.isfinite(gamma):
        return ()
    square = a * a + b * b - 2 * a * b * math.cos(gamma)
    return () if math.isnan(square) else (math.sqrt(max(square, 0.0)),)


EPSILON = 1e-12  # tolerance of comparisons; fparser's default for doubles
NAN, INFINITY = math.nan, math.inf
Bools = NDArray[np.bool_]
Scalar = Callable[..., float]
Array = Callable[..., Floats]
Roots = Callable[..., tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class Function:
    """Function or operator.

    Attributes:
        arity: Number of arguments.
        scalar: Function of floats that returns a float.
        array: Function of arrays of one shape that returns such an array; it may warn, so use ``np.errstate``.
        roots: For multivalued functions, a function of floats that returns all values, best first; else None.
        most_roots: Maximum number of values.
    """

    arity: int
    scalar: Scalar
    array: Array
    roots: Roots | None = None
    most_roots: int = 1


def _total(function: Callable[[float], float]) -> Callable[[float], float]:
    """Wrap a function of ``math`` to return nan or infinity instead of raising an exception."""

    def guarded(x: float) -> float:
        try:
            return function(x)
        except ValueError:
            return NAN
        except OverflowError:
            return math.copysign(INFINITY, x)

    return guarded


def _rounding(function: Callable[[float], float]) -> Callable[[float], float]:
    """Wrap a rounding function to return infinity and nan unchanged."""

    def rounded(x: float) -> float:
        return float(function(x)) if math.isfinite(x) else x

    return rounded


def _divide(x: float, y: float) -> float:
    return x / y if y else NAN


def _divide_arrays(x: Floats, y: Floats) -> Floats:
    return np.where(y == 0, NAN, x / y)


def _modulo(x: float, y: float) -> float:
    try:
        return math.fmod(x, y)
    except ValueError:
        return NAN


def _power(x: float, y: float) -> float:
    if x == 0 and y < 0:
        return NAN  # a division by zero
    try:
        return math.pow(x, y)
    except ValueError:
        return NAN
    except OverflowError:
        is_odd = abs(math.fmod(y, 2.0)) == 1.0
        return -INFINITY if x < 0 and is_odd else INFINITY


def _power_arrays(x: Floats, y: Floats) -> Floats:
    return np.where((x == 0) & (y < 0), NAN, np.power(x, y))


def _nearest(x: float) -> float:
    return math.copysign(math.floor(abs(x) + 0.5), x)  # halves are rounded away from zero


def _nearest_arrays(x: Floats) -> Floats:
    return np.copysign(np.floor(np.abs(x) + 0.5), x)


def is_true(x: float) -> bool:
    """Return whether a number used as a condition is true: whether its nearest integer is not 0."""
    return abs(x) >= 0.5


def _are_true(x: Floats) -> Bools:
    return np.abs(x) >= 0.5


def _equal(x: float, y: float) -> bool:
    return x == y or abs(x - y) <= EPSILON


def _are_equal(x: Floats, y: Floats) -> Bools:
    return (x == y) | (np.abs(x - y) <= EPSILON)


def _unary(scalar: Callable[[float], float], array: Callable[[Floats], Floats]) -> Function:
    return Function(1, scalar, array)


def _binary(scalar: Callable[[float, float], float], array: Callable[[Floats, Floats], Floats]) -> Function:
    return Function(2, scalar, array)


def _test(scalar: Callable[[float, float], bool], array: Callable[[Floats, Floats], Bools]) -> Function:
    """Make an operator whose result is 1 or 0."""
    return _binary(lambda x, y: 1.0 if scalar(x, y) else 0.0, lambda x, y: array(x, y).astype(np.float64))


def _inverse(scalar: Callable[[float], float], array: Callable[[Floats], Floats]) -> Function:
    """Create the reciprocal 1 / f of a function f."""
    return _unary(lambda x: _divide(1.0, scalar(x)), lambda x: _divide_arrays(np.ones_like(x), array(x)))


def _logarithm(scalar: Callable[[float], float], array: Callable[[Floats], Floats]) -> Function:
    return _unary(_total(scalar), lambda x: np.where(x > 0, array(x), NAN))


def _if(condition: float, x: float, y: float) -> float:
    return x if is_true(condition) else y


def _if_arrays(condition: Floats, x: Floats, y: Floats) -> Floats:
    return np.where(_are_true(condition), x, y)


def _several(arity: int, roots: Roots, most_roots: int) -> Function:
    """Make a multivalued function, whose scalar and array forms return the first value."""
    return replace(_root(arity, roots, 0), roots=roots, most_roots=most_roots)


def _root(arity: int, roots: Roots, index: int) -> Function:
    """Create a function that returns the root number ``index``, or nan if ``roots`` returns fewer."""

    def root(*arguments: float) -> float:
        values = roots(*arguments)
        return values[index] if index < len(values) else NAN

    return Function(arity, root, np.vectorize(root, otypes=[np.float64]))


def nth(function: str, index: int) -> str:
    """Return the internal name of the function that returns value ``index`` of a multivalued function."""
    return f"{function}#{index}"


_tan, _sin, _cos, _cosh = (_total(f) for f in (math.tan, math.sin, math.cos, math.cosh))

OPERATORS: dict[str, Function] = {
    "or": _test(lambda x, y: is_true(x) or is_true(y), lambda x, y: _are_true(x) | _are_true(y)),
    "and": _test(lambda x, y: is_true(x) and is_true(y), lambda x, y: _are_true(x) & _are_true(y)),
    "not": _unary(lambda x: 0.0 if is_true(x) else 1.0, lambda x: (~_are_true(x)).astype(np.float64)),
    "eq": _test(_equal, _are_equal),
    "ne": _test(lambda x, y: not _equal(x, y), lambda x, y: ~_are_equal(x, y)),
    "lt": _test(lambda x, y: x < y - EPSILON, lambda x, y: x < y - EPSILON),
    "le": _test(lambda x, y: x <= y + EPSILON, lambda x, y: x <= y + EPSILON),
    "gt": _test(lambda x, y: x > y + EPSILON, lambda x, y: x > y + EPSILON),
    "ge": _test(lambda x, y: x >= y - EPSILON, lambda x, y: x >= y - EPSILON),
    "add": _binary(operator.add, np.add),
    "sub": _binary(operator.sub, np.subtract),
    "mul": _binary(operator.mul, np.multiply),
    "div": _binary(_divide, _divide_arrays),
    "mod": _binary(_modulo, np.fmod),
    "neg": _unary(lambda x: -x, np.negative),
}

NAMED: dict[str, Function] = {
    "abs": _unary(math.fabs, np.abs),
    "acos": _unary(_total(math.acos), np.arccos),
    "acosh": _unary(_total(math.acosh), np.arccosh),
    "asin": _unary(_total(math.asin), np.arcsin),
    "asinh": _unary(math.asinh, np.arcsinh),
    "atan": _unary(math.atan, np.arctan),
    "atan2": _binary(math.atan2, np.arctan2),
    "atanh": _unary(_total(math.atanh), lambda x: np.where(np.abs(x) < 1, np.arctanh(x), NAN)),
    "cbrt": _unary(math.cbrt, np.cbrt),
    "ceil": _unary(_rounding(math.ceil), np.ceil),
    "cos": _unary(_cos, np.cos),
    "cosh": _unary(lambda x: _cosh(abs(x)), np.cosh),
    "cot": _inverse(_tan, np.tan),
    "csc": _inverse(_sin, np.sin),
    "exp": _unary(_total(math.exp), np.exp),
    "exp2": _unary(_total(math.exp2), np.exp2),
    "floor": _unary(_rounding(math.floor), np.floor),
    "hypot": _binary(math.hypot, np.hypot),
    "if": Function(3, _if, _if_arrays),
    "int": _unary(_rounding(_nearest), _nearest_arrays),
    "log": _logarithm(math.log, np.log),
    "log10": _logarithm(math.log10, np.log10),
    "log2": _logarithm(math.log2, np.log2),
    "max": _binary(lambda x, y: x if x > y else y, lambda x, y: np.where(x > y, x, y)),
    "min": _binary(lambda x, y: x if x < y else y, lambda x, y: np.where(x < y, x, y)),
    "pow": _binary(_power, _power_arrays),
    "sec": _inverse(_cos, np.cos),
    "sin": _unary(_sin, np.sin),
    "sinh": _unary(_total(math.sinh), np.sinh),
    "sqrt": _unary(_total(math.sqrt), np.sqrt),
    "tan": _unary(_tan, np.tan),
    "tanh": _unary(math.tanh, np.tanh),
    "trunc": _unary(_rounding(int), np.trunc),
    "SSSA": _several(3, opposite_angle, 2),
    "SASA": _several(3, next_angle, 1),
    "SASS": _several(3, third_side, 1),
} | {f"polyroots{degree}": _several(degree + 1, real_roots, degree) for degree in range(2, 9)}

_ROOTS: dict[str, Function] = {
    nth(name, index): _root(function.arity, function.roots, index)
    for name, function in NAMED.items()
    if function.roots is not None and function.most_roots > 1
    for index in range(function.most_roots)
}

FUNCTIONS = OPERATORS | NAMED | _ROOTS
