"""The syntax of Python 2 in that of Python 3, with the lines of the original for tracebacks."""

# fissix has no types.
# pyright: reportMissingTypeStubs=false, reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownParameterType=false

import ast
import functools
import importlib.util
import re
from collections.abc import Callable
from types import CodeType
from typing import TYPE_CHECKING

from ravemj.python2.division import Division

if TYPE_CHECKING:
    from fissix.pytree import Node
    from fissix.refactor import RefactoringTool

_TRUE_DIVISION = re.compile(r"^from\s+__future__\s+import\b[^\n]*\bdivision\b", re.MULTILINE)
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
        module = ast.fix_missing_locations(Division().visit(module))
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
