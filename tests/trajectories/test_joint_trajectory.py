"""Motions as ``trajectory_msgs/JointTrajectory``: points, checks and files."""

import builtins
import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from strategies import examples

import ravemj
from ravemj.errors import ArgumentError, RavemjWarning, SourceError

RETIMERS = ("ParabolicTrajectoryRetimer", "CubicTrajectoryRetimer", "QuinticTrajectoryRetimer")
ECHO = """\
header:
  stamp:
    sec: 0
    nanosec: 0
  frame_id: ''
joint_names:
- joint1
- joint4
points:
- positions:
  - 0.1
  - 0.2
  velocities: []
  accelerations: []
  effort: []
  time_from_start:
    sec: 0
    nanosec: 0
- positions:
  - 0.3
  - -0.4
  velocities: []
  accelerations: []
  effort: []
  time_from_start:
    sec: 1
    nanosec: 500000000
---
"""


@pytest.fixture(scope="module")
def arm():
    """A SCARA: two joints that turn, one that slides, one that turns."""
    return ravemj.load(ravemj.model_path("scara")).GetRobots()[0]


@pytest.fixture
def scara(arm):
    arm.SetDOFValues([0.0, 0.0, 0.05, 0.0])
    arm.SetActiveDOFs(range(4))
    arm.ReleaseAllGrabbed()
    return arm


def timed(robot, rows, retimer):
    trajectory = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    trajectory.Init(robot.GetActiveConfigurationSpecification("linear"))
    trajectory.Insert(0, np.ravel(rows))
    status = ravemj.planningutils.RetimeActiveDOFTrajectory(trajectory, robot, plannername=retimer)
    assert status == ravemj.PlannerStatus.HasSolution
    return trajectory


def rows_of_scara(data, count):
    lower, upper = np.array([[-2.5, -2.5, 0.0, -4.0], [2.5, 2.5, 0.19, 4.0]])
    parts = data.draw(hnp.arrays(float, (count, 4), elements=st.floats(0, 1)))
    rows = lower + parts * (upper - lower)
    return rows[np.append(True, np.abs(np.diff(rows, axis=0)).max(axis=1) > 1e-3)]


def at(trajectory, robot, times):
    spec = robot.GetActiveConfigurationSpecification()
    return np.array([trajectory.Sample(float(np.clip(t, 0, trajectory.GetDuration())), spec) for t in times])


@given(st.data())
@examples(60)
def test_points_have_the_derivatives_of_the_trajectory(arm, data):
    arm.SetActiveDOFs(range(4))
    rows = rows_of_scara(data, data.draw(st.integers(2, 4)))
    if len(rows) < 2:
        return
    trajectory = timed(arm, rows, data.draw(st.sampled_from(RETIMERS)))
    points = arm.to_joint_trajectory(trajectory, rate=data.draw(st.sampled_from([20.0, 100.0, 333.0])))
    np.testing.assert_allclose(points.positions, at(trajectory, arm, points.times), atol=1e-9)
    assert points.times[0] == 0
    assert points.duration == pytest.approx(trajectory.GetDuration(), abs=1e-12)
    step = 1e-4
    inner = (points.times > step) & (points.times < points.duration - step)
    times = points.times[inner]
    if not inner.any():
        return
    differences = (at(trajectory, arm, times + step) - at(trajectory, arm, times - step)) / (2 * step)
    most = arm.GetDOFAccelerationLimits()
    assert (np.abs(points.velocities[inner] - differences) <= most * step + 1e-6).all()
    assert (np.abs(points.velocities) <= arm.GetDOFVelocityLimits() * 1.001).all()
    assert (np.abs(points.accelerations) <= most * 1.001).all()
    gains = np.diff(points.velocities, axis=0) / np.diff(points.times)[:, None]
    assert (np.abs(gains) <= most * 1.001 + 1e-6).all()


