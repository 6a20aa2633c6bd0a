"""Motions of bodies from starts to goals."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.collision.findings import Findings, GeometryOf
from ravemj.manipulation.bodies import USER, Conditions
from ravemj.planning.constrained_edges import ConstrainedEdges, bent_path
from ravemj.planning.edges import Allowed, nearby
from ravemj.planning.problem import Problem
from ravemj.planning.rrt import End, Search
from ravemj.planning.shortcuts import shorten
from ravemj.planning.space import Space

_SHORTCUTS = 100
"""The number of attempted shortcuts of a path on a constraint."""

_JITTER_TRIES = 1000
"""The number of random configurations that are tested near a start or goal in collision."""


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


def find_path(problem: Problem, search: Callable[[Problem], Search]) -> Search:
    """Search for a path. One on a constraint is shortened, and gets waypoints, since smoothers would leave it."""
    found, edges = search(problem), problem.edges
    if isinstance(edges, ConstrainedEdges) and found.path is not None:
        path = bent_path(edges, shorten(edges, found.path, _SHORTCUTS, problem.random))
        found = replace(found, path=path, end=End.stuck if path is None else found.end)
    return found


def jittered(conditions: Conditions, space: Space, configurations: Sequence[Floats], jitter: float) -> list[Floats]:
    """Return configurations, each one in collision replaced by a free one nearby, if one is found.

    Each value moves by ``jitter`` at most [rad or m].
    """
    random = np.random.default_rng(0)
    with conditions.kept():
        test = conditions.allowed()
        found = [nearby(space, one, test, _JITTER_TRIES, jitter, random) for one in configurations]
    return [old if new is None else new for old, new in zip(configurations, found, strict=True)]


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
