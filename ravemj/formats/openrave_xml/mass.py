"""``<Mass>`` in a Body and in a KinBody: the inertia of a link from densities, totals and shapes.

The rules are OpenRAVE's, including quirks to which old models were tuned. OpenRAVE stores densities and totals in
single precision, so they are rounded here.
"""

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass

from ravemj.core.transforms import UNSCALED, ZERO, Rows, Vec3, Wxyz, add, dot, normalize, rows_from_wxyz, scale
from ravemj.errors import Diagnostics
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tags import Tag
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import ROTATIONS, hadamard, number, numbers, vector
from ravemj.model.builder import DEFAULT_INERTIAL
from ravemj.model.scene import Box, Geometry, Inertial, Sphere

NO_INERTIA: Rows = (ZERO, ZERO, ZERO)
_ROUNDING = 1e-6  # of inertias that were printed with few digits
TOTAL_DENSITY = 1000.0  # OpenRAVE's density for shapes whose total mass is given


@dataclass(slots=True)
class MassRule:
    """Rule for computing the mass properties of a link.

    Attributes:
        kind: ``mimicgeom``, ``sphere``, ``box`` or ``custom``.
        density: Density [kg/m^3].
        total: Total mass [kg]; used only if ``by_total``.
        by_total: Whether the mass is given by the total instead of the density.
        half_extents: Half extents of the box; the first is the radius of the sphere.
        custom_mass: Mass of a ``custom`` mass [kg]: the last total in the Body, not that of a KinBody.
        com: Its centre of mass.
        inertia: Its inertia about the centre of mass.
        axes: The orientation of its principal axes, or None for any that fit the inertia.
    """

    kind: str = "sphere"
    density: float = 1.0
    total: float = 1.0
    by_total: bool = False
    half_extents: Vec3 = UNSCALED
    custom_mass: float = 1.0
    com: Vec3 = ZERO
    inertia: Rows = DEFAULT_INERTIAL.inertia
    axes: Wxyz | None = None


@dataclass(slots=True)
class _Mass:
    """Reading state of a ``<Mass>`` in a ``<Body>``."""

    diagnostics: Diagnostics
    rule: MassRule
    scale: Vec3

    def density(self, element: Element) -> None:
        """Read a ``<density>``; it does not affect a custom mass, but does affect the next Mass (test gap-21)."""
        self.rule.density = single(number(element, self.diagnostics, self.rule.density))
        self.rule.by_total = False

    def total(self, element: Element) -> None:
        """Read a total mass: ``<total>`` in single, ``<precisetotal>`` in double precision."""
        rule = self.rule
        total = number(element, self.diagnostics, rule.custom_mass if rule.kind == "custom" else rule.total)
        rule.total = rule.custom_mass = single(total) if element.tag == "total" else total
        rule.by_total = True

    def radius(self, element: Element) -> None:
        before, y, z = self.rule.half_extents
        self.rule.half_extents = (number(element, self.diagnostics, before) * self.scale[0], y, z)

    def com(self, element: Element) -> None:
        self.rule.com = hadamard(self.scale, vector(element, self.diagnostics, self.rule.com))

    def inertia(self, element: Element) -> None:
        """Read the inertia of a custom mass; only its upper triangle is used."""
        before = [value for row in self.rule.inertia for value in row]
        xx, xy, xz, yx, yy, yz, zx, zy, zz = numbers(element, 9, self.diagnostics, before)
        if max(abs(xy - yx), abs(xz - zx), abs(yz - zy)) > _ROUNDING * max(abs(xx), abs(yy), abs(zz)):
            message = f"<{element.spelled}> is not symmetric; OpenRAVE takes what stands above its diagonal"
            self.diagnostics.warn("asymmetric-inertia", message, element.source)
        self.rule.inertia = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))

    def axes(self, element: Element) -> None:
        self.rule.axes = normalize(ROTATIONS["quat"](element, self.diagnostics))

    def extents(self, element: Element) -> None:
        """Accept and ignore ``<extents>``, as OpenRAVE does in a Body (test mass-11)."""