@given(st.data())
@examples(60)
def test_points_at_waypoints_are_the_whole_motion(arm, data):
    arm.SetActiveDOFs(range(4))
    rows = rows_of_scara(data, data.draw(st.integers(2, 4)))
    if len(rows) < 2:
        return
    trajectory = timed(arm, rows, data.draw(st.sampled_from(RETIMERS)))
    points = arm.to_joint_trajectory(trajectory, rate=None)
    again = arm.from_joint_trajectory(points)
    times = np.linspace(0, trajectory.GetDuration(), 57)
    np.testing.assert_allclose(at(again, arm, times), at(trajectory, arm, times), atol=1e-6)
    assert len(points.times) <= len(trajectory.GetAllWaypoints2D())


@given(st.data())
@examples(60)
def test_a_motion_is_retimed_along_its_lines(arm, data):
    """It passes through all rows, within the limits, near the lines, and starts and ends at rest."""
    arm.SetActiveDOFs(range(4))
    rows = rows_of_scara(data, data.draw(st.integers(2, 5)))
    if len(rows) < 2:
        return
    points = arm.to_joint_trajectory(ravemj.Motion(range(len(rows)), rows))
    through = arm.to_joint_trajectory(ravemj.Motion(range(len(rows)), rows), rate=None)
    assert not through.velocities[[0, -1]].any()
    for row in rows:
        assert np.abs(through.positions - row).max(axis=1).min() < 1e-9
    assert distances(points.positions, rows).max() <= 0.012


def distances(values, rows):
    """Return the distance of each row of values from a polyline, largest difference of a joint."""
    starts, steps = rows[:-1], np.diff(rows, axis=0)
    parts = ((values[:, None] - starts) * steps).sum(axis=2) / (steps * steps).sum(axis=1)
    nearest = starts + np.clip(parts, 0, 1)[..., None] * steps
    return np.abs(values[:, None] - nearest).max(axis=2).min(axis=1)


def test_dense_rows_are_passed_without_stops(scara):
    way = np.linspace(0, 1, 101)[:, None] * [1.0, -0.5, 0.1, 2.0]
    points = scara.to_joint_trajectory(ravemj.Motion(np.linspace(0, 1, 101), way))
    assert np.abs(points.velocities[1:-1]).max(axis=1).min() > 0


def test_sharp_corners_are_stops(scara):
    points = scara.to_joint_trajectory(ravemj.Motion([0, 1, 2], [[0, 0, 0, 0], [1, 0, 0, 0], [1, 1, 0, 0]]), rate=None)
    corner = np.abs(points.positions - [1, 0, 0, 0]).max(axis=1).argmin()
    assert not points.velocities[corner].any()


def test_repeated_rows_are_one(scara):
    once = scara.to_joint_trajectory(ravemj.Motion([0, 1], [[0.0] * 4, [0.1] * 4]), rate=None)
    twice = scara.to_joint_trajectory(
        ravemj.Motion([0, 1, 2, 3], [[0.0] * 4, [0.0] * 4, [0.1] * 4, [0.1] * 4]), rate=None
    )
    np.testing.assert_array_equal(twice.positions, once.positions)


def test_only_active_dofs_of_a_motion_are_written(scara):
    scara.SetActiveDOFs([3, 1])
    points = scara.to_joint_trajectory(ravemj.Motion.line([0] * 4, [0, 0.5, 0, 1.0]))
    assert points.joint_names == ("joint4", "joint2")
    np.testing.assert_allclose(points.positions[-1], [1.0, 0.5])
    assert points.units == ("rad", "rad")


def test_a_moving_motion_keeps_its_times_and_has_no_velocities(scara):
    motion = ravemj.Motion([5.0, 6.0, 8.0], [[0] * 4, [1.0, 0, 0, 0], [1.0, 2.0, 0, 0]])
    points = scara.to_joint_trajectory(motion, moving=True)
    assert points.velocities is None
    np.testing.assert_array_equal(points.times, [0, 1, 3])
    np.testing.assert_array_equal(points.positions, motion.values)
    assert scara.from_joint_trajectory(points).Sample(2.0)[1] == pytest.approx(1.0)


