"""Arms as closed loops: three joints that form a block, and three others around it.

An arm E1 … E6 has to make a motion X. With the block B anywhere among its joints, A B C = X, so B⁻¹ = C X⁻¹ A: the
joints behind the block, the motion that is asked for, and the joints before it, in a circle. Moving X⁻¹ to the end of
the circle leaves three joints, some of them seen from elsewhere (E(axis) X = X E(X⁻¹ axis)), that have to keep the
block's point or plane. Joints that are locked at a value are constant motions in that circle.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from ravemj.ik.families.blocks import Motion, Planar, Wrist
from ravemj.ik.families.carrying import CarryPlane, CarryPoint, NoFamilyError, Plane
from ravemj.ik.families.pairs import Pair
from ravemj.ik.vectors import Floats, Screw, Transform, tile

Locked = Mapping[int, Floats]
"""Values of locked joints, turns (2, 1, N) or distances (1, 1, N), by their place in the arm."""


@dataclass(frozen=True, eq=False)
class Arm:
    """An arm as a family sees it, lengths in units of its reach.

    Attributes:
        screws: Its joints.
        joints: For each of them its index in the chain; -1 for joints that were added, and have to stay at 0.
        locked: Places of joints whose values are given.
    """

    screws: tuple[Screw, ...]
    joints: tuple[int, ...]
    locked: frozenset[int] = field(default_factory=frozenset[int])

    def trimmed(self, motion: Transform, locked: Locked) -> Transform:
        """Return the motion that is left when locked joints at both ends are taken off."""
        for place in self._ends(range(len(self.screws))):
            motion = self.screws[place].transform(locked[place]).inverse() @ motion
        for place in self._ends(range(len(self.screws) - 1, -1, -1)):
            motion = motion @ self.screws[place].transform(locked[place]).inverse()
        return motion

    def _ends(self, places: Sequence[int]) -> list[int]:
        found: list[int] = []
        for place in places:
            if place not in self.locked:
                break
            found.append(place)
        return found

    @property
    def inner(self) -> list[int]:
        """Places from the first joint that is not locked to the last one."""
        free = [place for place in range(len(self.screws)) if place not in self.locked]
        return list(range(free[0], free[-1] + 1))

    def free(self, places: Sequence[int]) -> list[int]:
        """Return those places whose joints are not locked."""
        return [place for place in places if place not in self.locked]


class Family(Protocol):
    """A way to all solutions of an arm.

    Attributes:
        arm: The arm.
        name: What it is called.
        why: What makes the arm one of its kind.
        order: Places of the joints that it solves for, in the order of its answers.
        coupled: Whether a quartic or a larger equation has to be solved.
        equations: What has to be solved.
        shared: Whether the geometry that counts is the same for all poses, which is faster.
    """

    arm: Arm
    name: str
    why: str
    order: list[int]
    coupled: bool
    equations: str
    shared: bool

    def names(self) -> list[tuple[int, int]]:
        """Return for each choice between solutions the place of the joint and their number, the fastest first."""
        ...

    def solve(self, motion: Transform, locked: Locked) -> list[Floats]:
        """Return the values of the joints of ``order``, turns (2, B, N) or distances (1, B, N); B may be 1 for all."""
        ...


class Circle:
    """The joints around a block, and what they become when the motion is moved out from between them."""

    def __init__(self, arm: Arm, block: int) -> None:
        inner = arm.inner
        self.arm = arm
        self.block = list(range(block, block + 3))
        self.behind, self.before = range(block + 3, inner[-1] + 1), range(inner[0], block)
        self.places = [*arm.free(self.behind), *arm.free(self.before)]
        self.motion_first = len(arm.free(self.before)) > len(arm.free(self.behind))

    def around(self, motion: Transform, locked: Locked) -> tuple[list[Screw], Transform | None, Transform | None]:
        """Return the joints F1, F2, F3 and constants W, K with B⁻¹ = W⁻¹ F1 F2 F3 K; None stands for no motion."""
        seen: Transform | None = motion if self.motion_first else None
        goal = seen
        screws: list[Screw] = []
        for place in self.behind:
            seen = self._pass(place, seen, screws, locked)
        if seen is None or seen is not goal:
            seen = motion.inverse() if seen is None else seen @ motion.inverse()
        else:
            seen = None
        for place in self.before:
            seen = self._pass(place, seen, screws, locked)
        return screws, goal, seen

    def _pass(self, place: int, seen: Transform | None, screws: list[Screw], locked: Locked) -> Transform | None:
        screw = self.arm.screws[place]
        if place not in self.arm.locked:
            screws.append(screw if seen is None else screw.carried(seen))
            return seen
        step = screw.transform(locked[place])
        return step if seen is None else seen @ step


def _turned(transform: Transform | None, vectors: Floats) -> Floats:
    return vectors if transform is None else transform.turned(vectors)


def _moved(transform: Transform | None, points: Floats) -> Floats:
    return points if transform is None else transform.moved(points)


Step = Callable[[Screw, Floats, Floats], Floats]
"""A method of ``Screw`` that moves vectors by a joint value."""


class _Around:
    """The joints around a block with their values: B⁻¹ = W⁻¹ F1 F2 F3 K."""

    def __init__(
        self, screws: Sequence[Screw], values: Sequence[Floats], goal: Transform | None, rest: Transform | None
    ) -> None:
        self._pairs, self._count = list(zip(screws, values, strict=True)), values[0].shape[-2]
        self._goal, self._rest = goal, rest

    def needed(self) -> Motion:
        """Return B = K⁻¹ F3⁻¹ F2⁻¹ F1⁻¹ W."""
        return self._motion(self._goal, self._rest, self._pairs, Screw.turned_back, Screw.moved_back)

    def opposite(self) -> Motion:
        """Return B⁻¹."""
        return self._motion(self._rest, self._goal, self._pairs[::-1], Screw.turned, Screw.moved)

    def _motion(
        self,
        first: Transform | None,
        last: Transform | None,
        pairs: Sequence[tuple[Screw, Floats]],
        turn: Step,
        move: Step,
    ) -> Motion:
        """Return the motion by a transform, then by joints, then by the inverse of another transform."""
        back = None if last is None else last.inverse()

        def turned(vectors: Floats) -> Floats:
            vectors = tile(_turned(first, vectors), self._count)
            for screw, value in pairs:
                vectors = turn(screw, value, vectors)
            return _turned(back, vectors)

        def moved(points: Floats) -> Floats:
            points = tile(_moved(first, points), self._count)
            for screw, value in pairs:
                points = move(screw, value, points)
            return _moved(back, points)

        return Motion(turned, moved)


class BlockFamily:
    """An arm with a block of three joints: a spherical wrist or shoulder, or three parallel axes."""

    def __init__(self, arm: Arm, block: int, inside: Wrist | Planar, examples: tuple[Transform, Locked]) -> None:
        """Find the way of solution from examples of motions.

        Raises:
            NoFamilyError: the geometry is not of this family.
        """
        self.arm, self.inside = arm, inside
        self.circle = Circle(arm, block)
        if len(self.circle.places) != 3:
            raise NoFamilyError
        self.order = [*self.circle.places, *self.circle.block]
        screws, goal, rest = self.circle.around(*examples)
        kept = self._kept(goal, rest)
        self.carry = CarryPoint(screws, *kept[0]) if isinstance(inside, Wrist) else CarryPlane(screws, *kept[1])
        self.coupled, self.equations = _degree(self.carry.pair)
        self.shared = all(screw.shared for screw in screws)
        self.name, self.why = inside.describe([arm.joints[place] for place in self.circle.block])

    def _kept(
        self, goal: Transform | None, rest: Transform | None
    ) -> tuple[tuple[Floats, Floats], tuple[Plane, Plane]]:
        centre = self.inside.centre
        points = _moved(rest, centre), _moved(goal, centre)
        if isinstance(self.inside, Wrist):
            normals = centre, centre
        else:
            normals = _turned(rest, self.inside.normal), _turned(goal, self.inside.normal)
        return points, (Plane(normals[0], points[0]), Plane(normals[1], points[1]))

    def names(self) -> list[tuple[int, int]]:
        """Return for each choice between solutions the place of the joint and their number, the fastest first."""
        around = [(self.circle.places[joint], count) for joint, count in self.carry.names]
        return around + [(self.circle.block[joint], count) for joint, count in self.inside.names]

    def solve(self, motion: Transform, locked: Locked) -> list[Floats]:
        """Return the values of the joints of ``order``."""
        screws, goal, rest = self.circle.around(motion, locked)
        points, planes = self._kept(goal, rest)
        if isinstance(self.carry, CarryPoint):
            values = self.carry.solve(screws, *points)
        else:
            values = self.carry.solve(screws, *planes)
        around = _Around(screws, values, goal, rest)
        backward = isinstance(self.inside, Planar) and self.inside.backward
        return values + self.inside.solve(around.opposite() if backward else around.needed())


def _degree(pair: Pair | None) -> tuple[bool, str]:
    quartic = pair is not None and pair.alone is None and not all(pair.sliding)
    return quartic, "a quartic equation" if quartic else "quadratic equations"


class PointFamily:
    """Three joints that carry the tool to a place, in whatever orientation."""

    def __init__(self, arm: Arm, tool: Floats, examples: tuple[Transform, Locked]) -> None:
        """Find the way of solution from examples; of the motions only the translation counts, the place of the tool.

        Raises:
            NoFamilyError: the joints cannot carry it to any place around.
        """
        self.arm, self.tool = arm, tool
        self.order = arm.free(range(len(arm.screws)))
        if len(self.order) != 3:
            raise NoFamilyError
        motion, locked = examples
        screws, start = self._seen(locked)
        self.carry = CarryPoint(screws, start, motion.translation)
        self.coupled, self.equations = _degree(self.carry.pair)
        self.shared = all(screw.shared for screw in screws)
        self.name, self.why = "position", "three joints carry the tool to a place"

    def _seen(self, locked: Locked) -> tuple[list[Screw], Floats]:
        seen: Transform | None = None
        screws: list[Screw] = []
        for place, screw in enumerate(self.arm.screws):
            if place in self.arm.locked:
                step = screw.transform(locked[place])
                seen = step if seen is None else seen @ step
            else:
                screws.append(screw if seen is None else screw.carried(seen))
        return screws, _moved(seen, self.tool)

    def names(self) -> list[tuple[int, int]]:
        """Return for each choice between solutions the place of the joint and their number, the fastest first."""
        return [(self.order[joint], count) for joint, count in self.carry.names]

    def solve(self, motion: Transform, locked: Locked) -> list[Floats]:
        """Return the values of the joints of ``order``."""
        screws, start = self._seen(locked)
        return self.carry.solve(screws, start, motion.translation)
