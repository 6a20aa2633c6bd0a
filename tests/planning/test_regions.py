"""Planning to regions of poses, with constraints along the path, and the reasons of failures."""

import math
import re

import numpy as np
import pytest
from conftest import one_in

import ravemj
from ravemj import IkParameterization, Planner, PlanningError, Region
from ravemj.planning.projection import project

ZERO, TURN, ANY = [0.0, 0.0], [-math.pi, math.pi], [-math.inf, math.inf]

PLANAR = """<Environment><Robot name="arm"><KinBody>
<Body name="base"/>
{links}
</KinBody>
<Manipulator name="hand"><base>base</base><effector>l{last}</effector><Translation>{tip} 0 0</Translation></Manipulator>
</Robot></Environment>"""
LINK = """<Body name="l{i}"><offsetfrom>{parent}</offsetfrom><Translation>{at} 0 0</Translation>
<Geom type="box"><extents>{half} 0.02 0.02</extents><Translation>{middle} 0 0</Translation></Geom></Body>
<Joint name="j{i}" type="hinge"><Body>{parent}</Body><Body>l{i}</Body><offsetfrom>l{i}</offsetfrom><axis>{axis}</axis>
<limitsrad>{low} 3.1</limitsrad></Joint>"""


def planar(*lengths, axis="0 0 1", low=-3.1):
    """A chain of parallel hinges."""
    links = [
        LINK.format(
            i=i,
            parent=f"l{i - 1}" if i > 1 else "base",
            at=([0, *lengths])[i - 1],
            half=length / 2 - 0.05,
            middle=length / 2,
            axis=axis,
            low=low if i == 2 else -3.1,
        )
        for i, length in enumerate(lengths, 1)
    ]
    env = ravemj.Environment()
    env.LoadData(PLANAR.format(links="\n".join(links), last=len(lengths), tip=lengths[-1]))
    robot = env.GetRobots()[0]
    robot.SetActiveDOFs(robot.GetActiveManipulator().GetArmIndices())
    return robot


def bounds(**named):
    return [named.get(name, ZERO) for name in ("x", "y", "z", "roll", "pitch", "yaw")]


def at(x, y, z=0.0):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


SQUARE = Region(Bw=bounds(x=[1.2, 1.4], y=[0.2, 0.4], yaw=TURN), name="square")
FAR = Region(Bw=bounds(x=[2.1, 2.3], y=[-0.05, 0.05], yaw=TURN), name="far")


def tool_at(robot, values):
    with robot:
        robot.SetActiveDOFValues(values)
        return robot.GetActiveManipulator().GetTransform()


def moved(robot, **options):
    return ravemj.interfaces.BaseManipulation(robot).MoveToHandPosition(
        execute=False, outputtrajobj=True, **{"maxtries": 1, **options}
    )


def rows_of(robot, trajectory, step=0.005):
    times = np.append(np.arange(0, trajectory.GetDuration(), step), trajectory.GetDuration())
    return trajectory.SamplePoints2D(times, robot.GetActiveConfigurationSpecification())


def end_of(robot, trajectory):
    return trajectory.GetWaypoint(-1, robot.GetActiveConfigurationSpecification())


def goals(robot, region, count):
    """Goals that are drawn from a region."""
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.set_goal_sampler(region)
    source = params.given.goal_sampler.source
    found = source.first(lambda root: None, np.random.default_rng(0), enough=8)
    drawn = (source.next(lambda root: None) for _ in range(count))
    return np.array([*found, *(goal for goal in drawn if goal is not None)]), source.tally.total()


SOLVERS = [None, IkParameterization.Type.TranslationXY2D]


def give_solver(robot, kind):
    assert kind is None or ravemj.databases.inversekinematics.InverseKinematicsModel(robot, iktype=kind).load()


@pytest.mark.parametrize("kind", SOLVERS)
def test_a_planar_arm_reaches_a_region_with_both_elbows(kind):
    robot = planar(1, 1)
    give_solver(robot, kind)
    ends, _ = goals(robot, SQUARE, 100)
    assert (np.abs(ends[:, 1]) >= 1.51076 - 1e-3).all()
    assert (np.abs(ends[:, 1]) <= 1.83382 + 1e-3).all()
    assert set(np.sign(ends[:, 1])) == {-1, 1}
    assert all(SQUARE.distance(tool_at(robot, end)) < 1e-3 for end in ends)