def moving_points(robot, velocity):
    times = np.linspace(0, 1, 11)
    columns = np.zeros((11, 4))
    columns[:, 0] = velocity * times
    rates = np.zeros((11, 4))
    rates[:, 0] = velocity
    return robot.from_joint_trajectory(
        ravemj.JointTrajectory([f"joint{n}" for n in (1, 2, 3, 4)], times, columns, rates)
    )


def test_motion_at_the_ends_has_to_be_asked_for(scara):
    trajectory = moving_points(scara, 0.5)
    with pytest.raises(ArgumentError, match=r"'joint1' moves at 0.5 rad/s at 0 s, the start.*--moving"):
        scara.to_joint_trajectory(trajectory)
    assert scara.to_joint_trajectory(trajectory, moving=True).velocities[-1, 0] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda robot: robot.SetDOFLimits([-0.2, -1, 0, -1], [0.5, 1, 1, 1]), r"'joint1' is at 1 rad, 0.5 rad outside"),
        (
            lambda robot: robot.SetDOFVelocityLimits([0.4, 9, 9, 9]),
            r"'joint1' has a velocity of .* at .* its limit is 0.4",
        ),
        (
            lambda robot: robot.SetDOFAccelerationLimits([99, 99, 0.1, 99]),
            r"'joint3' has an acceleration of .* is 0.1 m/s\^2",
        ),
    ],
)
def test_what_is_beyond_a_limit_is_named(change, message):
    robot = ravemj.load(ravemj.model_path("scara")).GetRobots()[0]
    trajectory = timed(robot, [[0, 0, 0, 0], [1.0, 0.5, 0.15, -0.5]], "ParabolicTrajectoryRetimer")
    change(robot)
    with pytest.raises(ArgumentError, match=message):
        robot.to_joint_trajectory(trajectory)


def test_a_motion_outside_of_the_limits_is_named_with_its_time(scara):
    with pytest.raises(
        ArgumentError, match=r"'joint3' is at 0.4 m, 0.205 m outside of its limits \[0, 0.195\], at 2 s"
    ):
        scara.to_joint_trajectory(ravemj.Motion([0, 2], [[0] * 4, [0, 0, 0.4, 0]]))


def test_the_first_point_is_the_measured_state(scara):
    motion = ravemj.Motion.line([0] * 4, [0.5] * 2 + [0.1, 0.5])
    scara.to_joint_trajectory(motion, start=[0.009, 0, 0, 0])
    with pytest.raises(ArgumentError, match=r"'joint2' starts at 0 rad, and the robot is at -0.02 rad, 0.02 rad apart"):
        scara.to_joint_trajectory(motion, start=[0, -0.02, 0, 0])
    with pytest.raises(ArgumentError, match="start"):
        scara.to_joint_trajectory(motion, start=[0.0])


@given(st.integers(-3, 3), st.floats(-0.009, 0.009))
@examples(30)
def test_continuous_joints_are_shifted_by_whole_turns(turns, offset):
    robot = ravemj.load(ravemj.model_path("pendulum")).GetRobots()[0]
    here = 0.5 + turns * 2 * math.pi + offset
    points = robot.to_joint_trajectory(ravemj.Motion.line([0.5, 0], [3.5, 1]), start=[here, 0])
    assert points.positions[0, 0] == pytest.approx(0.5 + turns * 2 * math.pi)
    assert np.ptp(points.positions[:, 0]) == pytest.approx(3.0)


def test_a_continuous_joint_does_not_jump(robot):
    trajectory = timed(robot, [[3.0, 0.0], [-3.0, 0.5], [-2.0, 0.0]], "CubicTrajectoryRetimer")
    points = robot.to_joint_trajectory(trajectory)
    assert np.abs(np.diff(points.positions[:, 0])).max() < 0.1
    assert points.positions[-1, 0] == pytest.approx(2 * math.pi - 2.0)


