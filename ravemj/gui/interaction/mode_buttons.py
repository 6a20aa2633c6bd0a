"""OpenRAVE's mode buttons and camera wheels, as rectangles that windows and pages draw."""

from enum import Enum
from typing import NamedTuple

_MARGIN = 8
_BUTTON = 36
_WHEEL_LENGTH, _WHEEL_WIDTH = 120, 18
_RIDGES = 9
_LABEL_WIDTH, _LABEL_HEIGHT = 44, 20

_Rgba = tuple[float, float, float, float]
_BACK: _Rgba = (0.15, 0.15, 0.17, 0.75)
_CHOSEN: _Rgba = (0.95, 0.95, 0.97, 1.0)
_RIDGE: _Rgba = (0.6, 0.6, 0.63, 1.0)
_RED: _Rgba = (0.85, 0.1, 0.1, 1.0)
_GREY: _Rgba = (0.5, 0.5, 0.55, 1.0)
_LENS: _Rgba = (0.2, 0.3, 0.5, 1.0)


class Rect(NamedTuple):
    """A rectangle; x and y are the position of its top left corner [points]."""

    x: float
    y: float
    width: float
    height: float

    def contains(self, x: float, y: float) -> bool:
        """Return whether a point is inside."""
        return self.x <= x < self.x + self.width and self.y <= y < self.y + self.height


class Panel(NamedTuple):
    """A rectangle with text; later panels are drawn over earlier ones.

    Attributes:
        rect: The rectangle.
        rgba: Its colour, in 0..1; if the opacity is 0, only the text is drawn.
        text: Text in its centre.
        is_left: Whether the text is left-aligned instead of centred.
        text_rgb: Colour of the text, in 0..255.
    """

    rect: Rect
    rgba: _Rgba
    text: str = ""
    is_left: bool = False
    text_rgb: tuple[int, int, int] = (255, 255, 255)


class ViewButton(Enum):
    """A mode button or a camera wheel; the values are displayed names."""

    INTERACT = "Interaction mode"
    CAMERA = "Camera mode"
    ROT_X = "RotX"
    ROT_Y = "RotY"
    DOLLY = "Dolly"


def button_rects(size: tuple[int, int]) -> dict[ViewButton, Rect]:
    """Return the rectangles of the buttons and wheels on a view of a size [points]; none if it is too small."""
    width, height = size
    right, bottom = width - _MARGIN, height - _MARGIN
    if width < 3 * _WHEEL_LENGTH or height < 2 * _WHEEL_LENGTH:
        return {}
    upright = bottom - _WHEEL_WIDTH - _MARGIN - _WHEEL_LENGTH
    return {
        ViewButton.INTERACT: Rect(right - _BUTTON, _MARGIN, _BUTTON, _BUTTON),
        ViewButton.CAMERA: Rect(right - _BUTTON, 2 * _MARGIN + _BUTTON, _BUTTON, _BUTTON),
        ViewButton.ROT_X: Rect(_MARGIN, upright, _WHEEL_WIDTH, _WHEEL_LENGTH),
        ViewButton.ROT_Y: Rect(2 * _MARGIN + _WHEEL_WIDTH, bottom - _WHEEL_WIDTH, _WHEEL_LENGTH, _WHEEL_WIDTH),
        ViewButton.DOLLY: Rect(right - _WHEEL_WIDTH, upright, _WHEEL_WIDTH, _WHEEL_LENGTH),
    }


def button_at(size: tuple[int, int], x: float, y: float) -> ViewButton | None:
    """Return the button or wheel at a point of the view [points], or None."""
    return next((tool for tool, rect in button_rects(size).items() if rect.contains(x, y)), None)


def panels(size: tuple[int, int], chosen: ViewButton) -> tuple[Panel, ...]:
    """Return the panels of the buttons and wheels on a view of a size [points]; ``chosen`` is the active button."""
    drawn: list[Panel] = []
    for tool, rect in button_rects(size).items():
        drawn.append(Panel(rect, _CHOSEN if tool is chosen else _BACK))
        if tool is ViewButton.INTERACT:
            drawn += _arrow(rect)
        elif tool is ViewButton.CAMERA:
            drawn += _camera(rect)
        else:
            drawn += _ridges(rect)
            drawn.append(Panel(_label(tool, rect), _BACK, tool.value))
    return tuple(drawn)


def _arrow(rect: Rect) -> list[Panel]:
    """Return a red arrow like a mouse pointer."""
    head = [Panel(Rect(rect.x + 9, rect.y + 5 + row, 2 + 0.8 * row, 1), _RED) for row in range(18)]
    tail = [Panel(Rect(rect.x + 14 + 0.5 * row, rect.y + 22 + row, 5, 1), _RED) for row in range(9)]
    return head + tail


def _camera(rect: Rect) -> list[Panel]:
    return [
        Panel(Rect(rect.x + 13, rect.y + 9, 8, 5), _GREY),
        Panel(Rect(rect.x + 6, rect.y + 12, 24, 16), _GREY),
        Panel(Rect(rect.x + 13, rect.y + 15, 10, 10), _LENS),
    ]


def _ridges(rect: Rect) -> list[Panel]:
    steps = [(number + 1) / (_RIDGES + 1) for number in range(_RIDGES)]
    if rect.height > rect.width:
        return [Panel(Rect(rect.x + 3, rect.y + step * rect.height, rect.width - 6, 2), _RIDGE) for step in steps]
    return [Panel(Rect(rect.x + step * rect.width, rect.y + 3, 2, rect.height - 6), _RIDGE) for step in steps]


def _label(tool: ViewButton, rect: Rect) -> Rect:
    if tool is ViewButton.ROT_Y:
        return Rect(rect.x + rect.width + 2, rect.y + rect.height - _LABEL_HEIGHT, _LABEL_WIDTH, _LABEL_HEIGHT)
    x = rect.x if tool is ViewButton.ROT_X else rect.x + rect.width - _LABEL_WIDTH
    return Rect(x, rect.y - _LABEL_HEIGHT - 2, _LABEL_WIDTH, _LABEL_HEIGHT)
