"""Joints: their setters, and the graph that they make of the links."""

import math

import numpy as np
import pytest

import ravemj
from ravemj.core.transforms import pose_of
from ravemj.model.joints import measured_values

ANY_JOINTS = """<Environment><KinBody name="any">
  <Body name="a"/><Body name="b"/><Body name="c"><offsetfrom>b</offsetfrom><translation>.1 .2 .3</translation>
  <rotationaxis>1 2 3 40</rotationaxis></Body><Body name="d"/><Body name="e"/>
  <Joint name="ab"><Body>a</Body><Body>b</Body><anchor>.3 .1 .2</anchor><axis>1 2 3</axis>
  <limits>-200 200</limits><initial>50</initial></Joint>
  <Joint name="bc" type="slider"><Body>b</Body><Body>c</Body><axis>1 -1 2</axis><limits>-9 9</limits></Joint>
  <Joint name="cd"><Body>c</Body><Body>d</Body><axis>0 0 1</axis><limits>0 0</limits></Joint>
  <Joint name="de"><Body>d</Body><Body>e</Body><offsetfrom>e</offsetfrom><axis>0 1 0</axis></Joint>
</KinBody></Environment>"""

TREE = """<Environment><KinBody name="tree">
  <Body name="root"><Geom type="box"><extents>1 1 1</extents></Geom></Body>
  <Body name="left"/><Body name="right"/><Body name="hand"/><Body name="nail"/><Body name="loose"/>
  <Joint name="l"><Body>root</Body><Body>left</Body><axis>0 0 1</axis><limits>-4 4</limits></Joint>
  <Joint name="h" type="slider"><Body>left</Body><Body>hand</Body><axis>1 0 0</axis><limits>-1 1</limits></Joint>
  <Joint name="r" circular="true"><Body>root</Body><Body>right</Body><axis>0 0 1</axis></Joint>
  <Joint name="n" mimic_pos="2*r"><Body>hand</Body><Body>nail</Body><axis>0 1 0</axis><limits>-9 9</limits></Joint>
</KinBody></Environment>"""

LOOP = """<Environment><KinBody name="loop">
  <Body name="a"/><Body name="b"/><Body name="c"/>
  <Joint name="ab"><Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint>
  <Joint name="bc"><Body>b</Body><Body>c</Body><axis>0 0 1</axis></Joint>
  <Joint name="ca"><Body>c</Body><Body>a</Body><axis>0 0 1</axis></Joint>
</KinBody></Environment>"""


@pytest.fixture
def env():
    return ravemj.Environment()


@pytest.fixture
def tree(env):
    env.LoadData(TREE)
    return env.GetKinBody("tree")


def random_poses(count, seed=3):
    random = np.random.default_rng(seed)
    return [
        ravemj.matrixFromPose([*ravemj.quatFromAxisAngle(row[:3]), *row[3:]]) for row in random.normal(0, 2, (count, 6))
    ]


def names(things):
    return [thing.GetName() for thing in things]


class TestSetters:
    @pytest.mark.parametrize("name", ["VelocityLimits", "AccelerationLimits", "TorqueLimits", "Weights"])
    def test_what_is_set_is_there_and_in_the_body(self, tree, name):
        joint = tree.GetJoint("h")
        getattr(joint, f"Set{name}")([3])
        assert getattr(tree, f"GetDOF{name}")().tolist()[1] == 3
        assert getattr(tree, f"GetDOF{name}")().tolist()[0] != 3
        got = getattr(joint, f"Get{name}")()
        np.testing.assert_array_equal(got, [[-3], [3]] if name == "VelocityLimits" else [3])

    def test_limits_move_nothing_and_hold_from_then_on(self, tree):
        tree.SetDOFValues([0, 0.8, 0])
        tree.GetJoint("h").SetLimits([-0.5], [0.5])
        assert tree.GetJoint("h").GetValue() == 0.8
        tree.SetDOFValues([0, 0.8, 0], None, ravemj.CheckLimitsAction.CheckLimitsSilent)
        assert tree.GetJoint("h").GetValue() == 0.5

    @pytest.mark.parametrize(
        "call",
        [
            lambda joint: joint.SetLimits([-1, -1], [1, 1]),
            lambda joint: joint.SetLimits([-1], [np.nan]),
            lambda joint: joint.SetWeights([0]),
            lambda joint: joint.SetVelocityLimits([]),
        ],
    )
    def test_what_is_refused_changes_nothing(self, tree, call):
        before = tree.simulation_state.scene
        with pytest.raises(ravemj.openrave_exception):
            call(tree.GetJoint("h"))
        assert tree.simulation_state.scene is before

    def test_a_wrap_offset_chooses_the_turn(self, tree):
        tree.SetDOFValues([0, 0, 1])
        transforms = tree.link_transforms()
        tree.GetJoint("r").SetWrapOffset(4 * np.pi)
        assert tree.GetDOFValues()[2] == pytest.approx(1 + 4 * np.pi)
        assert tree.GetJoint("r").GetWrapOffset() == 4 * np.pi
        np.testing.assert_allclose(tree.link_transforms(), transforms, atol=1e-12)


