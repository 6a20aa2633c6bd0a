"""The one exception of this package."""

from ravemj.errors import ArgumentError

EXCERPT = 20


class ExpressionError(ArgumentError):
    """An equation that cannot be read; one line that names the place.

    Attributes:
        problem: The error, without the place.
        position: Index of the character in the text, from 0; where the text ends too early, its length.
        expected: What could have stood there; may be empty.
    """

    def __init__(self, problem: str, text: str, position: int, expected: str = "") -> None:
        before, after = text[max(0, position - EXCERPT) : position], text[position : position + EXCERPT]
        where = " and".join(f" {side} {part!r}" for side, part in (("after", before), ("before", after)) if part)
        wanted = f"; expected {expected}" if expected else ""
        super().__init__(f"{problem} at character {position}{where}{wanted}")
        self.problem = problem
        self.position = position
        self.expected = expected
