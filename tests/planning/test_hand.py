"""Motions of the hand: along a trajectory, to grasps, on constraints. The poses of the tool are the truth."""

import numpy as np
import pytest

import ravemj
from ravemj import IkParameterization, Planner, PlannerStatus, planningutils
from ravemj.planning.space import Coordinates, Space
from ravemj.planning.tracking import track
from ravemj.trajectories.serialization import AS_TEXT

READY = [-0.1, 0.7, -2.7, 0.0, -0.7, -0.8]
POSE = IkParameterization.Type.Transform6D


@pytest.fixture
def robot():
    env = ravemj.load(ravemj.model_path("puma560"))
    arm = env.GetRobots()[0]
    manip = arm.GetActiveManipulator()
    ravemj.databases.inversekinematics.InverseKinematicsModel(arm, iktype=POSE).load()
    arm.SetActiveDOFs(manip.GetArmIndices())
    arm.SetActiveDOFValues(READY)
    return arm


def box(env, name, centre, half):
    body = ravemj.RaveCreateKinBody(env, "")
    body.InitFromBoxes([[0, 0, 0, *half]])
    body.SetName(name)
    env.Add(body)
    body.SetTransform([1, 0, 0, 0, *centre])
    return body


def tool_at(robot, values):
    with robot:
        robot.SetActiveDOFValues(values)
        return robot.GetActiveManipulator().GetTransform()


def waypoints(robot, trajectory):
    return trajectory.GetAllWaypoints2D(robot.GetActiveConfigurationSpecification())


def poses_of_hand(robot, far):
    """Return three poses of the tool: to the side, upwards, and turning."""
    poses = []
    for part in (0.0, 0.5, 1.0):
        pose = robot.GetActiveManipulator().GetTransform()
        pose[:3, 3] += [0, far * part, 0.04 * part * part]
        pose[:3, :3] = pose[:3, :3] @ ravemj.rotationMatrixFromAxisAngle([0, 0, 0.4 * part])
        poses.append(pose)
    return poses


def way_of_hand(robot, *, seconds=1.0, far=0.12, above=0.0, affine=False):
    """Return a trajectory of the tool through these poses, as goals or as poses of any body."""
    if affine:
        spec = ravemj.RaveGetAffineConfigurationSpecification(39, None, "linear")
    else:
        spec = IkParameterization.GetConfigurationSpecificationFromType(POSE, "linear")
    spec.AddDeltaTimeGroup()
    trajectory = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    trajectory.Init(spec)
    for number, pose in enumerate(poses_of_hand(robot, far)):
        wxyz, position = np.split(ravemj.poseFromMatrix(pose), [4])
        position[2] += above
        numbers = [*position, *wxyz] if affine else [*wxyz, *position]
        trajectory.Insert(number, [*numbers, seconds / 2 if number else 0.0], spec)
    return trajectory


def followed(robot, way, extra="<_fsteplength>0.02</_fsteplength>"):
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetExtraParameters(f"<workspacetrajectory>{way.serialize(AS_TEXT).decode()}</workspacetrajectory>{extra}")
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), "WorkspaceTrajectoryTracker")
    planner.InitPlan(robot, params)
    result = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    return planner.PlanPath(result), result


