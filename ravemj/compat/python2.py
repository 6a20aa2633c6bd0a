"""Scripts written for Python 2, translated while they are read.

fissix changes the syntax and the renamed parts of the standard library; here, division of integers is made to round
down, and the lines of the original are kept for tracebacks.
"""

# fissix has no types, and what old scripts divide has none either.
# pyright: reportMissingTypeStubs=false, reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownParameterType=false

import ast
import functools
import importlib.util
import operator
import os
import re
import sys
import sysconfig
from collections.abc import Callable
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fissix.pytree import Node
    from fissix.refactor import RefactoringTool

_TRUE_DIVISION = re.compile(r"^from\s+__future__\s+import\b[^\n]*\bdivision\b", re.MULTILINE)
_DIVIDE, _DIVISOR = "__divide__", "__divisor__"
_OF_STRING = {"letters": "ascii_letters", "lowercase": "ascii_lowercase", "uppercase": "ascii_uppercase"}
_TAB = 8


def compile_script(source: bytes, path: str) -> CodeType:
    """Translate a script or module and compile it; run it with ``HELPERS`` among its names.

    Args:
        source: Its bytes.
        path: Where it is; the names of its neighbours decide which imports are relative.

    Raises:
        SyntaxError: it is neither Python 2 nor Python 3; file and line are those of the original.
    """
    text = importlib.util.decode_source(source)
    if not text.endswith("\n"):
        text += "\n"
    try:
        tree = _translated(text, path)
    except SyntaxError:
        try:
            return _compile_unchanged(source, path)  # may be of our days
        except SyntaxError:
            pass
        raise
    lines = _original_lines(tree)
    try:
        module = ast.parse(str(tree), path)
    except SyntaxError as error:
        raise _syntax_error(str(error.msg), path, lines[min(error.lineno or 1, len(lines)) - 1], text) from None
    if not _TRUE_DIVISION.search(text):
        module = ast.fix_missing_locations(_Division().visit(module))
    for node in ast.walk(_Strings().visit(module)):
        if isinstance(node, ast.expr | ast.stmt | ast.excepthandler | ast.arg | ast.keyword | ast.alias):
            node.lineno = node.end_lineno = lines[node.lineno - 1]
            node.col_offset = node.end_col_offset = -1  # unknown: the columns of the translation mean nothing
    return compile(module, path, "exec", dont_inherit=True)


def is_python2(path: str) -> bool:
    """Return whether a file is Python 2, and not Python 3."""
    try:
        with open(path, "rb") as file:
            source = file.read()
    except OSError:
        return False
    return not _compiles(_compile_unchanged, source, path) and _compiles(compile_script, source, path)


def _compile_unchanged(source: bytes, path: str) -> CodeType:
    return compile(source, path, "exec", dont_inherit=True)


def _compiles(compiler: Callable[[bytes, str], CodeType], source: bytes, path: str) -> bool:
    try:
        compiler(source, path)
    except (SyntaxError, ValueError):
        return False
    return True


def install_finder(folder: str) -> None:
    """Translate from now on the modules in a folder, and those in folders that are added to ``sys.path``."""
    here = next(place for place, finder in enumerate(sys.meta_path) if finder is PathFinder)
    sys.meta_path.insert(here, _Finder(folder))  # pyright: ignore[reportArgumentType] - has what finders need


class _Finder:
    """Finds what Python's own finder does, and has it translated."""

    def __init__(self, folder: str) -> None:
        self._folder = os.path.realpath(folder)
        self._known = {os.path.realpath(path) for path in sys.path} - {self._folder}
        self._installed = [os.path.realpath(sysconfig.get_path(name)) for name in ("purelib", "platlib", "stdlib")]

    def find_spec(self, fullname: str, path: Any = None, target: ModuleType | None = None) -> ModuleSpec | None:  # noqa: ANN401 - as Python passes it
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and type(spec.loader) is SourceFileLoader and self._is_neighbour(spec.loader.path):
            spec.loader = _Loader(fullname, spec.loader.path)
        return spec

    def _is_neighbour(self, path: str) -> bool:
        path = os.path.realpath(path)
        if any(_is_in(path, folder) for folder in self._installed):
            return False
        added = {os.path.realpath(folder) for folder in sys.path} - self._known
        return any(_is_in(path, folder) for folder in {self._folder, *added})


class _Loader(SourceFileLoader):
    """Translates a module; keeps no byte code, which Python 3 would take for its own."""

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = ModuleType(spec.name)
        module.__dict__.update(HELPERS)
        return module

    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        return compile_script(self.get_data(path), path)


