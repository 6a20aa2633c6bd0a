"""MuJoCo as physics engine, against physics worked out by hand."""

import logging
import math

import mujoco
import numpy as np
import pytest

import ravemj

G = 9.797930195020351
PENDULUM = """<Robot name="{name}"><KinBody>
  <Body name="{name}-stand" type="{kind}"><Geom type="box"><extents>.05 .05 .05</extents></Geom></Body>
  <Body name="{name}-bob" type="dynamic">
    <Geom type="box"><Translation>0 0 -1</Translation><extents>.05 .05 .05</extents></Geom>
    <Mass type="custom"><total>2</total><com>0 0 -1</com><inertia>.01 0 0 0 .02 0 0 0 .03</inertia></Mass>
  </Body>
  <Joint name="{name}-pivot" type="hinge" circular="true">
    <Body>{name}-stand</Body><Body>{name}-bob</Body><axis>0 1 0</axis><maxvel>100</maxvel><maxtorque>30</maxtorque>
  </Joint>
</KinBody></Robot>"""
BOX = """<KinBody name="{name}"><Body name="{name}" type="{kind}"><Geom type="box"><extents>{half}</extents></Geom>
  <Mass type="mimicgeom"><density>1000</density></Mass></Body></KinBody>"""
FLOOR_HALF, HALF = 0.5, 0.1


def add(env, text):
    assert env.LoadData(f"<Environment>{text}</Environment>")


def box(env, name, position, kind="dynamic", half=HALF):
    add(env, BOX.format(name=name, kind=kind, half=f"{half} {half} {half}"))
    body = env.GetKinBody(name)
    place(body, position)
    return body


def pendulum(env, name="pendulum", kind="static"):
    add(env, PENDULUM.format(name=name, kind=kind))
    return env.GetRobot(name)


def place(body, position):
    T = np.eye(4)
    T[:3, 3] = position
    body.SetTransform(T)


def position(body):
    return body.GetTransform()[:3, 3]


def run(env, seconds, timestep=0.01):
    for _ in range(round(seconds / timestep)):
        env.StepSimulation(timestep)


@pytest.fixture
def env():
    env = ravemj.Environment()
    env.StopSimulation()
    env.SetPhysicsEngine("mujoco")
    yield env
    env.Destroy()


def test_a_free_fall(env):
    body = box(env, "box", [1, 2, 30])
    body.SetVelocity([0.5, 0, 3], [0, 0, 2])
    run(env, 1.0, 0.1)
    np.testing.assert_allclose(position(body), [1.5, 2, 33 - G / 2], atol=1e-9)
    np.testing.assert_allclose(body.GetTransform()[:3, 0], [math.cos(2), math.sin(2), 0], atol=1e-9)
    np.testing.assert_allclose(body.GetLinkVelocities(), [[0.5, 0, 3 - G, 0, 0, 2]], atol=1e-9)
    env.GetPhysicsEngine().SetGravity([0, 0, 0])
    run(env, 0.5, 0.5)
    np.testing.assert_allclose(position(body), [1.75, 2, 34.5 - G], atol=1e-9)


def test_a_pendulum_keeps_its_period_and_energy(env):
    robot = pendulum(env)
    amplitude, inertia, mass = 0.8, 2 * 1**2 + 0.02, 2.0
    robot.SetDOFValues([amplitude])
    a, b = 1.0, math.cos(amplitude / 2)
    while abs(a - b) > 1e-15:
        a, b = (a + b) / 2, math.sqrt(a * b)
    period = 2 * math.pi * math.sqrt(inertia / (mass * G)) / a
    env.StepSimulation(10 * period)
    assert robot.GetDOFValues()[0] == pytest.approx(amplitude, abs=1e-6)
    env.StepSimulation(period / 4)
    assert robot.GetDOFValues()[0] == pytest.approx(0, abs=1e-5)
    speed = robot.GetDOFVelocities()[0]
    assert inertia * speed**2 / 2 == pytest.approx(mass * G * (1 - math.cos(amplitude)), rel=1e-6)


def test_a_box_on_the_floor_stays(env):
    floor = box(env, "floor", [0, 0, -FLOOR_HALF], "static", FLOOR_HALF)
    body = box(env, "box", [0.1, 0.2, HALF])
    run(env, 2.0)
    np.testing.assert_allclose(position(body), [0.1, 0.2, HALF], atol=2e-4)
    np.testing.assert_array_equal(position(floor), [0, 0, -FLOOR_HALF])
    np.testing.assert_allclose(body.GetLinkVelocities(), 0, atol=1e-6)
    weight = body.GetLinks()[0].GetMass() * G
    force, torque = env.GetPhysicsEngine().GetLinkForceTorque(body.GetLinks()[0])
    np.testing.assert_allclose(force, [0, 0, weight], atol=1e-6 * weight)
    np.testing.assert_allclose(torque, 0, atol=1e-6 * weight)


