"""Whole-body inverse kinematics beside other ways to the same numbers: mink, a flyer of six joints, turned worlds."""

import importlib.util
import re
from itertools import pairwise

import numpy as np
import pytest
from conftest import MODELS
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples
from test_whole_body import FEET, biped

import ravemj
from ravemj import WholeBodyIK
from ravemj.ik.whole_body.bounds import MotionLimits

NEEDS_MINK = pytest.mark.skipif(
    importlib.util.find_spec("mink") is None, reason="there is no mink: pip install mink (the group `bench`)"
)
ROBOTS = {  # their end effectors, and the configuration
    "biped": (("LFoot", "RFoot", "LHand", "RHand"), None),
    "panda": (("hand",), [0.3, -0.4, 0.2, -1.8, 0.3, 1.7, 0.5, 0.02]),
    "puma560": (("link6",), [0.3, -0.5, 0.4, 0.2, 0.7, 0.3]),
    "scara": (("tool",), [0.3, 0.5, 0.05, 0.2]),
}
CURVED = """<Robot name="curved"><KinBody>
<Body name="a"><Geom type="box"><extents>0.05 0.05 0.05</extents></Geom></Body>
<Body name="b"><offsetfrom>a</offsetfrom><Translation>0.2 0 0</Translation>
  <Geom type="box"><extents>0.05 0.05 0.05</extents></Geom><Mass type="mimicgeom"><total>2</total></Mass></Body>
<Body name="c"><offsetfrom>b</offsetfrom><Translation>0.2 0 0</Translation>
  <Geom type="box"><extents>0.05 0.05 0.05</extents></Geom><Mass type="mimicgeom"><total>1</total></Mass></Body>
<Body name="d"><offsetfrom>c</offsetfrom><Translation>0.2 0 0</Translation>
  <Geom type="box"><extents>0.05 0.05 0.05</extents></Geom><Mass type="mimicgeom"><total>3</total></Mass></Body>
<Joint name="leader" type="hinge"><Body>a</Body><Body>b</Body><offsetfrom>b</offsetfrom><axis>0 0 1</axis>
  <limits>-2 2</limits></Joint>
<Joint name="curve" type="hinge" enable="false" mimic_pos="0.5*leader^2+0.3*sin(leader)"><Body>b</Body><Body>c</Body>
  <offsetfrom>c</offsetfrom><axis>0 1 0</axis><limits>-3 3</limits></Joint>
<Joint name="slide" type="slider" enable="false" mimic_pos="0.2*leader+0.1"><Body>c</Body><Body>d</Body>
  <offsetfrom>d</offsetfrom><axis>1 0 0</axis><limits>-3 3</limits></Joint>
</KinBody><Manipulator name="tool"><base>a</base><effector>d</effector></Manipulator></Robot>"""


def shipped(name):
    return ravemj.load(ravemj.model_path(name)).GetRobots()[0]


def small_motion(rng, size=1e-5):
    """A pose that is nearly the identity."""
    T = ravemj.matrixFromAxisAngle(rng.normal(size=3) * size)
    T[:3, 3] = rng.normal(size=3) * size
    return T


