"""MathML to the text of a mimic equation."""

from collections.abc import Callable

from ravemj.meshes.collada.document import Element, children, local_name, words

_BETWEEN = {
    "plus": "+", "minus": "-", "times": "*", "divide": "/", "eq": "=", "neq": "!=", "lt": "<", "leq": "<=",
    "gt": ">", "geq": ">=", "and": "&", "or": "|",
}  # fmt: skip
_CALLS = {
    "power": "pow", "abs": "abs", "floor": "floor", "ceiling": "ceil", "exp": "exp", "rem": "fmod",
    "sin": "sin", "cos": "cos", "tan": "tan", "sec": "sec", "csc": "csc", "cot": "cot",
    "sinh": "sinh", "cosh": "cosh", "tanh": "tanh",
    "arcsin": "asin", "arccos": "acos", "arctan": "atan",
    "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh",
    "min": "min", "max": "max", "quotient": "floor",
}  # fmt: skip
_CONSTANTS = {"pi": "3.14159265358979323846", "exponentiale": "2.71828182845904523536", "true": "1", "false": "0"}
_MAX_DEPTH = 100


class FormulaError(Exception):
    """A formula that has no counterpart in the language of mimic equations."""


def equation(math: Element | None, name_of: Callable[[str], str | None]) -> str:
    """Return the text of a ``<math>``.

    Args:
        math: The element.
        name_of: Gives the name of the joint that a path stands for, or None.

    Raises:
        FormulaError: It has something that mimic equations cannot say.
    """
    content = next(children(math), None)
    if content is None:
        raise FormulaError("it is empty")
    return _text(content, name_of, 0)


def _text(element: Element, name_of: Callable[[str], str | None], depth: int) -> str:
    if depth > _MAX_DEPTH:
        raise FormulaError("it is nested too deep")
    kind = local_name(element)
    if kind == "cn":
        return _number(element)
    if kind == "csymbol":
        path = "".join(words(element))
        name = None if element.get("definitionURL") else name_of(path)
        if name is None:
            raise FormulaError(f"there is no joint '{path}'")
        return name
    if kind in _CONSTANTS:
        return _CONSTANTS[kind]
    if kind == "apply":
        operator, *operands = [*children(element)] or [element]
        return _apply(operator, operands, name_of, depth + 1)
    raise FormulaError(f"<{kind}> is not understood")


def _number(element: Element) -> str:
    text = "".join(words(element))
    try:
        float(text)
    except ValueError:
        raise FormulaError(f"'{text}' is no number") from None
    return text.removeprefix("+")


def _apply(operator: Element, operands: list[Element], name_of: Callable[[str], str | None], depth: int) -> str:
    kind = local_name(operator)
    texts = [_text(item, name_of, depth) for item in operands if local_name(item) not in {"degree", "logbase"}]
    if not texts:
        raise FormulaError(f"<{kind}> has no operands")
    if kind == "minus" and len(texts) == 1:
        return f"(-{texts[0]})"
    if kind in _BETWEEN:
        return f"({_BETWEEN[kind].join(texts)})"
    if kind == "root":
        degree = next((item for item in operands if local_name(item) == "degree"), None)
        content = None if degree is None else next(children(degree), None)
        return f"sqrt({texts[0]})" if content is None else f"pow({texts[0]},(1.0/{_text(content, name_of, depth)}))"
    if kind in {"ln", "log"}:
        return f"{'log' if kind == 'ln' else 'log10'}({texts[0]})"
    if kind in _CALLS:
        return f"{_CALLS[kind]}({','.join(texts)})"
    raise FormulaError(f"<{kind}> is not understood")
