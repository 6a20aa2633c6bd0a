"""Triangle meshes and axis-aligned bounding boxes."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats, Ints


class Bounds(NamedTuple):
    """Axis-aligned bounding box: minimum and maximum of x, y and z [m], each of shape (3,)."""

    low: Floats
    high: Floats


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangle mesh; meshes compare by value.

    Attributes:
        vertices: Vertices [m], shape (n, 3); read-only.
        triangles: Vertex indices of each triangle, counter-clockwise seen from outside, shape (m, 3); read-only.
        known_digest: A cached ``digest``, else empty, since hashing a large mesh is slow.
    """

    vertices: Floats
    triangles: Ints
    known_digest: str = field(default="", repr=False)

    def __post_init__(self) -> None:
        for name, kind in (("vertices", np.float64), ("triangles", np.int_)):
            given: NDArray[Any] = np.asarray(getattr(self, name))
            if not _is_settled(given, kind):
                numbers = given.reshape(-1, 3).astype(kind, order="C")
                numbers.flags.writeable = False
                object.__setattr__(self, name, numbers)

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the numbers, in hexadecimal digits."""
        if self.known_digest:
            return self.known_digest
        import hashlib  # noqa: PLC0415 - slow to import

        content = hashlib.sha256(self.vertices.tobytes())
        content.update(self.triangles.tobytes())
        return content.hexdigest()

    def moved(self, T_a_mesh: Floats) -> "Mesh":
        """Return the mesh transformed to frame a by a matrix of shape (4, 4)."""
        return Mesh(self.vertices @ T_a_mesh[:3, :3].T + T_a_mesh[:3, 3], self.triangles)

    def bounds(self, T_a_mesh: Floats) -> Bounds:
        """Return the bounding box of the vertices in frame a; if there are none, the origin of the mesh frame."""
        if not len(self.vertices):
            return Bounds(T_a_mesh[:3, 3], T_a_mesh[:3, 3])
        vertices = self.vertices @ T_a_mesh[:3, :3].T + T_a_mesh[:3, 3]
        return Bounds(vertices.min(axis=0), vertices.max(axis=0))

    @staticmethod
    def merged(meshes: "Iterable[Mesh]") -> "Mesh":
        """Concatenate meshes."""
        vertices, triangles = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int_)]
        count = 0
        for mesh in meshes:
            vertices.append(mesh.vertices)
            triangles.append(mesh.triangles + count)
            count += len(mesh.vertices)
        return Mesh(np.concatenate(vertices), np.concatenate(triangles))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mesh) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)


def _is_settled(numbers: NDArray[Any], kind: type) -> bool:
    """Return whether a mesh can use an array without a copy: correct type, own memory, read-only."""
    return (
        numbers.dtype == kind
        and numbers.shape[1:] == (3,)
        and numbers.flags.c_contiguous
        and numbers.flags.owndata
        and not numbers.flags.writeable
    )
