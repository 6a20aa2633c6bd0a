"""Search for the families that an arm belongs to.

An arm with fewer than six joints is completed by virtual joints whose values must be 0: two intersecting axes get a
third one through their intersection, and become a spherical wrist. The solutions of the completed arm include all
solutions of the arm; those with other values of the virtual joints fail the check by forward kinematics.
"""

import contextlib
from collections.abc import Iterator, Sequence

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.families.blocks import Planar, Wrist, common_point, is_planar
from ravemj.ik.families.carrying import NoFamilyError
from ravemj.ik.families.gantry import Gantry
from ravemj.ik.families.general import General
from ravemj.ik.families.loops import Arm, BlockFamily, Family, Locked, PointFamily
from ravemj.ik.tasks import Task
from ravemj.ik.vectors import Floats, Screw, Transform, constant, perpendicular, turn_of

EXACT = 1e-9
"""Tolerance of zero lengths and sines of angles in nominal geometry."""
_EXAMPLES = 24
_SEED = 20


def families(nominal: Chain, task: Task, locked: Sequence[int]) -> Iterator[Family]:
    """Yield methods that solve an arm of nominal geometry, with lengths divided by its reach.

    Of methods for the same completed arm, the fastest come first.
    """
    arm = _arm(nominal, locked)
    free = nominal.dof - len(locked)
    if task in (Task.TRANSFORM, Task.PLANAR):
        for whole in _complete(arm, 6 - free):
            yield from sorted(_of(whole), key=lambda family: (family.coupled, not family.shared))
        return
    if task is Task.PLACE_XY:
        arm = _inserted(arm, 0, [Screw(constant(np.array([0.0, 0.0, 1.0])), np.zeros((3, 1, 1)), prismatic=True)])
    tool = constant(nominal.T_base_tool[:3, 3])
    try:
        yield PointFamily(arm, tool, _examples(arm, tool))
    except NoFamilyError:
        return


def general_families(nominal: Chain, locked: Sequence[int]) -> Iterator[Family]:
    """Yield methods that solve an arm of revolute joints by an eigenvalue problem.

    They are a hundred times slower than those of ``families``.
    """
    whole = next(_complete(_arm(nominal, locked), 6 - nominal.dof + len(locked)), None)
    for backward in (False, True):
        for shift in range(6):
            try:
                if whole is not None:
                    yield General(whole, shift, backward=backward)
            except NoFamilyError:
                return


def _arm(nominal: Chain, locked: Sequence[int]) -> Arm:
    screws = [
        Screw(constant(axis), constant(point), sliding)
        for axis, point, sliding in zip(nominal.axes, nominal.points, nominal.prismatic.tolist(), strict=True)
    ]
    return Arm(tuple(screws), tuple(range(nominal.dof)), frozenset(locked))


def _of(arm: Arm) -> Iterator[Family]:
    """Yield the solver families that an arm of six joints belongs to."""
    for ordered in _orders(arm):
        examples = _examples(ordered, np.zeros((3, 1, 1)))
        with contextlib.suppress(NoFamilyError):
            yield Gantry(ordered)
        inner = ordered.inner
        for block in range(inner[0], inner[-1] - 1):
            yield from _block(ordered, block, examples)


def _block(arm: Arm, block: int, examples: tuple[Transform, Locked]) -> Iterator[Family]:
    if arm.locked & set(range(block, block + 3)):
        return
    screws = arm.screws[block : block + 3]
    centre = common_point(screws, EXACT)
    try:
        if centre is not None:
            yield BlockFamily(arm, block, Wrist(screws, constant(centre)), examples)
        elif is_planar(screws, EXACT):
            yield BlockFamily(arm, block, Planar(screws), examples)
    except NoFamilyError:
        return


def _orders(arm: Arm) -> Iterator[Arm]:
    """Yield the arm with equivalent orders of joints; a prismatic and a revolute one with parallel axes commute."""
    yield arm
    for toward_tool in (True, False):
        order = list(range(len(arm.screws)))
        for _ in order:
            for place in range(len(order) - 1):
                pair = order[place : place + 2]
                slider, other = pair if toward_tool else pair[::-1]
                if _commute(arm, slider, other):
                    order[place : place + 2] = pair[::-1]
        if order != sorted(order):
            screws, joints = tuple(arm.screws[index] for index in order), tuple(arm.joints[index] for index in order)
            yield Arm(screws, joints, frozenset(order.index(place) for place in arm.locked))


