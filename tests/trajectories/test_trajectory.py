"""Trajectories: waypoints, interpolation against mathematics, storage."""

import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravemj
from ravemj import ArgumentError, ConfigurationSpecification, OutputError, RavemjError
from ravemj.trajectories.groups import INTERPOLATIONS, JOINTS, Group
from ravemj.trajectories.interpolation import DERIVATIVES

ENV = ravemj.load("models/env.xml")  # which tests of RaveDestroy in the same process may empty
ROBOT = ENV.GetRobots()[0].GetName()


def spec_of(*groups):
    spec = ConfigurationSpecification()
    for name, dof, *interpolation in groups:
        spec.AddGroup(name, dof, *interpolation)
    return spec


def trajectory_of(spec, rows=(), env=ENV):
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    trajectory.Insert(0, np.array(rows))
    return trajectory


TIMED = spec_of((f"joint_values {ROBOT} 0 1", 2, "linear"), ("deltatime", 1))
numbers = st.floats(-100, 100).map(lambda x: round(x, 3))
steps = st.integers(1, 300).map(lambda n: n / 100)


# ---------------------------------------------------------------------------------------------------- interpolation


def polynomial_motion(coefficients, interpolation, times):
    """A trajectory whose waypoints lie on a polynomial, with all derivatives that the interpolation uses."""
    spec = spec_of((f"{JOINTS[0]} arm 0", 1, interpolation), ("deltatime", 1))
    for order in range(1, DERIVATIVES[interpolation] + 1):
        spec.AddDerivativeGroups(order)
    polynomials = [np.polynomial.Polynomial(coefficients).deriv(order) for order in range(len(JOINTS))]
    rows = np.zeros((len(times), spec.GetDOF()))
    for group in spec.GetGroups():
        if group.kind in JOINTS:
            rows[:, group.offset] = polynomials[JOINTS.index(group.kind)](np.array(times))
    rows[1:, spec.GetGroupFromName("deltatime").offset] = np.diff(times)
    return trajectory_of(spec, rows), polynomials


@pytest.mark.parametrize("interpolation", INTERPOLATIONS[2:])
@given(data=st.data())
def test_polynomials_of_the_degree_are_reproduced_with_their_derivatives(interpolation, data):
    """The highest derivatives lack derivatives of their own, and are those of the positions or velocities."""
    times = [0.0, *np.cumsum(data.draw(st.lists(steps, min_size=1, max_size=3)))]
    degree = INTERPOLATIONS.index(interpolation)
    coefficients = data.draw(st.lists(st.floats(-2, 2), min_size=degree + 1, max_size=degree + 1))
    trajectory, polynomials = polynomial_motion(coefficients, interpolation, times)
    spec = trajectory.GetConfigurationSpecification()
    scale = 1 + sum(abs(c) * max(1, times[-1]) ** i for i, c in enumerate(coefficients))
    for part in (0, 0.3, 0.77, 1):
        sample = trajectory.Sample(part * times[-1])
        for order in range(DERIVATIVES[interpolation] + 1):
            expected = polynomials[order](part * times[-1])
            assert sample[spec.GetGroupFromName(JOINTS[order]).offset] == pytest.approx(expected, abs=1e-7 * scale)


@st.composite
def motions(draw):
    """Waypoints with values and all derivatives at random."""
    interpolation = draw(st.sampled_from(["linear", "cubic", "quintic"]))
    spec = spec_of(("joint_values arm 0 1", 2, interpolation), ("deltatime", 1))
    for order in range(1, DERIVATIVES[interpolation] + 1):
        spec.AddGroup(f"{JOINTS[order]} arm 0 1", 2, INTERPOLATIONS[INTERPOLATIONS.index(interpolation) - order])
    count = draw(st.integers(1, 4))
    row = st.lists(numbers, min_size=spec.GetDOF(), max_size=spec.GetDOF())
    rows = np.array(draw(st.lists(row, min_size=count, max_size=count)))
    rows[:, 2] = [0, *draw(st.lists(steps, min_size=count - 1, max_size=count - 1))]
    return trajectory_of(spec, rows)


