"""The bodies with their links and joints, as a tree in rows."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from ravemj.engine.simulation import BodyState, Simulation
from ravemj.gui.interaction.selection import Selection, Selector
from ravemj.gui.interaction.viewpoint import View

_NAME = re.compile(r"(?P<kind>body|link|joint) (?P<body>[0-9]+)(?: (?P<number>[0-9]+))?")
"""Names of rows; a body stands for its first link."""


class Node(NamedTuple):
    """A row of the tree.

    Attributes:
        name: What ``Operate`` calls it.
        text: The name of the body, the link or the joint.
        kind: ``body``, ``link`` or ``joint``.
        depth: How far it is indented; a joint is as deep as the link that it moves.
    """

    name: str
    text: str
    kind: str
    depth: int


class Tree:
    """The tree of one viewer's bodies; its rows are made anew only where bodies have changed."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._made_of: list[object] = []
        self._nodes: tuple[Node, ...] = ()

    def nodes(self) -> tuple[Node, ...]:
        """Return the rows: below each link the joints that hang on it, each followed by the link that it moves."""
        made_of: list[object] = [part for body in self._simulation.bodies for part in (body, body.scene)]
        if len(made_of) != len(self._made_of) or any(a is not b for a, b in zip(made_of, self._made_of, strict=True)):
            self._made_of = made_of
            self._nodes = tuple(node for body in self._simulation.bodies for node in _of_body(body))
        return self._nodes


def _of_body(body: BodyState) -> Iterator[Node]:
    joints = body.scene.all_joints
    placed = {joint.child for joint in joints if joint.places_child}
    yield Node(f"body {body.index}", body.scene.name, "body", 0)
    waiting = [("link", link, 1) for link in reversed(range(len(body.scene.links))) if link not in placed]
    while waiting:
        kind, number, depth = waiting.pop()
        parts = body.scene.links if kind == "link" else joints
        yield Node(f"{kind} {body.index} {number}", parts[number].name, kind, depth)
        if kind == "link":
            below = [index for index, joint in enumerate(joints) if joint.parent == number]
            waiting += [("joint", index, depth + 1) for index in reversed(below)]
        elif joints[number].places_child:
            waiting.append(("link", joints[number].child, depth))


def names_of(selection: Selection | None) -> tuple[str, ...]:
    """Return the names of the rows that something selected is in: its body, its link and its joint."""
    if selection is None:
        return ()
    index, scene = selection.body.index, selection.body.scene
    names = [f"body {index}", f"link {index} {selection.link}"]
    if selection.dof is not None:
        names.append(f"joint {index} {scene.joints.index(scene.joint_of_dof(selection.dof))}")
    return tuple(names)


def choose(selector: Selector, view: View, name: str) -> bool:
    """Select what a row stands for; return False where there is no such row."""
    found = _NAME.fullmatch(name)
    body = None if found is None else selector.simulation.body_at(int(found["body"]))
    if found is None or body is None:
        return False
    number = int(found["number"] or 0)
    if found["kind"] == "joint" and number < len(body.scene.all_joints):
        selector.choose_joint(view, body, number)
    elif found["kind"] != "joint" and number < len(body.scene.links):
        selector.choose(view, body, number)
    return True
