"""Which geoms of a model are drawn, and how: the rules of MuJoCo's visualiser, and the styles of viewers."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats

DRAWN_GROUPS = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
"""Geom groups that a default ``mjvOption`` draws: 0, 1 and 2."""

COLLISION_GROUPS = np.array([1, 0, 0, 1, 0, 0], dtype=np.uint8)
"""Geom groups of what collides: 2 is only seen, 3 only collides."""

_UNSET_RGBA = (0.5, 0.5, 0.5, 1.0)  # which MuJoCo takes for no colour
_TINT = np.array([0.3, 0.6, 1.0])
_TINT_PART = 0.4
"""A body that is pointed at has so much of this colour, which shows on white and on black."""

_OPACITY = 0.35


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


@dataclass(frozen=True)
class Style:
    """A way to draw geoms. Rays draw them as they are; OpenGL is needed for others."""

    collision: bool = False  # what collides is drawn, in place of what is seen
    hulls: bool = False  # meshes are drawn as their convex hulls
    transparent: bool = False  # bodies are half transparent
    wireframe: bool = False  # only edges are drawn
    lit: int = -1  # the body of the model that stands out from the others by a tint; -1: none

    @property
    def groups(self) -> NDArray[np.uint8]:
        """For each geom group, 1 if it is drawn."""
        return COLLISION_GROUPS if self.collision else DRAWN_GROUPS

    def apply(self, option: mujoco.MjvOption) -> None:
        """Set what is taken over into a scene."""
        option.geomgroup[:] = self.groups
        option.flags[mujoco.mjtVisFlag.mjVIS_CONVEXHULL] = self.hulls

    def colours(self, model: mujoco.MjModel, rgba: Floats) -> Floats:
        """Return the colours that geoms of these colours, (ngeom, 4), are drawn in."""
        changed = rgba.copy()
        if self.transparent:
            changed[:, 3] *= _OPACITY
        lit = model.geom_bodyid == self.lit
        changed[lit, :3] = (1 - _TINT_PART) * changed[lit, :3] + _TINT_PART * _TINT
        return changed

    def finish(self, model: mujoco.MjModel, scene: mujoco.MjvScene) -> None:
        """Change a scene that was filled: edges only, a body that is tinted, or all transparent."""
        scene.flags[mujoco.mjtRndFlag.mjRND_WIREFRAME] = self.wireframe
        if self.lit < 0 and not self.transparent:
            return
        for geom in scene.geoms[: scene.ngeom]:
            if geom.objtype != mujoco.mjtObj.mjOBJ_GEOM:
                continue
            if self.transparent:  # MuJoCo's own way leaves out what no joint moves
                geom.rgba[3] *= _OPACITY
                geom.transparent = 1
            if model.geom_bodyid[geom.objid] == self.lit:
                geom.rgba[:3] = (1 - _TINT_PART) * geom.rgba[:3] + _TINT_PART * _TINT


AS_IT_IS = Style()
