"""Table of pointer gestures and keyboard shortcuts, for keys, menus, help and the manual."""

from collections.abc import Iterable
from typing import NamedTuple


class Shortcut(NamedTuple):
    """An action with a keyboard shortcut.

    Attributes:
        name: Name of the control.
        keys: Names of its keys, as in ``Key`` events.
        text: Caption in a menu.
        label: Description.
    """

    name: str
    keys: tuple[str, ...]
    text: str
    label: str


VIEW = (
    Shortcut("home", ("home",), "Home", "go back to the first view, or to that of the last SetCamera"),
    Shortcut("fit", ("f",), "Fit", "show what is selected as large as it fits, or everything"),
    Shortcut("upright", ("u",), "Upright", "level the view: z points up"),
    Shortcut("turntable", ("k",), "Keep upright", "keep the view level while it turns, or let it roll again"),
    Shortcut("front", ("1",), "Front", "look from the front, along -x"),
    Shortcut("behind", ("2",), "Behind", "look from behind, along +x"),
    Shortcut("left", ("3",), "Left", "look from the left, along -y"),
    Shortcut("right", ("4",), "Right", "look from the right, along +y"),
    Shortcut("above", ("5",), "Above", "look from above, with y up"),
    Shortcut("below", ("6",), "Below", "look from below, with y up"),
)
"""Camera actions."""

DISPLAY = (
    Shortcut("floor", ("g",), "Floor", "show a grid on the floor, in metres, and the axes of the world"),
    Shortcut("collision", ("v",), "Collision shapes", "show what collides, or what is seen"),
    Shortcut("hulls", ("x",), "Convex hulls", "show meshes as their convex hulls"),
    Shortcut("frames", ("l",), "Link frames", "show the frames of the links: x red, y green, z blue"),
    Shortcut("axes", ("j",), "Joint axes", "show the axes of the joints, and the range between their limits"),
    Shortcut("masses", ("i", "m"), "Masses", "show centres of mass, and inertia as ellipsoids of even density"),
    Shortcut("contacts", ("c",), "Contacts", "show where shapes touch; with physics, the forces there"),
    Shortcut("transparent", ("t",), "Transparent", "look through the bodies"),
    Shortcut("wireframe", ("w",), "Wireframe", "show edges only"),
    Shortcut("names", ("n",), "Names", "show the names of the links"),
)
"""Display options."""

OTHERS = (
    Shortcut("help", ("f1", "h", "?"), "?", "show this help, or hide it"),
    Shortcut("tree", ("b",), "", "show the tree of bodies, links and joints, or hide it"),
    Shortcut("pull", ("d",), "", "pull links with left drags, or move bodies again"),
    Shortcut(
        "pin", ("p",), "", "pin the link under the pointer, or the selected one, where it is; or take its pin out"
    ),
    Shortcut("reload", ("r",), "", "read the model again (in ravemj view)"),
    Shortcut("play", (" ",), "", "play or pause a motion; without one, simulation time"),
    Shortcut("back", ("arrowleft",), "", "one frame of a motion back"),
    Shortcut("forward", ("arrowright",), "", "one frame of a motion forward; without one, a step of time"),
    Shortcut("slower", ("-",), "", "play a motion slower; without one, simulation time"),
    Shortcut("faster", ("+", "="), "", "play a motion faster; without one, simulation time"),
)
"""Actions that are in no menu."""

KEYS = {key: shortcut.name for shortcut in (*VIEW, *DISPLAY, *OTHERS) for key in shortcut.keys}
"""The control that each key operates."""


class Gesture(NamedTuple):
    """A pointer gesture and its effect."""

    to: str
    do: str


GESTURES = {
    "Both modes": (
        Gesture(
            "switch between camera mode and interaction mode",
            "Esc, or the two buttons on the right: red arrow for interaction, camera",
        ),
        Gesture("centre on a surface point; later turns are about it", "S + left click"),
        Gesture(
            "pull a link with a force, while physics runs", "right drag: a spring leads from the link to the pointer"
        ),
    ),
    "Camera mode": (
        Gesture("turn", "left drag, or the wheels RotX and RotY"),
        Gesture("translate", "Shift + left drag, or middle drag"),
        Gesture("zoom", "mouse wheel: up is nearer; or left + middle drag, or the wheel Dolly: down is nearer"),
    ),
    "Interaction mode": (
        Gesture("select an object", "left click; a second click on it, or a click on nothing, ends it"),
        Gesture("translate it", "drag a face of its cube: along the two directions of the face"),
        Gesture("rotate it", "drag an edge of its cube: about the axis along the edge, through the middle of the cube"),
        Gesture(
            "select the joint above a link",
            "Ctrl + left click on the link; again for the next axis of a joint with several",
        ),
        Gesture("turn the joint, or slide it", "drag its cylinder"),
        Gesture("change the size of the cylinder", "Ctrl + left click on it"),
        Gesture(
            "pull a link, with the joints above it",
            "Ctrl + Shift + left drag, or left drag with the button Pull: it follows in the plane of the view",
        ),
        Gesture(
            "pull a link while others stay",
            "pin these first: P over each, or select it and press the button Pin; the base moves then",
        ),
        Gesture(
            "move a redundant arm while its link stays",
            "mouse wheel, while the link is pulled; or the slider that is there from then on",
        ),
    ),
}
"""Gestures by mode: those of OpenRAVE's tutorial, and additional ones."""

TOUCH = "Touch screen"
TOUCH_GESTURES = (
    Gesture("turn", "move one finger"),
    Gesture("shift and zoom", "move two fingers: what is under them stays there"),
    Gesture("select an object, and go to interaction mode", "tap it"),
    Gesture("select the joint above a link, or change the size of the cylinder", "a long press, as Ctrl + click"),
    Gesture("move what is selected", "drag the cube or the cylinder, in interaction mode; beside it the view turns"),
)
"""Touch gestures; windows have none."""

_KEY_NAMES = {"home": "Home", " ": "Space", "arrowleft": "Left", "arrowright": "Right", "f1": "F1"}


def key_text(keys: tuple[str, ...]) -> str:
    """Return the displayed names of keys."""
    return ", ".join(_KEY_NAMES.get(key, key.upper()) for key in keys)


Section = tuple[str, tuple[tuple[str, str], ...]]
"""A heading, and rows of an action and its keys or gesture."""


def sections() -> tuple[Section, ...]:
    """Return the sections of the help."""
    gestures = ((title, _rows(rows)) for title, rows in GESTURES.items())
    keys = (("View", VIEW), ("Display", DISPLAY), ("More keys", OTHERS))
    return *gestures, *((title, tuple((row.label, key_text(row.keys)) for row in rows)) for title, rows in keys)


def page_sections() -> tuple[Section, ...]:
    """Return the sections of the help of pages; the last one is about touch."""
    return *sections(), (TOUCH, _rows(TOUCH_GESTURES))


def _rows(gestures: Iterable[Gesture]) -> tuple[tuple[str, str], ...]:
    return tuple((gesture.to, gesture.do) for gesture in gestures)


def as_markdown() -> str:
    """Return the help as Markdown tables for the manual."""
    lines: list[str] = ["| to | do |", "|---|---|"]
    for title, rows in sections():
        lines += [f"| **{title}** | |", *(f"| {to} | {do} |" for to, do in rows)]
    return "\n".join(lines) + "\n"
