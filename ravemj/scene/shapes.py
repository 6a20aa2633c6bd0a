"""Shapes, colours and triangles."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.errors import Source
from ravemj.scene.record import Record
from ravemj.transforms import Floats, Ints, Pose, Vec3

Rgb = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles; two meshes are equal if their numbers are.

    Attributes:
        vertices: Shape (n, 3) [m]; read-only.
        triangles: Indices of the corners of each triangle, counter-clockwise seen from outside, shape (m, 3);
            read-only.
    """

    vertices: Floats
    triangles: Ints

    def __post_init__(self) -> None:
        for name, kind in (("vertices", np.float64), ("triangles", np.int_)):
            given: NDArray[Any] = np.asarray(getattr(self, name))
            if not _is_settled(given, kind):
                numbers = given.reshape(-1, 3).astype(kind, order="C")
                numbers.flags.writeable = False
                object.__setattr__(self, name, numbers)

    @cached_property
    def digest(self) -> str:
        """A name for the content: the same for the same numbers."""
        import hashlib  # noqa: PLC0415 - slow to import

        content = hashlib.sha256(self.vertices.tobytes())
        content.update(self.triangles.tobytes())
        return content.hexdigest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mesh) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)


def _is_settled(numbers: NDArray[Any], kind: type) -> bool:
    """Tell whether a mesh can keep an array as it is: it is of the right form, has its own memory, and is read-only."""
    return (
        numbers.dtype == kind
        and numbers.shape[1:] == (3,)
        and numbers.flags.c_contiguous
        and numbers.flags.owndata
        and not numbers.flags.writeable
    )


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Box(Record):
    """A box; ``half_extents`` are half its edge lengths."""

    half_extents: Vec3


@dataclass(frozen=True, slots=True)
class CalibrationBoard(Box):
    """A box with a pattern that cameras are calibrated by; the pattern is not kept."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Sphere(Record):
    """A sphere."""

    radius: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Cylinder(Record):
    """A cylinder along z, centred; ``height`` is the full height."""

    radius: float
    height: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Capsule(Record):
    """A capsule along z, centred; ``height`` is that of the cylindrical part."""

    radius: float
    height: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Container(Record):
    """An open box that stands on the origin and opens along z; all sizes are full edge lengths.

    Attributes:
        outer_extents: Its outer size.
        inner_extents: The size of its interior.
        bottom_cross: Size of a cross on the bottom.
        bottom: Size of a plate on the bottom.
    """

    outer_extents: Vec3
    inner_extents: Vec3
    bottom_cross: Vec3
    bottom: Vec3


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Prism(Record):
    """Walls along z over the edges of a polygon, without top and bottom.

    Attributes:
        cross_section: Corners x y of the polygon [m]; the last is joined to the first.
        height: The full height; the origin is at half of it.
    """

    cross_section: tuple[tuple[float, float], ...]
    height: float

    def walls(self) -> Mesh:
        """Return the walls, two triangles for each edge."""
        corners = np.array(self.cross_section, dtype=float).reshape(-1, 2)
        count = len(corners)
        below, above = (np.column_stack([corners, np.full(count, z)]) for z in (-self.height / 2, self.height / 2))
        here, after = np.arange(count), np.roll(np.arange(count), -1)
        triangles = [(here, after, after + count), (here, after + count, here + count)]
        return Mesh(np.concatenate([below, above]), np.concatenate([np.column_stack(three) for three in triangles]))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TriMesh(Record):
    """Triangles; none where their file is missing."""

    mesh: Mesh


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class NoShape(Record):
    """A geometry without a shape."""


Shape = Box | Sphere | Cylinder | Capsule | Container | Prism | TriMesh | NoShape


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Surface(Record):
    """Triangles that are only drawn, in the frame of their geometry."""

    mesh: Mesh
    diffuse: Rgb
    transparency: float


class MeshFile(NamedTuple):
    """A mesh file, and factors along x, y and z."""

    name: str
    scale: Vec3 = (1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class Geometry(Record):
    """A shape fixed to a link.

    Attributes:
        shape: Its kind and sizes.
        T_link_geometry: Its pose in the link.
        name: Its name; often empty.
        diffuse: Colour, each part from 0 to 1.
        ambient: Colour in the shade, each part from 0 to 1.
        transparency: 0 is opaque, 1 invisible.
        visible: False where it only collides.
        modifiable: Whether planners may change it.
        display: What is drawn in place of the shape; None: the shape itself.
        render_file: Where this comes from, or None.
        collision_file: Where the triangles of the shape come from, or None.
        collision_mesh: The triangles that scripts get of a shape that is no mesh; None: its own.
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
