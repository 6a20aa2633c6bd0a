"""Entry point of interaction: maps events to changes of bodies, camera and overlay.

It needs neither a window nor OpenGL. A shell (window or page) passes events in, and draws the model from
``view.camera`` with the drawings, texts and rectangles of ``overlay()``.
"""

from collections.abc import Sequence
from dataclasses import replace

from ravemj.engine.simulation import BodyState, Simulation
from ravemj.graphics.rendering import Camera, Style
from ravemj.gui.interaction import mode_buttons
from ravemj.gui.interaction.controls import Controls, Display
from ravemj.gui.interaction.events import Event, Key, Move, Press, Release, Wheel
from ravemj.gui.interaction.figures import figures, floor_grid, floor_labels, names
from ravemj.gui.interaction.mode_buttons import ViewButton
from ravemj.gui.interaction.navigation import Navigation
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.overlay import Label, Overlay
from ravemj.gui.interaction.picking import Hit
from ravemj.gui.interaction.pointer_controller import Mode, PointerController
from ravemj.gui.interaction.selection import OnSelect, Selection, Selector, point_line
from ravemj.gui.interaction.shortcuts import sections
from ravemj.gui.interaction.time_controls import TimeControls
from ravemj.gui.interaction.viewpoint import Viewpoint
from ravemj.model.drawing import NOTHING, Primitives, merge