class TestMink:
    """A step with the same weights and hardly any damping, beside mink's on the same model."""

    WEIGHTS = 1.0, 0.1, 1e-4  # of frames, the centre of mass, the posture

    def configuration(self, robot, *, free):
        """Return mink's configuration of a robot, and the places of the robot's joints in it."""
        import mink

        spec = robot.GetEnv().spec
        if free:
            spec.body(robot.GetLinks()[0].GetName()).add_freejoint()
        model = spec.compile()
        places = np.array([model.joint(joint.GetName()).qposadr[0] for joint in robot.GetJoints()])
        qpos = mink.Configuration(model).data.qpos.copy()
        qpos[places] = robot.GetDOFValues()
        return mink.Configuration(model, qpos), places

    def tasks(self, configuration, links):
        import mink

        roots = [weight**0.5 for weight in self.WEIGHTS]
        frames = [mink.FrameTask(link, "body", roots[0], roots[0]) for link in links]
        tasks = [*frames, mink.ComTask(roots[1]), mink.PostureTask(configuration.model, roots[2])]
        for task in tasks:
            task.set_target_from_configuration(configuration)
        return tasks

    @NEEDS_MINK
    @pytest.mark.parametrize("name", ROBOTS)
    @pytest.mark.parametrize("seed", range(3))
    def test_a_step_is_mink_s(self, name, seed):
        """Errors of 1e-5, since mink measures larger ones of poses otherwise: by a logarithm of motions."""
        import mink

        rng = np.random.default_rng(seed)
        robot, (links, values) = shipped(name), ROBOTS[name]
        if values is not None:
            robot.SetDOFValues(values)
        free = name == "biped"
        configuration, places = self.configuration(robot, free=free)
        tasks = self.tasks(configuration, links)
        ik = WholeBodyIK(robot, base=free)
        for link, task in zip(links, tasks, strict=False):
            goal = robot.GetLink(link).GetTransform() @ small_motion(rng)
            task.set_target(mink.SE3.from_matrix(goal))
            ik.add_reach(robot.GetLink(link), goal, weight=self.WEIGHTS[0])
        com = robot.GetCenterOfMass() + rng.normal(size=3) * 1e-5
        if name == "panda":  # its fingers are one joint here, and two in mink
            tasks.pop(-2)
        else:
            tasks[-2].set_target(com)
            ik.add_com(com, weight=self.WEIGHTS[1])
        posture = robot.GetDOFValues() + rng.normal(size=robot.GetDOF()) * 1e-5
        target = configuration.q.copy()
        target[places] = posture
        tasks[-1].set_target(target)
        ik.add_posture(posture, weight=self.WEIGHTS[2])

        before, T_before = robot.GetDOFValues(), robot.GetTransform()
        velocity = mink.solve_ik(configuration, tasks, 1.0, "daqp", damping=1e-13, limits=[])
        configuration.integrate_inplace(velocity, 1.0)
        ik.step(1.0)
        step = robot.GetDOFValues() - before
        assert np.abs(step).max() > 1e-6
        np.testing.assert_allclose(step, configuration.q[places] - before, rtol=0, atol=1e-4 * np.abs(step).max())
        if free:
            moved = robot.GetTransform() - T_before
            theirs = configuration.get_transform_frame_to_world(robot.GetLinks()[0].GetName(), "body").as_matrix()
            np.testing.assert_allclose(moved, theirs - T_before, rtol=0, atol=1e-4 * np.abs(moved).max())

    @NEEDS_MINK
    @pytest.mark.parametrize("name", ROBOTS)
    def test_both_reach_the_same_poses(self, name):
        import mink

        robot, (links, values) = shipped(name), ROBOTS[name]
        if values is not None:
            robot.SetDOFValues(values)
        free = name == "biped"
        configuration, _ = self.configuration(robot, free=free)
        tasks = self.tasks(configuration, links)[:-2]
        goals = [robot.GetLink(link).GetTransform() for link in links]
        present = robot.GetDOFValues()
        lower, upper = robot.GetDOFLimits()
        robot.SetDOFValues(np.clip(present + np.where(np.arange(len(present)) % 2, 0.2, -0.1), lower, upper))
        goals = [robot.GetLink(link).GetTransform() for link in links]
        robot.SetDOFValues(present)
        ik = WholeBodyIK(robot, base=free)
        for link, task, goal in zip(links, tasks, goals, strict=True):
            ik.add_reach(robot.GetLink(link), goal)
            task.set_target(mink.SE3.from_matrix(goal))
        limits = [mink.ConfigurationLimit(configuration.model)]
        for _ in range(200):
            velocity = mink.solve_ik(configuration, tasks, 0.1, "daqp", damping=1e-9, limits=limits)
            configuration.integrate_inplace(velocity, 0.1)
        assert ik.solve()
        for link, goal in zip(links, goals, strict=True):
            theirs = configuration.get_transform_frame_to_world(link, "body").as_matrix()
            np.testing.assert_allclose(theirs, goal, atol=1e-4)
            np.testing.assert_allclose(robot.GetLink(link).GetTransform(), theirs, atol=1e-4)