def _is_in(path: str, folder: str) -> bool:
    return path.startswith(os.path.join(folder, ""))


# Syntax


@functools.cache
def _tool() -> "RefactoringTool":
    from fissix import refactor  # noqa: PLC0415 - slow to import

    return refactor.RefactoringTool(refactor.get_fixers_from_package("fissix.fixes"))


def _translated(text: str, path: str) -> "Node":
    """Return the tree of the translation."""
    from fissix.pgen2 import token  # noqa: PLC0415 - slow to import
    from fissix.pgen2.parse import ParseError  # noqa: PLC0415 - slow to import
    from fissix.pgen2.tokenize import TokenError  # noqa: PLC0415 - slow to import

    try:
        tree = _tool().refactor_string(text, path)
    except ParseError as error:
        line = error.context[1][0]
        raise _syntax_error("invalid syntax", path, line, text) from None
    except TokenError as error:
        message, (line, _) = error.args
        raise _syntax_error(str(message), path, line, text) from None
    assert tree is not None
    for leaf in tree.leaves():
        leaf.prefix = leaf.prefix.expandtabs(_TAB)  # Python 2 lets tabs and spaces be mixed
        if leaf.type == token.INDENT:
            leaf.value = leaf.value.expandtabs(_TAB)
    return tree


def _original_lines(tree: "Node") -> list[int]:
    """Return for each line of the translation the line that it comes from."""
    lines = [1]
    for leaf in tree.leaves():
        for _ in range(leaf.prefix.count("\n")):
            lines.append(lines[-1])
        if leaf.lineno:
            lines[-1] = leaf.lineno
        for _ in range(leaf.value.count("\n")):
            lines.append(lines[-1])
    return lines


def _syntax_error(message: str, path: str, line: int, text: str) -> SyntaxError:
    lines = text.splitlines()
    return SyntaxError(message, (path, line, None, lines[line - 1] if 0 < line <= len(lines) else None))


class _Strings(ast.NodeTransformer):
    """Renames what is called otherwise in the module ``string``."""

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        self.generic_visit(node)
        if isinstance(node.value, ast.Name) and node.value.id == "string":
            node.attr = _OF_STRING.get(node.attr, node.attr)
        return node


# Division


class _Division(ast.NodeTransformer):
    """Puts helpers in the place of ``a / b`` and ``a /= b``."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        if not isinstance(node.op, ast.Div):
            return node
        call = ast.Call(ast.Name(_DIVIDE, ast.Load()), [node.left, node.right], [])
        return ast.copy_location(call, node)

    def visit_AugAssign(self, node: ast.AugAssign) -> ast.AST:
        self.generic_visit(node)
        if isinstance(node.op, ast.Div):
            call = ast.Call(ast.Name(_DIVISOR, ast.Load()), [node.value], [])
            node.value = ast.copy_location(call, node.value)
        return node


def _divide(left: Any, right: Any) -> Any:  # noqa: ANN401 - whatever scripts divide
    """Divide as Python 2 does."""
    if hasattr(type(left), "__div__"):
        return left.__div__(right)
    if not hasattr(type(left), "__truediv__") and hasattr(type(right), "__rdiv__"):
        return right.__rdiv__(left)
    return left // right if _is_whole(left) and _is_whole(right) else left / right


class _Divisor:
    """The right side of ``a /= b``, which no left side knows, so that it is asked what to do."""

    def __init__(self, value: Any) -> None:  # noqa: ANN401 - whatever scripts divide by
        self._value = value

    def __rtruediv__(self, left: Any) -> Any:  # noqa: ANN401 - whatever scripts divide
        if hasattr(type(left), "__idiv__"):
            return left.__idiv__(self._value)
        if hasattr(type(left), "__div__"):
            return left.__div__(self._value)
        whole = _is_whole(left) and _is_whole(self._value)
        return operator.ifloordiv(left, self._value) if whole else operator.itruediv(left, self._value)

    def __array_ufunc__(self, ufunc: Any, method: str, left: Any, right: object, **options: Any) -> Any:  # noqa: ANN401
        """Divide an array, into itself; numpy asks for this."""
        del method, right
        divide = np.floor_divide if _is_whole(left) and _is_whole(self._value) else ufunc
        return divide(left, self._value, **options)


def _is_whole(value: object) -> bool:
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "biu"
    return isinstance(value, int | np.integer)


def _compare(left: Any, right: Any) -> int:  # noqa: ANN401 - whatever scripts compare
    return int(left > right) - int(left < right)


HELPERS = {_DIVIDE: _divide, _DIVISOR: _Divisor, "cmp": _compare, "file": open}
"""Names that translated modules use."""
