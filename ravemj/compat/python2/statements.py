"""Conversion of constructs that are valid in Python 3 with another meaning."""

import ast

from ravemj.compat.python2 import methods

METHOD, MESSAGE, CODE, ITEM = "__method__", "__message__", "__code__", "__item__"
"""Names of helpers that call methods, read ``error.message``, compile for ``exec`` and ``eval``, and read numbers."""
_ERROR = "__error__"
_EXC_INFO = ["exc_type", "exc_value", "exc_traceback"]
_ORDER = {"__lt__": "<", "__le__": "<=", "__gt__": ">", "__ge__": ">=", "__eq__": "==", "__ne__": "!="}


class Statements(ast.NodeTransformer):
    """Converts a tree to its meaning in Python 2, except for division, see ``Division``.

    Args:
        targets: The original tuple targets of parameters and exceptions, by their replacement names.
    """

    def __init__(self, targets: dict[str, str]) -> None:
        self._targets = targets
        self._scopes: list[ast.AST] = []  # visited scopes, the innermost last
        self._globals: list[str] = []  # declarations of the innermost scope

    def _visit_scope(self, node: ast.Module | ast.FunctionDef | ast.ClassDef) -> None:
        """Visit a module, function or class; move its ``global`` statements to the start, as Python 3 requires."""
        outer, self._globals = self._globals, []
        self._scopes.append(node)
        self.generic_visit(node)
        self._scopes.pop()
        if self._globals:
            node.body.insert(_start(node.body), ast.Global(self._globals))
        self._globals = outer

    def visit_Module(self, node: ast.Module) -> ast.AST:
        """Visit the module as a scope."""
        self._visit_scope(node)
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        """Unpack tuple parameters first."""
        start = _start(node.body)
        node.body[start:start] = [_at(node, f"{self._targets[name]} = {name}") for name in self._names(node.args)]
        self._visit_scope(node)
        return node

    def visit_Global(self, node: ast.Global) -> ast.AST:
        """Record the declaration."""
        self._globals += node.names
        return ast.copy_location(ast.Pass(), node)

    def visit_ImportFrom(self, node: ast.ImportFrom) -> ast.AST:
        """Convert ``import *`` in functions, which Python 3 forbids: its names become global."""
        if node.names[0].name == "*" and isinstance(self._scopes[-1], ast.FunctionDef):
            return _at(node, f"exec({ast.unparse(node)!r}, globals())")
        return node

    def visit_Lambda(self, node: ast.Lambda) -> ast.AST:
        """Unpack tuples: ``lambda (a, b): c`` becomes ``lambda t: [c for ((a, b),) in [(t,)]][0]``."""
        self.generic_visit(node)
        names = self._names(node.args)
        if names:
            targets = "".join(f"{self._targets[name]}, " for name in names)
            first = _expression(node, f"[None for ({targets}) in [({', '.join(names)},)]][0]")
            assert isinstance(first, ast.Subscript)
            assert isinstance(first.value, ast.ListComp)
            first.value.elt = node.body
            node.body = first
        return node

    def _names(self, arguments: ast.arguments) -> list[str]:
        return [argument.arg for argument in arguments.args if argument.arg in self._targets]

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.AST:
        """Add ``next``, comparison by ``__cmp__`` or identity, and a hash for classes with ``__eq__``."""
        self._visit_scope(node)
        own = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
        is_plain = all(isinstance(base, ast.Name) and base.id == "object" for base in node.bases)
        added: dict[str, str] = {}
        if "next" in own:
            added["__next__"] = "__next__ = next"
        if "__cmp__" in own:
            for name, sign in _ORDER.items():
                added[name] = f"def {name}(self, other): return self.__cmp__(other) {sign} 0"
        elif is_plain and own.isdisjoint(_ORDER):
            added["__lt__"] = "def __lt__(self, other): return id(self) < id(other)"
        if is_plain and ("__eq__" in own or "__cmp__" in own):
            added["__hash__"] = "__hash__ = object.__hash__"
        node.body += [_at(node, text) for name, text in added.items() if name not in own]
        return node

    def visit_ExceptHandler(self, node: ast.ExceptHandler) -> ast.AST:
        """Keep the exception after ``except E, name:``, since Python 3 deletes the name; unpack tuple targets."""
        self.generic_visit(node)
        if node.name is not None:
            target = self._targets.get(node.name, node.name)
            is_tuple = isinstance(ast.parse(target, mode="eval").body, ast.Tuple | ast.List)
            node.body.insert(0, _at(node, f"{target} = {_ERROR}{'.args' if is_tuple else ''}"))
            node.name = _ERROR
        return node

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        """Compare ``array == None`` as a whole, like NumPy before 1.13, instead of element by element."""
        self.generic_visit(node)
        operands = [node.left, *node.comparators]
        for place, operator in enumerate(node.ops):
            if any(isinstance(side, ast.Constant) and side.value is None for side in operands[place : place + 2]):
                is_same: dict[type[ast.cmpop], ast.cmpop] = {ast.Eq: ast.Is(), ast.NotEq: ast.IsNot()}
                node.ops[place] = is_same.get(type(operator), operator)
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """Redirect removed methods; convert the arguments of ``exec``, ``eval`` and ``float``."""
        self.generic_visit(node)
        if isinstance(node.func, ast.Attribute) and node.func.attr in methods.NAMES:
            node.args[:0] = [node.func.value, ast.Constant(node.func.attr)]
            node.func = ast.Name(METHOD, ast.Load())
        elif isinstance(node.func, ast.Name) and node.args:
            if node.func.id in {"exec", "eval"}:
                node.args[0] = ast.Call(ast.Name(CODE, ast.Load()), [node.args[0], ast.Constant(node.func.id)], [])
            elif node.func.id in {"float", "int", "long"}:
                node.args[0] = ast.Call(ast.Name(ITEM, ast.Load()), [node.args[0]], [])
        return node

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """Convert ``message`` of exceptions, and ``sys.exc_type`` and similar names."""
        self.generic_visit(node)
        if isinstance(node.value, ast.Name) and node.value.id == "sys" and node.attr in _EXC_INFO:
            return _expression(node, f"sys.exc_info()[{_EXC_INFO.index(node.attr)}]")
        if node.attr == "message" and isinstance(node.ctx, ast.Load):
            return ast.Call(ast.Name(MESSAGE, ast.Load()), [node.value], [])
        return node


def _start(body: list[ast.stmt]) -> int:
    """Return the index of the first statement after the docstring and imports from ``__future__``."""
    for number, statement in enumerate(body):
        is_docstring = number == 0 and isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
        if not is_docstring and not (isinstance(statement, ast.ImportFrom) and statement.module == "__future__"):
            return number
    return len(body)


def _expression(place: ast.expr, text: str) -> ast.expr:
    """Parse an expression into a syntax tree with the source position of the node ``place``."""
    statement = _at(place, text)
    assert isinstance(statement, ast.Expr)
    return statement.value


def _at(place: ast.stmt | ast.expr | ast.excepthandler, text: str) -> ast.stmt:
    """Parse a statement into a syntax tree with the source position of the node ``place``."""
    statement = ast.parse(text).body[0]
    for node in ast.walk(statement):
        ast.copy_location(node, place)
    return statement