def test_the_share_of_poses_in_reach_is_that_of_the_area():
    robot = planar(1, 1)
    give_solver(robot, IkParameterization.Type.TranslationXY2D)
    wide = Region(Bw=bounds(x=[1.5, 2.5], y=[-0.5, 0.5], yaw=TURN))
    _, total = goals(robot, wide, 1000)
    assert total[None] / total.total() == pytest.approx(0.479, abs=0.05)


# --- reasons


def failure(robot, **options):
    with pytest.raises(PlanningError) as caught:
        moved(robot, **options)
    return caught.value


@pytest.mark.parametrize("kind", one_in(2, SOLVERS))
def test_regions_out_of_reach(kind):
    robot = planar(1, 1)
    give_solver(robot, kind)
    error = failure(robot, regions=[FAR])
    near = r"\(the nearest that it reaches is (\d\S*) m away\)"
    told = re.fullmatch(rf"no goal: out of reach: 200 of 200 poses {near} \(region 'far'\)", str(error))
    assert 0.099 < float(told[1]) < 0.2  # the middle of one side is 0.1 m away, the corners are not
    assert error.status.causes == {"out of reach": 200}


@pytest.mark.stress
@pytest.mark.parametrize("kind", one_in(2, SOLVERS))
def test_regions_outside_the_limits(kind):
    robot = planar(1, 1)
    give_solver(robot, kind)
    robot.GetJoints()[1].SetLimits([0], [1])
    assert failure(robot, regions=[SQUARE]).status.causes == {"outside the joint limits": 200}


@pytest.mark.parametrize("kind", one_in(2, SOLVERS))
def test_regions_in_collision_name_a_pair_and_a_configuration(kind):
    robot = planar(1, 1)
    give_solver(robot, kind)
    can = ravemj.KinBody.GeometryInfo()
    can._type, can._vGeomData = ravemj.GeometryType.Cylinder, [0.3, 0.2]
    body = ravemj.RaveCreateKinBody(robot.GetEnv(), "")
    body.SetName("can")
    body.InitFromGeometries([can])
    robot.GetEnv().Add(body)
    body.SetTransform([1, 0, 0, 0, 1.3, 0.3, 0])
    error = failure(robot, regions=[SQUARE])
    assert error.status.causes == {"in collision": 200}
    assert "e.g. link 'l2' of 'arm' with link 'base' of 'can'" in str(error)
    assert SQUARE.distance(tool_at(robot, error.status.examples["in collision"])) < 1e-3
    assert str(failure(robot, regions=[SQUARE])) == str(error), "the same for the same seed"


@pytest.mark.stress
def test_regions_off_a_constraint_say_how_far():
    robot = planar(1, 1)
    robot.SetActiveDOFValues([np.pi / 2, 0])
    aside = Region(Bw=bounds(x=ANY, y=[0.5, math.inf], yaw=TURN))
    error = failure(robot, regions=[SQUARE], constraints=[aside])
    assert error.status.causes == {"off the constraint": 200}
    low, high = map(float, str(error).partition("missed by ")[2].split(")")[0].split(" to "))
    assert 0.099 < low < 0.12
    assert 0.27 < high < 0.302


def test_a_start_off_the_constraint_is_refused_before_goals_are_sampled():
    robot = planar(1, 1)
    aside = Region(Bw=bounds(x=ANY, y=[0.5, math.inf], yaw=TURN))
    error = failure(robot, regions=[SQUARE], constraints=[aside])
    assert str(error).startswith("start: the tool is 0.5 off its constraint")
    assert not error.status.causes


@pytest.mark.stress
def test_causes_add_up_by_region():
    robot = planar(1, 1)
    status = failure(robot, regions=[FAR, Region(at(3, 0), Bw=bounds(yaw=TURN))]).status
    by_region = status.causes_by_region
    assert by_region.keys() == {"far", "region 1"}
    assert sum(sum(counts.values()) for counts in by_region.values()) == 200 == sum(status.causes.values())


