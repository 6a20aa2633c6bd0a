"""Configurations nearby that are allowed, where a little collision is in the way."""

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Allowed
from ravemj.planning.space import Space


def nearby(
    space: Space, configuration: Floats, allowed: Allowed, tries: int, farthest: float, random: np.random.Generator
) -> Floats | None:
    """Return a configuration itself if it is allowed, else an allowed one near it, or None.

    Args:
        space: Where it is.
        configuration: The configuration.
        allowed: Tests one.
        tries: How many others are tried.
        farthest: How far each value may move [rad or m]; the first tries stay nearer.
        random: Draws the others.
    """
    if allowed(configuration):
        return configuration
    for attempt in range(tries if farthest > 0 else 0):
        reach = farthest * (attempt + 1) / tries
        candidate = space.clamp(configuration + random.uniform(-reach, reach, len(configuration)))
        if allowed(candidate):
            return candidate
    return None
