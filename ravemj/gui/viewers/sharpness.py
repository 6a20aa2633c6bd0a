"""How sharp pictures are: as sharp as leaves time for 30 in a second while things move, and crisp at rest."""

from typing import NamedTuple

BUDGET = 0.028
"""What drawing may take while things move [s]: 30 pictures in a second, and some time for the rest."""

REST = 0.1
"""After so long without a change [s] the picture is drawn once more, crisp."""

_PERIOD, _QUIET_PERIOD = 1 / 60, 1 / 30
"""How often it is seen whether something has changed [s]; less often once nothing has for a while."""

_QUIET = 1.0
"""How long that is [s]."""

_SPARE = 0.7
"""Part of the budget that a sharper picture has to leave free, so that sharpness does not go to and fro."""

_INERTIA = 0.6
"""Weight of earlier pictures when the next one's time is guessed."""


LEAST_SIDE, LARGEST_SIDE = 16, 4096
"""Bounds of the width and height of pictures [px]."""


def bounded_size(width: float, height: float) -> tuple[int, int]:
    """Return the size of a picture within the bounds, with the same aspect if there is such a size."""
    shrink = min(LARGEST_SIDE / max(width, height), 1.0)
    return max(int(shrink * width), LEAST_SIDE), max(int(shrink * height), LEAST_SIDE)


def period(unchanged: float) -> float:
    """Return when to look again for a change [s], after so long without one [s]."""
    return _QUIET_PERIOD if unchanged > _QUIET else _PERIOD


class Level(NamedTuple):
    """Columns and rows as a part of the view's, samples per pixel, and the time as a part of that of crisp pictures."""

    scale: float
    samples: int
    cost: float


LEVELS = (Level(1.0, 4, 1.0), Level(1.0, 0, 0.6), Level(0.75, 0, 0.36), Level(0.5, 0, 0.2), Level(0.35, 0, 0.13))
CRISP = LEVELS[0]


class Sharpness:
    """Chooses how the next picture is drawn, by what the last ones took."""

    def __init__(self) -> None:
        self._crisp: float | None = None  # what a crisp picture would take [s]
        self._level = CRISP
        self._changed: float | None = None
        self._is_crisp = False

    def moving(self, now: float) -> Level:
        """Return how to draw something that has changed [s, any clock]."""
        self._changed = now
        return self._level

    def is_due(self, now: float) -> bool:
        """Return whether to draw what has not changed once more, crisp."""
        return not self._is_crisp and self._changed is not None and now - self._changed >= REST

    def drew(self, level: Level, seconds: float) -> None:
        """Note what a picture took."""
        self._is_crisp = level == CRISP
        taken = seconds / level.cost
        self._crisp = taken if self._crisp is None else _INERTIA * self._crisp + (1 - _INERTIA) * taken
        fitting = [one for one in LEVELS if self._crisp * one.cost <= self._share(one)]
        self._level = fitting[0] if fitting else LEVELS[-1]

    def _share(self, level: Level) -> float:
        return BUDGET if level.scale <= self._level.scale and level.cost <= self._level.cost else _SPARE * BUDGET