def test_a_moving_base_is_refused(scara):
    spec = scara.GetActiveConfigurationSpecification("linear") + ravemj.ConfigurationSpecification(
        ravemj.ConfigurationSpecification.Group(f"affine_transform {scara.GetName()} 3", 0, 2, "linear")
    )
    spec.AddDeltaTimeGroup()
    trajectory = ravemj.RaveCreateTrajectory(scara.GetEnv(), "")
    trajectory.Init(spec)
    trajectory.Insert(0, [0, 0, 0, 0, 0, 0, 0, 0.1, 0.1, 0.1, 0.1, 0.5, 0.5, 1])
    with pytest.raises(ArgumentError, match="moves the base of 'scara'"):
        scara.to_joint_trajectory(trajectory)


def test_grabs_of_a_trajectory_are_refused(scara):
    spec = scara.GetActiveConfigurationSpecification("linear") + ravemj.ConfigurationSpecification(
        ravemj.ConfigurationSpecification.Group(f"grab {scara.GetName()} 4", 0, 1, "previous")
    )
    spec.AddDeltaTimeGroup()
    trajectory = ravemj.RaveCreateTrajectory(scara.GetEnv(), "")
    trajectory.Init(spec)
    names = [group.name.split()[0] for group in spec.GetGroups()]
    row = {"joint_values": [0.0, 0, 0, 0], "grab": [1.0], "deltatime": [1.0]}
    trajectory.Insert(0, [number for _ in range(2) for name in names for number in row[name]], spec)
    with pytest.raises(ArgumentError, match="grabs or releases bodies"):
        scara.to_joint_trajectory(trajectory)


def test_other_robots_are_refused():
    env = ravemj.load(ravemj.model_path("workshop"))
    first, second = env.GetRobots()[:2]
    trajectory = timed(second, [second.GetDOFValues(), second.GetDOFValues() + 1e-2], "ParabolicTrajectoryRetimer")
    with pytest.raises(ArgumentError, match=f"moves '{second.GetName()}', too"):
        first.to_joint_trajectory(trajectory)


def test_one_waypoint_or_another_number_of_joints_is_refused(scara):
    with pytest.raises(ArgumentError, match="the motion has 2 joints, and 'scara' has 4 DOFs"):
        scara.to_joint_trajectory(ravemj.Motion.line([0, 0], [1, 1]))
    with pytest.raises(ArgumentError, match="no two different rows"):
        scara.to_joint_trajectory(ravemj.Motion([0], [[0, 0, 0, 0]]))
    with pytest.raises(ArgumentError, match="rate"):
        scara.to_joint_trajectory(ravemj.Motion.line([0] * 4, [0.1] * 4), rate=0)


def test_a_grabbed_body_is_a_warning(scara):
    env = scara.GetEnv()
    body = ravemj.RaveCreateKinBody(env, "")
    body.InitFromBoxes(np.array([[0, 0, 0, 0.1, 0.1, 0.1]]))
    body.SetName("box")
    env.Add(body, True)
    try:
        scara.Grab(body, scara.GetLinks()[-1])
        with pytest.warns(RavemjWarning, match="holds 'box'"):
            scara.to_joint_trajectory(ravemj.Motion.line([0] * 4, [0.1] * 4))
    finally:
        scara.ReleaseAllGrabbed()
        env.Remove(body)


# Files

names = st.lists(
    st.text(st.characters(codec="utf-8", exclude_categories=["C", "Z"]), min_size=1, max_size=6), unique=True
)
numbers = st.floats(-1e6, 1e6, allow_subnormal=False)


@st.composite
def trajectories(draw):
    known = draw(names.filter(bool).filter(lambda found: not any(name.startswith("#") for name in found)))
    steps = draw(st.lists(st.integers(1, 10**10), min_size=1, max_size=4))
    shape = len(steps), len(known)
    rows = [draw(hnp.arrays(float, shape, elements=numbers)) for _ in range(draw(st.integers(1, 3)))]
    units = draw(st.lists(st.sampled_from(["rad", "m"]), min_size=len(known), max_size=len(known)))
    return ravemj.JointTrajectory(known, np.cumsum(steps) / 1e9, *rows, units=units)


