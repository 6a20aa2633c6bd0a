"""Specifications: layouts there and back, merging, and data converted between them."""

import itertools
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravemj
from ravemj import ArgumentError, ConfigurationSpecification, DOFAffine, RaveGetAffineConfigurationSpecification
from ravemj.trajectories import conversion
from ravemj.trajectories.groups import INTERPOLATIONS, Group

Spec = ConfigurationSpecification
PARTS = [parts | kind for parts in range(8) for kind in (0, 8, 16, 32) if parts | kind]


def spec_of(*groups):
    spec = Spec()
    for name, dof, *interpolation in groups:
        spec.AddGroup(name, dof, *interpolation)
    return spec


def listed(spec):
    return [(group.name, group.offset, group.dof, group.interpolation) for group in spec.GetGroups()]


def joints(body, indices, interpolation="linear"):
    return (" ".join(["joint_values", body, *map(str, indices)]), len(indices), interpolation)


indices = st.lists(st.integers(0, 9), min_size=1, max_size=5, unique=True)
interpolations = st.sampled_from(["", "previous", "max", *INTERPOLATIONS])


@st.composite
def specs(draw):
    """Positions of up to three bodies, some with derivatives and time."""
    spec = Spec()
    for body in draw(st.lists(st.sampled_from(["arm", "hand", "box<&>"]), min_size=1, unique=True)):
        if draw(st.booleans()):
            spec.AddGroup(*joints(body, draw(indices), draw(interpolations)))
        else:
            parts = draw(st.sampled_from(PARTS))
            spec.AddGroup(f"affine_transform {body} {parts}", ravemj.RaveGetAffineDOF(parts), draw(interpolations))
    if draw(st.booleans()):
        spec.AddDerivativeGroups(draw(st.integers(1, 6)), draw(st.booleans()))
    return spec


@given(specs())
def test_texts_and_copies_are_equal(spec):
    for twin in (eval(repr(spec)), pickle.loads(pickle.dumps(spec, 2)), Spec(spec)):
        assert twin == spec
        assert listed(twin) == listed(spec)
        twin.AddGroup("something else", 1)
        assert twin != spec
    twin = Spec()
    twin.DeserializeJSON(spec.SerializeJSON())
    assert twin == spec
    assert spec.IsValid()
    spec.Validate()


@given(specs(), specs())
def test_sums_hold_both(first, second):
    total = first + second
    assert total.IsValid()
    assert total + first == total
    assert first + first == first
    assert total.GetDOF() <= first.GetDOF() + second.GetDOF()
    added = Spec(first)
    added += second
    assert added == total
    for group in itertools.chain(first.GetGroups(), second.GetGroups()):
        merged = total.FindCompatibleGroup(group)
        if group.kind.startswith("joint"):
            assert set(group.name.split()) <= set(merged.name.split())


def test_sums_of_poses_have_one_kind_of_rotation():
    for first, second, parts in [(9, 18, 19), (16, 39, 39), (32, 8, 32), (1, 8, 9)]:
        total = RaveGetAffineConfigurationSpecification(first) + RaveGetAffineConfigurationSpecification(second)
        assert listed(total) == [(f"affine_transform __dummy__ {parts}", 0, ravemj.RaveGetAffineDOF(parts), "")]


def test_sums_take_the_higher_interpolation():
    for first, second, total in [("linear", "cubic", "cubic"), ("", "next", "next"), ("previous", "linear", "linear")]:
        for order in ((first, second), (second, first)):
            merged = spec_of(joints("arm", [0], order[0])) + spec_of(joints("arm", [1], order[1]))
            assert listed(merged) == [("joint_values arm 0 1", 0, 2, total)]


def test_sums_that_cannot_be():
    with pytest.raises(ArgumentError, match="knows how to merge"):
        spec_of(("colour", 3)) + spec_of(("colour arm", 3))
    with pytest.raises(ArgumentError, match="1 values, and 2"):
        spec_of(("deltatime", 1)) + spec_of(("deltatime", 2))
    ik = spec_of(("ikparam_values 1728053249", 7))
    assert (ik + spec_of(("ikparam_values 855638019", 3))).GetDOF() == 10
    signals = spec_of(("outputSignals lamp door", 2)) + spec_of(("outputSignals door bell", 2))
    assert listed(signals) == [("outputSignals lamp door bell", 0, 3, "")]


