"""Reasons for the rejection of starts and goals: of single configurations, and statistics of samples."""

from collections import Counter, deque
from collections.abc import Callable, Sequence
from enum import Enum

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.collision.findings import Findings
from ravemj.engine.collision.world import GeometryOf
from ravemj.manipulation.bodies import ENV_COLLISION, SELF_COLLISION, USER, Bodies, Conditions
from ravemj.planning.edges import Allowed
from ravemj.planning.space import Space

_REMEMBERED = 200
"""Number of last rejected configurations that are explained after a search."""

_MOST_REGIONS = 6
"""Maximum number of regions that a message describes one by one."""


class Cause(Enum):
    """Cause for which a sampled pose is rejected as start or goal, in the order of the tests."""

    REACH = "out of reach"
    LIMITS = "outside the joint limits"
    FILTER = "rejected by a filter of inverse kinematics"
    REGION = "outside the region, as the arm has too few joints"
    SELF_COLLISION = "in collision with itself"
    COLLISION = "in collision"
    CONSTRAINT = "off the constraint"


_ORDER = list(Cause)


class Tally:
    """Sample counts by region and cause. If a sample has several solutions, the cause of the last test reached counts.

    Args:
        names: The names of the regions.

    Attributes:
        shortfall: Returns a description of how far the arm stays from an unreachable region; None if there is none.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self.names = list(names)
        self.shortfall: Callable[[], str] | None = None
        self.counts: list[Counter[Cause | None]] = [Counter() for _ in names]
        self.examples: dict[Cause, RefusedError] = {}
        self._off = (np.inf, 0.0)

    def note(self, region: int, refusals: Sequence["RefusedError"]) -> None:
        """Count a sample: accepted if there are no refusals, else with the refusals of all its solutions."""
        last = max(refusals, key=lambda refused: _ORDER.index(refused.cause), default=None)
        self.counts[region][None if last is None else last.cause] += 1
        if last is None:
            return
        self.examples.setdefault(last.cause, last)
        if last.cause is Cause.CONSTRAINT:
            off = min(refused.off for refused in refusals if refused.cause is Cause.CONSTRAINT)
            self._off = min(self._off[0], off), max(self._off[1], off)

    def named(self) -> dict[str, dict[str, int]]:
        """Return the counts by names of regions and causes; accepted samples are counted as ``reached``."""
        return {
            name: {"reached" if cause is None else cause.value: number for cause, number in counts.items()}
            for name, counts in zip(self.names, self.counts, strict=True)
        }

    def total(self) -> "Counter[Cause | None]":
        """Return the counts over all regions by cause; accepted samples have the key None."""
        return sum(self.counts, Counter[Cause | None]())

    def error(self, name: str) -> "RefusedError":
        """Return the error for regions without any accepted sample, with an example of the most frequent cause.

        ``name`` is the name of the set of regions in the text.
        """
        most = max(self.examples, key=lambda cause: self.total()[cause])
        example = self.examples[most]
        error = RefusedError(name, self.described(), most, values=example.values, findings=example.findings)
        error.tally = self
        return error

    def described(self) -> str:
        """Return the counts as text."""
        total = self.total()
        text = f"{self._text(total)}{self._detail(total)}"
        if len(self.names) < 2:
            return f"{text} (region '{self.names[0]}')" if self.names[0] else text
        regions = [f"'{name}': {self._text(counts)}" for name, counts in zip(self.names, self.counts, strict=True)]
        rest = f"; and {len(regions) - _MOST_REGIONS} more regions" if len(regions) > _MOST_REGIONS else ""
        return f"{text}; by region: {'; '.join(regions[:_MOST_REGIONS])}{rest}"

    def _text(self, counts: "Counter[Cause | None]") -> str:
        drawn = counts.total()
        if not drawn:
            return "no pose was drawn"
        failures = [(cause.value, counts[cause]) for cause in Cause if counts[cause]]
        parts = [f"{name}: {number} of {drawn} poses" for name, number in failures]
        return ", ".join(parts) or f"all {drawn} poses can be reached"

    def _detail(self, total: "Counter[Cause | None]") -> str:
        told: list[str] = []
        if self.shortfall is not None and total[Cause.REACH] == total.total():
            told.append(self.shortfall())
        for cause in (Cause.SELF_COLLISION, Cause.COLLISION):
            findings = self.examples[cause].findings if total[cause] else None
            if findings is not None:
                told.append(f"e.g. {colliding(findings)}")
        if total[Cause.CONSTRAINT] and self._off[1] > 0:
            told.append(f"the constraint is missed by {self._off[0]:.3g} to {self._off[1]:.3g}")
        return f" ({'; '.join(told)})" if told else ""


class RefusedError(Exception):
    """No start or no goal is allowed; the text gives the reason.

    Attributes:
        values: The first rejected configuration, shape (n,); empty if there is none.
        findings: Its collision, or None.
        cause: The cause.
        off: Error norm of a violated constraint; 0 for other causes.
        tally: The counts of rejected samples by cause, or None.
    """

    def __init__(
        self,
        name: str,
        detail: str = "",
        cause: Cause = Cause.LIMITS,
        *,
        values: Floats | None = None,
        findings: Findings | None = None,
        off: float = 0.0,
    ) -> None:
        super().__init__(f"{name}: {detail}" if detail else name)
        self.values = np.zeros(0) if values is None else values
        self.findings, self.cause, self.off = findings, cause, off
        self.tally: Tally | None = None


class Blocked:
    """Test of configurations that stores recently rejected ones.

    Args:
        allowed: The test.
    """

    def __init__(self, allowed: Allowed) -> None:
        self._allowed = allowed
        self._last: deque[Floats] = deque(maxlen=_REMEMBERED)

    def __call__(self, values: Floats) -> bool:
        """Return whether a configuration is allowed."""
        if self._allowed(values):
            return True
        self._last.append(values.copy())
        return False

    def most_frequent(self, conditions: Conditions) -> str:
        """Return the two links that collide most often in recently rejected configurations; empty if none do."""
        pairs = Counter[str]()
        for values in self._last:
            told: list[Findings] = []
            if conditions.violation(values, told=told) in {ENV_COLLISION, SELF_COLLISION}:
                pairs[colliding(told[-1])] += 1
        return pairs.most_common(1)[0][0] if pairs else ""


def refusal(conditions: Conditions, space: Space, allowed: Allowed, values: Floats, name: str) -> RefusedError | None:
    """Return the reason why a configuration cannot be a start or a goal, or None. Use it within ``conditions.kept``.

    ``allowed`` is the test of ``conditions``.
    """
    if not np.isfinite(values).all():
        return RefusedError(name, f"{values.tolist()} should be finite numbers", values=values)
    outside = space.outside(values)
    if outside is not None:
        limits = f"[{space.lower[outside]:g}, {space.upper[outside]:g}]"
        reason = f"{_described(conditions, outside)} is {values[outside]:.6g}, outside its limits {limits}"
        return RefusedError(name, reason, values=values)
    if allowed(values):
        return None
    told: list[Findings] = []
    violated = conditions.violation(values, told=told)
    if violated == USER:
        off = 0.0 if conditions.manifold is None else conditions.manifold.off(values)
        return RefusedError(name, _off(conditions, off), Cause.CONSTRAINT, values=values, off=off)
    if violated:
        cause = Cause.SELF_COLLISION if violated == SELF_COLLISION else Cause.COLLISION
        return RefusedError(name, f"it collides: {colliding(told[-1])}", cause, values=values, findings=told[-1])
    return None


def troubles(bodies: Bodies, values: Floats) -> list[str]:
    """Return all exceeded limits and collisions of a configuration. Use it within ``bodies.kept``."""
    beyond = bodies.beyond_limits(values)
    bodies.move(values)
    pairs = (findings.collisions[0][:2] for findings in bodies.collisions())
    hits = [" hits ".join(geom.body.scene.links[geom.link].name for geom in pair) for pair in pairs]
    return [*([f"beyond limits: {', '.join(beyond)}"] if beyond else []), *hits]


def allowed_ends(
    conditions: Conditions, space: Space, allowed: Allowed, name: str, ends: Sequence[Floats], *, needed: bool
) -> list[Floats]:
    """Return the allowed configurations among starts or goals. Use it within ``conditions.kept``.

    Raises:
        RefusedError: no configuration is allowed; ``ends`` is empty although ``needed``; or a coordinate of the space
            has no limits. The text calls the configurations ``name``.
    """
    endless = np.flatnonzero(~np.isfinite(space.lower) | ~np.isfinite(space.upper))
    if len(endless):
        raise RefusedError(f"{_described(conditions, int(endless[0]))} has no limits, and should have some")
    if not len(ends) and needed:
        raise RefusedError(f"there is no {name}")
    refusals = [refusal(conditions, space, allowed, values, name) for values in ends]
    kept = [values for values, why in zip(ends, refusals, strict=True) if why is None]
    if refusals and not kept:
        assert refusals[0] is not None, "none is allowed"
        raise refusals[0]
    return kept


def _described(conditions: Conditions, index: int) -> str:
    assert conditions.bodies is not None, "something moves"
    return conditions.bodies.described(index)


def _off(conditions: Conditions, off: float) -> str:
    """Describe how far the tool violates the constraint; ``off`` is the error norm."""
    manifold = conditions.manifold
    if manifold is None or off <= manifold.threshold:
        return "a constraint does not allow it"
    return f"the tool is {off:.3g} off its constraint, and should be {manifold.threshold:g} at most"


def colliding(findings: Findings) -> str:
    """Return the names of the first two links that collide."""
    return " with ".join(map(_link, findings.collisions[0][:2]))


def _link(geometry: GeometryOf) -> str:
    scene = geometry.body.scene
    return f"link '{scene.links[geometry.link].name}' of '{scene.name}'"
