"""Adaptive resolution: full at rest, reduced while moving to keep 30 frames per second."""

from typing import NamedTuple

BUDGET = 0.028
"""Time budget of a frame while moving [s]: 30 frames per second, with some time left for other work."""

REST = 0.1
"""Time without changes after which a frame of full quality is drawn [s]."""

_PERIOD, _QUIET_PERIOD = 1 / 60, 1 / 30
"""Polling period for changes, and the longer one after ``_QUIET`` [s]."""

_QUIET = 1.0
"""Time without changes after which viewers poll less often [s]."""

_SPARE = 0.7
"""Fraction of the time budget in which a sharper level must be drawn before it is selected (hysteresis)."""

_INERTIA = 0.6
"""Weight of earlier measurements in the moving average of the drawing time."""


LEAST_SIDE, LARGEST_SIDE = 16, 4096
"""Bounds of the width and height of pictures [pixels]."""


def bounded_size(width: float, height: float) -> tuple[int, int]:
    """Clip a picture size to the bounds, keeping the aspect ratio if possible."""
    shrink = min(LARGEST_SIDE / max(width, height), 1.0)
    return max(int(shrink * width), LEAST_SIDE), max(int(shrink * height), LEAST_SIDE)


def period(unchanged: float) -> float:
    """Return the polling period [s], given the time without changes [s]."""
    return _QUIET_PERIOD if unchanged > _QUIET else _PERIOD


class Level(NamedTuple):
    """A quality level: resolution relative to the view's, samples per pixel, drawing time relative to full quality."""

    scale: float
    samples: int
    cost: float


LEVELS = (Level(1.0, 4, 1.0), Level(1.0, 0, 0.6), Level(0.75, 0, 0.36), Level(0.5, 0, 0.2), Level(0.35, 0, 0.13))
CRISP = LEVELS[0]


class Sharpness:
    """Selects the quality level of each frame from measured drawing times."""

    def __init__(self) -> None:
        self._crisp: float | None = None  # estimated drawing time at full quality [s]
        self._level = CRISP
        self._changed: float | None = None
        self._is_crisp = False

    def level_while_moving(self, now: float) -> Level:
        """Return the quality level for a changed scene; ``now`` is from any clock [s]."""
        self._changed = now
        return self._level

    def is_due(self, now: float) -> bool:
        """Return whether the unchanged scene must be redrawn in full quality."""
        return not self._is_crisp and self._changed is not None and now - self._changed >= REST

    def add_measurement(self, level: Level, seconds: float) -> None:
        """Update the estimate with the drawing time of a frame [s]."""
        self._is_crisp = level == CRISP
        taken = seconds / level.cost
        self._crisp = taken if self._crisp is None else _INERTIA * self._crisp + (1 - _INERTIA) * taken
        fitting = [candidate for candidate in LEVELS if self._crisp * candidate.cost <= self._share(candidate)]
        self._level = fitting[0] if fitting else LEVELS[-1]

    def _share(self, level: Level) -> float:
        return BUDGET if level.scale <= self._level.scale and level.cost <= self._level.cost else _SPARE * BUDGET
