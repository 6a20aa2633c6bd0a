"""A glass is carried upright over a wall, so that nothing is spilled.

A constraint of the planner allows only configurations in which the glass leans by less than 15 degrees.
"""

import numpy as np
from stage import BLUE, GREEN, WOOD, add_box, filmed, load_robot, solve_poses, wait

import ravemj

MOST_LEAN = np.radians(15)


def held(y: float) -> np.ndarray:
    """Return a pose of the gripper that points forwards, for a glass at the side of the wall."""
    pose = ravemj.matrixFromAxisAngle([0, np.pi / 2, 0])
    pose[:3, 3] = 0.5, y, 0.45
    return pose


def cylinder(radius: float, height: float) -> ravemj.KinBody.GeometryInfo:
    """Return the shape of the glass."""
    info = ravemj.KinBody.GeometryInfo()
    info._type, info._vGeomData = ravemj.GeometryType.Cylinder, [radius, height]
    info._vDiffuseColor = BLUE
    return info


def main() -> None:
    """Carry the glass from one side of the wall to the other."""
    env = ravemj.Environment()
    robot = load_robot(env, "panda", "panda")
    add_box(env, "table", [0.55, 0, 0.17], [0.15, 0.5, 0.17], WOOD)
    add_box(env, "wall", [0.55, 0, 0.48], [0.15, 0.015, 0.14], GREEN)
    glass = ravemj.RaveCreateKinBody(env, "")
    glass.SetName("glass")
    glass.InitFromGeometries([cylinder(0.03, 0.14)])
    env.Add(glass)

    arm = robot.GetActiveManipulator()
    solve_poses(arm)
    poses = [held(y) for y in (-0.3, 0.3)]
    starts, goals = (arm.FindIKSolutions(pose, ravemj.IkFilterOptions.CheckEnvCollisions) for pose in poses)
    robot.SetActiveDOFs(arm.GetArmIndices())
    robot.SetActiveDOFValues(starts[0])
    glass.SetTransform([1, 0, 0, 0, *poses[0][:3, 3]])
    robot.Grab(glass)

    def lean() -> float:
        return float(np.arccos(min(glass.GetTransform()[2, 2], 1)))

    params = ravemj.Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig(goals.ravel())
    params.add_constraint(lambda values: lean() < MOST_LEAN)  # the robot is there when it is asked
    planner = ravemj.RaveCreatePlanner(env, "birrt")
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    assert planner.InitPlan(robot, params)
    status = planner.PlanPath(trajectory)
    assert status == ravemj.PlannerStatus.HasSolution, status.description
    most = 0.0
    for t in np.linspace(0, trajectory.GetDuration(), 200):
        robot.SetActiveDOFValues(trajectory.Sample(t, robot.GetActiveConfigurationSpecification()))
        most = max(most, lean())
    assert most < MOST_LEAN
    robot.SetActiveDOFValues(starts[0])
    with filmed(env, [0.35, 0, 0.42], [1.6, -0.5, 1.05]):
        robot.GetController().SetPath(trajectory)
        wait(robot)
    print(f"{status.description}; the glass leans by {np.degrees(most):.1f} degrees at most")


if __name__ == "__main__":
    main()