@given(motions())
def test_samples_hit_the_waypoints(trajectory):
    rows = trajectory.GetAllWaypoints2D()
    for time, row in zip(np.cumsum(rows[:, 2]), rows, strict=True):
        np.testing.assert_allclose(trajectory.Sample(time)[:2], row[:2], atol=1e-9)
    np.testing.assert_array_equal(trajectory.Sample(trajectory.GetDuration() + 1), rows[-1])


@given(motions())
def test_velocities_at_waypoints_are_those_given(trajectory):
    spec, rows = trajectory.GetConfigurationSpecification(), trajectory.GetAllWaypoints2D()
    group = spec.FindTimeDerivativeGroup("joint_values arm")
    for time, row in zip(np.cumsum(rows[:-1, 2]), rows[:-1], strict=True):
        if group is not None:
            np.testing.assert_allclose(trajectory.Sample(time + 1e-12)[group.columns], row[group.columns], atol=1e-2)


def test_velocities_without_their_derivative_come_from_positions():
    """The slope of the cubic positions is what quadratic velocities are."""
    spec = spec_of(("joint_values arm 0", 1, "cubic"), ("joint_velocities arm 0", 1, "quadratic"), ("deltatime", 1))
    trajectory = trajectory_of(spec, [[0, 1, 0], [2, -1, 0.5]])
    for time in (0.1, 0.25, 0.4):
        left, right = trajectory.Sample(time - 1e-5)[0], trajectory.Sample(time + 1e-5)[0]
        assert trajectory.Sample(time)[1] == pytest.approx((right - left) / 2e-5, abs=1e-6)


@pytest.mark.parametrize(
    ("interpolation", "expected"),
    [("previous", [1, 1, 1, 5]), ("next", [1, 5, 5, 5]), ("", [1, 5, 5, 5]), ("max", [1, 5, 5, 5])],
)
def test_values_that_jump(interpolation, expected):
    trajectory = trajectory_of(spec_of(("grab arm 0", 1, interpolation), ("deltatime", 1)), [[1, 0], [5, 2], [3, 1]])
    assert [trajectory.Sample(time)[0] for time in (0, 1, 1.99, 2)] == expected
    assert trajectory.Sample(2.5)[0] == {"previous": 5, "max": 5}.get(interpolation, 3)
    assert trajectory.Sample(3)[0] == 3


@pytest.mark.parametrize("interpolation", INTERPOLATIONS[2:])
def test_interpolations_that_lack_derivatives(interpolation):
    spec = spec_of(("joint_values arm 0", 1, interpolation), ("deltatime", 1))
    for order in range(1, DERIVATIVES[interpolation]):
        spec.AddDerivativeGroups(order)
    trajectory = trajectory_of(spec, [[0] * spec.GetDOF(), [1] * spec.GetDOF()])
    with pytest.raises(ArgumentError, match="needs"):
        trajectory.Sample(0.5)


def test_interpolations_that_are_not_there():
    trajectory = trajectory_of(spec_of(("joint_values arm 0", 1, "spline"), ("deltatime", 1)), [[0, 0], [1, 1]])
    with pytest.raises(ArgumentError, match="no interpolation 'spline'"):
        trajectory.Sample(0.5)
    ik = trajectory_of(spec_of(("ikparam_values 1728053249", 7, "cubic"), ("deltatime", 1)), [[0] * 8, [1] * 8])
    with pytest.raises(NotImplementedError, match="'cubic' interpolation of goals"):
        ik.Sample(0.5)


