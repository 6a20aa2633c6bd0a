"""``<formula>``: mimic joints; MathML is converted to mimic equations."""

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from ravemj.formats.collada.library import Library
from ravemj.formats.limits import MOST_ELEMENTS
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, words
from ravemj.model.builder import BodyBuilder, JointBuilder
from ravemj.model.expressions.functions import NAMED
from ravemj.model.mimic import Equations
from ravemj.model.scene import AXES

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


class _FormulaError(Exception):
    """A formula that cannot be expressed as a mimic equation."""


_NameOf = Callable[[str], str | None]
"""Function that returns the expression of a joint path or function parameter, or None if it is unknown."""


def read_formulas(library: Library, model: Element, joints: Mapping[Element, int], body: BodyBuilder) -> None:
    """Set the equations of mimic joints of a ``<kinematics_model>``; ``joints`` are indices of joints in the body."""
    reader = _FormulaReader(library, model, joints, body.joints)
    for item in children(child(model, "technique_common"), "formula", "instance_formula"):
        formula = library.follow(item) if local_name(item) == "instance_formula" else item
        if formula is not None:
            reader.read(formula)


@dataclass(frozen=True, slots=True)
class _FormulaReader:
    library: Library
    model: Element
    indices: Mapping[Element, int]
    joints: list[JointBuilder]
    steps: Iterator[int] = field(default_factory=itertools.count)

    def read(self, formula: Element) -> None:
        """Read a formula as the mimic equations of its joint; if it is invalid, disable the joint: it has no DOF."""
        path = "".join(words(child(formula, "target", "param")))
        joint = self._joint(path)
        if joint is None:
            self.library.warn("broken-reference", f"there is no joint '{path}' for the formula", formula)
            return
        unit = self._unit(joint)
        try:
            text = self._content(_position(formula), self._variable, 0)
        except _FormulaError as error:
            message = f"joint '{joint.name}' cannot follow: {error}; it stays where it is"
            self.library.warn("bad-mimic", message, formula)
            joint.enabled = False
            return
        position = text if unit == 1 else f"{unit:f}*({text})"
        first, second = (self._partials(formula, kind) for kind in ("first_partial", "second_partial"))
        joint.equations = Equations(position, first, second)

    def _partials(self, formula: Element, kind: str) -> str:
        """Return the partial derivatives of type ``kind`` as OpenRAVE's ``|joint expression`` terms."""
        text = ""
        for item in _own_equations(formula, kind):
            joint = self._joint(item.get("target") or "")
            try:
                if joint is not None:
                    text += f"|{joint.name} {self._content(child(item, 'math'), self._variable, 0)} "
            except _FormulaError as error:
                self.library.warn("bad-mimic", f"a derivative is left out: {error}", item)
        return text

    def _variable(self, path: str) -> str | None:
        """Return the expression for a joint's value in the file's unit; None if there is no such joint."""
        joint = self._joint(path)
        if joint is None:
            return None
        unit = self._unit(joint)
        return joint.name if unit == 1 else f"({1 / unit:f}*{joint.name})"

    def _unit(self, joint: JointBuilder) -> float:
        """Return the file's unit of a joint's value [m for prismatic joints, else rad]."""
        return self.library.metres(self.model) if AXES[joint.kind][0] == "P" else 1.0

    def _joint(self, path: str) -> JointBuilder | None:
        joint = self.library.resolve(path, self.model) if path else None
        index = None if joint is None else self.indices.get(joint.element)
        return None if index is None else self.joints[index]

    def _function(self, symbol: Element) -> Element | None:
        is_named = bool(symbol.get("definitionURL"))
        return self.library.follow(symbol, "formula", attribute="definitionURL") if is_named else None

    def _content(self, math: Element | None, name_of: _NameOf, depth: int) -> str:
        content = next(children(math), None)
        if content is None:
            raise _FormulaError("it is empty")
        return self._text(content, name_of, depth)

    def _text(self, element: Element, name_of: _NameOf, depth: int) -> str:
        if depth > _MAX_DEPTH:
            raise _FormulaError("it is nested too deep")
        if next(self.steps) > MOST_ELEMENTS:  # functions that call others twice, which call others twice
            raise _FormulaError("it calls functions too often")
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
        raise _FormulaError(f"<{kind}> is not understood")

    def _choice(self, pieces: list[Element], name_of: _NameOf, depth: int) -> str:
        """Return the expression of a ``<piecewise>``: the first piece whose condition holds, else ``<otherwise>``."""
        if not pieces:
            raise _FormulaError("<piecewise> has no piece for every case")
        parts = [self._text(item, name_of, depth) for item in children(pieces[0])]
        if local_name(pieces[0]) == "otherwise" and len(parts) == 1:
            return parts[0]
        if local_name(pieces[0]) == "otherwise" or len(parts) != 2:
            raise _FormulaError(f"<{local_name(pieces[0])}> has {len(parts)} parts")
        return f"if({parts[1]},{parts[0]},{self._choice(pieces[1:], name_of, depth + 1)})"

    def _apply(self, elements: list[Element], name_of: _NameOf, depth: int) -> str:
        """Return the expression of an operator applied to its operands, ``elements[0]`` and ``elements[1:]``."""
        kind = local_name(elements[0]) if elements else "apply"
        texts = [self._text(item, name_of, depth) for item in elements[1:] if local_name(item) not in _QUALIFIERS]
        if not texts:
            raise _FormulaError(f"<{kind}> has no operands")
        degree = next((item for item in elements[1:] if local_name(item) == "degree"), None)
        if kind == "csymbol":
            text = self._call(elements[0], texts, depth)
        elif kind == "root" and degree is not None:
            order = self._content(degree, name_of, depth)
            text = f"sqrt({texts[0]})" if order == "2" else f"pow({texts[0]},(1.0/{order}))"
        else:
            text = _operation(kind, texts)
        if len(text) > _LONGEST:
            raise _FormulaError("it is too long")
        return text

    def _call(self, function: Element, texts: list[str], depth: int) -> str:
        """Return the expression of a call of a function that the file defines, or that OpenRAVE knows by name."""
        name = "".join(words(function))
        if name in NAMED:  # OpenRAVE has three of them: SSSA, SASA and SASS
            return f"{name}({','.join(texts)})"
        formula = self._function(function)
        if formula is None:
            raise _FormulaError(f"there is no function '{name}'")
        parameters = [item.get("sid", "") for item in children(formula, "newparam")]
        if len(parameters) != len(texts):
            raise _FormulaError(f"the function '{name}' has {len(parameters)} parameters, not {len(texts)}")
        given = dict(zip(parameters, texts, strict=True))
        return self._content(child(formula, "technique_common", "math"), given.get, depth + 1)


