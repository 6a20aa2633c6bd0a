"""Tree view of the bodies with their links and joints, as rows."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from ravemj.engine.simulation import BodyState, Simulation
from ravemj.gui.interaction.selection import Selection, Selector
from ravemj.gui.interaction.viewpoint import Viewpoint

_NAME = re.compile(r"(?P<kind>body|link|joint) (?P<body>[0-9]+)(?: (?P<number>[0-9]+))?")
"""Pattern of control names of tree rows; the row of a body selects its first link."""


class TreeRow(NamedTuple):
    """A row of the tree.

    Attributes:
        name: Identifier in ``Operate`` events.
        text: The name of the body, the link or the joint.
        kind: ``body``, ``link`` or ``joint``.
        depth: Indentation level; a joint has the level of the link that it moves.
    """

    name: str
    text: str
    kind: str
    depth: int


class SceneTree:
    """The tree of a viewer's bodies; rows are rebuilt only if bodies have changed."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._made_of: list[object] = []
        self._nodes: tuple[TreeRow, ...] = ()

    def nodes(self) -> tuple[TreeRow, ...]:
        """Return the rows: below each link its child joints, each followed by the link that it moves."""
        made_of: list[object] = [part for body in self._simulation.bodies for part in (body, body.scene)]
        if len(made_of) != len(self._made_of) or any(a is not b for a, b in zip(made_of, self._made_of, strict=True)):
            self._made_of = made_of
            self._nodes = tuple(node for body in self._simulation.bodies for node in _of_body(body))
        return self._nodes


def _of_body(body: BodyState) -> Iterator[TreeRow]:
    joints = body.scene.all_joints
    placed = {joint.child for joint in joints if joint.places_child}
    yield TreeRow(f"body {body.index}", body.scene.name, "body", 0)
    waiting = [("link", link, 1) for link in reversed(range(len(body.scene.links))) if link not in placed]
    while waiting:
        kind, number, depth = waiting.pop()
        parts = body.scene.links if kind == "link" else joints
        yield TreeRow(f"{kind} {body.index} {number}", parts[number].name, kind, depth)
        if kind == "link":
            below = [index for index, joint in enumerate(joints) if joint.parent == number]
            waiting += [("joint", index, depth + 1) for index in reversed(below)]
        elif joints[number].places_child:
            waiting.append(("link", joints[number].child, depth))


def names_of(selection: Selection | None) -> tuple[str, ...]:
    """Return the names of the rows of a selection: its body, link and joint."""
    if selection is None:
        return ()
    index, scene = selection.body.index, selection.body.scene
    names = [f"body {index}", f"link {index} {selection.link}"]
    if selection.dof is not None:
        names.append(f"joint {index} {scene.joints.index(scene.joint_of_dof(selection.dof))}")
    return tuple(names)


def choose(selector: Selector, view: Viewpoint, name: str) -> bool:
    """Select the body, link or joint of a row; return False if the row does not exist."""
    match = _NAME.fullmatch(name)
    body = None if match is None else selector.simulation.body_at(int(match["body"]))
    if match is None or body is None:
        return False
    number = int(match["number"] or 0)
    if match["kind"] == "joint" and number < len(body.scene.all_joints):
        selector.choose_joint(view, body, number)
    elif match["kind"] != "joint" and number < len(body.scene.links):
        selector.choose(view, body, number)
    return True