class Interaction:
    """Pointer and keyboard interaction of one view of a simulation.

    Attributes:
        controls: The buttons and sliders, except for OpenRAVE's mode buttons and wheels.
    """

    def __init__(
        self, selector: Selector, navigation: Navigation, controls: Controls, *, has_tools: bool = True
    ) -> None:
        self._simulation = selector.simulation
        self._selector, self._navigation, self.controls = selector, navigation, controls
        self._controller = PointerController(selector, navigation, controls, has_tools=has_tools)
        self._changes = 0
        self._hovered = False

    @classmethod
    def first_view(
        cls, simulation: Simulation, camera: Camera, size: tuple[int, int], on_select: OnSelect | None = None
    ) -> "Interaction":
        """Return the interaction of a view of a size [points], in camera mode, with nothing selected.

        ``on_select`` is called before each selection, with the simulation locked.
        """
        notices = Notices()
        selector = Selector(simulation, notices, on_select)
        navigation = Navigation(Viewpoint(camera, 0.0, size), simulation)
        controls = Controls(selector, navigation, TimeControls(simulation, notices), notices, Display())
        return cls(selector, navigation, controls)

    def another_view(self, *, has_tools: bool = True) -> "Interaction":
        """Return the interaction of another view with the same selection; ``has_tools``: with mode buttons."""
        navigation = self._navigation.another()
        other = Interaction(self._selector, navigation, self.controls.another(navigation), has_tools=has_tools)
        other._controller.mode = self.mode
        return other

    @property
    def mode(self) -> Mode:
        """Camera or interaction mode."""
        return self._controller.mode

    @property
    def appearance(self) -> object:
        """A key that changes when the view must be redrawn, except for movements of bodies."""
        return self._changes, self._selector.changes, self.controls.appearance

    @property
    def view(self) -> Viewpoint:
        """The viewpoint: the camera and its focus."""
        return self._navigation.view

    @view.setter
    def view(self, view: Viewpoint) -> None:
        self._navigation.view = view

    @property
    def drawn_view(self) -> Viewpoint:
        """The viewpoint to draw from; it lags ``view`` while the camera glides."""
        return self._navigation.drawn

    def copy_view(self, view: Viewpoint) -> None:
        """Copy the camera of another view. Needs no lock."""
        self.view = replace(self.view, camera=view.camera, distance=view.distance)

    def look_from(self, camera: Camera, distance: float = 0.0) -> None:
        """Set the camera and make it the home view; ``distance`` to the focus [m], 0 keeps the previous one.

        A camera drag in progress is cancelled.
        """
        with self._simulation.lock:
            if self.mode is Mode.CAMERA:
                self._controller.cancel_drag()
            self.view = replace(self.view, camera=camera, distance=distance or self.view.distance)
            self._navigation.set_home()
            self._changes += 1

    def cancel_drag(self) -> None:
        """Cancel the current drag, for instance when the window is closed. Needs no lock."""
        self._controller.cancel_drag()

    def handle(self, event: Event) -> None:
        """Handle an event, with the simulation locked."""
        with self._simulation.lock:
            self._drop_removed()
            if isinstance(event, Press | Wheel):
                self._controller.update_layout()  # scripts may have changed the controls
            self._controller.handle(event)
            hovers = self._controller.hovers()
            if not isinstance(event, Move) or self._controller.buttons or hovers or self._hovered:
                self._changes += 1
            self._hovered = hovers

    @property
    def selection(self) -> Selection | None:
        """The selection, or None."""
        with self._simulation.lock:
            self._drop_removed()
            return self._selector.selection

    def select(self, selection: Selection | None) -> None:
        """Set the selection without calling ``on_select``."""
        with self._simulation.lock:
            self._selector.selection = selection
            self._selector.changes += 1  # all views show it

    def choose(self, body: BodyState) -> None:
        """Select a body like a click on its first link."""
        with self._simulation.lock:
            self._selector.choose(self.view, body, 0)

    def forbid_drags(self) -> None:
        """Forbid moving bodies and joints in all views; camera, selection and playback still work."""
        self._selector.is_fixed = True

    @property
    def hover(self) -> Hit | None:
        """The link under the pointer; None while a button is held."""
        with self._simulation.lock:
            return self._controller.hit()

    def advance(self, now: float) -> None:
        """Advance motions and the camera to ``now`` (``time.monotonic``); called before each frame, under the lock."""
        self.controls.advance(now)

    def overlay(self) -> Overlay:
        """Return the overlay for the current state; locks the simulation."""
        with self._simulation.lock:
            self._drop_removed()
            controller, shown = self._controller, self.controls.display.shown
            controller.update_layout()
            if self.view.distance <= 0:
                self._navigation.scene_sphere()  # cache it: it may be needed while others hold the lock
            hit = controller.hit()
            lines = *self._pointed_at(hit), *self._selector.lines(), *self.controls.notices.lines
            chosen = ViewButton.CAMERA if self.mode is Mode.CAMERA else ViewButton.INTERACT
            tools = mode_buttons.panels(self.view.size, chosen) if controller.has_tools else ()
            mark = self._highlight(hit)
            takes_link = mark is None and hit is not None and self.mode is Mode.INTERACTION
            parts = [self._selector.primitives(), self._controller.primitives(), mark or NOTHING]
            labels = tuple(Label(point, text) for point, text in self._simulation.drawings.texts())
            if shown:
                sphere = self._navigation.scene_sphere()
                parts += figures(self._simulation, shown, sphere[1])
                labels += names(self._simulation) if "names" in shown else ()
                if "floor" in shown:
                    parts.append(floor_grid(*sphere))
                    labels += floor_labels(*sphere)
            return Overlay(
                primitives=merge(parts) if any(map(len, parts)) else NOTHING,
                lines=lines,
                panels=(*tools, *controller.layout.panels()),
                controls=self.controls.all(),
                labels=labels,
                help=sections() if self.controls.unfolded == "help" else (),
                tree=self.controls.tree(),
                chosen=self.controls.chosen,
                style=Style(
                    *(name in shown for name in ("collision", "hulls", "transparent", "wireframe")),
                    lit=self._lit(hit if takes_link else None),
                ),
                cursor="move" if mark is not None else "pointer" if takes_link else controller.cursor(),
                text_size=self.controls.notices.text_size,
            )

    def _highlight(self, hit: Hit | None) -> Primitives | None:
        """Return the highlight of the handle under the pointer; None if there is none."""
        at = self._controller.free_pointer()
        is_fixed = self.mode is Mode.CAMERA or self._selector.is_fixed
        return None if at is None or is_fixed else self._selector.highlight(self.view, at, hit)

    def _lit(self, hit: Hit | None) -> int:
        """Return MuJoCo's id of the link under the pointer, or else of that selected in the tree; -1 if none."""
        part = hit or (self._selector.selection if self.controls.unfolded == "tree" else None)
        return -1 if part is None else int(self._simulation.compiled().part(part.body).body_ids[part.link])

    def _pointed_at(self, hit: Hit | None) -> list[str]:
        """Return a line that describes the point or control under the pointer, else the clicked point; or no line."""
        control = self._controller.layout.at(self._controller.pointer)
        text = self._selector.point_line()
        if hit is not None:
            text = point_line(hit.body, hit.link, hit.position, hit.normal)
        elif control is not None:
            text = control.label
        return [text] if text else []

    def _drop_removed(self) -> None:
        if self._selector.drop_removed():
            self._controller.cancel_drag()

    # --- while others hold the lock

    def handle_view_events(self, events: Sequence[Event]) -> list[Event]:
        """Handle the events that change only the view, while other threads hold the simulation's lock.

        Returns:
            The events that need the simulation. Clicks made before the view changed are dropped.
        """
        waiting: list[Event] = []
        for event in events:
            is_pointer = isinstance(event, Press | Move | Release)
            if isinstance(event, Press) and not self._controller.needs_bodies(event):
                waiting = _without_clicks(waiting)
            follows = is_pointer and any(isinstance(other, Press) for other in waiting)
            follows |= isinstance(event, Key) and not event.pressed and Key(event.name) in waiting
            before = self.view
            if follows or not self._controller.handle_view_event(event):
                waiting.append(event)
            elif self.view is not before:
                waiting = _without_clicks(waiting)
        return waiting

    def advance_view(self, now: float) -> None:
        """Advance the camera's glide while other threads hold the lock; ``now`` is from ``time.monotonic``."""
        self._navigation.advance(now)


def _without_clicks(events: list[Event]) -> list[Event]:
    """Drop presses, moves and releases of the pointer, from the first press on."""
    presses = (number for number, event in enumerate(events) if isinstance(event, Press))
    first = next(presses, len(events))
    return [*events[:first], *(event for event in events[first:] if not isinstance(event, Press | Move | Release))]
