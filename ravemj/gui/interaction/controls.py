"""Buttons and sliders of a view: playback, saving pictures, camera, display, and one slider per joint.

They are plain data, which a window draws (``control_layout``) and a page converts to HTML elements.
"""

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

from ravemj.engine.simulation import BodyState
from ravemj.gui.interaction import joint_controls
from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.navigation import Navigation
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.playback import Playback
from ravemj.gui.interaction.selection import Selector
from ravemj.gui.interaction.shortcuts import DISPLAY, VIEW, Shortcut, key_text
from ravemj.gui.interaction.time_controls import TimeControls
from ravemj.gui.interaction.tree import SceneTree, TreeRow, choose, names_of
from ravemj.gui.interaction.viewpoint import camera_line

if TYPE_CHECKING:
    from ravemj.gui.interaction.reaching import Reach


class Menu(NamedTuple):
    """A menu button: text, description, and entries."""

    text: str
    label: str
    shortcuts: tuple[Shortcut, ...]


MENUS = {
    "view": Menu("View", "Ways to look at it", VIEW),
    "display": Menu("Show", "What is shown besides the bodies", DISPLAY),
    "tree": Menu("SceneTree", "Bodies, links and joints (B)", ()),
    "help": Menu("?", "Help: gestures and keys (H)", ()),
}
"""The menus, besides the joint sliders."""

_WITHOUT_BUTTON = {shortcut.name for menu in MENUS.values() for shortcut in menu.shortcuts} | {*MENUS, "reload"}
"""Names of controls that only keys operate, without a visible button."""


class Request(Enum):
    """Requested action of the window or page that draws the view; the values are names of controls."""

    PICTURE = "picture"
    VIDEO = "video"


@dataclass
class Display:
    """Display options, shared by all views of a viewer.

    Attributes:
        shown: Names of the active options, of ``shortcuts.DISPLAY``.
        wants_reload: Whether the user has requested a reload of the model; None if reloading is not supported.
    """

    shown: frozenset[str] = frozenset()
    wants_reload: bool | None = None


