"""Division of Python 2, which rounds down for integers."""

# Operands of old scripts have no types.
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownParameterType=false

import ast
import operator
from typing import Any

import numpy as np

DIVIDE, DIVISOR = "__divide__", "__divisor__"
"""Names of ``divide`` and ``Divisor`` for scripts."""


class Division(ast.NodeTransformer):
    """Replaces ``a / b`` and ``a /= b`` by calls of ``divide`` and ``Divisor``."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Change ``a / b``."""
        self.generic_visit(node)
        if not isinstance(node.op, ast.Div):
            return node
        call = ast.Call(ast.Name(DIVIDE, ast.Load()), [node.left, node.right], [])
        return ast.copy_location(call, node)

    def visit_AugAssign(self, node: ast.AugAssign) -> ast.AST:
        """Change ``a /= b``."""
        self.generic_visit(node)
        if isinstance(node.op, ast.Div):
            call = ast.Call(ast.Name(DIVISOR, ast.Load()), [node.value], [])
            node.value = ast.copy_location(call, node.value)
        return node


def divide(left: Any, right: Any) -> Any:
    """Divide like Python 2."""
    if hasattr(type(left), "__div__"):
        return left.__div__(right)
    if not hasattr(type(left), "__truediv__") and hasattr(type(right), "__rdiv__"):
        return right.__rdiv__(left)
    return left // right if _is_whole(left) and _is_whole(right) else left / right


class Divisor:
    """Right side of ``a /= b``: the left side is of unknown type, so Python calls the methods of this class."""

    def __init__(self, value: Any) -> None:
        self._value = value

    def __rtruediv__(self, left: Any) -> Any:
        if hasattr(type(left), "__idiv__"):
            return left.__idiv__(self._value)
        if hasattr(type(left), "__div__"):
            return left.__div__(self._value)
        whole = _is_whole(left) and _is_whole(self._value)
        return operator.ifloordiv(left, self._value) if whole else operator.itruediv(left, self._value)

    def __array_ufunc__(self, ufunc: Any, method: str, left: Any, right: object, **options: Any) -> Any:
        """Divide an array in place; numpy calls this."""
        del method, right
        divide = np.floor_divide if _is_whole(left) and _is_whole(self._value) else ufunc
        return divide(left, self._value, **options)


def _is_whole(value: object) -> bool:
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "biu"
    return isinstance(value, int | np.integer)
