"""Exact coefficients of expressions that are polynomials."""

import math
from collections.abc import Callable
from typing import NamedTuple

from ravemj.model.expressions.functions import FUNCTIONS
from ravemj.model.expressions.nodes import Call, Node, Number, Variable

MAX_INNER_DEGREE = 16  # maximum degree of intermediate results: terms of higher degree may cancel
MAX_PRODUCTS = 1000  # maximum number of terms in one multiplication, against malicious text

Coefficients = tuple[float, ...]  # ascending

_Polynomial = dict[tuple[str, ...], float]
"""Nonzero coefficients by monomial: the key of x^2 y is ("x", "x", "y"), the key of the constant is ()."""


def coefficients(nodes: list[Node], variable: str, max_degree: int) -> Coefficients | None:
    """Return the coefficients of the last of ``nodes`` if it is a polynomial in ``variable`` alone, else None."""
    terms = _polynomial(nodes)
    if terms is None or any(isinstance(node, Variable) and node.name != variable for node in nodes):
        return None
    degree = max(map(len, terms), default=0)
    return tuple(terms.get((variable,) * power, 0.0) for power in range(degree + 1)) if degree <= max_degree else None


class Affine(NamedTuple):
    """Constant plus multiples of variables.

    Attributes:
        offset: The constant.
        slopes: Factor of each variable.
    """

    offset: float
    slopes: dict[str, float]


def affine(nodes: list[Node]) -> Affine | None:
    """Return the last of ``nodes`` as a constant plus multiples of variables, or None if it is not affine."""
    terms = _polynomial(nodes)
    if terms is None or any(len(variables) > 1 for variables in terms):
        return None
    return Affine(terms.pop((), 0.0), {variable: slope for (variable,), slope in terms.items()})


def _polynomial(nodes: list[Node]) -> _Polynomial | None:
    """Return the last of ``nodes`` as a polynomial, or None if it does not have the form of a polynomial."""
    polynomials: dict[Node, _Polynomial | None] = {}
    for node in nodes:
        match node:
            case Number(value):
                terms = {(): value}
            case Variable(name):
                terms = {(name,): 1.0}
            case Call(function, arguments):
                known = [polynomial for polynomial in map(polynomials.__getitem__, arguments) if polynomial is not None]
                terms = _combined(function, known) if len(known) == len(arguments) else None
        if terms is not None and all(map(math.isfinite, terms.values())):  # otherwise 0 times them may be nan
            polynomials[node] = {variables: factor for variables, factor in terms.items() if factor}
        else:
            polynomials[node] = None
    return polynomials[nodes[-1]]


def _combined(function: str, known: list[_Polynomial]) -> _Polynomial | None:
    """Apply a function to polynomials; return None if the result is not a polynomial."""
    definition = FUNCTIONS[function]
    if all(terms.keys() <= {()} for terms in known) and definition.roots is None:
        return {(): definition.scalar(*(terms.get((), 0.0) for terms in known))}
    return _RULES[function](*known) if function in _RULES else None


def _sum(x: _Polynomial, y: _Polynomial, sign: float = 1.0) -> _Polynomial:
    return x | {variables: x.get(variables, 0.0) + sign * factor for variables, factor in y.items()}


def _difference(x: _Polynomial, y: _Polynomial) -> _Polynomial:
    return _sum(x, y, -1.0)


def _negative(x: _Polynomial) -> _Polynomial:
    return _sum({}, x, -1.0)


def _product(x: _Polynomial, y: _Polynomial) -> _Polynomial | None:
    if len(x) * len(y) > MAX_PRODUCTS:
        return None
    terms: _Polynomial = {}
    for variables, factor in x.items():
        for others, other in y.items():
            both = tuple(sorted(variables + others))
            terms[both] = terms.get(both, 0.0) + factor * other
    return terms if max(map(len, terms), default=0) <= MAX_INNER_DEGREE else None


def _quotient(x: _Polynomial, y: _Polynomial) -> _Polynomial | None:
    return {variables: factor / y[()] for variables, factor in x.items()} if y.keys() == {()} else None


def _power(base: _Polynomial, exponent: _Polynomial) -> _Polynomial | None:
    count = exponent.get((), 0.0)
    if not exponent.keys() <= {()} or count not in range(MAX_INNER_DEGREE + 1):
        return None
    result: _Polynomial | None = {(): 1.0}
    for _ in range(int(count)):
        result = None if result is None else _product(result, base)
    return result


_RULES: dict[str, Callable[..., _Polynomial | None]] = {
    "add": _sum,
    "sub": _difference,
    "neg": _negative,
    "mul": _product,
    "div": _quotient,
    "pow": _power,
}
