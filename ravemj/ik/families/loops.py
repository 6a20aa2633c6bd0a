"""Arms as closed loops: three joints that form a block, and three others around it.

The motion of an arm E1 … E6 must equal X. With the block B anywhere among its joints, A B C = X, so B⁻¹ = C X⁻¹ A: the
joints after the block, the inverse goal, and the joints before it, in a loop. Moving X⁻¹ to the end of the loop leaves
three joints, some of them transformed (E(axis) X = X E(X⁻¹ axis)), that must keep the block's point or plane fixed.
Locked joints are constant motions in the loop.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from ravemj.ik.families.blocks import Planar, RigidMotion, Wrist
from ravemj.ik.families.carrying import CarryPlane, CarryPoint, NoFamilyError, Plane
from ravemj.ik.families.pairs import Pair
from ravemj.ik.vectors import Floats, Screw, Transform, tile

Locked = Mapping[int, Floats]
"""Values of locked joints by position in the arm: cosine and sine (2, 1, N) or distances (1, 1, N)."""


@dataclass(frozen=True, eq=False)
class Arm:
    """Arm as input of a family; lengths are divided by its reach.

    Attributes:
        screws: The joints.
        joints: Index of each joint in the chain; -1 for virtual joints, whose values must be 0.
        locked: Positions of joints whose values are given.
    """

    screws: tuple[Screw, ...]
    joints: tuple[int, ...]
    locked: frozenset[int] = field(default_factory=frozenset[int])

    def trimmed(self, motion: Transform, locked: Locked) -> Transform:
        """Return the motion without the locked joints at both ends."""
        for place in self._ends(range(len(self.screws))):
            motion = self.screws[place].transform(locked[place]).inverse() @ motion
        for place in self._ends(range(len(self.screws) - 1, -1, -1)):
            motion = motion @ self.screws[place].transform(locked[place]).inverse()
        return motion

    def _ends(self, places: Sequence[int]) -> list[int]:
        ends: list[int] = []
        for place in places:
            if place not in self.locked:
                break
            ends.append(place)
        return ends

    @property
    def inner(self) -> list[int]:
        """Positions from the first to the last joint that is not locked."""
        free = [place for place in range(len(self.screws)) if place not in self.locked]
        return list(range(free[0], free[-1] + 1))

    def free(self, places: Sequence[int]) -> list[int]:
        """Return the positions in ``places`` whose joints are not locked."""
        return [place for place in places if place not in self.locked]


class Family(Protocol):
    """Method that finds all solutions of a kind of arm.

    Attributes:
        arm: The arm.
        name: The name of the family.
        why: The property that makes the arm a member.
        order: Positions of the joints to solve for, in the order of the results.
        coupled: Whether it solves a quartic or an equation of higher degree.
        equations: Description of the equations.
        shared: Whether the relevant geometry is the same for all poses, which is faster.
    """

    arm: Arm
    name: str
    why: str
    order: list[int]
    coupled: bool
    equations: str
    shared: bool

    def names(self) -> list[tuple[int, int]]:
        """Return index and number of solutions of each joint with several; the first varies fastest over branches."""
        ...

    def solve(self, motion: Transform, locked: Locked) -> list[Floats]:
        """Return values of the joints in ``order``: cosine and sine (2, B, N) or distances (1, B, N); B may be 1."""
        ...


class Circle:
    """Joints around a block, transformed so that the goal motion is moved to the end of the loop."""

    def __init__(self, arm: Arm, block: int) -> None:
        inner = arm.inner
        self.arm = arm
        self.block = list(range(block, block + 3))
        self.behind, self.before = range(block + 3, inner[-1] + 1), range(inner[0], block)
        self.places = [*arm.free(self.behind), *arm.free(self.before)]
        self.motion_first = len(arm.free(self.before)) > len(arm.free(self.behind))

    def around(self, motion: Transform, locked: Locked) -> tuple[list[Screw], Transform | None, Transform | None]:
        """Return the joints F1, F2, F3 and constants W, K with B⁻¹ = W⁻¹ F1 F2 F3 K; None means the identity."""
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
"""Method of ``Screw`` that moves vectors, given a joint value."""


class _Around:
    """The joints F1, F2, F3 outside of a block, their values, and the constants ``goal`` and ``rest`` of the loop.

    The block's motion B satisfies B⁻¹ = goal⁻¹ F1 F2 F3 rest.
    """

    def __init__(
        self, screws: Sequence[Screw], values: Sequence[Floats], goal: Transform | None, rest: Transform | None
    ) -> None:
        self._pairs, self._count = list(zip(screws, values, strict=True)), values[0].shape[-2]
        self._goal, self._rest = goal, rest

    def needed(self) -> RigidMotion:
        """Return the motion that the block must make: rest⁻¹ F3⁻¹ F2⁻¹ F1⁻¹ goal."""
        return self._motion(self._goal, self._rest, self._pairs, Screw.turned_back, Screw.moved_back)

    def opposite(self) -> RigidMotion:
        """Return the inverse of the motion that the block must make."""
        return self._motion(self._rest, self._goal, self._pairs[::-1], Screw.turned, Screw.moved)

    def _motion(
        self,
        first: Transform | None,
        last: Transform | None,
        pairs: Sequence[tuple[Screw, Floats]],
        turn: Step,
        move: Step,
    ) -> RigidMotion:
        """Return the motion that applies ``first``, then each joint of ``pairs``, then the inverse of ``last``.

        A joint moves vectors by the method ``turn``, points by ``move``.
        """
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

        return RigidMotion(turned, moved)


class BlockFamily:
    """Arm with a block of three joints: a spherical wrist or shoulder, or three parallel axes."""

    def __init__(self, arm: Arm, block: int, inside: Wrist | Planar, examples: tuple[Transform, Locked]) -> None:
        """Find the solution method from examples of motions.

        Raises:
            NoFamilyError: the geometry does not belong to this family.
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
        """Return index and number of solutions of each joint with several; the first varies fastest over branches."""
        around = [(self.circle.places[joint], count) for joint, count in self.carry.names]
        return around + [(self.circle.block[joint], count) for joint, count in self.inside.names]

    def solve(self, motion: Transform, locked: Locked) -> list[Floats]:
        """Return the values of the joints in ``order``."""
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
    """Three joints that carry the tool to a position, in any orientation."""

    def __init__(self, arm: Arm, tool: Floats, examples: tuple[Transform, Locked]) -> None:
        """Find the solution method from examples of motions, of which only the translation matters.

        Raises:
            NoFamilyError: the joints cannot carry the tool to arbitrary positions.
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
        """Return index and number of solutions of each joint with several; the first varies fastest over branches."""
        return [(self.order[joint], count) for joint, count in self.carry.names]

    def solve(self, motion: Transform, locked: Locked) -> list[Floats]:
        """Return the values of the joints in ``order``."""
        screws, start = self._seen(locked)
        return self.carry.solve(screws, start, motion.translation)
