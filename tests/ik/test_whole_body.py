"""Whole-body inverse kinematics against numbers that are known otherwise, and properties on many robots."""

import builtins
import math

import numpy as np
import pytest
from agreement import CORPUS, NEEDS_THE_CORPUS
from conftest import MODELS
from hypothesis import example, given
from hypothesis import strategies as st
from strategies import examples

import ravemj
from ravemj import DOFAffine, WholeBodyIK
from ravemj.ik.whole_body.bounds import MotionLimits
from ravemj.ik.whole_body.box_qp import BoxProblem, active_set, is_optimal

FREE = DOFAffine.X | DOFAffine.Y | DOFAffine.Z | DOFAffine.Rotation3D
FEET = ("left_foot", "right_foot")
(needs_corpus,) = NEEDS_THE_CORPUS


def planar_arm(lengths=(0.5, 0.4, 0.3), speed=100.0):
    """An arm in a plane, with its tool at the end of the last link."""
    bodies, joints = '<Body name="l0" type="dynamic"/>', ""
    for index in range(1, len(lengths) + 1):
        offset = lengths[index - 2] if index > 1 else 0
        bodies += (
            f'<Body name="l{index}" type="dynamic"><offsetfrom>l{index - 1}</offsetfrom>'
            f'<Translation>{offset} 0 0</Translation><Geom type="sphere"><radius>0.02</radius></Geom></Body>'
        )
        joints += (
            f'<Joint name="joint {index}" type="hinge"><Body>l{index - 1}</Body><Body>l{index}</Body>'
            f"<offsetfrom>l{index}</offsetfrom><axis>0 0 1</axis><limits>-3 3</limits>"
            f"<maxvel>{speed}</maxvel><maxaccel>40</maxaccel></Joint>"
        )
    tool = (
        f'<Manipulator name="the tip"><base>l0</base><effector>l{len(lengths)}</effector>'
        f"<Translation>{lengths[-1]} 0 0</Translation></Manipulator>"
    )
    env = ravemj.Environment()
    robot = env.ReadRobotData(f'<Robot name="arm"><KinBody>{bodies}{joints}</KinBody>{tool}</Robot>')
    env.Add(robot)
    return robot


def with_block(env, place):
    """Add a block of 5 kg at a pose."""
    block = env.ReadKinBodyData(
        '<KinBody name="block"><Body name="b" type="dynamic"><Geom type="box"><extents>0.05 0.05 0.05</extents></Geom>'
        '<Mass type="mimicgeom"><total>5</total></Mass></Body></KinBody>'
    )
    env.Add(block)
    block.SetTransform(place)
    return block


def biped():
    return ravemj.load(MODELS / "biped.robot.xml").GetRobots()[0]


def tip(robot):
    return robot.GetManipulators()[0].GetTransform()[:3, 3]


def start(robot):
    robot.SetDOFValues([0.3, 0.5, -0.4])
    return tip(robot)