def test_derivatives():
    spec = spec_of(joints("arm", [0, 1], "quintic"), ("affine_transform arm 39", 7, "linear"))
    spec.AddDerivativeGroups(2, True)
    assert listed(spec)[2:] == [
        ("joint_accelerations arm 0 1", 9, 2, "cubic"),
        ("affine_accelerations arm 39", 11, 7, "next"),
        ("deltatime", 18, 1, ""),
    ]
    before = listed(spec)
    spec.AddDerivativeGroups(2, True)
    assert listed(spec) == before
    assert listed(spec.GetTimeDerivativeSpecification(2)) == [
        ("joint_accelerations arm 0 1", 0, 2, "cubic"),
        ("affine_accelerations arm 39", 2, 7, "next"),
    ]
    derived = spec.GetTimeDerivativeSpecification(0).ConvertToDerivativeSpecification(2)
    assert derived == spec.GetTimeDerivativeSpecification(2)
    assert spec.FindTimeDerivativeGroup("joint_velocities arm").name == "joint_accelerations arm 0 1"
    assert spec.FindTimeIntegralGroup("joint_velocities arm").name == "joint_values arm 0 1"
    assert spec.FindTimeDerivativeGroup("joint_values arm") is None
    assert spec.FindTimeDerivativeGroup("deltatime") is None


def test_derivatives_of_another_size_are_replaced():
    spec = spec_of(("joint_velocities arm 0", 1, "next"), joints("arm", [0, 1]), ("deltatime", 1))
    spec.AddDerivativeGroups(1)
    assert listed(spec) == [
        ("joint_values arm 0 1", 0, 2, "linear"),
        ("deltatime", 2, 1, ""),
        ("joint_velocities arm 0 1", 3, 2, "next"),
    ]


def test_groups():
    spec = spec_of(("joint_values arm 0 1", 2), ("joint_values armlet 3", 1))
    assert spec.AddGroup("joint_values arm 0 1", 2) == 0
    assert spec.AddGroup(Group("deltatime", 77, 1)) == 3 == spec.AddDeltaTimeGroup()
    assert spec.GetGroupFromName("joint_values arm").name == "joint_values arm 0 1"
    assert spec.GetGroupFromName("joint_values arml").offset == 2
    assert Spec(Spec.Group("x", 5, 2, "next")) == spec_of(("x", 2, "next"))
    with pytest.raises(ArgumentError, match="conflicts"):
        spec.AddGroup("joint_values arm 2", 1)
    with pytest.raises(ArgumentError, match="2 values, not 3"):
        spec.AddGroup("joint_values arm 0 1", 3)
    with pytest.raises(ArgumentError, match="no group starts"):
        spec.GetGroupFromName("affine")
    spec.GetGroups()[0].name = "changed"
    assert spec.GetGroups()[0].name == "joint_values arm 0 1"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("<configuration>", "no element found"),
        ("<trajectory/>", "should start with <configuration>"),
        ("<configuration><group name='a' offset='1' dof='1'/></configuration>", "starts at 1"),
        ("<configuration><group name='a' offset='0' dof='x'/></configuration>", "integers"),
        ("<configuration><group name='a' offset='0' dof='0'/></configuration>", "0 values"),
        (
            "<configuration><group name='a' offset='0' dof='1'/><group name='a' offset='1' dof='1'/></configuration>",
            "two groups 'a'",
        ),
    ],
)
def test_texts_that_are_no_specification(text, message):
    with pytest.raises(ArgumentError, match=message):
        Spec(text)


# ---------------------------------------------------------------------------------------------------- data