class Controls:
    """The buttons and sliders of one view, and their actions.

    Attributes:
        navigation: Camera navigation of the view.
        time: Playback and simulation time, shared by all views.
        notices: Messages to the user, shared by all views.
        display: Display options, shared by all views.
        unfolded: Name of the open menu, or empty.
        in_degrees: Whether angles are shown in degrees, not in radians.
        pulls: Whether a drag on a link moves it by inverse kinematics without Ctrl and Shift.
        reach: The last inverse-kinematics drag.
        requests: Pending actions of the window or page; a ``str`` is a text to be copied to the clipboard.
    """

    def __init__(
        self, selector: Selector, navigation: Navigation, time: TimeControls, notices: Notices, display: Display
    ) -> None:
        self._selector = selector
        self.navigation = navigation
        self.time = time
        self.notices = notices
        self.display = display
        self.unfolded = ""
        self.in_degrees = False
        self.pulls = False
        self.reach: Reach | None = None
        self.requests: list[Request | str] = []
        self._tree = SceneTree(selector.simulation)

    def another(self, navigation: Navigation) -> "Controls":
        """Return the controls of another view."""
        return Controls(self._selector, navigation, self.time, self.notices, self.display)

    @property
    def playback(self) -> Playback:
        """Playback of the motion."""
        return self.time.playback

    @property
    def appearance(self) -> object:
        """A key that changes when the controls or the messages must be redrawn."""
        notices = self.notices
        told = notices.lines, notices.recording, notices.text_size
        return self.navigation.appearance, self.time.appearance, told, self.display.shown

    def advance(self, now: float) -> None:
        """Advance playback and expire notices; ``now`` is from ``time.monotonic``."""
        self.navigation.advance(now)
        self.time.advance(now)
        self.notices.advance(now)

    def all(self) -> tuple[Control, ...]:
        """Return the current controls. The caller holds the simulation's lock, as for ``operate``."""
        body = self._body()
        recording = self.notices.recording
        video = "Stop recording" if recording else "Record a video (MP4)"
        controls = [
            *self.time.all(),
            Control(Request.PICTURE.value, "Save a picture (PNG)", "PNG"),
            Control(Request.VIDEO.value, video, "Stop" if recording else "MP4", is_on=recording),
            Control("camera", "Copy the camera as a line of Python", "Copy"),
            *(Control(name, label, text, is_on=self.unfolded == name) for name, (text, label, _) in MENUS.items()),
        ]
        reach = self._redundant_reach()
        if reach is not None and reach.free_dof is not None:
            controls.append(joint_controls.sweep_control(reach.body, reach.free_dof, in_degrees=self.in_degrees))
        if body is not None:
            label = "Pull links: a drag on one takes the joints above it along (D)"
            controls.append(Control("pull", label, "Pull", is_on=self.pulls))
            if self._selector.selection is not None:
                label = "Pin the selected link: it stays, and pulling another one moves the rest and the base (P)"
                controls.append(Control("pin", label, "Pin", is_on=self._selector.is_pinned))
            label = f"DOFs of {body.scene.name}: a slider for each"
            controls.append(Control("joints", label, "DOFs", is_on=self.unfolded == "joints"))
            if self.unfolded == "joints":
                controls += joint_controls.controls(body, in_degrees=self.in_degrees)
        if self.unfolded in MENUS:
            controls += [self._entry(shortcut) for shortcut in MENUS[self.unfolded].shortcuts]
        return tuple(controls)

    def tree(self) -> tuple[TreeRow, ...]:
        """Return the tree of bodies, links and joints if it is open; the same object until it changes."""
        return self._tree.nodes() if self.unfolded == "tree" else ()

    @property
    def chosen(self) -> tuple[str, ...]:
        """Names of the selected rows of the tree."""
        return names_of(self._selector.selection)

    def rows(self, search: str) -> list[Control]:
        """Return the rows of a window: if the tree is open, those that match a search; for the help, a close button."""
        if self.unfolded == "help":
            return [Control("help", "", group="help")]
        if self.unfolded != "tree":
            return []
        chosen, words = self.chosen, search.lower().split()
        rows = [
            Control(
                node.name,
                f"{node.kind.title()} {node.text}",
                ("" if words else 2 * node.depth * " ") + node.text,
                is_on=node.name in chosen,
                group="tree",
            )
            for node in self.tree()
            if all(word in node.text.lower() for word in words)
        ]
        return [
            Control(
                "search",
                "Words that should be in a name; Enter selects what has them",
                search or "Search",
                group="joint tools",
            ),
            *rows,
        ]

    def _entry(self, shortcut: Shortcut) -> Control:
        is_on = shortcut.name in self.display.shown if shortcut in DISPLAY else None
        if shortcut.name == "turntable":
            is_on = self.navigation.view.is_upright
        label = f"{shortcut.label} ({key_text(shortcut.keys)})"
        return Control(shortcut.name, label, shortcut.text, is_on=is_on, group="menu")

    def _body(self) -> BodyState | None:
        """Return the body whose joints have sliders: the selected one, else a moving one, else the first robot."""
        selection, motion = self._selector.selection, self.playback.motion
        bodies = [] if selection is None else [selection.body]
        bodies += [] if motion is None else motion.bodies
        bodies += sorted(self._selector.simulation.bodies, key=lambda body: not body.scene.is_robot)
        return next((body for body in bodies if body.scene.dof_axes), None)

    def _redundant_reach(self) -> "Reach | None":
        """Return the last inverse-kinematics drag if its redundant joint has a slider now, else None.

        It has one while the dragged link is selected and no menu covers the slider.
        """
        reach, selection = self.reach, self._selector.selection
        if reach is None or reach.free_dof is None or selection is None or self.unfolded not in {"", "joints"}:
            return None
        return reach if (selection.body, selection.link) == (reach.body, reach.link) else None

    def operate(self, name: str, value: float = 0.0) -> None:
        """Press a button or set a slider; unknown names are ignored."""
        if name in _WITHOUT_BUTTON:
            if not self.change_view(name):
                self._switch(name)
        elif self.time.operate(name, value) or choose(self._selector, self.navigation.view, name):
            return
        elif name in {control.name for control in self.all()}:
            self._operate(name, value)

    def change_view(self, name: str) -> bool:
        """Operate a control that changes only the camera; return False for controls that need the bodies."""
        if name == "fit" and self._selector.selection is None:
            self.navigation.fit()
            return True
        return self.navigation.go(name)

    def _switch(self, name: str) -> None:
        if name == "fit":
            self.navigation.fit(self._selector.sphere())
        elif name in MENUS:
            self.unfolded = "" if self.unfolded == name else name
        elif name == "reload":
            self._ask_for_reload()
        else:
            self.display.shown ^= {name}

    def _ask_for_reload(self) -> None:
        if self.display.wants_reload is None:
            self.notices.say("Only ravemj view reads a model again")
        else:
            self.display.wants_reload = True

    def _operate(self, name: str, value: float) -> None:
        body = self._body()
        if name in {"picture", "video"}:
            self.requests.append(Request(name))
        elif name == "camera":
            self.requests.append(camera_line(self.navigation.view.camera))
        elif name == "joints":
            self.unfolded = "" if self.unfolded == name else name
        elif name in {"pull", "pin"}:
            self._switch_pulling(name)
        elif name == "sweep":
            self._sweep(value)
        elif name == "units":
            self.in_degrees = not self.in_degrees
        elif body is not None:
            self._operate_joints(body, name, value)

    def _switch_pulling(self, name: str) -> None:
        if name == "pin":
            self._selector.toggle_pin()
        else:
            self.pulls = not self.pulls

    def _operate_joints(self, body: BodyState, name: str, value: float) -> None:
        if name == "values":
            self.requests.append(joint_controls.values_line(body))
        elif not self._selector.is_fixed:
            self.pause_motion(body)
            joint_controls.operate(body, name, value)

    def _sweep(self, value: float) -> None:
        reach = self._redundant_reach()
        if reach is not None and not self._selector.is_fixed:
            self.pause_motion(reach.body)
            reach.sweep_to(value)

    def pop_requests(self) -> list[Request | str]:
        """Return and clear the pending actions of the window or page."""
        requests, self.requests = self.requests, []
        return requests

    def pause_motion(self, body: BodyState) -> None:
        """Pause the playback if it moves a body that the user drags."""
        motion = self.playback.motion
        if motion is not None and body in motion.bodies:
            self.playback.pause()
