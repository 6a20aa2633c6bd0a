"""Arms with three prismatic joints in any order among three revolute ones."""

import numpy as np

from ravemj.ik.families.blocks import RigidMotion, Wrist
from ravemj.ik.families.carrying import NoFamilyError
from ravemj.ik.families.loops import Arm, Locked
from ravemj.ik.vectors import Floats, Transform, cross, dot


class Gantry:
    """Arm whose three revolute joints give the orientation, and whose three prismatic joints then give the position."""

    coupled, equations = False, "a quadratic equation"

    def __init__(self, arm: Arm) -> None:
        """Check that the arm belongs to the family.

        Raises:
            NoFamilyError: it does not.
        """
        self.arm, self.order = arm, arm.inner
        screws = [arm.screws[place] for place in self.order]
        self.turning = [index for index, screw in enumerate(screws) if not screw.prismatic]
        self.sliding = [index for index, screw in enumerate(screws) if screw.prismatic]
        if len(self.turning) != 3 or len(self.sliding) != 3 or set(self.order) & arm.locked:
            raise NoFamilyError
        self.screws = screws
        self.wrist = Wrist([screws[index] for index in self.turning], np.zeros((3, 1, 1)))
        self.name, self.shared = "three prismatic joints", True
        self.why = "three other joints give the orientation, and the place is linear in their values"

    def names(self) -> list[tuple[int, int]]:
        """Return index and number of solutions of each joint with several; the first varies fastest over branches."""
        return [(self.order[self.turning[joint]], count) for joint, count in self.wrist.names]

    def solve(self, motion: Transform, locked: Locked) -> list[Floats]:
        """Return the values of the joints in ``order``."""
        turns = self.wrist.solve(RigidMotion(motion.turned, motion.moved))
        values: list[Floats] = [np.zeros((1, 1, 1))] * 6
        for index, turn in zip(self.turning, turns, strict=True):
            values[index] = turn
        place, directions = np.zeros((3, 1, 1)), list[Floats]()
        for screw, value in zip(reversed(self.screws), reversed(values), strict=True):
            place = screw.moved(value, place)
            directions = [screw.turned(value, direction) for direction in directions]
            if screw.prismatic:
                directions.append(screw.axis)
        way = motion.translation - place
        a, b, c = np.broadcast_arrays(*directions[::-1], way)[:3]
        way = np.broadcast_to(way, a.shape)
        volume = dot(a, cross(b, c))
        volume = np.where(volume == 0, np.inf, volume)
        for index, numerator in zip(self.sliding, ((way, b, c), (a, way, c), (a, b, way)), strict=True):
            values[index] = (dot(numerator[0], cross(numerator[1], numerator[2])) / volume)[None]
        return values
