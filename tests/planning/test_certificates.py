"""Certificates: bounds that hold for all configurations between, and motions that are proved or not, as they should."""

import warnings

import mujoco
import numpy as np
import pytest
import strategies
from conftest import MODELS, one_in
from hypothesis import given
from hypothesis import strategies as st

import ravemj
from ravemj import DOFAffine
from ravemj.manipulation.bodies import Bodies
from ravemj.manipulation.certification import BodySpaces, Certifier, UncertifiableError
from ravemj.planning.curves import Curve, Intervals, line_curve
from ravemj.planning.proofs import Cases

SWING = """<Environment><Robot name="arm"><KinBody>
  <Body name="base"><Geom type="sphere"><radius>0.001</radius></Geom></Body>
  <Body name="link"><Geom type="box"><extents>0.5 0.005 0.005</extents><translation>0.5 0 0</translation></Geom></Body>
  <Joint name="turn" type="hinge"><Body>base</Body><Body>link</Body><axis>0 0 1</axis>
    <limitsrad>-1 2</limitsrad><resolution>2.8648</resolution></Joint>
</KinBody></Robot><KinBody name="post"><Body name="post"><Geom type="cylinder"><radius>0.01</radius><height>1</height>
  <rotationaxis>1 0 0 90</rotationaxis></Geom></Body></KinBody></Environment>"""
"""A link of length 1 that turns from 0 to 1 rad, tested in steps of 0.05 rad, and a post."""

DISTANCE, ANGLE = 0.9, 0.525  # of the post: the link is 7.5 mm from it at the nearest step
FIRST_TOUCH = ANGLE - np.arcsin((0.01 + 0.005) / DISTANCE)


def swing(distance=DISTANCE, angle=ANGLE):
    env = ravemj.Environment()
    assert env.LoadData(SWING)
    T_world_post = np.eye(4)
    T_world_post[:2, 3] = distance * np.cos(angle), distance * np.sin(angle)
    env.GetKinBody("post").SetTransform(T_world_post)
    robot = env.GetRobot("arm")
    robot.SetActiveDOFs([0])
    return robot


def moving(robot) -> Bodies:
    groups = robot.GetActiveConfigurationSpecification().GetGroups()
    return Bodies(robot.GetEnv().simulation, groups, robot.GetEnv().GetCollisionChecker)


def timed(robot, points) -> ravemj.Trajectory:
    """Return straight lines through points of what is active, one second each."""
    spec = robot.GetActiveConfigurationSpecification("linear")
    spec.AddDeltaTimeGroup()
    traj = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    traj.Init(spec)
    for number, point in enumerate(points):
        traj.Insert(number, [*point, float(number > 0)])
    return traj


class TestCurves:
    @given(st.integers(1, 7), st.integers(0, 1000), st.integers(2, 8), st.floats(0.01, 0.99))
    @strategies.examples(50)
    def test_parts_are_the_curve(self, number, seed, count, part):
        coefficients = np.random.default_rng(seed).normal(size=(number, 3))
        curve = Curve.of_powers(1.0, 3.0, coefficients)
        powers = np.arange(number)
        line = line_curve(np.zeros(3), np.ones(3))  # of another degree
        parts, origins = Intervals.of([curve, line, curve]).parts(np.array([count, 1, 2]))
        for index, row in enumerate(np.flatnonzero(origins == 0).tolist()):
            place, (start, end) = (index + part) / count, parts.times[row].tolist()
            at = Curve(start, end, parts.control[row]).at(part)
            np.testing.assert_allclose(at, place**powers @ coefficients, atol=1e-9)
            assert (start, end) == pytest.approx((1 + 2 * index / count, 1 + 2 * (index + 1) / count))
        (row,) = np.flatnonzero(origins == 1)
        np.testing.assert_allclose(Curve(0.0, 1.0, parts.control[row]).at(part), np.full(3, part), atol=1e-12)
        first, second = curve.split(part)
        np.testing.assert_allclose(first.at(0.5), (part / 2) ** powers @ coefficients, atol=1e-9)
        np.testing.assert_allclose(second.control[0], part**powers @ coefficients, atol=1e-9)


