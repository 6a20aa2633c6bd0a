"""``<Mass>`` in a Body and in a KinBody: from densities, totals and shapes to the inertia of a link.

OpenRAVE's rules, quirks included: old models were tuned on them. Densities and totals are kept in single precision
there, so they are rounded to it here.
"""

import math
import struct
from collections.abc import Sequence
from typing import NamedTuple

from ravemj.core.transforms import ZERO, Rows, Vec3, Wxyz, add, dot, normalize, rows_from_wxyz, scale
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tags import Tag
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import ROTATIONS, hadamard, number, numbers, vector
from ravemj.model.builder import DEFAULT_INERTIAL
from ravemj.model.scene import Box, Geometry, Inertial, Sphere

NO_INERTIA: Rows = (ZERO, ZERO, ZERO)
_ROUNDING = 1e-6  # of inertias that were printed with few digits
TOTAL_DENSITY = 1000.0  # OpenRAVE's density for shapes whose total mass is given


class MassRule(NamedTuple):
    """How the mass properties of a link are computed.

    Attributes:
        kind: ``mimicgeom``, ``sphere``, ``box`` or ``custom``.
        density: Density [kg/m^3].
        total: Total mass [kg], which counts ``by_total``.
        by_total: Whether the mass follows from the total and not from the density.
        half_extents: Half sizes of the box; the first is the radius of the sphere.
        custom_mass: Mass of a ``custom`` mass [kg]: the last total of the Body, which a KinBody does not give.
        com: Its centre of mass.
        inertia: Its inertia about the centre of mass.
        axes: The orientation of its principal axes, or None for any that fit the inertia.
    """

    kind: str = "sphere"
    density: float = 1.0
    total: float = 1.0
    by_total: bool = False
    half_extents: Vec3 = (1.0, 1.0, 1.0)
    custom_mass: float = 1.0
    com: Vec3 = ZERO
    inertia: Rows = DEFAULT_INERTIAL.inertia
    axes: Wxyz | None = None


