"""Messages to pages that render the scene themselves: only changes are sent.

Text messages are JSON objects with the changed fields; ``changed`` has the changed fields of controls, with their
names. Binary messages begin with their kind, a 32-bit number:

* ``FRAME``: the page draws all updates since the last frame. The message continues, little endian: the numbers of
  acknowledged messages, of the following bodies and of the following shapes, and whether a camera follows (32 bits
  each); the camera's position, quaternion wxyz, vertical field of view [rad] and distance to its focus [m], 0 if the
  page must not predict drags (9 floats); the bodies' positions (3 floats each), their quaternions (4 integers of 16
  bits each; 32767 is 1), their indices (32 bits each); the shapes' indices (32 bits each), their colours (4 bytes
  each).
* ``DRAWINGS``, ``FIGURES``: the drawings of scripts, and those of the overlay, in the format of ``pack_drawings``.
"""

import json
import struct
from dataclasses import asdict
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, wxyz_from_rows
from ravemj.engine.simulation import Simulation
from ravemj.engine.simulation.published import Published
from ravemj.graphics.rendering.style import Look, geom_rgba
from ravemj.graphics.webgl.look import packed_look
from ravemj.graphics.webgl.packing import Package, pack_drawings
from ravemj.gui.interaction import Overlay, Viewpoint
from ravemj.gui.interaction.control import Control
from ravemj.gui.viewers.web.scenes import PackedScene, Scenes
from ravemj.model.drawing import Primitives

FRAME, DRAWINGS, FIGURES = range(3)

_UNIT = 32767
_DIGITS = 6
"""Decimals of positions [m]; smaller movements are not sent."""

_VALUE_DIGITS = 4
"""Decimals of slider values [rad, m or s], finer than a pixel."""

_LEVEL = 1
"""Compression level of drawings: low, since they may change with every frame."""


class Stage(NamedTuple):
    """The visible state of a scene, except for camera and texts.

    Attributes:
        scene: The geometry.
        positions: Positions of the scene's bodies in the world, shape (B, 3) [m].
        rotations: Quaternions wxyz of the bodies, scaled by 32767, shape (B, 4).
        colours: Red, green, blue and opacity of the shapes, from 0 to 255, shape (S, 4).
        drawings: Drawings of scripts.
        figures: Drawings of the overlay.
        edges: Whether the style is wireframe.
        model: The compiled model, to which the body indices refer.
        published: Serial number of the last poses published by a script.
        look: Background, floor and lights, packed for pages.
    """

    scene: PackedScene
    positions: NDArray[np.float32]
    rotations: NDArray[np.int16]
    colours: NDArray[np.uint8]
    drawings: Primitives
    figures: Primitives
    edges: bool
    model: mujoco.MjModel
    published: int
    look: dict[str, Any]

    @classmethod
    def from_simulation(
        cls, simulation: Simulation, overlay: Overlay, scenes: Scenes, look: Look, *, shadows: bool | None = None
    ) -> "Stage":
        """Return the visible state of a simulation, which the caller has locked."""
        compiled = simulation.compiled()
        model, data, style = compiled.model, compiled.data, overlay.style
        scene = scenes.packed(model, simulation.version, style)
        colours = style.colours(model, geom_rgba(model))[scene.geoms]
        return cls(
            scene,
            *_packed_poses(scene, data.xpos, data.xquat),
            np.rint(255 * np.clip(colours, 0, 1)).astype(np.uint8),
            simulation.drawings.primitives(),
            overlay.primitives,
            style.wireframe,
            model,
            simulation.published.number,
            packed_look(scenes.level(model), data, look, shadows=shadows),
        )

    def with_published(self, published: Published) -> "Stage":
        """Return a copy with the body poses that a script has published while it holds the lock."""
        poses = None if published.number == self.published else published.poses(self.model)
        if poses is None:
            return self
        positions, rotations = _packed_poses(self.scene, *poses)
        return self._replace(positions=positions, rotations=rotations, published=published.number)


def _packed_poses(scene: PackedScene, positions: Floats, wxyz: Floats) -> tuple[NDArray[np.float32], NDArray[np.int16]]:
    rounded = np.round(positions[scene.bodies], _DIGITS).astype(np.float32)
    return rounded, np.rint(_UNIT * wxyz[scene.bodies]).astype(np.int16)


