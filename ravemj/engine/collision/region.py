"""The region in which a body that moves freely can touch others."""

from collections.abc import Iterable

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.collision.queries import held_with
from ravemj.engine.simulation import BodyState
from ravemj.model.motion_bounds import reach
from ravemj.model.scene import Bounds


def touching_region(body: BodyState) -> Bounds | None:
    """Return the box of base positions [m] beyond which a body touches no other one, at any joint values.

    None if there is no other body with shapes.
    """
    attached = body.simulation.attached(body)
    others = _boxes(one for one in body.simulation.bodies if one not in attached)
    if not others:
        return None
    origin, poses = body.link_transform(0)[:3, 3], body.link_transforms()
    farthest = max([reach(body.scene), *(_distance(box, origin) for box in _boxes([body]))])
    for grab in body.grabs:
        farthest += max((_distance(box, poses[grab.link, :3, 3]) for box in _boxes(held_with(grab.body))), default=0.0)
    low, high = np.min([box.low for box in others], axis=0), np.max([box.high for box in others], axis=0)
    return Bounds(low - farthest, high + farthest)


def _boxes(bodies: Iterable[BodyState]) -> list[Bounds]:
    found = [body.bounds.at(body.link_transforms(), [True] * len(body.scene.links)) for body in bodies]
    return [box for box in found if box is not None]


def _distance(box: Bounds, point: Floats) -> float:
    """Return the greatest distance of a point from a box."""
    return float(np.linalg.norm(np.maximum(np.abs(box.low - point), np.abs(box.high - point))))
