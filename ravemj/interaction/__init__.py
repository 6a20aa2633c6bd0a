"""The mouse and the keys, without a window: what the GUI does with pointer and key events.

::

    interaction = Interaction(simulation, camera, (960, 720))
    interaction.handle(Key("escape"))  # interaction mode
    interaction.handle(Press(480, 360))
    interaction.handle(Release(480, 360))  # a click: the body in the middle is selected
    interaction.overlay().lines
"""

from ravemj.interaction.board import Board
from ravemj.interaction.controls import Control, Controls, Wish
from ravemj.interaction.core import Interaction, Mode, Overlay
from ravemj.interaction.events import (
    Button,
    Event,
    Fingers,
    Key,
    Leave,
    Move,
    Operate,
    Press,
    Release,
    Resize,
    Use,
    Wheel,
)
from ravemj.interaction.layout import Panel, Rect, Tool, tools
from ravemj.interaction.notices import Notices
from ravemj.interaction.picking import Hit, pick
from ravemj.interaction.playback import Playback
from ravemj.interaction.selecting import Selection
from ravemj.interaction.view import Ray, View

__all__ = [
    "Board",
    "Button",
    "Control",
    "Controls",
    "Event",
    "Fingers",
    "Hit",
    "Interaction",
    "Key",
    "Leave",
    "Mode",
    "Move",
    "Notices",
    "Operate",
    "Overlay",
    "Panel",
    "Playback",
    "Press",
    "Ray",
    "Rect",
    "Release",
    "Resize",
    "Selection",
    "Tool",
    "Use",
    "View",
    "Wheel",
    "Wish",
    "pick",
    "tools",
]
