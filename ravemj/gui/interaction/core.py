"""What the mouse and the keys do: events in, changes of bodies, of the camera and of what is drawn out.

There is no window and no OpenGL here. A shell hands in events, and draws a model from ``view.camera`` with the
figures, the text and the rectangles of ``overlay()``.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from enum import Enum
from typing import NamedTuple

from ravemj.engine.simulation import Simulation
from ravemj.graphics.rendering import Camera, bounding_sphere
from ravemj.gui.interaction import mode_buttons
from ravemj.gui.interaction.control_layout import ControlLayout
from ravemj.gui.interaction.control_panel import ControlPanel
from ravemj.gui.interaction.controls import Control, Controls
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
    Use,
    Wheel,
)
from ravemj.gui.interaction.mode_buttons import Panel, Tool
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.picking import Hit, pick
from ravemj.gui.interaction.playback import Playback
from ravemj.gui.interaction.selection import OnSelect, Selection, Selector, point_line
from ravemj.gui.interaction.viewpoint import View
from ravemj.model.drawing import Primitives

_CLICK = 4.0
"""Farthest way of the pointer [points] between press and release of a click."""

_STEP = 0.9
"""How much nearer a step of the wheel brings the focus."""


class Mode(Enum):
    """What the left button does."""

    CAMERA = "camera"
    INTERACTION = "interaction"


class Overlay(NamedTuple):
    """What is drawn over the bodies.

    Attributes:
        primitives: Figures in the world.
        lines: Text for the top left corner.
        panels: Buttons, wheels and sliders, for a shell that has none of its own.
        controls: What the buttons and sliders beside the tutorial's are, as plain data.
    """

    primitives: Primitives
    lines: tuple[str, ...]
    panels: tuple[Panel, ...]
    controls: tuple[Control, ...] = ()


_Follow = Callable[[float, float], None]


class Interaction:
    """The mouse and the keys of one view on a simulation.

    Attributes:
        view: The camera.
        mode: What the left button does.
        controls: The buttons and sliders beside the tutorial's.
    """

    def __init__(
        self, simulation: Simulation, camera: Camera, size: tuple[int, int], on_select: OnSelect | None = None
    ) -> None:
        """Begin in camera mode.

        Args:
            simulation: What is seen and moved.
            camera: Where from.
            size: Width and height of the view [points].
            on_select: Asked before something is selected, with the simulation locked.
        """
        self._simulation = simulation
        self.view = View(camera, 0.0, size)
        self.mode = Mode.CAMERA
        self._selector = Selector(simulation, on_select)
        self.controls = Controls(simulation, self._selector, Playback(simulation), Notices())
        self._panel = ControlPanel(self.controls)
        self._has_tools = True
        self._changes = 0
        self._pointer: tuple[float, float] | None = None
        self._hovered = False
        self._buttons: set[Button] = set()
        self._keys: set[str] = set()
        self._press: Press | None = None
        self._follow: _Follow | None = None

    def another_view(self, *, has_tools: bool = True) -> "Interaction":
        """Return the mouse and the keys of another view on the same simulation; they share what is selected.

        Args:
            has_tools: False where the shell has buttons and wheels of its own, which ``Use`` them.
        """
        other = Interaction(self._simulation, self.view.camera, self.view.size)
        other.view, other.mode = self.view, self.mode
        other._selector = self._selector
        other.controls = self.controls.another()
        other._panel = ControlPanel(other.controls, is_drawn=has_tools)
        other._has_tools = has_tools
        return other

    @property
    def version(self) -> int:
        """A number that grows with what changes the view and the overlay; what moves bodies changes these as well."""
        return self._changes + self._selector.changes + self.controls.changes

    def look_from(self, camera: Camera, distance: float = 0.0) -> None:
        """Take another camera; what the mouse does with the old one ends.

        Args:
            camera: The camera.
            distance: How far its focus is [m]; 0: as far as before.
        """
        with self._simulation.lock:
            if self.mode is Mode.CAMERA:
                self._follow = None
            self.view = replace(self.view, camera=camera, distance=distance or self.view.distance)
            self._changes += 1

    def handle(self, event: Event) -> None:
        """Do what an event asks for. The simulation is locked meanwhile."""
        with self._simulation.lock:
            self._forget_what_is_gone()
            self._do(event)
            layout = self._panel.layout(self.view.size)
            hovers = layout.covers(self._pointer) or self._hit(layout) is not None
            if not isinstance(event, Move) or self._buttons or hovers or self._hovered:
                self._changes += 1
            self._hovered = hovers

    @property
    def selection(self) -> Selection | None:
        """What is selected, or None."""
        with self._simulation.lock:
            self._forget_what_is_gone()
            return self._selector.selection

    @property
    def hover(self) -> Hit | None:
        """What is under the pointer now; None while a button is held."""
        with self._simulation.lock:
            return self._hit(self._panel.layout(self.view.size))

    def _hit(self, layout: ControlLayout) -> Hit | None:
        at = self._pointer
        if at is None or self._buttons or layout.covers(at):
            return None
        if not all(0 <= place < length for place, length in zip(at, self.view.size, strict=True)):
            return None
        return pick(self._simulation, self.view.ray(*at))

    def pass_time(self, now: float) -> None:
        """Let a motion that plays go on; who draws calls this before each picture, with the simulation locked.

        Args:
            now: What ``time.monotonic`` says.
        """
        self.controls.pass_time(now)

    def overlay(self) -> Overlay:
        """Return what is to be drawn over the bodies as they are now. The simulation is locked meanwhile."""
        with self._simulation.lock:
            self._forget_what_is_gone()
            chosen = Tool.CAMERA if self.mode is Mode.CAMERA else Tool.INTERACT
            at, layout = self._selector.point_line(), self._panel.layout(self.view.size)
            hit, control = self._hit(layout), layout.at(self._pointer)
            if hit is not None:
                at = point_line(hit.body, hit.link, hit.position, hit.normal)
            elif control is not None:
                at = control.label
            lines = (*([at] if at else []), *self._selector.lines(), *self.controls.notices.lines)
            tools = mode_buttons.panels(self.view.size, chosen) if self._has_tools else ()
            panels = *tools, *layout.panels()
            return Overlay(self._selector.primitives(), lines, panels, self.controls.all())

    def _forget_what_is_gone(self) -> None:
        if self._selector.forget_what_is_gone():
            self._press = self._follow = None

    # --- events

    def _do(self, event: Event) -> None:
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

    def _do_without_pointer(self, event: Wheel | Fingers | Use | Key | Operate | Resize) -> None:
        match event:
            case Wheel(steps):
                self._on_wheel(steps)
            case Fingers():
                self.view = self._focused().pinched(event)
            case Use(tool, amount):
                self._use(tool, amount)
            case Key(name, pressed):
                self._on_key(name.lower(), pressed)
            case Operate(name, value):
                self.controls.operate(name, value)
            case Resize(width, height):
                self.view = replace(self.view, size=(max(width, 1), max(height, 1)))

    def _on_press(self, press: Press) -> None:
        self._buttons.add(press.button)
        self._press = self._follow = None
        self._pointer = press.x, press.y
        tool = mode_buttons.tool_at(self.view.size, press.x, press.y) if self._has_tools else None
        layout = self._panel.layout(self.view.size)
        if layout.covers(self._pointer):
            self._follow = self._panel.press(press, layout)
        elif tool is not None:
            self._press_tool(tool, press)
        elif press.touch:
            self._press = press
        elif press.button is Button.LEFT and "s" in self._keys:
            self._centre(press)
        elif self.mode is Mode.CAMERA:
            self._move_camera(press)
        elif press.button is Button.LEFT:
            self._press = press

    def _on_move(self, x: float, y: float) -> None:
        self._pointer = x, y
        press = self._press
        if press is not None and self._follow is None and math.hypot(x - press.x, y - press.y) > _CLICK:
            self._press, self._follow = None, self._hold(press)
        if self._follow is not None:
            self._follow(x, y)

    def _on_release(self, release: Release) -> None:
        self._on_move(release.x, release.y)
        self._buttons.discard(release.button)
        press, self._press, self._follow = self._press, None, None
        if press is not None and press.button is release.button:
            self._selector.click(self.view, press)
            if press.touch and self._selector.selection is not None:
                self._set_mode(Mode.INTERACTION)  # what has appeared can be dragged

    def _on_wheel(self, steps: float) -> None:
        layout = self._panel.layout(self.view.size)
        if layout.covers(self._pointer):
            self._panel.scroll(layout, steps)
        elif self.mode is Mode.CAMERA:
            self.view = self._focused().zoomed(math.log(_STEP) * steps)

    def _on_key(self, name: str, pressed: bool) -> None:
        if not pressed:
            self._keys.discard(name)
            return
        if name == "escape" and name not in self._keys:
            self._set_mode(Mode.INTERACTION if self.mode is Mode.CAMERA else Mode.CAMERA)
        elif name not in self._keys:
            self._panel.key(name)
        self._keys.add(name)

    def _on_leave(self) -> None:
        self._buttons.clear()
        self._keys.clear()
        self._press = self._follow = self._pointer = None

    def _set_mode(self, mode: Mode) -> None:
        self.mode = mode
        self._press = self._follow = None

    def _press_tool(self, tool: Tool, press: Press) -> None:
        """Press a button, or hold one of the wheels."""
        if press.button is not Button.LEFT:
            return
        if tool in (Tool.INTERACT, Tool.CAMERA):
            self._use(tool)
        else:
            view = self._focused()
            aside = tool is Tool.ROT_Y
            self._follow = self._steered(press, lambda right, down: view.rolled(tool, right if aside else down))

    def _use(self, tool: Tool, amount: float = 0.0) -> None:
        if tool is Tool.INTERACT:
            self._set_mode(Mode.INTERACTION)
        elif tool is Tool.CAMERA:
            self._set_mode(Mode.CAMERA)
        else:
            self.view = self._focused().rolled(tool, amount)

    # --- the camera

    def _focused(self) -> View:
        """Return the view with a focus: before one was set, as deep as the middle of the scene."""
        if self.view.distance > 0:
            return self.view
        compiled = self._simulation.compiled()
        center, radius = bounding_sphere(compiled.model, compiled.data)
        depth = float((center - self.view.camera.position) @ self.view.camera.rotation[:, 2])
        return replace(self.view, distance=depth if depth > 0 else radius)

    def _steered(self, press: Press, change: Callable[[float, float], View]) -> _Follow:
        """Return what changes the view by how far the pointer goes from here."""

        def follow(x: float, y: float) -> None:
            self.view = replace(change(x - press.x, y - press.y), size=self.view.size)

        return follow

    def _move_camera(self, press: Press) -> None:
        view = self._focused()
        if {Button.LEFT, Button.MIDDLE} <= self._buttons:
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
        follow = self._selector.hold(self.view, press) if self.mode is Mode.INTERACTION else None
        selection = self._selector.selection
        if follow is not None and selection is not None:
            self.controls.take(selection.body)
            return lambda x, y: follow(self.view.ray(x, y))
        return self._steered(press, self._focused().turned) if press.touch else None
