"""The mouse and the keys of one view: what is held, and which part of the view each event is for."""

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
from ravemj.gui.interaction.mode_buttons import Tool
from ravemj.gui.interaction.navigation import Navigation
from ravemj.gui.interaction.picking import Hit, pick
from ravemj.gui.interaction.selection import Selector
from ravemj.gui.interaction.shortcuts import KEYS
from ravemj.gui.interaction.viewpoint import View
from ravemj.model.drawing import NOTHING, Primitives

if TYPE_CHECKING:
    from ravemj.gui.interaction.pulling import Pulling
    from ravemj.gui.interaction.reaching import Reach

WITHOUT_PHYSICS = "A right drag pulls links while physics runs: env.SetPhysicsEngine('mujoco')"

_CLICK = 4.0
"""Farthest way of the pointer [points] between press and release of a click."""

_STEP = 0.9
"""How much nearer a step of the wheel brings the focus."""


class Mode(Enum):
    """What the left button does."""

    CAMERA = "camera"
    INTERACTION = "interaction"


_Follow = Callable[[float, float], None]


class Hand:
    """Does what events ask for. The simulation is locked by the caller, but for ``steer``.

    Attributes:
        mode: What the left button does.
        panel: The controls on the view.
        layout: Where these are, as was found last.
        has_tools: Whether the tutorial's buttons and wheels are on the view.
        buttons: The buttons of the mouse that are held.
        pointer: Where the pointer is [points], or None.
    """

    def __init__(
        self, selector: Selector, navigation: Navigation, controls: Controls, *, has_tools: bool = True
    ) -> None:
        """Begin in camera mode, with nothing held."""
        self._simulation: Simulation = selector.simulation
        self._selector, self._navigation, self._controls = selector, navigation, controls
        self.mode = Mode.CAMERA
        self.has_tools = has_tools
        self.panel = ControlPanel(controls, is_drawn=has_tools)
        self.layout = ControlLayout.of((), navigation.view.size)  # until it is looked: this must not wait for bodies
        self.buttons: set[Button] = set()
        self.pointer: tuple[float, float] | None = None
        self._keys: set[str] = set()
        self._press: Press | None = None
        self._follow: _Follow | None = None
        self._pulling: Pulling | None = None
        self._reach: Reach | None = None
        self._steers = False

    @property
    def view(self) -> View:
        """The camera."""
        return self._navigation.view

    @view.setter
    def view(self, view: View) -> None:
        self._navigation.view = view

    def look(self) -> None:
        """See where the controls are now."""
        self.layout = self.panel.layout(self.view.size)

    def hovers(self) -> bool:
        """See where the controls are now, and return whether the pointer is on one, or on a body."""
        self.look()
        return self.layout.covers(self.pointer) or self.hit() is not None

    def let_go(self) -> None:
        """End what is being dragged; the simulation need not be locked."""
        self._press = self._follow = self._reach = None
        if self._pulling is not None:
            self._pulling.end()
            self._pulling = None

    def primitives(self) -> Primitives:
        """Return the spring that pulls, or the other configurations of an arm that is pulled."""
        if self._pulling is not None:
            return self._pulling.primitives()
        return NOTHING if self._reach is None else self._reach.ghosts()

    def free_pointer(self) -> tuple[float, float] | None:
        """Return where the pointer is on the view; None while a button is held, and over controls."""
        at = self.pointer
        if at is None or self.buttons or self.layout.covers(at):
            return None
        is_inside = all(0 <= place < length for place, length in zip(at, self.view.size, strict=True))
        return at if is_inside else None

    def hit(self) -> Hit | None:
        """Return what is under the pointer; None while a button is held."""
        at = self.free_pointer()
        return None if at is None else pick(self._simulation, self.view.ray(*at))

    def cursor(self) -> str:
        """Return how the pointer looks where there is nothing to take."""
        is_tool = self.pointer is not None and self._tool_at(Press(*self.pointer)) is not None
        if self.layout.field_at(self.pointer) is not None:
            return "text"
        if is_tool or self.layout.at(self.pointer) is not None:
            return "pointer"
        return "grab" if self.mode is Mode.CAMERA else "default"

    def steer(self, event: Event) -> bool:
        """Do what an event asks for if that needs no bodies; return whether it was done."""
        if self._needs_what_is_shown(event):
            return False
        match event:
            case Key(name, True) if name.lower() in KEYS:
                return self._controls.steer(KEYS[name.lower()])
            case Operate(name):
                return self._controls.steer(name)
            case _:
                self.do(event)
                return True

    def _needs_what_is_shown(self, event: Event) -> bool:
        """Return whether an event is for a body or a control, as far as the event and the hand say."""
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
        """Return whether it takes the bodies to know what a press does."""
        if self.layout.covers((press.x, press.y)):
            return True
        if self._tool_at(press) is not None:
            return False
        centres = press.button is Button.LEFT and "s" in self._keys
        pulls = press.button is Button.RIGHT
        return press.touch or centres or pulls or self.mode is Mode.INTERACTION

    def _tool_at(self, press: Press) -> Tool | None:
        return mode_buttons.tool_at(self.view.size, press.x, press.y) if self.has_tools else None

    # --- events

    def do(self, event: Event) -> None:
        """Do what an event asks for."""
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
                self._do_without_pointer(event)

    def _do_without_pointer(self, event: Wheel | Fingers | Use | Key | Type | Operate | Resize) -> None:
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
        self.let_go()
        self.panel.stop_typing()
        self.pointer = press.x, press.y
        self._steers = not self.needs_bodies(press)
        tool = self._tool_at(press)
        if self.layout.covers(self.pointer):
            self._follow = self.panel.press(press, self.layout)
        elif tool is not None:
            self._press_tool(tool, press)
        elif press.touch:
            self._press = press
        elif press.button is Button.LEFT and "s" in self._keys:
            self._centre(press)
        elif press.button is Button.RIGHT:
            self._follow = self._pull(press)
        elif self.mode is Mode.CAMERA:
            self._move_camera(press)
        elif press.button is Button.LEFT:
            self._press = press

    def _on_move(self, x: float, y: float) -> None:
        self.pointer = x, y
        press = self._press
        if press is not None and self._follow is None and math.hypot(x - press.x, y - press.y) > _CLICK:
            self._press, self._follow = None, self._hold(press)
        if self._follow is not None:
            self._follow(x, y)

    def _on_release(self, release: Release) -> None:
        self._on_move(release.x, release.y)
        self.buttons.discard(release.button)
        press = self._press
        self.let_go()
        if press is not None and press.button is release.button:
            self._selector.click(self.view, press)
            if press.touch and self._selector.selection is not None:
                self._set_mode(Mode.INTERACTION)  # what has appeared can be dragged

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
        elif name not in self._keys:
            self.panel.key(name)
        self._keys.add(name)

    def _on_leave(self) -> None:
        self.buttons.clear()
        self._keys.clear()
        self.pointer = None
        self.let_go()

    def _set_mode(self, mode: Mode) -> None:
        self.mode = mode
        self.let_go()

    def _press_tool(self, tool: Tool, press: Press) -> None:
        """Press a button, or hold one of the wheels."""
        if press.button is not Button.LEFT:
            return
        if tool in (Tool.INTERACT, Tool.CAMERA):
            self._use(tool)
        else:
            view = self._navigation.focused()
            aside = tool is Tool.ROT_Y
            self._follow = self._steered(press, lambda right, down: view.rolled(tool, right if aside else down))

    def _use(self, tool: Tool, amount: float = 0.0) -> None:
        if tool is Tool.INTERACT:
            self._set_mode(Mode.INTERACTION)
        elif tool is Tool.CAMERA:
            self._set_mode(Mode.CAMERA)
        else:
            self.view = self._navigation.focused().rolled(tool, amount)

    # --- the camera

    def _steered(self, press: Press, change: Callable[[float, float], View]) -> _Follow:
        """Return what changes the view by how far the pointer goes from here."""

        def follow(x: float, y: float) -> None:
            self.view = replace(change(x - press.x, y - press.y), size=self.view.size)

        return follow

    def _move_camera(self, press: Press) -> None:
        view = self._navigation.focused()
        if {Button.LEFT, Button.MIDDLE} <= self.buttons:
            self._follow = self._steered(press, lambda _, down: view.rolled(Tool.DOLLY, down))
        elif press.button is Button.MIDDLE or (press.button is Button.LEFT and press.shift):
            self._follow = self._steered(press, view.shifted)
        elif press.button is Button.LEFT:
            self._follow = self._steered(press, view.turned)

    def _centre(self, press: Press) -> None:
        hit = pick(self._simulation, self.view.ray(press.x, press.y))
        if hit is not None:
            self.view = self.view.centred(hit.position)

    def _hold(self, press: Press) -> _Follow | None:
        """Take hold of the cube or the cylinder where the button went down; fingers turn the view elsewhere."""
        pulls = (press.ctrl and press.shift) or self._controls.pulls
        if self.mode is Mode.INTERACTION and pulls:
            return self._hold_link(press)
        follow = self._selector.hold(self.view, press) if self.mode is Mode.INTERACTION else None
        selection = self._selector.selection
        if follow is not None and selection is not None:
            self._controls.take(selection.body)
            return lambda x, y: follow(self.view.ray(x, y))
        return self._steered(press, self._navigation.focused().turned) if press.touch else None

    def _hold_link(self, press: Press) -> _Follow | None:
        """Take hold of a link, so that its arm comes along."""
        self._reach = reach = self._selector.reach(self.view, press)
        if reach is None:
            return None
        self._controls.take(reach.body)
        self._controls.reach = reach
        return lambda x, y: reach.follow(self.view.ray(x, y))

    def _pull(self, press: Press) -> _Follow | None:
        """Pull the link where the button went down with a force."""
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
