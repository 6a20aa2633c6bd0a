"""Elements of URDF: children, and numbers and poses in attributes."""

import math
from collections.abc import Iterable, Mapping, Sequence

from ravemj.core.transforms import (
    UNMOVED,
    ZERO,
    Pose,
    Vec3,
    Wxyz,
    multiply,
    normalize,
    wxyz_from_axis_angle,
)
from ravemj.errors import SourceError
from ravemj.formats.openrave_xml.context import Context, did_you_mean
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import leading_numbers


def children(element: Element, tag: str) -> list[Element]:
    """Return the child elements with a tag; URDF is case-sensitive."""
    return [child for child in element.children if child.spelled == tag]


def only(element: Element, tag: str, context: Context) -> Element | None:
    """Return the first child element with a tag, or None; further ones are reported and ignored."""
    elements = children(element, tag)
    for other in elements[1:]:
        message = f"<{tag}> is left out: the first one, in line {elements[0].source.line}, counts"
        context.diagnostics.warn("repeated-tag", message, other.source, "write one")
    return elements[0] if elements else None


def check_children(
    element: Element, known: Iterable[str], context: Context, ignored: Iterable[str] = (), language: str = "URDF"
) -> None:
    """Report child elements that are neither in ``known`` nor in ``ignored``; ``language`` is for the message.

    Extensions with a namespace are not reported, since they belong to other programs.
    """
    known = set(known)
    for child in element.children:
        if child.spelled not in known and child.spelled not in ignored and ":" not in child.spelled:
            message = f"{language} knows no <{child.spelled}> in <{element.spelled}>; it is left out"
            context.diagnostics.warn("unknown-tag", message, child.source, did_you_mean(child.spelled, known))


def attribute(element: Element, name: str) -> str:
    """Return an attribute.

    Raises:
        SourceError: it is missing or empty.
    """
    text = element.attributes.get(name, "")
    if not text:
        raise SourceError(f"<{element.spelled}> has no {name}", element.source, f'write {name}="…"')
    return text


def number_of(element: Element, name: str, default: float) -> float:
    """Return the number in an attribute, or a default; raises the errors of ``numbers_of``."""
    return numbers_of(element, name, 1)[0] if name in element.attributes else default


def numbers_of(element: Element, name: str, count: int) -> list[float]:
    """Return the numbers in an attribute.

    Raises:
        SourceError: it is missing, or is anything but ``count`` finite numbers separated by spaces.
    """
    text = attribute(element, name)
    values, rest = leading_numbers(text)
    if rest or len(values) != count:
        wanted = "a number" if count == 1 else f"{count} numbers separated by spaces"
        raise SourceError(f'{name}="{text}" of <{element.spelled}> should be {wanted}', element.source)
    return values


def vector_of(element: Element, name: str, default: Vec3) -> Vec3:
    """Return the three numbers in an attribute, or a default; raises the errors of ``numbers_of``."""
    if name not in element.attributes:
        return default
    x, y, z = numbers_of(element, name, 3)
    return x, y, z


def origin_of(element: Element, context: Context) -> Pose:
    """Return the pose of an element's ``<origin>``; the identity if it has none.

    ``rpy`` are rotations about the fixed axes x, y and z, in this order; URDF 1.1 has ``quat_xyzw`` instead.
    """
    origin = only(element, "origin", context)
    if origin is None:
        return UNMOVED
    position = vector_of(origin, "xyz", ZERO)
    if "quat_xyzw" not in origin.attributes:
        return Pose(position, wxyz_from_rpy(vector_of(origin, "rpy", ZERO)))
    if "rpy" in origin.attributes:
        raise SourceError("<origin> has rpy and quat_xyzw", origin.source, "write one of the two")
    x, y, z, w = numbers_of(origin, "quat_xyzw", 4)
    if not math.hypot(x, y, z, w):
        raise SourceError("quat_xyzw of <origin> is 0 0 0 0, which is no rotation", origin.source)
    return Pose(position, normalize((w, x, y, z)))


def wxyz_from_rpy(rpy: Vec3) -> Wxyz:
    """Return the quaternion of Rz(yaw) Ry(pitch) Rx(roll) for angles [rad]."""
    if rpy == ZERO:
        return UNMOVED.wxyz
    roll, pitch, yaw = (
        wxyz_from_axis_angle(axis, angle)
        for axis, angle in zip(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), rpy, strict=True)
    )
    return multiply(yaw, multiply(pitch, roll))


def named(elements: Sequence[Element], what: str) -> dict[str, Element]:
    """Return elements by name; ``what`` is the noun for them in messages.

    Raises:
        SourceError: two of them have the same name, or one has none.
    """
    by_name: dict[str, Element] = {}
    for element in elements:
        first = by_name.setdefault(attribute(element, "name"), element)
        if first is not element:
            name, line = element.attributes["name"], first.source.line
            message = f"there are two {what}s '{name}'; the other one is in line {line}"
            raise SourceError(message, element.source, "give each a name of its own")
    return by_name


def known_name(name: str, known: Mapping[str, object], what: str, element: Element) -> str:
    """Check that a name to which an element refers is in ``known``, and return it; ``what`` is the noun in messages.

    Raises:
        SourceError: nothing has this name.
    """
    if name not in known:
        hint = did_you_mean(name, known) or f"there are: {', '.join([*known][:8])}"
        raise SourceError(f"there is no {what} '{name}'", element.source, hint)
    return name