class MassReader:
    """Reads ``<Mass>`` elements in order; what one leaves out keeps its value.

    Attributes:
        rule: The rule so far, or None before the first ``<Mass>``.
    """

    def __init__(self, context: Context, default: MassRule | None, scale: Vec3) -> None:
        self._context = context
        self._scale = scale
        self._rule = default or MassRule()
        self.rule: MassRule | None = None

    def read(self, element: Element) -> None:
        """Read a ``<Mass>`` of a Body."""
        self._context.check_attributes(element, MASS_ATTRIBUTES, {})
        kind = element.attributes.get("type", "sphere").lower()
        if kind not in {"mimicgeom", "sphere", "box", "custom"}:  # mass-24
            self._context.diagnostics.warn(
                "unknown-type", f"there is no mass of type '{kind}'; OpenRAVE takes a sphere", element.source
            )
            kind = "sphere"
        self._rule = self._rule._replace(kind=kind, by_total=False)  # whatever the KinBody's was (gap-22, gap-23)
        self._context.walk(element, MASS_TAGS, {}, self)
        self.rule = self._rule
        if kind == "box" and any(child.tag == "extents" for child in element.children):
            self._context.diagnostics.warn(
                "openrave-bug",
                "<extents> of a box mass in a Body has no effect in OpenRAVE; "
                f"the half sizes are {self._rule.half_extents}",
                element.source,
                "write the mass as type custom",
            )

    def precise_total(self, element: Element) -> None:
        """Read a total mass in double precision."""
        self._take_total(self._total(element))

    def density(self, element: Element) -> None:
        """Read a ``<density>``; it has no effect on a custom mass (gap-21), but on a Mass after it."""
        density = single(number(element, self._context.diagnostics, self._rule.density))
        self._rule = self._rule._replace(density=density, by_total=False)

    def total(self, element: Element) -> None:
        """Read a ``<total>`` mass."""
        self._take_total(single(self._total(element)))

    def _total(self, element: Element) -> float:
        rule = self._rule
        return number(element, self._context.diagnostics, rule.custom_mass if rule.kind == "custom" else rule.total)

    def _take_total(self, total: float) -> None:
        self._rule = self._rule._replace(total=total, by_total=True, custom_mass=total)

    def radius(self, element: Element) -> None:
        """Read the ``<radius>`` of a sphere."""
        before, *others = self._rule.half_extents
        radius = number(element, self._context.diagnostics, before) * self._scale[0]
        self._rule = self._rule._replace(half_extents=(radius, *others))

    def com(self, element: Element) -> None:
        """Read the centre of mass of a custom mass."""
        com = vector(element, self._context.diagnostics, self._rule.com)
        self._rule = self._rule._replace(com=hadamard(self._scale, com))

    def inertia(self, element: Element) -> None:
        """Read the inertia of a custom mass; only its upper triangle counts."""
        before = [value for row in self._rule.inertia for value in row]
        xx, xy, xz, yx, yy, yz, zx, zy, zz = numbers(element, 9, self._context.diagnostics, before)
        if max(abs(xy - yx), abs(xz - zx), abs(yz - zy)) > _ROUNDING * max(abs(xx), abs(yy), abs(zz)):
            message = f"<{element.spelled}> is not symmetric; OpenRAVE takes what stands above its diagonal"
            self._context.diagnostics.warn("asymmetric-inertia", message, element.source)
        self._rule = self._rule._replace(inertia=((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))

    def axes(self, element: Element) -> None:
        """Read which principal axes a custom mass has."""
        self._rule = self._rule._replace(axes=normalize(ROTATIONS["quat"](element, self._context.diagnostics)))

    def extents(self, element: Element) -> None:
        """Accept ``<extents>``, which OpenRAVE does not read in a Body (mass-11)."""


MASS_ATTRIBUTES = {"type": "mimicgeom, sphere, box, custom"}
MASS_TAGS: dict[str, Tag[MassReader]] = {
    "density": Tag(MassReader.density, "[kg/m³]", once=True),
    "total": Tag(MassReader.total, "[kg]", once=True),
    "precisetotal": Tag(
        MassReader.precise_total,
        "[kg] of which OpenRAVE, which does not know it, has single precision; ravemj writes it",
    ),
    "radius": Tag(MassReader.radius, "of a sphere [m]", once=True),
    "extents": Tag(MassReader.extents, "no effect, as in OpenRAVE; a warning says so", once=True),
    "com": Tag(MassReader.com, "centre of a custom mass [m]", once=True),
    "inertia": Tag(MassReader.inertia, "of a custom mass, about its centre: nine numbers [kg m²]", once=True),
    "principalaxes": Tag(
        MassReader.axes,
        "w x y z of the principal axes that a custom mass has of all that fit its inertia; ravemj's own",
    ),
}


class DefaultMassReader:
    """Reads ``<Mass>`` of a KinBody: the default of the Bodies that follow it.

    Attributes:
        rule: The default so far, or None before the first ``<Mass>``.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self.rule: MassRule | None = None
        self._kind = "sphere"
        self._number = 1.0
        self._half_extents: Vec3 = (1.0, 1.0, 1.0)
        self._is_total = False

    def read(self, element: Element) -> None:
        """Read a ``<Mass>`` of a KinBody."""
        self._context.check_attributes(element, DEFAULT_MASS_ATTRIBUTES, {})
        kind = element.attributes.get("type", "sphere").lower()
        if kind not in {"mimicgeom", "sphere", "box"}:  # "custom" too
            message = f"OpenRAVE takes a mass of type '{kind}' in a KinBody for a sphere"
            self._context.diagnostics.warn("openrave-bug", message, element.source, "give each Body its own Mass")
            kind = "sphere"
        self._kind, self._is_total = kind, False
        self._context.walk(element, DEFAULT_MASS_TAGS, {}, self)
        if self._is_total and kind == "mimicgeom":
            message = f"OpenRAVE takes the total {self._number:g} of a KinBody's mimicgeom mass for a density"
            self._context.diagnostics.warn("openrave-bug", message, element.source, "write <density>")
        self.rule = MassRule(
            kind,
            density=self._number,
            total=self._number,
            by_total=self._is_total and kind != "mimicgeom",
            half_extents=self._half_extents,
        )

    def density(self, element: Element) -> None:
        """Read a ``<density>``."""
        self._number, self._is_total = self._read(element), False

    def total(self, element: Element) -> None:
        """Read a ``<total>``; it lands in the same place as a density (mass-21)."""
        self._number, self._is_total = self._read(element), True

    def _read(self, element: Element) -> float:
        return single(number(element, self._context.diagnostics, self._number))

    def radius(self, element: Element) -> None:
        """Read the ``<radius>`` of a sphere."""
        before, second, third = self._half_extents
        self._half_extents = (number(element, self._context.diagnostics, before), second, third)

    def extents(self, element: Element) -> None:
        """Read the half sizes of a box; of other kinds and behind a total they have no effect (gap-24)."""
        half_extents = vector(element, self._context.diagnostics, self._half_extents)
        if self._kind == "box" and not self._is_total:
            self._half_extents = half_extents


DEFAULT_MASS_ATTRIBUTES = {"type": "mimicgeom, sphere, box; others count as sphere"}
DEFAULT_MASS_TAGS: dict[str, Tag[DefaultMassReader]] = {
    "density": Tag(DefaultMassReader.density, "[kg/m³]", once=True),
    "total": Tag(DefaultMassReader.total, "[kg]; of mimicgeom OpenRAVE takes it for a density", once=True),
    "radius": Tag(DefaultMassReader.radius, "of a sphere [m]", once=True),
    "extents": Tag(DefaultMassReader.extents, "of a box: half sizes [m]", once=True),
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
    return Inertial(mass, ZERO, ((moments[0], 0.0, 0.0), (0.0, moments[1], 0.0), (0.0, 0.0, moments[2])))


def _sum_of_shapes(rule: MassRule, geometries: Sequence[Geometry]) -> Inertial:
    """Combine the solids of all shapes by the parallel axis theorem.

    With a total mass, OpenRAVE scales the masses of the parts and not their own inertias (mass-06). It divides a total
    by 0 where there are shapes and none has a volume (random-xml-132), and not where there are none (gap-25).
    """
    density = TOTAL_DENSITY if rule.by_total else rule.density
    solids = [geometry.shape.mass_moments(density) for geometry in geometries]
    mass = sum(part for part, _ in solids)
    if mass == 0.0:
        return Inertial(0.0, ZERO, NO_INERTIA, undefined=rule.by_total and bool(geometries))
    factor = rule.total / mass if rule.by_total else 1.0
    com = ZERO
    for geometry, (part, _) in zip(geometries, solids, strict=True):
        com = add(com, scale(geometry.T_link_geometry.position, part / mass))
    inertia = NO_INERTIA
    for geometry, (part, moments) in zip(geometries, solids, strict=True):
        position, wxyz = geometry.T_link_geometry
        arm = add(position, scale(com, -1.0))
        inertia = _add_rows(inertia, _rotated(moments, wxyz), _point_inertia(part * factor, arm))
    return Inertial(mass * factor, com, inertia)


def _rotated(moments: Vec3, wxyz: Wxyz) -> Rows:
    """Return R diag(moments) R^T."""
    if moments[0] == moments[1] == moments[2] or not any(wxyz[1:]):
        return ((moments[0], 0.0, 0.0), (0.0, moments[1], 0.0), (0.0, 0.0, moments[2]))
    rows = rows_from_wxyz(wxyz)
    weighted = [(row[0] * moments[0], row[1] * moments[1], row[2] * moments[2]) for row in rows]
    xy, xz, yz = dot(weighted[0], rows[1]), dot(weighted[0], rows[2]), dot(weighted[1], rows[2])
    return (
        (dot(weighted[0], rows[0]), xy, xz),
        (xy, dot(weighted[1], rows[1]), yz),
        (xz, yz, dot(weighted[2], rows[2])),
    )


def _point_inertia(mass: float, arm: Vec3) -> Rows:
    """Return the inertia of a point mass at the end of an arm."""
    x, y, z = arm
    square = dot(arm, arm)
    return (
        (mass * (square - x * x), -mass * x * y, -mass * x * z),
        (-mass * x * y, mass * (square - y * y), -mass * y * z),
        (-mass * x * z, -mass * y * z, mass * (square - z * z)),
    )


def _add_rows(*matrices: Rows) -> Rows:
    first, second, third = ZERO, ZERO, ZERO
    for matrix in matrices:
        first, second, third = add(first, matrix[0]), add(second, matrix[1]), add(third, matrix[2])
    return first, second, third


def single(value: float) -> float:
    """Round to single precision."""
    try:
        return struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
