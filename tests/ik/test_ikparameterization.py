"""Goals of arms: what they hold, how they move, how far they are from each other."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravemj
from ravemj import IkParameterization, Ray, misc
from ravemj.geometry_functions.ik_types import GOAL_TYPES

Type = IkParameterization.Type
numbers = st.lists(st.floats(-2, 2), min_size=7, max_size=7).filter(lambda row: sum(x * x for x in row[:4]) > 0.1)
TURN = ravemj.matrixFromAxisAngle([0, 0, np.pi / 2])
SHIFT = ravemj.matrixFromPose([1, 0, 0, 0, 1, 2, 3])


def pose(row):
    quaternion = np.array(row[:4]) / np.linalg.norm(row[:4])
    return ravemj.matrixFromPose([*quaternion, *row[4:]])


def goals(T):
    """Goals of all types that move, which a tool at T reaches, with its direction along x."""
    ray = Ray(T[:3, 3], T[:3, 0])
    return {
        Type.Transform6D: T,
        Type.Rotation3D: ravemj.quatFromRotationMatrix(T),
        Type.Translation3D: T[:3, 3],
        Type.Lookat3D: T[:3, 3] + T[:3, 0],
        Type.Direction3D: T[:3, 0],
        Type.Ray4D: ray,
        Type.TranslationDirection5D: ray,
    }


@given(numbers, numbers)
def test_a_moved_goal_is_that_of_the_moved_tool(row, other):
    T, move = pose(row), pose(other)
    for (kind, value), moved in zip(goals(T).items(), goals(move @ T).values(), strict=True):
        goal = IkParameterization(value, kind)
        assert len(goal.GetValues()) == goal.GetNumberOfValues()
        expected = IkParameterization(moved, kind)
        for result in (move * goal, goal.Transform(move)):
            assert result.GetType() is kind
            assert expected.ComputeDistanceSqr(result) < 1e-12
        goal.MultiplyTransform(move)
        assert expected.ComputeDistanceSqr(goal) < 1e-12


@pytest.mark.parametrize("kind", list(goals(TURN)))
def test_text_copies_and_pickles_hold_all(kind):
    goal = IkParameterization(goals(SHIFT @ TURN)[kind], kind)
    for _ in range(2):
        for copy in (IkParameterization(str(goal)), IkParameterization(goal), pickle.loads(pickle.dumps(goal, 2))):
            assert copy.GetType() is kind
            assert copy.GetValues().tolist() == goal.GetValues().tolist()
            assert {name: list(row) for name, row in copy.GetCustomDataMap().items()} == {
                name: list(row) for name, row in goal.GetCustomDataMap().items()
            }
        assert str(eval(repr(goal))) == str(goal)
        goal.SetCustomValues("weight", [1, 0.25])
        goal.SetCustomValues("none", [])


@pytest.mark.parametrize(
    ("kind", "dof", "count"),
    [
        ("Transform6D", 6, 7),
        ("Rotation3D", 3, 4),
        ("Ray4D", 4, 6),
        ("TranslationDirection5D", 5, 6),
        ("Lookat3D", 2, 3),
    ],
)
def test_types_know_their_sizes(kind, dof, count):
    assert IkParameterization.GetDOFFromType(Type[kind]) == dof
    assert IkParameterization.GetNumberOfValuesFromType(Type[kind]) == count
    spec = IkParameterization.GetConfigurationSpecificationFromType(Type[kind], "linear", "arm", "hand")
    (group,) = spec.GetGroups()
    assert (group.name, group.dof) == (f"ikparam_values {int(Type[kind])} arm hand", count)
    assert group.interpolation == "linear"


def test_getters_and_setters_of_all_types():
    goal = IkParameterization()
    goal.SetTransform6D(SHIFT[:3])
    assert goal.GetTransform6D().tolist() == SHIFT.tolist()
    assert goal.GetTransform6DPose().tolist() == [1, 0, 0, 0, 1, 2, 3]
    assert goal.GetDOF() == 6
    for name, value in (("Rotation3D", [0, 1, 0, 0]), ("Translation3D", [1, 2, 3]), ("Lookat3D", [4, 5, 6])):
        getattr(goal, f"Set{name}")(value)
        assert goal.GetType() is Type[name]
        assert getattr(goal, f"Get{name}")().tolist() == value
    goal.SetDirection3D([0, 1, 0])
    assert goal.GetDirection3D().tolist() == [0, 1, 0]
    for name in ("Ray4D", "TranslationDirection5D"):
        getattr(goal, f"Set{name}")(Ray([1, 2, 3], [0, 0, 1.004]))
        ray = getattr(goal, f"Get{name}")()
        assert [ray.pos().tolist(), ray.dir().tolist()] == [[1, 2, 3], [0, 0, 1]]
    goal.SetValues([1, 2], Type.TranslationXY2D)
    assert goal.GetValues().tolist() == [1, 2]
    values = goal.GetValues()
    values[0] = 9
    assert goal.GetValues().tolist() == [1, 2]


def test_what_cannot_be_says_so_and_changes_nothing():
    goal = IkParameterization([1, 2, 3], Type.Translation3D)
    for wrong in (
        lambda: goal.SetRotation3D([1, 2]),
        lambda: goal.SetValues([1, 2], Type.Ray4D),
        lambda: goal.SetCustomValues("two words", [1]),
        lambda: goal.ComputeDistanceSqr(IkParameterization(SHIFT, Type.Transform6D)),
    ):
        with pytest.raises(ravemj.openrave_exception):
            wrong()
        assert str(goal) == f"{int(Type.Translation3D)} 1.0 2.0 3.0"
    ray = IkParameterization(Ray([1, 2, 3], [0, 0, 1]), Type.Ray4D)
    before = str(ray)
    with pytest.raises(ravemj.openrave_exception, match="own frame") as caught:
        ray.MultiplyTransformRight(SHIFT)
    assert (caught.value.GetCode(), str(ray)) == ("Failed", before)


def test_getters_do_not_check_the_type():
    place = IkParameterization([1, 2, 3], Type.Translation3D)
    np.testing.assert_array_equal(place.GetTransform6D()[:3], [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3]])
    assert place.GetRotation3D().tolist() == [1, 0, 0, 0]
    assert place.GetLookat3D().tolist() == place.GetTranslationXYOrientation3D().tolist() == [1, 2, 3]
    assert place.GetTranslationXY2D().tolist() == [1, 2]
    pose_ = IkParameterization([0.5, 0.5, -0.5, 0.5, 1, 2, 3], Type.Transform6D)
    assert pose_.GetTranslation3D().tolist() == [1, 2, 3]
    assert pose_.GetRotation3D().tolist() == [0.5, 0.5, -0.5, 0.5]
    ray = IkParameterization(Ray([1, 2, 3], [0, 0.6, 0.8]), Type.TranslationDirection5D)
    assert ray.GetDirection3D().tolist() == ray.GetRay4D().dir().tolist() == [0, 0.6, 0.8]
    assert ray.GetTranslation3D().tolist() == ray.GetRay4D().pos().tolist() == [1, 2, 3]
    angle = IkParameterization([[1, 2, 3], 0.5], Type.TranslationZAxisAngle4D)
    point, turn = angle.GetTranslationXAxisAngleZNorm4D()
    assert (point.tolist(), turn, angle.GetTranslation3D().tolist()) == ([1, 2, 3], 0.5, [1, 2, 3])
    direction = IkParameterization([0, 0.6, 0.8], Type.Direction3D)
    assert direction.GetTranslation3D().tolist() == [0, 0, 0]
    assert IkParameterization([1, 2], Type.TranslationXY2D).GetTranslation3D().tolist() == [1, 2, 0]
    assert IkParameterization().GetTranslation3D().tolist() == [0, 0, 0]


@pytest.mark.parametrize("kind", [*goals(np.eye(4)), Type.none], ids=lambda kind: kind.name)
def test_every_getter_reads_every_type(kind):
    goal = IkParameterization() if kind == Type.none else IkParameterization(goals(SHIFT)[kind], kind)
    for other in GOAL_TYPES:
        assert getattr(goal, f"Get{other.name}")() is not None


def test_pairs_of_points_and_of_a_point_and_an_angle():
    goal = IkParameterization([[1, 2, 3], [4, 5, 6]], Type.TranslationLocalGlobal6D)
    assert goal.GetValues().tolist() == [1, 2, 3, 4, 5, 6]
    assert (SHIFT * goal).GetValues().tolist() == [1, 2, 3, 5, 7, 9]
    assert (goal * SHIFT).GetValues().tolist() == [1, 2, 3, 5, 7, 9]
    angle = IkParameterization([[1, 2, 3], 0.5], Type.TranslationZAxisAngleYNorm4D)
    assert angle.GetValues().tolist() == [0.5, 1, 2, 3]
    assert IkParameterization([0.5, 1, 2, 3], Type.TranslationZAxisAngleYNorm4D).GetValues().tolist() == [0.5, 1, 2, 3]
    for wrong in ([1, 2, 3, 4, 5], [[1, 2], [3, 4]], None):
        with pytest.raises(ravemj.openrave_exception):
            IkParameterization(wrong, Type.TranslationLocalGlobal6D)
        with pytest.raises(ravemj.openrave_exception):
            IkParameterization(wrong, Type.TranslationXAxisAngle4D)


@given(numbers, numbers)
def test_a_frame_is_moved_inside_itself(row, other):
    T, move = pose(row), pose(other)
    for kind, whole in ((Type.Transform6D, T), (Type.Rotation3D, ravemj.quatFromRotationMatrix(T))):
        result = IkParameterization(whole, kind) * move
        expected = IkParameterization(goals(T @ move)[kind], kind)
        assert expected.ComputeDistanceSqr(result) < 1e-12


@given(numbers, numbers)
def test_a_direction_is_moved_inside_the_frame_that_is_turned_to_it(row, other):
    """OpenRAVE's answers in the case ``ik-09-param-multiply-in-place``."""
    T, move = pose(row), pose(other)
    frame = ravemj.matrixFromQuat(ravemj.quatRotateDirection([0, 0, 1], T[:3, 0]))
    frame[:3, 3] = T[:3, 3]
    moved = frame @ move
    for kind, whole in (
        (Type.Direction3D, moved[:3, 2]),
        (Type.TranslationDirection5D, Ray(moved[:3, 3], moved[:3, 2])),
    ):
        goal = IkParameterization(goals(T)[kind], kind)
        result = goal * move
        assert IkParameterization(whole, kind).ComputeDistanceSqr(result) < 1e-12
        assert goal.MultiplyTransformRight(move) is None
        assert goal.GetValues().tolist() == result.GetValues().tolist()


