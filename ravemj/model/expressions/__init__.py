"""The language of mimic equations.

OpenRAVE parses mimic equations with the library fparser 4.5. This package implements the same language without
executing code: text is parsed to a tree, and only the tree is evaluated.

>>> follower = parse(substitute("JF1/3+0.8727", joint_variables(["JF1"])), {"joint0"})
>>> follower.evaluate({"joint0": 0.3})
0.9727
>>> str(follower.derivative("joint0"))
'0.3333333333333333'
>>> follower.polynomial("joint0")
(0.8727, 0.3333333333333333)

Malicious text can only raise ``ExpressionError``: the length, the nesting depth and the number of values are bounded,
and evaluation time is proportional to the length.
"""

from ravemj.model.expressions.attributes import before_substitution, joint_variables, linear_mimic, partials, substitute
from ravemj.model.expressions.expression import Expression, parse
from ravemj.model.expressions.nodes import ExpressionError
from ravemj.model.expressions.polynomial_fit import fit_polynomial

__all__ = [
    "Expression",
    "ExpressionError",
    "before_substitution",
    "fit_polynomial",
    "joint_variables",
    "linear_mimic",
    "parse",
    "partials",
    "substitute",
]