class TestKnownNumbers:
    def test_one_step_is_the_pseudoinverse(self):
        robot = planar_arm()
        ik = WholeBodyIK(robot)
        ik.add_reach("the tip", np.add(start(robot), [0.01, -0.02, 0]))
        before = robot.GetDOFValues()
        jacobian = robot.ComputeJacobianTranslation(3, tip(robot))[:2]
        ik.step(1.0)
        step = robot.GetDOFValues() - before
        np.testing.assert_allclose(step, np.linalg.pinv(jacobian) @ [0.01, -0.02], atol=1e-8)
        np.testing.assert_allclose(step, [-0.018958, 0.003752, -0.009066], atol=1e-6)

    def test_a_limit_in_the_way_leaves_the_other_joints_the_rest(self):
        robot = planar_arm()
        robot.SetDOFLimits([0.295, -3, -3], [3, 3, 3])
        ik = WholeBodyIK(robot)
        ik.add_reach("the tip", np.add(start(robot), [0.01, -0.02, 0]))
        before = robot.GetDOFValues()
        jacobian = robot.ComputeJacobianTranslation(3, tip(robot))[:2]
        rest = np.linalg.solve(jacobian[:, 1:], [0.01, -0.02] + 0.005 * jacobian[:, 0])
        ik.step(1.0)
        step = robot.GetDOFValues() - before
        np.testing.assert_allclose(step, [-0.005, *rest], atol=1e-8)
        np.testing.assert_allclose(step, [-0.005, -0.0057328, -0.0421793], atol=1e-7)

    @pytest.mark.parametrize("elbow", [1, -1])
    def test_both_elbows_of_two_links(self, elbow):
        """By the law of cosines."""
        robot, (a, b), (x, y) = planar_arm((0.5, 0.4)), (0.5, 0.4), (0.3, 0.6)
        second = elbow * math.acos((x * x + y * y - a * a - b * b) / (2 * a * b))
        first = math.atan2(y, x) - math.atan2(b * math.sin(second), a + b * math.cos(second))
        robot.SetDOFValues([first + 0.2, second - 0.1])
        ik = WholeBodyIK(robot)
        ik.add_reach("the tip", [x, y, 0])
        assert ik.solve()
        np.testing.assert_allclose(robot.GetDOFValues(), [first, second], atol=1e-9)

    def test_a_target_out_of_reach_stretches_the_arm(self):
        robot = planar_arm()
        start(robot)
        ik = WholeBodyIK(robot)
        reach = ik.add_reach("the tip", [2.0, 0, 0])
        result = ik.solve()
        np.testing.assert_allclose(robot.GetDOFValues(), 0, atol=1e-7)
        np.testing.assert_allclose(reach.residual, [0.8, 0, 0], atol=1e-7)
        assert np.linalg.norm(reach.residual) == pytest.approx(0.8, abs=1e-12)
        assert not result
        assert result.reason == "stopped improving: the tip is 0.8 m away"
        assert result.residuals["the tip"] is not reach.residual

    @pytest.mark.parametrize("dt", [0.01, 0.03])
    def test_steps_to_a_target_out_of_reach_do_not_bounce(self, dt):
        robot = planar_arm()
        start(robot)
        ik = WholeBodyIK(robot)
        ik.add_reach("the tip", [2.0, 0, 0])
        for _ in range(100):
            ik.step(dt)
        np.testing.assert_allclose(robot.GetDOFValues(), 0, atol=1e-6)

    def test_a_limit_that_is_in_the_way_is_named(self):
        robot = planar_arm()
        start(robot)
        robot.SetDOFLimits([0.2, -3, -3], [3, 3, 3])
        ik = WholeBodyIK(robot)
        ik.add_reach("the tip", [0.0, -1.1, 0])
        result = ik.solve()
        assert result.active_limits == ["joint 1 is at its lower limit"]
        assert result.reason.endswith("m away; joint 1 is at its lower limit")


class TestWeightsAndPriorities:
    def com_over_one_foot(self, *weights, priorities):
        """How far the centre of mass stays from the left sole, with a hand that pulls [m]."""
        robot = biped()
        ik = WholeBodyIK(robot, base=True)
        foot, com, hand, posture = weights
        for name in FEET:
            ik.add_contact(name, weight=foot, priority=priorities[0])
        over = robot.GetManipulator("left_foot").GetTransform()[:2, 3]
        left = ik.add_com(over, axes="xy", weight=com, priority=priorities[1])
        ik.add_reach("right_hand", [0.55, -0.3, 0.75], weight=hand, priority=priorities[2])
        ik.add_posture(weight=posture, priority=priorities[3])
        ik.solve(400)
        feet = [task.residual for task in ik.tasks[:2]]
        return float(np.linalg.norm(left.residual)), float(np.abs(feet).max())

    def test_weights_give_in_and_priorities_do_not(self):
        pytest.importorskip("daqp")
        weighted, feet = self.com_over_one_foot(1, 1e-2, 1e-2, 1e-5, priorities=(1, 1, 1, 1))
        strict, strict_feet = self.com_over_one_foot(1, 1e-2, 1e-2, 1e-5, priorities=(1, 2, 3, 4))
        assert weighted == pytest.approx(0.0271506, abs=1e-5)
        assert strict < 1e-6
        assert max(feet, strict_feet) < 1e-8

    def test_levels_hold_with_limits_active(self):
        """A level never fails, however many bounds are active: velocities that are too slow for a fast swing."""
        pytest.importorskip("daqp")
        robot = biped()
        robot.SetDOFVelocityLimits([1.0] * robot.GetDOF())
        ik = WholeBodyIK(robot, base=True)
        feet = [ik.add_contact(name, priority=1) for name in FEET]
        com = ik.add_com(priority=2)
        ik.add_posture(priority=3)
        middle = np.array(com.target)

        def swing(time):
            com.target = middle + np.array([0, 0.15 * math.sin(6 * time), 0.03 * math.sin(9 * time)])
            lower, upper = robot.GetDOFLimits()
            assert (robot.GetDOFValues() >= lower).all()
            assert (robot.GetDOFValues() <= upper).all()
            assert max(np.abs(foot.residual).max() for foot in feet) < 1e-6

        ik.follow(4.0, update=swing)

    @pytest.mark.parametrize("call", ["priority", "distance", "support"])
    def test_without_daqp_the_extra_is_named(self, call, monkeypatch):
        plain = builtins.__import__

        def importing(name, *rest, **named):
            if name == "daqp":
                raise ImportError(name)
            return plain(name, *rest, **named)

        robot = biped()
        ik = WholeBodyIK(robot, base=True)
        ik.add_contact("left_foot")
        assert ik.solve()
        monkeypatch.setattr(builtins, "__import__", importing)
        ik.add_com()
        assert ik.solve()
        with pytest.raises(ravemj.openrave_exception, match=r"pip install 'ravemj\[wholebody\]'"):  # noqa: PT012
            if call == "priority":
                ik.add_com(priority=2)
                ik.solve()
            elif call == "distance":
                ik.add_distance()
            else:
                ik.add_support([[0, 0], [1, 0], [0, 1]])


