"""Whether a body collides in configurations other than its own."""

from collections.abc import Callable, Generator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.engine.collision.queries import body_and_all, body_and_others
from ravemj.engine.simulation import BodyState


@contextmanager
def collision_test(body: BodyState, *, itself_too: bool = True) -> Generator[Callable[[Floats], bool]]:
    """Yield a function that takes joint values and returns whether the body, with what it holds, collides there.

    It is made for planners, which ask it thousands of times. Nothing else moves meanwhile. The body is back in its
    configuration afterwards, and so is what it holds. The caller holds the lock.

    Args:
        body: A body in the world.
        itself_too: Whether collisions of the body with itself count.

    Example:
        >>> with simulation.lock, collision_test(body) as collides:
        ...     free = [values for values in samples if not collides(values)]
    """
    world, kinematics = body.simulation.collisions(), body.kinematics
    pairs = body_and_all(world, body) if itself_too else body_and_others(world, body)
    collide, follow, part = world.collide, world.model.follow, world.model.part(body)

    def collides(values: Floats) -> bool:
        kinematics.set_values(values)
        follow(part, kinematics)
        return collide(pairs)

    def collides_with_held(values: Floats) -> bool:
        body.set_values(values)
        body.simulation.compiled()
        return collide(pairs)

    before, stamp = body.configuration(), body.stamp
    held = [(grab.body, grab.body.configuration()) for grab in body.grabs]
    try:
        yield collides_with_held if held else collides
    finally:
        body.restore(before)
        for one, configuration in held:
            one.restore(configuration)
        body.stamp = stamp


def batch_collides(body: BodyState, values: Floats, *, itself_too: bool) -> NDArray[np.bool_]:
    """Return for each configuration whether the body collides. The caller holds the lock.

    Args:
        body: The body; it is back in its configuration afterwards.
        values: Joint values [rad or m], shape (n, dof).
        itself_too: Whether collisions of the body with itself count.

    Returns:
        Shape (n,).
    """
    with collision_test(body, itself_too=itself_too) as collides:
        return np.array([collides(one) for one in values], dtype=bool)
