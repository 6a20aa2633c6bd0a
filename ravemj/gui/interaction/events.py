"""What people do with mouse and keys, in points of the screen: (0, 0) is the top left corner of the view."""

from dataclasses import dataclass
from enum import Enum

from ravemj.gui.interaction.mode_buttons import Tool


class Button(Enum):
    """A button of the mouse."""

    LEFT = "left"
    MIDDLE = "middle"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class Press:
    """A button goes down.

    Attributes:
        x: Column of the pointer [points].
        y: Row of the pointer [points].
        button: Which button.
        ctrl: Whether Ctrl is held.
        shift: Whether Shift is held.
        touch: Whether this is a finger: it turns the view beside what can be dragged, and a tap selects in both modes.
    """

    x: float
    y: float
    button: Button = Button.LEFT
    ctrl: bool = False
    shift: bool = False
    touch: bool = False


@dataclass(frozen=True, slots=True)
class Move:
    """The pointer is now elsewhere [points]."""

    x: float
    y: float


@dataclass(frozen=True, slots=True)
class Release:
    """A button goes up."""

    x: float
    y: float
    button: Button = Button.LEFT


@dataclass(frozen=True, slots=True)
class Wheel:
    """The wheel turns; positive steps are away from the hand."""

    steps: float


@dataclass(frozen=True, slots=True)
class Fingers:
    """Two fingers move.

    Attributes:
        x: Column of their middle [points].
        y: Row of their middle [points].
        right: How far it came from the left [points].
        down: How far it came from above [points].
        spread: By which factor their distance grew; above 0.
    """

    x: float
    y: float
    right: float
    down: float
    spread: float = 1.0


@dataclass(frozen=True, slots=True)
class Use:
    """A button or a wheel on the view is used otherwise than by pressing it there.

    Attributes:
        tool: Which one.
        amount: How far a wheel is moved, to the right or down [points].
    """

    tool: Tool
    amount: float = 0.0


@dataclass(frozen=True, slots=True)
class Key:
    """A key goes down or up; ``escape``, ``enter``, ``backspace`` and letters such as ``s`` are known."""

    name: str
    pressed: bool = True


@dataclass(frozen=True, slots=True)
class Type:
    """A letter is typed: what the keyboard makes of keys, which ``Key`` tells as well."""

    letter: str


@dataclass(frozen=True, slots=True)
class Operate:
    """A control is used otherwise than with the pointer on the view.

    Attributes:
        name: Its name; ``Controls`` has them.
        value: Where a slider goes.
    """

    name: str
    value: float = 0.0


@dataclass(frozen=True, slots=True)
class Resize:
    """The view has another size [points]."""

    width: int
    height: int


@dataclass(frozen=True, slots=True)
class Leave:
    """The view is left: keys and buttons that are held do not count any more."""


Event = Press | Move | Release | Wheel | Fingers | Use | Key | Type | Operate | Resize | Leave