def gripper():
    """An arm of two hinges with a finger, and a second finger that follows the first and the second hinge."""
    env = ravemj.Environment()
    bodies = "".join(
        f'<Body name="{name}"><Translation>{x} {y} 0</Translation>'
        '<Geom type="box"><extents>.1 .1 .1</extents></Geom><Mass type="mimicgeom"><density>9</density></Mass></Body>'
        for name, x, y in [("a", 0, 0), ("b", 1, 0), ("c", 2, 0), ("d", 3, 1), ("e", 3, -1)]
    )
    joints = "".join(
        f'<Joint name="{name}" type="{kind}" {more}><Body>{parent}</Body><Body>{child}</Body>'
        f"<offsetfrom>{child}</offsetfrom><axis>0 0 1</axis><limits>-2 2</limits></Joint>"
        for name, kind, parent, child, more in [
            ("one", "hinge", "a", "b", ""),
            ("two", "hinge", "b", "c", ""),
            ("three", "slider", "c", "d", ""),
            ("four", "slider", "c", "e", 'mimic_pos="three+two"'),
        ]
    )
    arm = "<Manipulator name='m'><base>a</base><effector>c</effector><joints>three</joints>"
    arm += "<closingdirection>1</closingdirection></Manipulator>"
    assert env.LoadData(f'<Robot name="r"><KinBody>{bodies}{joints}</KinBody>{arm}</Robot>')
    return env, env.GetRobot("r")


class TestFollowing:
    def test_a_follower_gets_another_equation(self, tree):
        follower = tree.GetJoint("n")
        follower.SetMimicEquations(0, "l+1")
        assert follower.GetMimicDOFIndices().tolist() == [0]
        tree.SetDOFValues([0.5, 0, 0])
        assert follower.GetValue() == pytest.approx(1.5)
        tree.SetDOFVelocities([2, 0, 0])
        assert follower.GetVelocities() == pytest.approx(2)

    @pytest.mark.parametrize(("joint", "axis", "equation"), [("n", 0, "nonsense+1"), ("n", 1, "l"), ("l", 0, "x*r")])
    def test_what_is_refused_changes_nothing(self, tree, joint, axis, equation):
        before = tree.simulation_state.scene
        with pytest.raises(ravemj.openrave_exception):
            tree.GetJoint(joint).SetMimicEquations(axis, equation)
        assert tree.simulation_state.scene is before

    def test_without_an_equation_a_joint_that_follows_none_stays_as_it_is(self, tree):  # random-api-23
        before = tree.simulation_state.scene
        tree.GetJoint("l").SetMimicEquations(0, "", "", "")
        assert tree.simulation_state.scene is before

    def test_a_joint_that_begins_to_follow_loses_its_dof(self):  # gap-15
        env, robot = gripper()
        first, second, third = robot.GetJoints()
        (follower,) = robot.GetPassiveJoints()
        robot.SetActiveDOFs([2])
        robot.SetDOFValues([0.1, 0.2, 0.3])
        stood = robot.link_transforms()
        second.SetMimicEquations(0, "2*one", "|one 2", "|one 0")
        assert [joint.GetName() for joint in robot.GetJoints()] == ["one", "three"]
        assert [joint.GetName() for joint in robot.GetPassiveJoints()] == ["four", "two"]
        assert [joint.GetName() for joint in (first, second, third, follower)] == ["one", "two", "three", "four"]
        assert [joint.GetDOFIndex() for joint in (first, second, third)] == [0, -1, 1]
        assert robot.GetActiveDOFIndices().tolist() == [0, 1]
        arm = robot.GetManipulators()[0]
        assert arm.GetArmIndices().tolist() == [0]
        assert arm.GetGripperIndices().tolist() == [1]
        np.testing.assert_allclose(robot.link_transforms(), stood, atol=1e-12)
        robot.SetDOFValues([0.2, -0.1])
        assert second.GetValue() == pytest.approx(0.4)
        assert follower.GetValue() == pytest.approx(-0.1 + 0.4)  # it follows by names, whatever their numbers
        np.testing.assert_allclose(robot.ComputeJacobianAxisAngle(2)[2], [3, 0], atol=1e-12)
        assert len(robot.ComputeInverseDynamics([1, 1])) == 2
        assert not env.CheckCollision(robot)
        second.SetMimicEquations(0, "")
        assert [joint.GetName() for joint in robot.GetJoints()] == ["one", "three", "two"]
        robot.SetDOFValues([0.2, -0.1, 0.5])
        assert [joint.GetValue() for joint in (first, second, third)] == pytest.approx([0.2, 0.5, -0.1])

    def test_velocities_are_the_derivatives_of_the_equation(self, tree):
        tree.SetDOFVelocities([0, 0.5, -1.5])
        assert tree.GetJoint("n").GetVelocities() == pytest.approx(-3)
        assert tree.GetJoint("h").GetVelocities() == pytest.approx(0.5)


