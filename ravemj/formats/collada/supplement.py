"""Reader of ravemj's own ``<extra>`` elements: order, names and parameters of a body's parts, and grabbed bodies."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from ravemj.errors import SourceError
from ravemj.formats.collada.extras import own_techniques
from ravemj.formats.collada.geometry import GeometryReader
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.visual import read_pose
from ravemj.formats.meshes.collada.document import Element, child, children, words
from ravemj.formats.parameters import with_parameter
from ravemj.model.builder import BodyBuilder, GrabBuilder, JointBuilder, LinkBuilder
from ravemj.model.scene.mechanism import RARE_NUMBERS

_Part = TypeVar("_Part", LinkBuilder, JointBuilder)

_NUMBERS = {
    "values": "reference",
    "torques": "max_torque",
    "own_torques": "joint_torque",
    **{name: name for name in RARE_NUMBERS},
}


@dataclass(frozen=True, slots=True)
class SupplementReader:
    """Reader of ravemj's own extras of a body's articulated systems.

    Attributes:
        library: The documents.
        geometry: Reader of shapes.
        body: The body with its links and joints.
        links: Its links, by their elements.
        joints: Its joints, by their elements.
        values: Bound values of the joints' axes, in the order of the body's joints.
    """

    library: Library
    geometry: GeometryReader
    body: BodyBuilder
    links: Mapping[Element, LinkBuilder]
    joints: Mapping[Element, JointBuilder]
    values: list[list[float]]

    def read(self, system: Element) -> None:
        """Read the extras of a system.

        Raises:
            SourceError: A number is malformed.
        """
        for technique in own_techniques(system):
            self._read_names(technique)
            for element in children(technique, "parameter"):
                self._read_parameter(element)
            for element in children(technique, "group"):
                link = self._link(element.get("of") or "", technique)
                if link is not None:
                    link.add_to_group(element.get("name") or "", self.geometry.read_instances(element, np.eye(4)))
            for element in children(technique, "grabbed"):
                link = self._link(element.get("link") or "", technique)
                if link is not None:
                    links = (self._link(path, technique) for path in (element.get("ignored") or "").split())
                    ignored = tuple(ignored_link for ignored_link in links if ignored_link is not None)
                    pose = read_pose(self.library, element)
                    self.body.grabs.append(GrabBuilder(element.get("body") or "", link, pose, ignored))

    def _read_names(self, technique: Element) -> None:
        """Restore the original names, which COLLADA readers change, and the original order of joints and links."""
        body = self.body
        body.name = _text(child(technique, "name")) or body.name
        body.description = _text(child(technique, "description")) or body.description
        if words(child(technique, "joined_links_adjacent"))[:1] == ["false"]:
            body.joined_links_adjacent = False
        listed = [*children(technique, "joint")]
        order = self._order(listed, technique, self.joints, body.joints)
        if order is not None:
            _name_joints(body, [body.joints[index].name for index in order], listed)
            body.joints = [body.joints[index] for index in order]
            self.values[:] = [self.values[index] for index in order]
            for joint, element in zip(body.joints, listed, strict=True):
                for name, field in _NUMBERS.items():
                    given = map(float, (element.get(name) or "").split())
                    joint.axes = tuple(
                        replace(axis, **{field: next(given, getattr(axis, field))}) for axis in joint.axes
                    )
        listed = [*children(technique, "link")]
        order = self._order(listed, technique, self.links, body.links)
        if order is not None:
            _order_links(body, order, [_text(element) for element in listed])
            for link, element in zip(body.links, listed, strict=True):
                link.self_collision_ignored = element.get("self_collision_ignored") == "true"

    def _order(
        self, listed: list[Element], technique: Element, parts: Mapping[Element, _Part], built: list[_Part]
    ) -> list[int] | None:
        """Return the indices in ``built`` of the listed links or joints; None unless each is listed exactly once."""
        index_of = {id(part): index for index, part in enumerate(built)}
        ordered = (self._found(element.get("path") or "", technique, parts) for element in listed)
        order = [index_of.get(id(part), -1) for part in ordered]
        return order if sorted(order) == list(range(len(built))) else None

    def _read_parameter(self, element: Element) -> None:
        path = element.get("of") or ""
        owner = self._found(path, element, self.links) or self._found(path, element, self.joints)
        if owner is None:
            return
        name, kind = element.get("name") or "", element.get("type") or ""
        try:
            owner.parameters = with_parameter(owner.parameters, name, kind, element.text or "")
        except ValueError as error:
            raise SourceError(f"the parameter '{name}' cannot be read: {error}", self.library.source(element)) from None

    def _link(self, path: str, technique: Element) -> LinkBuilder | None:
        return self._found(path, technique, self.links)

    def _found(self, path: str, scope: Element, parts: Mapping[Element, _Part]) -> _Part | None:
        resolved = self.library.resolve(path, scope)
        return None if resolved is None else parts.get(resolved.element)


def _name_joints(body: BodyBuilder, names: Sequence[str], listed: Sequence[Element]) -> None:
    """Rename joints as listed, also in mimic equations and manipulators."""
    from ravemj.model.expressions import substitute  # noqa: PLC0415 - rarely wanted

    renamed = {name: _text(element) for name, element in zip(names, listed, strict=True)}
    if all(old == new for old, new in renamed.items()):
        return
    for joint in body.joints:
        joint.name = renamed[joint.name]
        if joint.equations is not None:
            joint.equations = joint.equations._make(substitute(text, renamed) for text in joint.equations)
    for manipulator in body.manipulators:
        manipulator.gripper_joints = [renamed[name] for name in manipulator.gripper_joints]


def _order_links(body: BodyBuilder, order: Sequence[int], names: Sequence[str]) -> None:
    place_of = {index: place for place, index in enumerate(order)}
    renamed = {body.links[index].name: name for index, name in zip(order, names, strict=True)}
    for manipulator in body.manipulators:
        manipulator.base, manipulator.effector = renamed[manipulator.base], renamed[manipulator.effector]
    for joint in body.joints:
        joint.links = (place_of[joint.links[0]], place_of[joint.links[1]])
    pairs = [(place_of[first], place_of[second]) for first, second in body.adjacent]
    body.adjacent = [(min(pair), max(pair)) for pair in pairs]
    body.sensors = [
        attached._replace(
            sensor=replace(
                attached.sensor, link=None if attached.sensor.link is None else place_of[attached.sensor.link]
            )
        )
        for attached in body.sensors
    ]
    body.forget_names()
    body.links = [body.links[index] for index in order]
    for link, name in zip(body.links, names, strict=True):
        link.name = name


def _text(element: Element | None) -> str:
    return "" if element is None else element.text or ""
