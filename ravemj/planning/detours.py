"""Certified detours around lines that cannot be certified."""

from dataclasses import replace

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges, Proof
from ravemj.planning.rrt import Budget, connect

AROUND = 0.3
"""Maximum weighted distance, in each coordinate, of a detour from the part of the path that it replaces."""

_ITERATIONS = 200


def certified_detour(edges: Edges, proof: Proof, part: Floats, random: np.random.Generator) -> Floats | None:
    """Return a nearby path with certified edges that replaces the path ``part``, shape (m, n), or None."""
    space, around = edges.space, AROUND / edges.space.weights
    lower = np.maximum(part.min(axis=0) - around, space.lower)
    upper = np.minimum(part.max(axis=0) + around, space.upper)
    near = Edges(replace(space, lower=lower, upper=upper), edges.allowed, edges.step, proof)
    near.is_strict = True
    return connect(near, [part[0]], [part[-1]], Budget(_ITERATIONS), random).path