def test_poses_without_solutions_are_counted_by_cause():
    env = ravemj.load(ravemj.model_path("puma560"))
    robot = env.GetRobots()[0]
    give_solver(robot, IkParameterization.Type.Transform6D)
    arm = robot.GetActiveManipulator()
    robot.SetActiveDOFs(arm.GetArmIndices())
    here = arm.GetTransform()
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes([[0, 0, 0, 0.05, 0.05, 0.05]])
    box.SetName("box")
    env.Add(box)
    box.SetTransform(at(*here[:3, 3]))
    error = failure(robot, matrices=[at(3, 0), here, at(0, 4)])
    assert error.status.causes == {"out of reach": 2, "in collision": 1}
    assert "out of reach: 2 of 3 poses, in collision: 1 of 3 poses" in str(error)
    assert " (e.g. link '" in str(error)


def test_a_ring_of_walls_is_named_with_the_sizes_of_the_trees():
    robot = planar(1, 1)
    walls = ravemj.RaveCreateKinBody(robot.GetEnv(), "")
    walls.SetName("ring")
    walls.InitFromBoxes([[1.2, 0.3, 0, 1, 0.03, 0.1], [1.2, -0.3, 0, 1, 0.03, 0.1]])
    robot.GetEnv().Add(walls)
    error = failure(robot, regions=[Region(at(0, 1.5), Bw=bounds(x=[-0.1, 0.1], yaw=TURN))], maxiter=150)
    assert "the iterations were used up after 150 iterations, with trees of" in str(error)
    assert "most lines were stopped by link 'l" in str(error)
    assert "of 'ring'" in str(error)


KINDS = sorted((kind for kind in ravemj.geometry_functions.ik_types.GOAL_TYPES), key=lambda kind: kind.name)


@pytest.mark.parametrize("kind", one_in(2, KINDS), ids=lambda kind: kind.name)
def test_solvers_of_all_types_reach_regions(kind):
    env = ravemj.load(ravemj.model_path("puma560"))
    robot = env.GetRobots()[0]
    robot.SetTransform(ravemj.matrixFromAxisAngle([0.3, -0.5, 0.7]))
    give_solver(robot, kind)
    arm = robot.GetActiveManipulator()
    robot.SetActiveDOFs(arm.GetArmIndices())
    place = tool_at(robot, [0.5, 0.3, -2.0, 0.4, 0.8, 0.2])
    region = Region(place, Bw=[[-0.05, 0.05]] * 3 + [[-0.3, 0.3]] * 3)
    found = moved(robot, regions=region)
    assert region.distance(tool_at(robot, end_of(robot, found))) <= 1e-3


def test_filters_of_users_are_asked_and_counted():
    robot = planar(1, 1)
    give_solver(robot, IkParameterization.Type.TranslationXY2D)
    action = ravemj.IkReturnAction
    solver = robot.GetActiveManipulator().GetIkSolver()
    with solver.RegisterCustomFilter(0, lambda row, arm, goal: action.Success if row[1] < 0 else action.Reject):
        ends, _ = goals(robot, SQUARE, 20)
        assert (ends[:, 1] < 0).all()
    with solver.RegisterCustomFilter(0, lambda row, arm, goal: action.Reject):
        causes = failure(robot, regions=SQUARE).status.causes
    assert causes == {"rejected by a filter of inverse kinematics": 200}


# --- several regions, starts, mixtures


def test_the_region_that_is_reached_is_told():
    robot = planar(1, 1)
    found = moved(robot, regions=[FAR, SQUARE, FAR])
    assert found.goal_index == 1
    helper = ravemj.interfaces.BaseManipulation(robot)
    mixed = helper.MoveActiveJoints(goals=[SQUARE, [0.1, 0.1]], execute=False, outputtrajobj=True)
    end = end_of(robot, mixed)
    assert SQUARE.distance(tool_at(robot, end)) < 1e-3 if mixed.goal_index == 1 else end == pytest.approx([0.1, 0.1])


