"""Visual elements of a document besides its bodies: lights, background, floor, classes of geoms."""

import math

import numpy as np

from ravemj.core.transforms import Floats, rows_from_wxyz
from ravemj.formats.mjcf.lines import Attribute, XmlLines
from ravemj.model.look import (
    FILL,
    HORIZON,
    KEY,
    LINES,
    SKY,
    STUDIO_PREFIX,
    ZENITH,
    Light,
    first_rotation,
)
from ravemj.model.scene import View

_SKY_SIZE, _GRID_SIZE = 32, 128
"""Number of texels along a side of a sky face, and of a cell of the floor's grid."""


def write_look(out: XmlLines, view: View, meshes: XmlLines) -> None:
    """Write lights, the classes of geoms, the background and the meshes."""
    level = HORIZON if view.background is None else view.background
    out.open("visual")
    x, y, z = _first_rotation(view)[:, 2].tolist()  # initial direction of MuJoCo's own viewers
    azimuth, elevation = math.degrees(math.atan2(y, x)), math.degrees(math.atan2(z, math.hypot(x, y)))
    out.element("global", azimuth=round(azimuth, 6) % 360.0, elevation=round(elevation, 6))
    out.element("headlight", active=1, **_light_attributes(FILL))
    out.element("rgba", fog=(*level, 1.0), haze=(*level, 1.0))
    out.close("visual")
    out.open("default")
    out.open("default", **{"class": "visual"})
    out.element("geom", contype=0, conaffinity=0, group=2)
    out.close("default")
    out.open("default", **{"class": "collision"})
    out.element("geom", group=3)
    out.close("default")
    out.close("default")
    out.open("asset")
    top, bottom = (ZENITH, level) if view.background is None else (level, level)
    size: dict[str, Attribute] = {"width": _SKY_SIZE, "height": 6 * _SKY_SIZE}
    out.element("texture", name="background", type="skybox", builtin="gradient", rgb1=top, rgb2=bottom, **size)
    grid: dict[str, Attribute] = {"width": _GRID_SIZE, "height": _GRID_SIZE}
    lines: dict[str, Attribute] = {"mark": "edge", "markrgb": (LINES, LINES, LINES), "rgb1": (1.0, 1.0, 1.0)}
    out.element("texture", name="floor", type="2d", builtin="flat", **lines, **grid)
    out.element("material", name="floor", texture="floor")
    out.text += meshes.text
    out.sources += meshes.sources
    out.close("asset")


def _light_attributes(light: Light) -> dict[str, Attribute]:
    parts = {"ambient": light.ambient, "diffuse": light.diffuse, "specular": light.specular}
    return {name: (part, part, part) for name, part in parts.items()}


def _first_rotation(view: View) -> Floats:
    """Return ``R_world_camera`` of a view; if it has no camera, the default of pictures."""
    camera = view.T_world_camera
    return first_rotation() if camera is None else np.array(rows_from_wxyz(camera.wxyz))


def write_lights(out: XmlLines, view: View) -> None:
    """Write the lights of pictures, placed for the first camera."""
    R_world_camera = _first_rotation(view)
    for name, light in (("key", KEY), ("sky", SKY)):
        direction = tuple(light.direction_in_world(R_world_camera).round(6).tolist())
        attributes: dict[str, Attribute] = {"castshadow": light.casts_shadows, **_light_attributes(light)}
        out.element("light", name=f"{STUDIO_PREFIX}{name}", type="directional", dir=direction, **attributes)