class TestContacts:
    def test_ten_seconds_without_drift(self):
        robot = biped()
        robot.SetActiveDOFs(range(robot.GetDOF()), FREE)
        ik = WholeBodyIK(robot)
        kept = [ik.add_contact(name) for name in (*FEET, "left_hand", "right_hand")]
        com = ik.add_com()
        ik.add_posture(weight=1e-6)
        middle, worst = np.array(com.target), []
        poses = [robot.GetManipulator(task.name).GetTransform() for task in kept]

        def swing(time):
            com.target = middle + 0.03 * np.array([math.sin(time), math.cos(time) - 1, 0])
            worst.append(max(np.abs(task.residual).max() for task in kept))

        motion = ik.follow(10.0, update=swing)
        assert max(worst) < 1e-8
        spec = robot.GetActiveConfigurationSpecification("linear")
        for row in motion.GetWaypoints2D(0, motion.GetNumWaypoints(), spec)[::50]:
            robot.SetActiveDOFValues(row)
            for task, pose in zip(kept, poses, strict=True):
                np.testing.assert_allclose(robot.GetManipulator(task.name).GetTransform(), pose, atol=1e-6)
        assert motion.GetDuration() == pytest.approx(10)

    @pytest.mark.parametrize(
        "goal", [[1.43, -1.87, 0.92], [1.92, 0.74, 0.6], [1.71, 1.87, -1.94], [-1.96, -0.54, -1.69]]
    )
    def test_a_target_out_of_reach_does_not_open_them(self, goal):
        for limb in ("left_hand", "right_hand"):
            ik = WholeBodyIK(biped(), base=True)
            kept = [ik.add_contact(foot) for foot in FEET]
            ik.add_reach(limb, goal)
            result = ik.solve()
            assert not result
            assert f": {limb} is" in result.reason
            assert max(np.abs(contact.residual).max() for contact in kept) < 1e-8

    def test_contacts_that_contradict_each_other_are_no_error(self):
        robot = biped()
        ik = WholeBodyIK(robot, base=True)
        apart = robot.GetManipulator("left_foot").GetTransform()
        apart[1, 3] += 5
        ik.add_contact("left_foot", apart)
        ik.add_contact("right_foot")
        result = ik.solve()
        assert not result
        assert "m and" in result.reason

    def test_a_limb_of_a_closed_form_agrees(self):
        """The legs of the biped hang on a base that stands where the feet are told to be."""
        robot = biped()
        ik = WholeBodyIK(robot, base=True)
        arm = robot.GetManipulator("left_foot")
        goal = arm.GetTransform() @ ravemj.matrixFromPose([math.cos(0.1), 0, 0, math.sin(0.1), 0.03, 0.02, 0.08])
        ik.add_contact("Pelvis")
        ik.add_contact("left_foot", goal)
        assert ik.solve()
        found = arm.ik(goal)
        solutions = found.solutions[0][found.valid[0]]
        assert np.abs(solutions - arm.GetArmDOFValues()).max(axis=1).min() < 1e-6


