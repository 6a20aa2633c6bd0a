"""Grasps of a robot: each reason for a rejection, invariance, arguments that are refused."""

from contextlib import contextmanager

import numpy as np
import pytest
from conftest import one_in

import ravemj
from ravemj.rave import grasping

HAND = """<Robot name="tongs"><KinBody>
  <Body name="bar"/>
  <Body name="left"><offsetfrom>bar</offsetfrom>
    <Geom type="box"><Translation>0.006 0 0</Translation><Extents>0.005 0.01 0.03</Extents></Geom></Body>
  <Body name="right"><offsetfrom>bar</offsetfrom>
    <Geom type="box"><Translation>-0.006 0 0</Translation><Extents>0.005 0.01 0.03</Extents></Geom></Body>
  <Joint name="l" type="slider"><Body>bar</Body><Body>left</Body><axis>1 0 0</axis><limits>0 0.04</limits></Joint>
  <Joint name="r" type="slider"><Body>bar</Body><Body>right</Body><axis>-1 0 0</axis><limits>0 0.04</limits></Joint>
</KinBody>
<Manipulator name="hand"><base>bar</base><effector>bar</effector><direction>0 0 1</direction>
  <joints>l r</joints><closingdirection>-1 -1</closingdirection></Manipulator></Robot>"""


def kitchen(target="box", at=(0.5, 0, 0), floor=False):
    env = ravemj.Environment()
    assert env.Load(ravemj.model_path("panda"))
    assert env.Load(ravemj.model_path(target))
    body = env.GetKinBody(target)
    body.SetTransform([1, 0, 0, 0, *at])
    if floor:
        add_box(env, "floor", [0, 0, -0.012, 1, 1, 0.01])
    return env.GetRobots()[0], body


@pytest.fixture(scope="module")
def flown():
    """The Panda, a box, and the grasps of the hand alone that are found by flying; tests change none of it."""
    robot, box = kitchen()
    return robot, box, ravemj.grasps(robot, box, reach=False, proofs=3)


def add_box(env, name, numbers):
    body = ravemj.RaveCreateKinBody(env, "")
    body.SetName(name)
    body.InitFromBoxes([numbers], True)
    env.Add(body)
    return body


@pytest.mark.stress
@pytest.mark.parametrize("method", ["fly", "antipodal"])
def test_processes_find_the_same(method):
    robot, box = kitchen()
    found, same = (ravemj.grasps(robot, box, method=method, processes=count) for count in (1, 2))
    assert str(found) == str(same)
    assert len(found) > 5
    for one, two in zip([*found, *found.rejected], [*same, *same.rejected], strict=True):
        for field in ("pose", "closed", "contacts", "arm", "quality", "limiting", "reason"):
            np.testing.assert_array_equal(getattr(one, field), getattr(two, field))


def test_a_terminal_shows_progress(monkeypatch):
    robot, box = tongs(0.02, 0.015, 0.02)
    shown = []

    @contextmanager
    def bar(task, total, unit=""):
        shown.append((task, total))
        yield shown.append

    monkeypatch.setattr(grasping, "progress_bar", bar)
    found = ravemj.grasps(robot, box)
    total = len(found) + len(found.rejected)
    assert total > 5
    assert shown == [("grasps", total), *range(1, total + 1)]


@pytest.mark.parametrize("method", one_in(2, ["antipodal", "fly"]))
def test_the_panda_holds_the_box(method):
    robot, box = kitchen()
    before = robot.GetTransform(), robot.GetDOFValues()
    found = ravemj.grasps(robot, box, method=method, proofs=2)
    for old, new in zip(before, (robot.GetTransform(), robot.GetDOFValues()), strict=True):
        np.testing.assert_array_equal(old, new)
    qualities = [grasp.quality for grasp in found]
    assert len(found) > 5
    assert qualities == sorted(qualities, reverse=True)
    assert qualities[-1] > 0
    assert found[0].proof.held
    arm = robot.GetActiveManipulator()
    for grasp in found[:3]:
        robot.SetDOFValues(grasp.arm, arm.GetArmIndices())
        error = arm.GetTransform() - box.GetTransform() @ grasp.pose
        assert np.abs(error).max() < 2e-4
        assert set(np.sign(grasp.contacts[:, 3:].round(6) @ np.ones(3))) == {-1, 1}
        half, middle = np.array([0.02, 0.03, 0.05]), [0, 0, 0.05]
        inside = np.abs(grasp.contacts[:, :3] - middle) / half
        np.testing.assert_allclose(inside.max(axis=1), 1, atol=2e-3)


