"""Frame rate and image quality of a page, adapted to its connection."""

import time
from collections import deque
from collections.abc import Callable

_UNDER_WAY = 2
"""Maximum number of unacknowledged frames, so that one is drawn while the page shows the previous one."""

_SLOW, _FAST = 0.15, 0.05
"""Excess over the minimum round-trip time [s] above which the quality is lowered, and below which it is raised."""

_STALLED = 0.5
"""Round-trip time [s] after which a page counts as stalled, like a hidden tab; scripts do not wait for it."""

_DROP, _RISE = 0.7, 0.05
_WORST, _BEST = 25, 85
_GOOD, _HALF = 0.5, 0.4
_FORGETTING = 1.02
"""Growth per frame of the estimated minimum round-trip time, which lets it follow a slowing connection."""


class ConnectionPacing:
    """Pacing of the frames of one page, by the round-trip times of earlier frames."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._is_there = False
        self._sent: deque[tuple[float, bool]] = deque()
        self._quickest = float("inf")
        self._level = 1.0

    @property
    def is_free(self) -> bool:
        """Whether the page is ready for another frame."""
        return self._is_there and len(self._sent) < _UNDER_WAY

    @property
    def is_stalled(self) -> bool:
        """Whether a frame has been unacknowledged for too long."""
        return len(self._sent) > 0 and self._clock() - self._sent[0][0] > _STALLED

    @property
    def is_good(self) -> bool:
        """Whether the connection is fast enough for lossless still pictures."""
        return self._level >= _GOOD

    @property
    def quality(self) -> int:
        """JPEG quality while moving, from 25 to 85."""
        return round(_WORST + (_BEST - _WORST) * self._level)

    @property
    def is_halved(self) -> bool:
        """Whether the resolution should be halved while moving."""
        return self._level < _HALF

    def sent(self, *, is_moving: bool) -> None:
        """Record that a frame was sent; the times of still pictures (``is_moving`` False) are not measured."""
        self._sent.append((self._clock(), is_moving))

    def shown(self) -> None:
        """Record that the page has connected, or has shown the oldest unacknowledged frame."""
        self._is_there = True
        if not self._sent:
            return
        since, is_moving = self._sent.popleft()
        if is_moving:
            self._adapt(self._clock() - since)

    def _adapt(self, delay: float) -> None:
        self._quickest = min(_FORGETTING * self._quickest, delay)
        if delay > self._quickest + _SLOW:
            self._level *= _DROP
        elif delay < self._quickest + _FAST:
            self._level = min(self._level + _RISE, 1.0)