def assert_bounded(bodies, lower, upper, seed, *, spread, count=6) -> None:
    """Check that no pair comes nearer than its bounds say, wherever joints may be."""
    numbers = np.random.default_rng(seed)
    with bodies.kept():
        spaces = BodySpaces(bodies)
        world = bodies.world()
        model, data = world.model.model, world.model.data

        def distances(values):
            bodies.move(values)
            bodies.world()
            return np.array([mujoco.mj_geomDistance(model, data, a, b, 1e3, None) for a, b in spaces.pairs.tolist()])

        for _ in range(count):
            middle = numbers.uniform(lower, upper)
            change = spread * numbers.uniform(0, 1, len(middle))
            pairs = np.arange(spaces.pair_count)
            tested = spaces.test([middle], [change], Cases(np.zeros_like(pairs), pairs), 1e9)
            spaces.put_back()
            here = distances(middle)
            assert (tested.gaps <= np.maximum(here, 0) + 1e-6).all()
            for _ in range(4):
                there = distances(middle + change * numbers.choice([-1.0, 1.0, numbers.uniform(-1, 1)], len(middle)))
                assert (np.maximum(here, 0) - np.maximum(there, 0) <= tested.travel + 1e-6).all()


class TestBounds:
    @pytest.mark.parametrize("model", ["panda.xml", "puma560.xml", "double-pendulum.xml", "scara.dae"])
    def test_of_models(self, model):
        env = ravemj.Environment()
        env.Load(str(MODELS / model))
        robot = env.GetRobots()[0]
        robot.SetActiveDOFs(range(robot.GetDOF()))
        assert_bounded(moving(robot), *robot.GetActiveDOFLimits(), 1, spread=0.3)

    def test_of_a_moving_base_with_a_held_box(self):
        env = ravemj.Environment()
        env.Load(str(MODELS / "puma560.xml"))
        robot, box = env.GetRobots()[0], ravemj.RaveCreateKinBody(env, "")
        box.InitFromBoxes([[0, 0, 0, 0.05, 0.1, 0.2]])
        box.SetName("box")
        env.Add(box)
        wall = ravemj.RaveCreateKinBody(env, "")
        wall.InitFromBoxes([[2, 0, 0, 0.05, 1, 1]])
        wall.SetName("wall")
        env.Add(wall)
        hand = robot.GetActiveManipulator()
        box.SetTransform(hand.GetTransform())
        robot.Grab(box, hand.GetEndEffector())
        affine = DOFAffine.X | DOFAffine.Y | DOFAffine.RotationAxis
        robot.SetActiveDOFs(range(robot.GetDOF()), affine, [0.6, 0, 0.8])
        assert_bounded(moving(robot), *np.clip(robot.GetActiveDOFLimits(), -2, 2), 2, spread=0.4)

    @given(strategies.scenes(), st.integers(0, 1000))
    @strategies.examples(30)
    def test_of_scenes_made_by_chance(self, scene, seed):
        env = ravemj.Environment()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            env.LoadData(strategies.xml(strategies.scene_node(scene)))
            for robot in env.GetRobots():
                dofs = [dof for dof in range(robot.GetDOF()) if robot.GetJointFromDOFIndex(dof).GetDOF() == 1]
                robot.SetActiveDOFs(dofs)
                if not dofs or not robot.GetActiveDOFIndices().size:
                    continue
                try:
                    with moving(robot).kept():
                        BodySpaces(moving(robot))
                except UncertifiableError:
                    continue
                limits = np.clip(robot.GetActiveDOFLimits(), -4, 4)
                assert_bounded(moving(robot), *limits, seed, spread=0.5, count=2)


