"""Signatures as written in the source: ``ArrayLike``, not the dozen types of its union.

``?`` in IPython, ``help`` and ``inspect.signature`` show them. The source is parsed on demand.
"""

import ast
import inspect
import pkgutil
from textwrap import dedent
from types import FunctionType
from typing import Any


class _Annotation:
    """Annotation whose ``repr`` is its source, for display in signatures."""

    def __init__(self, source: str) -> None:
        self._source = source

    def __repr__(self) -> str:
        return self._source


class WrittenSignature(inspect.Signature):
    """The signature of a function, computed on demand."""

    __slots__ = ("_evaluated", "_function")

    def __init__(self, function: FunctionType) -> None:
        self._function = function
        self._evaluated: inspect.Signature | None = vars(function).get("__signature__")

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - a slot of the base class that is not filled yet
        if name not in {"_parameters", "_return_annotation"}:
            raise AttributeError(name)
        made = vars(self._function)["__signature__"] = _made(self._function, self._evaluated)
        self._parameters, self._return_annotation = made.parameters, made.return_annotation
        return getattr(self, name)

    def replace(self, **changes: Any) -> inspect.Signature:  # noqa: ANN401 - those of the base class
        """Return a changed copy, which ``inspect`` requests to remove ``self`` from bound methods."""
        plain = inspect.Signature(list(self.parameters.values()), return_annotation=self.return_annotation)
        return plain.replace(**changes)


def show_as_written(thing: object) -> None:
    """Display the signature of a function, or of a class' constructor and public methods, as in the source."""
    if isinstance(thing, type):
        for name, member in tuple(vars(thing).items()):
            if name[0] != "_" or name in {"__init__", "__new__"}:
                show_as_written(None if isinstance(member, type) else member)
        return
    function = getattr(thing, "__func__", thing)
    if not isinstance(function, FunctionType):
        return
    if "__signature__" not in vars(function) or hasattr(function, "__wrapped__"):  # else the source does not say it
        vars(function)["__signature__"] = WrittenSignature(function)


def _made(function: FunctionType, evaluated: inspect.Signature | None) -> inspect.Signature:
    if evaluated is None:
        vars(function).pop("__signature__", None)  # else the next line would ask for it
        evaluated = inspect.signature(function)
    source = inspect.unwrap(function)
    written = _annotations(source) or _fields(source)
    named = {id(known.annotation): name for name, known in evaluated.parameters.items() if name in written}
    parameters = list[inspect.Parameter]()
    for name, parameter in evaluated.parameters.items():
        text = written.get(name if name in written else named.get(id(parameter.annotation), ""))  # a further name
        parameters.append(parameter if text is None else parameter.replace(annotation=_Annotation(text)))
    returned = evaluated.return_annotation
    if returned is not inspect.Signature.empty and "return" in written:
        returned = _Annotation(written["return"])
    return inspect.Signature(parameters, return_annotation=returned)


def _annotations(function: FunctionType) -> dict[str, str]:
    """Return the annotations of a function's arguments and result; none if its source is not available."""
    definition = _definition(function)
    if not isinstance(definition, ast.FunctionDef):
        return {}
    arguments = [node for node in ast.walk(definition.args) if isinstance(node, ast.arg)]
    annotations = {argument.arg: argument.annotation for argument in arguments} | {"return": definition.returns}
    return {name: _text(annotation) for name, annotation in annotations.items() if annotation is not None}


def _fields(constructor: FunctionType) -> dict[str, str]:
    """Return the annotations of a dataclass's fields, given its generated constructor."""
    try:
        kind = pkgutil.resolve_name(f"{constructor.__module__}:{constructor.__qualname__.rpartition('.')[0]}")
    except (AttributeError, ImportError, ValueError):
        return {}
    annotations: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        definition = _definition(base)
        body = definition.body if isinstance(definition, ast.ClassDef) else []
        fields = [line for line in body if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name)]
        annotations |= {ast.unparse(line.target): _text(line.annotation) for line in fields}
    return annotations


def _definition(thing: type | FunctionType) -> ast.stmt | None:
    try:
        return ast.parse(dedent(inspect.getsource(thing))).body[0]
    except (OSError, TypeError, SyntaxError):  # made by others, or not in Python
        return None


def _text(annotation: ast.expr) -> str:
    if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
        return annotation.value
    return ast.unparse(annotation)
