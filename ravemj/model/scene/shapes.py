"""Shapes, and geometries: shapes with pose and colours.

All properties of a shape type are in its class. A new type is a class here with its row in ``SHAPE_TYPES``, and a
member of the API's ``GeometryType``; its getters belong to the API's ``Geometry``.
"""

# ruff: noqa: D102 - the docstrings are in the base class

import functools
import math
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from typing import Any, NamedTuple, Self

import numpy as np

from ravemj.core.transforms import ZERO, Floats, Pose, Vec3, add, scale
from ravemj.errors import Source
from ravemj.model.scene.mesh import Bounds, Mesh
from ravemj.model.scene.record import Record
from ravemj.model.scene.tessellation import solid_mesh

Rgb = tuple[float, float, float]

CrossSection = tuple[tuple[float, float], ...]
"""Vertices x y of a polygon [m]; the last is connected to the first."""


class Solid(NamedTuple):
    """Solid that is a geom type of MuJoCo.

    Attributes:
        kind: MuJoCo's type of geom: ``box``, ``sphere``, ``cylinder`` or ``capsule``.
        size: MuJoCo's sizes: half extents of a box, else the radius and, along z, half the height [m].
        centre: Its centre in the frame of the shape.
    """

    kind: str
    size: tuple[float, ...]
    centre: Vec3 = ZERO


class Extent(NamedTuple):
    """Support function of a shape: Minkowski sum of a box, a disk in the xy plane and a ball.

    Attributes:
        box: Half the edge lengths of the box.
        disk: Radius of the disk.
        ball: Radius of the ball.
        centre: Centre of the shape in its frame.
    """

    box: Vec3 = ZERO
    disk: float = 0.0
    ball: float = 0.0
    centre: Vec3 = ZERO


class Size(NamedTuple):
    """Size parameter of a shape.

    Attributes:
        name: The name; also used by file readers and the API.
        type: ``float``, ``Vec3``, ``CrossSection`` or ``Mesh``.
        optional: Whether it may be omitted.
    """

    name: str
    type: object
    optional: bool


class Shape(Record):
    """Base class of shapes. By default a shape has no volume."""

    __slots__ = ()

    @classmethod
    @functools.cache
    def sizes(cls) -> tuple[Size, ...]:
        """Return the size parameters of the shape, in the order of its fields."""
        own: Any = cls  # ``fields`` requires a dataclass, as every shape is
        return tuple(Size(field.name, field.type, field.default is not MISSING) for field in fields(own))

    @classmethod
    def of_sizes(cls, values: Mapping[str, Any]) -> Self:
        """Return the shape with sizes from a mapping; other entries are ignored."""
        return cls(**{size.name: values[size.name] for size in cls.sizes() if size.name in values})

    def solids(self) -> list[Solid]:
        """Return the solids that the shape consists of; empty for shapes described only by triangles."""
        return []

    def triangulated(self) -> Mesh:
        """Return the surface as triangles, counter-clockwise seen from outside, in the frame of the shape.

        Round shapes have their vertices on the surface. Walls between several solids are kept.
        """
        solids = self.solids()
        return Mesh.merged(solid_mesh(kind, size).moved(Pose(centre).matrix()) for kind, size, centre in solids)

    def extent(self) -> Extent | None:
        """Return the support function of the shape; None if only its triangles define it."""
        return None

    def bounds(self, T_a_shape: Floats) -> Bounds:
        """Return the exact axis-aligned bounding box in frame a."""
        extent = self.extent()
        if extent is None:
            return self.triangulated().bounds(T_a_shape)
        rotation = T_a_shape[:3, :3]
        centre = rotation @ extent.centre + T_a_shape[:3, 3]
        reach = np.abs(rotation) @ extent.box + np.hypot(rotation[:, 0], rotation[:, 1]) * extent.disk + extent.ball
        return Bounds(centre - reach, centre + reach)

    def mass_moments(self, density: float) -> tuple[float, Vec3]:
        """Return mass [kg] and principal moments of inertia about the origin of the shape's frame [kg m^2].

        As in OpenRAVE, capsules, prisms and meshes have no mass.
        """
        del density
        return 0.0, ZERO


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Box(Shape):
    """Box with ``half_extents``."""

    half_extents: Vec3

    def solids(self) -> list[Solid]:
        return [Solid("box", self.half_extents)]

    def extent(self) -> Extent:
        return Extent(self.half_extents)

    def mass_moments(self, density: float) -> tuple[float, Vec3]:
        a, b, c = self.half_extents
        mass = 8 * a * b * c * density
        return mass, (mass / 3 * (b * b + c * c), mass / 3 * (a * a + c * c), mass / 3 * (a * a + b * b))


