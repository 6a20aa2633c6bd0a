"""Other files as bodies: the first body of a COLLADA file joins the body being read, a mesh becomes one link."""

import os
from dataclasses import replace
from pathlib import Path

from ravemj.core.transforms import Pose, Vec3
from ravemj.errors import Diagnostics, LimitError, Source, SourceError
from ravemj.formats import collada
from ravemj.formats.meshes import MESH_SUFFIXES
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tree import Element
from ravemj.model.builder import BodyBuilder, LinkBuilder, SensorBuilder
from ravemj.model.scene import Geometry, TriMesh
from ravemj.model.shape_bodies import MASSLESS


def add_collada(
    body: BodyBuilder, uri: str, source: Source, context: Context, scale: Vec3, *, skip_geometry: bool
) -> None:
    """Fill a body with the first body of a COLLADA file, all joints at 0; a malformed file is reported.

    Args:
        body: The body.
        uri: The file, optionally with ``#`` and the id of the body.
        source: Source of the reference.
        context: Receives diagnostics.
        scale: Factors of lengths along x, y and z.
        skip_geometry: Whether to omit the shapes.
    """
    path, wanted = collada.split_uri(uri)
    found_path = context.find(path, source)
    if found_path is None:
        return
    path = f"{found_path}#{wanted}" if wanted else found_path
    try:
        factor = uniform(scale, source, context)
        content = collada.read_file(path, context.access, source, factor, context.documents)
        first = next(iter((*content.bodies, *content.others)), None)
        if first is None:
            raise SourceError("there is no body in it", Source(found_path, included_from=source))
        if first.is_robot and not body.is_robot:  # gap-66
            raise SourceError("it holds a robot, and OpenRAVE takes no robot for a KinBody", source, "write <Robot>")
        first.joint_values = None  # those of the file hold only where it is loaded by itself (gap-51)
        placed = first.freeze(Diagnostics())
    except LimitError:
        raise
    except SourceError as error:
        context.diagnostics.error("broken-file", error.message, error.source)
        return
    body.name = first.name
    body.source = body.source if body.links else Source(path, 0, source)
    for link, at_values in zip(first.links, placed.links, strict=True):
        link.pose = at_values.T_world_link
        if skip_geometry:
            link.geometries = []
    _join(body, first)


def add_urdf(body: BodyBuilder, root: Element, element: Element, context: Context, *, skip_geometry: bool) -> None:
    """Fill a body with a URDF; a malformed one is reported. A KinBody gets no manipulators.

    Args:
        body: The body.
        root: The root element of the URDF.
        element: The element that names the file; its attributes may name the SRDF.
        context: Receives diagnostics.
        skip_geometry: Whether to omit the shapes.
    """
    from ravemj.formats.urdf.robot import read_robot  # noqa: PLC0415 - rarely wanted

    try:
        robot = read_robot(root, context, element.attributes)
    except LimitError:
        raise
    except SourceError as error:
        context.diagnostics.error("broken-file", error.message, error.source, error.hint)
        return
    body.name = robot.name
    if not body.is_robot:
        robot.manipulators = []
    if skip_geometry:
        for link in robot.links:
            link.geometries = []
    _join(body, robot)
    body.configurations += robot.configurations


def uniform(scale: Vec3, source: Source, context: Context) -> float:
    """Return the single scale factor that a COLLADA file can have; report others as ignored."""
    if len(set(scale)) > 1:
        message = f"scalegeometry scales a COLLADA file by {scale[0]:g} in all directions"
        context.diagnostics.warn("ignored-attribute", message, source)
    return scale[0]


def _join(body: BodyBuilder, other: BodyBuilder) -> None:
    """Merge ``other`` into ``body`` by link names.

    If ``body`` has a link with the name of the first link of ``other``, move ``other`` so that the two coincide.
    """
    places = [body.find_link(link.name) for link in other.links]
    T_body_other = Pose()
    if places[0] is not None:
        T_body_other = body.links[places[0]].pose @ other.links[0].pose.inverse()
    indices: list[int] = []
    for link, place in zip(other.links, places, strict=True):
        link.pose = T_body_other @ link.pose
        indices.append(len(body.links) if place is None else place)
        if place is None:
            body.links.append(link)
        else:
            link.geometries = [*body.links[place].geometries, *link.geometries]
            body.links[place] = link
    for joint in other.joints:
        joint.links = (indices[joint.links[0]], indices[joint.links[1]])
    body.joints += other.joints
    body.adjacent += [(indices[first], indices[two]) for first, two in other.adjacent]
    body.manipulators += other.manipulators
    for sensor, link_name in other.sensors:
        link = None if sensor.link is None else indices[sensor.link]
        body.sensors.append(SensorBuilder(replace(sensor, link=link), link_name))


def is_mesh(name: str) -> bool:
    """Return whether a file that serves as a body is a mesh file; COLLADA files count as robots."""
    lowered = name.lower()
    return lowered.endswith(MESH_SUFFIXES) and not lowered.endswith(collada.SUFFIXES)


def add_mesh(body: BodyBuilder, path: str, scale: Vec3, source: Source, context: Context) -> None:
    """Fill a body with the link that OpenRAVE makes of a mesh file; it has the name of the file.

    Args:
        body: The body.
        path: The file.
        scale: Factors along x, y and z.
        source: The position of its name.
        context: Receives diagnostics.
    """
    geometries = [
        Geometry(
            shape=TriMesh(part.mesh),
            T_link_geometry=Pose(),
            name="",
            diffuse=part.diffuse,
            ambient=part.ambient,
            transparency=part.transparency,
            visible=True,
            source=source,
        )
        for part in context.mesh(os.path.abspath(path), source, scale=scale)
    ]
    body.links.append(LinkBuilder("base", source, geometries=geometries, inertial=MASSLESS, static=True))
    body.name = Path(path).stem
