"""Contact patches: all contact points of pairs of geoms, such as the corners of the overlap of two faces.

``mj_geomDistance``, which decides about collisions, gives one point of a pair. MuJoCo's collision detection gives the
corners (``multiccd``, on by default), but only of bodies with a joint between them; here all bodies are temporarily
treated as such.
"""

import math
from collections.abc import Generator, Iterable, Sequence

import mujoco
import numpy as np

from ravemj.core.blocks import block, restoring
from ravemj.core.graphs import Pair
from ravemj.core.transforms import Floats
from ravemj.engine.collision.pairs import Masks
from ravemj.engine.collision.shapes import Contact
from ravemj.engine.collision.world import CollisionWorld

_PARENTS_COUNT = int(mujoco.mjtDisableBit.mjDSBL_FILTERPARENT)
_MOST = 8
"""Maximum number of contact points per geom pair; points between the kept ones are dropped."""

_ONES = np.ones(3)
_SAME = 1e-7  # m; contact points of one pair that are nearer to each other count as one


def patches(world: CollisionWorld, pairs: Sequence[Pair]) -> list[list[Contact]]:
    """Return the contact points of each pair of touching geoms, the deepest first.

    A pair for which MuJoCo finds none has the point of ``ShapeTests.contact``. The caller holds the lock.
    """
    convex = [pair for pair in pairs if not any(map(world.shapes.is_concave, pair))]
    contacts = present(world, convex) if world.detection.has_contacts else {}
    missing = [pair for pair in convex if pair not in contacts]
    if missing and not world.detection.is_overruled:
        bodies = {int(world.model.model.geom_bodyid[geom]) for pair in missing for geom in pair}
        with _all_separate(world, sorted(bodies)) as masks:
            world.detection.detect_near(world.detection.overlaps(masks))
        contacts |= present(world, missing)
    return [contacts.get(pair) or _of_pair(world, pair) for pair in pairs]


def _of_pair(world: CollisionWorld, pair: Pair) -> list[Contact]:
    if any(map(world.shapes.is_concave, pair)):
        return spread(world.shapes.contacts_of_triangles(*pair))
    return [world.shapes.contact(*pair)]


def present(world: CollisionWorld, pairs: Sequence[Pair]) -> dict[Pair, list[Contact]]:
    """Return MuJoCo's last contacts by pair, for the given pairs that have contacts."""
    if not pairs or not world.model.data.ncon:
        return {}
    wanted: dict[Pair, tuple[Pair, bool]] = {}
    for first, second in pairs:
        wanted[first, second], wanted[second, first] = ((first, second), True), ((first, second), False)
    by_pair: dict[Pair, list[Contact]] = {}
    contacts = world.model.data.contact
    positions, normals, distances = contacts.pos.copy(), contacts.frame[:, :3].copy(), contacts.dist.tolist()
    for row, (first, second) in enumerate(contacts.geom.tolist()):
        if (first, second) in wanted:  # MuJoCo's normal points from its first geom to its second
            pair, is_outwards = wanted[first, second]
            normal = -normals[row] if is_outwards else normals[row]
            by_pair.setdefault(pair, []).append(Contact(positions[row], normal, max(-distances[row], 0.0)))
    return {pair: spread(some) for pair, some in by_pair.items()}


def spread(contacts: list[Contact]) -> list[Contact]:
    """Return at most ``_MOST`` contacts without duplicates, the deepest first, chosen far from each other."""
    rest = sorted(contacts, key=_depth, reverse=True) if len(contacts) > 1 else contacts
    if len(rest) > _MOST:
        return sorted(_farthest(rest), key=_depth, reverse=True)
    chosen: list[Contact] = []
    positions: list[list[float]] = []
    for contact in rest:
        position = contact.position.tolist()
        if all(math.dist(position, other) > _SAME for other in positions):
            chosen.append(contact)
            positions.append(position)
    return chosen


def _farthest(contacts: list[Contact]) -> list[Contact]:
    """Return at most ``_MOST`` contacts: the first one, then always the one farthest from those chosen before."""
    positions, chosen = np.array([contact.position for contact in contacts]), list[Contact]()
    squares, number = np.full(len(contacts), np.inf), 0
    while len(chosen) < _MOST and squares[number] > _SAME * _SAME:
        chosen.append(contacts[number])
        apart = positions - positions[number]
        squares = np.minimum(squares, (apart * apart) @ _ONES)
        number = int(squares.argmax())
    return chosen


def _depth(contact: Contact) -> float:
    return contact.depth


def contact_rows(contacts: Iterable[Contact]) -> Floats:
    """Return positions [m] and normals of contacts, shape (n, 6)."""
    return np.array([[*contact.position, *contact.normal] for contact in contacts]).reshape(-1, 6)


@block
def _all_separate(world: CollisionWorld, bodies: list[int]) -> Generator[Masks]:
    """Context manager that makes MuJoCo test all geoms of ``bodies`` against each other; it yields their masks."""
    model = world.model.model
    welds, dofs, flags = model.body_weldid.copy(), model.body_dofnum.copy(), model.opt.disableflags

    def restore() -> None:
        model.body_weldid[:], model.body_dofnum[:], model.opt.disableflags = welds, dofs, flags

    chosen = np.zeros(model.nbody, dtype=np.int32)
    chosen[bodies] = 1
    with restoring(restore):
        model.body_weldid[:] = np.arange(model.nbody)
        model.body_dofnum[bodies] = np.maximum(dofs[bodies], 1)
        model.opt.disableflags = flags | _PARENTS_COUNT
        yield Masks(chosen, chosen)