def test_starts_may_be_a_region():
    robot = planar(1, 1)
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetInitialConfig([])
    params.set_start_sampler([FAR, SQUARE])
    params.set_goal_sampler(Region(at(0, 1.5), Bw=bounds(x=[-0.1, 0.1], yaw=TURN)))
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), "birrt")
    trajectory = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    assert planner.InitPlan(robot, params)
    status = planner.PlanPath(trajectory)
    assert (status.start_index, status.goal_index) == (1, 0)
    assert SQUARE.distance(tool_at(robot, rows_of(robot, trajectory)[0])) < 1e-3


def test_regions_move_with_a_link():
    robot = planar(1, 1)
    box = ravemj.RaveCreateKinBody(robot.GetEnv(), "")
    box.SetName("target")
    box.InitFromBoxes([[0, 0, 0.5, 0.01, 0.01, 0.01]])
    robot.GetEnv().Add(box)
    region = Region(Bw=bounds(yaw=TURN), frame=box.GetLinks()[0])
    for place in (at(1.2, 0.3), at(0.2, -1.1)):
        box.SetTransform(place)
        found = end_of(robot, moved(robot, regions=region))
        assert tool_at(robot, found)[:3, 3] == pytest.approx(place[:3, 3], abs=1e-3)
    robot.GetEnv().Remove(box)
    with pytest.raises(ravemj.ArgumentError, match="its frame was removed"):
        moved(robot, regions=region)


WRONG = [
    (dict(regions=[]), "an empty list"),
    (dict(regions=[3]), "should be regions"),
    (dict(regions=Region(Bw=bounds(y=[0, math.inf]))), "y of the region has no bounds"),
    (dict(regions=SQUARE, constraints=[3]), "constraint is 3"),
    (dict(regions=SQUARE, holding="cup"), "there is no body 'cup'"),
]


@pytest.mark.parametrize(("options", "message"), WRONG)
def test_wrong_regions_are_named(options, message):
    with pytest.raises(ravemj.ArgumentError, match=message):
        moved(planar(1, 1), **options)


# --- constraints along the path


def upright_arm():
    robot = planar(1, 1, 0.5, axis="0 -1 0")
    robot.SetActiveDOFValues([1.864346, -2.339216, 0.474870])
    return robot


LEVEL = Region(at(0, 0, 0.5), Bw=bounds(x=ANY), name="level")


def test_a_level_hand_is_carried_at_a_height():
    robot = upright_arm()
    give_solver(robot, None)
    goal = [0.879794, -1.153817, 0.274024]
    helper = ravemj.interfaces.BaseManipulation(robot)
    found = helper.MoveActiveJoints(goal=goal, constraints=[LEVEL], execute=False, outputtrajobj=True)
    rows = rows_of(robot, found)
    assert rows[-1] == pytest.approx(goal, abs=1e-6)
    assert max(LEVEL.distance(tool_at(robot, row)) for row in rows) <= 1e-3 + 1e-6
    wrist = [tool_at(robot, row)[0, 3] - 0.5 for row in rows]
    middle = rows[int(np.argmin(np.abs(np.array(wrist) - 1.1)))]
    assert middle == pytest.approx([1.348722, -1.844189, 0.495467], abs=0.02)
    straight = rows[0] + 0.492 * (rows[-1] - rows[0])
    assert tool_at(robot, straight)[2, 3] == pytest.approx(0.5 + 0.114591, abs=1e-4)


def test_intervals_are_used():
    robot = upright_arm()
    loose = Region(at(0, 0, 0.5), Bw=bounds(x=ANY, z=[0, 0.2], pitch=[-0.1, 0.1]))
    helper = ravemj.interfaces.BaseManipulation(robot)
    found = helper.MoveActiveJoints(
        goal=[0.879794, -1.153817, 0.274024], constraints=[loose], execute=False, outputtrajobj=True
    )
    assert len(rows_of(robot, found, 1.0)) < 5, "the straight line is inside"


