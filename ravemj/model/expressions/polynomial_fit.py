"""Polynomial approximation of an expression in one variable, for MuJoCo's ``<joint polycoef>``."""

import math

import numpy as np

from ravemj.model.expressions.expression import Expression
from ravemj.model.expressions.polynomials import Coefficients

FIT_POINTS, CHECK_POINTS = 200, 2001


def fit_polynomial(
    expression: Expression, variable: str, lower: float, upper: float, degree: int = 4
) -> tuple[Coefficients, float]:
    """Approximate an expression in one variable by a polynomial, from ``lower`` to ``upper``.

    The fit is by least squares at Chebyshev points, which nearly minimizes the largest error.

    Returns:
        ``degree + 1`` coefficients in ascending order, and the largest error at evenly spaced points of the range;
        infinite if the expression is undefined at some of them.

    Raises:
        ValueError: If there are other variables, or the range is not finite.
    """
    others = [name for name in expression.variables if name != variable]
    if others or not (math.isfinite(lower) and math.isfinite(upper)):
        raise ValueError(f"cannot fit over {lower} to {upper}" + "".join(f"; {name} is open" for name in others))
    middle, radius = (lower + upper) / 2, abs(upper - lower) / 2 or 1.0
    unit = np.cos(np.pi * (np.arange(FIT_POINTS) + 0.5) / FIT_POINTS)
    points = middle + radius * (unit if lower != upper else 0 * unit)
    values = expression.evaluate_many({variable: points})
    usable = np.isfinite(values)
    if lower == upper or np.count_nonzero(usable) <= degree:
        constant = float(values[usable].mean()) if usable.any() else 0.0
        fitted = np.array([constant] + [0.0] * degree)
    else:
        basis = np.polynomial.Chebyshev.fit(points[usable], values[usable], degree, domain=[lower, upper])
        coefficients = basis.convert(kind=np.polynomial.Polynomial).coef  # trailing zeros are omitted
        fitted = np.pad(coefficients, (0, degree + 1 - len(coefficients)))
    checks = np.linspace(lower, upper, CHECK_POINTS)
    errors = np.abs(np.polynomial.polynomial.polyval(checks, fitted) - expression.evaluate_many({variable: checks}))
    largest = float(errors.max()) if np.isfinite(errors).all() else math.inf
    return tuple(fitted.tolist()), largest
