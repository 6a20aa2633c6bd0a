"""Derivatives of expressions, by the chain rule over the nodes in order.

Each node adds a few new nodes, so the size of a derivative is proportional to that of the equation.
"""

import math
from collections.abc import Callable, Sequence

from ravemj.model.expressions.nodes import Call, Graph, Node, Number, Variable

Outer = Callable[["Algebra", Node, Node], Node]
Rule = Callable[["Algebra", Call, Sequence[Node]], Node]


class Algebra:
    """Arithmetic on nodes that simplifies operations with 0 and 1."""

    def __init__(self, graph: Graph) -> None:
        self.call = graph.call
        self.number = graph.number

    def add(self, x: Node, y: Node) -> Node:
        """Return x + y."""
        if is_number(x, 0.0):
            return y
        return x if is_number(y, 0.0) else self.call("add", x, y)

    def sub(self, x: Node, y: Node) -> Node:
        """Return x - y."""
        if is_number(x, 0.0):
            return self.neg(y)
        return x if is_number(y, 0.0) else self.call("sub", x, y)

    def mul(self, x: Node, y: Node) -> Node:
        """Return x * y; a factor 0 gives 0 even if the other is undefined."""
        if is_number(x, 0.0) or is_number(y, 0.0):
            return self.number(0.0)
        if is_number(x, 1.0):
            return y
        return x if is_number(y, 1.0) else self.call("mul", x, y)

    def div(self, x: Node, y: Node) -> Node:
        """Return x / y; a numerator 0 gives 0 even if y is undefined."""
        if is_number(x, 0.0) or is_number(y, 1.0):
            return x
        return self.call("div", x, y)

    def neg(self, x: Node) -> Node:
        """Return -x."""
        if isinstance(x, Call) and x.function == "neg":
            return x.arguments[0]
        return self.number(0.0) if is_number(x, 0.0) else self.call("neg", x)

    def square(self, x: Node) -> Node:
        """Return x * x."""
        return self.mul(x, x)

    def inverse(self, x: Node) -> Node:
        """Return 1 / x."""
        return self.div(self.number(1.0), x)

    def choose(self, condition: Node, x: Node, y: Node) -> Node:
        """Return x if the condition holds, else y."""
        return x if x is y else self.call("if", condition, x, y)

    def one_minus_square(self, x: Node) -> Node:
        """Return 1 - x * x."""
        return self.sub(self.number(1.0), self.square(x))

    def inverse_root(self, x: Node) -> Node:
        """Return 1 / sqrt(x)."""
        return self.inverse(self.call("sqrt", x))


def is_number(node: Node, value: float) -> bool:
    """Return whether a node is the constant ``value``."""
    return isinstance(node, Number) and node.value == value


def derivative(nodes: list[Node], variable: str) -> Node:
    """Return the derivative with respect to a variable of the last of the topologically ordered ``nodes``."""
    algebra = Algebra(Graph(nodes))
    slopes: dict[Node, Node] = {}
    for node in nodes:
        if isinstance(node, Call):
            slopes[node] = _slope(algebra, node, [slopes[argument] for argument in node.arguments])
        else:
            is_it = isinstance(node, Variable) and node.name == variable
            slopes[node] = algebra.number(1.0 if is_it else 0.0)
    return slopes[nodes[-1]]