def test_one_of_several_regions_is_enough_and_all_of_them_hold():
    robot = planar(1, 1)
    lines = [Region(Bw=bounds(x=ANY, y=[y, y], yaw=TURN)) for y in (0.5, 5.0)]
    robot.SetActiveDOFValues(np.array([1.2, -1.9]))
    for joint in robot.GetJoints():
        joint.SetResolution(0.1)
    start = tool_at(robot, robot.GetActiveDOFValues())
    lines[0] = Region(Bw=bounds(x=ANY, y=[start[1, 3] - 0.1, start[1, 3] + 0.1], yaw=TURN))
    goal = Region(Bw=bounds(x=[0.7, 0.8], y=[start[1, 3]] * 2, yaw=TURN))
    right = Region(Bw=bounds(x=[-math.inf, 2.0], y=ANY, yaw=TURN))
    found = moved(robot, regions=goal, constraints=[ravemj.all_of(ravemj.any_of(*lines), right, lambda values: True)])
    assert max(lines[0].distance(tool_at(robot, row)) for row in rows_of(robot, found)) < 1.1e-3


def test_sets_that_only_contain_are_kept():
    class Low:
        def contains(self, values):
            return values[0] < 0.9

    robot = planar(1, 1)
    found = moved(robot, regions=SQUARE, constraints=[Low()])
    assert rows_of(robot, found)[:, 0].max() < 0.9
    either = ravemj.any_of(Low(), Region(Bw=bounds(x=[5, 6])))
    assert rows_of(robot, moved(robot, regions=SQUARE, constraints=[either]))[:, 0].max() < 0.9


def test_a_held_glass_stays_upright_and_is_released_again():
    robot = upright_arm()
    glass = ravemj.RaveCreateKinBody(robot.GetEnv(), "")
    glass.SetName("glass")
    glass.InitFromBoxes([[0, 0, 0.1, 0.03, 0.03, 0.05]])
    robot.GetEnv().Add(glass)
    glass.SetTransform(robot.GetActiveManipulator().GetTransform() @ at(0, 0, 0.1))
    upright = Region(Bw=[ANY, ANY, ANY, ZERO, ZERO, TURN], lean=0.05)
    here = glass.GetTransform()
    goal = Region(at(1.9, 0, 0.9), Bw=bounds(x=[-0.1, 0.1], z=[-0.1, 0.1]), lean=0.05)
    found = moved(robot, regions=goal, constraints=[upright], holding="glass")
    assert robot.IsGrabbing(glass) is None
    T_tool_glass = np.linalg.inv(robot.GetActiveManipulator().GetTransform()) @ here
    poses = [tool_at(robot, row) @ T_tool_glass for row in rows_of(robot, found)]
    assert max(upright.distance(pose) for pose in poses) < 1.1e-3
    assert goal.distance(poses[-1]) < 1e-3


def test_two_arms_carry_a_bar():
    robots = [planar(1, 1, 0.3)]
    env = robots[0].GetEnv()
    second = ravemj.RaveCreateRobot(env, "")
    second.Clone(robots[0], 0)
    second.SetName("other")
    env.Add(second, True)
    second.SetTransform(at(1.6, 0))
    robots.append(second)
    robots[0].SetDOFValues([2.2, -1.4, -1.6])
    second.SetDOFValues([math.pi - 2.2, 1.4, 1.6])
    left, right = (robot.GetActiveManipulator() for robot in robots)
    bar = np.linalg.inv(left.GetTransform()) @ right.GetTransform()
    region = Region(left.GetLocalToolTransform() @ bar, frame=left.GetEndEffector())
    spec = robots[0].GetActiveConfigurationSpecification() + second.GetActiveConfigurationSpecification()
    params = Planner.PlannerParameters()
    params.SetConfigurationSpecification(env, spec)
    params.add_constraint(region, manip=right)
    start = params.GetStateFn()
    error = params.given.conditions.manifold
    assert error.off(start) < 1e-9
    steps, values = project(start + np.array([0.2, 0.1, 0, 0.1, 0, 0]), error.error, params.given.space(), 1e-5, 40)
    assert steps >= 0
    params.SetStateValues(start)
    params.SetGoalConfig(values)
    params.SetInitialConfig(start)
    planner = ravemj.RaveCreatePlanner(env, "birrt")
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    assert planner.InitPlan(None, params)
    assert planner.PlanPath(trajectory) == ravemj.PlannerStatus.HasSolution
    for time in np.linspace(0, trajectory.GetDuration(), 40):
        params.SetStateValues(trajectory.Sample(time, spec))
        between = np.linalg.inv(left.GetTransform()) @ right.GetTransform()
        assert between == pytest.approx(bar, abs=2e-3)