@pytest.mark.stress
def test_each_reason_is_given():
    seen: set[str] = set()
    robot, box = kitchen(floor=True)
    seen |= set(ravemj.grasps(robot, box, reach=False).counts)
    assert {"touches 'floor' first", "finger 'finger' starts in contact", "not closed"} <= seen
    seen = set(ravemj.grasps(robot, box, method="antipodal", reach=False).counts)
    assert {"in collision with 'floor'", "in collision with 'box'", "too wide"} <= seen
    box.SetTransform([1, 0, 0, 0, 3, 0, 0])
    assert "no IK" in ravemj.grasps(robot, box).counts
    box.SetTransform([1, 0, 0, 0, 0.5, 0, 0])
    add_box(robot.GetEnv(), "wall", [0, 0, 0.4, 0.1, 0.1, 0.1])  # inside the arm
    assert "arm in collision" in ravemj.grasps(robot, box).counts


def tongs(*half):
    env = ravemj.Environment()
    assert env.LoadData(HAND)
    return env.GetRobots()[0], add_box(env, "target", [0, 0, 0, *half])


def test_tongs_fly_past_a_stick():
    robot, stick = tongs(0.002, 0.002, 0.002)
    assert "flies past the target" in ravemj.grasps(robot, stick, delta=0.005).counts


@pytest.mark.stress
def test_the_quality_does_not_depend_on_where_the_target_stands():
    robot, box = tongs(0.021, 0.016, 0.022)
    first = ravemj.grasps(robot, box, method="antipodal")
    turned = ravemj.matrixFromAxisAngle([0.3, -0.5, 0.2])
    turned[:3, 3] = [1, 2, 3]
    box.SetTransform(turned)
    second = ravemj.grasps(robot, box, method="antipodal")
    assert len(first) == len(second) > 0
    np.testing.assert_allclose([one.quality for one in first], [one.quality for one in second], rtol=0.02)


def test_a_table_of_counts_is_printed(flown):
    _, _, found = flown
    head, *rows = str(found).splitlines()
    total = len(found) + len(found.rejected)
    assert head.strip() == f"{len(found)}  grasps of {total} candidates, friction 0.4"
    assert sum(int(row.split()[0]) for row in rows) == len(found.rejected)
    assert all(grasp.reason for grasp in found.rejected)
    assert not any(grasp.reason for grasp in found)


def test_drawn_contacts_have_the_colour_of_what_limits_them(flown):
    _, _, found = flown
    grasp = found[0]
    robot, box = kitchen()
    env = robot.GetEnv()
    assert ravemj.draw_grasp(box, grasp) == []  # no viewer
    env.SetViewer("offscreen")
    assert len(ravemj.draw_grasp(box, grasp)) == len(grasp.contacts) + 2
    assert 0 < len(grasp.limiting) < len(grasp.contacts)
    assert grasp.weakness.startswith(("turns about ", "slides along "))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"method": "magic"}, "method: is 'magic'; expected 'fly' or 'antipodal'"),
        ({"friction": -1}, "friction"),
        ({"friction": float("nan")}, "friction"),
        ({"rolls": 0}, "rolls: is 0; expected 1 or more"),
        ({"delta": 0}, "delta"),
    ],
)
def test_wrong_arguments_are_refused(change, message):
    robot, box = tongs(0.02, 0.02, 0.02)
    with pytest.raises(ravemj.ArgumentError, match=message):
        ravemj.grasps(robot, box, **change)


def test_robots_that_cannot_grasp_are_refused():
    robot, box = kitchen()
    with pytest.raises(ravemj.ArgumentError, match="is the robot or in its hand"):
        ravemj.grasps(robot, robot)
    robot.Grab(box)
    with pytest.raises(ravemj.ArgumentError, match="is the robot or in its hand"):
        ravemj.grasps(robot, box)
    env = ravemj.load(ravemj.model_path("puma560"))
    with pytest.raises(ravemj.ArgumentError, match="no gripper joints that close"):
        ravemj.grasps(env.GetRobots()[0], add_box(env, "box", [1, 0, 0, 0.1, 0.1, 0.1]))
    robot, _ = tongs(0.02, 0.02, 0.02)
    empty = ravemj.RaveCreateKinBody(robot.GetEnv(), "")
    empty.SetName("empty")
    empty.InitFromBoxes(np.zeros((0, 6)), True)
    robot.GetEnv().Add(empty)
    with pytest.raises(ravemj.ArgumentError, match="no shapes"):
        ravemj.grasps(robot, empty)


def test_distinct_grasps_are_no_twins_and_the_best_ones(flown):
    _, _, found = flown
    chosen = found.distinct(4)
    assert chosen[0] is found[0]
    assert [grasp.proof is not None for grasp in chosen] == [True] * 3 + [False]
    for number, grasp in enumerate(chosen):
        for better in chosen[:number]:
            apart = np.linalg.norm(grasp.contacts[:, None, :3] - better.contacts[None, :, :3], axis=2)
            is_near = max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 0.015
            assert not (is_near and grasp.approach @ better.approach > np.cos(np.radians(20)))
    assert len(found.distinct(len(found))) < len(found)