@dataclass(frozen=True, slots=True)
class CalibrationBoard(Box):
    """Box with a pattern for camera calibration; the pattern is not stored."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Sphere(Shape):
    """A sphere."""

    radius: float

    def solids(self) -> list[Solid]:
        return [Solid("sphere", (self.radius,))]

    def extent(self) -> Extent:
        return Extent(ball=self.radius)

    def mass_moments(self, density: float) -> tuple[float, Vec3]:
        mass = 4 / 3 * math.pi * self.radius**3 * density
        moment = 0.4 * mass * self.radius**2
        return mass, (moment, moment, moment)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Cylinder(Shape):
    """Cylinder along z, centred; ``height`` is the full height."""

    radius: float
    height: float

    def solids(self) -> list[Solid]:
        return [Solid("cylinder", (self.radius, self.height / 2))]

    def extent(self) -> Extent:
        return Extent((0.0, 0.0, self.height / 2), disk=self.radius)

    def mass_moments(self, density: float) -> tuple[float, Vec3]:
        mass = math.pi * self.radius**2 * self.height * density
        across = mass * (self.radius**2 / 4 + self.height**2 / 12)
        return mass, (across, across, mass * self.radius**2 / 2)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Capsule(Shape):
    """Capsule along z, centred; ``height`` is the height of the cylindrical part."""

    radius: float
    height: float

    def solids(self) -> list[Solid]:
        return [Solid("capsule", (self.radius, self.height / 2))]

    def extent(self) -> Extent:
        return Extent((0.0, 0.0, self.height / 2), ball=self.radius)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Container(Shape):
    """Open box that stands on the origin and opens along z; all sizes are full edge lengths.

    Attributes:
        outer_extents: Its outer size.
        inner_extents: The size of its interior.
        bottom_cross: Size of a cross on the bottom.
        bottom: Size of a plate on the bottom.
    """

    outer_extents: Vec3
    inner_extents: Vec3
    bottom_cross: Vec3 = ZERO
    bottom: Vec3 = ZERO

    def solids(self) -> list[Solid]:
        """Return the floor, four walls, cross and plate."""
        outer, inner = self.outer_extents, self.inner_extents
        wall_x, wall_y, floor = ((o - i) / 2 for o, i in zip(outer, inner, strict=True))
        floor *= 2  # no lid
        solids = [Solid("box", (outer[0] / 2, outer[1] / 2, floor / 2), (0.0, 0.0, floor / 2))]
        middle: Vec3 = (0.0, 0.0, outer[2] / 2)
        for sign in (-1.0, 1.0):
            across: Vec3 = ((outer[0] - wall_x) / 2, 0.0, 0.0)
            along: Vec3 = (0.0, (outer[1] - wall_y) / 2, 0.0)
            solids.append(Solid("box", (wall_x / 2, outer[1] / 2, outer[2] / 2), add(middle, scale(across, sign))))
            solids.append(Solid("box", (outer[0] / 2, wall_y / 2, outer[2] / 2), add(middle, scale(along, sign))))
        for size in (self.bottom_cross, self.bottom):
            if all(size):
                solids.append(Solid("box", scale(size, 0.5), (0.0, 0.0, floor + size[2] / 2)))
        return solids

    def extent(self) -> Extent:
        half = scale(self.outer_extents, 0.5)
        return Extent(half, centre=(0.0, 0.0, half[2]))

    def mass_moments(self, density: float) -> tuple[float, Vec3]:
        """Return the moments of a solid box about the origin, as OpenRAVE does."""
        return Box(scale(self.outer_extents, 0.5)).mass_moments(density)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Prism(Shape):
    """Walls along z on the edges of a polygon, without top and bottom.

    Attributes:
        cross_section: The polygon.
        height: The full height; the origin is at half of it.
    """

    cross_section: CrossSection
    height: float

    def triangulated(self) -> Mesh:
        """Return the walls, two triangles for each edge."""
        corners = np.array(self.cross_section, dtype=float).reshape(-1, 2)
        count = len(corners)
        below, above = (np.column_stack([corners, np.full(count, z)]) for z in (-self.height / 2, self.height / 2))
        here, after = np.arange(count), np.roll(np.arange(count), -1)
        triangles = [(here, after, after + count), (here, after + count, here + count)]
        return Mesh(np.concatenate([below, above]), np.concatenate([np.column_stack(three) for three in triangles]))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TriMesh(Shape):
    """Triangle mesh; empty if its file is missing."""

    mesh: Mesh

    def triangulated(self) -> Mesh:
        return self.mesh


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class NoShape(Shape):
    """Geometry without a shape."""


class ShapeType(NamedTuple):
    """OpenRAVE's names of a shape type.

    Attributes:
        shape: The class.
        name: Its name in ``GeometryType``.
        xml: The ``type`` of a ``<Geom>``; None if the type does not exist in XML.
        collada: Elements of a ``geometry_info`` in COLLADA; those of capsules, prisms and empty shapes are ravemj's
            own.
    """

    shape: type[Shape]
    name: str
    xml: str | None = None
    collada: tuple[str, ...] = ()


SHAPE_TYPES = (
    ShapeType(Box, "Box", "box", ("box",)),
    ShapeType(Sphere, "Sphere", "sphere", ("sphere",)),
    ShapeType(Cylinder, "Cylinder", "cylinder", ("cylinder", "cylinderz")),
    ShapeType(Capsule, "Capsule", "capsule", ("capsule",)),
    ShapeType(Container, "Container", "container", ("container",)),
    ShapeType(Prism, "Prism", "prism", ("prism",)),
    ShapeType(TriMesh, "Trimesh", "trimesh", ("trimesh",)),
    ShapeType(CalibrationBoard, "CalibrationBoard", collada=("calibration_board",)),
    ShapeType(NoShape, "None_", "none", ("none",)),
)
"""All types of geometry."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Surface(Record):
    """Visual triangles in the frame of their geometry."""

    mesh: Mesh
    diffuse: Rgb
    transparency: float


