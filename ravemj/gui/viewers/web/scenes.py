"""The geometry that pages draw by themselves, packed once for all pages of a viewer."""

import hashlib
import threading
from typing import NamedTuple

import mujoco
import numpy as np

from ravemj.core.transforms import Ints
from ravemj.graphics.rendering import Style
from ravemj.graphics.rendering.backdrop import FloorLevel
from ravemj.graphics.webgl.packing import Package, pack_scene
from ravemj.graphics.webgl.surfaces import surfaces

PREFIX = "scene-"
"""Begins the names of scenes in addresses."""

_MOST = 8
"""So many scenes are kept: those of the last models and ways to draw them."""

_LEVEL = 6


class Scene(NamedTuple):
    """The surfaces of a model.

    Attributes:
        name: Made of the content, so that equal scenes have equal names.
        content: What ``pack_scene`` packs.
        bodies: The bodies that have surfaces, shape (B,).
        geoms: The geom of each shape, shape (S,).
    """

    name: str
    content: bytes
    bodies: Ints
    geoms: Ints


class Scenes:
    """Packs scenes, and hands them out."""

    def __init__(self) -> None:
        self._scenes: dict[object, Scene] = {}
        self._level: FloorLevel | None = None
        self._lock = threading.Lock()

    def of(self, model: mujoco.MjModel, version: int, style: Style) -> Scene:
        """Return the scene of a model in a style; each model has another version."""
        key = version, style.collision, style.hulls
        with self._lock:
            scene = self._scenes.pop(key, None) or _packed(model, style)
            self._scenes[key] = scene
            for oldest in list(self._scenes)[:-_MOST]:
                del self._scenes[oldest]
            return scene

    def level(self, model: mujoco.MjModel) -> FloorLevel:
        """Return what finds the floor of a model."""
        with self._lock:
            if self._level is None or self._level.model is not model:
                self._level = FloorLevel(model)
            return self._level

    def content(self, name: str) -> bytes | None:
        """Return the scene of a name; None where there is none."""
        with self._lock:
            return next((scene.content for scene in self._scenes.values() if scene.name == name), None)


def _packed(model: mujoco.MjModel, style: Style) -> Scene:
    groups = np.clip(model.geom_group, 0, len(style.groups) - 1)
    shown = surfaces(model, style.groups[groups] > 0, hulls=style.hulls)
    package = Package()
    pack_scene(package, model, shown)
    content = package.content(_LEVEL)
    name = PREFIX + hashlib.sha256(content).hexdigest()[:32]
    bodies = np.unique([shape.body for shape in shown.shapes]).astype(np.intp)
    return Scene(name, content, bodies, np.array([shape.geom for shape in shown.shapes], dtype=np.intp))
