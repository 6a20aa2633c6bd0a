"""How many pictures a page is sent, and how good they are: as its connection can take."""

import time
from collections import deque
from collections.abc import Callable

_UNDER_WAY = 2
"""Pictures that may be under way at a time: the next one is drawn here while the last one is shown there."""

_SLOW, _FAST = 0.15, 0.05
"""A picture that takes so much longer than the quickest one lowers the quality, or raises it [s]."""

_STALLED = 0.5
"""A picture that is under way for longer [s] is in a tab that nobody sees, or on a way that scripts do not wait for."""

_DROP, _RISE = 0.7, 0.05
_WORST, _BEST = 25, 85
_GOOD, _HALF = 0.5, 0.4
_FORGETTING = 1.02
"""By how much the quickest time grows with each picture: the way to the browser may have become longer."""


class Link:
    """The way to one page, as the times tell that its pictures take until they are shown."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._is_there = False
        self._sent: deque[tuple[float, bool]] = deque()
        self._quickest = float("inf")
        self._level = 1.0

    @property
    def is_free(self) -> bool:
        """Whether the page takes another picture now."""
        return self._is_there and len(self._sent) < _UNDER_WAY

    @property
    def is_stalled(self) -> bool:
        """Whether the page has shown nothing for long, although it was sent something."""
        return len(self._sent) > 0 and self._clock() - self._sent[0][0] > _STALLED

    @property
    def is_good(self) -> bool:
        """Whether what comes to rest may have as many bytes as it likes."""
        return self._level >= _GOOD

    @property
    def quality(self) -> int:
        """Quality of pictures as JPEG while things move, from 25 to 85."""
        return round(_WORST + (_BEST - _WORST) * self._level)

    @property
    def is_halved(self) -> bool:
        """Whether pictures should have half as many rows and columns while things move."""
        return self._level < _HALF

    def sent(self, *, is_moving: bool) -> None:
        """Note that a picture was sent; what comes to rest may take its time."""
        self._sent.append((self._clock(), is_moving))

    def shown(self) -> None:
        """Note that the page has come, or has shown the oldest picture that is under way."""
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