class TestCertificates:
    def test_tests_in_steps_see_nothing_of_a_thin_post(self):
        robot = swing()
        for number in range(21):
            robot.SetDOFValues([number * 0.05])
            assert not robot.GetEnv().CheckCollision(robot)

    def test_a_post_between_two_steps_is_found(self):
        traj = timed(swing(), [[0.0], [1.0]])
        certificate = traj.certify()
        assert not certificate.certified
        assert not certificate.reason
        (found,) = certificate.undecided
        assert found.pair == ("link 'link' of 'arm'", "link 'post' of 'post'")
        assert found.start < FIRST_TOUCH < found.start + 0.005
        assert found.end > ANGLE
        assert certificate.smallest_gap == 0
        assert traj.certificate is certificate
        assert str(certificate).startswith("not certified: link 'link' of 'arm' and link 'post' of 'post' from 0.50")

    @pytest.mark.parametrize("distance", [1.2, 1.05, 1.03, 1.02, 1.012])
    def test_a_post_beyond_the_end_is_proved_to_be_free(self, distance):
        certificate = timed(swing(distance), [[0.0], [1.0]]).certify()
        gap = distance - 0.01 - np.hypot(1, 0.005)
        assert certificate.certified
        assert certificate.undecided == ()
        assert gap - max(1.1e-3, 0.06 * gap) <= certificate.smallest_gap <= gap + 1e-5
        assert certificate.nearest.start == pytest.approx(ANGLE, abs=0.05)
        ends = np.array(certificate.nearest_points)
        assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(gap, abs=1e-3)
        post = distance * np.array([np.cos(ANGLE), np.sin(ANGLE)])
        assert sorted(np.linalg.norm(ends[:, :2] - post, axis=1))[0] == pytest.approx(0.01, abs=1e-4)  # its radius

    def test_a_motion_that_is_changed_has_no_certificate(self):
        traj = timed(swing(1.2), [[0.0], [1.0]])
        assert traj.certificate is None
        assert traj.certify().certified
        traj.Init(traj.GetConfigurationSpecification())
        assert traj.certificate is None

    def test_everything_is_where_it_was(self):
        robot = swing(1.2)
        env = robot.GetEnv()
        robot.SetDOFValues([0.3])
        timed(robot, [[0.0], [1.0]]).certify()
        assert robot.GetDOFValues() == [0.3]
        env.GetKinBody("post").SetTransform(robot.GetLink("link").GetTransform())
        assert env.CheckCollision(robot)

    @pytest.mark.parametrize("radius", [0.05, 0.2])
    def test_what_a_moving_link_holds_counts_and_stays_in_the_hand(self, radius):
        robot = swing(1.5)
        env = robot.GetEnv()
        ball = ravemj.RaveCreateKinBody(env, "")
        ball.InitFromSpheres([[0, 0, 0, radius]])
        ball.SetName("ball")
        env.Add(ball)
        ball.SetTransform([1, 0, 0, 0, 1.3, 0, 0])
        robot.Grab(ball, robot.GetLink("link"))
        robot.SetDOFValues([0.2])
        before = ball.GetTransform()
        certificate = timed(robot, [[0.0], [1.0]]).certify()
        gap = 0.2 - 0.01 - radius
        assert certificate.certified == (gap > 0)
        if gap > 0:
            assert gap - max(1.1e-3, 0.06 * gap) <= certificate.smallest_gap <= gap + 1e-5
        np.testing.assert_array_equal(ball.GetTransform(), before)
        robot.SetDOFValues([ANGLE])
        assert env.CheckCollision(robot) == (gap < 0)

    def test_a_motion_with_an_undecided_part_is_not_certified_as_a_whole(self):
        traj = timed(swing(), [[0.0], [1.0]])
        assert traj.certify() is traj.certificate
        assert not traj.is_certified()
        assert traj.certificate is None
        free = timed(swing(1.2), [[0.0], [1.0]])
        assert free.is_certified()
        assert free.certificate == free.certify()
        jumping = ravemj.RaveCreateTrajectory(free.GetEnv(), "")
        jumping.Init(free.GetConfigurationSpecification())
        assert not jumping.is_certified()
        assert jumping.certificate.reason == "nothing moves"

    @pytest.mark.parametrize("seed", one_in(3, range(6)))
    def test_certified_motions_touch_nothing_and_keep_the_gap(self, seed):
        env = ravemj.Environment()
        env.Load(str(MODELS / "puma560.xml"))
        robot, numbers = env.GetRobots()[0], np.random.default_rng(seed)
        for number in range(4):
            box = ravemj.RaveCreateKinBody(env, "")
            box.InitFromBoxes(
                [[*numbers.uniform(-0.9, 0.9, 2), numbers.uniform(0.2, 1), *numbers.uniform(0.02, 0.1, 3)]]
            )
            box.SetName(f"box{number}")
            env.Add(box)
        robot.SetActiveDOFs(range(robot.GetDOF()))
        lower, upper = robot.GetActiveDOFLimits()
        spec, report = robot.GetActiveConfigurationSpecification(), ravemj.CollisionReport()
        env.GetCollisionChecker().SetCollisionOptions(ravemj.CollisionOptions.Distance)
        free: list[np.ndarray] = []
        with robot:
            while len(free) < 8:
                values = numbers.uniform(lower, upper)
                robot.SetActiveDOFValues(values)
                if not env.CheckCollision(robot) and not robot.CheckSelfCollision():
                    free.append(values)
        for ends in zip(free[::2], free[1::2], strict=True):
            traj = timed(robot, ends)
            certificate = traj.certify()
            least = np.inf
            with robot:
                for row in traj.SamplePoints2D(np.linspace(0, 1, 400), spec):
                    robot.SetActiveDOFValues(row)
                    assert not (certificate.certified and robot.CheckSelfCollision())
                    env.CheckCollision(robot, report)
                    least = min(least, report.minDistance)
            if certificate.certified:
                assert certificate.smallest_gap <= least + 1e-6
            else:
                assert certificate.undecided

    @pytest.mark.parametrize(("gap", "text"), [(0.1684, "170"), (0.017e-3, "0.017"), (2.0, "2000"), (0.0, "0")])
    def test_gaps_are_shown_in_millimetres(self, gap, text):
        certificate = ravemj.Certificate(certified=True, smallest_gap=gap)
        assert str(certificate) == f"certified: smallest gap {text} mm"