class TestLimits:
    numbers = st.floats(-5, 5)

    @examples(300)
    @given(
        st.floats(-3, 3), st.floats(-8, 8), st.floats(0.01, 5), st.floats(0.1, 80), st.floats(1e-4, 0.2), st.booleans()
    )
    @example(-1.9982076298844957, 1.762180511521184, 1.762180511521184, 0.1, 0.0001, True)
    def test_bounds_never_contradict(self, value, speed, fastest, change, dt, accelerates):
        limits = MotionLimits(*(np.array([x]) for x in (-1.0, 1.0, fastest, change if accelerates else np.inf)))
        lower, upper = limits.displacements(np.array([value]), np.array([speed]), dt)
        assert lower <= upper
        assert abs(lower) <= fastest * dt * (1 + 1e-12)
        assert abs(upper) <= fastest * dt * (1 + 1e-12)
        if not accelerates and abs(value) > 1 + fastest * dt:
            assert lower == upper == -np.sign(value) * fastest * dt

    @examples(100)
    @given(st.floats(0.05, 5), st.floats(0.5, 80), st.floats(1e-3, 0.05))
    def test_brakes_are_strong_enough(self, fastest, change, dt):
        """Driven towards a limit as fast as the bounds let it, a joint stops before it, within its acceleration."""
        limits = MotionLimits(*(np.array([x]) for x in (-1.0, 1.0, fastest, change)))
        value, speed = np.zeros(1), np.zeros(1)
        for _ in range(400):
            _, upper = limits.displacements(value, speed, dt)
            value, before, speed = value + upper, speed, upper / dt
            assert abs(speed - before) <= change * dt * (1 + 1e-9)
            assert value <= 1 + 1e-12

    def test_a_robot_outside_of_its_limits_comes_back(self):
        robot = planar_arm(speed=2.0)
        ik = WholeBodyIK(robot)
        ik.limits.accelerations = True
        ik.add_reach("the tip", [0.5, 0.2, 0])
        robot.SetDOFValues([3.1, 0.5, -0.4], checklimits=0)
        values = [robot.GetDOFValues()]
        for _ in range(30):
            ik.step(0.01)
            values.append(robot.GetDOFValues())
        speeds = np.diff(values, axis=0) / 0.01
        assert np.abs(speeds).max() <= 2.0 + 1e-9
        assert np.abs(np.diff(speeds, axis=0)).max() <= 40 * 0.01 + 1e-9
        outside = [row[0] > 3 + 1e-12 for row in values]
        assert sum(outside) <= math.ceil(0.1 / (2.0 * 0.01)) + math.ceil(2.0 / (40 * 0.01)) + 1

    def test_joints_never_leave_their_limits(self):
        robot = biped()
        ik = WholeBodyIK(robot, base=True)
        for name in FEET:
            ik.add_contact(name)
        com = ik.add_com(weight=1.0)
        middle = np.array(com.target)
        lower, upper = robot.GetDOFLimits()

        def swing(time):
            com.target = middle + 0.15 * np.array([math.sin(5 * time), math.cos(5 * time), -abs(math.sin(time))])
            assert (robot.GetDOFValues() >= lower).all()
            assert (robot.GetDOFValues() <= upper).all()

        ik.follow(10.0, update=swing)

    def test_self_collisions_end(self):
        """A hand in the torso comes out of it at each step, and a goal in there is not reached then."""
        pytest.importorskip("daqp")
        robot, inside = biped(), [0.07, 0.05, 0.75]
        robot.SetActiveDOFs(range(15, 20))
        alone = WholeBodyIK(robot)
        alone.add_reach("left_hand", inside)
        assert alone.solve()
        checker = robot.GetEnv().GetCollisionChecker()
        ik = WholeBodyIK(robot, base=True)
        for name in FEET:
            ik.add_contact(name)
        ik.add_distance()
        depths = []
        while robot.CheckSelfCollision():
            report = ravemj.CollisionReport()
            checker.SetCollisionOptions(ravemj.CollisionOptions.Contacts)
            robot.CheckSelfCollision(report)
            depths.append(max(contact.depth for contact in report.contacts))
            ik.step(0.01)
            assert len(depths) < 30
        assert len(depths) > 2
        assert (np.diff(depths) < 0).all()
        ik.add_reach("left_hand", inside)
        assert "left_hand" in ik.solve().reason
        assert not robot.CheckSelfCollision()

    def test_obstacles_are_kept_away_from(self):
        pytest.importorskip("daqp")
        robot = biped()
        env = robot.GetEnv()
        wall = ravemj.RaveCreateKinBody(env, "")
        wall.InitFromBoxes(np.array([[0.3, 0, 0.8, 0.02, 0.5, 0.5]]), True)
        wall.SetName("wall")
        env.Add(wall)
        ik = WholeBodyIK(robot, base=True)
        for name in FEET:
            ik.add_contact(name)
        ik.add_reach("left_hand", [0.5, 0.2, 0.8])
        ik.add_distance(wall, minimum=0.03)
        result = ik.solve()
        assert not result
        report = ravemj.CollisionReport()
        checker = env.GetCollisionChecker()
        checker.SetCollisionOptions(ravemj.CollisionOptions.Distance)
        assert not env.CheckCollision(robot, wall, report)
        assert report.minDistance > 0.03 - 5e-3  # the hand turns, and another corner comes nearer

    def test_the_support_keeps_the_centre_of_mass(self):
        pytest.importorskip("daqp")
        robot = biped()
        ik = WholeBodyIK(robot, base=True)
        soles = []
        for name in FEET:
            ik.add_contact(name)
            sole = robot.GetManipulator(name).GetTransform()
            corners = [[x, y, 0, 1] for x in (-0.09, 0.09) for y in (-0.045, 0.045)]
            soles += [(sole @ corner)[:3] for corner in corners]
        ik.add_support(soles)
        ik.add_reach("left_hand", [1.2, 0.2, 0.7])
        assert not ik.solve()
        com = robot.GetCenterOfMass()
        assert np.min(soles, axis=0)[0] - 1e-4 <= com[0] <= np.max(soles, axis=0)[0] + 1e-4
        assert com[0] > 0.1  # it goes as far as it may