def _own_equations(formula: Element, kind: str) -> list[Element]:
    """Return the ``<equation>`` elements of type ``kind`` in the formula's OpenRAVE technique."""
    techniques = (item for item in children(formula, "technique") if item.get("profile") == "OpenRAVE")
    return [item for technique in techniques for item in children(technique, "equation") if item.get("type") == kind]


def _position(formula: Element) -> Element | None:
    """Return the ``<math>`` of the joint value: from OpenRAVE's technique, else from ``<technique_common>``."""
    own = _own_equations(formula, "position")
    return child(own[0], "math") if own else child(formula, "technique_common", "math")


def _name(element: Element, name_of: _NameOf) -> str:
    path = "".join(words(element))
    name = None if element.get("definitionURL") else name_of(path)
    if name is None:
        raise _FormulaError(f"there is no joint '{path}'")
    return name


def _operation(kind: str, texts: list[str]) -> str:
    if kind == "minus" and len(texts) == 1:
        return f"(-{texts[0]})"
    if kind in _BETWEEN:
        return f"({_BETWEEN[kind].join(texts)})"
    if kind in CALLS:
        return f"{CALLS[kind]}({','.join(texts)})"
    raise _FormulaError(f"<{kind}> is not understood")


def _number(element: Element) -> str:
    text = "".join(words(element))
    try:
        float(text)
    except ValueError:
        raise _FormulaError(f"'{text}' is not a number") from None
    return text.removeprefix("+")