def _slope(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    """Return the derivative of a function call; ``slopes`` are the derivatives of its arguments."""
    if node.function in _STEPS or all(is_number(slope, 0.0) for slope in slopes):
        return algebra.number(0.0)
    if node.function in _OUTER:
        return algebra.mul(_OUTER[node.function](algebra, node.arguments[0], node), slopes[0])
    if node.function.startswith("polyroots"):
        return _root_slope(algebra, node, slopes)
    return _RULES[node.function.partition("#")[0]](algebra, node, slopes)


def _product(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    (x, y), (dx, dy) = node.arguments, slopes
    return algebra.add(algebra.mul(dx, y), algebra.mul(x, dy))


def _quotient(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    (_, y), (dx, dy) = node.arguments, slopes
    return algebra.div(algebra.sub(dx, algebra.mul(node, dy)), y)


def _remainder(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    (x, y), (dx, dy) = node.arguments, slopes
    return algebra.sub(dx, algebra.mul(algebra.call("trunc", algebra.div(x, y)), dy))


def _power(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    (x, y), (dx, dy) = node.arguments, slopes
    if is_number(y, 0.0):
        return y
    lower = algebra.sub(y, algebra.number(1.0))
    lowered = x if is_number(lower, 1.0) else algebra.call("pow", x, lower)
    of_base = algebra.mul(algebra.mul(y, lowered), dx)
    if is_number(dy, 0.0):
        return of_base
    return algebra.add(of_base, algebra.mul(algebra.mul(node, algebra.call("log", x)), dy))


def _direction(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    return _turn(algebra, *node.arguments, *slopes)


def _turn(algebra: Algebra, y: Node, x: Node, dy: Node, dx: Node) -> Node:
    """Return the derivative of atan2(y, x), given the derivatives of y and x."""
    square = algebra.add(algebra.square(x), algebra.square(y))
    return algebra.div(algebra.sub(algebra.mul(dy, x), algebra.mul(y, dx)), square)


def _length(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    (x, y), (dx, dy) = node.arguments, slopes
    return algebra.div(algebra.add(algebra.mul(x, dx), algebra.mul(y, dy)), node)


def _choice(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    return algebra.choose(node.arguments[0], slopes[1], slopes[2])


def _larger(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    return algebra.choose(algebra.call("gt", *node.arguments), *slopes)


def _smaller(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    return algebra.choose(algebra.call("lt", *node.arguments), *slopes)


def _root_slope(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    """Return the derivative of a root r of a polynomial p: -dp(r) / p'(r), where dp differentiates the coefficients."""
    change, steepness = slopes[0], algebra.number(0.0)
    value = node.arguments[0]
    for coefficient, slope in zip(node.arguments[1:], slopes[1:], strict=True):
        change = algebra.add(algebra.mul(change, node), slope)
        steepness = algebra.add(algebra.mul(steepness, node), value)
        value = algebra.add(algebra.mul(value, node), coefficient)
    return algebra.neg(algebra.div(change, steepness))


def _law_of_cosines(algebra: Algebra, a: Node, b: Node, gamma: Node, slopes: Sequence[Node]) -> tuple[Node, Node]:
    """Return half the derivative of c^2 = a^2 + b^2 - 2 a b cos(gamma), that is c c', in two parts.

    They are the part without gamma', and the factor of gamma'; ``slopes`` are the derivatives of a and b.
    """
    da, db = slopes
    lengths = algebra.add(algebra.mul(a, da), algebra.mul(b, db))
    shadow = algebra.mul(algebra.add(algebra.mul(da, b), algebra.mul(a, db)), algebra.call("cos", gamma))
    factor = algebra.mul(algebra.mul(a, b), algebra.call("sin", gamma))
    return algebra.sub(lengths, shadow), factor


def _opposite_angle(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    (a, b, c), (da, db, dc) = node.arguments, slopes
    d_length = algebra.choose(algebra.call("lt", c, algebra.number(0.0)), algebra.neg(dc), dc)
    rest, factor = _law_of_cosines(algebra, b, algebra.call("abs", c), node, (db, d_length))
    return algebra.div(algebra.sub(algebra.mul(a, da), rest), factor)


def _third_side(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    (a, gamma, b), (da, d_gamma, db) = node.arguments, slopes
    rest, factor = _law_of_cosines(algebra, a, b, gamma, (da, db))
    return algebra.div(algebra.add(rest, algebra.mul(factor, d_gamma)), node)


def _next_angle(algebra: Algebra, node: Call, slopes: Sequence[Node]) -> Node:
    (a, gamma, b), (da, d_gamma, db) = node.arguments, slopes
    sine, cosine = algebra.call("sin", gamma), algebra.call("cos", gamma)
    y, projection = algebra.mul(a, sine), algebra.mul(a, cosine)
    dy = algebra.add(algebra.mul(da, sine), algebra.mul(projection, d_gamma))
    d_projection = algebra.sub(algebra.mul(da, cosine), algebra.mul(y, d_gamma))
    return _turn(algebra, y, algebra.sub(b, projection), dy, algebra.sub(db, d_projection))


_STEPS = {"or", "and", "not", "eq", "ne", "lt", "le", "gt", "ge", "ceil", "floor", "int", "trunc"}

_OUTER: dict[str, Outer] = {  # derivatives f'(x) of functions f of one argument
    "neg": lambda g, x, f: g.number(-1.0),
    "abs": lambda g, x, f: g.choose(g.call("lt", x, g.number(0.0)), g.number(-1.0), g.number(1.0)),
    "acos": lambda g, x, f: g.neg(g.inverse_root(g.one_minus_square(x))),
    "acosh": lambda g, x, f: g.inverse_root(g.sub(g.square(x), g.number(1.0))),
    "asin": lambda g, x, f: g.inverse_root(g.one_minus_square(x)),
    "asinh": lambda g, x, f: g.inverse_root(g.add(g.square(x), g.number(1.0))),
    "atan": lambda g, x, f: g.inverse(g.add(g.square(x), g.number(1.0))),
    "atanh": lambda g, x, f: g.inverse(g.one_minus_square(x)),
    "cbrt": lambda g, x, f: g.inverse(g.mul(g.number(3.0), g.square(f))),
    "cos": lambda g, x, f: g.neg(g.call("sin", x)),
    "cosh": lambda g, x, f: g.call("sinh", x),
    "cot": lambda g, x, f: g.neg(g.square(g.call("csc", x))),
    "csc": lambda g, x, f: g.neg(g.mul(f, g.call("cot", x))),
    "exp": lambda g, x, f: f,
    "exp2": lambda g, x, f: g.mul(g.number(math.log(2.0)), f),
    "log": lambda g, x, f: g.inverse(x),
    "log10": lambda g, x, f: g.div(g.number(1.0 / math.log(10.0)), x),
    "log2": lambda g, x, f: g.div(g.number(1.0 / math.log(2.0)), x),
    "sec": lambda g, x, f: g.mul(f, g.call("tan", x)),
    "sin": lambda g, x, f: g.call("cos", x),
    "sinh": lambda g, x, f: g.call("cosh", x),
    "sqrt": lambda g, x, f: g.div(g.number(0.5), f),
    "tan": lambda g, x, f: g.add(g.square(f), g.number(1.0)),
    "tanh": lambda g, x, f: g.one_minus_square(f),
}

_RULES: dict[str, Rule] = {
    "add": lambda g, node, slopes: g.add(*slopes),
    "sub": lambda g, node, slopes: g.sub(*slopes),
    "mul": _product,
    "div": _quotient,
    "mod": _remainder,
    "pow": _power,
    "atan2": _direction,
    "hypot": _length,
    "if": _choice,
    "max": _larger,
    "min": _smaller,
    "SSSA": _opposite_angle,
    "SASA": _next_angle,
    "SASS": _third_side,
}
