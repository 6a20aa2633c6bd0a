"""Parts of mesh files, each of one colour, and the limits for hostile files."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.errors import Source, SourceError
from ravemj.formats.limits import MOST_TRIANGLES, check_count
from ravemj.model.scene import Mesh, Rgb

READERS = {
    **dict.fromkeys((".iv", ".wrl", ".vrml"), ("inventor", "read_inventor")),
    ".stl": ("stl", "read_stl"),
    ".obj": ("obj", "read_obj"),
    ".dae": ("collada", "read_collada"),
    **dict.fromkeys((".ply", ".off", ".glb", ".gltf"), ("trimesh_formats", "read_with_trimesh")),
}
"""Module and function of the reader for each suffix."""

MESH_SUFFIXES = tuple(READERS)
"""Suffixes of readable files, in lower case."""

WHITE: Rgb = (1.0, 1.0, 1.0)
BLACK: Rgb = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class MeshPart:
    """Triangles of one colour.

    Attributes:
        mesh: The triangles, in the frame of the file [m].
        diffuse: Colour, each component from 0 to 1.
        ambient: Ambient colour, each component from 0 to 1.
        transparency: 0 is opaque, 1 invisible.
    """

    mesh: Mesh
    diffuse: Rgb = WHITE
    ambient: Rgb = BLACK
    transparency: float = 0.0


def weld(corners: ArrayLike) -> Mesh:
    """Return separate triangles as a mesh with shared vertices, in order of first appearance.

    Coordinates are first rounded to single precision, as in OpenRAVE's importers and MuJoCo, so that the same vertices
    are merged.

    Args:
        corners: Three points for each triangle, shape (n, 3, 3).
    """
    points = np.asarray(corners, np.float32).reshape(-1, 3) + np.float32(0)  # -0 becomes 0
    rows = np.ascontiguousarray(points).view(np.dtype((np.void, 12))).ravel()
    _, first, number = np.unique(rows, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return Mesh(points[first[order]].astype(np.float64), rank[number].reshape(-1, 3))


def welded(
    corners: Floats, source: Source, diffuse: Rgb = WHITE, ambient: Rgb = BLACK, transparency: float = 0.0
) -> tuple[MeshPart, ...]:
    """Return separate triangles, except degenerate ones, as one part; no part if there are none, as in OpenRAVE.

    Raises:
        SourceError: There are too many triangles, or a coordinate is not finite.
    """
    check_size(len(corners), source)
    check_finite(corners, source)
    corners = without_degenerate(corners)
    return (MeshPart(weld(corners), diffuse, ambient, transparency),) if len(corners) else ()


def corners_of(mesh: Mesh) -> Floats:
    """Return the three points of each triangle, shape (n, 3, 3)."""
    return mesh.vertices[mesh.triangles]


def without_degenerate(corners: Floats) -> Floats:
    """Remove triangles with two equal corners, as OpenRAVE's importer does for all formats except Inventor."""
    a, b, c = (np.asarray(corners[:, i], np.float32) for i in range(3))
    degenerate = (a == b).all(1) | (b == c).all(1) | (c == a).all(1)
    return corners[~degenerate]


def rgb(numbers: ArrayLike) -> Rgb:
    """Return a colour rounded to single precision, as in OpenRAVE's importers."""
    red, green, blue = (float(part) for part in np.nan_to_num(np.asarray(numbers, np.float32)[:3]))
    return red, green, blue


def check_size(triangles: int, source: Source) -> None:
    """Refuse a file with far more triangles than any model needs.

    Raises:
        SourceError: There are more than ``MOST_TRIANGLES``.
    """
    check_count(triangles, MOST_TRIANGLES, "triangles in the mesh", source)


def check_finite(corners: Floats, source: Source) -> None:
    """Refuse coordinates that are not finite in single precision.

    Raises:
        SourceError: A coordinate is not finite.
    """
    if not (np.abs(corners) <= np.finfo(np.float32).max).all():
        raise SourceError("the mesh has a coordinate that is not a finite number", source)