def test_a_box_on_a_slope_stays(env):
    floor = box(env, "floor", [0, 0, 0], "static", FLOOR_HALF)
    body = box(env, "box", [0, 0, FLOOR_HALF + HALF])
    tilt = ravemj.matrixFromAxisAngle([0, 0.3, 0])
    floor.SetTransform(tilt)
    start = tilt @ body.GetTransform()
    body.SetTransform(start)
    run(env, 1.0)
    np.testing.assert_allclose(body.GetTransform(), start, atol=5e-3)


def test_torques_accelerate_as_inverse_dynamics_says(env):
    robot = pendulum(env)
    robot.SetDOFValues([0.5])
    robot.SetDOFVelocities([0.3])
    wanted, timestep = 1.5, 1e-4
    robot.SetDOFTorques(robot.ComputeInverseDynamics([wanted]), False)
    env.StepSimulation(timestep)
    assert (robot.GetDOFVelocities()[0] - 0.3) / timestep == pytest.approx(wanted, rel=1e-3)
    before = robot.GetDOFVelocities()[0]
    env.StepSimulation(timestep)  # torques act for one step only
    fall = -2 * G * math.sin(robot.GetDOFValues()[0]) / 2.02
    assert (robot.GetDOFVelocities()[0] - before) / timestep == pytest.approx(fall, rel=1e-3)


def test_torques_add_up_or_replace_each_other(env):
    env.GetPhysicsEngine().SetGravity([0, 0, 0])
    robot = pendulum(env)
    joint = robot.GetJoints()[0]
    robot.SetDOFTorques([5.0], False)
    robot.SetJointTorques([1.0], False)
    robot.SetDOFTorques([2.0], True)
    joint.AddTorque([3.0])
    env.StepSimulation(0.01)
    assert robot.GetDOFVelocities()[0] == pytest.approx(6.0 * 0.01 / 2.02)
    for wrong in ([1.0, 2.0], [], [[1.0]]):
        with pytest.raises(ravemj.openrave_exception) as caught:
            robot.SetDOFTorques(wrong, False)
        assert caught.value.GetCode() == "Assert"


def test_forces_push_and_turn(env):
    env.GetPhysicsEngine().SetGravity([0, 0, 0])
    body = box(env, "box", [1, 0, 0])
    link = body.GetLinks()[0]
    mass, timestep = link.GetMass(), 0.01
    inertia = mass * (2 * HALF) ** 2 / 6
    link.SetForce([99, 0, 0], [1, 0, 0], False)
    link.SetForce([1, 0, 0], [1, 0.1, 0], False)
    link.SetForce([0, 2, 0], [1, 0, 0], True)
    link.SetTorque([0, 0, 0.25], False)
    link.SetTorque([0, 0, 0.25], True)
    env.StepSimulation(timestep)
    moved = np.array([1, 2, 0, 0, 0, 0.5 - 0.1]) * timestep / np.array([mass, mass, mass, inertia, inertia, inertia])
    np.testing.assert_allclose(body.GetLinkVelocities()[0], moved, rtol=1e-6, atol=1e-12)
    env.StepSimulation(timestep)
    np.testing.assert_allclose(body.GetLinkVelocities()[0], moved, rtol=1e-6, atol=1e-9)


def test_what_nothing_holds_falls_as_a_whole(env):
    robot = pendulum(env, kind="dynamic")
    place(robot, [0, 0, 10])
    robot.SetDOFValues([0.4])
    start = robot.GetTransform(), robot.GetCenterOfMass()
    run(env, 0.5)
    np.testing.assert_allclose(robot.GetCenterOfMass() - start[1], [0, 0, -G / 2 * 0.5**2], atol=1e-6)
    np.testing.assert_allclose(position(robot) - start[0][:3, 3], [0, 0, -G / 2 * 0.5**2], atol=1e-6)
    assert robot.GetDOFValues()[0] == pytest.approx(0.4, abs=1e-6)


def test_momentum_is_kept_when_a_joint_works(env):
    env.GetPhysicsEngine().SetGravity([0, 0, 0])
    robot = pendulum(env, kind="dynamic")
    start = robot.GetCenterOfMass()
    for _ in range(10):
        robot.SetDOFTorques([3.0], False)
        env.StepSimulation(0.01)
    assert robot.GetDOFValues()[0] > 0.05
    np.testing.assert_allclose(robot.GetCenterOfMass(), start, atol=1e-6)
    assert np.abs(robot.GetLinkVelocities()).max() > 0.1


