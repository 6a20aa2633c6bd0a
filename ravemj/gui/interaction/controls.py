"""The buttons and sliders of a view: playing a motion, saving what is seen, and one slider for each joint.

They are plain data, which a window draws (``layout``) and a page makes its own buttons and sliders of.
"""

import math
import random
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from ravemj.engine.simulation import BodyState
from ravemj.gui.interaction.display import Display
from ravemj.gui.interaction.dragging import set_dof
from ravemj.gui.interaction.joint_handle import joint_and_axis
from ravemj.gui.interaction.navigation import Navigation
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.playback import SPEEDS, Playback
from ravemj.gui.interaction.selection import Selector
from ravemj.gui.interaction.shortcuts import DISPLAY, VIEW, Shortcut, key_text
from ravemj.model.limits import clamp

_WIDEST = {True: (1.0, "m"), False: (math.pi, "rad")}
"""How far a control goes to each side where the limits of the axis are much wider, and its unit; True: it slides."""

_MUCH = 4.0
"""How many times wider than that limits are that no slider can cover."""


_JOINT_TOOLS = (
    ("zero", "Zero", "Bring all joints to 0, or as near as their limits go"),
    ("random", "Random", "Bring all joints to random values within their limits"),
    ("units", "Units", "Show angles in degrees, or in radians"),
    ("values", "Copy", "Copy the values as a line of Python"),
)


class Menu(NamedTuple):
    """A button that unfolds others.

    Attributes:
        text: What stands on it.
        label: What it does, for people.
        shortcuts: The others.
    """

    text: str
    label: str
    shortcuts: tuple[Shortcut, ...]


MENUS = {
    "view": Menu("View", "Ways to look at it", VIEW),
    "display": Menu("Show", "What is shown besides the bodies", DISPLAY),
    "help": Menu("?", "Help: gestures and keys (H)", ()),
}
"""What can be unfolded, besides the sliders of the joints."""

_WITHOUT_BUTTON = {shortcut.name for menu in MENUS.values() for shortcut in menu.shortcuts} | {*MENUS, "reload"}
"""What keys do whether or not it is unfolded."""


class Request(Enum):
    """What only the one who draws the view can do; the values are the names of the controls."""

    PICTURE = "picture"
    VIDEO = "video"
    CAMERA = "camera"
    VALUES = "values"


@dataclass(frozen=True, slots=True)
class Control:
    """A button, or a slider if it has a range.

    Attributes:
        name: What ``Operate`` calls it.
        label: What it does, for people.
        text: What stands on a button, or beside a slider.
        value: Where a slider is.
        lower: Where its range begins.
        upper: Where its range ends.
        is_on: For a button that stays down, whether it is.
        group: Where it is: among the ``tools``, in the row that is ``playing``, or unfolded in the ``joints`` or a
            ``menu``.
    """

    name: str
    label: str
    text: str = ""
    value: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    is_on: bool | None = None
    group: str = "tools"

    @property
    def is_slider(self) -> bool:
        """Whether it has a value, and not only something to do."""
        return self.lower < self.upper


_REQUESTS = {request.value for request in Request}