def _commute(arm: Arm, slider: int, other: int) -> bool:
    first, two = arm.screws[slider], arm.screws[other]
    if not first.prismatic or two.prismatic or {slider, other} & arm.locked:
        return False
    return bool(np.linalg.norm(np.cross(first.axis.ravel(), two.axis.ravel())) < EXACT)


def _examples(arm: Arm, start: Floats) -> tuple[Transform, Locked]:
    """Return motions of an arm in random configurations, and the values of locked joints.

    The translation of a motion is the moved point ``start``.
    """
    rng = np.random.default_rng(_SEED)
    seen: Transform | None = None
    locked: dict[int, Floats] = {}
    for place, screw in enumerate(arm.screws):
        draws = rng.uniform(-3, 3, (1, _EXAMPLES))
        value = draws[None] / 3 if screw.prismatic else turn_of(draws)
        if place in arm.locked:
            locked[place] = value
        step = screw.transform(value)
        seen = step if seen is None else seen @ step
    assert seen is not None
    return Transform(seen.rotation, seen.moved(start)), locked


def _complete(arm: Arm, missing: int) -> Iterator[Arm]:
    """Yield the arm with ``missing`` virtual joints: first all at the tool, then some that extend joints to a block.

    A block is a wrist or three planar joints.
    """
    if missing < 0:
        return
    if missing == 0:
        yield arm
        return
    for ordered in _orders(arm):
        yield _behind(ordered, missing)
        for added in (1, 2, 3):
            if added <= missing:
                yield from _blocks_of(ordered, added, missing - added)


def _blocks_of(arm: Arm, added: int, more: int) -> Iterator[Arm]:
    """Yield arms in which ``added`` virtual joints extend existing ones to a block: a wrist or three planar joints.

    Further ``more`` virtual joints are at the tool.
    """
    size = 3 - added
    for place in range(len(arm.screws) - size + 1):
        around = range(place, place + size)
        if not arm.locked & set(around):
            for screws in _third(arm.screws[place : place + size], added):
                yield _behind(_inserted(arm, place + size, screws), more)


def _third(screws: Sequence[Screw], added: int) -> Iterator[list[Screw]]:
    """Yield sets of ``added`` virtual joints that complete the given ones to a block: a wrist or planar joints."""
    turning = [screw for screw in screws if not screw.prismatic]
    if not turning:
        if not screws:
            yield _around(np.array([0.31, -0.17, 0.23]), np.eye(3))
        return
    axis = turning[0].axis.ravel()
    if added == 1:
        centre = common_point(screws, EXACT)
        if centre is not None:
            side = np.cross(screws[0].axis.ravel(), screws[1].axis.ravel())
            yield _around(centre, side[None] / np.linalg.norm(side))
        elif is_planar(screws, EXACT):
            yield [Screw(constant(axis), constant(turning[0].point.ravel() + _generic(1)[0]))]
    else:
        side = perpendicular(axis)
        yield _around(turning[0].point.ravel(), np.stack([side, np.cross(axis, side)]))
        yield [Screw(constant(axis), constant(turning[0].point.ravel() + away)) for away in _generic(2)]


def _around(centre: Floats, axes: Floats) -> list[Screw]:
    return [Screw(constant(axis), constant(centre)) for axis in axes]


def _behind(arm: Arm, count: int) -> Arm:
    """Append ``count`` virtual revolute joints with generic axes at the tool of an arm."""
    rng = np.random.default_rng(_SEED + count)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    places = rng.normal(size=(3, 3)) / 2
    screws = [Screw(constant(axis), constant(place)) for axis, place in zip(axes, places, strict=True)][:count]
    return _inserted(arm, len(arm.screws), screws)


def _inserted(arm: Arm, place: int, screws: Sequence[Screw]) -> Arm:
    return Arm(
        (*arm.screws[:place], *screws, *arm.screws[place:]),
        (*arm.joints[:place], *[-1] * len(screws), *arm.joints[place:]),
        frozenset(at if at < place else at + len(screws) for at in arm.locked),
    )


def _generic(count: int) -> Floats:
    """Return vectors in no special direction, so that added axes are neither parallel nor intersecting."""
    return np.array([[0.37, -0.29, 0.41], [-0.23, 0.43, 0.31]])[:count]