@pytest.mark.parametrize("affine", [False, True])
def test_the_hand_is_where_its_trajectory_says_at_each_step(robot, affine):
    way = way_of_hand(robot, affine=affine)
    status, trajectory = followed(robot, way)
    assert status == PlannerStatus.HasSolution, status.description
    rows = waypoints(robot, trajectory)
    assert rows[0] == pytest.approx(READY)
    assert len(rows) == 51
    found, poses = [tool_at(robot, row) for row in rows], poses_of_hand(robot, 0.12)
    assert found[::25] == pytest.approx(np.array(poses), abs=1e-6)
    for number, pose in enumerate(found):
        part, (start, end) = number / 25 % 1, (poses[number // 25], poses[min(number // 25 + 1, 2)])
        assert pose[:3, 3] == pytest.approx((1 - part) * start[:3, 3] + part * end[:3, 3], abs=1e-6)
    assert np.abs(np.diff(rows, axis=0)).max() < 0.1
    assert robot.GetActiveDOFValues() == pytest.approx(READY)
    planningutils.VerifyTrajectory(None, trajectory, 0.01)


def test_times_are_kept_where_the_joints_are_fast_enough(robot):
    way, keep = way_of_hand(robot), "<_fsteplength>0.02</_fsteplength><maintaintiming>1</maintaintiming>"
    status, trajectory = followed(robot, way, keep)
    assert status == PlannerStatus.HasSolution, status.description
    assert trajectory.GetDuration() == pytest.approx(1.0)
    status, _ = followed(robot, way_of_hand(robot, seconds=0.02), keep.replace("0.02", "0.001"))
    assert "no solution of inverse kinematics (IK) continues the motion" in status.description


def test_the_hand_stops_before_what_is_in_its_way(robot):
    way = way_of_hand(robot)
    post = box(robot.GetEnv(), "post", poses_of_hand(robot, 0.12)[-1][:3, 3], [0.02, 0.02, 0.02])
    status, _ = followed(robot, way)
    assert status == PlannerStatus.Failed
    assert "of 1 s: no solution" in status.description
    assert robot.GetActiveDOFValues() == pytest.approx(READY)
    step = "<_fsteplength>0.02</_fsteplength>"
    status, part = followed(robot, way, f"{step}<minimumcompletetime>0.1</minimumcompletetime>")
    assert status == PlannerStatus.HasSolution
    assert 5 <= part.GetNumWaypoints() < 51
    for row in waypoints(robot, part):
        with robot:
            robot.SetActiveDOFValues(row)
            assert not robot.GetEnv().CheckCollision(robot, post)
    status, _ = followed(robot, way, f"{step}<ignorefirstcollision>2</ignorefirstcollision>")
    assert status == PlannerStatus.HasSolution


def test_what_cannot_be_followed_says_why(robot):
    way = way_of_hand(robot)
    assert followed(robot, way_of_hand(robot, far=3.0))[0].description.startswith("the hand gets to ")
    nowhere = "<_fsteplength>0.02</_fsteplength><minimumcompletetime>0</minimumcompletetime>"
    assert "gets to 0 s of" in followed(robot, way_of_hand(robot, above=3.0), nowhere)[0].description
    for junk in ("", "junk", "<trajectory/>"):
        params = Planner.PlannerParameters()
        params.SetRobotActiveJoints(robot)
        params.SetExtraParameters(f"<workspacetrajectory>{junk}</workspacetrajectory>")
        assert not ravemj.RaveCreatePlanner(robot.GetEnv(), "workspacetrajectorytracker").InitPlan(robot, params)
    for step in ("0", "-1", "1e-9"):
        assert "_fsteplength: is " in followed(robot, way, f"<_fsteplength>{step}</_fsteplength>")[0].description
    robot.SetActiveDOFs([0, 1])
    assert "should be those of the arm" in followed(robot, way)[0].description
    robot.SetActiveDOFs(range(6))
    empty = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    empty.Init(robot.GetActiveConfigurationSpecification())
    assert "has no waypoints" in followed(robot, empty)[0].description
    robot.GetActiveManipulator().SetIkSolver(None)
    assert "has no solver of inverse kinematics" in followed(robot, way)[0].description
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    assert not ravemj.RaveCreatePlanner(robot.GetEnv(), "workspacetrajectorytracker").InitPlan(robot, params)


def test_a_branch_that_ends_does_no_harm():
    """Two branches of solutions, the nearer of which ends after three goals."""
    space = Space(Coordinates(np.zeros(1, dtype=bool)), *(np.array([one]) for one in (-9.0, 9.0, 1.0, 0.1)))

    def solve(number, near):
        return [np.array([5.0 + number])] + ([np.array([0.1 * number])] if number < 3 else [])

    def connects(number, before, after):
        return abs(after[0] - before[0]) < 1.5

    assert track(space, 5, np.zeros(1), solve, connects).ravel() == pytest.approx([5, 6, 7, 8, 9])
    assert track(space, 3, np.zeros(1), solve, connects).ravel() == pytest.approx([0, 0.1, 0.2])
    assert track(space, 3, np.zeros(1), lambda number, near: [], connects).shape == (0, 1)


# ------------------------------------------------------------------------------------------------------- grasps


def descended(robot, target, grasps, extra=""):
    numbers = " ".join(repr(float(value)) for grasp in grasps for value in ravemj.poseFromMatrix(grasp))
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    tags = f"<target>{target}</target><grasps>{len(grasps)} {numbers}</grasps>"
    params.SetExtraParameters(f"{tags}<_nmaxiterations>400</_nmaxiterations>{extra}")
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), "GraspGradient")
    planner.InitPlan(robot, params)
    trajectory = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    return planner, planner.PlanPath(trajectory), trajectory


