"""Contact patches: all contact points of pairs of geoms, such as the corners of the overlap of two faces.

``mj_geomDistance``, which decides about collisions, gives one point of a pair. MuJoCo's collision detection gives the
corners (``multiccd``, on by default), but only of bodies with a joint between them; here all bodies are temporarily
treated as such.
"""

from collections.abc import Generator, Iterable, Sequence

import mujoco
import numpy as np

from ravemj.core.blocks import block, restoring
from ravemj.core.graphs import Pair, ordered_pair
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
    contacts: dict[Pair, list[Contact]] = {}
    if convex and not world.detection.is_overruled:
        bodies = {int(world.model.model.geom_bodyid[geom]) for pair in convex for geom in pair}
        with _all_separate(world, sorted(bodies)) as masks:
            world.detection.detect_near(world.detection.overlaps(masks))
        contacts = present(world, convex)
    return [_of_pair(world, pair, contacts.get(ordered_pair(*pair), [])) for pair in pairs]


def _of_pair(world: CollisionWorld, pair: Pair, contacts: list[Contact]) -> list[Contact]:
    if any(map(world.shapes.is_concave, pair)):
        return spread(world.shapes.contacts_of_triangles(*pair))
    return contacts or [world.shapes.contact(*pair)]


def present(world: CollisionWorld, pairs: Iterable[Pair]) -> dict[Pair, list[Contact]]:
    """Return MuJoCo's last contacts of the given pairs, by pair; the smaller geom of a key comes first."""
    wanted = {ordered_pair(*pair): pair[0] for pair in pairs}
    by_pair: dict[Pair, list[Contact]] = {}
    data = world.model.data
    if not data.ncon:
        return by_pair
    contacts = data.contact
    positions, normals, depths = contacts.pos.copy(), contacts.frame[:, :3].copy(), (-contacts.dist).tolist()
    for row, (first, second) in enumerate(contacts.geom.tolist()):
        key = ordered_pair(first, second)
        if key in wanted:  # MuJoCo's normal points from its first geom to its second
            away = normals[row] if wanted[key] == second else -normals[row]
            by_pair.setdefault(key, []).append(Contact(positions[row], away, max(depths[row], 0.0)))
    return {key: spread(some) for key, some in by_pair.items()}


def spread(contacts: list[Contact]) -> list[Contact]:
    """Return at most ``_MOST`` contacts without duplicates, the deepest first, chosen far from each other."""
    if len(contacts) < 2:
        return contacts
    rest, chosen = sorted(contacts, key=_depth, reverse=True), list[Contact]()
    positions = np.array([contact.position for contact in rest])
    squares, number = np.full(len(rest), np.inf), 0
    while len(chosen) < _MOST and squares[number] > _SAME * _SAME:
        chosen.append(rest[number])
        apart = positions - positions[number]
        squares = np.minimum(squares, (apart * apart) @ _ONES)
        number = int(squares.argmax())
    return sorted(chosen, key=_depth, reverse=True)


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