class Controls:
    """What there is to press and to slide in one view, and what that does.

    Attributes:
        navigation: The view.
        playback: The motion, which all views share.
        notices: What the viewer tells; all views share it.
        display: What is shown besides the bodies; all views share it.
        unfolded: Name of the button whose menu is unfolded, or empty.
        values_line: The line of a script that sets the values of the sliders, as they were when that was asked for.
        in_degrees: Whether angles are shown in degrees, not in radians.
        requests: What was asked of the one who draws, and is not done yet.
    """

    def __init__(
        self, selector: Selector, navigation: Navigation, playback: Playback, notices: Notices, display: Display
    ) -> None:
        self._selector = selector
        self.navigation = navigation
        self.playback = playback
        self.notices = notices
        self.display = display
        self.unfolded = ""
        self.in_degrees = False
        self.values_line = ""
        self.requests: list[Request] = []

    def another(self, navigation: Navigation) -> "Controls":
        """Return the controls of another view."""
        return Controls(self._selector, navigation, self.playback, self.notices, self.display)

    @property
    def changes(self) -> int:
        """A number that grows with the view, and with what the views share."""
        return self.navigation.changes + self.playback.changes + self.notices.changes + self.display.changes

    def pass_time(self, now: float) -> None:
        """Let a motion that plays go on, and old notices go away.

        Args:
            now: What ``time.monotonic`` says.
        """
        self.navigation.pass_time(now)
        self.playback.advance(now)
        self.notices.pass_time(now)

    def all(self) -> tuple[Control, ...]:
        """Return the controls as they are now. The simulation is locked by the caller, as for ``operate``."""
        body = self._body()
        recording = self.notices.recording
        video = "Stop recording" if recording else "Record a video (MP4)"
        controls = [
            *self._playing(),
            Control(Request.PICTURE.value, "Save a picture (PNG)", "PNG"),
            Control(Request.VIDEO.value, video, "Stop" if recording else "MP4", is_on=recording),
            Control(Request.CAMERA.value, "Copy the camera as a line of Python", "Copy"),
            *(Control(name, label, text, is_on=self.unfolded == name) for name, (text, label, _) in MENUS.items()),
        ]
        if body is not None:
            label = f"DOFs of {body.scene.name}: a slider for each"
            controls.append(Control("joints", label, "DOFs", is_on=self.unfolded == "joints"))
            if self.unfolded == "joints":
                values = enumerate(body.kinematics.values().tolist())
                sliders = (_joint(body, dof, value, in_degrees=self.in_degrees) for dof, value in values)
                controls += [Control(name, label, text, group="joint tools") for name, text, label in _JOINT_TOOLS]
                controls += [slider for slider in sliders if slider.is_slider]
        if self.unfolded in MENUS:
            controls += [self._entry(shortcut) for shortcut in MENUS[self.unfolded].shortcuts]
        return tuple(controls)

    def _entry(self, shortcut: Shortcut) -> Control:
        """Return an entry of a menu."""
        is_on = shortcut.name in self.display.shown if shortcut in DISPLAY else None
        if shortcut.name == "turntable":
            is_on = self.navigation.view.is_upright
        label = f"{shortcut.label} ({key_text(shortcut.keys)})"
        return Control(shortcut.name, label, shortcut.text, is_on=is_on, group="menu")

    def _playing(self) -> list[Control]:
        playback = self.playback
        if not playback.duration > 0:
            return []
        clock = f"{playback.time:.2f} / {playback.duration:.2f} s"
        return [
            Control("back", "One frame back", group="playing"),
            Control("play", "Pause" if playback.playing else "Play", group="playing", is_on=playback.playing),
            Control("forward", "One frame forward", group="playing"),
            Control("seek", "Time", clock, playback.time, 0.0, playback.duration, group="playing"),
            Control("speed", "Speed", f"{playback.speed:g}x", group="playing"),
        ]

    def _body(self) -> BodyState | None:
        """Return the body whose joints have sliders: the selected one, else one that plays, else the first robot."""
        selection, motion = self._selector.selection, self.playback.motion
        bodies = [] if selection is None else [selection.body]
        bodies += [] if motion is None else motion.bodies
        bodies += sorted(self._selector.simulation.bodies, key=lambda body: not body.scene.is_robot)
        return next((body for body in bodies if body.scene.dof_axes), None)

    def operate(self, name: str, value: float = 0.0) -> None:
        """Press a button, or move a slider to a value; nothing happens where there is no such control."""
        if name in _WITHOUT_BUTTON:
            if not self.steer(name):
                self._switch(name)
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
            self.display.toggle(name)

    def _ask_for_reload(self) -> None:
        if self.display.wants_reload is None:
            self.notices.say("Only ravemj view reads a model again")
        else:
            self.display.wants_reload = True

    def _operate(self, name: str, value: float) -> None:
        playback = self.playback
        if name in _REQUESTS:
            self.values_line = self._values_line() if name == Request.VALUES.value else self.values_line
            self.requests.append(Request(name))
        elif name == "play":
            (playback.pause if playback.playing else playback.play)()
        elif name in {"back", "forward"}:
            playback.step(1 if name == "forward" else -1)
        elif name == "seek":
            playback.pause()
            playback.seek(value)
        elif name == "speed":
            playback.speed = next((speed for speed in SPEEDS if speed > playback.speed), SPEEDS[0])
        else:
            self._operate_joints(name, value)

    def _operate_joints(self, name: str, value: float) -> None:
        if name == "joints":
            self.unfolded = "" if self.unfolded == name else name
        elif name == "units":
            self.in_degrees = not self.in_degrees
        elif name in {"zero", "random"}:
            self._move_all(is_random=name == "random")
        else:
            self._move(int(name.removeprefix("dof ")), value)

    def take_requests(self) -> list[Request]:
        """Return what was asked of the one who draws, and forget it."""
        requests, self.requests = self.requests, []
        return requests

    def take(self, body: BodyState) -> None:
        """Pause a motion of a body, which a hand takes hold of."""
        motion = self.playback.motion
        if motion is not None and body in motion.bodies:
            self.playback.pause()

    def _move_all(self, *, is_random: bool) -> None:
        """Bring all joints to zero, or to random values, as far as their limits go."""
        body = self._body()
        if body is None:
            return
        self.take(body)
        values = np.zeros(body.dof)
        for dof, axis in enumerate(body.scene.dof_axes):
            slider = _joint(body, dof, 0.0)
            values[dof] = clamp(axis, random.uniform(slider.lower, slider.upper) if is_random else 0.0)
        body.set_values(values)

    def _values_line(self) -> str:
        """Return the line of a script that sets the values that the sliders show; empty where there are none."""
        body = self._body()
        if body is None:
            return ""
        values = ", ".join(str(round(value, 6) + 0.0) for value in body.kinematics.values().tolist())
        return f"env.GetKinBody({body.scene.name!r}).SetDOFValues([{values}])"

    def _move(self, dof: int, value: float) -> None:
        body = self._body()
        if body is not None:
            self.take(body)
            set_dof(body, dof, value)


def _joint(body: BodyState, dof: int, value: float, *, in_degrees: bool = False) -> Control:
    limits = body.scene.dof_axes[dof]
    joint, axis = joint_and_axis(body, dof)
    reach, unit = _WIDEST[joint.slides(axis)]
    shown, lower, upper = value, limits.lower, limits.upper
    if limits.circular:
        lower, upper, shown = -math.pi, math.pi, math.remainder(value, math.tau)
    elif not upper - lower <= _MUCH * 2 * reach:
        middle = min(max(0.0, lower + reach), upper - reach)
        lower, upper = middle - reach, middle + reach
    name = f"{joint.name}, axis {axis}" if len(joint.axes) > 1 else joint.name
    text = f"{round(value, 3) + 0.0:.3f} {unit}"
    if in_degrees and unit == "rad":
        text = f"{round(math.degrees(value), 1) + 0.0:.1f} deg"
    return Control(f"dof {dof}", name, text, shown, lower, upper, group="joints")