@pytest.fixture
def target(robot):
    """Return a box before the hand, with a free way to it."""
    place = robot.GetActiveManipulator().GetTransform() @ [0.1, 0.05, 0.15, 1]
    return box(robot.GetEnv(), "target", place[:3], [0.02, 0.02, 0.02])


def grasp_from(robot, target, back):
    """Return ``T_target_tool`` of a hand that points as it does now, some way before the target."""
    pose = robot.GetActiveManipulator().GetTransform()
    pose[:3, 3] = target.GetTransform()[:3, 3] - back * pose[:3, 2]
    return np.linalg.inv(target.GetTransform()) @ pose


def test_the_hand_goes_down_the_gradient_to_the_nearest_grasp(robot, target):
    near, far = grasp_from(robot, target, 0.1), grasp_from(robot, target, 0.1)
    far[2, 3] += 5.0
    planner, status, trajectory = descended(robot, "target", [far, near])
    assert status == PlannerStatus.HasSolution, status.description
    assert planner.SendCommand("GetGoalIndex") == "1"
    reached = tool_at(robot, waypoints(robot, trajectory)[-1])
    assert reached == pytest.approx(target.GetTransform() @ near, abs=1e-5)
    planningutils.VerifyTrajectory(None, trajectory, 0.01)
    assert robot.GetActiveDOFValues() == pytest.approx(READY)


def test_grasps_that_cannot_be_reached_say_why(robot, target):
    far = grasp_from(robot, target, 0.1)
    far[2, 3] += 1.0
    assert "no step came nearer after" in descended(robot, "target", [far])[1].description
    assert "there is no body 'cup'" in descended(robot, "cup", [far])[1].description
    assert "<grasps>: should be" in descended(robot, "target", [])[1].description
    wrong = "<grasps>2 1 0 0 0 1 2 3</grasps>"
    assert "<grasps>: should be" in descended(robot, "target", [far], wrong)[1].description


def listed(*poses):
    return np.array([pose[:3].T.ravel() for pose in poses])


def test_one_of_several_grasps_is_reached_before_the_target(robot, target):
    helper = ravemj.interfaces.TaskManipulation(robot)
    near, far = grasp_from(robot, target, 0.06), grasp_from(robot, target, 0.06)
    far[2, 3] += 5.0
    goals, index, seconds, trajectory = helper.GraspPlanning(
        graspindices={"igrasptrans": 0},
        grasps=listed(far, near),
        target=target,
        approachoffset=0.04,
        destposes=[[1, 0, 0, 0, *(target.GetTransform()[:3, 3] + [0, -0.1, 0.05])], np.eye(4)],
        execute=False,
        outputtrajobj=True,
    )
    grasp = target.GetTransform() @ near
    assert (index, seconds > 0) == (1, True)
    reached = tool_at(robot, waypoints(robot, trajectory)[-1])
    assert reached[:3, :3] == pytest.approx(grasp[:3, :3], abs=1e-6)
    assert reached[:3, 3] == pytest.approx(grasp[:3, 3] - 0.04 * grasp[:3, 2], abs=1e-6)
    (goal,) = goals  # the other place is in the robot's own base
    assert goal.GetTransform6D()[:3, 3] == pytest.approx(grasp[:3, 3] + [0, -0.1, 0.05])
    assert robot.GetActiveDOFValues() == pytest.approx(READY)
    assert target.IsEnabled()
    planningutils.VerifyTrajectory(None, trajectory, 0.01)


