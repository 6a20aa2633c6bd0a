"""Motions of bodies from starts to goals."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.manipulation.bodies import Bodies, Conditions
from ravemj.planning.constrained_edges import ConstrainedEdges, Manifold, bent_path
from ravemj.planning.edges import Allowed, nearby
from ravemj.planning.projection import PROJECTION_STEPS, project
from ravemj.planning.rrt import End, Problem, Search
from ravemj.planning.shortcuts import shorten
from ravemj.planning.space import Space
from ravemj.planning.tracking import LARGEST_JUMP, track

_SHORTCUTS = 100
"""Number of attempted shortcuts of a path on a constraint."""

_JITTER_TRIES = 1000
"""Number of random configurations tested near a start or goal in collision."""

_CLOSE = 1e-6
"""Distance from a contact at which closing joints stop [rad or m]."""


def find_path(problem: Problem, search: Callable[[Problem], Search], spacing: float = 0.0) -> Search:
    """Search for a path. A path on a constraint is shortened and densified here, since smoothers would violate it.

    ``spacing`` is the maximum weighted distance of waypoints, 0 for none.
    """
    search_, edges = search(problem), problem.edges
    if isinstance(edges, ConstrainedEdges) and search_.path is not None:
        path = bent_path(edges, shorten(edges, search_.path, _SHORTCUTS, problem.random))
        search_ = replace(search_, path=path, end=End.stuck if path is None else search_.end)
    if spacing > 0 and search_.path is not None:
        search_ = replace(search_, path=_spaced(edges.space, search_.path, spacing))
    return search_


def _spaced(space: Space, path: Floats, spacing: float) -> Floats:
    rows = [path[:1]]
    for start, end in pairwise(path):
        count = max(1, int(np.ceil(space.distance(end, start) / spacing)))
        parts = np.arange(1, count)[:, None] / count
        rows += [start + parts * space.difference(end, start), end[None]]
    return np.concatenate(rows)


def jittered(conditions: Conditions, space: Space, configurations: Sequence[Floats], jitter: float) -> list[Floats]:
    """Replace each configuration in collision by an allowed one nearby, if one is found.

    Each value changes by at most ``jitter`` [rad or m]; the straight line to the replacement satisfies the constraint,
    if any.
    """
    random, tries = np.random.default_rng(0), _JITTER_TRIES
    with conditions.kept():
        test, manifold = conditions.allowed(), conditions.manifold
        moved = [
            nearby(space, configuration, test, tries, jitter, random)
            if manifold is None
            else _jittered_on(manifold, space, configuration, test, jitter, random)
            for configuration in configurations
        ]
    return [old if new is None else new for old, new in zip(configurations, moved, strict=True)]


def _jittered_on(
    manifold: Manifold,
    space: Space,
    configuration: Floats,
    test: Allowed,
    jitter: float,
    random: np.random.Generator,
) -> Floats | None:
    """Return an allowed configuration near a given one; None if that one violates the constraint or none is found."""
    if not manifold.has(configuration):
        return None

    def projected(values: Floats) -> Floats:
        return project(values, manifold.error, space, manifold.threshold / 2, PROJECTION_STEPS)[1]

    def is_joined(values: Floats) -> bool:
        change = space.difference(values, configuration)
        line = configuration + np.linspace(0, 1, 5)[:, None] * change
        return np.abs(change).max() <= jitter and all(map(manifold.has, line)) and test(values)

    if test(configuration):
        return configuration
    return nearby(space, configuration, is_joined, _JITTER_TRIES, jitter, random, projected)


def free_configuration(
    conditions: Conditions, space: Space, here: Floats, tries: int, farthest: float
) -> Floats | None:
    """Return ``here`` if it is allowed, else an allowed configuration within ``farthest`` [rad or m], or None."""
    with conditions.kept():
        return nearby(space, here, conditions.allowed(), tries, farthest, np.random.default_rng(0))


def place_for_others(
    conditions: Conditions, space: Space, here: Floats, others: Bodies, target: Floats, divisions: int, seed: int
) -> Floats | None:
    """Return a configuration from which other joints can move to their target: ``here``, else a random one, else None.

    Args:
        conditions: The conditions of the configuration.
        space: The configuration space.
        here: The initial configuration.
        others: The other joints, which are restored afterwards.
        target: The target values of the other joints.
        divisions: The number of tested steps of the other joints' motion.
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
    """Return joint values that reach consecutive goals without jumps, up to the first failure, shape (m, n).

    Args:
        space: The configuration space of the arm.
        first: The joint values at the start, shape (n,).
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
    """Move joints until a first new contact of their links, or to a limit; return the final values.

    Joints move alternately, one step each, like fingers that close simultaneously.

    Args:
        bodies: The joints.
        limits: Their lower and upper limits [rad or m], each of shape (n,).
        sides: The sign of the motion of each joint, shape (n,).
        step: The step between two tests [rad or m].
        touches: Whether a link moved by a joint (given by index) is in contact.
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
    """Set a joint to the last value without contact, by bisection between ``free`` and the current value."""
    taken = float(values[joint])
    while abs(taken - free) > _CLOSE:
        values[joint] = middle = (taken + free) / 2
        bodies.move(values)
        taken, free = (middle, free) if touches(joint) else (taken, middle)
    values[joint] = free
    bodies.move(values)