def test_other_goals_are_shifted_inside_themselves():
    for kind in (Type.Translation3D, Type.Lookat3D):
        assert (IkParameterization([4, 5, 6], kind) * (SHIFT @ TURN)).GetValues().tolist() == [5, 7, 9]
    assert (IkParameterization([4, 5], Type.TranslationXY2D) * SHIFT).GetValues().tolist() == [5, 7]
    turned = IkParameterization([4, 5, 0.25], Type.TranslationXYOrientation3D) * (SHIFT @ TURN)
    np.testing.assert_allclose(turned.GetValues(), [5, 7, 0.25 + np.pi / 2])


def test_planar_goals_are_moved_in_their_plane():
    goal = IkParameterization([4, 5, 0.25], Type.TranslationXYOrientation3D)
    np.testing.assert_allclose((SHIFT @ TURN * goal).GetValues(), [1 - 5, 2 + 4, 0.25 + np.pi / 2])
    goal = IkParameterization([4, 5], Type.TranslationXY2D)
    np.testing.assert_allclose(([1, 0, 0, 0, 1, 2, 3] * goal).GetValues(), [5, 7])


def test_distances():
    six = IkParameterization(np.eye(4), Type.Transform6D)
    assert six.ComputeDistanceSqr(SHIFT * six) == 14
    assert six.ComputeDistanceSqr(TURN * six) == pytest.approx(0.4 * (np.pi / 4) ** 2)
    ray = IkParameterization(Ray([0, 0, 5], [0, 0, 1]), Type.Ray4D)
    assert ray.ComputeDistanceSqr(IkParameterization(Ray([3, 0, -8], [0, 0, 1]), Type.Ray4D)) == 9
    five = IkParameterization(ray.GetRay4D(), Type.TranslationDirection5D)
    moved = IkParameterization(Ray([0, 0, 7], [1, 0, 0]), Type.TranslationDirection5D)
    assert five.ComputeDistanceSqr(moved) == pytest.approx(4 + 0.4 * (np.pi / 2) ** 2)


