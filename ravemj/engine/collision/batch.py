"""Many configurations at once."""

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.collision.questions import body_and_others, itself
from ravemj.engine.simulation import BodyState


def batch_collides(body: BodyState, values: Floats, *, itself_too: bool) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return for each configuration whether the body collides. The caller holds the lock.

    Args:
        body: The body; it is back in its configuration afterwards.
        values: Joint values [rad or m], shape (n, dof).
        itself_too: Whether collisions of the body with itself count.

    Returns:
        Shape (n,).
    """
    world = body.simulation.collisions()
    pairs = [body_and_others(world, body)] + ([itself(world, body)] if itself_too else [])
    found = np.zeros(len(values), dtype=bool)
    before, stamp = body.configuration(), body.stamp
    held = [(grab.body, grab.body.configuration()) for grab in body.grabs]
    try:
        for number, one in enumerate(values):
            body.set_values(one)
            body.simulation.compiled()  # the world follows
            found[number] = any(world.collide(some) for some in pairs)
    finally:
        body.restore(before)
        for one, configuration in held:
            one.restore(configuration)
        body.stamp = stamp
    return found