class Feed:
    """The state that a page has received."""

    def __init__(self) -> None:
        self._text: dict[str, Any] = {}
        self._stage: Stage | None = None
        self._camera = b""
        self._acknowledged: int = 0

    def messages(self, stage: Stage, view: Viewpoint, text: dict[str, object], acknowledged: int) -> list[str | bytes]:
        """Return the messages with all changes since the last ones; empty if nothing changed."""
        messages: list[str | bytes] = []
        text = {**text, "scene": stage.scene.name, "edges": stage.edges}
        said = _changed(self._text, text)
        if said:
            messages.append(json.dumps(said, default=asdict))
        before = self._stage
        if before is None or stage.drawings is not before.drawings:
            messages.append(_drawn(DRAWINGS, stage.drawings))
        if before is None or not _is_same(stage.figures, before.figures):
            messages.append(_drawn(FIGURES, stage.figures))
        news, camera = self._news(stage), _packed_camera(view)
        if messages or news is not None or camera != self._camera or acknowledged != self._acknowledged:
            messages.append(_frame(stage, news, camera if camera != self._camera else b"", acknowledged))
        self._text, self._stage = text, stage
        self._camera, self._acknowledged = camera, acknowledged
        return messages

    def _news(self, stage: Stage) -> tuple[NDArray[np.intp], NDArray[np.intp]] | None:
        """Return the indices of moved bodies and recoloured shapes; None if there are none."""
        before = self._stage
        if before is None or before.scene.name != stage.scene.name:
            return np.arange(len(stage.positions)), np.arange(len(stage.colours))
        moved = (stage.positions != before.positions).any(axis=1) | (stage.rotations != before.rotations).any(axis=1)
        news = np.flatnonzero(moved), np.flatnonzero((stage.colours != before.colours).any(axis=1))
        return news if any(part.size for part in news) else None


def _changed(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    """Return the changed fields; if only values of controls changed, the field ``changed`` lists those controls."""
    said = {name: value for name, value in after.items() if name not in before or before[name] != value}
    old, new = before.get("controls", ()), said.get("controls", ())
    if new and [control.name for control in old] == [control.name for control in new]:
        del said["controls"]
        said["changed"] = [_difference(layer, other) for layer, other in zip(new, old, strict=True) if layer != other]
    return said


def _difference(control: Control, before: Control) -> dict[str, object]:
    """Return the changed fields of a control, and its name."""
    old, new = asdict(before), asdict(control)
    new["value"] = round(control.value, _VALUE_DIGITS)
    return {name: value for name, value in new.items() if name == "name" or value != old[name]}


def _frame(
    stage: Stage, news: tuple[NDArray[np.intp], NDArray[np.intp]] | None, camera: bytes, acknowledged: int
) -> bytes:
    moved, painted = news or (np.empty(0, np.intp), np.empty(0, np.intp))
    return b"".join(
        (
            struct.pack("<5I", FRAME, acknowledged & 0xFFFFFFFF, moved.size, painted.size, camera != b""),
            camera,
            stage.positions[moved].tobytes(),
            stage.rotations[moved].tobytes(),
            stage.scene.bodies[moved].astype(np.uint32).tobytes(),
            painted.astype(np.uint32).tobytes(),
            stage.colours[painted].tobytes(),
        )
    )


def _packed_camera(view: Viewpoint) -> bytes:
    camera = view.camera
    rotation = wxyz_from_rows(camera.rotation.tolist())
    distance = 0.0 if view.is_upright else view.distance  # pages predict no drags of turntable views
    return struct.pack("<9f", *camera.position.tolist(), *rotation, camera.fovy, distance)


def _drawn(kind: int, primitives: Primitives) -> bytes:
    package = Package()
    pack_drawings(package, primitives)
    return struct.pack("<I", kind) + package.content(_LEVEL)


def _is_same(drawn: Primitives, other: Primitives) -> bool:
    return drawn is other or all(
        np.array_equal(array, others)
        for batch, other_batch in zip(drawn.batches, other.batches, strict=True)
        for array, others in zip(batch, other_batch, strict=True)
    )
