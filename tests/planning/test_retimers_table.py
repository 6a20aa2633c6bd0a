"""Retimers and smoothers with every name, number of waypoints and option: what OpenRAVE's rules say of each."""

import itertools

import numpy as np
import pytest

import ravemj
from ravemj import PlannerStatus, planningutils

RETIMERS = {
    "LinearTrajectoryRetimer": "linear",
    "ParabolicTrajectoryRetimer": "quadratic",
    "parabolictrajectoryretimer2": "quadratic",
    "CubicTrajectoryRetimer": "cubic",
    "CubicTrajectoryRetimer2": "cubic",
    "QUINTICTRAJECTORYRETIMER": "quintic",
}
SMOOTHERS = ["LinearSmoother", "ParabolicSmoother", "ParabolicSmoother2", "CubicSmoother", "QuinticSmoother"]
ROWS = np.array([[0.0, 0.0], [0.6, 0.2], [0.2, 0.9]])


@pytest.fixture
def robot():
    env = ravemj.load(ravemj.model_path("puma560"))
    robot = env.GetRobots()[0]
    robot.SetActiveDOFs([0, 1])
    yield robot
    env.Destroy()


def path(robot, count, interpolation="", derivatives=0, times=()):
    spec = robot.GetActiveConfigurationSpecification(interpolation)
    if derivatives:
        spec.AddDerivativeGroups(1, False)
    if len(times):
        spec.AddDeltaTimeGroup()
    made = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    made.Init(spec)
    rows = np.zeros((count, spec.GetDOF()))
    rows[:, spec.GetGroupFromName("joint_values").columns] = ROWS[:count]
    if len(times):
        rows[:, spec.GetGroupFromName("deltatime").offset] = times
    made.Insert(0, rows.ravel())
    return made


def groups(made):
    return {group.name.split()[0]: group.interpolation for group in made.GetConfigurationSpecification().GetGroups()}


ONE = {
    "active": lambda t, r, name: planningutils.RetimeActiveDOFTrajectory(t, r, plannername=name),
    "plain": lambda t, r, name: planningutils.RetimeTrajectory(t, plannername=name),
    "affine": lambda t, r, name: planningutils.RetimeAffineTrajectory(t, [1], [1], plannername=name),
    "smooth active": lambda t, r, name: planningutils.SmoothActiveDOFTrajectory(t, r, plannername=name),
    "smooth plain": lambda t, r, name: planningutils.SmoothTrajectory(t, plannername=name),
    "smooth affine": lambda t, r, name: planningutils.SmoothAffineTrajectory(t, [1], [1], plannername=name),
    "retimer": lambda t, r, name: planningutils.ActiveDOFTrajectoryRetimer(r, "LinearTrajectoryRetimer").PlanPath(t),
    "smoother": lambda t, r, name: planningutils.ActiveDOFTrajectorySmoother(r).PlanPath(t),
    "affine retimer": lambda t, r, name: planningutils.AffineTrajectoryRetimer(name).PlanPath(t, [1], [1]),
}


@pytest.mark.parametrize("call", ONE)
@pytest.mark.parametrize("name", ["", *RETIMERS, *SMOOTHERS, "no such planner"])
def test_one_waypoint_keeps_its_groups_and_gets_a_time(robot, call, name):
    made = path(robot, 1, "cubic", derivatives=1)
    before = made.GetWaypoint(0)
    assert ONE[call](made, robot, name) == PlannerStatus.HasSolution
    assert groups(made) == {"joint_values": "cubic", "joint_velocities": "quadratic", "deltatime": ""}
    assert made.GetNumWaypoints() == 1
    assert made.GetDuration() == 0
    assert made.GetWaypoint(0).tolist() == [*before, 0]


@pytest.mark.parametrize("name", RETIMERS)
def test_a_planner_wants_two_waypoints_to_smooth_and_one_to_retime(robot, name):
    for planner, count, expected in ((name, 0, 0), (name, 1, 1), *itertools.product(SMOOTHERS, (0, 1), (0,))):
        params = ravemj.Planner.PlannerParameters()
        params.SetRobotActiveJoints(robot)
        run = ravemj.RaveCreatePlanner(robot.GetEnv(), planner)
        assert run.InitPlan(robot, params)
        assert run.PlanPath(path(robot, count)).statusCode == expected, planner


@pytest.mark.parametrize("interpolation", ["", "linear", "quadratic", "cubic", "quintic", "next"])
def test_without_a_name_the_interpolation_chooses(robot, interpolation):
    expected = "quadratic" if interpolation == "quadratic" else "linear"
    for call in (
        lambda made: planningutils.RetimeActiveDOFTrajectory(made, robot),
        planningutils.RetimeTrajectory,
    ):
        made = path(robot, 2, interpolation)
        assert call(made) == PlannerStatus.HasSolution
        assert groups(made)["joint_values"] == expected


FLAGS = [
    (name, derivatives, times, options)
    for name in RETIMERS
    for derivatives in (0, 1)
    for times in ((), (0, 9, 9), (0, 1e-3, 9))
    for options in itertools.product((0, 1), (0, 1))
]