class TestTouchingEnds:
    @staticmethod
    def lift() -> ravemj.Robot:
        env = ravemj.Environment()
        assert env.LoadData("""<Environment><Robot name="lift"><KinBody>
          <Body name="base"><Geom type="box"><extents>0.05 0.05 0.05</extents></Geom></Body>
          <Body name="plate"><offsetfrom>base</offsetfrom><Translation>0.5 0 0</Translation>
            <Geom type="box"><extents>0.1 0.1 0.05</extents></Geom></Body>
          <Joint name="up" type="slider"><Body>base</Body><Body>plate</Body><axis>0 0 1</axis>
            <limits>0 1</limits></Joint>
          </KinBody></Robot>
          <KinBody name="table"><Body name="top"><Translation>0.5 0 -0.10001</Translation>
            <Geom type="box"><extents>0.3 0.3 0.05</extents></Geom></Body></KinBody></Environment>""")
        robot = env.GetRobot("lift")
        robot.SetActiveDOFs([0])
        return robot

    def test_what_touches_at_the_start_is_exempt_until_it_is_apart(self):
        certificate = timed(self.lift(), [[0.0], [1.0]]).certify()
        assert certificate.certified
        (exempt,) = certificate.exempt
        assert exempt.pair == ("link 'plate' of 'lift'", "link 'top' of 'table'")
        assert exempt.start == 0
        assert exempt.end == pytest.approx(0.002, abs=0.006)

    def test_after_that_it_counts(self):
        certificate = timed(self.lift(), [[0.0], [0.5], [-0.001], [0.5]]).certify()
        assert not certificate.certified
        (touching,) = certificate.undecided
        assert touching.start < 2 < touching.end
        assert [span.start for span in certificate.exempt] == [0]