class TestBase:
    def test_a_base_that_lies_on_its_face_converges(self):
        robot = biped()
        robot.SetTransform(ravemj.matrixFromPose([math.sqrt(0.5), 0, math.sqrt(0.5), 0, 0.2, 0.1, 0.3]))
        ik = WholeBodyIK(robot, base=True)
        ik.add_contact("left_foot")
        ik.add_reach("right_hand", np.add(robot.GetManipulator("right_hand").GetTransform()[:3, 3], [0.05, 0.1, 0.2]))
        assert ik.solve()

    @pytest.mark.parametrize(
        "affine", [0, DOFAffine.X | DOFAffine.Y | DOFAffine.RotationAxis, DOFAffine.Z, FREE, DOFAffine.Transform]
    )
    def test_only_active_parts_of_the_base_move(self, affine):
        robot = biped()
        robot.SetActiveDOFs([*range(12, 25)], affine, [0, 0, 1])
        before, legs = robot.GetTransform(), robot.GetDOFValues(range(12))
        ik = WholeBodyIK(robot)
        ik.add_reach("left_hand", [0.6, 0.5, 0.9])
        ik.solve()
        after = robot.GetTransform()
        np.testing.assert_array_equal(robot.GetDOFValues(range(12)), legs)
        moved = np.abs(after[:3, 3] - before[:3, 3]) > 1e-9
        assert not (moved & ~np.array([bool(affine & part) for part in (1, 2, 4)])).any()
        if not affine & DOFAffine.RotationMask:
            np.testing.assert_allclose(after[:3, :3], before[:3, :3], atol=1e-12)
        elif affine & DOFAffine.RotationAxis:
            np.testing.assert_allclose(after[:3, 2], [0, 0, 1], atol=1e-12)

    def test_the_motion_of_a_base_plays(self):
        robot = biped()
        ik = WholeBodyIK(robot, base=True)
        ik.add_contact("left_foot")
        ik.add_com(np.add(robot.GetCenterOfMass(), [0, 0.05, 0]))
        motion = ik.follow(0.5)
        last, values = robot.GetTransform(), robot.GetDOFValues()
        robot.SetTransform(np.eye(4))
        robot.GetController().SetPath(motion)
        robot.GetEnv().StartSimulation(0.01, realtime=False)
        assert robot.WaitForController(60)
        np.testing.assert_allclose(robot.GetDOFValues(), values, atol=1e-9)
        np.testing.assert_allclose(robot.GetTransform(), last, atol=1e-9)


