"""The towers of Hanoi: a Panda moves three slabs from the first plate to the third, no larger one on a smaller one."""

from collections.abc import Iterator

import numpy as np
from stage import BLUE, RED, WOOD, YELLOW, add_box, filmed, load_robot, solve_poses, wait

import ravemj

THICKNESS = 0.04
PLATES = np.array([[0.5, -0.25, 0.1], [0.5, 0.0, 0.1], [0.5, 0.25, 0.1]])
"""Where slabs lie: the middle of each plate's upper side [m]."""


def moves(count: int, source: int, target: int) -> Iterator[tuple[int, int]]:
    """Yield from which plate to which one slabs go, so that a tower of some slabs moves."""
    if count:
        other = 3 - source - target
        yield from moves(count - 1, source, other)
        yield source, target
        yield from moves(count - 1, other, target)


class Mover:
    """A robot that carries slabs from plate to plate."""

    def __init__(self, robot: ravemj.Robot) -> None:
        self.robot, self.arm = robot, robot.GetActiveManipulator()
        self.planner = ravemj.interfaces.BaseManipulation(robot)
        self.fingers = ravemj.interfaces.TaskManipulation(robot)

    def go_to(self, place: np.ndarray) -> None:
        """Plan a way to 10 cm above a place, and go straight down."""
        down = ravemj.matrixFromAxisAngle([np.pi, 0, 0])
        down[:3, 3] = place + np.array([0, 0, 0.1])
        self.planner.MoveToHandPosition(matrices=[down])
        wait(self.robot)
        self.straight(-1)

    def straight(self, direction: float) -> None:
        """Go 10 cm up or down."""
        self.planner.MoveHandStraight([0, 0, direction], stepsize=0.01, minsteps=10, maxsteps=10)
        wait(self.robot)

    def grab(self, slab: ravemj.KinBody) -> None:
        """Close the gripper around a slab, and lift it."""
        self.fingers.CloseFingers()
        wait(self.robot)
        self.robot.Grab(slab)
        self.straight(1)

    def release(self, slab: ravemj.KinBody) -> None:
        """Let go of a slab, and leave it."""
        self.fingers.ReleaseFingers(target=slab)
        wait(self.robot)
        self.straight(1)


def main() -> None:
    """Move the tower."""
    env = ravemj.Environment()
    mover = Mover(load_robot(env, "panda", "panda"))
    solve_poses(mover.arm)
    for number, plate in enumerate(PLATES):
        add_box(env, f"plate {number}", plate - [0, 0, 0.051], [0.1, 0.1, 0.05], WOOD)
    towers: list[list[ravemj.KinBody]] = [[], [], []]
    for level, (half, colour) in enumerate(((0.036, RED), (0.028, YELLOW), (0.02, BLUE))):
        centre = PLATES[0] + [0, 0, (level + 0.5) * THICKNESS + 0.001 * level]
        towers[0].append(add_box(env, f"slab {level}", centre, [half, half, THICKNESS / 2 - 0.0005], colour))
    with filmed(env, [0.32, 0, 0.3], [1.35, -0.7, 0.95], fps=5):
        for source, target in moves(3, 0, 2):
            slab = towers[source].pop()
            mover.go_to(slab.GetTransform()[:3, 3])
            mover.grab(slab)
            mover.go_to(PLATES[target] + [0, 0, (len(towers[target]) + 0.5) * THICKNESS + 0.001 * len(towers[target])])
            mover.release(slab)
            towers[target].append(slab)
    heights = [round(float(slab.GetTransform()[2, 3]), 2) for slab in towers[2]]
    print(f"{len(towers[2])} slabs are on the third plate, at heights {heights}")


if __name__ == "__main__":
    main()