def test_the_joint_frame_places_the_child(tree):
    tree.SetDOFValues([0.3, 0.2, 0.1])
    for joint in tree.GetJoints():
        left, right = joint.GetInternalHierarchyLeftTransform(), joint.GetInternalHierarchyRightTransform()
        motion, axis = np.eye(4), joint.GetInternalHierarchyAxis(0) * joint.GetValue(0)
        if joint.IsPrismatic():
            motion[:3, 3] = axis
        else:
            motion = ravemj.matrixFromAxisAngle(axis)
        placed = joint.GetFirstAttached().GetTransform() @ left @ motion @ right
        np.testing.assert_allclose(placed, joint.GetSecondAttached().GetTransform(), atol=1e-12)


class TestGraph:
    def test_what_moves_what(self, tree):
        affect = [[tree.DoesDOFAffectLink(dof, link) for link in range(6)] for dof in range(3)]
        moved = []
        for dof in range(3):
            tree.SetDOFValues([0, 0, 0])
            before = tree.link_transforms()
            tree.SetDOFValues([0.5], [dof])
            moved.append((np.abs(tree.link_transforms() - before).max(axis=(1, 2)) > 1e-9).astype(int).tolist())
        assert affect == moved
        assert [tree.IsDOFInChain(1, 4, dof) for dof in range(3)] == [False, True, True]

    def test_ways(self, tree):
        assert names(tree.GetChain(4, 2)) == ["n", "h", "l", "r"]
        assert names(tree.GetChain(4, 2, returnjoints=False)) == ["nail", "hand", "left", "root", "right"]
        assert tree.GetChain(0, 5) == []
        assert names(tree.GetDependencyOrderedJoints()) == ["l", "r", "h"]
        assert tree.GetJointIndex("n") == -1
        with pytest.raises(ravemj.ArgumentError):
            tree.GetChain(0, 6)

    def test_loops(self, env, tree):
        env.LoadData(LOOP)
        assert tree.GetClosedLoops() == []
        (loop,) = env.GetKinBody("loop").GetClosedLoops()
        assert sorted(link.GetName() for link, _ in loop) == ["a", "b", "c"]
        assert sorted(joint.GetName() for _, joint in loop) == ["ab", "bc", "ca"]
        for (link, joint), (after, _) in zip(loop, [*loop[1:], loop[0]], strict=True):
            assert {link, after} == {joint.GetFirstAttached(), joint.GetSecondAttached()}

    def test_a_hash_tells_structures_apart(self, env, tree):
        plain = tree.GetKinematicsGeometryHash()
        tree.SetDOFValues([0.3, 0.2, 0.1])
        tree.SetTransform([0, 1, 0, 0, 1, 2, 3])
        tree.GetJoint("l").SetLimits([0], [1])
        tree.SetName("other")
        assert tree.GetKinematicsGeometryHash() == plain
        env.LoadData(TREE.replace("1 1 1</extents>", "1 1 2</extents>"))
        assert env.GetKinBody("tree").GetKinematicsGeometryHash() != plain
        env.GetKinBody("tree").SetName("larger")
        env.LoadData(TREE.replace("2*r", "3*r"))
        assert env.GetKinBody("tree").GetKinematicsGeometryHash() != plain


