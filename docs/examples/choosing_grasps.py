"""A box is taken out of a shelf: of many grasps, the planner takes one that can be reached.

The boards of the shelf rule most of them out. The same list of grasps serves for putting the box down, since it is held
the same way: only one is left then.
"""

import numpy as np
from stage import GREEN, RED, WOOD, add_box, filmed, load_robot, solve_poses, wait

import ravemj

BOX = np.array([0.6, 0.15, 0.45])
TABLE = np.array([0.25, -0.5, 0.5])


def grasps() -> list[np.ndarray]:
    """Return poses of the gripper in the box: from six sides, each turned in four ways."""
    sides = [[0, 0, 0], [0, np.pi / 2, 0], [0, np.pi, 0], [0, -np.pi / 2, 0], [np.pi / 2, 0, 0], [-np.pi / 2, 0, 0]]
    turns = [[0, 0, angle] for angle in np.arange(4) * np.pi / 2]
    return [ravemj.matrixFromAxisAngle(side) @ ravemj.matrixFromAxisAngle(turn) for side in sides for turn in turns]


def main() -> None:
    """Take the box out of the shelf, and put it onto the table."""
    env = ravemj.Environment()
    robot = load_robot(env, "panda", "panda")
    arm = robot.GetActiveManipulator()
    solve_poses(arm)
    for number, (centre, half) in enumerate(
        (
            ([0.65, 0.15, 0.39], [0.15, 0.25, 0.01]),
            ([0.65, 0.15, 0.75], [0.15, 0.25, 0.01]),
            ([0.65, 0.41, 0.57], [0.15, 0.01, 0.19]),
            ([0.65, -0.11, 0.57], [0.15, 0.01, 0.19]),
            ([0.81, 0.15, 0.57], [0.01, 0.25, 0.19]),
        )
    ):
        add_box(env, f"board {number}", centre, half, GREEN)
    add_box(env, "table", [*TABLE[:2], 0.225], [0.04, 0.04, 0.225], WOOD)
    box = add_box(env, "box", BOX, [0.025, 0.025, 0.049], RED)

    planner, fingers = ravemj.interfaces.BaseManipulation(robot), ravemj.interfaces.TaskManipulation(robot)
    with filmed(env, [0.35, -0.1, 0.42], [-0.45, -1.4, 1.1]):
        planner.MoveToHandPosition(matrices=[box.GetTransform() @ grasp for grasp in grasps()])
        wait(robot)
        T_box_hand = np.linalg.inv(box.GetTransform()) @ arm.GetTransform()
        fingers.CloseFingers()
        wait(robot)
        robot.Grab(box)
        places = []
        for angle in np.arange(16) * np.pi / 8:
            T_world_box = ravemj.matrixFromAxisAngle([0, 0, angle])
            T_world_box[:3, 3] = TABLE + np.array([0, 0, 0.001])
            places.append(T_world_box @ T_box_hand)
        planner.MoveToHandPosition(matrices=places)
        wait(robot)
        fingers.ReleaseFingers(target=box)
        wait(robot)
    number = int(np.argmin([np.abs(T_box_hand - grasp).max() for grasp in grasps()]))
    print(f"grasp {number + 1} of {len(grasps())}; the box stands at", box.GetTransform()[:3, 3].round(3))


if __name__ == "__main__":
    main()