@pytest.mark.parametrize("sign", [1, -1])
def test_goals_between_waypoints_turn_evenly_the_short_way(sign):
    turned = sign * np.array([np.cos(0.5), 0, 0, np.sin(0.5)])  # one radian about z
    rows = [[1, 0, 0, 0, 0, 0, 0, 0], [*turned, 1, 2, 3, 1]]
    trajectory = trajectory_of(spec_of(("ikparam_values 1728053249", 7, "linear"), ("deltatime", 1)), rows)
    sample = trajectory.Sample(0.25)
    assert np.abs(sample[:4]) == pytest.approx([np.cos(0.125), 0, 0, np.sin(0.125)])
    assert sample[4:7] == pytest.approx([0.25, 0.5, 0.75])


def test_velocities_of_other_interpolations_are_no_derivatives():
    """Positions and velocities that are both linear have nothing to do with one another."""
    spec = spec_of(("joint_values arm 0", 1, "linear"), ("joint_velocities arm 0", 1, "linear"), ("deltatime", 1))
    assert trajectory_of(spec, [[0, 7, 0], [1, 9, 1]]).Sample(0.5).tolist() == [0.5, 8, 0.5]


# ---------------------------------------------------------------------------------------------------- waypoints

rows3 = st.lists(st.lists(numbers, min_size=3, max_size=3), max_size=6)


@given(rows3, rows3, st.data())
def test_insert_and_remove_are_those_of_lists(present, added, data):
    trajectory = trajectory_of(TIMED, present)
    index = data.draw(st.integers(0, len(present)))
    trajectory.Insert(index, np.array(added))
    expected = present[:index] + added + present[index:]
    assert trajectory.GetAllWaypoints2D().tolist() == expected
    start = data.draw(st.integers(0, len(expected)))
    end = data.draw(st.integers(start, len(expected)))
    assert trajectory.GetWaypoints2D(start, end).tolist() == expected[start:end]
    assert trajectory.GetWaypoints(start, end).tolist() == [x for row in expected[start:end] for x in row]
    assert trajectory[start:end].tolist() == expected[start:end]
    trajectory.Remove(start, end)
    assert [row.tolist() for row in trajectory] == expected[:start] + expected[end:]
    assert len(trajectory) == trajectory.GetNumWaypoints() == len(expected) - (end - start)


@given(rows3, rows3, st.data())
def test_overwriting_is_that_of_lists(present, added, data):
    trajectory = trajectory_of(TIMED, present)
    index = data.draw(st.integers(0, len(present)))
    trajectory.Insert(index, np.array(added), True)
    expected = present[:index] + added + present[index + len(added) :]
    assert trajectory.GetAllWaypoints2D().tolist() == expected


def test_insert_in_another_layout():
    env = ravemj.load("models/env.xml")
    env.GetRobots()[0].SetDOFValues([0.25, 0.5])
    trajectory = trajectory_of(TIMED, [[1, 2, 3]], env)
    second = spec_of(("affine_transform x 1", 1), (f"joint_values {ROBOT} 1", 1))
    trajectory.Insert(0, [9, 7, 9, 8], second, True)
    assert trajectory.GetAllWaypoints2D().tolist() == [[1, 7, 3], [0.25, 8, 0]]
    trajectory.Insert(1, [6], group=Group("deltatime", 5, 1))
    assert trajectory.GetWaypoint(1).tolist() == [0, 0, 6]
    assert trajectory.GetWaypoint(0, second).tolist() == [0, 7]
    np.testing.assert_array_equal(trajectory.GetAllWaypoints2D(Group("deltatime", 0, 1)), [[3], [6], [0]])
    full = env.GetRobots()[0].GetConfigurationSpecification()
    np.testing.assert_allclose(trajectory.GetWaypoint(-1, full)[:2], [0.25, 8])


