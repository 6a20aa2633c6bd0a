"""Translation of MathML into mimic equations."""

from collections.abc import Callable
from dataclasses import dataclass

from ravemj.formats.meshes.collada.document import Element, child, children, local_name, words
from ravemj.model.expressions.functions import NAMED

_BETWEEN = {
    "plus": "+", "minus": "-", "times": "*", "divide": "/", "eq": "=", "neq": "!=", "lt": "<", "leq": "<=",
    "gt": ">", "geq": ">=", "and": "&", "or": "|",
    "rem": "%",
}  # fmt: skip
CALLS = {
    "power": "pow", "abs": "abs", "floor": "floor", "ceiling": "ceil", "exp": "exp",
    "sin": "sin", "cos": "cos", "tan": "tan", "sec": "sec", "csc": "csc", "cot": "cot",
    "sinh": "sinh", "cosh": "cosh", "tanh": "tanh",
    "arcsin": "asin", "arccos": "acos", "arctan": "atan",
    "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh",
    "root": "sqrt", "ln": "log", "log": "log10", "min": "min", "max": "max", "quotient": "floor",
}  # fmt: skip
_CONSTANTS = {"pi": "3.14159265358979323846", "exponentiale": "2.71828182845904523536", "true": "1", "false": "0"}
_QUALIFIERS = {"degree", "logbase"}
_MAX_DEPTH = 100
_LONGEST = 100_000


class FormulaError(Exception):
    """A formula that has no counterpart in the language of mimic equations."""


NameOf = Callable[[str], str | None]
"""Gives the text for what a path or a parameter stands for, or None."""


@dataclass(frozen=True, slots=True)
class Writer:
    """Writes formulas as texts.

    Attributes:
        name_of: Gives the names of joints.
        function: Gives the ``<formula>`` that a ``<csymbol>`` names as a function, or None.
    """

    name_of: NameOf
    function: Callable[[Element], Element | None]

    def equation(self, math: Element | None) -> str:
        """Return the text of a ``<math>``.

        Raises:
            FormulaError: It has something that mimic equations cannot say.
        """
        return self._content(math, self.name_of, 0)

    def _content(self, math: Element | None, name_of: NameOf, depth: int) -> str:
        content = next(children(math), None)
        if content is None:
            raise FormulaError("it is empty")
        return self._text(content, name_of, depth)

    def _text(self, element: Element, name_of: NameOf, depth: int) -> str:
        if depth > _MAX_DEPTH:
            raise FormulaError("it is nested too deep")
        kind = local_name(element)
        if kind == "cn":
            return _number(element)
        if kind in {"csymbol", "ci"}:
            return _name(element, name_of)
        if kind in _CONSTANTS:
            return _CONSTANTS[kind]
        if kind == "piecewise":
            return self._choice([*children(element, "piece", "otherwise")], name_of, depth + 1)
        if kind == "apply":
            return self._apply([*children(element)], name_of, depth + 1)
        raise FormulaError(f"<{kind}> is not understood")

    def _choice(self, pieces: list[Element], name_of: NameOf, depth: int) -> str:
        """Return the text of a ``<piecewise>``: the first piece whose condition holds, else what is left."""
        if not pieces:
            raise FormulaError("<piecewise> has no piece for every case")
        parts = [self._text(item, name_of, depth) for item in children(pieces[0])]
        if local_name(pieces[0]) == "otherwise" and len(parts) == 1:
            return parts[0]
        if local_name(pieces[0]) == "otherwise" or len(parts) != 2:
            raise FormulaError(f"<{local_name(pieces[0])}> has {len(parts)} parts")
        return f"if({parts[1]},{parts[0]},{self._choice(pieces[1:], name_of, depth + 1)})"

    def _apply(self, elements: list[Element], name_of: NameOf, depth: int) -> str:
        """Return the text of an operator and what it is applied to."""
        kind = local_name(elements[0]) if elements else "apply"
        texts = [self._text(item, name_of, depth) for item in elements[1:] if local_name(item) not in _QUALIFIERS]
        if not texts:
            raise FormulaError(f"<{kind}> has no operands")
        degree = next((item for item in elements[1:] if local_name(item) == "degree"), None)
        if kind == "csymbol":
            text = self._call(elements[0], texts, depth)
        elif kind == "root" and degree is not None:
            text = f"pow({texts[0]},(1.0/{self._content(degree, name_of, depth)}))"
        else:
            text = _operation(kind, texts)
        if len(text) > _LONGEST:
            raise FormulaError("it is too long")
        return text

    def _call(self, function: Element, texts: list[str], depth: int) -> str:
        """Return the text of a function that the file defines, or that OpenRAVE knows by its name."""
        name = "".join(words(function))
        if name in NAMED:  # OpenRAVE has three of them: SSSA, SASA and SASS
            return f"{name}({','.join(texts)})"
        formula = self.function(function)
        if formula is None:
            raise FormulaError(f"there is no function '{name}'")
        parameters = [item.get("sid", "") for item in children(formula, "newparam")]
        if len(parameters) != len(texts):
            raise FormulaError(f"the function '{name}' has {len(parameters)} parameters, not {len(texts)}")
        given = dict(zip(parameters, texts, strict=True))
        return self._content(child(formula, "technique_common", "math"), given.get, depth + 1)


def _name(element: Element, name_of: NameOf) -> str:
    path = "".join(words(element))
    name = None if element.get("definitionURL") else name_of(path)
    if name is None:
        raise FormulaError(f"there is no joint '{path}'")
    return name


def _operation(kind: str, texts: list[str]) -> str:
    if kind == "minus" and len(texts) == 1:
        return f"(-{texts[0]})"
    if kind in _BETWEEN:
        return f"({_BETWEEN[kind].join(texts)})"
    if kind in CALLS:
        return f"{CALLS[kind]}({','.join(texts)})"
    raise FormulaError(f"<{kind}> is not understood")


def _number(element: Element) -> str:
    text = "".join(words(element))
    try:
        float(text)
    except ValueError:
        raise FormulaError(f"'{text}' is not a number") from None
    return text.removeprefix("+")