def test_grasps_by_command_and_by_a_model(robot, target):
    env = robot.GetEnv()
    env.StopSimulation()
    pose = grasp_from(robot, target, 0.06)
    module = ravemj.RaveCreateModule(env, "TaskManipulation")
    env.Add(module, True, robot.GetName())
    numbers = " ".join(repr(float(value)) for value in listed(pose).ravel())
    grasps = f"target target igrasptrans 0 grasps 1 12 {numbers}"
    words = module.SendCommand(f"GraspPlanning {grasps} execute 0 outputtraj").split(maxsplit=3)
    assert words[:2] == ["0", "0"]
    spec = robot.GetActiveConfigurationSpecification()
    planned = ravemj.RaveCreateTrajectory(env, "").deserialize(words[3])
    assert tool_at(robot, planned.GetWaypoint(-1, spec)) == pytest.approx(target.GetTransform() @ pose, abs=1e-6)

    class Model:
        graspindices, grasps, target = {"igrasptrans": 0}, listed(pose), env.GetKinBody("target")

    helper = ravemj.interfaces.TaskManipulation(robot)
    goals, index, _, nothing = helper.GraspPlanning(gmodel=Model())
    assert (goals, index, nothing) == ([], 0, None)
    while not robot.GetController().IsDone():
        env.StepSimulation(0.05)
    here = robot.GetActiveManipulator().GetTransform()
    assert here == pytest.approx(target.GetTransform() @ pose, abs=1e-6)
    assert module.SendCommand(f"GraspPlanning {grasps.replace('target target', 'target cup')}") is None


def test_grasps_that_are_refused_say_why(robot, target):
    helper = ravemj.interfaces.TaskManipulation(robot)
    touching = grasp_from(robot, target, -0.01)
    with pytest.raises(ravemj.PlanningError, match="no grasp can be reached without collisions"):
        helper.GraspPlanning({"igrasptrans": 0}, listed(touching), target)
    with pytest.raises(ravemj.openrave_exception, match="should have 'igrasptrans'"):
        helper.GraspPlanning({}, listed(touching), target)
    with pytest.raises(ravemj.openrave_exception, match="'igrasptrans' is 5, and grasps have 12 numbers"):
        helper.GraspPlanning({"igrasptrans": 5}, listed(touching), target)
    with pytest.raises(ravemj.openrave_exception, match=r"'igrasptrans' of grasp 0 is .*nan.* should be finite"):
        helper.GraspPlanning({"igrasptrans": 0}, listed(touching) * np.nan, target)
    with pytest.raises(ravemj.openrave_exception, match="target: is None"):
        helper.GraspPlanning({"igrasptrans": 0}, listed(touching), None)
    robot.Grab(target)
    with pytest.raises(ravemj.openrave_exception, match="holds 'target' already"):
        helper.GraspPlanning({"igrasptrans": 0}, listed(touching), target)


# -------------------------------------------------------------------------------------------------- constraints


@pytest.mark.parametrize("freedoms", [[1, 1, 0, 0, 0, 0], [0, 0, 0, 0, 0, 1], [1, 1, 1, 1, 0, 1], [1] * 6])
def test_configurations_on_a_constraint_keep_what_it_holds(robot, freedoms):
    """In the frame of the tool, what is held is zero; what is free stays near where it was."""
    helper = ravemj.interfaces.TaskManipulation(robot)
    start = robot.GetActiveManipulator().GetTransform()
    random = np.random.default_rng(3)
    configurations = READY + random.uniform(-0.3, 0.3, (5, 6))
    steps, rows = helper.EvaluateConstraints(
        freedoms, configurations, targetframematrix=np.linalg.inv(start), errorthresh=1e-6
    )
    assert (steps >= 1).all()
    assert rows.shape == (5, 6)
    for row in rows:
        moved = np.linalg.inv(start) @ tool_at(robot, row)
        error = np.append(ravemj.axisAngleFromRotationMatrix(moved[:3, :3]), moved[:3, 3])
        assert np.abs(error * freedoms).max() < 1e-6
    assert robot.GetActiveDOFValues() == pytest.approx(READY)


def test_constraints_that_hold_already_need_no_step_and_others_are_never_kept(robot):
    helper = ravemj.interfaces.TaskManipulation(robot)
    start = robot.GetActiveManipulator().GetTransform()
    steps, rows = helper.EvaluateConstraints([1] * 6, [READY], np.linalg.inv(start))
    assert (steps.tolist(), rows.tolist()) == ([0], [READY])
    away = start.copy()
    away[:3, 3] += 5.0
    assert helper.EvaluateConstraints([1] * 6, [READY], np.linalg.inv(away))[0].tolist() == [-1]
    robot.SetActiveDOFs([0, 1])
    with pytest.raises(ravemj.openrave_exception, match="should be those of the arm"):
        helper.EvaluateConstraints([1] * 6, [[0, 0]])


