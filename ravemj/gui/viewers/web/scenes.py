"""Geometry for pages that render it themselves, packed once for all pages of a viewer."""

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
"""Prefix of scene names in URLs."""

_MOST = 8
"""Maximum number of cached scenes; the oldest are removed."""

_LEVEL = 6


class PackedScene(NamedTuple):
    """The packed geometry of a model.

    Attributes:
        name: Hash of the content.
        content: Output of ``pack_scene``.
        bodies: Indices of the bodies with geometry, shape (B,).
        geoms: Index of the geom of each shape, shape (S,).
    """

    name: str
    content: bytes
    bodies: Ints
    geoms: Ints


class Scenes:
    """Cache of packed scenes."""

    def __init__(self) -> None:
        self._scenes: dict[object, PackedScene] = {}
        self._level: FloorLevel | None = None
        self._lock = threading.Lock()

    def packed(self, model: mujoco.MjModel, version: int, style: Style) -> PackedScene:
        """Return the packed scene of a model in a style; ``version`` identifies the model."""
        key = version, style.collision, style.hulls
        with self._lock:
            scene = self._scenes.pop(key, None) or _packed(model, style)
            self._scenes[key] = scene
            for oldest in list(self._scenes)[:-_MOST]:
                del self._scenes[oldest]
            return scene

    def level(self, model: mujoco.MjModel) -> FloorLevel:
        """Return the object that computes height and size of a model's floor."""
        with self._lock:
            if self._level is None or self._level.model is not model:
                self._level = FloorLevel(model)
            return self._level

    def content(self, name: str) -> bytes | None:
        """Return the content of a scene by its name; None if it does not exist."""
        with self._lock:
            return next((scene.content for scene in self._scenes.values() if scene.name == name), None)


def _packed(model: mujoco.MjModel, style: Style) -> PackedScene:
    groups = np.clip(model.geom_group, 0, len(style.groups) - 1)
    shown = surfaces(model, style.groups[groups] > 0, hulls=style.hulls)
    package = Package()
    pack_scene(package, model, shown)
    content = package.content(_LEVEL)
    name = PREFIX + hashlib.sha256(content).hexdigest()[:32]
    bodies = np.unique([shape.body for shape in shown.shapes]).astype(np.intp)
    return PackedScene(name, content, bodies, np.array([shape.geom for shape in shown.shapes], dtype=np.intp))
