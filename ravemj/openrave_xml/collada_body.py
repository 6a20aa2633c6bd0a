"""A COLLADA file in place of a body: its first body joins the one that is open."""

from dataclasses import replace

from ravemj import collada
from ravemj.builder import BodyBuilder
from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.openrave_xml.context import COLLADA_SUFFIXES, Context


def is_collada(name: str) -> bool:
    """Return whether a file in place of a body is a COLLADA file."""
    return name.lower().endswith(COLLADA_SUFFIXES)


def add_collada(body: BodyBuilder, path: str, source: Source, context: Context, *, skip_geometry: bool) -> None:
    """Fill a body with the first one of a COLLADA file, as its values place it; a broken file is reported.

    Args:
        body: The body.
        path: The file.
        source: Where the file is named.
        context: Takes findings.
        skip_geometry: Whether the shapes are left out.
    """
    try:
        content = collada.read_file(path, context.diagnostics, context.files, source)
        found = next(iter((*content.bodies, *content.others)), None)
        if found is None:
            raise SourceError("there is no body in it", Source(path, included_from=source))
        placed = found.freeze(Diagnostics())
    except SourceError as error:
        context.diagnostics.error("broken-file", error.message, error.source)
        return
    body.name = found.name
    first = len(body.links)
    for link, at_values in zip(found.links, placed.links, strict=True):
        link.pose = at_values.T_world_link
        if skip_geometry:
            link.geometries = []
    for joint in found.joints:
        joint.links = (joint.links[0] + first, joint.links[1] + first)
    body.links += found.links
    body.joints += found.joints
    body.adjacent += [(one + first, other + first) for one, other in found.adjacent]
    body.manipulators += found.manipulators
    body.sensors += [
        replace(sensor, link=None if sensor.link is None else sensor.link + first) for sensor in found.sensors
    ]
