"""The reference of the API: what users call, topic by topic, with the types as the source writes them.

The API's big classes are joined from parts, one for each topic. Autodoc would list what they inherit by name, or leave
it out; here each part is a group, with its summary as the heading. Functions and enumerations are listed as they are::

    .. reference::
       :without: KinBody

       Robot
"""

import ast
import enum
import functools
import inspect
import pkgutil
import textwrap
from collections.abc import Iterator
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import SphinxDirective

_BASES = {"object", "Shown"}


class Reference(SphinxDirective):
    """Names of ravemj, each with its docstring; classes with their members."""

    has_content = True
    option_spec: ClassVar = {
        "without": directives.unchanged,  # a base class that has a page of its own
        "plain": directives.flag,  # no members
    }

    def run(self) -> list[nodes.Node]:
        """Return what autodoc makes of them."""
        lines: list[str] = []
        for name in " ".join(self.content).split():
            thing = pkgutil.resolve_name(f"ravemj.{name}")
            lines.append(f".. {_directive(thing)}:: ravemj.{name}\n")
            if inspect.isclass(thing) and issubclass(thing, enum.Enum):
                lines += _values(thing)
            elif inspect.isclass(thing) and "plain" not in self.options:
                lines += _groups(thing, name, self.options.get("without", ""))
        return self.parse_text_to_nodes("\n".join(lines))


def _directive(thing: object) -> str:
    if inspect.isclass(thing):
        return "autoexception" if issubclass(thing, BaseException) else "autoclass"
    if isinstance(thing, property | functools.cached_property):
        return "autoproperty"
    return "automethod" if "." in getattr(thing, "__qualname__", "") else "autofunction"


def _values(kind: type[enum.Enum]) -> Iterator[str]:
    values = ", ".join(f"``{name}`` = {member.value:d}" for name, member in kind.__members__.items())
    yield f"   {values}\n"


def _groups(kind: type, path: str, without: str) -> Iterator[str]:
    """Yield the lines below a class."""
    bases = [base for base in kind.__mro__ if base.__name__ not in _BASES and base.__module__.startswith("ravemj")]
    seen = {name for base in bases if base.__name__ == without for name in dir(base)}
    for base in bases:
        own = [name for name in vars(base) if name in dir(kind) and name[0] != "_" and name not in seen]
        members = [(name, inspect.getattr_static(kind, name)) for name in own if _is_called_or_read(kind, name)]
        lines = [f"   .. {_directive(member)}:: ravemj.{path}.{name}\n" for name, member in members]
        seen.update(own)
        if lines and base is not kind:
            summary = (inspect.getdoc(base) or base.__name__).splitlines()[0]
            yield f"   .. rubric:: {summary.rstrip('.')}\n      :heading-level: 2\n"
        yield from lines


def _is_called_or_read(kind: type, name: str) -> bool:
    member = inspect.getattr_static(kind, name)
    return isinstance(member, property | functools.cached_property) or inspect.isroutine(getattr(kind, name))


def written_signature(
    app: Sphinx, what: str, name: str, member: object, options: object, signature: str | None, answer: str | None
) -> tuple[str | None, str | None]:
    """Return arguments and answer with the types that the source writes, not with what these stand for."""
    del app, name, options
    if inspect.isclass(member) and not _is_called(member):
        return "", None
    made_of: Any = member.__init__ if inspect.isclass(member) else getattr(member, "__func__", member)
    function = inspect.unwrap(made_of)
    if hasattr(function, "capability"):  # what ravemj lacks: the source of all is one function
        return signature, answer
    try:
        (definition,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
    except (OSError, TypeError):  # made by a dataclass, or not in Python
        return signature, answer
    if not isinstance(definition, ast.FunctionDef):
        return signature, answer
    arguments = definition.args
    if what != "function" and (what == "class" or inspect.ismethod(member) or not _is_static(definition)):
        (arguments.posonlyargs or arguments.args).pop(0)
    for argument in ast.walk(arguments):
        if isinstance(argument, ast.arg):
            argument.annotation = _unquoted(argument.annotation)
    returned = _unquoted(definition.returns)
    return f"({ast.unparse(arguments)})", ast.unparse(returned) if returned and what != "class" else None


def _is_called(kind: type) -> bool:
    """Return whether users make objects of a class: its arguments are explained."""
    return any("Args:" in (text or "") for text in (kind.__doc__, kind.__init__.__doc__))


def _is_static(definition: ast.FunctionDef) -> bool:
    return any(isinstance(mark, ast.Name) and mark.id == "staticmethod" for mark in definition.decorator_list)


def _unquoted(annotation: ast.expr | None) -> ast.expr | None:
    if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
        return ast.parse(annotation.value, mode="eval").body
    return annotation


def untyped_answers(app: Sphinx, what: str, name: str, member: object, options: object, lines: list[str]) -> None:
    """Tell napoleon that what comes before a colon in our answers is no type: signatures have those."""
    del app, name, member, options
    if what == "property" and lines:
        lines[0] = f": {lines[0]}"
    for number, line in enumerate(lines[:-1]):
        if line.strip() == "Returns:":
            text = lines[number + 1]
            lines[number + 1] = text[: len(text) - len(text.lstrip())] + f": {text.lstrip()}"


def named_by_last_word(app: Sphinx, env: BuildEnvironment, node: pending_xref, text: nodes.Element) -> object:
    """Return the link to what has a longer name: ``WebViewer`` for ``ravemj.gui.viewers.web.WebViewer``."""
    if node.get("refdomain") != "py":
        return None
    domain = env.domains.python_domain
    names = [name for name in domain.objects if name.endswith(f".{node['reftarget']}")]
    if len(names) != 1:
        return None
    return domain.resolve_xref(env, node["refdoc"], app.builder, node["reftype"], names[0], node, text)


def setup(app: Sphinx) -> dict[str, bool]:
    """Make the directive known, prepare signatures and answers for napoleon, and find short names."""
    app.add_directive("reference", Reference)
    app.connect("autodoc-process-signature", written_signature)
    app.connect("autodoc-process-docstring", untyped_answers, priority=400)
    app.connect("missing-reference", named_by_last_word)
    return {"parallel_read_safe": True}
