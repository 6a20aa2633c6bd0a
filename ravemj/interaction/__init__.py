"""The mouse and the keys, without a window: what the GUI does with pointer and key events.

::

    interaction = Interaction(simulation, camera, (960, 720))
    interaction.handle(Key("escape"))  # interaction mode
    interaction.handle(Press(480, 360))
    interaction.handle(Release(480, 360))  # a click: the body in the middle is selected
    interaction.overlay().lines
"""

from ravemj.interaction.core import Interaction, Mode, Overlay
from ravemj.interaction.events import (
    Button,
    Event,
    Fingers,
    Key,
    Leave,
    Move,
    Press,
    Release,
    Resize,
    Use,
    Wheel,
)
from ravemj.interaction.layout import Panel, Rect, Tool, tools
from ravemj.interaction.picking import Hit, pick
from ravemj.interaction.selecting import Selection
from ravemj.interaction.view import Ray, View

__all__ = [
    "Button",
    "Event",
    "Fingers",
    "Hit",
    "Interaction",
    "Key",
    "Leave",
    "Mode",
    "Move",
    "Overlay",
    "Panel",
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
    "pick",
    "tools",
]