def test_custom_data_is_kept_apart():
    goal = IkParameterization([1, 2, 3], Type.Translation3D)
    goal.SetCustomValues("a", [1])
    goal.SetCustomValues("b", [2, 3])
    assert goal.GetCustomValues("b").tolist() == [2, 3]
    assert goal.GetCustomValues("c") is None
    copy = IkParameterization(goal)
    assert goal.ClearCustomValues("a") == 1
    assert goal.ClearCustomValues() == 1
    assert set(copy.GetCustomDataMap()) == {"a", "b"}


# Manipulators

ARM = """<Robot name="arm"><KinBody>
  <Body name="base" type="dynamic"><Translation>1 0 0</Translation><RotationAxis>0 0 1 90</RotationAxis></Body>
  <Body name="hand" type="dynamic"><Translation>2 0 1</Translation></Body>
  <Joint name="j" type="hinge"><Body>base</Body><Body>hand</Body><axis>0 1 0</axis></Joint></KinBody>
  <Manipulator name="m"><base>base</base><effector>hand</effector><Translation>0 0 0.5</Translation>
  <direction>1 0 0</direction></Manipulator></Robot>"""


@pytest.fixture
def arm(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM)
    return ravemj.load(tmp_path / "arm.xml").GetRobots()[0].GetManipulators()[0]


