"""What OpenRAVE has in memory after loading: frozen, resolved, nothing of XML and nothing of MuJoCo.

Readers make a ``Scene`` (through ``ravemj.builder``), writers and the runtime read it. Lengths are metres,
angles radians, masses kilograms. Links are referred to by their index in ``KinBody.links``.
"""

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from ravemj.errors import Source
from ravemj.transforms import Floats, Ints, Pose, Rows, Vec3

Rgb = tuple[float, float, float]
JointKind = Literal["hinge", "slider"]

UNLIMITED = 10000.0
"""The limit [rad] that OpenRAVE reports for a circular joint."""


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
        vertices = np.array(self.vertices, dtype=np.float64).reshape(-1, 3)
        triangles = np.array(self.triangles, dtype=np.int_).reshape(-1, 3)
        for name, numbers in (("vertices", vertices), ("triangles", triangles)):
            numbers.flags.writeable = False
            object.__setattr__(self, name, numbers)

    @cached_property
    def digest(self) -> str:
        """A name for the content: the same for the same numbers."""
        content = hashlib.sha256(self.vertices.tobytes())
        content.update(self.triangles.tobytes())
        return content.hexdigest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mesh) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)


@dataclass(frozen=True, slots=True)
class Box:
    """A box; ``half_extents`` are half its edge lengths."""

    half_extents: Vec3


@dataclass(frozen=True, slots=True)
class Sphere:
    """A sphere."""

    radius: float


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder along z, centred; ``height`` is the full height."""

    radius: float
    height: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """A capsule along z, centred; ``height`` is that of the cylindrical part."""

    radius: float
    height: float


Shape = Box | Sphere | Cylinder | Capsule


@dataclass(frozen=True, slots=True, kw_only=True)
class Geometry:
    """A shape fixed to a link.

    Attributes:
        shape: Its kind and sizes.
        T_link_geometry: Its pose in the link.
        name: Its name; often empty.
        diffuse: Colour, each part from 0 to 1.
        ambient: Colour in the shade, each part from 0 to 1.
        transparency: 0 is opaque, 1 invisible.
        visible: False where it only collides.
        source: The element that it comes from.
    """

    shape: Shape
    T_link_geometry: Pose
    name: str
    diffuse: Rgb
    ambient: Rgb
    transparency: float
    visible: bool
    source: Source


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass properties of a link.

    Attributes:
        mass: Mass [kg].
        com: Centre of mass in the link frame [m].
        inertia: Inertia tensor about the centre of mass, in axes parallel to the link's [kg m^2].
    """

    mass: float
    com: Vec3
    inertia: Rows


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """A rigid part of a body.

    Attributes:
        name: Its name.
        T_world_link: Its pose after loading.
        inertial: Its mass properties, as the file gives them.
        geometries: Its shapes, in document order.
        static: True for ``type="static"``.
        enabled: False where collision checking leaves it out.
        source: The element that it comes from.
    """

    name: str
    T_world_link: Pose
    inertial: Inertial
    geometries: tuple[Geometry, ...]
    static: bool
    enabled: bool
    source: Source


@dataclass(frozen=True, slots=True)
class Axis:
    """One degree of freedom of a joint.

    Attributes:
        direction: Unit vector in the frame of the joint's parent link.
        reference: The value at which ``Joint.T_parent_child`` holds.
        value: The value after loading.
        lower: Lower limit [rad or m].
        upper: Upper limit [rad or m].
        circular: True for a joint that turns without end; its limits are ±``UNLIMITED``.
        weight: Weight in distances between configurations.
        resolution: Step of planners [rad or m].
        max_velocity: Velocity limit [rad/s or m/s].
        max_acceleration: Acceleration limit [rad/s^2 or m/s^2].
        max_torque: Torque or force limit [N m or N]; 0 where the file says nothing.
    """

    direction: Vec3
    reference: float = 0.0
    value: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    circular: bool = False
    weight: float = 1.0
    resolution: float = 0.02
    max_velocity: float = 10.0
    max_acceleration: float = 50.0
    max_torque: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """A joint between two links; a positive value moves the child right-handed about or along the axis.

    Attributes:
        name: Its name.
        kind: ``hinge`` or ``slider``.
        parent: Index of the link nearer to link 0.
        child: Index of the link farther from link 0.
        T_parent_child: Relative pose of the two at ``Axis.reference``.
        anchor: A point on the axis, in the parent's frame.
        axes: Its degrees of freedom.
        places_child: False for a joint that closes a loop: another joint places its child.
        source: The element that it comes from.
    """

    name: str
    kind: JointKind
    parent: int
    child: int
    T_parent_child: Pose
    anchor: Vec3
    axes: tuple[Axis, ...]
    places_child: bool
    source: Source

    @property
    def static(self) -> bool:
        """True for a weld: a joint whose limits leave no room."""
        return all(axis.lower == axis.upper and not axis.circular for axis in self.axes)


@dataclass(frozen=True, slots=True, kw_only=True)
class KinBody:
    """A body: links and the joints between them.

    Attributes:
        name: Its name, unique in an environment.
        is_robot: True for a ``<Robot>``.
        links: Links in the order of their first appearance; link 0 is the root.
        joints: Active joints in DOF order.
        passive_joints: Joints without a DOF.
        adjacent: Pairs of link indices that ``<adjacent>`` names.
        source: The element that it comes from.
    """

    name: str
    is_robot: bool
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    passive_joints: tuple[Joint, ...]
    adjacent: tuple[tuple[int, int], ...]
    source: Source

    @property
    def dof_axes(self) -> tuple[Axis, ...]:
        """The axes of all active joints, in DOF order."""
        return tuple(axis for joint in self.joints for axis in joint.axes)


@dataclass(frozen=True, slots=True)
class View:
    """How a file wants to be looked at.

    Attributes:
        background: Colour behind everything.
        T_world_camera: Pose of the camera (z forward, y down), or None where the file has no camera.
    """

    background: Rgb = (1.0, 1.0, 1.0)
    T_world_camera: Pose | None = None


@dataclass(frozen=True, slots=True)
class Scene:
    """The content of a file.

    Attributes:
        bodies: Bodies in document order.
        view: Background and camera, or None where the file has no ``<Environment>``.
    """

    bodies: tuple[KinBody, ...] = ()
    view: View | None = None
