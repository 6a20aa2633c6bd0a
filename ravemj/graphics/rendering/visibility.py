"""Which geoms are drawn, and in which colour: the rules of MuJoCo's visualiser, for whole models at once."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats

DRAWN_GROUPS = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
"""Geom groups that a default ``mjvOption`` draws: 0, 1 and 2."""

_UNSET_RGBA = (0.5, 0.5, 0.5, 1.0)


def geom_rgba(model: mujoco.MjModel) -> Floats:
    """Return the colour and opacity of every geom, (ngeom, 4) in 0..1.

    A geom with a material and no colour of its own (which MuJoCo recognises by its default grey) has the
    material's.
    """
    rgba = np.array(model.geom_rgba, dtype=np.float64)
    from_material = (model.geom_matid >= 0) & (rgba == _UNSET_RGBA).all(axis=1)
    rgba[from_material] = model.mat_rgba[model.geom_matid[from_material]]
    return rgba


def drawn_geoms(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Return which geoms appear in pictures, (ngeom,): those of groups 0 to 2 that are not wholly transparent."""
    groups = np.clip(model.geom_group, 0, len(DRAWN_GROUPS) - 1)
    return (DRAWN_GROUPS[groups] > 0) & (geom_rgba(model)[:, 3] > 0)
