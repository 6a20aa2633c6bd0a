"""Shapes as solids of the kinds that MuJoCo has."""

from ravemj.core.transforms import Vec3, add, scale
from ravemj.model.scene import Box, Capsule, Container, Cylinder, NoShape, Prism, Shape, Sphere, TriMesh

Solid = tuple[str, tuple[float, ...], Vec3]
"""MuJoCo's type and size of a solid, and where its centre is in the geometry."""


def solids(shape: Shape) -> list[Solid]:
    """Return the solids that a shape consists of."""
    match shape:
        case Box(half_extents):
            return [("box", half_extents, (0.0, 0.0, 0.0))]
        case Sphere(radius):
            return [("sphere", (radius,), (0.0, 0.0, 0.0))]
        case Cylinder(radius, height):
            return [("cylinder", (radius, height / 2), (0.0, 0.0, 0.0))]
        case Capsule(radius, height):
            return [("capsule", (radius, height / 2), (0.0, 0.0, 0.0))]
        case Container():
            return _container(shape)
        case Prism() | TriMesh() | NoShape():
            return []


def _container(shape: Container) -> list[Solid]:
    """Return floor, four walls, and what stands on the floor; the origin is the middle of the outer bottom."""
    outer, inner = shape.outer_extents, shape.inner_extents
    wall_x, wall_y, floor = ((o - i) / 2 for o, i in zip(outer, inner, strict=True))
    floor *= 2
    solids: list[Solid] = [("box", (outer[0] / 2, outer[1] / 2, floor / 2), (0.0, 0.0, floor / 2))]
    middle: Vec3 = (0.0, 0.0, outer[2] / 2)
    for sign in (-1.0, 1.0):
        across: Vec3 = ((outer[0] - wall_x) / 2, 0.0, 0.0)
        along: Vec3 = (0.0, (outer[1] - wall_y) / 2, 0.0)
        solids.append(("box", (wall_x / 2, outer[1] / 2, outer[2] / 2), add(middle, scale(across, sign))))
        solids.append(("box", (outer[0] / 2, wall_y / 2, outer[2] / 2), add(middle, scale(along, sign))))
    for size in (shape.bottom_cross, shape.bottom):
        if all(size):
            solids.append(("box", scale(size, 0.5), (0.0, 0.0, floor + size[2] / 2)))
    return solids