def test_what_goes_wrong_changes_nothing():
    trajectory = trajectory_of(TIMED, [[1, 2, 3]])
    for call in (
        lambda: trajectory.Insert(0, [1, 2]),
        lambda: trajectory.Insert(2, [1, 2, 3]),
        lambda: trajectory.Insert(-1, [1, 2, 3]),
        lambda: trajectory.Insert(0, ["x"]),
        lambda: trajectory.Insert(0, [1], ConfigurationSpecification()),
        lambda: trajectory.Remove(1, 0),
        lambda: trajectory.Remove(0, 2),
        lambda: trajectory.GetWaypoints(0, 2),
        lambda: trajectory.GetWaypoint(-2),
        lambda: trajectory.Sample(math.nan),
        lambda: trajectory.SamplePointsSameDeltaTime2D(0, True),
        lambda: trajectory.deserialize("<trajectory>"),
    ):
        with pytest.raises(ArgumentError):
            call()
    assert trajectory.GetAllWaypoints2D().tolist() == [[1, 2, 3]]


def test_before_a_specification():
    trajectory = ravemj.RaveCreateTrajectory(ENV, "")
    for call in (trajectory.GetDuration, trajectory.serialize, lambda: trajectory.Sample(0), lambda: len(trajectory)):
        with pytest.raises(RavemjError, match="Init"):
            call()
    assert trajectory.GetConfigurationSpecification().GetDOF() == 0
    assert trajectory
    assert str(trajectory) == "<trajectory:GenericTrajectory, not initialized>"


def test_answers_are_copies():
    given = np.array([[1.0, 2, 0], [3, 4, 1]])
    trajectory = trajectory_of(TIMED, given)
    for array in (given, trajectory.GetAllWaypoints2D(), trajectory.GetWaypoint(0), trajectory.Sample(1)):
        array[...] = 9
    trajectory.GetConfigurationSpecification().RemoveGroups("deltatime")
    assert trajectory.GetAllWaypoints2D().tolist() == [[1, 2, 0], [3, 4, 1]]
    assert trajectory.GetConfigurationSpecification() == TIMED


@given(motions(), st.lists(st.floats(0, 10), max_size=4), st.floats(0.05, 2))
def test_many_samples_are_single_ones(trajectory, times, step):
    many = trajectory.SamplePoints2D(times)
    assert many.shape == (len(times), trajectory.GetConfigurationSpecification().GetDOF())
    for time, row in zip(times, many, strict=True):
        np.testing.assert_array_equal(row, trajectory.Sample(time))
    duration = trajectory.GetDuration()
    regular = trajectory.SamplePointsSameDeltaTime2D(step, True)
    np.testing.assert_array_equal(regular[-1], trajectory.Sample(duration))
    np.testing.assert_array_equal(trajectory.SamplePointsSameDeltaTime2D(step, False), regular[:-1])
    assert len(regular) - 1 == math.ceil(duration / step)
    some = spec_of(("joint_values arm 1", 1))
    np.testing.assert_array_equal(trajectory.SamplePoints2D(times, some)[:, 0], many[:, 1])


def test_ranges_of_samples():
    trajectory = trajectory_of(TIMED, [[0, 0, 0], [1, 2, 1]])
    assert trajectory.SampleRangeSameDeltaTime2D(0.25, 0.25, 0.75, False)[:, 0].tolist() == [0.25, 0.5]
    assert trajectory.SampleRangeSameDeltaTime2D(0.25, 0.25, 0.75, True)[:, 0].tolist() == [0.25, 0.5, 1.0]


def test_samples_in_another_layout():
    env = ravemj.load("models/env.xml")
    env.GetRobots()[0].SetDOFValues([0.25, 0.5])
    one_joint = spec_of((f"joint_values {ROBOT} 1", 1, "linear"), ("deltatime", 1))
    trajectory = trajectory_of(one_joint, [[0, 0], [1, 2]], env)
    assert trajectory.Sample(1, TIMED).tolist() == [0.25, 0.5, 2]
    assert trajectory.Sample(1).tolist() == [0.5, 1]
    assert trajectory.SampleFromPrevious([7, 8, 9], 1, TIMED).tolist() == [7, 0.5, 2]


