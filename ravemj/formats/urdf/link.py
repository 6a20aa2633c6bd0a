"""``<link>``: mass properties and shapes."""

from collections.abc import Callable
from dataclasses import replace

from ravemj.core.transforms import UNMOVED, Rows, Vec3, Wxyz, rows_from_wxyz
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.urdf.elements import attribute, check_children, children, number_of, numbers_of, only, origin_of
from ravemj.formats.urdf.shapes import UrdfShapeReader
from ravemj.model.builder import LinkBuilder
from ravemj.model.scene import Geometry, Inertial
from ravemj.model.shape_bodies import MASSLESS

VISUAL_GROUP, SPHERES_GROUP = "visual", "spheres"
"""Geometry groups that every link has, as in or_urdf."""

_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_KNOWN = ("inertial", "visual", "collision", "geometry_group")


def read_link(element: Element, shapes: UrdfShapeReader) -> LinkBuilder:
    """Read a ``<link>``; its pose in the body is set later from the joints."""
    context = shapes.context
    check_children(element, _KNOWN, context, ("sensor", "gazebo", "contact"))
    link = LinkBuilder(element.attributes["name"], element.source, inertial=_inertial(element, context))
    visuals = [shape for visual in children(element, "visual") if (shape := shapes.visual(visual)) is not None]
    collisions = [
        shape for collision in children(element, "collision") if (shape := shapes.collision(collision)) is not None
    ]
    link.geometries = [*(drawn for drawn, _ in visuals), *collisions]
    link.add_to_group(VISUAL_GROUP, (shaped for _, shaped in visuals))
    link.add_to_group(SPHERES_GROUP, ())
    return link


def read_groups(element: Element, shapes: UrdfShapeReader) -> dict[str, list[Geometry]]:
    """Return the shapes of the ``<geometry_group>`` elements of a link, or_urdf's extension, by group."""
    groups: dict[str, list[Geometry]] = {}
    for group in children(element, "geometry_group"):
        shape = shapes.collision(group)
        groups.setdefault(attribute(group, "name"), []).extend([] if shape is None else [shape])
    return groups


def _inertial(element: Element, context: Context) -> Inertial:
    """Return the mass properties of a link; ``MASSLESS`` if it has no ``<inertial>``."""
    inertial = only(element, "inertial", context)
    if inertial is None:
        return MASSLESS
    T_link_inertial = origin_of(inertial, context)
    mass, tensor = only(inertial, "mass", context), only(inertial, "inertia", context)
    for tag, part in (("mass", mass), ("inertia", tensor)):
        if part is None:
            context.diagnostics.error(
                "missing-inertia", f"<inertial> has no <{tag}>", inertial.source, "it counts as 0"
            )
    kilograms = 0.0 if mass is None else numbers_of(mass, "value", 1)[0]
    moments = [0.0 if tensor is None else number_of(tensor, name, 0.0) for name in _MOMENTS]
    if not kilograms and not any(moments):
        return replace(MASSLESS, com=T_link_inertial.position)
    return Inertial(kilograms, T_link_inertial.position, _turned(moments, T_link_inertial.wxyz))


def _turned(moments: list[float], wxyz: Wxyz) -> Rows:
    """Return the inertia tensor R I R^T; ``moments`` are xx, xy, xz, yy, yz, zz of I, ``wxyz`` is R."""
    xx, xy, xz, yy, yz, zz = moments
    tensor: Rows = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    if wxyz == UNMOVED.wxyz:
        return tensor
    rotation = rows_from_wxyz(wxyz)
    half = [[sum(row[k] * tensor[k][j] for k in range(3)) for j in range(3)] for row in rotation]

    def product(i: int, j: int) -> float:
        return sum(half[min(i, j)][k] * rotation[max(i, j)][k] for k in range(3))  # symmetric to the last digit

    return _row(product, 0), _row(product, 1), _row(product, 2)


def _row(product: Callable[[int, int], float], i: int) -> Vec3:
    return product(i, 0), product(i, 1), product(i, 2)
