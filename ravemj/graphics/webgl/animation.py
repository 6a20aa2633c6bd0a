"""A motion as one self-contained HTML file with camera and playback controls."""

import html
import math
import re
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ravemj.core.output import AnyPath, new_file
from ravemj.core.transforms import Floats
from ravemj.graphics.rendering import Camera, Look
from ravemj.graphics.rendering.backdrop import FloorLevel
from ravemj.graphics.rendering.camera import bounding_sphere
from ravemj.graphics.webgl.look import packed_look
from ravemj.graphics.webgl.packing import Package, pack_drawings, pack_scene
from ravemj.graphics.webgl.surfaces import surfaces
from ravemj.model.drawing import NOTHING, Primitives

_HEIGHT = 480
"""Height of an animation in a notebook [px]."""

_STILL = 1e-9
"""Movement below which a body counts as static [m, or component of a unit quaternion]."""


class Recording(NamedTuple):
    """A recorded motion."""

    fps: float
    positions: Floats  # positions of all bodies of the model in the world, shape (frames, bodies, 3) [m]
    rotations: Floats  # their quaternions wxyz, shape (frames, bodies, 4)
    values: Floats  # of the joints, shape (frames, joints) [rad or m]
    names: list[str]  # of the joints
    units: list[str]  # of their values: ``rad`` or ``m``


class Appearance(NamedTuple):
    """Initial view of the page.

    Attributes:
        camera: The camera.
        aspect: Minimum aspect ratio (width by height) for which the camera's field of view shows the scene. Narrower
            pages get a larger vertical field of view.
        look: Background, floor and lights.
        title: The title.
    """

    camera: Camera
    aspect: float
    look: Look
    title: str
    shadows: bool | None = None  # whether lights cast shadows; None: if rendering is fast enough
    notes: tuple[str, ...] = ()  # lines of text in the corner


class Animation(NamedTuple):
    """A page that plays a motion; a notebook displays it as the result of a cell.

    Attributes:
        html: The whole page.
    """

    html: str

    def save(self, path: AnyPath) -> Path:
        """Write the page to a file.

        Raises:
            OutputError: the file cannot be written; nothing is left behind.
        """
        with new_file(path) as temporary:
            temporary.write_text(self.html, encoding="utf-8")
        return Path(path)

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.html)}" title="motion" allow="fullscreen" '
            f'style="width: 100%; height: {_HEIGHT}px; border: 0"></iframe>'
        )

    def __repr__(self) -> str:
        return f"Animation(<page of {len(self.html) / 1e6:.2f} MB>)"


def animation_page(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    recording: Recording,
    appearance: Appearance,
    drawings: Primitives = NOTHING,
    mechanism: Mapping[str, Any] | None = None,
) -> str:
    """Return a self-contained page that plays a recording. Drawings of scripts do not move.

    Bodies without motion in the recording have their poses in the state ``data``, unless sliders move them;
    ``mechanism`` is the result of ``webgl.sliders.mechanism``.
    """
    package = Package()
    pack_scene(package, model, surfaces(model))
    pack_drawings(package, drawings)
    _pack_recording(package, recording)
    _pack_view(package, model, data, appearance)
    package.document["mechanism"] = mechanism
    parts = {
        "title": html.escape(appearance.title),
        "notes": "".join(f"<p>{html.escape(line)}</p>" for line in appearance.notes),
        "style": _file("animation.css"),
        "camera": _file("camera.js"),
        "look": _file("look.js"),
        "renderer": _file("renderer.js"),
        "sharpness": _file("sharpness.js"),
        "wheel": _file("wheel.js"),
        "mechanism": _file("mechanism.js"),
        "player": _file("animation.js"),
        "scene": package.text(),
    }
    return re.sub(r"{{(\w+)}}", lambda match: parts[match[1]], _file("animation.html"))


def _pack_recording(package: Package, recording: Recording) -> None:
    frames, bodies = recording.positions.shape[:2]
    poses = np.concatenate([recording.positions, _continuous(recording.rotations)], axis=2)
    moving = np.flatnonzero((np.ptp(poses, axis=0) > _STILL).any(axis=1))
    still = np.array([body for body in range(bodies) if body not in moving], dtype=np.intp)
    package.document["fps"], package.document["frames"] = recording.fps, frames
    package.document["still"] = {"bodies": still.tolist(), "poses": package.array(poses[0, still].astype(np.float32))}
    package.document["moving"] = {"bodies": moving.tolist()}
    package.document["joints"] = [
        {"name": name, "unit": unit} for name, unit in zip(recording.names, recording.units, strict=True)
    ]
    if moving.size:
        package.document["moving"] |= package.quantized(poses[:, moving].reshape(frames, -1))
    if recording.names:
        package.document["values"] = package.quantized(recording.values)


def _continuous(rotations: Floats) -> Floats:
    """Choose the signs of quaternions, shape (frames, bodies, 4), so that each is nearest to the previous one."""
    turns = np.sign(np.einsum("fbi,fbi->fb", rotations[1:], rotations[:-1]))
    signs = np.cumprod(np.where(turns < 0, -1.0, 1.0), axis=0)
    return np.concatenate([rotations[:1], rotations[1:] * signs[:, :, None]])


def _pack_view(package: Package, model: mujoco.MjModel, data: mujoco.MjData, appearance: Appearance) -> None:
    center, radius = bounding_sphere(model, data)
    camera = appearance.camera
    distance = float((center - camera.position) @ camera.rotation[:, 2])
    package.document["view"] = {
        "rotation": camera.rotation.reshape(-1).tolist(),
        "position": camera.position.tolist(),
        "fovy": camera.fovy if camera.calibration is None else math.radians(45),
        "distance": max(distance, 0.1 * radius),
        "aspect": appearance.aspect,
    }
    package.document["look"] = packed_look(FloorLevel(model), data, appearance.look, shadows=appearance.shadows)


def _file(name: str) -> str:
    return (resources.files("ravemj.graphics.webgl") / "page" / name).read_text(encoding="utf-8")
