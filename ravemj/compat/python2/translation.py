"""Translation of Python 2 syntax to Python 3, keeping line numbers for tracebacks."""

# fissix has no types.
# pyright: reportMissingTypeStubs=false, reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownParameterType=false

import ast
import functools
import re
import warnings
from types import CodeType
from typing import TYPE_CHECKING, Any, Literal

from ravemj.compat.python2.division import Division
from ravemj.compat.python2.statements import Statements

if TYPE_CHECKING:
    from fissix.pytree import Node
    from fissix.refactor import RefactoringTool

FIXERS = """
asserts exec execfile exitfunc funcattrs metaclass methodattrs ne nonzero print raise repr throw unicode
"""
"""Fixers of fissix for syntax; ``builtin``, ``methods`` and ``modules`` provide names."""
_OCTAL = re.compile(r"^0(?=[0-7]+$)")
_TAB = 8
_EXCEPT_NAMED = 4  # parts of "except", class, "," or "as", target


def translate(text: str, path: str, mode: Literal["exec", "eval"] = "exec") -> CodeType:
    """Translate and compile a script, a module or an expression; run it with ``builtin.NAMES``.

    Args:
        text: The source.
        path: The path, for tracebacks.
        mode: ``exec`` for statements, ``eval`` for an expression.

    Raises:
        SyntaxError: it is not Python 2; file and line are those of the original.
    """
    if not text.endswith("\n"):
        text += "\n"
    tree = _tree(text, path)
    _enclose_lists(tree)
    targets = _name_targets(tree)
    lines = _original_lines(tree)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SyntaxWarning)  # "\d" was valid
        warnings.simplefilter("ignore", DeprecationWarning)  # the same in Python 3.11
        try:
            module: Any = ast.parse(str(tree), path, mode)
        except SyntaxError as error:
            raise _syntax_error(str(error.msg), path, lines[min(error.lineno or 1, len(lines)) - 1], text) from None
        if not _has_true_division(module):
            Division().visit(module)
        ast.fix_missing_locations(Statements(targets).visit(module))
        for node in ast.walk(module):
            if isinstance(node, ast.expr | ast.stmt | ast.excepthandler | ast.arg | ast.keyword | ast.alias):
                node.lineno = node.end_lineno = lines[node.lineno - 1]
                node.col_offset = node.end_col_offset = -1  # unknown: columns of the translation are meaningless
        return compile(module, path, mode, dont_inherit=True)


def _has_true_division(module: ast.AST) -> bool:
    imports = [node for node in ast.walk(module) if isinstance(node, ast.ImportFrom) and node.module == "__future__"]
    return any(alias.name == "division" for node in imports for alias in node.names)


@functools.cache
def _tool() -> "RefactoringTool":
    from fissix import refactor  # noqa: PLC0415 - slow to import

    return refactor.RefactoringTool([f"fissix.fixes.fix_{name}" for name in FIXERS.split()])


def _tree(text: str, path: str) -> "Node":
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
        leaf.prefix = leaf.prefix.expandtabs(_TAB)  # Python 2 allows mixed tabs and spaces
        if leaf.type == token.INDENT:
            leaf.value = leaf.value.expandtabs(_TAB)
        elif leaf.type == token.NUMBER:
            leaf.value = _OCTAL.sub("0o", leaf.value.rstrip("lL"))
    return tree


def _enclose_lists(tree: "Node") -> None:
    """Add the parentheses that Python 3 requires in ``[x for x in 1, 2]``."""
    from fissix.fixer_util import LParen, RParen  # noqa: PLC0415 - slow to import
    from fissix.pygram import python_symbols  # noqa: PLC0415 - slow to import

    symbols: Any = python_symbols
    for node in tree.pre_order():
        if node.type == symbols.testlist_safe:
            node.insert_child(0, LParen())
            node.append_child(RParen())


def _name_targets(tree: "Node") -> dict[str, str]:
    """Replace tuple targets by names: ``def f((a, b))``, ``except E, (a, b)``; return the tuples by name."""
    from fissix.pgen2 import token  # noqa: PLC0415 - slow to import
    from fissix.pygram import python_symbols  # noqa: PLC0415 - slow to import
    from fissix.pytree import Leaf  # noqa: PLC0415 - slow to import

    symbols: Any = python_symbols
    inner = {symbols.tfplist, symbols.vfplist, symbols.tfpdef, symbols.vfpdef}
    nodes: list[Any] = []
    node: Any
    for node in tree.pre_order():
        if node.type in {symbols.tfpdef, symbols.vfpdef} and node.parent.type not in inner:
            nodes.append(node)
        elif node.type == symbols.except_clause and len(node.children) == _EXCEPT_NAMED:
            _, _, comma, target = node.children
            comma.value, comma.prefix, target.prefix = "as", " ", " "
            nodes += [] if target.type == token.NAME else [target]
    targets = {f"__target_{number}__": str(node).strip() for number, node in enumerate(nodes)}
    for name, node in zip(targets, nodes, strict=True):
        node.replace(Leaf(token.NAME, name, prefix=node.prefix or " "))
    return targets


def _original_lines(tree: "Node") -> list[int]:
    """Return the original line of each line of the translation."""
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