@pytest.mark.parametrize("suffix", [".json", ".yaml", ".yml", ".ros2.csv"])
@given(given=trajectories())
@examples(60)
def test_files_hold_the_very_numbers(tmp_path_factory, suffix, given):
    if suffix.startswith(".y"):
        pytest.importorskip("yaml")
    path = tmp_path_factory.mktemp("files") / f"motion{suffix}"
    ravemj.write_joint_trajectory(path, given, ["a note", "two\nlines"])
    read = ravemj.read_joint_trajectory(path)
    assert read.joint_names == given.joint_names
    np.testing.assert_allclose(read.times, given.times, rtol=1e-15, atol=1e-9)
    for name in ("positions", "velocities", "accelerations"):
        np.testing.assert_array_equal(getattr(read, name), getattr(given, name))
    assert read.units == (given.units if suffix == ".ros2.csv" else ("rad or m",) * len(given.joint_names))
    assert ("# a note" in path.read_text(encoding="utf-8")) == (suffix != ".json")


def test_what_ros2_topic_echo_prints_is_read(tmp_path):
    pytest.importorskip("yaml")
    (tmp_path / "echo.yaml").write_text(ECHO)
    read = ravemj.read_joint_trajectory(tmp_path / "echo.yaml")
    assert read.joint_names == ("joint1", "joint4")
    np.testing.assert_array_equal(read.times, [0, 1.5])
    np.testing.assert_array_equal(read.positions, [[0.1, 0.2], [0.3, -0.4]])
    assert read.velocities is None


def test_times_of_ros_1_are_read(tmp_path):
    pytest.importorskip("yaml")
    (tmp_path / "echo.yml").write_text(ECHO.replace("nanosec:", "nsecs:").replace("sec:", "secs:"))
    np.testing.assert_array_equal(ravemj.read_joint_trajectory(tmp_path / "echo.yml").times, [0, 1.5])


POINT = {"positions": [0.1], "time_from_start": {"sec": 0, "nanosec": 0}}


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{", "m.json:1: error: not JSON"),
        ("[" * 100_000, "not JSON"),
        ("[1]", "found list, expected joint_names and points"),
        ({"joint_names": ["a"]}, "found joint_names, expected joint_names and points"),
        ({"joint_names": [1], "points": [POINT]}, "joint_names: expected texts"),
        ({"joint_names": ["a", "a"], "points": [{**POINT, "positions": [1, 2]}]}, "'a' is there twice"),
        ({"joint_names": ["a"], "points": ["..."]}, r"points\[0\]: found '...'.*--full-length"),
        ({"joint_names": ["a"], "points": [{**POINT, "positions": [1, 2]}]}, r"points\[0\].positions: .* 1 numbers"),
        ({"joint_names": ["a"], "points": [{**POINT, "positions": ["1"]}]}, r"found '1', expected a finite number"),
        ({"joint_names": ["a"], "points": [{**POINT, "positions": [math.nan]}]}, "found nan"),
        ({"joint_names": ["a"], "points": [{**POINT, "positions": [10**400]}]}, "expected a finite number"),
        ({"joint_names": ["a"], "points": [{**POINT, "positions": [True]}]}, "found True"),
        ({"joint_names": ["a"], "points": [{**POINT, "positions": {}}]}, "found {}"),
        (
            {"joint_names": ["a"], "points": [{"positions": [1]}]},
            r"time_from_start: found None, expected sec and nanosec",
        ),
        ({"joint_names": ["a"], "points": [POINT, POINT]}, "times"),
        ({"joint_names": ["a"], "points": [{**POINT, "velocities": [1]}, POINT]}, r"points\[1\] has no velocities"),
        ({"joint_names": ["a"], "points": [{**POINT, "positions": []}]}, "no positions"),
        ({"joint_names": ["a"], "points": [{**POINT, "accelerations": [1]}]}, "need velocities"),
    ],
)
def test_broken_messages_are_named(tmp_path, content, message):
    path = tmp_path / "m.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    with pytest.raises(SourceError, match=message) as found:
        ravemj.read_joint_trajectory(path)
    assert str(path) in str(found.value)
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time,a\n0,1\n", r"no column 'time \[s\]'"),
        ("time [s],a\n0,1\n", "column 2 is named 'a'.*NAME position"),
        ("time [s],a position [deg]\n0,1\n", r"'a position \[deg\]'"),
        ("time [s],a velocity [rad/s]\n0,1\n", "'a' has no column of its position"),
        ("time [s],a position [m],b position [m],b velocity [m/s]\n0,1,2,3\n", "'a' has no column of its velocity"),
        ("time [s],a position [m]\n0,x\n", "csv:2: error: 'x' is not a finite number"),
    ],
)
def test_broken_tables_are_named(tmp_path, text, message):
    path = tmp_path / "m.ros2.csv"
    path.write_text(text)
    with pytest.raises(SourceError, match=message):
        ravemj.read_joint_trajectory(path)


