"""The buttons and sliders of a view: playing a motion, saving what is seen, and one slider for each joint.

They are plain data, which a window draws (``layout``) and a page makes its own buttons and sliders of.
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
from ravemj.gui.interaction.tree import Node, Tree, choose, names_of
from ravemj.gui.interaction.viewpoint import camera_line

if TYPE_CHECKING:
    from ravemj.gui.interaction.reaching import Reach


class Menu(NamedTuple):
    """A button that unfolds others: its text, what it does, and the others."""

    text: str
    label: str
    shortcuts: tuple[Shortcut, ...]


MENUS = {
    "view": Menu("View", "Ways to look at it", VIEW),
    "display": Menu("Show", "What is shown besides the bodies", DISPLAY),
    "tree": Menu("Tree", "Bodies, links and joints (B)", ()),
    "help": Menu("?", "Help: gestures and keys (H)", ()),
}
"""What can be unfolded, besides the sliders of the joints."""

_WITHOUT_BUTTON = {shortcut.name for menu in MENUS.values() for shortcut in menu.shortcuts} | {*MENUS, "reload"}
"""What keys do whether or not it is unfolded."""


class Request(Enum):
    """What only the one who draws the view can do; the values are the names of the controls."""

    PICTURE = "picture"
    VIDEO = "video"


@dataclass
class Display:
    """What is shown besides the bodies as they look; all views of a viewer share it.

    Attributes:
        shown: Names of what is shown, of ``shortcuts.DISPLAY``.
        wants_reload: Whether people have asked to read the model again; None where nobody would do it.
    """

    shown: frozenset[str] = frozenset()
    wants_reload: bool | None = None


class Controls:
    """What there is to press and to slide in one view, and what that does.

    Attributes:
        navigation: The view.
        time: The motion that is played, and simulation time; all views share them.
        notices: What the viewer tells; all views share it.
        display: What is shown besides the bodies; all views share it.
        unfolded: Name of the button whose menu is unfolded, or empty.
        in_degrees: Whether angles are shown in degrees, not in radians.
        pulls: Whether a drag on a link pulls the arm, as it does with Ctrl and Shift.
        reach: The link that was pulled last, with its arm.
        requests: What was asked of the one who draws, and is not done yet.
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
        self._tree = Tree(selector.simulation)

    def another(self, navigation: Navigation) -> "Controls":
        """Return the controls of another view."""
        return Controls(self._selector, navigation, self.time, self.notices, self.display)

    @property
    def playback(self) -> Playback:
        """The motion that is played."""
        return self.time.playback

    @property
    def appearance(self) -> object:
        """What is equal for as long as the view, and what the views share, look the same."""
        notices = self.notices
        told = notices.lines, notices.recording, notices.text_size
        return self.navigation.appearance, self.time.appearance, told, self.display.shown

    def pass_time(self, now: float) -> None:
        """Let a motion that plays go on, and old notices go away; ``now`` as ``time.monotonic`` says."""
        self.navigation.pass_time(now)
        self.time.pass_time(now)
        self.notices.pass_time(now)

    def all(self) -> tuple[Control, ...]:
        """Return the controls as they are now. The simulation is locked by the caller, as for ``operate``."""
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
            label = "Pull links: a drag on one takes the joints above it along (P)"
            controls.append(Control("pull", label, "Pull", is_on=self.pulls))
            label = f"DOFs of {body.scene.name}: a slider for each"
            controls.append(Control("joints", label, "DOFs", is_on=self.unfolded == "joints"))
            if self.unfolded == "joints":
                controls += joint_controls.controls(body, in_degrees=self.in_degrees)
        if self.unfolded in MENUS:
            controls += [self._entry(shortcut) for shortcut in MENUS[self.unfolded].shortcuts]
        return tuple(controls)

    def tree(self) -> tuple[Node, ...]:
        """Return the tree of bodies, links and joints while it is unfolded; the same object until it changes."""
        return self._tree.nodes() if self.unfolded == "tree" else ()

    @property
    def chosen(self) -> tuple[str, ...]:
        """Names of the rows of the tree that are selected."""
        return names_of(self._selector.selection)

    def rows(self, search: str) -> list[Control]:
        """Return, for a window, the rows of the tree that a search leaves, or a button that hides the help."""
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
        """Return an entry of a menu."""
        is_on = shortcut.name in self.display.shown if shortcut in DISPLAY else None
        if shortcut.name == "turntable":
            is_on = self.navigation.view.is_upright
        label = f"{shortcut.label} ({key_text(shortcut.keys)})"
        return Control(shortcut.name, label, shortcut.text, is_on=is_on, group="menu")

    def _body(self) -> BodyState | None:
        """Return the body whose joints have sliders: the selected one, else one that plays, else the first robot."""
        selection, motion = self._selector.selection, self.playback.motion
        bodies = [] if selection is None else [selection.body]
        bodies += [] if motion is None else motion.bodies
        bodies += sorted(self._selector.simulation.bodies, key=lambda body: not body.scene.is_robot)
        return next((body for body in bodies if body.scene.dof_axes), None)

    def _redundant_reach(self) -> "Reach | None":
        """Return the redundant arm that was pulled last, while its link is selected and nothing covers its slider."""
        reach, selection = self.reach, self._selector.selection
        if reach is None or reach.free_dof is None or selection is None or self.unfolded not in {"", "joints"}:
            return None
        return reach if (selection.body, selection.link) == (reach.body, reach.link) else None

    def operate(self, name: str, value: float = 0.0) -> None:
        """Press a button, or move a slider to a value; nothing happens where there is no such control."""
        if name in _WITHOUT_BUTTON:
            if not self.steer(name):
                self._switch(name)
        elif self.time.operate(name, value) or choose(self._selector, self.navigation.view, name):
            return
        elif name in {control.name for control in self.all()}:
            self._operate(name, value)

    def steer(self, name: str) -> bool:
        """Change the view, if that needs no look at the bodies, as to fit what is selected does; return whether."""
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
        elif name == "pull":
            self.pulls = not self.pulls
        elif name == "sweep":
            self._sweep(value)
        elif name == "units":
            self.in_degrees = not self.in_degrees
        elif body is not None:
            self._operate_joints(body, name, value)

    def _operate_joints(self, body: BodyState, name: str, value: float) -> None:
        if name == "values":
            self.requests.append(joint_controls.values_line(body))
        else:
            self.take(body)
            joint_controls.operate(body, name, value)

    def _sweep(self, value: float) -> None:
        reach = self._redundant_reach()
        if reach is not None:
            self.take(reach.body)
            reach.sweep_to(value)

    def take_requests(self) -> list[Request | str]:
        """Return what was asked of the one who draws, and forget it; a text is to be copied."""
        requests, self.requests = self.requests, []
        return requests

    def take(self, body: BodyState) -> None:
        """Pause a motion of a body, which a hand takes hold of."""
        motion = self.playback.motion
        if motion is not None and body in motion.bodies:
            self.playback.pause()
