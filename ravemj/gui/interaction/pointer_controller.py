"""Pointer and keyboard controller of one view: dispatches each event to the controls, the bodies or the camera."""

import math
from collections.abc import Callable
from dataclasses import replace
from enum import Enum
from typing import TYPE_CHECKING

from ravemj.engine.simulation import Simulation
from ravemj.gui.interaction import mode_buttons
from ravemj.gui.interaction.control_layout import ControlLayout
from ravemj.gui.interaction.control_panel import ControlPanel
from ravemj.gui.interaction.controls import Controls
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
from ravemj.gui.interaction.mode_buttons import ViewButton
from ravemj.gui.interaction.navigation import Navigation
from ravemj.gui.interaction.picking import Hit, pick
from ravemj.gui.interaction.selection import Selector
from ravemj.gui.interaction.shortcuts import KEYS
from ravemj.gui.interaction.viewpoint import Viewpoint
from ravemj.model.drawing import NOTHING, Primitives

if TYPE_CHECKING:
    from ravemj.gui.interaction.pulling import Pulling
    from ravemj.gui.interaction.reaching import Reach

WITHOUT_PHYSICS = "A right drag pulls links while physics runs: env.SetPhysicsEngine('mujoco')"

_CLICK = 4.0
"""Maximum pointer travel of a click [points]."""

_STEP = 0.9
"""Zoom factor of one wheel step."""


class Mode(Enum):
    """Mode of the left mouse button: it moves the camera, or it selects and drags."""

    CAMERA = "camera"
    INTERACTION = "interaction"


_Follow = Callable[[float, float], None]


