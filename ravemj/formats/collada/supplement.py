"""Our own ``<extra>`` elements, which say what COLLADA and OpenRAVE's extras cannot: order and names of the parts."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from ravemj.formats.collada.references import References
from ravemj.formats.meshes.collada.document import Element, child, children, words
from ravemj.model.builder import BodyBuilder
from ravemj.model.scene.mechanism import RARE_NUMBERS

PROFILE = "ravemj"

_NUMBERS = {"values": "reference", "torques": "max_torque", **{name: name for name in RARE_NUMBERS}}


def own_techniques(element: Element | None) -> Iterator[Element]:
    """Yield our techniques in the extras of an element."""
    for extra in children(element, "extra"):
        if extra.get("type") == PROFILE:
            for technique in children(extra, "technique"):
                if technique.get("profile") == PROFILE:
                    yield technique


def read_supplement(
    system: Element,
    references: References,
    body: BodyBuilder,
    links: Mapping[Element, int],
    joints: Mapping[Element, int],
    values: dict[int, list[float]],
) -> None:
    """Give a body the order and the names of its parts, if an articulated system has them.

    Args:
        system: The articulated system.
        references: Resolves paths.
        body: The body, filled from its models.
        links: Indices of its links, by their elements.
        joints: Indices of its joints, by their elements.
        values: Values of the joints' axes, by index.
    """
    for technique in own_techniques(system):
        body.name = _text(child(technique, "name")) or body.name
        body.description = _text(child(technique, "description")) or body.description
        if words(child(technique, "joined_links_adjacent"))[:1] == ["false"]:
            body.joined_links_adjacent = False
        order, names = _listed(references, technique, "joint", joints)
        if sorted(order) == list(range(len(body.joints))):
            _name_joints(body, order, names)
            body.joints = [body.joints[index] for index in order]
            for joint, element in zip(body.joints, children(technique, "joint"), strict=True):
                for name, field in _NUMBERS.items():
                    given = map(float, (element.get(name) or "").split())
                    joint.axes = tuple(
                        replace(axis, **{field: next(given, getattr(axis, field))}) for axis in joint.axes
                    )
            values |= {place: given for place, given in enumerate([values[index] for index in order])}
        order, names = _listed(references, technique, "link", links)
        if sorted(order) == list(range(len(body.links))):
            _order_links(body, order, names)
            for link, element in zip(body.links, children(technique, "link"), strict=True):
                link.self_collision_ignored = element.get("self_collision_ignored") == "true"


def _listed(
    references: References, technique: Element, kind: str, indices: Mapping[Element, int]
) -> tuple[list[int], list[str]]:
    """Return the indices of the listed parts, and their names."""
    order: list[int] = []
    names: list[str] = []
    for element in children(technique, kind):
        found = references.resolve(element.get("path") or "", technique)
        order.append(-1 if found is None else indices.get(found.element, -1))
        names.append(_text(element))
    return order, names


def _name_joints(body: BodyBuilder, order: Sequence[int], names: Sequence[str]) -> None:
    """Name the joints, also where equations and manipulators refer to them."""
    from ravemj.model.expressions import substitute  # noqa: PLC0415 - rarely wanted

    renamed = {body.joints[index].name: name for index, name in zip(order, names, strict=True)}
    if all(old == new for old, new in renamed.items()):
        return
    for joint in body.joints:
        joint.name = renamed[joint.name]
        if joint.equations is not None:
            joint.equations = joint.equations._make(substitute(text, renamed) for text in joint.equations)
    for manipulator in body.manipulators:
        manipulator.gripper_joints = [renamed[name] for name in manipulator.gripper_joints]


def _order_links(body: BodyBuilder, order: Sequence[int], names: Sequence[str]) -> None:
    """Bring the links into an order, and name them."""
    place_of = {index: place for place, index in enumerate(order)}
    renamed = {body.links[index].name: name for index, name in zip(order, names, strict=True)}
    for manipulator in body.manipulators:
        manipulator.base, manipulator.effector = renamed[manipulator.base], renamed[manipulator.effector]
    for joint in body.joints:
        joint.links = (place_of[joint.links[0]], place_of[joint.links[1]])
    pairs = [(place_of[first], place_of[second]) for first, second in body.adjacent]
    body.adjacent = [(min(pair), max(pair)) for pair in pairs]
    body.sensors = [
        one._replace(sensor=replace(one.sensor, link=None if one.sensor.link is None else place_of[one.sensor.link]))
        for one in body.sensors
    ]
    body.links = [body.links[index] for index in order]
    for link, name in zip(body.links, names, strict=True):
        link.name = name


def _text(element: Element | None) -> str:
    return "" if element is None else element.text or ""
