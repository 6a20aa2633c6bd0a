"""Single-link bodies of boxes, spheres or other shapes, made by a script instead of a file."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from ravemj.core.transforms import ZERO, Floats, Pose, wxyz_from_rows
from ravemj.errors import Source
from ravemj.model.scene import Box, Geometry, Inertial, KinBody, Link, Rgb, Shape, Sphere

FROM_SCRIPT = Source("made by a script")
"""Source of parts that are not described by a file."""

MASSLESS = Inertial(1e-10, ZERO, (ZERO, ZERO, ZERO))
"""OpenRAVE's mass properties of a link made of shapes alone."""

DIFFUSE: Rgb = (1.0, 0.5, 0.5)
AMBIENT: Rgb = (0.1, 0.0, 0.0)


def shape_geometry(shape: Shape, T_link_geometry: Pose, *, visible: bool) -> Geometry:
    """Return a geometry with OpenRAVE's default colours."""
    return Geometry(
        shape=shape,
        T_link_geometry=T_link_geometry,
        name="",
        diffuse=DIFFUSE,
        ambient=AMBIENT,
        transparency=0.0,
        visible=visible,
        source=FROM_SCRIPT,
    )


def box_geometries(boxes: Floats, *, visible: bool) -> list[Geometry]:
    """Return boxes as geometries.

    Each row contains centre and half extents [m], shape (n, 6); or centre, directions of the box's x, y and z axes, and
    half extents, shape (n, 15).
    """
    return [
        shape_geometry(Box((ex, ey, ez)), Pose((x, y, z), _rotation(axes)), visible=visible)
        for x, y, z, *axes, ex, ey, ez in boxes.tolist()
    ]


def _rotation(axes: Sequence[float]) -> tuple[float, float, float, float]:
    """Return the quaternion of the rotation with the given columns (nine numbers); the identity for no numbers."""
    return wxyz_from_rows([axes[row::3] for row in range(3)]) if axes else Pose().wxyz


def sphere_geometries(spheres: Floats, *, visible: bool) -> list[Geometry]:
    """Return spheres as geometries: each row contains centre and radius [m], shape (n, 4)."""
    return [shape_geometry(Sphere(radius), Pose((x, y, z)), visible=visible) for x, y, z, radius in spheres.tolist()]


def named_body(name: str, geometries: Iterable[Geometry]) -> KinBody:
    """Return a body of one static link with the given shapes."""
    nothing = KinBody(name=name, is_robot=False, links=(), joints=(), passive_joints=(), source=FROM_SCRIPT)
    return body_of_geometries(nothing, geometries)


def empty_body(body: KinBody) -> KinBody:
    """Return a body of the same name and class without links."""
    return KinBody(name=body.name, is_robot=body.is_robot, links=(), joints=(), passive_joints=(), source=FROM_SCRIPT)


def body_of_geometries(body: KinBody, geometries: Iterable[Geometry]) -> KinBody:
    """Return a body of the same name and class with one static link of the given shapes."""
    base = Link(
        name="base",
        T_world_link=Pose(),
        inertial=MASSLESS,
        geometries=tuple(geometries),
        static=True,
        enabled=True,
        source=FROM_SCRIPT,
    )
    return replace(empty_body(body), links=(base,))
