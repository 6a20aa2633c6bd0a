"""Rules about goals of inverse kinematics, by OpenRAVE's answers: every type with every operation."""

import itertools
import pickle
from enum import EnumMeta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravemj
import ravemj.rave.enums
from ravemj import IkFilterOptions, IkParameterization, IkReturn, IkReturnAction, Ray

Type = ravemj.IkParameterizationType

TABLE = {  # number, DOF, number of values
    "Transform6D": (0x67000001, 6, 7),
    "Rotation3D": (0x34000002, 3, 4),
    "Translation3D": (0x33000003, 3, 3),
    "Direction3D": (0x23000004, 2, 3),
    "Ray4D": (0x46000005, 4, 6),
    "Lookat3D": (0x23000006, 2, 3),
    "TranslationDirection5D": (0x56000007, 5, 6),
    "TranslationXY2D": (0x22000008, 2, 2),
    "TranslationXYOrientation3D": (0x33000009, 3, 3),
    "TranslationLocalGlobal6D": (0x3600000A, 3, 6),
    "TranslationXAxisAngle4D": (0x4400000B, 4, 4),
    "TranslationYAxisAngle4D": (0x4400000C, 4, 4),
    "TranslationZAxisAngle4D": (0x4400000D, 4, 4),
    "TranslationXAxisAngleZNorm4D": (0x4400000E, 4, 4),
    "TranslationYAxisAngleXNorm4D": (0x4400000F, 4, 4),
    "TranslationZAxisAngleYNorm4D": (0x44000010, 4, 4),
}
ANGLES = [name for name in TABLE if "Angle" in name]
units = st.lists(st.floats(-1, 1), min_size=3, max_size=3).filter(lambda row: np.linalg.norm(row) > 0.1)
points = st.lists(st.floats(-2, 2), min_size=3, max_size=3)
angles = st.floats(-3, 3)


@st.composite
def poses(draw):
    T = ravemj.matrixFromAxisAngle(np.array(draw(units)))
    T[:3, 3] = draw(points)
    return T


def goal(name, T, local=(0.01, 0.02, 0.03), angle=0.7):
    """Return a goal of a type that a tool at T reaches."""
    p, z = T[:3, 3], T[:3, 2]
    values = {
        "Transform6D": T,
        "Rotation3D": ravemj.quatFromRotationMatrix(T),
        "Direction3D": z,
        "Ray4D": Ray(p, z),
        "TranslationDirection5D": Ray(p, z),
        "TranslationXY2D": p[:2],
        "TranslationXYOrientation3D": [*p[:2], angle],
        "TranslationLocalGlobal6D": [local, p],
    }
    value = [p, angle] if name in ANGLES and "XYO" not in name else values.get(name, p)
    return IkParameterization(value, Type[name])


def code(call):
    with pytest.raises(ravemj.openrave_exception) as caught:
        call()
    return caught.value.GetCode()


@pytest.mark.parametrize("name", TABLE)
def test_numbers_of_types(name):
    number, dof, count = TABLE[name]
    kind = Type[name]
    assert int(kind) == number
    assert IkParameterization.Type is Type
    one = goal(name, np.eye(4))
    assert (one.GetDOF(), one.GetNumberOfValues(), len(one.GetValues())) == (dof, count, count)
    assert one.GetType() is kind
    assert int(str(one).split()[0]) == number
    assert code(lambda: IkParameterization(np.zeros(7), number + 0x8000)) == "InvalidArguments"


@pytest.mark.parametrize("name", ["Direction3D", "Ray4D", "TranslationDirection5D"])
@pytest.mark.parametrize(("square", "taken"), [(0.98, False), (0.991, True), (1.0, True), (1.009, True), (1.02, False)])
def test_lengths_of_directions(name, square, taken):
    direction = np.array([0.0, 0.6, 0.8]) * np.sqrt(square)
    value = direction if name == "Direction3D" else Ray([1, 2, 3], direction)
    if taken:
        values = IkParameterization(value, Type[name]).GetValues()
        assert np.linalg.norm(values[:3]) == pytest.approx(1, abs=1e-12)
    else:
        assert code(lambda: IkParameterization(value, Type[name])) == "Assert"


@pytest.mark.parametrize(("first", "second"), list(itertools.combinations(TABLE, 2)))
def test_goals_of_two_types_have_no_distance(first, second):
    one, other = goal(first, np.eye(4)), goal(second, np.eye(4))
    assert code(lambda: one.ComputeDistanceSqr(other)) == "Assert"
    assert one != other


