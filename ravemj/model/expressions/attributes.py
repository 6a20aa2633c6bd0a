"""Mimic equations in OpenRAVE's XML: joint names in the text, and partial derivatives in one attribute."""

import math
from collections.abc import Iterator, Mapping, Sequence

from ravemj.model.expressions.nodes import ExpressionError


class Replacements(dict[str, str]):
    """Map from names to replacements.

    Attributes:
        lengths: The lengths of the names, the largest first.
    """

    def __init__(self, names: Mapping[str, str]) -> None:
        super().__init__(names)
        self.lengths = sorted({len(name) for name in names if name}, reverse=True)

    def found_in(self, text: str) -> Iterator[tuple[int, str]]:
        """Yield the positions and names found in a text; at each position, the longest name."""
        at = 0
        while at < len(text):
            parts = (text[at : at + length] for length in self.lengths)
            name = next((part for part in parts if part in self), None)
            if name is not None:
                yield at, name
            at += len(name or " ")


def joint_variables(names: Sequence[str]) -> Replacements:
    """Return the variable for each joint: ``joint0``, ``joint1``, ...; passive joints come last."""
    return Replacements({name: f"joint{index}" for index, name in reversed(list(enumerate(names)))})


def substitute(text: str, names: Mapping[str, str]) -> str:
    """Replace joint names in an equation by their variables, with OpenRAVE's textual substitution.

    From left to right, the longest joint name at each position is replaced; replacements are not scanned again. Word
    boundaries and functions are ignored: a joint called ``s`` turns ``sin(x)`` into ``joint0in(x)``, and the equation
    is invalid. Names may have any characters (``/arm/j01``). Other text is kept, so equations may also contain
    ``joint0``, and the second axis of joint ``u`` is ``u_1``.
    """
    names = names if isinstance(names, Replacements) else Replacements(names)
    parts: list[str] = []
    behind = 0
    for at, name in names.found_in(text):
        parts += [text[behind:at], names[name]]
        behind = at + len(name)
    return "".join([*parts, text[behind:]])


def before_substitution(error: ExpressionError, text: str, names: Replacements) -> ExpressionError:
    """Convert an error in a substituted equation to an error at the position in the original text."""
    problem, grown = error.problem, 0
    position = error.position
    for at, name in names.found_in(text):
        variable, start = names[name], at + grown
        problem = problem.replace(repr(variable), repr(name))
        if start < error.position:
            grown += len(variable) - len(name)
            position = max(at, error.position - grown)
    if "'joint" in problem and problem.split("'")[1] not in text:
        problem += " (names of joints count inside of words, too)"
    return ExpressionError(problem, text, position, error.expected)


def partials(text: str) -> dict[str, str]:
    """Return the expressions in ``mimic_vel`` or ``mimic_accel``, ``|name expression |name expression``, by name.

    Every ``|`` starts a partial derivative, so expressions cannot use the logical operator. Text before the first ``|``
    defines inline variables for all of them. If a name is repeated, the last one is used.

    Raises:
        ExpressionError: If a name or an expression is missing.
    """
    shared, *parts = text.split("|")
    shared = f"{shared.strip().rstrip(';')}; " if shared.strip() and parts else ""
    if not parts and text.strip():
        raise ExpressionError("a partial derivative begins otherwise", text, 0, "'|name expression'")
    derivatives: dict[str, str] = {}
    position = len(text) - sum(len(part) + 1 for part in parts)
    for part in parts:
        words = part.split(maxsplit=1)
        if len(words) < 2:
            raise ExpressionError("a partial derivative is not complete", text, position + 1, "'name expression'")
        derivatives[words[0]] = shared + words[1].strip()
        position += len(part) + 1
    return derivatives


def linear_mimic(text: str) -> tuple[str, str, str]:
    """Translate the deprecated attribute ``mimic="J a b"``; if b is missing, it is 0.

    Returns:
        The equation of the position, ``J*a+b`` with six decimals, and those of the velocity and of the acceleration,
        both ``|J a``.

    Raises:
        ExpressionError: the text is not a name and one or two finite numbers.
    """
    name, *words = [*text.split(), "0"][:3]
    try:
        a, b = map(float, words)
    except ValueError:
        raise ExpressionError("cannot read a mimic joint", text, 0, "a joint and one or two numbers") from None
    if not math.isfinite(a + b):
        raise ExpressionError("cannot read a mimic joint", text, 0, "finite numbers")
    return f"{name}*{a:.6f}+{b:.6f}", f"|{name} {a:.6f}", f"|{name} {a:.6f}"