class TestLinkTransformations:
    """Poses of links look alike full turns of a hinge apart."""

    CORNERS = (math.pi, -math.pi, 3.1415926, -3.1415926, 3, -3, 9.5, -9.5, 3 * math.pi, 2 * math.pi, 0, 100)

    @pytest.mark.parametrize("angle", CORNERS)
    @pytest.mark.parametrize("other", [0, 3.1, -3.1, 50])
    def test_with_joint_values_they_come_back_exactly(self, tree, angle, other):
        tree.SetDOFValues([0.5, 0.25, angle])
        transforms, values = tree.GetLinkTransformations(True)
        tree.SetDOFValues([-0.5, 0, other])
        tree.SetLinkTransformations(transforms, values)
        np.testing.assert_allclose(tree.GetDOFValues(), [0.5, 0.25, angle], atol=1e-12)
        np.testing.assert_array_equal(tree.GetLinkTransformations(True)[1], values)
        np.testing.assert_allclose(tree.GetLinkTransformations(), transforms, atol=1e-12)

    @pytest.mark.parametrize("last", CORNERS)
    @pytest.mark.parametrize("angle", CORNERS)
    def test_a_hinge_gets_the_value_next_to_the_given_one(self, tree, angle, last):
        tree.SetDOFValues([0, 0, angle])
        transforms = tree.GetLinkTransformations()
        tree.SetLinkTransformations(transforms, doflastsetvalues=[0, 0, last])
        value = tree.GetDOFValues()[2]
        assert abs(value - last) <= math.pi + 1e-6
        np.testing.assert_allclose(np.exp(1j * value), np.exp(1j * angle), atol=1e-9)

    def test_without_joint_values_a_hinge_goes_on_from_where_it_is(self, tree):
        """OpenRAVE's rule for all values that it reads off poses: next to the last one."""
        poses = []
        for angle in np.linspace(-10, 10, 41):
            tree.SetDOFValues([angle / 4, 0, angle])
            poses.append(tree.GetLinkTransformations())
        tree.SetDOFValues([-2.5, 0, -10])
        for angle, transforms in zip(np.linspace(-10, 10, 41), poses, strict=True):
            tree.SetLinkTransformations(transforms)
            np.testing.assert_allclose(tree.GetDOFValues(), [angle / 4, 0, angle], atol=1e-12)

    def test_turns_are_kept_also_before_anything_is_compiled(self, env, tree):
        tree.SetDOFValues([0.5, 0.25, 9])
        transforms, values = tree.GetLinkTransformations(True)
        tree.SetDOFValues([0, 0, 0])
        env.LoadData('<KinBody name="another"><Body name="b"/></KinBody>')
        tree.SetLinkTransformations(transforms, values)
        np.testing.assert_allclose(tree.GetDOFValues(), [0.5, 0.25, 9], atol=1e-12)

    def test_joint_values_of_a_body_outside_of_the_environment_are_refused(self, env, tree):
        transforms, values = tree.GetLinkTransformations(True)
        env.Remove(tree)
        tree.SetLinkTransformations(transforms)
        with pytest.raises(ravemj.openrave_exception) as caught:
            tree.SetLinkTransformations(transforms, values)
        assert caught.value.GetCode() == "NotInitialized"


POLYNOMIAL = """<Environment><KinBody name="m">
  <Body name="r"/><Body name="a"/><Body name="b"/><Body name="c"/>
  <Joint name="lead"><Body>r</Body><Body>a</Body><axis>0 1 0</axis><limitsrad>-1 1.5</limitsrad></Joint>
  <Joint name="follow" mimic_pos="polyroots2(1,1,-1-lead)"><Body>r</Body><Body>b</Body><axis>0 1 0</axis>
  <limitsrad>%s</limitsrad></Joint>
  <Joint name="after" mimic_pos="2*follow"><Body>b</Body><Body>c</Body><axis>0 0 1</axis><limitsrad>-9 9</limitsrad>
  </Joint></KinBody></Environment>"""


@pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")
class TestEquationsWithSeveralValues:
    """OpenRAVE's answers in the case ``name-33-polyroots``: the first root within the limits."""

    @staticmethod
    def roots(lead):
        square = np.sqrt(1.25 + lead)
        return -0.5 - square, -0.5 + square

    @pytest.fixture
    def body(self, env, request):
        env.LoadData(POLYNOMIAL % getattr(request, "param", "0 3"))
        return env.GetKinBody("m")

    def expected(self, body, lead):
        (lower,), (upper,) = body.GetJoint("follow").GetLimits()
        return next((root for root in self.roots(lead) if lower <= root <= upper), None)

    @pytest.mark.parametrize("body", ["0 3", "-3 3", "-3 0"], indirect=True)
    def test_where_the_joint_is(self, body):
        assert body.GetJoint("follow").GetValue() == pytest.approx(self.expected(body, 0), abs=1e-9)  # when loaded
        for lead in (0, 0.2, 0.5, 1, 1.4):
            body.SetDOFValues([lead])
            expected = self.expected(body, lead)
            assert body.GetJoint("follow").GetValue() == pytest.approx(expected, abs=1e-9)
            assert body.GetJoint("after").GetValue() == pytest.approx(2 * expected, abs=1e-9)
            poses = body.batch_link_transforms([[lead], [0.1]])
            np.testing.assert_allclose(poses[0], body.link_transforms(), atol=1e-9)

    @pytest.mark.parametrize("body", ["0 3", "-3 0"], indirect=True)
    def test_how_fast_it_moves(self, body):
        link, point = body.GetLink("c"), [0.3, 0.2, 0.1]
        body.SetDOFValues([0.4])
        local = np.linalg.inv(link.GetTransform()) @ [*point, 1]
        slope = body.ComputeJacobianTranslation(link.GetIndex(), point)[:, 0]
        ends = []
        for lead in (0.4 - 1e-6, 0.4 + 1e-6):
            body.SetDOFValues([lead])
            ends.append((link.GetTransform() @ local)[:3])
        np.testing.assert_allclose(slope, (ends[1] - ends[0]) / 2e-6, atol=1e-6)

    def test_other_limits_choose_another_root(self, body):
        for lower, upper in ((0, 3), (-3, 0), (-3, 3)):
            body.GetJoint("follow").SetLimits([lower], [upper])
            body.SetDOFValues([0.5])
            assert body.GetJoint("follow").GetValue() == pytest.approx(self.expected(body, 0.5), abs=1e-9)
            jacobian = body.ComputeJacobianAxisAngle(2)[1, 0]
            assert jacobian == pytest.approx(1 / (2 * self.expected(body, 0.5) + 1))

    def test_without_a_root_there_it_stops_at_a_limit(self, body):
        body.GetJoint("follow").SetLimits([1], [2])
        body.SetDOFValues([0.5])
        assert body.GetJoint("follow").GetValue() == 1


class TestPosesThatJointsDoNotGive:
    def test_joints_show_what_each_one_measures(self, env):
        env.LoadData(ANY_JOINTS)
        body = env.GetKinBody("any")
        for seed in range(20):
            transforms = random_poses(5, seed)
            body.SetLinkTransformations(transforms, np.zeros(4))
            poses = [pose_of(transform) for transform in transforms]
            joints = body.simulation_state.scene.joints
            shown = [measured_values(one, poses[one.parent].inverse() @ poses[one.child])[0] for one in joints]
            shown = np.array(shown) - [
                0 if joint.kind == "slider" else math.tau * round(value / math.tau)
                for joint, value in zip(joints, shown, strict=True)
            ]
            np.testing.assert_allclose(body.GetDOFValues(), shown, rtol=0, atol=1e-9)
            np.testing.assert_allclose(body.GetLinkTransformations(), transforms, rtol=0, atol=1e-9)

    def test_every_form_of_a_pose_may_stand_beside_the_others(self, env):
        env.LoadData(ANY_JOINTS)
        body = env.GetKinBody("any")
        a, b, c, d, e = random_poses(5)
        e_below = e.copy()
        e_below[3] = 5, 6, 7, 8  # never looked at
        body.SetLinkTransformations([a, b[:3], ravemj.poseFromMatrix(c), d.tolist(), e_below])
        np.testing.assert_allclose(body.GetLinkTransformations(), [a, b, c, d, e], rtol=0, atol=1e-9)
        body.SetLinkTransformations([a, b, c, d, e_below])
        np.testing.assert_allclose(body.GetLinkTransformations(), [a, b, c, d, e], rtol=0, atol=1e-9)
        for wrong in (np.nan, np.inf):
            e[0, 3] = wrong
            with pytest.raises(ravemj.openrave_exception, match="finite"):
                body.SetLinkTransformations([a, b, c, d, e])
        with pytest.raises(ravemj.openrave_exception, match="rotation"):
            body.SetLinkTransformations([a, b, c, d, np.diag([-1.0, 1, 1, 1])])
