"""Lights, and the shading of surfaces by the ray caster."""

import copy
from collections.abc import Iterator, Sequence

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.camera import Camera, aim
from ravemj.graphics.rendering.style import Look
from ravemj.model.look import LONE, SENSOR, SOFTNESS, STUDIO, STUDIO_PREFIX, Light

SHININESS = 64
"""Default exponent of highlights, as in MuJoCo."""

GLOSS = 0.5
"""Default specular reflectance, as in MuJoCo."""

_MOST = 8
"""Maximum number of lights in OpenGL."""

_PARTS = 4
"""Number of adjacent lights that replace a light with shadows, so that the shadows have soft edges."""


def place_lights(
    model: mujoco.MjModel,
    scene: mujoco.MjvScene,
    lights_of_model: Sequence[mujoco.MjvLight],
    look: Look,
    rotation: Floats,
    *,
    soft: bool,
) -> None:
    """Replace the lights of a scene by the lights of a look.

    Args:
        model: The model.
        scene: The scene, whose lights are replaced.
        lights_of_model: Copies of the lights that MuJoCo set up for the model.
        look: The look.
        rotation: ``R_world_camera``.
        soft: Whether lights with shadows are split into several adjacent ones.
    """
    own = [light for light in lights_of_model if _is_own(model, light)]
    lights: Sequence[Light] = ()
    if look.lights == "model":
        kept = own
        if len(own) == 1 and len(lights_of_model) > 1:  # only the headlight, which the studio lights replace
            lights, kept = (LONE,), []
    else:
        lights = SENSOR if look.lights == "sensor" else STUDIO
        kept = [light for light in own if not light.headlight] if look.lights == "both" else []
    spread = list(_spread(lights, rotation, _PARTS if soft and len(kept) + len(lights) + _PARTS <= _MOST + 1 else 1))
    scene.nlight = len(spread) + len(kept)
    for slot, light in zip(scene.lights[len(spread) : scene.nlight], kept, strict=True):
        for name in _FIELDS:
            setattr(slot, name, getattr(light, name))
        if light.headlight:
            slot.dir = rotation[:, 2]
    for slot, (light, direction, part) in zip(scene.lights, spread, strict=False):
        _fill(slot, light, direction, part)


def _is_own(model: mujoco.MjModel, light: mujoco.MjvLight) -> bool:
    return bool(light.headlight) or not model.light(light.id).name.startswith(STUDIO_PREFIX)


def _spread(lights: Sequence[Light], rotation: Floats, parts: int) -> Iterator[tuple[Light, Floats, float]]:
    """Yield (light, world direction, fraction of intensity), with ``parts`` directions for a light with shadows."""
    for light in lights:
        direction = light.direction_in_world(rotation)
        if not light.casts_shadows or parts == 1:
            yield light, direction, 1.0
            continue
        aside = np.cross(direction, (0.0, 0.0, 1.0))
        aside /= max(float(np.linalg.norm(aside)), 1e-9)
        around = np.cross(direction, aside)
        for angle in 2 * np.pi * (np.arange(parts) + 0.5) / parts:
            moved = direction + SOFTNESS * (np.cos(angle) * aside + np.sin(angle) * around)
            yield light, moved / np.linalg.norm(moved), 1 / parts


def _fill(slot: mujoco.MjvLight, light: Light, direction: Floats, part: float) -> None:
    slot.id, slot.texid = -1, -1
    slot.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    slot.dir, slot.pos = direction, np.zeros(3)
    slot.attenuation, slot.exponent, slot.cutoff = np.array([1.0, 0.0, 0.0]), 0.0, 180.0
    slot.ambient, slot.diffuse, slot.specular = (
        np.full(3, part * amount) for amount in (light.ambient, light.diffuse, light.specular)
    )
    slot.headlight, slot.castshadow = False, light.casts_shadows


_FIELDS = [name for name in dir(mujoco.MjvLight) if not name.startswith("_")]


class Lights:
    """The lights of a picture: either of the model, headlight included, or of a look."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._scene = mujoco.MjvScene(model, 1)
        self._shines = True

    def update(self, data: mujoco.MjData, camera: Camera, depths: tuple[float, float], look: Look) -> None:
        """Copy the poses of the lights, which may move with the camera; ``depths`` is its depth range [m]."""
        if self._model.nlight:
            mujoco.mj_camlight(self._model, data)
        aim(self._scene, camera, (1, 1), depths)
        mujoco.mjv_makeLights(self._model, data, self._scene)
        lights = [copy.copy(light) for light in self._scene.lights[: self._scene.nlight]]
        place_lights(self._model, self._scene, lights, look, camera.rotation, soft=False)
        self._shines = look.lights != "sensor"  # simulated cameras have no highlights

    def on(self, points: Floats, rays: Floats, normals: Floats) -> tuple[Floats, Floats]:
        """Return the diffuse light on surface points, shape (N, 3), and the highlights, shape (N, 3), as RGB.

        A diffuse light of 1 gives the surface's own colour; highlights have the colour of the light. Points are in the
        world, shape (N, 3) [m], with the viewing rays and the unit normals, shape (N, 3) each; normals that point away
        from the camera are flipped.
        """
        away = np.einsum("ij,ij->i", normals, rays) > 0
        facing = np.where(away[:, None], -normals, normals)
        back = -rays / np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), mujoco.mjMINVAL)
        total, shine = np.zeros(points.shape), np.zeros(points.shape)
        for light in self._scene.lights[: self._scene.nlight]:
            if light.type == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL:
                towards = np.broadcast_to(-np.asarray(light.dir, dtype=np.float64), points.shape)
            else:
                towards = np.asarray(light.pos, dtype=np.float64) - points
                towards = towards / np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), mujoco.mjMINVAL)
            cosine = np.einsum("ij,ij->i", facing, towards)
            total += light.ambient
            total += np.maximum(cosine, 0)[:, None] * np.asarray(light.diffuse, dtype=np.float64)
            if self._shines and np.any(light.specular):
                middle = towards + back
                middle /= np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), mujoco.mjMINVAL)
                glancing = np.maximum(np.einsum("ij,ij->i", facing, middle), 0) ** SHININESS
                lit = np.where(cosine > 0, glancing, 0)
                shine += GLOSS * lit[:, None] * np.asarray(light.specular, dtype=np.float64)
        return total, shine
