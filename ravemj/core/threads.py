"""Number of threads of batch calls."""

import os

from ravemj.core.arguments import checked_integer
from ravemj.errors import ArgumentError

_MOST = 1024
"""Maximum number of threads."""

_chosen = 0


def set_batch_threads(count: int) -> None:
    """Set how many threads batch calls such as ``batch_collides`` use in this process. Results do not depend on it.

    Args:
        count: Number of threads, at most 1024; 0, the default, means the number of processors that the process may use.
            If several processes share the processors, set 1 in each.

    Raises:
        ArgumentError: the count is negative, too large or not an integer.

    Example:
        >>> ravemj.set_batch_threads(1)
    """
    global _chosen  # noqa: PLW0603 - a setting of the process
    number = checked_integer(count, "set_batch_threads: count")
    if not 0 <= number <= _MOST:
        raise ArgumentError(f"set_batch_threads: count: expected 0 for all processors, or up to {_MOST}")
    _chosen = number


def batch_threads() -> int:
    """Return how many threads batch calls use, at least 1."""
    return _chosen or (len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1)
