"""A button or a slider, as plain data."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Control:
    """A button, or a slider if it has a range.

    Attributes:
        name: What ``Operate`` calls it.
        label: What it does, for people.
        text: What stands on a button, or beside a slider.
        value: Where a slider is.
        lower: Where its range begins.
        upper: Where its range ends.
        is_on: For a button that stays down, whether it is.
        group: Where it is: among the ``tools``, in the row of a motion that is ``playing`` or of simulation ``time``,
            or unfolded: a ``menu``, the ``joints`` or the ``tree`` with the ``joint tools`` above them, the ``help``.
    """

    name: str
    label: str
    text: str = ""
    value: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    is_on: bool | None = None
    group: str = "tools"

    @property
    def is_slider(self) -> bool:
        """Whether it has a value, and not only something to do."""
        return self.lower < self.upper