class TestReasons:
    def test_a_motion_without_times(self):
        robot = swing(1.2)
        traj = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
        traj.Init(robot.GetActiveConfigurationSpecification("linear"))
        traj.Insert(0, [0.0])
        assert "deltatime" in traj.certify().reason

    def test_a_callback_of_the_user(self):
        robot = swing(1.2)
        traj = timed(robot, [[0.0], [1.0]])
        handle = robot.GetEnv().RegisterCollisionCallback(lambda report, from_physics: 0)
        assert "collision checker, callback" in traj.certify().reason
        handle.Close()
        assert traj.certify().certified

    def test_a_base_that_turns_in_space(self):
        robot = swing(1.2)
        robot.SetActiveDOFs([0], DOFAffine.Rotation3D)
        certificate = timed(robot, [[0, 0, 0, 0], [1, 0, 0, 0]]).certify()
        assert certificate.reason == "the base of 'arm' turns about more than one axis"
        assert str(certificate) == f"not certified: {certificate.reason}"

    def test_a_body_that_moves_while_another_one_that_moves_holds_it(self):
        robot = swing(3.0)
        env = robot.GetEnv()
        held = ravemj.RaveCreateRobot(env, "")
        held.Clone(robot, 0)
        held.SetName("held")
        env.Add(held)
        held.SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, 1]))
        spec, other = (one.GetConfigurationSpecificationIndices([0], "linear") for one in (robot, held))
        spec += other
        spec.AddDeltaTimeGroup()
        traj = ravemj.RaveCreateTrajectory(env, "")
        traj.Init(spec)
        traj.Insert(0, [0.0, 0.0, 0.0, 0.5, 0.5, 1.0])
        assert traj.certify().reason == ""
        robot.Grab(held, robot.GetLink("link"))
        assert traj.certify().reason == "'held' moves by itself while 'arm' holds it"

    def test_a_motion_that_jumps(self):
        robot = swing(1.2)
        spec = robot.GetActiveConfigurationSpecification("next")
        spec.AddDeltaTimeGroup()
        traj = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
        traj.Init(spec)
        traj.Insert(0, [0.0, 0.0])
        traj.Insert(1, [1.0, 1.0])
        assert "jumps at" in traj.certify().reason