def moved_tool(robot, trajectory, frame=None, point=None):
    """Return rotation vectors and ways of ``frame @ T_world_tool @ point`` at many times of a motion, shape (m, 6)."""
    spec, found = robot.GetActiveConfigurationSpecification(), []
    for time in np.linspace(0, trajectory.GetDuration(), 600):
        tool = tool_at(robot, trajectory.Sample(time, spec))
        moved = (np.eye(4) if frame is None else frame) @ tool @ (np.eye(4) if point is None else point)
        found.append([*ravemj.axisAngleFromRotationMatrix(moved[:3, :3]), *moved[:3, 3]])
    return np.array(found)


def beside_a_wall(robot):
    """Put a wall in the way; return the present pose of the tool, and one behind the wall."""
    here = robot.GetActiveManipulator().GetTransform()
    there = here.copy()
    there[1, 3] += 0.35
    box(robot.GetEnv(), "wall", here[:3, 3] + [0, 0.17, 0], [0.05, 0.02, 0.6])
    return here, there


def test_a_cup_is_carried_upright_around_a_wall(robot):
    here, there = beside_a_wall(robot)
    for joint in robot.GetJoints():
        joint.SetResolution(0.01)  # else a line may graze the wall between two tests
    there[:3, :3] = ravemj.rotationMatrixFromAxisAngle([0, 0, 0.3]) @ there[:3, :3]
    upright = np.linalg.inv(here)
    found = ravemj.interfaces.BaseManipulation(robot).MoveToHandPosition(
        matrices=[there],
        constraintfreedoms=[1, 1, 0, 0, 0, 0],
        execute=False,
        outputtrajobj=True,
    )
    error = moved_tool(robot, found, point=upright)
    assert np.linalg.norm(error[:, :2], axis=1).max() <= 1e-3
    assert np.abs(error[:, 3:]).max() > 0.2, "that of the goal is 0.13: there is a detour"
    rows = waypoints(robot, found)
    assert rows[0] == pytest.approx(READY)
    assert tool_at(robot, rows[-1]) == pytest.approx(there, abs=1e-6)
    assert robot.GetActiveDOFValues() == pytest.approx(READY)
    planningutils.VerifyTrajectory(None, found, 0.01)


@pytest.mark.stress
def test_the_tool_moves_in_a_plane_by_command(robot):
    here, there = beside_a_wall(robot)
    plane = np.eye(4)
    plane[:3, 3] = -here[:3, 3]
    module = ravemj.RaveCreateModule(robot.GetEnv(), "basemanipulation")
    robot.GetEnv().Add(module, True, robot.GetName())
    goal, frame = (ravemj.matrixSerialization(pose) for pose in (there, plane))
    constraint = f"constraintmatrix {frame} constraintfreedoms 0 0 0 0 0 1 constrainterrorthresh 0.01"
    reply = module.SendCommand(f"MoveToHandPosition matrix {goal} {constraint} execute 0 outputtraj")
    found = ravemj.RaveCreateTrajectory(robot.GetEnv(), "").deserialize(reply.split(maxsplit=1)[1])
    error = moved_tool(robot, found, frame=plane)
    assert np.abs(error[:, 5]).max() <= 0.01
    assert np.abs(error[:, :3] - error[0, :3]).max() > 0.05  # it turns as it likes
    planningutils.VerifyTrajectory(None, found, 0.01)