class TestRows:
    @pytest.mark.parametrize("value", [-1.2, 0.3, 0.9])
    def test_curved_followers_are_exact(self, value):
        """By the chain rule: against differences of the fourth order, whose own error is below 1e-10."""
        env = ravemj.Environment()
        robot = env.ReadRobotData(CURVED)
        env.Add(robot)
        robot.SetDOFValues([value])
        ik = WholeBodyIK(robot, base=True)
        ik.add_reach("tool", robot.GetManipulators()[0].GetTransform())
        ik.add_com()

        def error(task, at):
            robot.SetDOFValues([value + at])
            return task.task.rows().error

        for task in ik.tasks:
            column = task.task.rows().jacobian[:, 0]
            near, far = (error(task, -h) - error(task, h) for h in (1e-3, 2e-3))
            np.testing.assert_allclose(column, (8 * near - far) / 12e-3, atol=1e-9)
            error(task, 0.0)

    def test_twice_the_same_task_is_once_with_twice_the_weight(self):
        found = []
        for weights in ((0.2,), (0.1, 0.1)):
            robot = shipped("puma560")
            robot.SetDOFValues(ROBOTS["puma560"][1])
            ik = WholeBodyIK(robot)
            for weight in weights:
                ik.add_reach("arm", [0.4, 0.3, 0.5], weight=weight)
            ik.add_posture(weight=1e-3)
            ik.step(0.01)
            found.append(robot.GetDOFValues())
        np.testing.assert_allclose(found[0], found[1], atol=1e-10)

    @examples(20)
    @given(st.integers(0, 2**32 - 1))
    def test_a_lower_priority_changes_no_row_of_a_higher_one(self, seed):
        """J x of the first level, for rows that the second one contradicts, also with velocity limits active."""
        pytest.importorskip("daqp")
        rng = np.random.default_rng(seed)
        offset, products = rng.uniform(-0.3, 0.3, 3), []
        for second in (False, True):
            robot = biped()
            ik = WholeBodyIK(robot, base=True)
            ik.exact_contacts = False
            first = [ik.add_contact(name) for name in FEET]
            first.append(ik.add_reach("left_hand", [0.2, 0.25, 0.6]))
            if second:
                ik.add_reach("left_hand", np.array([0.2, 0.25, 0.6]) + offset, priority=2)
                ik.add_com(np.array([0.2, 0.1, 0.5]) + offset, priority=3)
                ik.add_posture(priority=4)
            rows = np.vstack([task.task.rows().jacobian for task in first])
            before, T_before = robot.GetDOFValues(), robot.GetTransform()
            ik.step(0.004)
            T_after = robot.GetTransform()
            turn = ravemj.axisAngleFromRotationMatrix(T_after[:3, :3] @ T_before[:3, :3].T)
            x = np.concatenate([robot.GetDOFValues() - before, (T_after - T_before)[:3, 3], turn])
            products.append(rows @ x)
        np.testing.assert_allclose(products[0], products[1], rtol=0, atol=1e-9)