class TestTasks:
    @pytest.mark.parametrize("name", ["puma560.xml", "panda.xml", "scara.dae", "biped.robot.xml"])
    def test_rows_are_derivatives(self, name):
        """Of frames, the centre of mass with a grabbed body, couplings: against differences along displacements."""
        env = ravemj.load(MODELS / name)
        robot = env.GetRobots()[0]
        lower, upper = robot.GetDOFLimits()
        robot.SetDOFValues(lower + (upper - lower) * 0.4)
        robot.SetTransform(ravemj.matrixFromPose([0.8, 0.6, 0, 0, 0.3, 0.2, 0.1]))
        arm = robot.GetManipulators()[-1]
        robot.Grab(with_block(env, arm.GetTransform()), arm.GetEndEffector())
        ik = WholeBodyIK(robot, base=True)
        T = arm.GetTransform()
        ik.add_reach(arm.GetName(), T)
        ik.add_com()
        ik.add_look_at(arm.GetName(), T[:3, :3] @ arm.GetLocalToolDirection() + np.add(T[:3, 3], [0.1, 0.2, -0.1]))
        ik.add_posture()
        values, T_world_base = robot.GetDOFValues(), robot.GetTransform()

        def error(task, displacement):
            robot.SetDOFValues(values + displacement[:-6])
            turned = ravemj.matrixFromAxisAngle(displacement[-3:]) @ T_world_base
            turned[:3, 3] = T_world_base[:3, 3] + displacement[-6:-3]
            robot.SetTransform(turned)
            return task.task.rows().error

        for task in ik.tasks:
            jacobian = task.task.rows().jacobian
            small = 1e-6 * np.eye(len(values) + 6)
            quotient = np.array([error(task, -d) - error(task, d) for d in small]).T / 2e-6
            np.testing.assert_allclose(jacobian, quotient, atol=1e-7)
            error(task, 0 * small[0])

    def test_the_centre_of_mass_is_that_of_robot_and_load(self):
        robot = biped()
        block = with_block(robot.GetEnv(), robot.GetManipulator("left_hand").GetTransform())
        robot.Grab(block, robot.GetLink("LHand"))
        both = robot.GetMass() * robot.GetCenterOfMass() + 5.0 * block.GetCenterOfMass()
        com = WholeBodyIK(robot).add_com()
        np.testing.assert_allclose(com.target, both / (robot.GetMass() + 5), atol=1e-9)

    @pytest.mark.parametrize(
        "kind",
        [kind for kind in ravemj.IkParameterization.Type.values.values() if kind.name in {
            "Transform6D", "Rotation3D", "Translation3D", "Direction3D", "Ray4D", "Lookat3D", "TranslationDirection5D",
            "TranslationXY2D", "TranslationLocalGlobal6D", "TranslationZAxisAngle4D", "TranslationXAxisAngleZNorm4D",
        }],
    )  # fmt: skip
    def test_goals_of_every_type(self, kind):
        """A goal that the present pose has is met; one of another configuration is reached."""
        robot = ravemj.load(MODELS / "puma560.xml").GetRobots()[0]
        arm = robot.GetManipulators()[0]
        robot.SetDOFValues([0.3, -0.5, 0.4, 0.2, 0.7, 0.3])
        goal = arm.GetIkParameterization(kind, inworld=True)
        robot.SetDOFValues([0.2, -0.4, 0.5, 0.3, 0.6, 0.2])
        ik = WholeBodyIK(robot)
        ik.add_reach(arm.GetName(), goal)
        assert ik.solve().reason == "met"
        reached = arm.GetIkParameterization(goal, inworld=True)
        assert goal.ComputeDistanceSqr(reached) < 1e-8

    def test_a_body_is_followed(self):
        robot = biped()
        env = robot.GetEnv()
        ball = ravemj.RaveCreateKinBody(env, "")
        ball.InitFromSpheres(np.array([[0, 0, 0, 0.05]]), True)
        ball.SetName("ball")
        env.Add(ball)
        ik = WholeBodyIK(robot, base=True)
        ik.add_contact("left_foot")
        ik.add_reach("right_hand", ball, rotation=False)
        ik.add_look_at("eyes", ball)
        for place in ([0.3, -0.3, 0.7], [0.3, 0.0, 0.9]):
            ball.SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, *place]))
            assert ik.solve()
            np.testing.assert_allclose(robot.GetManipulator("right_hand").GetTransform()[:3, 3], place, atol=1e-4)

    def test_couplings_and_postures(self):
        robot = biped()
        ik = WholeBodyIK(robot, base=True)
        ik.add_joint_coupling({"L_KNEE": 1.0, "R_KNEE": -1.0})
        ik.add_joint_coupling({"NECK_P": 2.0}, 0.5)
        posture = ik.add_posture(np.linspace(0, 0.3, 25))
        assert ik.solve()
        knees = robot.GetDOFValues([robot.GetJoint(name).GetDOFIndex() for name in ("L_KNEE", "R_KNEE")])
        assert knees[0] == pytest.approx(knees[1], abs=1e-6)
        assert robot.GetJoint("NECK_P").GetValue(0) == pytest.approx(0.25, abs=1e-5)
        assert np.abs(posture.residual).max() < 0.3

    def test_tasks_change_and_go(self):
        robot = planar_arm()
        start(robot)
        ik = WholeBodyIK(robot)
        first = ik.add_reach("the tip", [0.9, 0.3, 0])
        second = ik.add_reach("the tip", [0.3, 0.9, 0], weight=5, gain=0.5)
        assert [task.name for task in ik.tasks] == ["the tip", "the tip 2"]
        first.enabled = False
        assert ik.solve()
        ik.remove(second)
        first.enabled, first.weight = True, 2
        assert ik.solve()
        np.testing.assert_allclose(tip(robot), [0.9, 0.3, 0], atol=1e-6)
        with pytest.raises(ravemj.ArgumentError, match="no task of this"):
            ik.remove(second)

    def test_nothing_active_moves_nothing(self):
        robot = planar_arm()
        before = start(robot)
        robot.SetActiveDOFs([])
        ik = WholeBodyIK(robot)
        ik.add_reach("the tip", [0.9, 0.3, 0])
        ik.step(0.1)
        assert not ik.solve()
        np.testing.assert_array_equal(tip(robot), before)

    def test_the_same_bits_twice(self):
        found = []
        for _ in range(2):
            robot = biped()
            ik = WholeBodyIK(robot, base=True)
            ik.add_contact("left_foot")
            ik.add_reach("right_hand", [0.4, -0.1, 0.9])
            ik.solve()
            found.append(robot.GetDOFValues().tobytes())
        assert found[0] == found[1]

    @needs_corpus
    @pytest.mark.corpus
    @pytest.mark.filterwarnings("ignore")  # of the published model
    @pytest.mark.parametrize("seed", range(3))
    def test_two_arms_share_the_torso_of_a_pr2(self, seed):
        env = ravemj.Environment()
        assert env.Load(CORPUS / "models" / "rdiankov+openrave" / "src" / "robots" / "pr2-beta-static.zae")
        robot = env.GetRobots()[0]
        arms = [robot.GetManipulator(name) for name in ("leftarm", "rightarm")]
        dofs = sorted(
            {robot.GetJoint("torso_lift_joint").GetDOFIndex(), *(d for arm in arms for d in arm.GetArmIndices())}
        )
        lower, upper = (np.clip(limits, -3, 3) for limits in robot.GetDOFLimits(dofs))
        rng = np.random.default_rng(seed)
        values = rng.uniform(0.7 * lower + 0.3 * upper, 0.3 * lower + 0.7 * upper)
        robot.SetDOFValues(values, dofs)
        goals = [arm.GetTransform() for arm in arms]
        robot.SetDOFValues(np.clip(values + rng.uniform(-0.2, 0.2, len(dofs)), lower, upper), dofs)
        robot.SetActiveDOFs(dofs)
        ik = WholeBodyIK(robot)
        for arm, goal in zip(arms, goals, strict=True):
            ik.add_reach(arm.GetName(), goal)
        assert ik.solve()
        for arm, goal in zip(arms, goals, strict=True):
            np.testing.assert_allclose(arm.GetTransform(), goal, atol=1e-9)

    def test_panda_agrees_with_its_closed_form(self):
        robot = ravemj.load(MODELS / "panda.xml").GetRobots()[0]
        arm = robot.GetManipulators()[0]
        dofs, values = arm.GetArmIndices(), np.array([0.3, -0.4, 0.2, -1.8, 0.3, 1.7, 0.5])
        robot.SetDOFValues(values, dofs)
        goal = arm.GetTransform()
        robot.SetDOFValues(values + 0.15, dofs)
        robot.SetActiveDOFs(dofs)
        ik = WholeBodyIK(robot)
        ik.add_reach("arm", goal)
        assert ik.solve()
        np.testing.assert_allclose(arm.GetTransform(), goal, atol=1e-9)
        last = arm.GetArmDOFValues()
        solver = arm.ik_solver(ravemj.IkParameterization.Type.Transform6D)
        T_base_goal = np.linalg.inv(arm.GetBase().GetTransform()) @ goal
        free = {joint: last[joint] for joint in solver.free}
        assert free
        known = solver.solve(T_base_goal[None], free=np.array([list(free.values())])).of(0)
        assert np.abs(known - last).max(axis=1).min() < 1e-6


