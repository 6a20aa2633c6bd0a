"""Triangles of one COLLADA ``<geometry>``; shared by mesh files and robots."""

import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.formats.meshes import triangulation
from ravemj.formats.meshes.cache import cached
from ravemj.formats.meshes.collada.document import (
    ColladaDocument,
    Element,
    attribute_number,
    child,
    children,
    local_name,
)
from ravemj.formats.meshes.collada.document import numbers as numbers_of
from ravemj.formats.meshes.number_lists import parse_list
from ravemj.formats.meshes.parts import MeshPart, check_finite, check_size, weld
from ravemj.model.scene import Mesh

_OF_ROBOTS = ("triangles", "trifans", "tristrips", "polylist")
_NO_PRIMITIVES = {"source", "vertices", "extra", "asset"}


def primitive_groups(
    document: ColladaDocument, geometry: Element, of_robots: bool = False
) -> list[tuple[Element, Floats]]:
    """Read a ``<geometry>``: its ``<mesh>`` or ``<convex_mesh>``, without units or transforms.

    Polygons with invalid indices, and elements that refer to missing elements, are skipped.

    Args:
        document: The file.
        geometry: The element.
        of_robots: Whether to read it like OpenRAVE's robots: without ``<polygons>``, and polygons become fans.
            Otherwise ear clipping is used.

    Returns:
        Each primitive element with the vertices of its triangles, shape (n, 3, 3), even if there are none: in document
        order, or for robots sorted by kind.

    Raises:
        SourceError: There are too many triangles.
    """
    mesh = _mesh(geometry)
    if mesh is None:
        return []
    points = _positions(document, mesh)
    groups: list[tuple[Element, Floats]] = []
    for element in _by_kind(mesh) if of_robots else children(mesh, *_OF_ROBOTS, "polygons"):
        sizes, index = _polygons(element, local_name(element))
        check_size(int(np.maximum(sizes - 2, 0).sum()), document.source(element))
        groups.append((element, triangulation.triangles(points, sizes, index, concave=not of_robots)))
    return groups


def triangle_meshes(document: ColladaDocument, geometry: Element, metres: float) -> list[tuple[Element, Mesh]]:
    """Return the triangles of a ``<geometry>`` as in OpenRAVE's robots, from the cache if possible.

    Args:
        document: The file.
        geometry: The element.
        metres: The length of its unit [m].

    Returns:
        Each primitive element with its triangles [m], even if there are none, except ``unread_primitives``.

    Raises:
        SourceError: There are too many triangles, or a coordinate is not finite.
    """

    def read() -> tuple[MeshPart, ...]:
        corners = [corners * metres for _, corners in primitive_groups(document, geometry, of_robots=True)]
        for item in corners:
            check_finite(item, document.source(geometry))
        return tuple(MeshPart(weld(item)) for item in corners)

    key = f"{document.digest} {document.place(geometry)} {metres!r}"
    parts = document.meshes.get(key)
    if parts is None:
        parts = document.meshes[key] = cached(key.encode(), "geometry", read)
    return [(element, part.mesh) for element, part in zip(_by_kind(_mesh(geometry)), parts, strict=True)]


def unread_primitives(geometry: Element) -> list[Element]:
    """Return the primitive elements of a ``<geometry>`` that OpenRAVE ignores in robots."""
    known = {*_OF_ROBOTS, *_NO_PRIMITIVES}
    return [element for element in children(_mesh(geometry)) if local_name(element) not in known]


def _by_kind(mesh: Element | None) -> list[Element]:
    """Return a mesh's primitive elements of the kinds that OpenRAVE reads for robots, sorted by kind."""
    return [element for kind in _OF_ROBOTS for element in children(mesh, kind)]


def _mesh(geometry: Element) -> Element | None:
    mesh = child(geometry, "mesh")
    return child(geometry, "convex_mesh") if mesh is None else mesh


def _positions(document: ColladaDocument, mesh: Element) -> Floats:
    """Return the vertex positions of a mesh, shape (N, 3), from its ``<vertices>`` regardless of their id."""
    inputs = children(child(mesh, "vertices"), "input")
    url = next((item.get("source", "") for item in inputs if item.get("semantic") == "POSITION"), "")
    wanted = url.strip().removeprefix("#")
    source = next((item for item in children(mesh, "source") if item.get("id") == wanted), None)
    return np.zeros((0, 3)) if source is None else _source_rows(document, source)


def _source_rows(document: ColladaDocument, source: Element) -> Floats:
    """Return the x, y and z columns of a ``<source>``, shape (N, 3); empty if its stride is less than 3."""
    accessor = child(source, "technique_common", "accessor")
    array = None if accessor is None else document.find("float_array", accessor.get("source"))
    own = child(source, "float_array")
    data = numbers_of(own if own is not None else array)
    stride = int(min(max(attribute_number(accessor, "stride", 3), 1), 1000))
    data = data[int(max(attribute_number(accessor, "offset", 0), 0)) :]
    columns = _columns(accessor, stride)
    rows = data[: len(data) // stride * stride].reshape(-1, stride)
    return rows[:, columns] if stride >= 3 else np.zeros((0, 3))


def _columns(accessor: Element | None, stride: int) -> list[int]:
    """Return the columns of x, y and z in a source: by ``<param>`` names if all three occur, else the first three."""
    names = [param.get("name", "") for param in children(accessor, "param")]
    if {"X", "Y", "Z"} <= set(names[:stride]):
        return [names.index(axis) for axis in "XYZ"]
    return [0, 1, 2]


def _polygons(element: Element, kind: str) -> tuple[Ints, Ints]:
    """Return the number of corners of each polygon, and the vertex index of each corner."""
    offsets = [
        (item.get("semantic"), int(max(attribute_number(item, "offset", 0), 0))) for item in children(element, "input")
    ]
    offset = next((number for semantic, number in offsets if semantic in ("VERTEX", "POSITION")), 0)
    width = min(max((number for _, number in offsets), default=0), 1000) + 1
    lists = [_indices(item, width, offset) for item in _index_lists(element)]
    index = np.concatenate([np.zeros(0, np.int_), *lists])
    lengths = np.array([len(item) for item in lists], np.int_)
    match kind:
        case "triangles":
            return np.full(len(index) // 3, 3), index
        case "polylist":
            counts = np.nan_to_num(numbers_of(child(element, "vcount"))).clip(0, len(index) + 1).astype(np.int_)
            return counts[np.cumsum(counts) <= len(index)], index
        case "tristrips":
            triangles = triangulation.strips(lengths, index)
            return np.full(len(triangles), 3), triangles.ravel()
        case _:
            return lengths, index


def _index_lists(element: Element) -> list[Element]:
    """Return the ``<p>`` elements of a primitive; of polygons with holes, the outlines."""
    lists = list(children(element, "p"))
    return lists + [item for holed in children(element, "ph") for item in children(holed, "p")]


def _indices(element: Element, width: int, offset: int) -> Ints:
    try:
        every = parse_list(element.text or "", int).astype(np.int_)
    except (ValueError, OverflowError):
        every = np.nan_to_num(numbers_of(element), nan=-1).clip(-1, 2**53).astype(np.int_)
    return every[: len(every) // width * width][offset::width]
