"""Appearance of pictures: lights, background and floor.

All renderers and the MJCF use these values, so that their pictures look alike. Light intensities are relative to a
surface's colour: if the lights on a surface add up to 1, it is drawn in its own colour.
"""

from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats

Rgb = tuple[float, float, float]


class Light(NamedTuple):
    """Directional light.

    Attributes:
        direction: Direction in which the light travels, in its frame; need not be of unit length.
        diffuse: Intensity on a surface that faces the light.
        ambient: Intensity on every surface.
        specular: Intensity of highlights.
        in_camera: Whether the frame is the camera's (x right, y down, z forward); else it is the world frame.
        casts_shadows: Whether bodies cast shadows in this light.
    """

    direction: tuple[float, float, float]
    diffuse: float
    ambient: float = 0.0
    specular: float = 0.0
    in_camera: bool = False
    casts_shadows: bool = False

    def direction_in_world(self, R_world_camera: Floats) -> Floats:
        """Return the unit direction of the light in the world, for a camera's rotation.

        A light that casts shadows always comes from above, so that shadows fall onto the floor.
        """
        direction = np.array(self.direction, dtype=np.float64)
        direction /= np.linalg.norm(direction)
        if not self.in_camera:
            return direction
        direction = R_world_camera @ direction
        if self.casts_shadows and direction[2] > -STEEPNESS:
            level = float(np.hypot(*direction[:2]))
            direction[:2] *= np.sqrt(1 - STEEPNESS**2) / max(level, 1e-9)
            direction[2] = -STEEPNESS if level > 1e-9 else -1.0
        return direction


LIGHTS = ("studio", "model", "both")
"""Choices of lights: studio lights, those of a model, or both."""

FLOORS = ("auto", "on", "off")
"""Choices of the floor; ``auto`` draws it if no background is set."""

AZIMUTH, ELEVATION = 40.0, 25.0
"""Default view direction: from the front left and above [degrees]."""

STEEPNESS = 0.6
"""Minimum sine of the elevation of a light that casts shadows."""

KEY = Light((0.45, 0.22, 1.0), diffuse=0.33, specular=0.1, in_camera=True, casts_shadows=True)
"""Key light, over the camera's left shoulder."""

FILL = Light((0.0, 0.0, 1.0), diffuse=0.08, ambient=0.58, in_camera=True)
"""Fill light from the camera; MuJoCo's headlight."""

SKY = Light((0.0, 0.0, -1.0), diffuse=0.04)
"""Weak light from above."""

STUDIO = (FILL, KEY, SKY)
"""Default lights of pictures: a surface that faces the camera's left shoulder is drawn in its own colour."""

STUDIO_PREFIX = "studio_"
"""Name prefix of the studio lights in MJCF files; other lights belong to a model."""

SOFTNESS = 0.008
"""Angular radius of the key light [rad], which softens the edges of its shadows."""

SENSOR = (
    Light((0.0, 0.0, 1.0), diffuse=0.26, ambient=0.34, specular=0.05, in_camera=True),
    Light((-0.4, 0.4, -1.0), diffuse=0.4),
)
"""Lights in images of simulated cameras, independent of the appearance of pictures."""

LONE = Light((0.0, 0.0, 1.0), diffuse=0.6, ambient=0.4, specular=0.2, in_camera=True)
"""Headlight for a model without lights that is drawn without studio lights."""

WHITE: Rgb = (1.0, 1.0, 1.0)

ZENITH: Rgb = (0.66, 0.75, 0.86)
HORIZON: Rgb = (0.91, 0.93, 0.95)
NADIR: Rgb = (0.74, 0.77, 0.80)
"""Default background colours: ``ZENITH`` is straight up, ``HORIZON`` at the horizon, and ``NADIR`` straight down."""

FLOOR: Rgb = (0.79, 0.81, 0.83)
"""Floor colour near the bodies; it fades to the horizon's colour with distance."""

LINES = 0.88
"""Brightness of the grid lines relative to the floor."""

LINE_WIDTH = 1 / 64
"""Width of the grid lines relative to their distance."""

FADE_START, FADE_END = 1.0, 10.0
"""Distances beyond the bodies at which the floor starts to fade and has faded [radii of the scene]."""

FLOOR_REACH = 3.0
"""Far end of the floor, as a multiple of the depth at which the floor has faded."""

CELLS = 2.0
"""Minimum number of grid cells along the radius of the scene."""


def cell_size(radius: float) -> float:
    """Return the distance of grid lines for a scene radius [m]: 1, 2 or 5 times a power of ten."""
    largest = max(radius, 1e-6) / CELLS
    power = 10.0 ** np.floor(np.log10(largest))
    return float(power * max(step for step in (1, 2, 5) if step * power <= largest * (1 + 1e-9)))


def first_rotation() -> Floats:
    """Return the default ``R_world_camera`` of pictures, shape (3, 3)."""
    azimuth, elevation = np.radians((AZIMUTH, ELEVATION))
    level = -np.cos(elevation)
    return rotation_along((level * np.cos(azimuth), level * np.sin(azimuth), -np.sin(elevation)), (0.0, 0.0, 1.0))


def rotation_along(forward: tuple[float, float, float], up: tuple[float, float, float]) -> Floats:
    """Return ``R_world_camera`` (x right, y down, z forward) of a camera that looks along a unit vector, shape (3, 3).

    Args:
        forward: The viewing direction in the world.
        up: Up direction in the world; its component perpendicular to the viewing direction is up in the picture.
    """
    z = np.array(forward)
    x = np.cross(z, up)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)
