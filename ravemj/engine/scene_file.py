"""``scene.xml``: a translated model with a floor and a camera."""

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.geom_extents import lowest
from ravemj.engine.translation import Translation
from ravemj.formats.mjcf.lines import XmlLines
from ravemj.model.look import FLOOR, first_rotation

NAME = "scene.xml"

_HALF_VIEW = np.radians(45.0 / 2)
"""Half the field of view of MuJoCo's default camera [rad]."""

_ROOM = 1.1
"""Camera distance, as a multiple of the distance at which the scene just fits."""


def scene_text(translation: Translation, file: str) -> str:
    """Return a scene document that includes the translated model ``file``.

    The floor is at the lowest point of the start pose. If this point belongs to a static body that is not a robot, no
    floor is added, since that body is the floor.
    """
    model, data = translation.model, translation.home
    height, body = lowest(model, data)
    out = XmlLines()
    out.open("mujoco", model=f"{file.removesuffix('.xml')} scene")
    out.element("include", file=file)
    if not _is_static(translation, body):
        out.open("asset")
        look = {"texuniform": True, "texrepeat": (2.0, 2.0), "rgba": (*FLOOR, 1.0)}
        out.element("material", name="ground", texture="floor", **look)
        out.close("asset")
    out.open("worldbody")
    if not _is_static(translation, body):
        place = (0.0, 0.0, round(height, 9) + 0.0)
        out.element("geom", name="ground", type="plane", pos=place, size=(0.0, 0.0, 0.05), material="ground")
    out.element(
        "light", name="top", type="directional", dir=(0.0, 0.0, -1.0), castshadow=False, diffuse=(0.1, 0.1, 0.1)
    )
    center, radius = _sphere(model, data)
    rotation = first_rotation()
    position = center - rotation[:, 2] * radius * _ROOM / np.sin(_HALF_VIEW)
    axes = (*rotation[:, 0].tolist(), *(-rotation[:, 1]).tolist())
    out.element("camera", name="overview", pos=_rounded(position), xyaxes=tuple(round(part, 6) for part in axes))
    out.close("worldbody")
    out.close("mujoco")
    return "\n".join(out.text) + "\n"


def _is_static(translation: Translation, body: int) -> bool:
    """Return whether a body is a static part of the environment, not of a robot."""
    name = translation.model.body(body).name
    for described, names in zip(translation.bodies, translation.mjcf.names, strict=True):
        if name in names.links:
            return described.links[names.links.index(name)].static and not described.is_robot
    return body == 0 and translation.model.ngeom > 0


def _sphere(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[Floats, float]:
    """Return centre and radius of a bounding sphere of all finite geoms."""
    some = model.geom_rbound > 0
    if not some.any():
        return np.zeros(3), 1.0
    centers, radii = data.geom_xpos[some], model.geom_rbound[some, None]
    center = ((centers - radii).min(axis=0) + (centers + radii).max(axis=0)) / 2
    return center, float((np.linalg.norm(centers - center, axis=1) + radii[:, 0]).max())


def _rounded(vector: Floats) -> tuple[float, ...]:
    return tuple(vector.round(6).tolist())