def half_angle(T, other):
    turn = T[:3, :3].T @ other[:3, :3]
    return np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)) / 2


@pytest.mark.parametrize("name", TABLE)
@given(T=poses(), other=poses(), first=angles, second=angles)
def test_distances(name, T, other, first, second):
    """The formulas of OpenRAVE's ``ComputeDistanceSqr``; of ``Lookat3D`` ours, see docs/api.md."""
    between = float(np.sum((T[:3, 3] - other[:3, 3]) ** 2))
    plane = float(np.sum((T[:2, 3] - other[:2, 3]) ** 2))
    turn = half_angle(T, other) ** 2
    bend = float(np.arccos(np.clip(T[:3, 2] @ other[:3, 2], -1, 1))) ** 2
    apart = abs(first - second)
    wrapped = min(apart, 2 * np.pi - apart)
    feet = [M[:3, 3] - (M[:3, 3] @ M[:3, 2]) * M[:3, 2] for M in (T, other)]
    expected = {
        "Transform6D": between + 0.4 * turn,
        "Rotation3D": turn,
        "Direction3D": bend,
        "TranslationDirection5D": between + 0.4 * bend,
        "Ray4D": float(np.sum((feet[0] - feet[1]) ** 2)) + 0.4 * bend,
        "TranslationXY2D": plane,
        "TranslationXYOrientation3D": plane + 0.4 * wrapped**2,
    }
    default = between + wrapped**2 if "Norm" in name else between
    one, two = goal(name, T, angle=first), goal(name, other, angle=second)
    if "AxisAngle4D" not in name:  # those compare |angle|: see below
        assert one.ComputeDistanceSqr(two) == pytest.approx(expected.get(name, default), abs=1e-6)
    assert one.ComputeDistanceSqr(one) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("name", TABLE)
@given(T=poses(), move=poses())
def test_transforms(name, T, move):
    """``Transform`` is on the left and returns another goal; ``MultiplyTransform`` changes the goal."""
    one = goal(name, T)
    before = one.GetValues().tolist()
    for moved in (one.Transform(move), ravemj.poseFromMatrix(move).tolist() * one):
        assert moved is not one
        assert one.GetValues().tolist() == before
        if "AxisAngle" in name:
            np.testing.assert_allclose(moved.GetValues()[0], 0.7, atol=1e-12)  # angles stay, as in OpenRAVE
            np.testing.assert_allclose(moved.GetValues()[1:], (move @ T)[:3, 3], atol=1e-9)
        elif not name.startswith(("TranslationXY", "TranslationLocal")):
            assert moved.ComputeDistanceSqr(goal(name, move @ T)) < 1e-9
    assert one.MultiplyTransform(move) is None
    np.testing.assert_allclose(one.GetValues(), goal(name, T).Transform(move).GetValues(), atol=1e-12)


@pytest.mark.parametrize(("first", "second"), [(1.0, 2.5), (0.5, 3.0), (-1.0, -2.5), (0.2, 0.2)])
@pytest.mark.parametrize("name", [name for name in ANGLES if "AxisAngle4D" in name])
def test_distances_of_angles(name, first, second):
    one, two = goal(name, np.eye(4), angle=first), goal(name, np.eye(4), angle=second)
    assert one.ComputeDistanceSqr(two) == pytest.approx((first - second) ** 2, abs=1e-12)


@pytest.mark.parametrize("name", TABLE)
def test_an_empty_goal_and_one_argument(name):
    empty = IkParameterization()
    assert int(empty.GetType()) == 0
    assert code(empty.GetValues) == "InvalidArguments"
    one = goal(name, ravemj.matrixFromPose([1, 0, 0, 0, 0.1, 0.2, 0.3]))
    for copy in (IkParameterization(one), eval(repr(one))):
        assert copy is not one
        np.testing.assert_array_equal(copy.GetValues(), one.GetValues())


@pytest.mark.parametrize("value", [np.eye(4), [1, 2, 3], 3, 1.5, Type.Translation3D, Ray([0, 0, 0], [0, 0, 1]), {}])
def test_a_value_alone_is_refused(value):
    with pytest.raises(TypeError, match="IkParameterization: value: is given without its type"):
        IkParameterization(value)


@pytest.mark.parametrize("name", TABLE)
def test_a_goal_beside_a_type_is_of_this_type(name):
    one = goal(name, ravemj.matrixFromPose([1, 0, 0, 0, 0.1, 0.2, 0.3]))
    for value in (one, str(one)):
        np.testing.assert_array_equal(IkParameterization(value, one.GetType()).GetValues(), one.GetValues())
        for other in set(TABLE) - {name}:
            with pytest.raises(ravemj.openrave_exception, match=f"{other}, and the goal is of type {name}"):
                IkParameterization(value, getattr(Type, other))