class TestErrors:
    @pytest.mark.parametrize(
        ("method", "arguments", "message"),
        [
            ("add_reach", ("no hand", [0, 0, 0]), "no manipulator or link 'no hand'; its manipulators: the tip"),
            ("add_reach", ("the tip", [0, math.nan, 0]), "target"),
            ("add_reach", ("the tip", [1, 2]), "target"),
            ("add_contact", ("the tip", [1, 2, 3]), "a contact needs a pose"),
            ("add_reach", ("the tipp", [0, 0, 0]), "; did you mean 'the tip'\\? Its manipulators: the tip"),
            ("add_joint_coupling", ({},), "coefficients: are empty, and should name at least one active joint"),
            ("add_com", ([0, 0], "xyzz"), "."),
            ("add_com", ([0, 0],), "target"),
            ("add_posture", ([0, 0],), "values"),
            ("add_joint_coupling", ({"joint 9": 1.0},), "'joint 9' is no active joint; these are joint 1, joint 2"),
            ("step", (0,), "dt: is 0 s, and should be above 0"),
            ("step", (math.nan,), "dt"),
            ("follow", (-1,), "duration"),
        ],
    )
    def test_wrong_arguments(self, method, arguments, message):
        robot = planar_arm()
        before = start(robot)
        ik = WholeBodyIK(robot)
        with pytest.raises((ravemj.openrave_exception, TypeError, ValueError), match=message):
            getattr(ik, method)(*arguments)
        assert ik.tasks == []
        np.testing.assert_array_equal(tip(robot), before)

    def test_wrong_targets_keep_the_old_one(self):
        robot = planar_arm()
        start(robot)
        task = WholeBodyIK(robot).add_reach("the tip", [0.9, 0.3, 0])
        with pytest.raises(ValueError, match="target"):
            task.target = [1, 2]
        assert task.target == [0.9, 0.3, 0]
        with pytest.raises(ravemj.ArgumentError, match="weight"):
            task.weight = -1
        with pytest.raises(ravemj.ArgumentError, match="gain"):
            task.gain = 2

    @pytest.mark.parametrize("priority", [1.5, "high", None])
    def test_priorities_are_whole_numbers(self, priority):
        ik = WholeBodyIK(planar_arm())
        with pytest.raises(ravemj.ArgumentError, match="priority"):
            ik.add_posture(priority=priority)
        task = ik.add_posture()
        with pytest.raises(ravemj.ArgumentError, match="priority"):
            task.priority = priority
        assert task.priority == 1
        assert ik.tasks == [task]

    @pytest.mark.parametrize("speed", [-1.0, math.nan, math.inf, "fast"])
    def test_velocities_of_the_base_are_numbers(self, speed):
        robot = planar_arm()
        ik = WholeBodyIK(robot, base=True)
        before = start(robot)
        ik.add_reach("the tip", [0.9, 0.3, 0])
        ik.limits.base_velocity = speed
        for call in (ik.solve, lambda: ik.step(0.01)):
            with pytest.raises(ravemj.ArgumentError, match=r"limits\.base_velocity"):
                call()
        np.testing.assert_array_equal(tip(robot), before)
        ik.limits.base_velocity = 0
        ik.step(0.01)
        np.testing.assert_array_equal(robot.GetTransform(), np.eye(4))

    def test_misspelt_limits_are_refused(self):
        with pytest.raises(AttributeError, match="velocity"):
            WholeBodyIK(planar_arm()).limits.velocity = False

    def test_a_frame_of_its_own_is_no_target(self):
        robot = planar_arm()
        with pytest.raises(ravemj.ArgumentError, match="itself"):
            WholeBodyIK(robot).add_reach("the tip", robot.GetLink("l1"))

    def test_a_robot_in_no_environment(self):
        robot = planar_arm()
        robot.GetEnv().Remove(robot)
        with pytest.raises(ravemj.openrave_exception, match="not in an environment"):
            WholeBodyIK(robot)

    def test_a_support_on_a_line(self):
        pytest.importorskip("daqp")
        with pytest.raises(ravemj.ArgumentError, match="should not be on a line"):
            WholeBodyIK(planar_arm()).add_support([[0, 0], [1, 1], [2, 2]])


