"""What every renderer checks before it draws."""

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.errors import ArgumentError


def checked_colour(colour: ArrayLike) -> tuple[float, float, float]:
    """Return a colour as three floats.

    Raises:
        ArgumentError: it is not three numbers from 0 to 1.
    """
    try:
        red, green, blue = (float(part) for part in np.asarray(colour, dtype=np.float64).reshape(-1)[:4])
    except (TypeError, ValueError):
        raise ArgumentError(f"a colour is three numbers from 0 to 1, not {colour!r}") from None
    if not all(0 <= part <= 1 for part in (red, green, blue)):
        raise ArgumentError(f"a colour is three numbers from 0 to 1, not {colour!r}")
    return (red, green, blue)


def color_bytes(color: ArrayLike) -> NDArray[np.uint8]:
    """Return a colour of three numbers 0..1 as the bytes of a pixel, (3,); errors as for ``checked_colour``."""
    return np.rint(255 * np.array(checked_colour(color))).astype(np.uint8)


def check_data(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Make sure that the state belongs to the model of the renderer; MuJoCo would read past its arrays.

    Raises:
        ArgumentError: it has other numbers of bodies or geoms.
    """
    expected = f"{model.nbody} bodies and {model.ngeom} geoms"
    found = f"{data.xpos.shape[0]} bodies and {data.geom_xpos.shape[0]} geoms"
    if found != expected:
        raise ArgumentError(f"these are the data of another model: {found}, expected {expected}")