def world_with_arm():
    """Return an environment with a body "arm" of ten joints that stands somewhere, and moves."""
    joint = (
        """<Joint name="j{0}" type="hinge"><Body>l{0}</Body><Body>l{1}</Body><limitsdeg>-90 90</limitsdeg></Joint>"""
    )
    parts = [f'<Body name="l{number}"/>' for number in range(11)] + [joint.format(n, n + 1) for n in range(10)]
    env = ravemj.Environment()
    assert env.LoadData(f'<Robot name="arm"><KinBody>{"".join(parts)}</KinBody></Robot>')
    arm = env.GetRobot("arm")
    arm.SetDOFValues(VALUES)
    arm.SetTransform([0.6, 0, 0.8, 0, 5, 6, 7])
    arm.SetDOFVelocities(-VALUES)
    return env


VALUES = np.arange(10) / 8
WORLD = world_with_arm()


@pytest.fixture(autouse=True, scope="module")
def _world():
    """Make the environment anew: ``RaveDestroy`` in tests of other files has emptied it."""
    global WORLD  # noqa: PLW0603 - hypothesis takes no fixtures of functions
    WORLD = world_with_arm()


@given(indices, indices, st.integers(0, 3))
def test_joint_values_come_from_the_data_or_the_body(present, wanted, rows):
    source, target = spec_of(joints("arm", present)), spec_of(joints("arm", wanted), ("deltatime", 1))
    data = np.arange(rows * len(present)).reshape(rows, len(present)) + 100.0
    got = source.ConvertData(target, data, rows, WORLD).reshape(rows, target.GetDOF())
    for column, index in enumerate(wanted):
        expected = data[:, present.index(index)] if index in present else np.full(rows, VALUES[index])
        np.testing.assert_array_equal(got[:, column], expected)
    assert (got[:, -1] == 0).all()
    previous = np.full(rows * target.GetDOF(), -1.0)
    kept = source.ConvertDataFromPrevious(previous, target, data, rows, WORLD).reshape(rows, target.GetDOF())
    missing = [index not in present for index in wanted]
    assert (kept[:, [*missing, True]] == -1).all()
    unfilled = source.ConvertData(target, data, rows, WORLD, False).reshape(rows, target.GetDOF())
    assert (unfilled[:, [*missing, True]] == 0).all()


@given(st.permutations(range(5)), st.permutations(range(5)), st.permutations(range(5)))
def test_conversions_compose(first, second, third):
    a, b, c = (spec_of(joints("arm", order), ("deltatime", 1)) for order in (first, second, third))
    data = np.arange(12.0)
    there = a.ConvertData(b, data, 2, None)
    np.testing.assert_array_equal(b.ConvertData(c, there, 2, None), a.ConvertData(c, data, 2, None))
    np.testing.assert_array_equal(b.ConvertData(a, there, 2, None), data)


angles = st.floats(-3, 3)


@given(st.tuples(angles, angles, angles), st.sampled_from([(16, 32), (32, 16)]))
def test_rotations_convert_to_the_same_rotation(turn, kinds):
    turn = np.array(turn) / 2
    source, target = (RaveGetAffineConfigurationSpecification(7 | kind) for kind in kinds)
    values = turn if kinds[0] == 16 else ravemj.quatFromAxisAngle(turn)
    got = source.ConvertData(target, [1, 2, 3, *values], 1, None)
    expected = ravemj.matrixFromAxisAngle(turn)
    expected[:3, 3] = [1, 2, 3]
    np.testing.assert_allclose(target.ExtractTransform(None, got, None), expected, atol=1e-9)


@pytest.mark.parametrize("kind", [16, 32])
def test_turns_about_an_axis_convert(kind):
    source = spec_of(("affine_transform arm 8 0 0.6 0.8", 1))
    target = spec_of((f"affine_transform arm {kind}", {16: 3, 32: 4}[kind]))
    there = source.ConvertData(target, [1.5], 1, WORLD)
    turned = target.ExtractTransform(None, there, None)
    np.testing.assert_allclose(turned, ravemj.matrixFromAxisAngle([0, 0.6, 0.8], 1.5), atol=1e-12)
    np.testing.assert_allclose(target.ConvertData(source, there, 1, WORLD), [1.5])


