"""Pointer and keyboard interaction with a simulation, independent of any window.

::

    interaction = Interaction.first_view(simulation, camera, (960, 720))
    interaction.handle(Key("escape"))  # interaction mode
    interaction.handle(Press(480, 360))
    interaction.handle(Release(480, 360))  # a click: the body in the middle is selected
    interaction.overlay().lines
"""

from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.control_layout import ControlLayout
from ravemj.gui.interaction.controls import Request
from ravemj.gui.interaction.core import Interaction
from ravemj.gui.interaction.events import (
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
    Type,
    Use,
    Wheel,
)
from ravemj.gui.interaction.mode_buttons import Panel, Rect, ViewButton, button_rects
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.overlay import Overlay
from ravemj.gui.interaction.picking import Hit, pick
from ravemj.gui.interaction.playback import Playback
from ravemj.gui.interaction.pointer_controller import Mode
from ravemj.gui.interaction.selection import Selection
from ravemj.gui.interaction.viewpoint import Viewpoint, ViewRay

__all__ = [
    "Button",
    "Control",
    "ControlLayout",
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
    "Rect",
    "Release",
    "Request",
    "Resize",
    "Selection",
    "Type",
    "Use",
    "ViewButton",
    "ViewRay",
    "Viewpoint",
    "Wheel",
    "button_rects",
    "pick",
]
