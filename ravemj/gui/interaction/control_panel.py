"""The pointer over the controls that a window draws."""

from collections.abc import Callable

from ravemj.gui.interaction.control_layout import ControlLayout
from ravemj.gui.interaction.controls import Controls
from ravemj.gui.interaction.events import Button, Press
from ravemj.gui.interaction.shortcuts import KEYS


class ControlPanel:
    """The controls of one view, where a window has them.

    Attributes:
        controls: What there is to press and to slide.
    """

    def __init__(self, controls: Controls, *, is_drawn: bool = True) -> None:
        """Begin with the first rows.

        Args:
            controls: What there is to press and to slide.
            is_drawn: False where the shell has buttons and sliders of its own: nothing is on the view then.
        """
        self.controls = controls
        self._is_drawn = is_drawn
        self._first_row = 0.0

    def layout(self, size: tuple[int, int]) -> ControlLayout:
        """Return where everything is now on a view of some size [points]."""
        controls = (*self.controls.all(), *self.controls.rows()) if self._is_drawn else ()
        return ControlLayout.of(controls, size, round(self._first_row))

    def press(self, press: Press, layout: ControlLayout) -> Callable[[float, float], None] | None:
        """Press a button, or take hold of a slider: what is returned lets it follow the pointer."""
        control = layout.at((press.x, press.y))
        if press.button is not Button.LEFT or control is None:
            return None
        if not control.is_slider:
            self.controls.operate(control.name)
            return None

        def slide(x: float, y: float) -> None:
            del y
            self.controls.operate(control.name, layout.value_at(control, x))

        slide(press.x, press.y)
        return slide

    def scroll(self, layout: ControlLayout, steps: float) -> None:
        """Show others of the sliders that have no room all at once."""
        self._first_row = min(max(self._first_row - steps, 0.0), layout.last_row)

    def key(self, name: str) -> None:
        """Do what a key is for."""
        if name in KEYS:
            self.controls.operate(KEYS[name])
