"""A gripper reaches through a window.

The straight way leads through the wall. The planner finds one through the opening, in and out again.
"""

import numpy as np
from stage import GREEN, RED, add_box, filmed, load_robot, solve_poses, wait

import ravemj


def main() -> None:
    """Reach for the ball behind the window, and come back."""
    env = ravemj.Environment()
    robot = load_robot(env, "panda", "panda")
    wall = [  # left, right, below and above of an opening of 34 x 34 cm
        ([0.4, 0.32, 0.45], [0.015, 0.15, 0.45]),
        ([0.4, -0.32, 0.45], [0.015, 0.15, 0.45]),
        ([0.4, 0, 0.19], [0.015, 0.17, 0.19]),
        ([0.4, 0, 0.81], [0.015, 0.17, 0.09]),
    ]
    for number, (centre, half) in enumerate(wall):
        add_box(env, f"wall {number}", centre, half, GREEN)
    add_box(env, "ball", [0.69, 0, 0.55], [0.015, 0.015, 0.015], RED)

    arm = robot.GetActiveManipulator()
    solve_poses(arm)
    robot.SetDOFValues([-1.2, -1.0, 0, -2.6, 0, 1.9, 0.785], arm.GetArmIndices())
    home = arm.GetArmDOFValues()
    planner = ravemj.interfaces.BaseManipulation(robot)
    with filmed(env, [0.3, 0, 0.48], [-0.75, -1.35, 1.25]):
        forward = ravemj.matrixFromAxisAngle([0, np.pi / 2, 0])
        forward[:3, 3] = 0.66, 0, 0.55
        turned = [forward @ ravemj.matrixFromAxisAngle([0, 0, angle]) for angle in np.arange(0, 2 * np.pi, np.pi / 4)]
        planner.MoveToHandPosition(matrices=turned)
        wait(robot)
        reached = np.linalg.norm(arm.GetTransform()[:3, 3] - forward[:3, 3])
        planner.MoveManipulator(home)
        wait(robot)
    print(f"the fingers were {1000 * reached:.0f} mm from where they should be, and are back")


if __name__ == "__main__":
    main()