@pytest.mark.parametrize("text", ["a: [", "a: !!python/object:os.system {}", "a: 1\n---\nb: 2\n", "&a [*a]", ""])
def test_broken_yaml_is_named(tmp_path, text):
    pytest.importorskip("yaml")
    path = tmp_path / "m.yaml"
    path.write_text(text)
    with pytest.raises(SourceError, match=r"m\.yaml"):
        ravemj.read_joint_trajectory(path)


def test_without_pyyaml_the_extra_is_named(tmp_path, monkeypatch):
    original = builtins.__import__

    def without(name, *rest):
        if name == "yaml":
            raise ImportError
        return original(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    points = ravemj.JointTrajectory(["a"], [0], [[1]])
    with pytest.raises(ArgumentError, match=r"pip install 'ravemj\[yaml\]'"):
        ravemj.write_joint_trajectory(tmp_path / "m.yaml", points)
    assert not list(tmp_path.iterdir())
    ravemj.write_joint_trajectory(tmp_path / "m.json", points)


def test_unknown_joints_are_refused(scara):
    points = ravemj.JointTrajectory(["joint5"], [0], [[1]])
    with pytest.raises(ArgumentError, match="'joint5' is not a joint of 'scara'; did you mean 'joint"):
        scara.from_joint_trajectory(points)


def test_renaming(scara):
    points = scara.to_joint_trajectory(ravemj.Motion.line([0] * 4, [0.1] * 4))
    assert points.renamed({"joint2": "elbow"}).joint_names == ("joint1", "elbow", "joint3", "joint4")
    with pytest.raises(ArgumentError, match="'joint1' is there twice"):
        points.renamed({"joint2": "joint1"})


def test_two_times_in_one_nanosecond_are_refused(tmp_path):
    points = ravemj.JointTrajectory(["a"], [0, 1e-10], [[1], [2]])
    with pytest.raises(ArgumentError, match="nanosecond"):
        ravemj.write_joint_trajectory(tmp_path / "m.json", points)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((["a"], [0, 0], [[1], [1]]), "times"),
        ((["a"], [-1, 0], [[1], [1]]), "times"),
        ((["a"], [], np.zeros((0, 1))), "times"),
        ((["a"], [0], [[1, 2]]), r"positions: found shape \(1, 2\), expected \(1, 1\)"),
        ((["a"], [0], [[math.inf]]), "positions"),
        ((["a"], [0], [[1]], None, [[1]]), "velocities"),
    ],
)
def test_wrong_points_are_refused(arguments, message):
    with pytest.raises(ArgumentError, match=message):
        ravemj.JointTrajectory(*arguments)
