"""Attributes passed by the caller together with a file, in addition to those of a body's element.

They are applied after those of the file: a name replaces the body's name, a prefix is put before the names of its
parts, scale factors are multiplied. OpenRAVE applies them if the root of the file is a body, and not inside an
``<Environment>``.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from ravemj.core.transforms import Vec3
from ravemj.errors import Diagnostics, Source
from ravemj.formats.openrave_xml.context import Context, did_you_mean
from ravemj.formats.openrave_xml.prefix import Marks, add_prefix
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import hadamard, is_true, leading_numbers, scale_attribute
from ravemj.model.builder import BodyBuilder

Attributes = Mapping[str, str]
"""Attributes by their names in lower case."""

NOTHING: Attributes = MappingProxyType({})
KNOWN = {"name", "prefix", "scalegeometry", "skipgeometry"}


def check_given(given: Attributes, source: Source, context: Context, known: Collection[str] = KNOWN) -> None:
    """Report ignored attributes passed by a caller."""
    for name in given:
        if name in KNOWN and name not in known:
            message = f"the attribute '{name}' that was given for the file is left out: its root is not a body"
            context.diagnostics.warn("ignored-attribute", message, source, "write it in the <Robot> or <KinBody>")
        elif name not in known:
            message = f"nothing reads the attribute '{name}' that was given for the file"
            context.diagnostics.warn("unknown-attribute", message, source, did_you_mean(name, known))
    factors = leading_numbers(given.get("scalegeometry", "1"))
    if factors.rest or len(factors.values) not in {1, 3}:
        message = f"scalegeometry was given as '{given['scalegeometry']}', and should be one number or three"
        context.diagnostics.warn("bad-number", message, source)


def with_given(root: Element, given: Attributes, context: Context, others: Collection[str] = ()) -> Element:
    """Return the root element of an XML file with the attributes passed by a caller.

    ``others`` are the attributes that its format supports in addition to those of OpenRAVE's bodies.
    """
    if not given:
        return root
    is_body = root.tag in {"robot", "kinbody"}
    known = {*KNOWN, *others} if is_body else set[str]()
    check_given(given, root.source, context, known)
    if not is_body:
        return root
    attributes = root.attributes | {name: text for name, text in given.items() if name in known and text}
    attributes["prefix"] = given.get("prefix", "") + root.attributes.get("prefix", "")
    if given.get("scalegeometry"):
        factors = hadamard(given_scale(given), scale_attribute(root, context.diagnostics))
        attributes["scalegeometry"] = " ".join(map(repr, factors))
    return replace(root, attributes=attributes)


def adapt(body: BodyBuilder, root: Element, context: Context) -> None:
    """Apply the attributes ``prefix`` and ``skipgeometry`` of a URDF's root to its body."""
    add_prefix(root.attributes.get("prefix", ""), body, Marks(), whole=True)
    if is_true(root.attributes.get("skipgeometry", "")):
        for link in body.links:
            link.geometries = []
    if "scalegeometry" in root.attributes:
        message = "scalegeometry is left out: a URDF keeps its size"
        context.diagnostics.warn("ignored-attribute", message, root.source)


def given_scale(given: Attributes) -> Vec3:
    """Return the factors of lengths along x, y and z."""
    return scale_attribute(Element("", "", dict(given), Source("")), Diagnostics())


def give(given: Attributes, bodies: Sequence[BodyBuilder]) -> None:
    """Apply the caller's name, prefix and ``skipgeometry`` to bodies; the scale is already applied."""
    for body in bodies:
        add_prefix(given.get("prefix", ""), body, Marks(), whole=True)
        if is_true(given.get("skipgeometry", "")):
            for link in body.links:
                link.geometries = []
    if bodies and given.get("name"):
        bodies[0].name = given["name"]
