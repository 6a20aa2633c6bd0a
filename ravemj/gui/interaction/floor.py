"""The grid on the floor, with metres, and the axes of the world."""

import math

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.gui.interaction.overlay import Label
from ravemj.model import drawing
from ravemj.model.drawing import Primitives

_REACH = 2.0
"""How far the grid goes, in radii of what stands on it."""

_STEPS = (0.1, 1.0, 10.0, 100.0, 1000.0)
"""Distances between lines [m]."""

_MOST_LINES = 24
"""Most lines from the middle of the grid to a side."""

_BELOW = 1e-3
"""How far below z = 0 the lines are, in radii, so that a floor of the model hides them and they do not flicker."""

_LINES, _MARKS = (0.62, 0.62, 0.65, 0.5), (0.45, 0.45, 0.5, 0.9)
_AXES = np.array([[0.85, 0.15, 0.15, 1.0], [0.1, 0.6, 0.15, 1.0], [0.15, 0.3, 0.9, 1.0]])
_AXIS_WIDTH = 3.0


def grid(center: Floats, radius: float) -> Primitives:
    """Return lines on the floor around a sphere (centre and radius [m]), and the axes of the world at its origin."""
    step, reach = _step_and_reach(center, radius)
    places = step * np.arange(-round(reach / step), round(reach / step) + 1)
    ends = np.array([[(place, -reach), (place, reach)] for place in places])
    lines = np.concatenate([ends, ends[:, :, ::-1]]).reshape(-1, 2)
    is_mark = np.isclose(np.remainder(np.abs(places) / step + 0.5, 10), 0.5)
    rgba = np.where(is_mark[:, None], _MARKS, _LINES)
    positions = np.column_stack([lines, np.full(len(lines), -_BELOW * radius)])
    floor = drawing.line_list(positions, 1.0, np.repeat(np.concatenate([rgba, rgba]), 2, axis=0))
    length = min(max(0.5 * radius, step), reach)
    cross = np.concatenate([[np.zeros(3), axis] for axis in length * np.eye(3)])
    return drawing.merge([floor, drawing.line_list(cross, _AXIS_WIDTH, np.repeat(_AXES, 2, axis=0))])


def marks(center: Floats, radius: float) -> tuple[Label, ...]:
    """Return the texts on the grid: metres along x and y, and the names of the axes at their ends."""
    step, reach = _step_and_reach(center, radius)
    apart = max(10 * step, math.ceil(0.25 * reach)) if reach >= 1 else 0.5
    labels = [
        Label(place * axis, f"{place:g} m")
        for axis in np.eye(3)[:2]
        for place in np.arange(apart, reach + 1e-9, apart).tolist()
    ]
    length = min(max(0.5 * radius, step), reach)
    return *labels, *(Label(length * axis, name) for axis, name in zip(np.eye(3), "xyz", strict=True))


def _step_and_reach(center: Floats, radius: float) -> tuple[float, float]:
    """Return the distance between lines, and how far they go to each side of the origin; whole steps [m]."""
    wanted = _REACH * radius + float(np.abs(center[:2]).max())
    step = next((step for step in _STEPS if wanted / step <= _MOST_LINES), _STEPS[-1])
    return step, step * min(max(math.ceil(wanted / step), 1), _MOST_LINES)