class MeshFile(NamedTuple):
    """Mesh file with scale factors along x, y and z."""

    name: str
    scale: Vec3 = (1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class Geometry(Record):
    """Shape fixed to a link.

    Attributes:
        shape: The shape with its sizes.
        T_link_geometry: Its pose in the link.
        name: Its name; often empty.
        diffuse: Colour, each component from 0 to 1.
        ambient: Ambient colour, each component from 0 to 1.
        transparency: 0 is opaque, 1 invisible.
        visible: Whether it is drawn.
        modifiable: Whether planners may change it.
        display: Surfaces drawn instead of the shape; None draws the shape itself.
        render_file: The file of ``display``, or None.
        collision_file: The file of the shape's triangles, or None.
        collision_mesh: Triangles returned to scripts for a shape that is not a mesh; None means the shape's own.
        source: The element that it comes from.
    """

    shape: Shape
    T_link_geometry: Pose
    name: str
    diffuse: Rgb
    ambient: Rgb
    transparency: float
    visible: bool
    modifiable: bool = True
    display: tuple[Surface, ...] | None = None
    render_file: MeshFile | None = None
    collision_file: MeshFile | None = None
    collision_mesh: Mesh | None = None
    source: Source

    def triangulated(self) -> Mesh:
        """Return the triangles for scripts in the geometry frame: ``collision_mesh`` if given, else of the shape."""
        return self.shape.triangulated() if self.collision_mesh is None else self.collision_mesh