def panda():
    """The arm of a Panda, its gripper with one joint, and a can to grasp."""
    env = ravemj.load(ravemj.model_path("panda"))
    robot = env.GetRobots()[0]
    robot.SetActiveDOFs(robot.GetActiveManipulator().GetArmIndices())
    can = ravemj.RaveCreateKinBody(env, "")
    can.SetName("can")
    shape = ravemj.KinBody.GeometryInfo()
    shape._type, shape._vGeomData = ravemj.GeometryType.Cylinder, [0.03, 0.12]
    can.InitFromGeometries([shape])
    env.Add(can)
    can.SetTransform([1, 0, 0, 0, 0.5, -0.2, 0.3])
    return robot, can


def grasp(can, preshape, name):
    side = ravemj.matrixFromAxisAngle([0, np.pi / 2, 0])
    side[0, 3] = -0.01
    return Region(Tw_e=side, Bw=bounds(z=[-0.02, 0.02], yaw=TURN), frame=can, preshape=preshape, name=name)


def opening(robot, trajectory, index=-1):
    spec = robot.GetConfigurationSpecificationIndices(robot.GetActiveManipulator().GetGripperIndices())
    return float(trajectory.GetWaypoint(index, spec)[0])


def test_the_gripper_opens_on_the_way_to_a_grasp():
    robot, can = panda()
    robot.SetDOFValues([0.0], [7])
    open_hand, closed = grasp(can, [0.035], "open"), grasp(can, [0.0], "closed")
    trajectory = moved(robot, regions=[closed, open_hand], maxiter=2000)
    assert trajectory.goal_index == 1  # closed, the fingers would be in the can
    assert opening(robot, trajectory) == pytest.approx(0.035, abs=1e-9)
    assert opening(robot, trajectory, 0) == 0
    assert trajectory.certificate.certified, str(trajectory.certificate)
    assert robot.GetDOFValues([7]) == [0.0]
    with robot:
        robot.SetActiveDOFValues(end_of(robot, trajectory))
        assert open_hand.distance(robot.GetActiveManipulator().GetTransform()) < 1e-6


def test_each_goal_has_the_preshape_of_its_region():
    robot, can = panda()
    robot.SetActiveDOFs([7, *robot.GetActiveManipulator().GetArmIndices()])  # the gripper first
    regions = [grasp(can, [0.04], "wide"), grasp(can, [0.035], "narrow"), grasp(can, None, "as it is")]
    wanted = [0.04, 0.035, 0.02]
    robot.SetDOFValues([0.02], [7])
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.set_goal_sampler(regions)
    source = params.given.goal_sampler.source
    found = [source.next(lambda root: None) for _ in range(300)]
    reached = {source.region_of(root): root for root in found if root is not None}
    assert sorted(reached) == [0, 1, 2]
    for number, root in reached.items():
        assert root[0] == wanted[number]
        assert regions[number].distance(tool_at(robot, root)) < 1e-6


def test_wrong_preshapes_are_named():
    robot, can = panda()
    with pytest.raises(ravemj.openrave_exception, match=r"'b': its preshape has 2 values, and the gripper .* 1 joints"):
        moved(robot, regions=[grasp(can, [0.0, 0.0], "b")])
    with pytest.raises(ravemj.openrave_exception, match=r"preshape is .*nan.* finite numbers"):
        grasp(can, [math.nan], "c")
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    with pytest.raises(ravemj.openrave_exception, match="'d': its preshape moves joint 'finger', which is not active"):
        params.set_goal_sampler([grasp(can, [0.02], "d")])
    with pytest.raises(PlanningError, match="outside the joint limits"):
        moved(robot, regions=[grasp(can, [9.0], "e")])