def test_a_constraint_that_is_kept_by_neither_end_is_not_planned_for(robot):
    helper = ravemj.interfaces.BaseManipulation(robot)
    here = robot.GetActiveManipulator().GetTransform()
    higher = here.copy()
    higher[2, 3] += 0.1
    held = {"constraintfreedoms": [0, 0, 0, 0, 0, 1], "constrainttaskmatrix": np.eye(4)}
    held["constraintmatrix"] = np.linalg.inv(here)
    with pytest.raises(ravemj.PlanningError, match=r"goal: the tool is 0\.\d+ off its constraint, and"):
        helper.MoveToHandPosition(matrices=[higher], execute=False, **held)
    held["constraintmatrix"] = np.linalg.inv(higher)
    with pytest.raises(ravemj.PlanningError, match="start: the tool is"):
        helper.MoveToHandPosition(matrices=[higher], execute=False, **held)


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ({"constrainterrorthresh": 0.01}, "needs constraintfreedoms"),
        ({"constraintfreedoms": [1, 1, 0]}, "constraintfreedoms: has shape"),
        ({"constraintfreedoms": [1, 1, 0, 0, 0, np.nan]}, "constraintfreedoms: is"),
        ({"constraintfreedoms": [1, -1, 0, 0, 0, 0]}, "should be 1 or 0 each"),
        ({"constraintfreedoms": [1] * 6, "constrainterrorthresh": 0}, "should be more than 0"),
        ({"constraintfreedoms": [1] * 6, "constrainterrorthresh": np.nan}, "should be more than 0"),
        ({"constraintfreedoms": [1] * 6, "constraintmatrix": np.full((4, 4), np.nan)}, "should be finite"),
        ({"constraintfreedoms": [1] * 6, "constrainttaskpose": [0] * 7}, "quaternion is zero"),
    ],
)
def test_constraints_that_are_none_are_refused(robot, options, problem):
    here = robot.GetActiveManipulator().GetTransform()
    with pytest.raises(ravemj.openrave_exception, match=problem):
        ravemj.interfaces.BaseManipulation(robot).MoveToHandPosition(matrices=[here], execute=False, **options)


def test_numbers_of_what_follows_are_not_negative(robot):
    module = ravemj.interfaces.BaseManipulation(robot).prob
    here = ravemj.matrixSerialization(robot.GetActiveManipulator().GetTransform())
    for text, problem in (
        ("MoveActiveJoints goals -1 0", "goals: -1 should be how many follow"),
        (f"MoveToHandPosition matrices -1 {here}", "matrices: -1 should be how many follow"),
        (f"MoveToHandPosition seedik -1 matrix {here}", "seedik is -1"),
        (f"MoveToHandPosition goalsamples -2 matrix {here}", "goalsamples -2"),
    ):
        with pytest.raises(ravemj.openrave_exception, match=problem):
            module.SendCommand(text)


def test_a_point_for_the_tool_is_a_goal_of_the_command_too(robot):
    kind = IkParameterization.Type.Translation3D
    ravemj.databases.inversekinematics.InverseKinematicsModel(robot, iktype=kind).load()
    point = robot.GetActiveManipulator().GetTransform()[:3, 3] + [0, 0.1, 0]
    words = " ".join(map(repr, point.tolist()))
    module = ravemj.interfaces.BaseManipulation(robot).prob
    reply = module.SendCommand(f"MoveToHandPosition translation {words} execute 0 outputtraj")
    found = ravemj.RaveCreateTrajectory(robot.GetEnv(), "").deserialize(reply.split(maxsplit=1)[1])
    assert tool_at(robot, waypoints(robot, found)[-1])[:3, 3] == pytest.approx(point, abs=1e-6)


@pytest.mark.parametrize("words", ["ikparam {goal}", "ikparams 2 {far} {goal}", "poses 1 {pose}", "pose {pose}"])
def test_a_command_takes_goals_of_every_kind(robot, words):
    before, goal = robot.GetActiveDOFValues(), [0.3, 0.4, -2.4, 0.2, -0.6, -0.5]
    T_world_tool = tool_at(robot, goal)
    pose = " ".join(map(repr, ravemj.poseFromMatrix(T_world_tool).tolist()))
    with_data = IkParameterization(T_world_tool, POSE)
    with_data.SetCustomValues("weight", [1, 2])
    texts = {"goal": with_data, "pose": pose, "far": IkParameterization([1, 0, 0, 0, 9, 9, 9], POSE)}
    module = ravemj.RaveCreateModule(robot.GetEnv(), "basemanipulation")
    robot.GetEnv().Add(module, True, robot.GetName())
    reply = module.SendCommand(f"MoveToHandPosition {words.format(**texts)} execute 0 outputtraj")
    traj = ravemj.RaveCreateTrajectory(robot.GetEnv(), "").deserialize(reply.removeprefix("1 "))
    last = traj.GetWaypoint(-1, robot.GetActiveConfigurationSpecification())
    assert tool_at(robot, last) == pytest.approx(T_world_tool, abs=1e-6)
    assert robot.GetActiveDOFValues().tolist() == before.tolist()