def test_velocities_of_different_rotations_do_not_convert():
    source, target = spec_of(("affine_velocities arm 16", 3)), spec_of(("affine_velocities arm 32", 4))
    with pytest.raises(ArgumentError, match="cannot be converted"):
        source.ConvertData(target, [0, 0, 0], 1, WORLD)


def test_what_is_missing_is_the_present_pose():
    source, target = spec_of(("affine_transform arm 2", 1)), spec_of(("affine_transform arm 39", 7))
    np.testing.assert_allclose(source.ConvertData(target, [1], 1, WORLD), [5, 1, 7, 0.6, 0, 0.8, 0])
    np.testing.assert_allclose(Spec().ConvertData(target, [], 1, WORLD), [5, 6, 7, 0.6, 0, 0.8, 0])
    np.testing.assert_allclose(Spec().ConvertData(target, [], 1, None), [0, 0, 0, 1, 0, 0, 0])
    velocities = spec_of(("joint_velocities arm 2 1", 2), ("outputSignals lamp", 1), ("joint_values other 0", 1))
    np.testing.assert_allclose(Spec().ConvertData(velocities, [], 1, WORLD), [-0.25, -0.125, -1, 0], atol=1e-12)


def test_group_data():
    got = Spec.ConvertGroupData(Group("grab a 2 1", 0, 2), [7, 8, 9], Group("grab a 1 2 3", 0, 3), 1, None)
    assert got.tolist() == [8, 7]
    with pytest.raises(ArgumentError, match="cannot be converted"):
        Spec.ConvertGroupData(Group("colour", 0, 1), [7], Group("colour arm", 0, 1), 1, None)
    assert conversion.nobody("arm") is None


@given(indices, indices, st.integers(0, 4))
def test_joint_values_are_read_where_they_were_written(present, chosen, order):
    spec = spec_of(("deltatime", 1), joints("arm", present)).ConvertToDerivativeSpecification(order)
    body = ravemj.load("models/env.xml").GetRobots()[0]
    group = spec.GetGroups()[1]
    name = group.name.replace("arm", body.GetName())
    spec = spec_of(("deltatime", 1), (name, group.dof))
    data, values = np.zeros(spec.GetDOF()), np.arange(len(chosen)) + 1.0
    assert spec.InsertJointValues(data, values, body, chosen, order)
    expected = [value if index in present else 0 for index, value in zip(chosen, values, strict=True)]
    assert spec.ExtractJointValues(data, body, chosen, order).tolist() == expected
    assert spec.ExtractJointValues(data, None, chosen, order).tolist() == expected
    assert np.count_nonzero(data) == np.count_nonzero(expected)
    assert spec.ExtractJointValues(data, body, chosen, order + 1) is None
    assert not spec.InsertJointValues(data, [], body, [], order)


def test_lists_are_written_in_place():
    spec = spec_of(joints("arm", [1, 0]), ("deltatime", 1))
    data = [0.0, 0.0, 0.0]
    assert spec.InsertJointValues(data, [5, 6], None, [0, 1])
    assert spec.InsertDeltaTime(data, 0.25)
    assert data == [6, 5, 0.25]
    assert spec.ExtractDeltaTime(data) == 0.25
    assert not Spec().InsertDeltaTime([], 1)
    assert Spec().ExtractDeltaTime([]) is None
    for wrong in (lambda: spec.InsertJointValues(data, [1], None, [0, 1]), lambda: spec.ExtractDeltaTime([1])):
        with pytest.raises(ArgumentError, match="has shape"):
            wrong()
    assert data == [6, 5, 0.25]


