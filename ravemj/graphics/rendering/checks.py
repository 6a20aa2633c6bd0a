"""Argument checks of the renderers."""

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from ravemj.errors import ArgumentError


def checked_colour(colour: ArrayLike) -> tuple[float, float, float]:
    """Check a colour and return it as three floats.

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


def check_data(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Check that a state belongs to the model of the renderer; otherwise MuJoCo would read past its arrays.

    Raises:
        ArgumentError: the numbers of bodies or geoms differ.
    """
    expected = f"{model.nbody} bodies and {model.ngeom} geoms"
    sizes = f"{data.xpos.shape[0]} bodies and {data.geom_xpos.shape[0]} geoms"
    if sizes != expected:
        raise ArgumentError(f"these are the data of another model: {sizes}, expected {expected}")
