"""Limits for pages and unauthenticated connections."""

import ipaddress
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

MOST_PAGES = 64
"""Maximum number of open pages."""

MOST_STRANGERS = 32
"""Maximum number of connections that have not sent the secret yet; pages are counted separately."""

_MOST_GUESSES = 20
_MINUTE = 60.0
_MOST_PEERS = 1024


@dataclass(slots=True)
class _PeerRecord:
    times: deque[float] = field(default_factory=lambda: deque[float](maxlen=_MOST_GUESSES))
    guesses: dict[int, float] = field(default_factory=dict[int, float])  # by hashes of the secrets

    def forget(self, until: float) -> None:
        while self.times and self.times[0] <= until:
            self.times.popleft()
        self.guesses = {token: at for token, at in self.guesses.items() if at > until}


class Guesses:
    """Counts the wrong secrets of each peer within the last minute.

    After 20 wrong secrets, further wrong secrets of a peer are refused. After 20 *different* ones the peer may be
    guessing, and all its requests are refused, since accepting the right secret would complete the search. An old page
    that repeats one wrong secret locks nobody out, even behind a proxy, where all browsers are one peer.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._records: dict[bytes, _PeerRecord] = {}
        self._lock = threading.Lock()

    def refuses(self, peer: str, token: str, *, is_right: bool) -> bool:
        """Count a wrong secret; return whether the request must be refused."""
        now, network = self._clock(), _network(peer)
        with self._lock:
            record = self._records.pop(network, None) or _PeerRecord()
            record.forget(now - _MINUTE)
            is_searching = len(record.guesses) >= _MOST_GUESSES
            is_refused = is_searching or (not is_right and len(record.times) >= _MOST_GUESSES)
            if not is_right and not is_searching:
                record.guesses[hash(token)] = now
                if not is_refused:
                    record.times.append(now)
            if record.guesses:
                self._records[network] = record
            for oldest in list(self._records)[:-_MOST_PEERS]:
                del self._records[oldest]
        return is_refused


def _network(peer: str) -> bytes:
    """Return the part of an IP address that identifies a machine: all of IPv4, the first half of IPv6."""
    try:
        address = ipaddress.ip_address(peer.partition("%")[0])
    except ValueError:
        return peer.encode()
    if isinstance(address, ipaddress.IPv6Address) and address.ipv4_mapped is not None:
        address = address.ipv4_mapped
    return address.packed[:8]
