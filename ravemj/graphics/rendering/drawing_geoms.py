"""Vectorized conversion of many thousands of drawings to ``mjvGeom`` structures of MuJoCo's classic renderer."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.camera import Camera
from ravemj.model.drawing import PrimitiveBatch, Primitives

_NO_VECTOR = np.zeros(3)
_NO_ROTATION = np.eye(3).reshape(-1)
_WHITE = np.ones(4, dtype=np.float32)

_Floats32 = NDArray[np.float32]


def add_drawing_geoms(
    scene: mujoco.MjvScene, primitives: Primitives, camera: Camera, width: int, height: int
) -> list[_Floats32]:
    """Append drawings in the world to an updated scene; those beyond its capacity are omitted.

    Returns:
        Writable arrays of the widths of points and lines [pixels], each of shape (N, 2).
    """
    widths: list[_Floats32] = []
    points, spheres, lines, triangles = primitives.batches
    for kind, batch in (
        (mujoco.mjtGeom.mjGEOM_SPHERE, spheres),
        (mujoco.mjtGeom.mjGEOM_TRIANGLE, triangles),
        (mujoco.mjtGeom.mjGEOM_LINE, lines),
        (mujoco.mjtGeom.mjGEOM_LINE, _squares(points, camera, width, height)),
    ):
        slots = _append(scene, kind, min(len(batch.sizes), scene.maxgeom - scene.ngeom))
        if slots:
            _write(slots, kind, PrimitiveBatch(*(array[: len(slots)] for array in batch)), camera.position)
            if kind == mujoco.mjtGeom.mjGEOM_LINE:
                widths.append(_column(slots, "size")[:, :2])
    return widths


def _squares(points: PrimitiveBatch, camera: Camera, width: int, height: int) -> PrimitiveBatch:
    """Return points as horizontal screen lines as long as they are wide, so that they appear as squares."""
    centers, sizes = points.corners[:, 0], np.maximum(points.sizes, 1)
    depth = (centers - camera.position) @ camera.rotation[:, 2]
    half = (0.5 * sizes * depth / camera.pinhole(width, height).fx)[:, None] * camera.rotation[:, 0]
    return PrimitiveBatch(np.stack([centers - half, centers + half], axis=1), sizes, points.rgba)


def _append(scene: mujoco.MjvScene, kind: mujoco.mjtGeom, count: int) -> tuple[mujoco.MjvGeom, ...]:
    """Allocate ``count`` decorative geoms in a scene, without shadows; return fewer if the scene is full."""
    first = scene.ngeom
    slots = scene.geoms[first : first + count]
    for number, slot in enumerate(slots, first):
        mujoco.mjv_initGeom(slot, kind, _NO_VECTOR, _NO_VECTOR, _NO_ROTATION, _WHITE)
        slot.category = mujoco.mjtCatBit.mjCAT_DECOR
        slot.specular = 0.0
        slot.segid = number
    scene.ngeom = first + len(slots)
    return slots


def _write(slots: tuple[mujoco.MjvGeom, ...], kind: mujoco.mjtGeom, batch: PrimitiveBatch, eye: Floats) -> None:
    size, position, frame, rgba = (_column(slots, name) for name in ("size", "pos", "mat", "rgba"))
    rgba[:] = np.clip(batch.rgba, 0, 1)
    rgba[:, 3] = 1 - np.sqrt(1 - rgba[:, 3])  # MuJoCo draws transparent geoms twice, back faces and front faces
    position[:] = batch.corners[:, 0]
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        size[:] = batch.sizes[:, None]
    elif kind == mujoco.mjtGeom.mjGEOM_LINE:
        length, frame[:, :, 2] = _length_and_direction(batch.corners[:, 1] - batch.corners[:, 0])
        size[:, :2] = np.maximum(batch.sizes, 1)[:, None]
        size[:, 2] = length
    else:
        size[:, 0], size[:, 1], frame[:] = _frames_of_triangles(batch.corners, eye)


def _column(slots: tuple[mujoco.MjvGeom, ...], name: str) -> _Floats32:
    """Return a writable view of one field of consecutive geoms, which MuJoCo allocates in one block."""
    first: _Floats32 = getattr(slots[0], name)
    second: _Floats32 = getattr(slots[min(1, len(slots) - 1)], name)
    stride = second.ctypes.data - first.ctypes.data
    return np.lib.stride_tricks.as_strided(first, (len(slots), *first.shape), (stride, *first.strides))


def _frames_of_triangles(corners: Floats, eye: Floats) -> tuple[Floats, Floats, Floats]:
    """Return lengths of two sides of each triangle, (N,) each, and (N, 3, 3) matrices: side directions and normal.

    The columns are the two directions and the normal, which points towards the eye, since only the front is lit.
    """
    edge, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    away = np.einsum("ij,ij->i", np.cross(edge, other), corners[:, 0] - eye) > 0
    edge, other = np.where(away[:, None], other, edge), np.where(away[:, None], edge, other)
    length, x = _length_and_direction(edge)
    other_length, y = _length_and_direction(other)
    _, z = _length_and_direction(np.cross(x, y))
    return length, other_length, np.stack([x, y, z], axis=2)


def _length_and_direction(vectors: Floats) -> tuple[Floats, Floats]:
    """Return the lengths, shape (N,), and the unit vectors of vectors, shape (N, 3); zero vectors stay zero."""
    lengths = np.linalg.norm(vectors, axis=1)
    return lengths, vectors / np.where(lengths > 0, lengths, 1)[:, None]