def test_bodies_come_and_go_while_the_others_move_on(env):
    one, other = box(env, "one", [0, 0, 10]), pendulum(env)
    other.SetDOFValues([1.0])
    run(env, 0.2)
    late = box(env, "late", [5, 0, 10])
    run(env, 0.2)
    env.Remove(late)
    run(env, 0.1)
    assert position(one)[2] == pytest.approx(10 - G / 2 * 0.5**2, abs=1e-9)
    assert position(late)[2] == pytest.approx(10 - G / 2 * 0.2**2, abs=1e-9)
    alone = ravemj.Environment()
    alone.StopSimulation()
    alone.SetPhysicsEngine("mujoco")
    twin = pendulum(alone)
    twin.SetDOFValues([1.0])
    run(alone, 0.5)
    np.testing.assert_allclose(other.GetDOFValues(), twin.GetDOFValues(), atol=1e-9)
    alone.Destroy()


def test_what_users_set_goes_before_physics(env):
    body, robot = box(env, "box", [0, 0, 10]), pendulum(env)
    run(env, 0.3)
    place(body, [3, 0, 5])
    body.SetVelocity([0, 0, 0], [0, 0, 0])
    robot.SetDOFValues([math.pi / 2])
    robot.SetDOFVelocities([0])
    place(robot, [1, 1, 1])
    env.StepSimulation(0.01)
    np.testing.assert_allclose(position(body), [3, 0, 5 - G / 2 * 0.01**2], atol=1e-12)
    assert robot.GetDOFVelocities()[0] == pytest.approx(-2 * G / 2.02 * 0.01, rel=1e-4)
    np.testing.assert_array_equal(position(robot), [1, 1, 1])


def test_held_bodies_follow_and_weigh(env):
    robot = pendulum(env)
    robot.SetDOFValues([0.3])
    load = box(env, "load", robot.GetLinks()[1].GetTransform() @ [0, 0, -2, 1] @ np.eye(4)[:, :3])
    assert robot.Grab(load, robot.GetLinks()[1])
    relative = np.linalg.inv(robot.GetLinks()[1].GetTransform()) @ load.GetTransform()
    free = pendulum(env, "free")
    place(free, [0, 5, 0])
    free.SetDOFValues([0.3])
    run(env, 0.4)
    np.testing.assert_allclose(
        np.linalg.inv(robot.GetLinks()[1].GetTransform()) @ load.GetTransform(), relative, atol=1e-12
    )
    mass, inertia = load.GetLinks()[0].GetMass(), load.GetLinks()[0].GetLocalInertia()[1, 1]
    angle, speed = 0.3, 0.0
    for _ in range(4000):
        speed -= 1e-4 * G * (2 * 1 + mass * 2) * math.sin(angle) / (2.02 + inertia + mass * 4)
        angle += 1e-4 * speed
    assert robot.GetDOFValues()[0] == pytest.approx(angle, abs=2e-3)
    assert abs(robot.GetDOFValues()[0] - free.GetDOFValues()[0]) > 0.05
    robot.Release(load)
    height = position(load)[2]
    run(env, 0.3)
    assert position(load)[2] < height - 0.3


def test_what_pushes_a_body_that_is_gone_is_forgotten(env):
    body = box(env, "box", [0, 0, 10])
    env.StepSimulation(0.01)
    env.Remove(body)
    body.GetLinks()[0].SetForce([1, 0, 0], [0, 0, 0], False)
    env.StepSimulation(0.01)
    env.Add(body)
    env.StepSimulation(0.01)
    assert position(body)[0] == 0


def test_disabled_links_fall_through(env):
    box(env, "floor", [0, 0, -FLOOR_HALF], "static", FLOOR_HALF)
    body = box(env, "box", [0, 0, HALF])
    run(env, 0.1)
    body.Enable(False)
    run(env, 0.2)
    assert position(body)[2] < HALF - 0.15
    place(body, [0, 0, HALF])
    body.SetVelocity([0, 0, 0], [0, 0, 0])
    body.Enable(True)
    run(env, 0.2)
    assert position(body)[2] == pytest.approx(HALF, abs=2e-4)


def test_joint_forces_hold_what_hangs(env):
    robot = pendulum(env)
    robot.SetDOFValues([0])
    run(env, 0.05)
    force, torque = env.GetPhysicsEngine().GetJointForceTorque(robot.GetJoints()[0])
    np.testing.assert_allclose(force, [0, 0, 2 * G], atol=1e-6)
    np.testing.assert_allclose(torque, 0, atol=1e-6)