class TestQuadraticProgram:
    @examples(200)
    @given(st.integers(0, 2**32 - 1), st.sampled_from([1e-4, 1e-2, 1.0, 1e4]))
    def test_answers_are_optimal(self, seed, size):
        """Also for tiny numbers, bounds that touch the start, fixed variables and singular matrices."""
        rng = np.random.default_rng(seed)
        count = int(rng.integers(1, 30))
        rows = rng.normal(size=(int(rng.integers(1, 40)), count)) * 10.0 ** rng.uniform(-3, 0, (1, count))
        hessian = rows.T @ rows + 10.0 ** rng.uniform(-8, 0) * np.eye(count)
        gradient = rng.normal(size=count) * size
        lower, upper = -size * rng.uniform(0, 1, count), size * rng.uniform(0, 1, count)
        lower[rng.random(count) < 0.2] = -1e-13
        upper[rng.random(count) < 0.2] = 0.0
        fixed = rng.random(count) < 0.1
        lower[fixed] = upper[fixed]
        lower = np.minimum(lower, upper)
        x = BoxProblem(hessian, lower, upper).minimise(gradient)
        assert (x >= lower - 1e-9).all()
        assert (x <= upper + 1e-9).all()

        costs = [y @ hessian @ y / 2 + gradient @ y for y in (x, active_set(hessian, gradient, lower, upper))]
        snapped = 1e-9 * np.abs(gradient).sum()  # bounds this near to the start count as touching it
        assert costs[0] <= costs[1] + 1e-8 * abs(costs[1]) + snapped

    @examples(100)
    @given(st.integers(0, 2**32 - 1))
    def test_the_active_set_is_optimal(self, seed):
        rng = np.random.default_rng(seed)
        count = int(rng.integers(1, 25))
        rows = rng.normal(size=(count + 3, count))
        hessian, gradient = rows.T @ rows, rng.normal(size=count) * 5
        lower, upper = -rng.uniform(0, 1, count), rng.uniform(0, 1, count)
        x = active_set(hessian, gradient, lower, upper)
        assert is_optimal(hessian, gradient, lower, upper, x)
        assert not is_optimal(hessian, gradient, lower, upper, np.clip(x + 0.1, lower, upper)) or count == 1
