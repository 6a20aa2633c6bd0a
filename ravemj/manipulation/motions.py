"""Motions of bodies from starts to goals."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.collision.findings import Findings, GeometryOf
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.manipulation.bodies import USER, Bodies, Conditions
from ravemj.planning.constrained_edges import ConstrainedEdges, bent_path
from ravemj.planning.edges import Allowed, nearby
from ravemj.planning.problem import Problem
from ravemj.planning.rrt import End, Search
from ravemj.planning.shortcuts import shorten
from ravemj.planning.space import Space
from ravemj.planning.tracking import LARGEST_JUMP, track

_SHORTCUTS = 100
"""The number of attempted shortcuts of a path on a constraint."""

_JITTER_TRIES = 1000
"""The number of random configurations that are tested near a start or goal in collision."""

_CLOSE = 1e-6
"""The distance from a contact within which joints stop [rad or m]."""


class RefusedError(Exception):
    """A problem has no start or no goal that is allowed; the text says why.

    Attributes:
        values: The first configuration that is refused, shape (n,); empty if there is none.
        findings: Its collision, or None.
    """

    def __init__(self, reason: str, values: Floats | None = None, findings: Findings | None = None) -> None:
        super().__init__(reason)
        self.values = np.zeros(0) if values is None else values
        self.findings = findings


def refusal(conditions: Conditions, space: Space, allowed: Allowed, values: Floats, name: str) -> RefusedError | None:
    """Return why a configuration cannot be a start or a goal, or None. Use it within ``conditions.kept``.

    ``allowed`` is the test of ``conditions``.
    """
    if not np.isfinite(values).all():
        return RefusedError(f"{name}: {values.tolist()} should be finite numbers", values)
    outside = space.outside(values)
    if outside is not None:
        limits = f"[{space.lower[outside]:g}, {space.upper[outside]:g}]"
        reason = f"{_described(conditions, outside)} is {values[outside]:.6g}, outside its limits {limits}"
        return RefusedError(f"{name}: {reason}", values)
    if allowed(values):
        return None
    told: list[Findings] = []
    found = conditions.violation(values, told=told)
    if found == USER:
        return RefusedError(f"{name}: {_off(conditions, values)}", values)
    if found:
        links = " with ".join(map(_link, told[-1].collisions[0][:2]))
        return RefusedError(f"{name}: it collides: {links}", values, told[-1])
    return None


def allowed_ends(
    conditions: Conditions,
    space: Space,
    allowed: Allowed,
    ends: tuple[Sequence[Floats], Sequence[Floats]],
    *,
    needs_goal: bool,
) -> tuple[list[Floats], list[Floats]]:
    """Return the starts and goals that are allowed. Use it within ``conditions.kept``.

    Raises:
        RefusedError: there is no start or no goal, none is allowed, or a value has no limits.
    """
    endless = np.flatnonzero(~np.isfinite(space.lower) | ~np.isfinite(space.upper))
    if len(endless):
        raise RefusedError(f"{_described(conditions, int(endless[0]))} has no limits, and should have some")
    kept: list[list[Floats]] = []
    for name, candidates in zip(("start", "goal"), ends, strict=True):
        if not len(candidates) and (name == "start" or needs_goal):
            raise RefusedError(f"there is no {name}")
        refusals = [refusal(conditions, space, allowed, values, name) for values in candidates]
        kept.append([values for values, why in zip(candidates, refusals, strict=True) if why is None])
        if refusals and not kept[-1]:
            assert refusals[0] is not None, "none is allowed"
            raise refusals[0]
    return kept[0], kept[1]


def find_path(problem: Problem, search: Callable[[Problem], Search], spacing: float = 0.0) -> Search:
    """Search for a path. One on a constraint is shortened, and gets waypoints, since smoothers would leave it.

    With a spacing, a weighted distance, the path gets waypoints that are at most so far apart.
    """
    found, edges = search(problem), problem.edges
    if isinstance(edges, ConstrainedEdges) and found.path is not None:
        path = bent_path(edges, shorten(edges, found.path, _SHORTCUTS, problem.random))
        found = replace(found, path=path, end=End.stuck if path is None else found.end)
    if spacing > 0 and found.path is not None:
        found = replace(found, path=_spaced(edges.space, found.path, spacing))
    return found


def _spaced(space: Space, path: Floats, spacing: float) -> Floats:
    rows = [path[:1]]
    for start, end in pairwise(path):
        count = max(1, int(np.ceil(space.distance(end, start) / spacing)))
        parts = np.arange(1, count)[:, None] / count
        rows += [start + parts * space.difference(end, start), end[None]]
    return np.concatenate(rows)


def jittered(conditions: Conditions, space: Space, configurations: Sequence[Floats], jitter: float) -> list[Floats]:
    """Return configurations, each one in collision replaced by a free one nearby, if one is found.

    Each value moves by ``jitter`` at most [rad or m].
    """
    random = np.random.default_rng(0)
    with conditions.kept():
        test = conditions.allowed()
        found = [nearby(space, one, test, _JITTER_TRIES, jitter, random) for one in configurations]
    return [old if new is None else new for old, new in zip(configurations, found, strict=True)]


def free_configuration(
    conditions: Conditions, space: Space, here: Floats, tries: int, farthest: float
) -> Floats | None:
    """Return a configuration if it is allowed, else an allowed one within ``farthest`` [rad or m], or None."""
    with conditions.kept():
        return nearby(space, here, conditions.allowed(), tries, farthest, np.random.default_rng(0))


def place_for_others(
    conditions: Conditions, space: Space, here: Floats, others: Bodies, target: Floats, divisions: int, seed: int
) -> Floats | None:
    """Return a configuration at or near another one where other joints can move to their target, or None.

    Args:
        conditions: The conditions of the configuration.
        space: The configuration space.
        here: The configuration to begin with.
        others: The other joints, which are not moved.
        target: The values of the other joints.
        divisions: The number of steps in which their motion is tested.
        seed: The seed of the random numbers.
    """
    test, before = conditions.allowed(), others.values()
    line = before + np.linspace(0.0, 1.0, divisions + 1)[1:, None] * (target - before)

    def is_free(values: Floats) -> bool:
        others.move(values)
        return not others.collision()

    def others_can_move(values: Floats) -> bool:
        if not test(values):
            return False
        try:
            return all(map(is_free, line))
        finally:
            others.move(before)

    farthest = float((space.upper - space.lower).max())
    with conditions.kept(), others.kept():
        return nearby(space, here, others_can_move, 1000, farthest, np.random.default_rng(seed))


def follow_goals(space: Space, first: Floats, count: int, search: Callable[[int], ArmSearch]) -> Floats:
    """Return joint values that reach one goal after the other without jumps, as far as they can, shape (m, n).

    Args:
        space: The configuration space of the arm.
        first: The first row, shape (n,).
        count: The number of goals.
        search: Returns the search for a goal, by its number from 1 to ``count``.
    """

    def solve(number: int, near: Floats) -> list[Floats]:
        row = search(number).near(near, LARGEST_JUMP) if number else first
        return [] if row is None else [row]

    return track(space, count + 1, first, solve, lambda number, before, after: True)


def move_until_contact(
    bodies: Bodies, limits: tuple[Floats, Floats], sides: Floats, step: float, touches: Callable[[int], bool]
) -> Floats:
    """Return the values at which joints stop: each moves until its links touch something new, or to its limit.

    Joints take turns, one step each, as fingers close at the same time.

    Args:
        bodies: The joints.
        limits: Their lower and upper limits [rad or m], each of shape (n,).
        sides: The sign of the motion of each joint, shape (n,).
        step: The step between two tests [rad or m].
        touches: Whether a link that a joint moves touches something, by the index of the joint.
    """
    lower, upper = limits
    with bodies.kept():
        values = bodies.values()
        touching = [touches(joint) for joint in range(len(sides))]
        moving = [joint for joint, side in enumerate(sides) if side != 0]
        while moving:
            for joint in tuple(moving):
                before = values[joint]
                target = float(np.clip(before + sides[joint] * step, lower[joint], upper[joint]))
                values[joint] = target
                bodies.move(values)
                is_touching = touches(joint)
                if is_touching and not touching[joint]:
                    _retreat(bodies, values, joint, before, touches)
                    moving.remove(joint)
                elif target in {lower[joint], upper[joint]}:
                    moving.remove(joint)
                touching[joint] = is_touching
        return values


def _retreat(bodies: Bodies, values: Floats, joint: int, free: float, touches: Callable[[int], bool]) -> None:
    """Set a joint to the last value without contact, by bisection between a free value and the current one."""
    taken = float(values[joint])
    while abs(taken - free) > _CLOSE:
        values[joint] = middle = (taken + free) / 2
        bodies.move(values)
        taken, free = (middle, free) if touches(joint) else (taken, middle)
    values[joint] = free
    bodies.move(values)


def _described(conditions: Conditions, index: int) -> str:
    assert conditions.bodies is not None, "something moves"
    return conditions.bodies.described(index)


def _off(conditions: Conditions, values: Floats) -> str:
    """Return which constraint a configuration does not keep."""
    manifold = conditions.manifold
    if manifold is None or manifold.has(values):
        return "a constraint does not allow it"
    off, most = manifold.off(values), manifold.threshold
    return f"the tool is {off:.3g} off its constraint, and should be {most:g} at most"


def _link(geometry: GeometryOf) -> str:
    scene = geometry.body.scene
    return f"link '{scene.links[geometry.link].name}' of '{scene.name}'"
