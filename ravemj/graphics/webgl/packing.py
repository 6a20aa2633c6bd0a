"""Serialization for browsers: 16-bit quantization, differences of neighbours, compression."""

import base64
import json
import zlib
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.graphics.webgl.surfaces import Surfaces, TriangleMesh, round_mesh
from ravemj.model.drawing import PrimitiveBatch, Primitives

_STEPS = 65535
_WIDE = 65536
"""Number of vertices above which a mesh needs 32-bit indices."""


class Package:
    """A JSON document, followed by its arrays as bytes.

    Layout: length of the document (4 bytes, little endian), the document, the arrays. The document refers to an array
    by ``{"at", "count", "type"}``: offset of its first byte, length, and ``i8``, ``u16``, ``u32`` or ``f32``.
    """

    def __init__(self) -> None:
        self.document: dict[str, Any] = {}
        self._arrays: list[bytes] = []
        self._length = 0

    def array(self, numbers: NDArray[Any]) -> dict[str, Any]:
        """Add an array; return its reference for the document."""
        content = np.ascontiguousarray(numbers).tobytes()
        content += b"\0" * (-len(content) % 4)  # typed arrays of browsers begin at multiples of their elements' size
        kind = f"{numbers.dtype.kind}{8 * numbers.dtype.itemsize}"
        name = {"at": self._length, "count": int(numbers.size), "type": kind}
        self._arrays.append(content)
        self._length += len(content)
        return name

    def quantized(self, numbers: Floats) -> dict[str, Any]:
        """Add an array, shape (N, k), quantized to 16 bits between the minimum and maximum of each column.

        The error is at most 1/131070 of a column's range. Columns are stored one after the other, as differences of
        consecutive numbers.
        """
        low, high = numbers.min(axis=0), numbers.max(axis=0)
        step = np.where(high > low, (high - low) / _STEPS, 1.0)
        whole = np.rint((numbers - low) / step).astype(np.uint16)
        return {
            "low": low.tolist(),
            "step": step.tolist(),
            "columns": self.array(np.diff(whole.T, prepend=np.uint16(0))),
        }

    def content(self, level: int = 9) -> bytes:
        """Return the package, compressed with zlib at a level from 1 (fast) to 9 (small)."""
        document = json.dumps(self.document, separators=(",", ":")).encode()
        document += b" " * (-len(document) % 4)
        return zlib.compress(len(document).to_bytes(4, "little") + document + b"".join(self._arrays), level)

    def text(self) -> str:
        """Return the package, compressed and encoded as text."""
        return base64.b64encode(self.content()).decode()


def pack_scene(package: Package, model: mujoco.MjModel, shown: Surfaces) -> None:
    """Add a model's surfaces to the document, with the keys ``meshes``, ``shapes`` and ``bodies``.

    The key ``ball`` is a unit sphere, with which the page draws spheres.
    """
    package.document["meshes"] = [_packed_mesh(package, mesh) for mesh in shown.meshes]
    package.document["ball"] = _packed_mesh(package, round_mesh(0.0))
    package.document["shapes"] = [
        {
            "mesh": shape.mesh,
            "body": shape.body,
            "rows": [round(number, 9) for number in shape.T_body_shape.reshape(-1).tolist()],
            "rgba": [round(part, 4) for part in shape.rgba.tolist()],
            "reach": round(shape.reach, 4),
        }
        for shape in shown.shapes
    ]
    package.document["bodies"] = [model.body(number).name for number in range(model.nbody)]


def pack_drawings(package: Package, drawings: Primitives) -> None:
    """Add drawings to the document, with the key ``drawings``."""
    names = ("points", "spheres", "lines", "triangles")
    package.document["drawings"] = {
        name: _packed_batch(package, batch)
        for name, batch in zip(names, drawings.batches, strict=True)
        if batch.sizes.size
    }


def _packed_mesh(package: Package, mesh: TriangleMesh) -> dict[str, Any]:
    kind = np.uint32 if len(mesh.positions) >= _WIDE else np.uint16
    corners = np.diff(mesh.triangles.reshape(-1).astype(kind), prepend=kind(0))
    return {
        "positions": package.quantized(mesh.positions),
        "normals": package.array(octahedral(mesh.normals)),
        "corners": package.array(corners),
    }


def octahedral(normals: Floats) -> NDArray[np.int8]:
    """Return the octahedral encoding, shape (N, 2), of unit vectors, shape (N, 3), with an error below 1 degree.

    Source: Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 3(2), 2014.
    """
    folded = normals / np.maximum(np.abs(normals).sum(axis=1, keepdims=True), 1e-12)
    square = folded[:, :2].copy()
    lower = folded[:, 2] < 0
    square[lower] = (1 - np.abs(folded[lower, 1::-1])) * np.where(folded[lower, :2] < 0, -1.0, 1.0)
    return np.rint(127 * square).astype(np.int8)


def _packed_batch(package: Package, batch: PrimitiveBatch) -> dict[str, Any]:
    return {
        "corners": package.array(batch.corners.astype(np.float32)),
        "sizes": package.array(batch.sizes.astype(np.float32)),
        "rgba": package.array(np.clip(batch.rgba, 0, 1).astype(np.float32)),
    }