@pytest.mark.parametrize("by_command", [False, True])
def test_velocity_controllers_drive_joints_within_their_torque(env, by_command):
    robot = pendulum(env)
    controller = ravemj.RaveCreateController(env, "odevelocity")
    assert robot.SetController(controller, [0], 0)
    env.StopSimulation()
    if by_command:
        assert controller.SendCommand("setvelocity 0.5") == ""
    else:
        controller.SetDesired([0.5])
    run(env, 0.5)
    assert robot.GetDOFVelocities()[0] == pytest.approx(0.5, abs=1e-4)
    assert robot.GetDOFValues()[0] == pytest.approx(0.25, abs=2e-2)  # the motor takes a moment
    robot.SetDOFTorqueLimits([1.0])
    robot.SetDOFValues([1.0])
    run(env, 0.2)
    assert robot.GetDOFVelocities()[0] < 0  # too weak against gravity
    controller.Reset()


def test_without_physics_nothing_falls():
    env = ravemj.Environment()
    env.StopSimulation()
    body = box(env, "box", [0, 0, 10])
    body.GetLinks()[0].SetForce([1, 2, 3], [0, 0, 0], False)
    run(env, 0.1)
    np.testing.assert_array_equal(position(body), [0, 0, 10])
    engine = env.GetPhysicsEngine()
    assert engine.GetXMLId() == "GenericPhysicsEngine"
    assert engine.GetGravity()[2] == -G
    env.Destroy()


def test_gravity_belongs_to_the_engine(env):
    env.GetPhysicsEngine().SetGravity([0, 0, -2])
    engine = ravemj.RaveCreatePhysicsEngine(env, "ODE")
    assert engine.GetXMLId() == "ODE"
    np.testing.assert_array_equal(engine.GetGravity(), 0)
    old = env.GetPhysicsEngine()
    assert env.SetPhysicsEngine(engine)
    assert env.GetPhysicsEngine() is engine
    engine.SetGravity([1, 0, 0])
    np.testing.assert_array_equal(old.GetGravity(), [0, 0, -2])
    assert env.SetPhysicsEngine(old)
    np.testing.assert_array_equal(env.GetPhysicsEngine().GetGravity(), [0, 0, -2])
    assert env.SetPhysicsEngine(None)
    np.testing.assert_array_equal(env.GetPhysicsEngine().GetGravity(), 0)
    assert ravemj.RaveCreatePhysicsEngine(env, "nonsense") is None
    with pytest.raises(ravemj.openrave_exception, match="nonsense"):
        env.SetPhysicsEngine("nonsense")


def three_spheres(env, distance):
    """A robot of three spheres in a row, the outer ones on sliders of the first."""
    links = "".join(
        f'<Body name="l{i}" type="dynamic"><Translation>{i * distance} 0 0</Translation>'
        f'<Geom type="sphere"><radius>.2</radius></Geom></Body>'
        for i in range(3)
    )
    joints = "".join(
        f'<Joint name="j{i}" type="slider"><Body>l0</Body><Body>l{i}</Body><axis>1 0 0</axis>'
        f"<limits>-3 3</limits></Joint>"
        for i in (1, 2)
    )
    add(env, f'<Robot name="r"><KinBody>{links}{joints}</KinBody></Robot>')
    return env.GetRobot("r")


def run_into(env, robot):
    """Let the second sphere move towards the third, for half a metre; return both joint values."""
    env.GetPhysicsEngine().SetGravity([0, 0, 0])
    robot.SetDOFValues([0, 0])
    robot.SetVelocity([0, 0, 0], [0, 0, 0])
    robot.SetDOFVelocities([1, 0])
    run(env, 0.5)
    return robot.GetDOFValues()


def test_self_collisions_can_be_switched_off(env):
    engine, robot = env.GetPhysicsEngine(), three_spheres(env, 0.6)
    assert engine.GetPhysicsOptions() == ravemj.PhysicsEngineOptions.SelfCollisions
    assert run_into(env, robot)[1] > 0.1
    assert engine.SetPhysicsOptions(0)
    assert engine.GetPhysicsOptions() == 0
    np.testing.assert_allclose(run_into(env, robot), [0.5, 0], atol=1e-6)


def test_links_that_openrave_never_tests_do_not_collide(env):
    touching = three_spheres(env, 0.3)
    np.testing.assert_allclose(run_into(env, touching), [0.5, 0], atol=1e-6)
    env.Remove(touching)
    declared = three_spheres(env, 0.6)
    assert run_into(env, declared)[1] > 0.1
    declared.SetAdjacentLinks(1, 2)
    np.testing.assert_allclose(run_into(env, declared), [0.5, 0], atol=1e-6)


