"""Transforms of COLLADA nodes; shared by mesh files and robots."""

import numpy as np

from ravemj.core.transforms import Floats, cross_rows
from ravemj.formats.meshes.collada.document import Element, local_name, numbers
from ravemj.formats.meshes.matrices import rotation, translation

LENGTHS = {"translate": 3, "rotate": 4, "scale": 3, "matrix": 16, "lookat": 9}
"""The number of values of each supported transform."""


def local_transform(element: Element) -> Floats | None:
    """Return the 4x4 matrix of a child of a node; None if it is not a supported transform.

    Angles are in degrees in the file, matrices are written row by row. A transform with too few numbers and ``<skew>``
    are ignored.
    """
    kind = local_name(element)
    values = numbers(element)
    if kind not in LENGTHS or len(values) < LENGTHS[kind]:
        return None
    match kind:
        case "translate":
            return translation(values[:3])
        case "rotate":
            return rotation(np.append(values[:3], np.deg2rad(values[3])))
        case "scale":
            return np.diag([*values[:3], 1.0])
        case "matrix":
            return values[:16].reshape(4, 4)
        case _:
            return _look_at(values[:9].reshape(3, 3))


def _look_at(rows: Floats) -> Floats:
    """Return the 4x4 camera pose of a ``<lookat>`` with rows eye, target and up: -z points to the target, y up."""
    eye, interest, up = rows
    back = _unit(eye - interest)
    right = _unit(cross_rows(up, back))
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, cross_rows(back, right), back, eye], axis=1)
    return matrix


def _unit(vector: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0 else vector