def test_poses():
    spec = spec_of(("deltatime", 1), ("affine_transform arm 11 0 1 0", 3))
    data = [9, 1, 2, 0.5]
    expected = ravemj.matrixFromAxisAngle([0, 0.5, 0])
    expected[:3, 3] = [1, 2, 7]
    np.testing.assert_allclose(spec.ExtractTransform([1, 0, 0, 0, 5, 6, 7], data, None), expected)
    assert Spec().ExtractTransform(None, [], None) is None
    parts = DOFAffine.Y | DOFAffine.Z | DOFAffine.RotationAxis
    assert spec.ExtractAffineValues(data, None, parts).tolist() == [2, 0, 0.5]
    assert spec.ExtractAffineValues(data, None, parts, 1) is None
    with pytest.raises(ArgumentError, match="ExtractAffineValues"):
        spec.ExtractTransform(None, data, None, 1)
    assert spec.ExtractIkParameterization(data) is None


def test_goals_of_arms():
    Type = ravemj.IkParameterizationType
    goal = ravemj.IkParameterization([1, 2, 3], Type.Translation3D)
    pose = ravemj.IkParameterization([1, 0, 0, 0, 4, 5, 6], Type.Transform6D)
    spec = ravemj.ConfigurationSpecification()
    spec.AddDeltaTimeGroup()
    spec += goal.GetConfigurationSpecification("linear", "arm", "left")
    spec += pose.GetConfigurationSpecification("linear", "arm", "right")
    spec.AddDerivativeGroups(1)
    data = [0.5, 1, 2, 3, 1, 0, 0, 0, 4, 5, 6, *range(10)]

    def extracted(*arguments):
        found = spec.ExtractIkParameterization(data, *arguments)
        return found and (found.GetType(), found.GetValues().tolist())

    assert extracted() == extracted(0, "arm") == extracted(0, "", "left") == (Type.Translation3D, [1, 2, 3])
    assert extracted(0, "arm", "right") == (Type.Transform6D, [1, 0, 0, 0, 4, 5, 6])
    assert extracted(1) == (Type.Translation3D, [0, 1, 2])
    assert extracted(1, "", "right") == (Type.Transform6D, [3, 4, 5, 6, 7, 8, 9])
    for nobody in ((2,), (0, "leg"), (0, "arm", "middle")):
        assert extracted(*nobody) is None
    with pytest.raises(ArgumentError, match=r"data: has shape \(1,\)"):
        spec.ExtractIkParameterization([0])
    for name in ("ikparam_values", "ikparam_values x"):
        with pytest.raises(ArgumentError, match=name):
            spec_of((name, 3)).ExtractIkParameterization([1, 2, 3])


@pytest.mark.parametrize("name", ["affine_transform arm", "affine_transform arm x", "affine_transform arm 8 0 0 z"])
def test_names_that_do_not_say_what_they_are(name):
    with pytest.raises(ArgumentError, match="should"):
        spec_of((name, 1)).ExtractAffineValues([0], None, 1)


# ---------------------------------------------------------------------------------------------------- bodies


@pytest.fixture
def robot():
    return ravemj.load("models/env.xml").GetRobots()[0]


def test_bodies_say_what_their_configuration_is(robot):
    name = robot.GetName()
    spec = robot.GetConfigurationSpecification("linear")
    assert listed(spec) == [
        (f"joint_values {name} 0 1", 0, 2, "linear"),
        (f"affine_transform {name} 39", 2, 7, "linear"),
    ]
    robot.SetDOFValues([0.25, 0.5])
    values = robot.GetConfigurationValues()
    assert spec.ExtractJointValues(values, robot, [1, 0]).tolist() == [0.5, 0.25]
    np.testing.assert_allclose(spec.ExtractTransform(None, values, robot), robot.GetTransform(), atol=1e-15)
    assert spec.ExtractUsedBodies(robot.GetEnv()) == [robot]
    dofs, places = robot.GetConfigurationSpecificationIndices([1]).ExtractUsedIndices(robot)
    assert (dofs.tolist(), places.tolist()) == ([1], [0])
    assert listed(robot.GetActiveConfigurationSpecification()) == [(f"joint_values {name} 0 1", 0, 2, "")]
    with pytest.raises(ArgumentError, match="from 0 to 1"):
        robot.GetConfigurationSpecificationIndices([2])
    with pytest.raises(ArgumentError, match=r"should have shape \(9,\)"):
        robot.SetConfigurationValues(values[:5])
