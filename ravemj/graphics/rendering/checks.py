"""What every renderer checks before it draws."""

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.errors import ArgumentError

WHITE = (1.0, 1.0, 1.0)


def color_bytes(color: ArrayLike) -> NDArray[np.uint8]:
    """Return a colour of three numbers 0..1 as the bytes of a pixel, (3,).

    Raises:
        ArgumentError: not three numbers between 0 and 1.
    """
    try:
        numbers = np.asarray(color, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"background: expected three numbers between 0 and 1, found {color!r}") from None
    if numbers.shape != (3,) or not ((numbers >= 0) & (numbers <= 1)).all():
        raise ArgumentError(f"background: expected three numbers between 0 and 1, found {numbers.tolist()}")
    return np.rint(255 * numbers).astype(np.uint8)


def check_data(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Make sure that the state belongs to the model of the renderer; MuJoCo would read past its arrays.

    Raises:
        ArgumentError: it has other numbers of bodies or geoms.
    """
    expected = f"{model.nbody} bodies and {model.ngeom} geoms"
    found = f"{data.xpos.shape[0]} bodies and {data.geom_xpos.shape[0]} geoms"
    if found != expected:
        raise ArgumentError(f"these are the data of another model: {found}, expected {expected}")