@given(rows3.filter(len), st.floats(0, 20))
def test_first_waypoint_after(rows, time):
    rows = [[a, b, abs(c) / 10] for a, b, c in rows]
    trajectory = trajectory_of(TIMED, rows)
    times = np.cumsum([row[2] for row in rows])
    assert trajectory.GetDuration() == times[-1]
    expected = next((index for index, reached in enumerate(times) if reached >= time), len(rows))
    assert trajectory.GetFirstWaypointIndexAfterTime(time) == (len(rows) if time >= times[-1] else expected)


def test_no_waypoints():
    trajectory = trajectory_of(TIMED)
    assert trajectory.GetDuration() == 0
    assert trajectory.GetFirstWaypointIndexAfterTime(0) == 0
    assert trajectory.GetAllWaypoints2D().shape == (0, 3)
    with pytest.raises(ArgumentError, match="needs a waypoint"):
        trajectory.Sample(0)


def test_groups_are_in_the_order_of_openrave():
    spec = spec_of(("what", 1), ("joint_values arm 0", 1, "cubic"))
    spec.AddDerivativeGroups(1, True)
    names = [group.kind for group in trajectory_of(spec).GetConfigurationSpecification().GetGroups()]
    assert names == ["deltatime", "joint_velocities", "joint_values", "what"]


# ---------------------------------------------------------------------------------------------------- storage

descriptions = st.text(st.characters(min_codepoint=32, exclude_categories=["Cs"]), max_size=9) | st.just("a]]>b<c>&")
anything = st.floats(allow_nan=False)


@given(st.lists(st.tuples(anything, anything, anything), max_size=4), descriptions, st.sampled_from([0, 0x8000, None]))
def test_stored_trajectories_come_back(rows, description, options):
    trajectory = trajectory_of(TIMED, rows)
    trajectory.SetDescription(description)
    stored = trajectory.serialize(options)
    texts = [stored.decode()] if options else [stored.decode("latin-1"), stored.decode(errors="surrogateescape")]
    for form in (stored, *texts):
        back = ravemj.RaveCreateTrajectory(ENV, "").deserialize(form)
        assert back.GetAllWaypoints2D().tolist() == trajectory.GetAllWaypoints2D().tolist()
        assert back.GetConfigurationSpecification() == TIMED
        assert back.GetDescription() == description


def test_files(tmp_path):
    trajectory = trajectory_of(TIMED, [[1, 2, 0], [3, 4, 1 / 3]])
    for options in (None, 0x8000):
        trajectory.SaveToFile(tmp_path / "motion", options)
        back = ravemj.RaveCreateTrajectory(ENV, "")
        back.LoadFromFile(tmp_path / "motion")
        assert back.GetAllWaypoints2D().tolist() == trajectory.GetAllWaypoints2D().tolist()
    with pytest.raises(OutputError, match="cannot write"):
        trajectory.SaveToFile(tmp_path / "missing" / "motion")
    with pytest.raises(RavemjError, match="cannot read"):
        trajectory.LoadFromFile(tmp_path / "missing")


def binary(version=2, tail=b""):
    """A trajectory of one number, put together by hand."""
    name = b"deltatime"
    group = struct.pack("<H", len(name)) + name + struct.pack("<iiH", 0, 1, 0)
    return (
        struct.pack("<HHH", 0x62FF, version, 1)
        + group
        + struct.pack("<Id", 1, 0.25)
        + struct.pack("<H", 2)
        + b"hi"
        + tail
    )


def test_the_binary_form_is_openraves():
    trajectory = trajectory_of(Group("deltatime", 0, 1), [[0.25]])
    trajectory.SetDescription("hi")
    assert trajectory.serialize() == binary(2, b"\0\0")
    for version, tail in [(1, b""), (2, b"\0\0"), (3, b"\1\0" + 3 * b"\1\0x")]:
        back = ravemj.RaveCreateTrajectory(ENV, "").deserialize(binary(version, tail))
        assert (back.GetDescription(), back.GetWaypoint(0).tolist()) == ("hi", [0.25])


