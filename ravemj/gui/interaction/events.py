"""Input events; positions are in points, (0, 0) is the top left corner of the view."""

from dataclasses import dataclass
from enum import Enum

from ravemj.gui.interaction.mode_buttons import ViewButton


class Button(Enum):
    """A mouse button."""

    LEFT = "left"
    MIDDLE = "middle"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class Press:
    """A mouse button or a finger was pressed.

    Attributes:
        x: Column of the pointer [points].
        y: Row of the pointer [points].
        button: The mouse button.
        ctrl: Whether Ctrl is held.
        shift: Whether Shift is held.
        touch: Whether it is a finger, which turns the view unless it starts on a handle; a tap selects in both modes.
    """

    x: float
    y: float
    button: Button = Button.LEFT
    ctrl: bool = False
    shift: bool = False
    touch: bool = False


@dataclass(frozen=True, slots=True)
class Move:
    """The pointer has moved to a position [points]."""

    x: float
    y: float


@dataclass(frozen=True, slots=True)
class Release:
    """A mouse button was released."""

    x: float
    y: float
    button: Button = Button.LEFT


@dataclass(frozen=True, slots=True)
class Wheel:
    """The mouse wheel was turned; positive steps are away from the user."""

    steps: float


@dataclass(frozen=True, slots=True)
class Fingers:
    """Two fingers have moved.

    Attributes:
        x: Column of the midpoint of the fingers [points].
        y: Row of the midpoint [points].
        right: Displacement of the midpoint to the right [points].
        down: Displacement of the midpoint downwards [points].
        spread: Ratio of new to old distance of the fingers; above 0.
    """

    x: float
    y: float
    right: float
    down: float
    spread: float = 1.0


@dataclass(frozen=True, slots=True)
class Use:
    """A mode button or a wheel was operated by other means than the pointer on the view.

    Attributes:
        tool: The button or wheel.
        amount: Displacement of a wheel, to the right or down [points].
    """

    tool: ViewButton
    amount: float = 0.0


@dataclass(frozen=True, slots=True)
class Key:
    """A key was pressed or released: ``escape``, ``enter``, ``backspace``, or a letter such as ``s``."""

    name: str
    pressed: bool = True


@dataclass(frozen=True, slots=True)
class Type:
    """A letter was typed. The keys that produce it are reported by ``Key`` as well."""

    letter: str


@dataclass(frozen=True, slots=True)
class Operate:
    """A control was operated by other means than the pointer on the view.

    Attributes:
        name: Name of the control, from ``Controls``.
        value: New value of a slider.
    """

    name: str
    value: float = 0.0


@dataclass(frozen=True, slots=True)
class Resize:
    """The view was resized [points]."""

    width: int
    height: int


@dataclass(frozen=True, slots=True)
class Leave:
    """The pointer or the focus has left the view: keys and buttons count as released."""


Event = Press | Move | Release | Wheel | Fingers | Use | Key | Type | Operate | Resize | Leave
