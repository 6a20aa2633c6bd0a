"""Triangle mesh of the API."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError
from ravemj.model.scene import Mesh


class TriMesh:
    """Triangle mesh.

    Attributes:
        vertices: The vertices [m], shape (n, 3); None in a new mesh.
        indices: The indices of each triangle's three vertices, shape (m, 3); None in a new mesh.

    Example:
        >>> mesh = TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    """

    __slots__ = ("indices", "vertices")  # slots show on the class, as OpenRAVE's properties do

    vertices: Floats | None
    indices: Ints | None

    def __init__(self, vertices: ArrayLike | None = None, indices: ArrayLike | None = None) -> None:
        self.vertices = None if vertices is None else checked_numbers(vertices, "vertices")
        self.indices = None if indices is None else checked_numbers(indices, "indices").astype(np.int_)

    def toDict(self) -> dict[str, Floats | Ints | None]:
        """Return the mesh as ``vertices`` and ``indices``."""
        return {"vertices": self.vertices, "indices": self.indices}

    def __repr__(self) -> str:
        vertices, indices = ("None" if part is None else part.tolist() for part in (self.vertices, self.indices))
        return f"TriMesh({vertices},{indices})"

    def __str__(self) -> str:
        counts = (0 if part is None else len(part) for part in (self.vertices, self.indices))
        return "<trimesh: verts {}, tris={}>".format(*counts)


def trimesh_of(mesh: Mesh) -> TriMesh:
    """Return a copy of a scene mesh as a ``TriMesh``."""
    return TriMesh(mesh.vertices, mesh.triangles)


def checked_mesh(trimesh: object, name: str) -> Mesh:
    """Return the checked mesh of a ``TriMesh``. Arrays that are None count as empty.

    Raises:
        ArgumentError: the object is not a ``TriMesh``, an array has the wrong shape, or an index is out of range.
    """
    given = checked_kind(trimesh, TriMesh, name)
    vertices, indices = given.vertices, given.indices
    points = np.empty((0, 3)) if vertices is None else checked_numbers(vertices, f"{name}.vertices")
    corners = np.empty((0, 3)) if indices is None else checked_numbers(indices, f"{name}.indices")
    if points.shape[1:] != (3,) or corners.shape[1:] != (3,) or not np.isfinite(points).all():
        shapes = f"vertices of shape {points.shape} and indices of shape {corners.shape}"
        raise ArgumentError(f"{name}: has {shapes}, and should have finite ones of shape (n, 3) and (m, 3)")
    if corners.size and not (corners.min() >= 0 and corners.max() < len(points)):
        raise ArgumentError(f"{name}: its indices should be from 0 to {len(points) - 1}")
    return Mesh(points, corners.astype(np.int_))
