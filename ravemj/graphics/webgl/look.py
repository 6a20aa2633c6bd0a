"""Background, floor and lights for pages, as ``renderer.js`` draws them."""

from typing import Any

import mujoco

from ravemj.graphics.rendering.backdrop import Floor, FloorLevel
from ravemj.graphics.rendering.style import Look
from ravemj.model import look as numbers
from ravemj.model.look import SENSOR, STUDIO, STUDIO_PREFIX, Light

_DIGITS = 6


def packed_look(level: FloorLevel, data: mujoco.MjData, look: Look, *, shadows: bool | None = None) -> dict[str, Any]:
    """Return a look for a page; if ``shadows`` is None, the page decides by its rendering time."""
    sky = [look.background] * 3 if look.background else [numbers.ZENITH, numbers.HORIZON, numbers.NADIR]
    return {
        "sky": [list(colour) for colour in sky],
        "floor": _packed_floor(level.floor(data, look)),
        "lights": _packed_lights(level.model, look),
        "steepness": numbers.STEEPNESS,
        "softness": numbers.SOFTNESS,
        "shadows": shadows,
    }


def _packed_floor(floor: Floor | None) -> dict[str, Any] | None:
    if floor is None:
        return None
    return {
        "height": round(floor.height, _DIGITS),
        "cell": floor.cell,
        "center": floor.center.round(_DIGITS).tolist(),
        "radius": round(floor.radius, _DIGITS),
        "colour": floor.colour.tolist(),
        "lines": numbers.LINES,
        "width": numbers.LINE_WIDTH,
        "fade": [numbers.FADE_START, numbers.FADE_END, numbers.FLOOR_REACH],
    }


def _packed_lights(model: mujoco.MjModel, look: Look) -> list[dict[str, Any]]:
    """Return a look's lights as JSON data of directional lights; those of the model are in their initial pose."""
    own = [light for light in map(model.light, range(model.nlight)) if not light.name.startswith(STUDIO_PREFIX)]
    of_model = [
        {name: getattr(light, name).tolist() for name in ("ambient", "diffuse", "specular")}
        | {"direction": light.dir.tolist(), "inCamera": False, "casts": bool(light.castshadow[0])}
        for light in own
    ]
    if look.lights != "model":
        standing = SENSOR if look.lights == "sensor" else STUDIO
        return [_packed(light) for light in standing] + (of_model if look.lights == "both" else [])
    if model.nlight and not own:
        return [_packed(numbers.LONE)]
    head = model.vis.headlight
    amounts = {name: getattr(head, name).tolist() for name in ("ambient", "diffuse", "specular")}
    return [amounts | {"direction": [0, 0, 1], "inCamera": True, "casts": False}, *of_model]


def _packed(light: Light) -> dict[str, Any]:
    amounts = {name: [getattr(light, name)] * 3 for name in ("ambient", "diffuse", "specular")}
    return amounts | {"direction": list(light.direction), "inCamera": light.in_camera, "casts": light.casts_shadows}