class PointerController:
    """Handles the events of one view. The caller holds the simulation's lock, except in ``handle_view_event``.

    Attributes:
        mode: Camera or interaction mode.
        panel: The controls on the view.
        layout: Control layout of the last frame.
        has_tools: Whether the mode buttons and wheels of OpenRAVE's viewer are drawn.
        buttons: The mouse buttons that are held.
        pointer: Pointer position [points]; None outside the view.
    """

    def __init__(
        self, selector: Selector, navigation: Navigation, controls: Controls, *, has_tools: bool = True
    ) -> None:
        """Start in camera mode."""
        self._simulation: Simulation = selector.simulation
        self._selector, self._navigation, self._controls = selector, navigation, controls
        self.mode = Mode.CAMERA
        self.has_tools = has_tools
        self.panel = ControlPanel(controls, is_drawn=has_tools)
        self.layout = ControlLayout.arrange(
            (), navigation.view.size
        )  # until the first update: the constructor must not wait for the lock
        self.buttons: set[Button] = set()
        self.pointer: tuple[float, float] | None = None
        self._keys: set[str] = set()
        self._press: Press | None = None
        self._follow: _Follow | None = None
        self._pulling: Pulling | None = None
        self._reach: Reach | None = None
        self._steers = False

    @property
    def view(self) -> Viewpoint:
        """The viewpoint: the camera and its focus."""
        return self._navigation.view

    @view.setter
    def view(self, view: Viewpoint) -> None:
        self._navigation.view = view

    def update_layout(self) -> None:
        """Recompute the layout of the controls."""
        self.layout = self.panel.layout(self.view.size)

    def hovers(self) -> bool:
        """Update the layout; return whether the pointer is on a control or a body."""
        self.update_layout()
        return self.layout.covers(self.pointer) or self.hit() is not None

    def cancel_drag(self) -> None:
        """Cancel the current drag. Needs no simulation lock."""
        self._press = self._follow = self._reach = None
        if self._pulling is not None:
            self._pulling.end()
            self._pulling = None

    def primitives(self) -> Primitives:
        """Return the drawing of the current drag: the spring of a force, or the other IK solutions of an arm."""
        if self._pulling is not None:
            return self._pulling.primitives()
        return NOTHING if self._reach is None else self._reach.ghosts()

    def free_pointer(self) -> tuple[float, float] | None:
        """Return the pointer position; None while a button is held, outside the view, and on controls."""
        at = self.pointer
        if at is None or self.buttons or self.layout.covers(at):
            return None
        is_inside = all(0 <= place < length for place, length in zip(at, self.view.size, strict=True))
        return at if is_inside else None

    def hit(self) -> Hit | None:
        """Return the link under the pointer; None while a button is held."""
        at = self.free_pointer()
        return None if at is None else pick(self._simulation, self.view.ray(*at))

    def cursor(self) -> str:
        """Return the cursor shape for a pointer that is neither on a handle nor on a body."""
        is_tool = self.pointer is not None and self._button_at(Press(*self.pointer)) is not None
        if self.layout.field_at(self.pointer) is not None:
            return "text"
        if is_tool or self.layout.at(self.pointer) is not None:
            return "pointer"
        return "grab" if self.mode is Mode.CAMERA else "default"

    def handle_view_event(self, event: Event) -> bool:
        """Handle an event that changes only the view, without the lock; return False if it needs the bodies."""
        if self._needs_controls_or_bodies(event):
            return False
        match event:
            case Key(name, True) if name.lower() in KEYS:
                return self._controls.change_view(KEYS[name.lower()])
            case Operate(name):
                return self._controls.change_view(name)
            case _:
                self.handle(event)
                return True

    def _needs_controls_or_bodies(self, event: Event) -> bool:
        """Return whether an event may concern a body or a control, judged without access to either."""
        match event:
            case Press():
                return self.needs_bodies(event)
            case Move() | Release():
                return self._press is not None or (self._follow is not None and not self._steers)
            case Wheel():
                return self._reach is not None or self.layout.covers(self.pointer)
            case Key() | Type():
                return self.panel.is_typing
            case _:
                return False

    def needs_bodies(self, press: Press) -> bool:
        """Return whether the effect of a press depends on the bodies."""
        if self.layout.covers((press.x, press.y)):
            return True
        if self._button_at(press) is not None:
            return False
        centres = press.button is Button.LEFT and "s" in self._keys
        pulls = press.button is Button.RIGHT
        return press.touch or centres or pulls or self.mode is Mode.INTERACTION

    def _button_at(self, press: Press) -> ViewButton | None:
        return mode_buttons.button_at(self.view.size, press.x, press.y) if self.has_tools else None

    # --- events

    def handle(self, event: Event) -> None:
        """Handle an event."""
        match event:
            case Press():
                self._on_press(event)
            case Move(x, y):
                self._on_move(x, y)
            case Release():
                self._on_release(event)
            case Leave():
                self._on_leave()
            case _:
                self._handle_other(event)

    def _handle_other(self, event: Wheel | Fingers | Use | Key | Type | Operate | Resize) -> None:
        match event:
            case Wheel(steps):
                self._on_wheel(steps)
            case Fingers():
                self.view = self._navigation.focused().pinched(event)
            case Use(tool, amount):
                self._use(tool, amount)
            case Key(name, pressed):
                self._on_key(name.lower(), pressed)
            case Type(letter):
                self.panel.type(letter)
            case Operate(name, value):
                self._controls.operate(name, value)
            case Resize(width, height):
                self.view = replace(self.view, size=(max(width, 1), max(height, 1)))

    def _on_press(self, press: Press) -> None:
        self.buttons.add(press.button)
        self.cancel_drag()
        self.panel.stop_typing()
        self.pointer = press.x, press.y
        self._steers = not self.needs_bodies(press)
        tool = self._button_at(press)
        if self.layout.covers(self.pointer):
            self._follow = self.panel.press(press, self.layout)
        elif tool is not None:
            self._press_button(tool, press)
        elif press.touch:
            self._press = press
        elif press.button is Button.LEFT and "s" in self._keys:
            self._centre(press)
        elif press.button is Button.RIGHT:
            self._follow = self._start_pull(press)
        elif self.mode is Mode.CAMERA:
            self._move_camera(press)
        elif press.button is Button.LEFT:
            self._press = press

    def _on_move(self, x: float, y: float) -> None:
        self.pointer = x, y
        press = self._press
        if press is not None and self._follow is None and math.hypot(x - press.x, y - press.y) > _CLICK:
            self._press, self._follow = None, self._start_drag(press)
        if self._follow is not None:
            self._follow(x, y)

    def _on_release(self, release: Release) -> None:
        self._on_move(release.x, release.y)
        self.buttons.discard(release.button)
        press = self._press
        self.cancel_drag()
        if press is not None and press.button is release.button:
            self._selector.click(self.view, press)
            if press.touch and self._selector.selection is not None:
                self._set_mode(Mode.INTERACTION)  # so that the next touch can drag the handle

    def _on_wheel(self, steps: float) -> None:
        if self._reach is not None:
            self._reach.sweep(steps)
        elif self.layout.covers(self.pointer):
            self.panel.scroll(self.layout, steps)
        elif self.mode is Mode.CAMERA:
            self.view = self._navigation.focused().zoomed(math.log(_STEP) * steps)

    def _on_key(self, name: str, pressed: bool) -> None:
        if not pressed:
            self._keys.discard(name)
            return
        if self.panel.is_typing:
            self.panel.key(name)
            return
        if name == "escape" and self._controls.unfolded == "help":
            self._controls.unfolded = ""
        elif name == "escape" and name not in self._keys:
            self._set_mode(Mode.INTERACTION if self.mode is Mode.CAMERA else Mode.CAMERA)
        elif name not in self._keys and KEYS.get(name) == "pin":
            self._selector.toggle_pin(self.hit())
        elif name not in self._keys:
            self.panel.key(name)
        self._keys.add(name)

    def _on_leave(self) -> None:
        self.buttons.clear()
        self._keys.clear()
        self.pointer = None
        self.cancel_drag()

    def _set_mode(self, mode: Mode) -> None:
        self.mode = mode
        self.cancel_drag()

    def _press_button(self, tool: ViewButton, press: Press) -> None:
        """Activate a mode button, or start a drag of a camera wheel."""
        if press.button is not Button.LEFT:
            return
        if tool in (ViewButton.INTERACT, ViewButton.CAMERA):
            self._use(tool)
        else:
            view = self._navigation.focused()
            aside = tool is ViewButton.ROT_Y
            self._follow = self._view_drag(press, lambda right, down: view.rolled(tool, right if aside else down))

    def _use(self, tool: ViewButton, amount: float = 0.0) -> None:
        if tool is ViewButton.INTERACT:
            self._set_mode(Mode.INTERACTION)
        elif tool is ViewButton.CAMERA:
            self._set_mode(Mode.CAMERA)
        else:
            self.view = self._navigation.focused().rolled(tool, amount)

    # --- the camera

    def _view_drag(self, press: Press, change: Callable[[float, float], Viewpoint]) -> _Follow:
        """Return a drag callback that passes the pointer's displacement to ``change`` and shows the resulting view."""

        def follow(x: float, y: float) -> None:
            self.view = replace(change(x - press.x, y - press.y), size=self.view.size)

        return follow

    def _move_camera(self, press: Press) -> None:
        view = self._navigation.focused()
        if {Button.LEFT, Button.MIDDLE} <= self.buttons:
            self._follow = self._view_drag(press, lambda _, down: view.rolled(ViewButton.DOLLY, down))
        elif press.button is Button.MIDDLE or (press.button is Button.LEFT and press.shift):
            self._follow = self._view_drag(press, view.shifted)
        elif press.button is Button.LEFT:
            self._follow = self._view_drag(press, view.turned)

    def _centre(self, press: Press) -> None:
        hit = pick(self._simulation, self.view.ray(press.x, press.y))
        if hit is not None:
            self.view = self.view.centred(hit.position)

    def _start_drag(self, press: Press) -> _Follow | None:
        """Start a drag of the handle or link under the press, or, by touch, of the view; None if nothing moves."""
        takes = self.mode is Mode.INTERACTION and not self._selector.is_fixed
        if takes and ((press.ctrl and press.shift) or self._controls.pulls):
            return self._start_reach(press)
        follow = self._selector.start_drag(self.view, press) if takes else None
        selection = self._selector.selection
        if follow is not None and selection is not None:
            self._controls.pause_motion(selection.body)
            return lambda x, y: follow(self.view.ray(x, y))
        return self._view_drag(press, self._navigation.focused().turned) if press.touch else None

    def _start_reach(self, press: Press) -> _Follow | None:
        """Start a drag of the link under the press by inverse kinematics; None if there is no link that can move."""
        self._reach = reach = self._selector.start_reach(self.view, press)
        if reach is None:
            return None
        self._controls.pause_motion(reach.body)
        self._controls.reach = reach
        return lambda x, y: reach.follow(self.view.ray(x, y))

    def _start_pull(self, press: Press) -> _Follow | None:
        """Start pulling the link under the press by a force; None if there is no link or no physics."""
        hit = pick(self._simulation, self.view.ray(press.x, press.y))
        if hit is None:
            return None
        physics = self._simulation.physics
        if physics is None:
            self._controls.notices.say(WITHOUT_PHYSICS)
            return None
        from ravemj.gui.interaction.pulling import Pulling  # noqa: PLC0415 - slow to import

        self._pulling = Pulling(physics, hit)
        follow = self._pulling.follow(self.view.camera.rotation[:, 2])
        return lambda x, y: follow(self.view.ray(x, y))