def test_unstable_physics_stays_where_it_was(env, caplog):
    body = box(env, "box", [0, 0, 1])
    body.GetLinks()[0].SetForce([1e200, 0, 0], [0, 1e50, 0], False)
    with caplog.at_level(logging.ERROR, "ravemj"):
        env.StepSimulation(0.01)
    assert "unstable" in caplog.text
    np.testing.assert_array_equal(position(body), [0, 0, 1])
    env.StepSimulation(0.01)
    assert position(body)[2] == pytest.approx(1 - G / 2 * 0.01**2)


PASSIVE = """<Robot name="r"><KinBody><Body name="a" type="static"/>
<Body name="b"><Translation>0 0 0.3</Translation><Geom type="box"><Translation>0.2 0 0</Translation>
<extents>0.2 0.02 0.02</extents></Geom><Mass type="mimicgeom"><density>1000</density></Mass></Body>
<Joint name="p" type="hinge" enable="false"><Body>a</Body><Body>b</Body><offsetfrom>b</offsetfrom>
<axis>0 1 0</axis><limitsdeg>-90 90</limitsdeg></Joint>{others}</KinBody></Robot>"""
ACTIVE = """<Body name="c"><offsetfrom>b</offsetfrom><Translation>0.4 0 0</Translation></Body>
<Joint name="j" type="hinge"><Body>b</Body><Body>c</Body><offsetfrom>c</offsetfrom><axis>0 1 0</axis></Joint>
<Body name="d" type="static"><Geom type="sphere"><radius>0.01</radius></Geom></Body>
<Joint name="m" type="hinge" enable="false" mimic_pos="2*p+0.1"><Body>a</Body><Body>d</Body><axis>0 1 0</axis>
</Joint>"""


def fallen(seconds):
    """Return the angle of a rod of 0.4 m that falls from level about its end, by Runge-Kutta steps."""
    inertia, arm, step = (0.4**2 + 0.04**2) / 12 + 0.2**2, 0.2, 1e-4
    state = np.zeros(2)

    def rate(state):
        return np.array([state[1], 9.81 * arm * np.cos(state[0]) / inertia])

    for _ in range(round(seconds / step)):
        a = rate(state)
        b = rate(state + step / 2 * a)
        c = rate(state + step / 2 * b)
        state = state + step / 6 * (a + 2 * b + 2 * c + rate(state + step * c))
    return state[0]


class TestPassiveJoints:
    """Joints without a DOF that follow nothing move freely in physics, as in OpenRAVE."""

    @pytest.fixture
    def dropped(self, request):
        env = ravemj.Environment()
        env.StopSimulation()
        assert env.LoadData(PASSIVE.format(others=request.param))
        engine = ravemj.RaveCreatePhysicsEngine(env, "ode")
        env.SetPhysicsEngine(engine)
        engine.SetGravity([0, 0, -9.81])
        for _ in range(20):
            env.StepSimulation(0.01)
        return env.GetRobots()[0]

    @pytest.mark.parametrize("dropped", [""], indirect=True)
    def test_it_falls_like_a_rod(self, dropped):
        (joint,) = dropped.GetPassiveJoints()
        assert joint.GetValues() == pytest.approx([fallen(0.2)], abs=1e-6)
        direction = dropped.GetLink("b").GetTransform()[:3, 0]
        np.testing.assert_allclose(direction, [np.cos(fallen(0.2)), 0, -np.sin(fallen(0.2))], atol=1e-6)
        assert mujoco.MjModel.from_xml_string(dropped.GetEnv().mjcf).njnt == 1

    @pytest.mark.parametrize("dropped", [ACTIVE], indirect=True)
    def test_joint_values_leave_it_where_it_is_and_others_follow_it(self, dropped):
        value = dropped.GetJoint("p").GetValue(0)
        assert value > 0.02
        before = dropped.GetLink("b").GetTransform()
        dropped.SetDOFValues([0.5])
        np.testing.assert_allclose(dropped.GetLink("b").GetTransform(), before, atol=1e-12)
        assert dropped.GetJoint("p").GetValue(0) == value
        assert dropped.GetJoint("m").GetValue(0) == pytest.approx(2 * value + 0.1, abs=1e-9)
        poses = dropped.batch_link_transforms([[0.5]])[0]
        np.testing.assert_allclose(poses, dropped.GetLinkTransformations(), atol=1e-9)
        link = dropped.GetLink("c")
        assert dropped.CalculateJacobian(link.GetIndex(), link.GetTransform()[:3, 3]).shape == (3, 1)