MASS_ATTRIBUTES = {"type": "mimicgeom, sphere, box, custom"}
MASS_TAGS: dict[str, Tag[_Mass]] = {
    "density": Tag(_Mass.density, "[kg/m³]", once=True),
    "total": Tag(_Mass.total, "[kg]", once=True),
    "precisetotal": Tag(
        _Mass.total,
        "[kg] of which OpenRAVE, which does not know it, has single precision; ravemj writes it",
    ),
    "radius": Tag(_Mass.radius, "of a sphere [m]", once=True),
    "extents": Tag(_Mass.extents, "no effect, as in OpenRAVE; a warning says so", once=True),
    "com": Tag(_Mass.com, "centre of a custom mass [m]", once=True),
    "inertia": Tag(_Mass.inertia, "of a custom mass, about its centre: nine numbers [kg m²]", once=True),
    "principalaxes": Tag(
        _Mass.axes,
        "w x y z of the principal axes that a custom mass has of all that fit its inertia; ravemj's own",
    ),
}


def read_mass(element: Element, before: MassRule | None, scale: Vec3, context: Context) -> MassRule:
    """Read a ``<Mass>`` of a Body; return the rule of earlier elements, ``before``, updated by this element.

    Lengths are multiplied by the factors ``scale`` along x, y and z.
    """
    context.check_attributes(element, MASS_ATTRIBUTES, {})
    kind = element.attributes.get("type", "sphere").lower()
    if kind not in {"mimicgeom", "sphere", "box", "custom"}:  # mass-24
        message = f"there is no mass of type '{kind}'; OpenRAVE takes a sphere"
        context.diagnostics.warn("unknown-type", message, element.source)
        kind = "sphere"
    rule = before or MassRule()
    rule.kind, rule.by_total = kind, False  # whatever the KinBody's was (gap-22, gap-23)
    context.walk(element, MASS_TAGS, {}, _Mass(context.diagnostics, rule, scale))
    if kind == "box" and any(child.tag == "extents" for child in element.children):
        message = f"<extents> of a box mass in a Body has no effect in OpenRAVE; the half sizes are {rule.half_extents}"
        context.diagnostics.warn("openrave-bug", message, element.source, "write the mass as type custom")
    return rule


@dataclass(slots=True)
class DefaultMass:
    """Default mass of subsequent Bodies, from the ``<Mass>`` elements of a KinBody."""

    context: Context
    kind: str = ""  # before the first
    number: float = 1.0  # density or total
    is_total: bool = False
    half_extents: Vec3 = UNSCALED

    def rule(self) -> MassRule | None:
        """Return the initial mass rule of a Body, or None before the first ``<Mass>``."""
        by_total = self.is_total and self.kind != "mimicgeom"
        return MassRule(self.kind, self.number, self.number, by_total, self.half_extents) if self.kind else None

    def read(self, element: Element) -> None:
        """Read a ``<Mass>`` of a KinBody."""
        self.context.check_attributes(element, DEFAULT_MASS_ATTRIBUTES, {})
        kind = element.attributes.get("type", "sphere").lower()
        if kind not in {"mimicgeom", "sphere", "box"}:  # "custom" too
            message = f"OpenRAVE takes a mass of type '{kind}' in a KinBody for a sphere"
            self.context.diagnostics.warn("openrave-bug", message, element.source, "give each Body its own Mass")
            kind = "sphere"
        self.kind, self.is_total = kind, False
        self.context.walk(element, DEFAULT_MASS_TAGS, {}, self)
        if self.is_total and kind == "mimicgeom":
            message = f"OpenRAVE takes the total {self.number:g} of a KinBody's mimicgeom mass for a density"
            self.context.diagnostics.warn("openrave-bug", message, element.source, "write <density>")

    def read_number(self, element: Element) -> None:
        """Read a ``<density>`` or a ``<total>``, which are stored in the same variable (test mass-21)."""
        self.number = single(number(element, self.context.diagnostics, self.number))
        self.is_total = element.tag == "total"

    def radius(self, element: Element) -> None:
        """Read the ``<radius>`` of a sphere."""
        before, y, z = self.half_extents
        self.half_extents = (number(element, self.context.diagnostics, before), y, z)

    def extents(self, element: Element) -> None:
        """Read the half extents of a box; for other kinds and after a total they have no effect (test gap-24)."""
        half_extents = vector(element, self.context.diagnostics, self.half_extents)
        if self.kind == "box" and not self.is_total:
            self.half_extents = half_extents


