"""What the mouse and the keys do: events in, changes of bodies, of the camera and of what is drawn out.

There is no window and no OpenGL here. A shell hands in events, and draws a model from ``view.camera`` with the
figures, the text and the rectangles of ``overlay()``.
"""

from collections.abc import Sequence
from dataclasses import replace

from ravemj.engine.simulation import BodyState, Simulation
from ravemj.graphics.rendering import Camera, Style
from ravemj.gui.interaction import mode_buttons
from ravemj.gui.interaction.controls import Controls, Display
from ravemj.gui.interaction.events import Event, Key, Move, Press, Release, Wheel
from ravemj.gui.interaction.figures import figures, floor_grid, floor_labels, names
from ravemj.gui.interaction.hand import Hand, Mode
from ravemj.gui.interaction.mode_buttons import Tool
from ravemj.gui.interaction.navigation import Navigation
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.overlay import Label, Overlay
from ravemj.gui.interaction.picking import Hit
from ravemj.gui.interaction.selection import OnSelect, Selection, Selector, point_line
from ravemj.gui.interaction.shortcuts import sections
from ravemj.gui.interaction.time_controls import TimeControls
from ravemj.gui.interaction.viewpoint import View
from ravemj.model.drawing import NOTHING, Primitives, merge


class Interaction:
    """The mouse and the keys of one view on a simulation.

    Attributes:
        controls: The buttons and sliders beside the tutorial's.
    """

    def __init__(
        self, simulation: Simulation, camera: Camera, size: tuple[int, int], on_select: OnSelect | None = None
    ) -> None:
        """Begin in camera mode, with a view of some size [points].

        ``on_select`` is asked before something is selected, with the simulation locked.
        """
        self._simulation = simulation
        self._navigation = Navigation(View(camera, 0.0, size), simulation)
        notices = Notices()
        self._selector = Selector(simulation, notices, on_select)
        self.controls = Controls(
            self._selector, self._navigation, TimeControls(simulation, notices), notices, Display()
        )
        self._hand = Hand(self._selector, self._navigation, self.controls)
        self._changes = 0
        self._hovered = False

    def another_view(self, *, has_tools: bool = True) -> "Interaction":
        """Return the interaction of another view with the same selection; without tools, the shell has its own."""
        other = Interaction(self._simulation, self.view.camera, self.view.size)
        other._navigation = self._navigation.another()
        other._selector = self._selector
        other.controls = self.controls.another(other._navigation)
        other._hand = Hand(self._selector, other._navigation, other.controls, has_tools=has_tools)
        other._hand.mode = self.mode
        return other

    @property
    def mode(self) -> Mode:
        """What the left button does."""
        return self._hand.mode

    @property
    def appearance(self) -> object:
        """What is equal for as long as the view and the overlay look the same, if no body moves either."""
        return self._changes, self._selector.changes, self.controls.appearance

    @property
    def view(self) -> View:
        """The camera."""
        return self._navigation.view

    @view.setter
    def view(self, view: View) -> None:
        self._navigation.view = view

    @property
    def drawn_view(self) -> View:
        """The camera to draw from: a little behind ``view`` while this glides to where a key sends it."""
        return self._navigation.drawn

    def look_as(self, view: View) -> None:
        """Look as another view does, where people have moved that. Needs no lock."""
        self.view = replace(self.view, camera=view.camera, distance=view.distance)

    def look_from(self, camera: Camera, distance: float = 0.0) -> None:
        """Take another camera, which people come back to, with a focus so far away [m]; 0: as far as before.

        What the mouse does with the old camera ends.
        """
        with self._simulation.lock:
            if self.mode is Mode.CAMERA:
                self._hand.let_go()
            self.view = replace(self.view, camera=camera, distance=distance or self.view.distance)
            self._navigation.set_home()
            self._changes += 1

    def let_go(self) -> None:
        """End what is being dragged, as when the window or the page is gone. Needs no lock."""
        self._hand.let_go()

    def handle(self, event: Event) -> None:
        """Do what an event asks for. The simulation is locked meanwhile."""
        with self._simulation.lock:
            self._forget_what_is_gone()
            if isinstance(event, Press | Wheel):
                self._hand.look()  # scripts may have changed what there is to press
            self._hand.do(event)
            hovers = self._hand.hovers()
            if not isinstance(event, Move) or self._hand.buttons or hovers or self._hovered:
                self._changes += 1
            self._hovered = hovers

    @property
    def selection(self) -> Selection | None:
        """What is selected, or None."""
        with self._simulation.lock:
            self._forget_what_is_gone()
            return self._selector.selection

    def select(self, selection: Selection | None) -> None:
        """Select something, or nothing, without asking anybody."""
        with self._simulation.lock:
            self._selector.selection = selection
            self._selector.changes += 1  # all views show it

    def choose(self, body: BodyState) -> None:
        """Select a body, as a click on its first link does."""
        with self._simulation.lock:
            self._selector.choose(self.view, body, 0)

    @property
    def hover(self) -> Hit | None:
        """What is under the pointer now; None while a button is held."""
        with self._simulation.lock:
            return self._hand.hit()

    def pass_time(self, now: float) -> None:
        """Let motions and time go on until ``now`` (``time.monotonic``); before each picture, under the lock."""
        self.controls.pass_time(now)

    def overlay(self) -> Overlay:
        """Return what is to be drawn over the bodies as they are now. The simulation is locked meanwhile."""
        with self._simulation.lock:
            self._forget_what_is_gone()
            hand, shown = self._hand, self.controls.display.shown
            hand.look()
            if self.view.distance <= 0:
                self._navigation.scene_sphere()  # it may be wanted while others have the simulation
            hit = hand.hit()
            lines = *self._pointed_at(hit), *self._selector.lines(), *self.controls.notices.lines
            chosen = Tool.CAMERA if self.mode is Mode.CAMERA else Tool.INTERACT
            tools = mode_buttons.panels(self.view.size, chosen) if hand.has_tools else ()
            mark = self._mark(hit)
            takes_link = mark is None and hit is not None and self.mode is Mode.INTERACTION
            parts = [self._selector.primitives(), self._hand.primitives(), mark or NOTHING]
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
                panels=(*tools, *hand.layout.panels()),
                controls=self.controls.all(),
                labels=labels,
                help=sections() if self.controls.unfolded == "help" else (),
                tree=self.controls.tree(),
                chosen=self.controls.chosen,
                style=Style(
                    *(name in shown for name in ("collision", "hulls", "transparent", "wireframe")),
                    lit=self._lit(hit if takes_link else None),
                ),
                cursor="move" if mark is not None else "pointer" if takes_link else hand.cursor(),
                text_size=self.controls.notices.text_size,
            )

    def _mark(self, hit: Hit | None) -> Primitives | None:
        """Return a figure on the face, the edge or the cylinder that a drag would take; None where there is none."""
        at = self._hand.free_pointer()
        return None if at is None or self.mode is Mode.CAMERA else self._selector.mark(self.view, at, hit)

    def _lit(self, hit: Hit | None) -> int:
        """Return MuJoCo's index of the link to be lit: that under the pointer, else what the tree has selected."""
        part = hit or (self._selector.selection if self.controls.unfolded == "tree" else None)
        return -1 if part is None else int(self._simulation.compiled().part(part.body).body_ids[part.link])

    def _pointed_at(self, hit: Hit | None) -> list[str]:
        """Return the text about what is under the pointer, else about the point that was clicked on."""
        control = self._hand.layout.at(self._hand.pointer)
        text = self._selector.point_line()
        if hit is not None:
            text = point_line(hit.body, hit.link, hit.position, hit.normal)
        elif control is not None:
            text = control.label
        return [text] if text else []

    def _forget_what_is_gone(self) -> None:
        if self._selector.forget_what_is_gone():
            self._hand.let_go()

    # --- while others have the simulation

    def steer(self, events: Sequence[Event]) -> list[Event]:
        """Do what changes the view only, without the simulation, which others have locked.

        Returns:
            What has to wait for the simulation. Clicks on what is no longer seen in this way are left out.
        """
        waiting: list[Event] = []
        for event in events:
            is_pointer = isinstance(event, Press | Move | Release)
            if isinstance(event, Press) and not self._hand.needs_bodies(event):
                waiting = _without_clicks(waiting)
            follows = is_pointer and any(isinstance(other, Press) for other in waiting)
            follows |= isinstance(event, Key) and not event.pressed and Key(event.name) in waiting
            before = self.view
            if follows or not self._hand.steer(event):
                waiting.append(event)
            elif self.view is not before:
                waiting = _without_clicks(waiting)
        return waiting

    def pass_time_without_bodies(self, now: float) -> None:
        """Let the view glide while others have the simulation; ``now`` as ``time.monotonic`` says."""
        self._navigation.pass_time(now)


def _without_clicks(events: list[Event]) -> list[Event]:
    """Return events up to the first press, and what is no pointer's after it."""
    presses = (number for number, event in enumerate(events) if isinstance(event, Press))
    first = next(presses, len(events))
    return [*events[:first], *(one for one in events[first:] if not isinstance(one, Press | Move | Release))]