class TestBase:
    @examples(20)
    @given(st.integers(0, 2**32 - 1))
    def test_turned_and_shifted_worlds_move_alike(self, seed):
        """Also with velocity limits active, as in the first steps here."""
        rng = np.random.default_rng(seed)
        quaternion = rng.normal(size=4)
        motion = ravemj.matrixFromPose([*(quaternion / np.linalg.norm(quaternion)), *rng.uniform(-2, 2, 3)])
        found = []
        for turn in (np.eye(4), motion):
            robot = biped()
            robot.SetTransform(turn @ robot.GetTransform())
            ik = WholeBodyIK(robot, base=True)
            for name in FEET:
                ik.add_contact(name)
            ik.add_com()
            ik.add_reach("left_hand", (turn @ [0.3, 0.2, 0.6, 1])[:3])
            ik.add_look_at("eyes", (turn @ [2, 1, 0.3, 1])[:3])
            ik.add_posture(weight=1e-3)
            for _ in range(5):
                ik.step(0.01)
            found.append((robot.GetDOFValues(), np.linalg.inv(turn) @ robot.GetTransform()))
        np.testing.assert_allclose(found[0][0], found[1][0], rtol=0, atol=1e-10)
        np.testing.assert_allclose(found[0][1], found[1][1], rtol=0, atol=1e-10)

    def test_a_flyer_of_six_joints_is_a_free_base(self):
        """pymanoid's way: six massless links, three sliders and three hinges, carry the robot."""
        text = (MODELS / "biped.robot.xml").read_text(encoding="utf-8")
        links = "".join(
            f'<Body name="fly{number}"><Translation>0 0 0.635794157</Translation></Body>' for number in range(6)
        )
        joints, chain = "", [*(f"fly{number}" for number in range(6)), "Pelvis"]
        for number, (parent, child) in enumerate(pairwise(chain)):
            kind = "slider" if number < 3 else "hinge"
            axis = " ".join("1" if number % 3 == place else "0" for place in range(3))
            joints += (
                f'<Joint name="fly{number}" type="{kind}"><Body>{parent}</Body><Body>{child}</Body>'
                f"<offsetfrom>{child}</offsetfrom><axis>{axis}</axis><limits>-3 3</limits><maxvel>100</maxvel></Joint>"
            )
        text = text.replace("<KinBody>\n", f"<KinBody>\n{links}", 1).replace(
            "    <jointvalues>", f"{joints}<jointvalues>"
        )
        text = re.sub("<jointvalues>([^<]*)", lambda values: f"<jointvalues>{values[1]} 0 0 0 0 0 0", text)
        found = []
        for flies in (False, True):
            env = ravemj.Environment()
            robot = env.ReadRobotData(text) if flies else env.ReadRobotURI(str(MODELS / "biped.robot.xml"))
            env.Add(robot)
            names = [joint.GetName() for joint in robot.GetJoints() if not joint.GetName().startswith("fly")]
            ik = WholeBodyIK(robot, base=not flies)
            for name in FEET:
                ik.add_contact(name)
            ik.add_reach("left_hand", [0.35, 0.2, 0.5])
            for name in names:
                ik.add_joint_coupling({name: 1.0}, robot.GetJoint(name).GetValue(0), weight=1e-4)
            ik.solve()
            found.append([robot.GetJoint(name).GetValue(0) for name in names])
        assert np.abs(np.subtract(found[0], biped().GetDOFValues())).max() > 0.1
        np.testing.assert_allclose(found[0], found[1], atol=1e-6)


def test_outside_of_a_limit_and_moving_outward():
    """Starts 0.1 rad beyond its limit with full speed outward: brakes, and comes back at full speed."""
    fastest, change, dt = 2.0, 40.0, 0.01
    limits = MotionLimits(*(np.array([number]) for number in (-3.0, 3.0, fastest, change)))
    value, speed, outside = np.array([3.1]), np.array([fastest]), 0
    while value > 3.0:
        lower, upper = limits.displacements(value, speed, dt)
        assert lower <= upper
        move, before = upper, speed  # a task that pulls outward with all its might
        value, speed, outside = value + move, move / dt, outside + 1
        assert abs(speed) <= fastest + 1e-12
        assert abs(speed - before) <= change * dt + 1e-12
        assert outside < 100
    braking = fastest / (change * dt)  # steps to stand, and as many to be as fast inwards
    assert outside <= np.ceil(0.1 / (fastest * dt)) + 3 * braking