@pytest.mark.parametrize("kind", list(goals(TURN)))
def test_the_tool_is_where_its_goal_says(arm, kind):
    arm.GetRobot().SetDOFValues([0.7])
    T = arm.GetTransform()
    here = IkParameterization(goals(T)[kind], kind)
    assert arm.GetIkParameterization(kind).ComputeDistanceSqr(here) < 1e-15
    in_base = arm.GetIkParameterization(kind, False)
    assert (arm.GetBase().GetTransform() * in_base).ComputeDistanceSqr(here) < 1e-15


def test_goals_are_drawn_as_axes_or_lines():
    class Canvas:
        def drawlinelist(self, points, linewidth, colors):
            return np.asarray(points)

    for kind, value in goals(SHIFT).items():
        (drawn,) = misc.DrawIkparam2(Canvas(), IkParameterization(value, kind), dist=0.5)
        has_place = kind not in {Type.Rotation3D, Type.Direction3D}
        place = value if kind == Type.Lookat3D else [1, 2, 3]
        assert drawn[0].tolist() == (list(place) if has_place else [0, 0, 0])
        assert len(drawn) in {2, 6}
        np.testing.assert_allclose(drawn[1] - drawn[0], [0.5, 0, 0])
    with pytest.raises(ravemj.openrave_exception, match="TranslationXY2D"):
        misc.DrawIkparam(Canvas(), IkParameterization([1, 2], Type.TranslationXY2D))


@pytest.mark.parametrize(
    "text", ["", "pose", "1 2", "nan 0", "1728053249 1 0 0", "1728053249 1 0 0 0 0 0 a", "855638020 1 0 0"]
)
def test_text_that_is_no_goal_is_refused_by_name(text):
    with pytest.raises(ravemj.openrave_exception, match=f"'{text}' should be a goal"):
        IkParameterization(text)