class TestPlanning:
    def test_a_plan_says_what_it_cannot_prove(self):
        robot = swing()
        base = ravemj.interfaces.BaseManipulation(robot)
        traj = base.MoveActiveJoints(goal=[1.0], certify=True, execute=False, outputtrajobj=True)
        assert not traj.certificate.certified  # there is no other way
        plain = base.MoveActiveJoints(goal=[1.0], execute=False, outputtrajobj=True)
        assert plain.certificate is None
        np.testing.assert_array_equal(traj.GetWaypoints(0, 3), plain.GetWaypoints(0, 3))

    @pytest.mark.stress
    def test_a_plan_that_has_to_be_proved_fails(self):
        base = ravemj.interfaces.BaseManipulation(swing())
        with pytest.raises(ravemj.PlanningError, match="not certified: link 'link' of 'arm' and link 'post'"):
            base.MoveActiveJoints(goal=[1.0], certify="required", execute=False, outputtrajobj=True)
        assert base.prob.SendCommand("MoveActiveJoints goal 1.0 certify required outputtraj") is None

    @pytest.mark.parametrize("depth", [5e-5, 1e-3])
    def test_a_motion_from_a_start_in_collision_has_a_certificate_as_a_whole(self, depth):
        """The planner begins beside the start, and the motion is extended to it."""
        robot = swing()
        arm = next(link for link in robot.GetLinks() if link.GetName() == "link").ComputeAABB()
        wall = ravemj.RaveCreateKinBody(robot.GetEnv(), "")
        wall.InitFromBoxes([[*(arm.pos() - [0, arm.extents()[1] + 0.1 - depth, 0]), 0.1, 0.1, 0.1]])
        wall.SetName("wall")
        robot.GetEnv().Add(wall)
        assert robot.GetEnv().CheckCollision(robot)
        base = ravemj.interfaces.BaseManipulation(robot)

        def planned(certify):
            return base.MoveActiveJoints(goal=[0.2], certify=certify, execute=False, outputtrajobj=True, jitter=0.1)

        certificate = planned(True).certificate
        assert certificate.certified == (depth < 1e-4)  # what touches is exempt until it is apart
        names = ("link 'link' of 'arm'", "link 'base' of 'wall'")
        spans = certificate.exempt if certificate.certified else certificate.undecided
        assert {span.pair for span in spans} == {names}
        if certificate.certified:
            assert planned("required").certificate.certified
        else:
            with pytest.raises(ravemj.PlanningError, match=r"not certified from the start to the goal: .*'wall'"):
                planned("required")

    def test_a_wrong_word_is_an_error(self):
        params = ravemj.Planner.PlannerParameters()
        with pytest.raises(ravemj.openrave_exception, match="certify: is 'please'"):
            params.set_certify("please")

    @pytest.mark.stress
    @pytest.mark.parametrize("seed", one_in(4, range(4)))
    def test_shortened_paths_among_thin_posts_do_not_graze(self, seed):
        env = ravemj.Environment()
        env.Load(str(MODELS / "puma560.xml"))
        robot, numbers = env.GetRobots()[0], np.random.default_rng(seed)
        for number in range(10):
            post, angle = ravemj.RaveCreateKinBody(env, ""), numbers.uniform(-np.pi, np.pi)
            far = numbers.uniform(0.4, 0.8)
            post.InitFromBoxes([[far * np.cos(angle), far * np.sin(angle), 0.6, 0.008, 0.008, 0.5]])
            post.SetName(f"post{number}")
            env.Add(post)
        robot.SetActiveDOFs(range(robot.GetDOF()))
        limits, free = robot.GetActiveDOFLimits(), []
        with robot:
            while len(free) < 4:
                values = numbers.uniform(*limits)
                robot.SetActiveDOFValues(values)
                if not env.CheckCollision(robot) and not robot.CheckSelfCollision():
                    free.append(values)
        base = ravemj.interfaces.BaseManipulation(robot)
        for start, goal in zip(free[::2], free[1::2], strict=True):
            robot.SetActiveDOFValues(start)
            try:
                traj = base.MoveActiveJoints(goal=goal, certify=True, execute=False, outputtrajobj=True)
            except ravemj.PlanningError:
                continue
            assert traj.certificate.certified, str(traj.certificate)
            times = np.arange(0, traj.GetDuration(), 5e-4)
            rows = traj.SamplePoints2D(times, robot.GetActiveConfigurationSpecification())
            assert not robot.batch_collides(rows).any()
            planned, afterwards = traj.certificate, traj.certify()
            assert afterwards.certified
            assert planned.smallest_gap == pytest.approx(afterwards.smallest_gap, abs=1e-3)
            assert planned.exempt == afterwards.exempt


def test_lines_are_proved_by_a_certifier():
    bodies = moving(swing())
    with bodies.kept():
        certifier = Certifier(bodies, [np.zeros(1), np.ones(1)])
        assert certifier.proves([line_curve(np.zeros(1), np.array([0.5]))])
        assert not certifier.proves([line_curve(np.zeros(1), np.array([0.51]))])