WRONG = [None, "x y", [], [1], [1, 2], [[1, 2], [3, 4]], list(range(5)), np.eye(3), np.zeros((2, 3, 3)), {}, object()]


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("name", TABLE)
def test_values_of_a_wrong_shape_are_refused(name, wrong):
    if (name, repr(wrong)) == ("TranslationXY2D", "[1, 2]"):
        return
    one = goal(name, ravemj.matrixFromPose([1, 0, 0, 0, 0.1, 0.2, 0.3]))
    with pytest.raises((ravemj.openrave_exception, ValueError, TypeError)):
        IkParameterization(wrong, getattr(Type, name))
    for operation in (lambda: one * wrong, lambda: wrong * one, lambda: one.Transform(wrong)):
        before = one.GetValues()
        with pytest.raises((ravemj.openrave_exception, ValueError, TypeError)):
            operation()
        np.testing.assert_array_equal(one.GetValues(), before)


@pytest.mark.parametrize("number", [-1, 0, 3, 0x67000002, 10**12])
def test_numbers_that_are_no_type_are_refused(number):
    with pytest.raises((ravemj.openrave_exception, ValueError), match=r"IkParameterization|type: "):
        IkParameterization([1, 2, 3], number)


@pytest.mark.parametrize("name", [name for name in TABLE if name != "Ray4D"])
@given(T=poses(), move=poses())
def test_each_form_of_a_transform_moves_the_same(name, T, move):
    one = goal(name, T)
    pose = ravemj.poseFromMatrix(move)
    left = [form * one for form in (move, move[:3], move.tolist(), pose, pose.tolist(), tuple(pose))]
    right = [one * form for form in (move, move[:3], move.tolist(), pose, pose.tolist(), tuple(pose))]
    one.MultiplyTransformRight(move)
    for side, expected in ((left, goal(name, T).Transform(move)), (right, one)):
        for moved in side:
            np.testing.assert_allclose(moved.GetValues(), expected.GetValues(), atol=1e-9)


ACTIONS = {
    "Success": 0, "Reject": 1, "Quit": 2, "QuitEndEffectorCollision": 0x82, "RejectKinematics": 0x11,
    "RejectSelfCollision": 0x21, "RejectEnvCollision": 0x41, "RejectJointLimits": 0x101,
    "RejectKinematicsPrecision": 0x201, "RejectCustomFilter": 0x8001,
}  # fmt: skip
OPTIONS = {
    "CheckEnvCollisions": 1, "IgnoreSelfCollisions": 2, "IgnoreJointLimits": 4, "IgnoreCustomFilters": 8,
    "IgnoreEndEffectorCollisions": 16, "IgnoreEndEffectorEnvCollisions": 16, "IgnoreEndEffectorSelfCollisions": 32,
}  # fmt: skip


@pytest.mark.parametrize(("kind", "members"), [(IkReturnAction, ACTIONS), (IkFilterOptions, OPTIONS)])
def test_enumerations(kind, members):
    for name, number in members.items():
        member = getattr(kind, name, None)
        assert member is not None, name
        assert int(member) == number, name
        assert name in dir(kind)
        assert kind(number) == member
    for first, second in itertools.product(members.values(), repeat=2):
        assert int(kind(first) | kind(second)) == first | second


@pytest.mark.parametrize("name", ACTIONS)
def test_returns_of_every_action(name):
    answer = IkReturn(getattr(IkReturnAction, name))
    assert answer.GetAction() == getattr(IkReturnAction, name)
    assert len(answer.GetSolution()) == 0
    assert answer.GetMapData("nothing") is None
    assert answer.GetUserData() is None


ENUMERATIONS = sorted(
    {value for value in vars(ravemj.rave.enums).values() if isinstance(value, EnumMeta) and len(value)},
    key=lambda kind: kind.__name__,
)


@pytest.mark.parametrize("kind", ENUMERATIONS)
def test_members_of_all_enumerations(kind):
    for name, member in kind.__members__.items():
        assert name in dir(kind)
        assert kind(int(member)) is member
        assert str(member).rpartition(".")[2] == member.name
        assert kind.names[name] is member
        assert kind.values[int(member)] == member
        assert pickle.loads(pickle.dumps(member)) is member
        for other in kind:
            assert int(member | other) == int(member) | int(other)
            assert (member == other) == (int(member) == int(other))
