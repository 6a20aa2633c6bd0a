"""Drawing styles and looks of pictures: visible geoms as in MuJoCo's visualizer, lights, background."""

import math
from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering.checks import checked_colour
from ravemj.model.look import FLOORS, LIGHTS, WHITE, Rgb

DRAWN_GROUPS = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
"""Geom groups that a default ``mjvOption`` draws: 0, 1 and 2."""

COLLISION_GROUPS = np.array([1, 0, 0, 1, 0, 0], dtype=np.uint8)
"""Mask of the geom groups of collision geometry: 0 (drawn, too) and 3 (collision only); group 2 is visual only."""

_UNSET_RGBA = (0.5, 0.5, 0.5, 1.0)  # MuJoCo's default, which means that no colour is set
_TINT = np.array([0.3, 0.6, 1.0])
_TINT_PART = 0.4
"""Fraction of the highlight colour mixed into a highlighted body, visible on both white and black."""

_OPACITY = 0.35


def geom_rgba(model: mujoco.MjModel) -> Floats:
    """Return the colour and opacity of every geom, (ngeom, 4) in 0..1.

    A geom with a material and no colour of its own (MuJoCo's default grey) has the colour of the material.
    """
    rgba = np.array(model.geom_rgba, dtype=np.float64)
    from_material = (model.geom_matid >= 0) & (rgba == _UNSET_RGBA).all(axis=1)
    rgba[from_material] = model.mat_rgba[model.geom_matid[from_material]]
    return rgba


def drawn_geoms(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Return a mask of the visible geoms, shape (ngeom,): groups 0 to 2, and not fully transparent."""
    groups = np.clip(model.geom_group, 0, len(DRAWN_GROUPS) - 1)
    return (DRAWN_GROUPS[groups] > 0) & (geom_rgba(model)[:, 3] > 0)


@dataclass(frozen=True)
class Style:
    """Drawing style of geoms. The ray caster supports only the default; others need OpenGL."""

    collision: bool = False  # collision geometry in place of visual geometry
    hulls: bool = False  # meshes are drawn as their convex hulls
    transparent: bool = False  # bodies are half transparent
    wireframe: bool = False  # only edges are drawn
    lit: int = -1  # index of the body that is highlighted by a tint; -1: none

    @property
    def groups(self) -> NDArray[np.uint8]:
        """Mask of the drawn geom groups."""
        return COLLISION_GROUPS if self.collision else DRAWN_GROUPS

    def apply(self, option: mujoco.MjvOption) -> None:
        """Set the visualization options used to update a scene."""
        option.geomgroup[:] = self.groups
        option.flags[mujoco.mjtVisFlag.mjVIS_CONVEXHULL] = self.hulls

    def colours(self, model: mujoco.MjModel, rgba: Floats) -> Floats:
        """Return the drawn colours of geoms, shape (ngeom, 4), given their own colours."""
        changed = rgba.copy()
        if self.transparent:
            changed[:, 3] *= _OPACITY
        lit = model.geom_bodyid == self.lit
        changed[lit, :3] = (1 - _TINT_PART) * changed[lit, :3] + _TINT_PART * _TINT
        return changed

    def finish(self, model: mujoco.MjModel, scene: mujoco.MjvScene) -> None:
        """Apply wireframe, highlight and transparency to an updated scene."""
        scene.flags[mujoco.mjtRndFlag.mjRND_WIREFRAME] = self.wireframe
        if self.lit < 0 and not self.transparent:
            return
        for geom in scene.geoms[: scene.ngeom]:
            if geom.objtype != mujoco.mjtObj.mjOBJ_GEOM:
                continue
            if self.transparent:  # MuJoCo's own transparency flag skips static bodies
                geom.rgba[3] *= _OPACITY
                geom.transparent = 1
            if model.geom_bodyid[geom.objid] == self.lit:
                geom.rgba[:3] = (1 - _TINT_PART) * geom.rgba[:3] + _TINT_PART * _TINT


AS_IT_IS = Style()


LightNames = Literal["studio", "model", "both", "sensor"]


@dataclass(frozen=True)
class Look:
    """Background, floor and lights of a picture; ``ravemj.model.look`` contains the numbers.

    Attributes:
        background: Red, green, blue from 0 to 1; None: a vertical gradient.
        floor: Whether to draw a floor below the bodies. It is not a body of the model.
        lights: The lights: ``model`` means those of the model, ``sensor`` those of simulated cameras.
        lowest: Upper bound of the floor's height [m], for pictures of a motion.
    """

    background: Rgb | None = WHITE
    floor: bool = False
    lights: LightNames = "model"
    lowest: float = math.inf

    @classmethod
    def coerced(cls, look: "Look | ArrayLike") -> "Look":
        """Convert a colour to the look with this background and the model's lights; return a look unchanged.

        Raises:
            ArgumentError: it is neither a look nor a colour.
        """
        return look if isinstance(look, Look) else cls(checked_colour(look))

    @classmethod
    def of_sensor(cls, background: Rgb | None) -> "Look":
        """Return the look of simulated cameras; the background is white by default."""
        return cls(background or WHITE, lights="sensor")


@dataclass(frozen=True)
class LookChoices:
    """Users' choices for a look.

    Attributes:
        shadows: Whether lights cast shadows; None: the default of the picture.
        floor: One of ``FLOORS``.
        lights: One of ``LIGHTS``.

    Raises:
        ArgumentError: a choice is invalid.
    """

    shadows: bool | None = None
    floor: str = "auto"
    lights: LightNames = "both"

    def __post_init__(self) -> None:
        for name, value, choices in (("floor", self.floor, FLOORS), ("lights", self.lights, LIGHTS)):
            if value not in choices:
                raise ArgumentError(f"{name}: is {value!r}, and should be one of {', '.join(choices)}")

    def look(self, background: Rgb | None) -> Look:
        """Return the look with a background colour; None gives the default background."""
        return Look(background, background is None if self.floor == "auto" else self.floor == "on", self.lights)


AS_USUAL = LookChoices()
