"""How the geoms of a model are drawn, besides their colours."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.visibility import DRAWN_GROUPS

COLLISION_GROUPS = np.array([1, 0, 0, 1, 0, 0], dtype=np.uint8)
"""Geom groups of what collides: 2 is only seen, 3 only collides."""

_TINT = np.array([0.3, 0.6, 1.0])
_TINT_PART = 0.4
"""A body that is pointed at has so much of this colour, which shows on white and on black."""

_OPACITY = 0.35


@dataclass(frozen=True)
class Style:
    """A way to draw geoms. Rays draw them as they are; OpenGL is needed for others.

    Attributes:
        collision: Whether what collides is drawn, in place of what is seen.
        hulls: Whether meshes are drawn as their convex hulls.
        transparent: Whether bodies are half transparent.
        wireframe: Whether only edges are drawn.
        lit: The body of the model that stands out from the others by a tint; -1: none.
    """

    collision: bool = False
    hulls: bool = False
    transparent: bool = False
    wireframe: bool = False
    lit: int = -1

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