def test_a_command_names_a_goal_that_is_none(robot):
    module = ravemj.RaveCreateModule(robot.GetEnv(), "basemanipulation")
    robot.GetEnv().Add(module, True, robot.GetName())
    with pytest.raises(ravemj.openrave_exception, match="ikparam: '7 1 0' should be a goal"):
        module.SendCommand("MoveToHandPosition ikparam 7 1 0")


@pytest.mark.parametrize(
    ("method", "options", "name"),
    [
        ("MoveActiveJoints", {"goal": "abc"}, "goal: 'abc' should be numbers"),
        ("MoveActiveJoints", {"goal": READY, "maxiter": float("nan")}, "maxiter"),
        ("MoveActiveJoints", {"goal": READY, "maxtries": "a"}, "maxtries"),
        ("MoveManipulator", {"goal": READY, "jitter": float("nan")}, "jitter"),
        ("MoveToHandPosition", {"matrices": 5}, "matrices: is of type int, and should be a list"),
        ("MoveToHandPosition", {"ikparam": 5}, "ikparam: is of type int"),
        ("MoveToHandPosition", {"matrices": [np.eye(4)], "goalsamples": "a"}, "goalsamples"),
        ("MoveToHandPosition", {"matrices": [np.eye(4)], "goalsampleprob": float("nan")}, "goalsampleprob"),
        ("MoveHandStraight", {"direction": [0, 0, 1], "maxsteps": float("nan")}, "maxsteps"),
        ("MoveHandStraight", {"direction": [0, 0, 1], "ignorefirstcollision": float("nan")}, "ignorefirstcollision"),
        ("MoveUnsyncJoints", {"jointvalues": [0], "jointinds": ["a"]}, "jointinds"),
        ("JitterActive", {"jitter": "a"}, "jitter"),
    ],
)
def test_a_wrong_argument_is_named(robot, method, options, name):
    with pytest.raises(ravemj.openrave_exception, match=name):
        getattr(ravemj.interfaces.BaseManipulation(robot), method)(execute=False, **options)


def test_a_goal_in_a_list_of_its_own_is_told_its_shape(robot):
    with pytest.raises(AssertionError, match=r"goal: has shape \(1, 6\), and should have 6 values"):
        ravemj.interfaces.BaseManipulation(robot).MoveActiveJoints(goal=[READY], execute=False)


@pytest.mark.parametrize("number", ["MaxIterations", "MaxPlanningTime", "StepLength", "RandomGeneratorSeed"])
@pytest.mark.parametrize("value", [float("nan"), "a", None, [1, 2]])
def test_parameters_take_finite_numbers_only(number, value):
    with pytest.raises(ravemj.openrave_exception):
        getattr(Planner.PlannerParameters(), f"Set{number}")(value)


def test_a_goal_outside_the_limits_is_a_warning_that_names_joint_value_and_limits(robot):
    robot.SetActiveDOFs([0, 1, 2])
    _, upper = robot.GetActiveDOFLimits()
    goal, name = robot.GetActiveDOFValues(), robot.GetJointFromDOFIndex(1).GetName()
    goal[1] = upper[1] + 0.5
    with pytest.warns(ravemj.RavemjWarning, match=f"joint '{name}' at {goal[1]:.6g}, .* {upper[1]:.6g}]") as told:
        robot_motion = ravemj.interfaces.BaseManipulation(robot).MoveActiveJoints(
            goal=goal, execute=False, outputtrajobj=True
        )
    assert [one.message.code for one in told] == ["value-outside-limits"]
    assert waypoints(robot, robot_motion)[-1] == pytest.approx([goal[0], upper[1], goal[2]])


def test_a_goal_out_of_reach_says_by_how_much(robot):
    far = robot.GetActiveManipulator().GetTransform()
    far[0, 3] += 3
    with pytest.raises(ravemj.PlanningError, match=r"the goal, which is out of reach: the nearest .* [\d.]+ m and "):
        ravemj.interfaces.BaseManipulation(robot).MoveToHandPosition(matrices=[far], execute=False)
    with pytest.raises(ravemj.PlanningError, match=r"any of the 2 goals; the first is out of reach: .* m"):
        ravemj.interfaces.BaseManipulation(robot).MoveToHandPosition(matrices=[far, far], execute=False)