@pytest.mark.parametrize("size", range(2, len(binary())))
def test_binary_forms_that_break_off(size):
    with pytest.raises(ArgumentError, match="breaks off"):
        ravemj.RaveCreateTrajectory(ENV, "").deserialize(binary()[:size])


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (binary(4), "version 4"),
        (b"\x80\x81", "neither"),
        ("", "empty"),
        ("<Robot/>", "should start with <trajectory>"),
        ("<trajectory><data>1 x</data></trajectory>", "should hold numbers"),
        ("<trajectory><data>1</data></trajectory>", "multiple of 0"),
        (
            "<trajectory><configuration><group name='a' dof='2'/></configuration><data>1 2 3</data></trajectory>",
            "multiple of 2",
        ),
        ("<trajectory><configuration><group dof='-2'/></configuration></trajectory>", "has -2 values"),
        ("<trajectory><configuration><group dof='1e21'/></configuration></trajectory>", "integers"),
        (f"<trajectory><configuration><group dof='{10**400}'/></configuration></trajectory>", "at most"),
        (f"<trajectory><configuration><group dof='{10**21}'/></configuration></trajectory>", "at most"),
        (
            "<trajectory><configuration><group name='a' dof='1'/><group name='deltatime' offset='1' dof='0'/>"
            "</configuration><data count='1'>1</data></trajectory>",
            "'deltatime' has 0 values",
        ),
        (
            "<trajectory><configuration><group name='a' dof='1'/><group name='deltatime' dof='1'/></configuration>"
            "<data count='1'>1</data></trajectory>",
            "starts at 0, and should start at 1",
        ),
        (
            "<trajectory><configuration><group name='deltatime' offset='5' dof='1'/></configuration></trajectory>",
            "starts at 5",
        ),
    ],
)
def test_data_that_is_no_trajectory(data, message):
    with pytest.raises(ArgumentError, match=message):
        ravemj.RaveCreateTrajectory(ENV, "").deserialize(data)


def test_descriptions_that_are_too_long():
    trajectory = trajectory_of(TIMED)
    trajectory.SetDescription("x" * 70000)
    with pytest.raises(ArgumentError, match="70000 bytes"):
        trajectory.serialize()


# ---------------------------------------------------------------------------------------------------- the object


def test_clones_and_swaps():
    first, second = trajectory_of(TIMED, [[1, 2, 3]]), trajectory_of(Group("x", 0, 1), [[7], [8]])
    first.SetDescription("first")
    clone = ravemj.RaveCreateTrajectory(ENV, "")
    clone.Clone(first, 0)
    first.Insert(0, [4, 5, 6])
    assert clone.GetAllWaypoints2D().tolist() == [[1, 2, 3]]
    assert clone.GetDescription() == "first"
    first.Swap(second)
    assert (len(first), len(second)) == (2, 2)
    assert first.GetConfigurationSpecification().GetDOF() == 1
    clone.Clone(ravemj.RaveCreateTrajectory(ENV, ""))
    assert clone.GetConfigurationSpecification().GetDOF() == 0
    with pytest.raises(ravemj.openrave_exception, match="Clone: ref"):
        clone.Clone(None)


def test_names_and_data_of_users():
    trajectory = ravemj.RaveCreateTrajectory(ENV, "generictrajectory")
    assert trajectory.GetXMLId() == "generictrajectory"
    assert trajectory.GetEnv() is ENV
    assert repr(trajectory) == f"RaveCreateTrajectory({ENV!r}, 'generictrajectory')"
    assert ravemj.RaveCreateTrajectory(ENV, "nothing") is None
    thing = object()
    trajectory.SetUserData(thing)
    trajectory.SetUserData("name", [1])
    assert trajectory.GetUserData() is thing
    assert trajectory.GetUserData("name") == [1]
    assert trajectory.RemoveUserData("name")
    assert not trajectory.RemoveUserData("name")
    assert trajectory.GetUserData("name") is None