def test_bodies_elsewhere_and_disabled_ones_are_named():
    robot, box = kitchen()
    _, other = kitchen()
    with pytest.raises(ravemj.openrave_exception, match="'box' is not in the environment of robot 'Panda'; add it"):
        ravemj.grasps(robot, other)
    box.Enable(False)
    with pytest.raises(ravemj.openrave_exception, match=r"no shapes that collide; enable it with Enable\(True\)"):
        ravemj.grasps(robot, box)
    for options in ({"proofs": -1}, {"processes": 0}):
        with pytest.raises(ravemj.openrave_exception, match="; expected"):
            ravemj.grasps(robot, box, **options)


def test_a_manipulator_without_a_gripper_names_one_with_it():
    robot, box = kitchen()
    info = robot.GetManipulators()[0].GetInfo()
    info._name, info._vGripperJointNames = "camera", []  # noqa: SLF001 - OpenRAVE's names
    info._vChuckingDirection = []
    robot.AddManipulator(info)
    robot.SetActiveManipulator("camera")
    with pytest.raises(ravemj.openrave_exception, match="'camera' has no gripper joints that close, and arm has some"):
        ravemj.grasps(robot, box)


@pytest.mark.stress
@pytest.mark.parametrize("method", ["fly", "antipodal"])
def test_turned_worlds_have_the_same_candidates(method):
    robot, box = kitchen()
    expected = ravemj.grasps(robot, box, method=method)
    random = np.random.default_rng(1)
    for _ in range(2):
        T = ravemj.matrixFromAxisAngle(random.normal(size=3), random.uniform(0, 3))
        T[:3, 3] = random.uniform(-2, 2, 3)
        robot, box = kitchen()
        for body in (robot, box):
            body.SetTransform(T @ body.GetTransform())
        found = ravemj.grasps(robot, box, method=method)
        assert len(found) + len(found.rejected) == len(expected) + len(expected.rejected)
        assert [grasp.quality for grasp in found] == pytest.approx([grasp.quality for grasp in expected], abs=1e-9)
        if method == "antipodal":  # hands that fly graze the sides of the box
            assert found.counts == expected.counts
        assert box.GetTransform() == pytest.approx(T @ ravemj.matrixFromPose([1, 0, 0, 0, 0.5, 0, 0]))


LINK = """<link name="{}"><collision><origin xyz="0 {} {}"/><geometry><box size="{}"/></geometry></collision>
  <inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{0}_joint" type="prismatic"><parent link="base"/><child link="{0}"/><origin xyz="0 0 0.015"/>
  <axis xyz="0 {1} 0"/><limit lower="0" upper="0.04" effort="20" velocity="0.2"/>{2}</joint>"""


@pytest.mark.parametrize("mimic", one_in(2, [True, False]))
@pytest.mark.parametrize("method", one_in(2, ["antipodal", "fly"]))
def test_jaws_of_a_urdf_close_towards_each_other(tmp_path, method, mimic):
    """URDF has no closing directions, and the tool of a hand without an arm is its palm."""
    parts = [LINK.format("base", 0, 0, "0.04 0.12 0.03"), LINK.format("left", 0.005, 0.04, "0.02 0.01 0.08")]
    parts += [LINK.format("right", -0.005, 0.04, "0.02 0.01 0.08"), JOINT.format("left", 1, "")]
    parts.append(JOINT.format("right", -1, '<mimic joint="left_joint"/>' if mimic else ""))
    (tmp_path / "jaws.urdf").write_text(f"<robot name='jaws'>{''.join(parts)}</robot>")
    joints = "<joint name='left_joint'/>" + ("" if mimic else "<joint name='right_joint'/>")
    group = f"<group name='hand'>{joints}</group><end_effector name='hand' parent_link='base' group='hand'/>"
    (tmp_path / "jaws.srdf").write_text(f"<robot name='jaws'>{group}</robot>")
    env = ravemj.load(tmp_path / "jaws.urdf")
    assert env.Load(ravemj.model_path("box"))
    robot, box = env.GetRobots()[0], env.GetKinBody("box")
    assert robot.GetActiveManipulator().GetChuckingDirection().tolist() == [0] * (1 if mimic else 2)
    box.SetTransform([1, 0, 0, 0, 0.5, 0, 0])
    found = ravemj.grasps(robot, box, method=method, proofs=1)
    assert len(found) > 20
    assert found[0].proof is not None
    assert found[0].proof.held
    assert (found[0].closed < found[0].preshape).all()