@pytest.mark.parametrize(("name", "derivatives", "times", "options"), FLAGS)
def test_velocities_and_times_that_should_be_kept(robot, name, derivatives, times, options):
    keeps_times, keeps_velocities = options
    made = path(robot, 3, "", derivatives, times)
    text = f"<hasvelocities>{keeps_velocities}</hasvelocities>"
    status = planningutils.RetimeActiveDOFTrajectory(made, robot, bool(keeps_times), 1, 1, name, text)
    are_missing = (keeps_times and not times) or (keeps_velocities and not derivatives and "Linear" not in name)
    are_short = bool(keeps_times) and len(times) > 0 and times[1] < 1
    assert status.statusCode == (0 if are_missing or are_short else 1), status.description
    if status:
        assert made.GetConfigurationSpecification().GetDOF() >= 5
        if keeps_times:
            assert made.GetDuration() == pytest.approx(18)
    else:
        assert made.GetNumWaypoints() == 3
        assert ("deltatime" in groups(made)) == bool(times)


@pytest.mark.parametrize("name", RETIMERS)
@pytest.mark.parametrize("interpolation", ["linear", "quadratic", "cubic", "quintic", "other"])
def test_another_interpolation_than_the_retimers_is_refused_at_the_start(robot, name, interpolation):
    text = f"<interpolation>{interpolation}</interpolation>"
    fits = RETIMERS[name] == interpolation
    params = ravemj.Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetExtraParameters(text)
    assert ravemj.RaveCreatePlanner(robot.GetEnv(), name).InitPlan(robot, params) == fits
    made = path(robot, 2)
    assert bool(planningutils.RetimeActiveDOFTrajectory(made, robot, False, 1, 1, name, text)) == fits
    if fits:
        planningutils.ActiveDOFTrajectoryRetimer(robot, name, text)
    else:
        with pytest.raises(ravemj.openrave_exception, match="InvalidArguments"):
            planningutils.ActiveDOFTrajectoryRetimer(robot, name, text)


@pytest.mark.parametrize("name", ["ParabolicTrajectoryRetimer", "CubicTrajectoryRetimer", "QuinticTrajectoryRetimer"])
def test_times_are_those_of_a_stop_whatever_velocities_are_kept(robot, name):
    stops, passes = path(robot, 3, "", 1), path(robot, 3, "", 1)
    row = passes.GetWaypoint(1)
    row[passes.GetConfigurationSpecification().GetGroupFromName("joint_velocities").offset] = 1e-3
    passes.Insert(1, row, True)
    text = "<hasvelocities>1</hasvelocities><outputaccelchanges>0</outputaccelchanges>"
    for made in (stops, passes):
        assert planningutils.RetimeActiveDOFTrajectory(made, robot, False, 1, 1, name, text), name
    first = [made.GetConfigurationSpecification().ExtractDeltaTime(made.GetWaypoint(1)) for made in (stops, passes)]
    assert first[0] == first[1]


NAMES = [f"joint_{kind} a 0" for kind in ("values", "velocities", "accelerations", "jerks")]


@pytest.mark.parametrize("interpolation", ["linear", "next", "quadratic"])
@pytest.mark.parametrize("kind", [*NAMES, "affine_velocities a 1", "iswaypoint", "my"])
def test_backwards_only_velocities_are_negated_and_moved(kind, interpolation):
    spec = ravemj.ConfigurationSpecification()
    spec.AddGroup(kind, 1, interpolation)
    spec.AddDeltaTimeGroup()
    made = ravemj.RaveCreateTrajectory(ravemj.Environment(), "")
    made.Init(spec)
    made.Insert(0, [1, 0, 2, 0.5, 3, 0.25])
    made.SetDescription("there")
    back = planningutils.ReverseTrajectory(made)
    expected = [3, 2, 1]
    if "_velocities" in kind:
        expected = [0, -3, -2] if interpolation == "next" else [-3, -2, -1]
    column = back.GetConfigurationSpecification().GetGroupFromName(kind).offset
    times = back.GetConfigurationSpecification().GetGroupFromName("deltatime").offset
    assert back.GetAllWaypoints2D()[:, column].tolist() == expected
    assert back.GetAllWaypoints2D()[:, times].tolist() == [0, 0.25, 0.5]
    assert back.GetDescription() == "there"


EXTREME = ["0", "1e-320", "1e-200", "1e300"]


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", RETIMERS)
def test_extreme_limits_and_values_end(robot, name):
    for velocity, acceleration, jerk, value in itertools.product(EXTREME, EXTREME, EXTREME[::3], (1e-320, 0.5)):
        made = path(robot, 2)
        made.Insert(1, [value, 0], True)
        text = (
            f"<_vconfigvelocitylimit>{velocity} {velocity}</_vconfigvelocitylimit><_vconfigjerklimit>{jerk} {jerk}"
            f"</_vconfigjerklimit><_vconfigaccelerationlimit>{acceleration} {acceleration}</_vconfigaccelerationlimit>"
        )
        status = planningutils.RetimeActiveDOFTrajectory(made, robot, False, 1, 1, name, text)
        assert status.statusCode in {0, 1}
