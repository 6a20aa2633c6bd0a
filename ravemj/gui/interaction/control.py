"""Buttons and sliders as plain data."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Control:
    """A button, or a slider if ``lower`` and ``upper`` differ.

    Attributes:
        name: Identifier in ``Operate`` events.
        label: Tooltip: description of the action.
        text: Caption of a button, or value text beside a slider.
        value: Value of a slider.
        lower: Minimum value of a slider.
        upper: Maximum value of a slider.
        is_on: State of a toggle button.
        group: Location: ``tools``, the row ``playing`` of a motion, the row ``time`` of the simulation, or a panel that
            opens: ``menu``, ``joints`` (with ``joint tools`` above it), ``tree`` or ``help``.
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
        """Whether it is a slider and not a button."""
        return self.lower < self.upper
