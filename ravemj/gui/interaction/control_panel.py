"""Pointer and keyboard input for the controls that a window draws."""

import math
from collections.abc import Callable
from dataclasses import replace

from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.control_layout import ControlLayout
from ravemj.gui.interaction.controls import Controls
from ravemj.gui.interaction.events import Button, Press
from ravemj.gui.interaction.shortcuts import KEYS


class ControlPanel:
    """Input and scroll state of the controls of one view.

    Attributes:
        controls: The buttons and sliders.
    """

    def __init__(self, controls: Controls, *, is_drawn: bool = True) -> None:
        """Start unscrolled. If ``is_drawn`` is False, as for pages, whose controls are HTML, the layout stays empty."""
        self.controls = controls
        self._is_drawn = is_drawn
        self._first_row = 0.0
        self._followed: tuple[str, tuple[str, ...]] = "", ()  # menu and selection of the last layout
        self._field = ""
        self._text = ""
        self._search = ""

    @property
    def is_typing(self) -> bool:
        """Whether keyboard input goes to a text field of the panel."""
        return bool(self._field)

    def layout(self, size: tuple[int, int]) -> ControlLayout:
        """Return the current layout on a view of a size [points]."""
        if not self._is_drawn:
            return ControlLayout.arrange((), size)
        rows = self.controls.rows(self._search)
        controls = tuple(map(self._with_typed, (*self.controls.all(), *rows)))
        if self._field not in {control.name for control in controls}:
            self.stop_typing()
        unfolded, chosen = self.controls.unfolded, self.controls.chosen[-1:]
        if unfolded != self._followed[0]:
            self._first_row = 0.0
        layout = ControlLayout.arrange(controls, size, round(self._first_row))
        number = next((number for number, row in enumerate(rows[1:]) if row.name in chosen), None)
        is_seen = any(control.name in chosen for control in layout.places)
        if number is not None and not is_seen and (unfolded, chosen) != self._followed:
            self._first_row = number
            layout = ControlLayout.arrange(controls, size, number)
        self._followed = unfolded, chosen
        return layout

    def _with_typed(self, control: Control) -> Control:
        return replace(control, text=f"{self._text}|", is_on=True) if control.name == self._field else control

    def press(self, press: Press, layout: ControlLayout) -> Callable[[float, float], None] | None:
        """Press a button, focus a text field, or grab a slider; return a callback for pointer moves, or None."""
        at = press.x, press.y
        control, field = layout.at(at), layout.field_at(at)
        if press.button is not Button.LEFT:
            return None
        if field is not None:
            self._field, self._text = field.name, self._search if field.name == "search" else ""
        elif control is not None and control.is_slider:
            return self._start_slide(control, press, layout)
        elif control is not None:
            self.controls.operate(control.name)
        return None

    def _start_slide(self, slider: Control, press: Press, layout: ControlLayout) -> Callable[[float, float], None]:
        def slide(x: float, y: float) -> None:
            del y
            self.controls.operate(slider.name, layout.value_at(slider, x))

        slide(press.x, press.y)
        return slide

    def scroll(self, layout: ControlLayout, steps: float) -> None:
        """Scroll the rows by wheel steps."""
        self._first_row = min(max(self._first_row - steps, 0.0), layout.last_row)

    def key(self, name: str) -> None:
        """Edit the focused text field, or operate the control with the shortcut ``name``."""
        if not self.is_typing:
            if name in KEYS:
                self.controls.operate(KEYS[name])
        elif name == "backspace":
            self._set_text(self._text[:-1])
        elif name == "escape":
            self._set_text("")
            self.stop_typing()
        elif name == "enter" and self._field == "search":
            self._select_next()
        elif name == "enter":
            self._set_value()

    def type(self, letter: str) -> None:
        """Append a letter to the focused text field, if there is one."""
        if self.is_typing:
            self._set_text(self._text + letter)

    def stop_typing(self) -> None:
        """Remove the focus from the text field; the search text stays."""
        self._field = self._text = ""

    def _set_text(self, text: str) -> None:
        self._text = text
        if self._field == "search":
            self._search = text

    def _select_next(self) -> None:
        """Select the next link or body that the search finds, after the last selected one."""
        names = [row.name for row in self.controls.rows(self._search)[1:]]
        for name in self.controls.chosen[-1:]:
            if name in names:
                before = names.index(name)
                names = names[before + 1 :] + names[:before]
        if names:
            self.controls.operate(names[0])

    def _set_value(self) -> None:
        """Set a joint to the typed value, in the displayed unit; tell the user if it is not a number."""
        try:
            value = float(self._text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            self.controls.notices.say(f"'{self._text}' is no number")
            return
        for control in self.controls.all():
            if control.name == self._field:
                self.controls.operate(control.name, math.radians(value) if control.text.endswith(" deg") else value)
        self.stop_typing()