DEFAULT_MASS_ATTRIBUTES = {"type": "mimicgeom, sphere, box; others count as sphere"}
DEFAULT_MASS_TAGS: dict[str, Tag[DefaultMass]] = {
    "density": Tag(DefaultMass.read_number, "[kg/m³]", once="density"),
    "total": Tag(DefaultMass.read_number, "[kg]; of mimicgeom OpenRAVE takes it for a density", once="total"),
    "radius": Tag(DefaultMass.radius, "of a sphere [m]", once=True),
    "extents": Tag(DefaultMass.extents, "of a box: half sizes [m]", once=True),
}


def link_inertial(rule: MassRule | None, geometries: Sequence[Geometry]) -> Inertial:
    """Return the mass properties of a link with the given shapes."""
    if rule is None:
        return DEFAULT_INERTIAL
    if rule.kind == "custom":
        return Inertial(rule.custom_mass, rule.com, rule.inertia, rule.axes)
    if rule.kind == "mimicgeom":
        return _sum_of_shapes(rule, geometries)
    shape = Box(rule.half_extents) if rule.kind == "box" else Sphere(rule.half_extents[0])
    mass, moments = shape.mass_moments(rule.density)
    if rule.by_total:
        moments = scale(moments, rule.total / mass if mass else 0.0)
        mass = rule.total
    return Inertial(mass, ZERO, _diagonal(moments))


def _sum_of_shapes(rule: MassRule, geometries: Sequence[Geometry]) -> Inertial:
    """Return the combined mass properties of all shapes, by the parallel axis theorem.

    With a total mass, OpenRAVE scales the masses of the shapes but not their inertias (test mass-06). It divides the
    total by 0 if all shapes lack a volume (test random-xml-132), but not if there are no shapes (test gap-25).
    """
    density = TOTAL_DENSITY if rule.by_total else rule.density
    solids = [geometry.shape.mass_moments(density) for geometry in geometries]
    mass = sum(part for part, _ in solids)
    if mass == 0.0:
        return Inertial(0.0, ZERO, NO_INERTIA, undefined=rule.by_total and bool(geometries))
    factor = rule.total / mass if rule.by_total else 1.0
    poses = [geometry.T_link_geometry for geometry in geometries]
    com = ZERO
    for (position, _), (part, _) in zip(poses, solids, strict=True):
        com = add(com, scale(position, part / mass))
    inertia = NO_INERTIA
    for (position, wxyz), (part, moments) in zip(poses, solids, strict=True):
        inertia = _add_rows(inertia, _rotated(moments, wxyz))
        if position != com:  # a single shape has no arm
            inertia = _add_rows(inertia, _point_inertia(part * factor, add(position, scale(com, -1.0))))
    return Inertial(mass * factor, com, inertia)


def _diagonal(moments: Vec3) -> Rows:
    return ((moments[0], 0.0, 0.0), (0.0, moments[1], 0.0), (0.0, 0.0, moments[2]))


def _rotated(moments: Vec3, wxyz: Wxyz) -> Rows:
    """Return the inertia tensor with these principal moments along the axes of the orientation ``wxyz``."""
    if moments[0] == moments[1] == moments[2] or not any(wxyz[1:]):
        return _diagonal(moments)
    rows = rows_from_wxyz(wxyz)
    weighted = [(row[0] * moments[0], row[1] * moments[1], row[2] * moments[2]) for row in rows]
    xy, xz, yz = dot(weighted[0], rows[1]), dot(weighted[0], rows[2]), dot(weighted[1], rows[2])
    return (
        (dot(weighted[0], rows[0]), xy, xz),
        (xy, dot(weighted[1], rows[1]), yz),
        (xz, yz, dot(weighted[2], rows[2])),
    )


def _point_inertia(mass: float, arm: Vec3) -> Rows:
    """Return the inertia tensor about the origin of a point mass at ``arm``."""
    x, y, z = arm
    square = dot(arm, arm)
    return (
        (mass * (square - x * x), -mass * x * y, -mass * x * z),
        (-mass * x * y, mass * (square - y * y), -mass * y * z),
        (-mass * x * z, -mass * y * z, mass * (square - z * z)),
    )


def _add_rows(a: Rows, b: Rows) -> Rows:
    return (add(a[0], b[0]), add(a[1], b[1]), add(a[2], b[2]))


def single(value: float) -> float:
    """Round to single precision."""
    try:
        return struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
