"""Styles and looks of pictures: visible geoms by the rules of MuJoCo's visualiser, lights, background."""

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


LightNames = Literal["studio", "model", "both", "sensor"]


@dataclass(frozen=True)
class Look:
    """Background, floor and lights of a picture; ``ravemj.model.look`` has the numbers.

    Attributes:
        background: Red, green, blue from 0 to 1; None: a vertical gradient.
        floor: Whether there is a floor below the bodies. It is no body: nothing but pictures shows it.
        lights: The lights. ``model`` leaves those of a model as they are, ``sensor`` are those of simulated cameras.
        lowest: Height [m] at which the floor is at most, for pictures of a motion.
    """

    background: Rgb | None = WHITE
    floor: bool = False
    lights: LightNames = "model"
    lowest: float = math.inf

    @classmethod
    def of(cls, look: "Look | ArrayLike") -> "Look":
        """Return a look as it is, and for a colour the one with this background and the model's own lights.

        Raises:
            ArgumentError: this is no colour.
        """
        return look if isinstance(look, Look) else cls(checked_colour(look))

    @classmethod
    def of_sensor(cls, background: Rgb | None) -> "Look":
        """Return the look of images of simulated cameras: white where nothing sets a background."""
        return cls(background or WHITE, lights="sensor")


@dataclass(frozen=True)
class LookChoices:
    """Choices of users about a look.

    Attributes:
        shadows: Whether lights cast shadows; None: as is usual for such pictures.
        floor: One of ``FLOORS``.
        lights: One of ``LIGHTS``.

    Raises:
        ArgumentError: a choice is none of these.
    """

    shadows: bool | None = None
    floor: str = "auto"
    lights: LightNames = "both"

    def __post_init__(self) -> None:
        for name, value, choices in (("floor", self.floor, FLOORS), ("lights", self.lights, LIGHTS)):
            if value not in choices:
                raise ArgumentError(f"{name}: is {value!r}, and should be one of {', '.join(choices)}")

    def look(self, background: Rgb | None) -> Look:
        """Return the look of pictures with a background; None where nothing sets one."""
        return Look(background, background is None if self.floor == "auto" else self.floor == "on", self.lights)


AS_USUAL = LookChoices()
