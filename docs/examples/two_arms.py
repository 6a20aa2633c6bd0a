"""Two arms change places without touching each other.

Both are planned at once: a configuration has the joint values of both robots, fourteen numbers.
"""

import numpy as np
from stage import filmed, load_robot, wait

import ravemj

STRETCHED = np.array([-0.6, 0.9, 0, -1.6, 0, 2.4, 0.785])
FOLDED = np.array([-0.6, -0.5, 0, -2.6, 0, 2.0, 0.785])
"""Where the left arm reaches over to the right; the right arm does the same in a mirror."""
MIRROR = np.array([-1, 1, 1, 1, 1, 1, 1])


def main() -> None:
    """Let one arm that reaches in front of the other draw back, and the other one reach."""
    env = ravemj.Environment()
    left = load_robot(env, "panda", "left", [0, 0.35, 0])
    right = load_robot(env, "panda", "right", [0, -0.35, 0])
    robots, goals = (left, right), (FOLDED, STRETCHED * MIRROR)
    for robot, start in zip(robots, (STRETCHED, FOLDED * MIRROR), strict=True):
        robot.SetActiveDOFs(range(7))
        robot.SetActiveDOFValues(start)
        robot.SetDOFVelocityLimits(0.5 * robot.GetDOFVelocityLimits())

    params = ravemj.Planner.PlannerParameters()
    spec = left.GetActiveConfigurationSpecification() + right.GetActiveConfigurationSpecification()
    params.SetConfigurationSpecification(env, spec)
    params.SetGoalConfig(np.concatenate(goals))
    planner = ravemj.RaveCreatePlanner(env, "birrt")
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    planner.InitPlan(None, params)
    status = planner.PlanPath(trajectory)
    assert status == ravemj.PlannerStatus.HasSolution, status.description
    with filmed(env, [0.25, 0, 0.35], [1.5, 0, 1.05]):
        for robot in robots:
            robot.GetController().SetPath(trajectory)
        wait(*robots)
    for robot, goal in zip(robots, goals, strict=True):
        assert np.allclose(robot.GetActiveDOFValues(), goal)
    print(f"{status.description}; {trajectory.GetDuration():.1f} s of motion")


if __name__ == "__main__":
    main()
