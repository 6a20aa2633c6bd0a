"""Exact coefficients of expressions that are polynomials in one variable."""

import math
from collections.abc import Callable
from itertools import zip_longest
from typing import NamedTuple

from ravemj.model.expressions.functions import FUNCTIONS
from ravemj.model.expressions.nodes import Call, Node, Number, Variable

MAX_INNER_DEGREE = 16  # of intermediate results: terms of higher degree may cancel

Coefficients = tuple[float, ...]  # ascending


def coefficients(nodes: list[Node], variable: str, max_degree: int) -> Coefficients | None:
    """Return the coefficients of the last of ``nodes`` if it is a polynomial in ``variable`` alone, else None."""
    found: dict[Node, Coefficients | None] = {}
    for node in nodes:
        match node:
            case Number(value):
                found[node] = (value,)
            case Variable(name):
                found[node] = (0.0, 1.0) if name == variable else None
            case Call(function, arguments):
                known = [found[argument] for argument in arguments]
                found[node] = _combine(function, [polynomial for polynomial in known if polynomial is not None])
    result = found[nodes[-1]]
    is_good = result is not None and len(result) <= max_degree + 1 and all(map(math.isfinite, result))
    return result if is_good else None


def _combine(function: str, known: list[Coefficients]) -> Coefficients | None:
    """Return the polynomial that a function makes of polynomials; None if it makes none, or some are missing."""
    definition = FUNCTIONS[function]
    if len(known) < definition.arity or definition.roots is not None:
        return None
    if function in _RULES:
        return _RULES[function](*known)
    if all(len(polynomial) == 1 for polynomial in known):
        return (definition.scalar(*(value for (value,) in known)),)
    return None


def _add(x: Coefficients, y: Coefficients) -> Coefficients:
    return _trimmed([a + b for a, b in zip_longest(x, y, fillvalue=0.0)])


def _subtract(x: Coefficients, y: Coefficients) -> Coefficients:
    return _trimmed([a - b for a, b in zip_longest(x, y, fillvalue=0.0)])


def _negate(x: Coefficients) -> Coefficients:
    return tuple(-value for value in x)


def _multiply(x: Coefficients, y: Coefficients) -> Coefficients | None:
    if len(x) + len(y) > MAX_INNER_DEGREE + 2:
        return None
    product = [0.0] * (len(x) + len(y) - 1)
    for i, a in enumerate(x):
        for j, b in enumerate(y):
            product[i + j] += a * b
    return _trimmed(product)


def _power(base: Coefficients, exponent: Coefficients) -> Coefficients | None:
    if len(base) == 1 and len(exponent) == 1:
        return (FUNCTIONS["pow"].scalar(base[0], exponent[0]),)
    if len(exponent) != 1 or exponent[0] not in range(MAX_INNER_DEGREE + 1):
        return None
    result: Coefficients | None = (1.0,)
    for _ in range(int(exponent[0])):
        result = _multiply(result, base) if result is not None else None
    return result


def _divide(x: Coefficients, y: Coefficients) -> Coefficients | None:
    return tuple(value / y[0] for value in x) if len(y) == 1 and y[0] != 0 else None


def _trimmed(values: list[float]) -> Coefficients:
    while len(values) > 1 and values[-1] == 0:
        values.pop()
    return tuple(values)


_RULES: dict[str, Callable[..., Coefficients | None]] = {
    "add": _add,
    "sub": _subtract,
    "neg": _negate,
    "mul": _multiply,
    "div": _divide,
    "pow": _power,
}


class Affine(NamedTuple):
    """A constant plus multiples of variables.

    Attributes:
        offset: The constant.
        slopes: What each variable is multiplied by.
    """

    offset: float
    slopes: dict[str, float]


def affine(nodes: list[Node]) -> Affine | None:
    """Return the last of ``nodes`` as a constant plus multiples of variables, or None if it is not written as one."""
    found: dict[Node, Affine | None] = {}
    for node in nodes:
        match node:
            case Number(value):
                found[node] = Affine(value, {})
            case Variable(name):
                found[node] = Affine(0.0, {name: 1.0})
            case Call(function, arguments):
                known = [part for part in map(found.__getitem__, arguments) if part is not None]
                rule = _AFFINE_RULES.get(function)
                found[node] = rule(*known) if rule is not None and len(known) == len(arguments) else None
    result = found[nodes[-1]]
    is_finite = result is not None and all(map(math.isfinite, (result.offset, *result.slopes.values())))
    return result if is_finite else None


def _affine_sum(x: Affine, y: Affine) -> Affine:
    slopes = dict(x.slopes)
    for name, slope in y.slopes.items():
        slopes[name] = slopes.get(name, 0.0) + slope
    return Affine(x.offset + y.offset, slopes)


def _affine_difference(x: Affine, y: Affine) -> Affine:
    return _affine_sum(x, _affine_negative(y))


def _affine_negative(x: Affine) -> Affine:
    return _scaled(x, -1.0)


def _scaled(x: Affine, factor: float) -> Affine:
    return Affine(factor * x.offset, {name: factor * slope for name, slope in x.slopes.items()})


def _affine_product(x: Affine, y: Affine) -> Affine | None:
    if x.slopes and y.slopes:
        return None
    return _scaled(x, y.offset) if x.slopes else _scaled(y, x.offset)


def _affine_quotient(x: Affine, y: Affine) -> Affine | None:
    return None if y.slopes or y.offset == 0 else _scaled(x, 1 / y.offset)


_AFFINE_RULES: dict[str, Callable[..., Affine | None]] = {
    "add": _affine_sum,
    "sub": _affine_difference,
    "neg": _affine_negative,
    "mul": _affine_product,
    "div": _affine_quotient,
}
