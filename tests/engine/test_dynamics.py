"""Velocities, derivatives and dynamics: against difference quotients, against MuJoCo, and by hand."""

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given
from strategies import Taste, choices, examples, number, scenes
from test_properties import SMOOTH, Kinematics, draw_smooth, draw_values, is_determined, load, spin

import ravemj
from ravemj.engine import batch
from ravemj.engine.affine import left_jacobian
from ravemj.engine.dynamics import rotation_rate

Nothing = ravemj.CheckLimitsAction.Nothing
STEP = 1e-6


def smooth_body(scene, choices):
    """Load a body, put it into a configuration where everything moves smoothly, and return both with velocities."""
    (body,), (model,) = load(scene), scene.bodies
    values = draw_smooth(body, Kinematics(model), choices)
    assume(len(values))
    body.SetDOFValues(values)
    return body, values, np.array([number(choices, -1, 1) for _ in values])


def quotient(body, values, function, step=STEP):
    """Return the derivatives of a function of the body by the DOF values, one after the other."""
    found = []
    for d in np.eye(len(values)) * step:
        body.SetDOFValues(values + d)
        after = function()
        body.SetDOFValues(values - d)
        found.append((after - function()) / (2 * step))
    body.SetDOFValues(values)
    return np.array(found)


def along(body, values, rates, function, step=STEP):
    """Return the time derivative of a function of the body on its way."""
    body.SetDOFValues(values + step * rates)
    after = function()
    body.SetDOFValues(values - step * rates)
    before = function()
    body.SetDOFValues(values)
    return (after - before) / (2 * step)


def close(actual, expected, tolerance=1e-7):
    scale = max(1.0, np.abs(expected).max(initial=0.0))
    np.testing.assert_allclose(actual, expected, rtol=0, atol=tolerance * scale)


class TestHessians:
    @examples(60)
    @given(scenes(SMOOTH), choices())
    def test_they_are_the_derivatives_of_the_jacobians(self, scene, choices):
        body, values, _ = smooth_body(scene, choices)
        local = np.array([0.3, -0.2, 0.1, 1.0])
        for link, found in enumerate(body.GetLinks()):

            def point(found=found):
                return (found.GetTransform() @ local)[:3]

            def moving(link=link, point=point):
                return body.ComputeJacobianTranslation(link, point())

            def turning(link=link):
                return body.ComputeJacobianAxisAngle(link)

            close(body.ComputeHessianTranslation(link, point()), quotient(body, values, moving), 1e-6)
            by_hand = quotient(body, values, turning)
            close(body.ComputeHessianAxisAngle(link), by_hand + by_hand.transpose(2, 1, 0), 1e-6)

    def test_indices_choose_rows_and_columns(self, robot):
        robot.SetDOFValues([0.4, -0.9])
        whole = robot.ComputeHessianTranslation(2, [0.1, 0.2, -0.3])
        part = robot.ComputeHessianTranslation(2, [0.1, 0.2, -0.3], [1, 7])
        np.testing.assert_array_equal(part[0, :, 0], whole[1, :, 1])
        assert part.shape == (2, 3, 2)
        assert not part[1].any()
        assert not part[:, :, 1].any()


class TestJacobians:
    def test_an_empty_list_means_all_and_a_wrong_index_zeros(self, robot):
        robot.SetDOFValues([0.4, -0.9])
        whole = robot.ComputeJacobianTranslation(2, [0.0, 0.1, -0.3])
        np.testing.assert_array_equal(robot.ComputeJacobianTranslation(2, [0.0, 0.1, -0.3], []), whole)
        chosen = robot.ComputeJacobianTranslation(2, [0.0, 0.1, -0.3], [1, 9, 0])
        np.testing.assert_array_equal(chosen, np.column_stack((whole[:, 1], np.zeros(3), whole[:, 0])))

    @pytest.mark.parametrize("call", [(5, [0, 0, 0]), (-1, [0, 0, 0]), (1, [0, 0]), (1, [0, 0, np.inf])])
    def test_nonsense_is_refused(self, robot, call):
        with pytest.raises((ravemj.openrave_exception, ValueError)):
            robot.ComputeJacobianTranslation(*call)

    def test_quaternion(self, robot):
        values = np.array([0.4, -0.9])
        robot.SetDOFValues(values)
        link = robot.GetLinks()[2]
        wxyz = ravemj.quatFromRotationMatrix(link.GetTransform())

        def quaternion():
            return ravemj.quatFromRotationMatrix(link.GetTransform())

        close(robot.CalculateRotationJacobian(2, wxyz), quotient(robot, values, quaternion).T, 1e-8)

    @examples(40)
    @given(scenes(SMOOTH), choices())
    def test_centre_of_mass(self, scene, choices):
        body, values, _ = smooth_body(scene, choices)
        masses = [link.GetMass() for link in body.GetLinks()]
        assume(sum(masses) > 1e-3 and min(masses) >= 0)
        close(body.com_jacobian(), quotient(body, values, body.GetCenterOfMass).T)


class TestVelocities:
    @examples(60)
    @given(scenes(SMOOTH), choices())
    def test_links_move_as_their_velocities_say(self, scene, choices):
        body, values, rates = smooth_body(scene, choices)
        body.SetDOFVelocities(rates, 0)
        np.testing.assert_allclose(body.GetDOFVelocities(), rates, rtol=0, atol=1e-9)
        velocities = body.GetLinkVelocities()
        linear = along(body, values, rates, lambda: body.link_transforms()[:, :3, 3])
        close(velocities[:, :3], linear)
        body.SetDOFValues(values - STEP * rates)
        before = body.link_transforms()
        body.SetDOFValues(values + STEP * rates)
        turned = [spin(*pair) / (2 * STEP) for pair in zip(before, body.link_transforms(), strict=True)]
        close(velocities[:, 3:], turned)

    def test_forms_of_the_call(self, robot):
        robot.SetDOFVelocities([0.5, -0.25], [1, 2, 3], [0.1, 0.2, 0.3])
        np.testing.assert_allclose(robot.GetDOFVelocities(), [0.5, -0.25], atol=1e-12)
        robot.SetDOFVelocities([0.75], 0, [0])  # the base keeps its velocity
        np.testing.assert_allclose(robot.GetDOFVelocities([1, 0]), [0, 0.75], atol=1e-12)
        np.testing.assert_allclose(robot.GetLinks()[0].GetVelocity(), [1, 2, 3, 0.1, 0.2, 0.3])
        robot.SetDOFVelocities([0.5], 0, [1])  # as in OpenRAVE the first DOF alone counts: random-api-117
        np.testing.assert_allclose(robot.GetDOFVelocities(), [0.75, 0], atol=1e-12)
        robot.SetDOFVelocities([9, 9], checklimits=0, indices=[1, 0])
        np.testing.assert_allclose(robot.GetDOFVelocities(), [9, 9], atol=1e-12)
        assert robot.GetDOFVelocities([]).shape == (0,)

    def test_limits(self, robot):
        with pytest.warns(ravemj.RavemjWarning, match="velocity 9"):
            robot.SetDOFVelocities([9, -9])
        np.testing.assert_allclose(robot.GetDOFVelocities(), [3.42, -5.42], atol=1e-12)
        with pytest.raises(ravemj.openrave_exception, match="limit"):
            robot.SetDOFVelocities([9, 0], ravemj.CheckLimitsAction.CheckLimitsThrow)
        robot.SetDOFVelocities([9, -9], ravemj.CheckLimitsAction.CheckLimitsSilent)
        np.testing.assert_allclose(robot.GetDOFVelocities(), [3.42, -5.42], atol=1e-12)

    @pytest.mark.parametrize("call", [([1],), ([1, np.nan],), ([1, 2], [0, 0], [0, 0, 0]), ([1, 2], 0, [0])])
    def test_a_refused_call_changes_nothing(self, robot, call):
        robot.SetDOFVelocities([0.5, -0.25])
        before = robot.GetLinkVelocities()
        with pytest.raises((ravemj.openrave_exception, ValueError)):
            robot.SetDOFVelocities(*call)
        np.testing.assert_array_equal(robot.GetLinkVelocities(), before)

    def test_whole_body_and_one_link(self, robot):
        robot.SetDOFValues([0.3, 0.9])
        assert robot.SetVelocity([1, 2, 3], [0.1, 0.2, 0.3])
        origins = robot.link_transforms()[:, :3, 3]
        expected = np.array([1, 2, 3]) + np.cross([0.1, 0.2, 0.3], origins - origins[0])
        np.testing.assert_allclose(robot.GetLinkVelocities()[:, :3], expected, atol=1e-12)
        np.testing.assert_allclose(robot.GetDOFVelocities(), 0, atol=1e-12)
        robot.GetLinks()[1].SetVelocity([0, 0, 1], [2, 0, 0])
        np.testing.assert_allclose(robot.GetLinkVelocities()[1], [0, 0, 1, 2, 0, 0])
        np.testing.assert_allclose(robot.GetDOFVelocities(), [1.9, -1.9], atol=1e-12)
        velocities = robot.GetLinkVelocities()
        velocities[:] = 7  # a copy
        assert not np.any(robot.GetLinkVelocities() == 7)
        robot.SetLinkVelocities(np.zeros((3, 6)))
        assert not robot.GetDOFVelocities().any()

    def test_they_outlive_the_model_and_belong_to_the_saver_that_asks(self, env, robot):
        robot.SetDOFVelocities([0.5, -0.25])
        env.simulation.forget_model()
        np.testing.assert_allclose(robot.GetDOFVelocities(), [0.5, -0.25], atol=1e-12)
        with robot.CreateKinBodyStateSaver(ravemj.KinBody.SaveParameters.LinkVelocities):
            robot.SetDOFVelocities([0, 0])
        np.testing.assert_allclose(robot.GetDOFVelocities(), [0.5, -0.25], atol=1e-12)
        with robot:
            robot.SetDOFVelocities([0, 0])
        assert not robot.GetDOFVelocities().any()


@pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")
def test_what_is_held_moves_along(env, robot):
    thing = ravemj.RaveCreateKinBody(env, "")
    thing.InitFromBoxes(np.array([[0, 0, 0, 0.01, 0.01, 0.01]]), True)
    thing.SetName("thing")
    thing.SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, 0.1, 0.2, -0.5]))
    env.Add(thing)
    robot.Grab(thing, robot.GetLinks()[2])
    robot.SetDOFVelocities([1, 0])
    arm = np.array([0.1, 0.2, -0.5]) - robot.GetLinks()[2].GetTransform()[:3, 3]
    carrier = robot.GetLinks()[2].GetVelocity()
    np.testing.assert_allclose(carrier[3:], [1, 0, 0], atol=1e-12)
    expected = [*(carrier[:3] + np.cross(carrier[3:], arm)), 1, 0, 0]
    np.testing.assert_allclose(thing.GetLinks()[0].GetVelocity(), expected, atol=1e-12)


@pytest.mark.parametrize("rotation", [0, 8, 16, 32])
def test_active_jacobians(robot, rotation):
    """Against difference quotients, of joints in another order, two directions and each kind of rotation."""
    robot.SetDOFValues([0.4, -0.9])
    robot.SetTransform(ravemj.matrixFromPose([0.5, 0.5, -0.5, 0.5, 1, -2, 3]))
    axis = np.array([0.6, 0.0, 0.8])
    if rotation == 8:
        robot.SetTransform(ravemj.matrixFromAxisAngle(axis * 0.7))
    robot.SetActiveDOFs([1, 0], 5 | rotation, axis)
    values, link = robot.GetActiveDOFValues(), robot.GetLinks()[2]
    local = np.array([0.1, 0.2, 0.3, 1])

    def place(values):
        robot.SetActiveDOFValues(values)
        return link.GetTransform()

    pairs = [(place(values + d), place(values - d)) for d in np.eye(len(values)) * STEP]
    point = (place(values) @ local)[:3]
    moved = np.array([((after - before) @ local)[:3] / (2 * STEP) for after, before in pairs]).T
    turned = np.array([spin(before, after) / (2 * STEP) for after, before in pairs]).T
    close(robot.CalculateActiveJacobian(2, point), moved, 1e-8)
    close(robot.CalculateActiveAngularVelocityJacobian(2), turned, 1e-8)
    rates = np.linspace(-0.5, 0.5, len(values))
    if rotation == 32:
        rates[-4:] -= values[-4:] * (values[-4:] @ rates[-4:])  # a unit quaternion stays one
    robot.SetActiveDOFVelocities(rates)
    np.testing.assert_allclose(robot.GetActiveDOFVelocities(), rates, atol=1e-9)
    velocity = link.GetVelocity()
    np.testing.assert_allclose(velocity[3:], robot.CalculateActiveAngularVelocityJacobian(2) @ rates, atol=1e-9)


def test_stacked_jacobians_are_those_of_the_single_calls(models):
    """Also of a mimic joint, of chosen columns, and of a base that moves, against the active ones."""
    for name in ("scara.dae", "panda.xml", "pr2.robot.xml"):
        if not (models / name).exists():
            continue
        robot = ravemj.load(models / name).GetRobots()[0]
        lower, upper = robot.GetDOFLimits()
        robot.SetDOFValues(np.clip(np.linspace(-0.7, 0.6, robot.GetDOF()), lower, upper))
        robot.SetTransform(ravemj.matrixFromPose([0.5, 0.5, -0.5, 0.5, 1, -2, 3]))
        links = [len(robot.GetLinks()) - 1, 1, 0]
        points = np.array([[0.3, 0.1, -0.4], [1.0, 2.0, 3.0], [0.0, 0.0, 0.0]])
        found = robot.jacobians(links, points, base=True)
        robot.SetActiveDOFs(range(robot.GetDOF()), 7 | 16)
        robot.SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, 1, -2, 3]))  # rates of a rotation vector are a twist
        level = robot.jacobians(links, points, base=True)
        for index, (link, point) in enumerate(zip(links, points, strict=True)):
            close(level[index, :3], robot.CalculateActiveJacobian(link, point), 1e-12)
            close(level[index, 3:], robot.CalculateActiveAngularVelocityJacobian(link), 1e-12)
        robot.SetTransform(ravemj.matrixFromPose([0.5, 0.5, -0.5, 0.5, 1, -2, 3]))
        for index, (link, point) in enumerate(zip(links, points, strict=True)):
            close(found[index, :3, :-6], robot.ComputeJacobianTranslation(link, point), 1e-12)
            close(found[index, 3:, :-6], robot.ComputeJacobianAxisAngle(link), 1e-12)
        close(robot.jacobians(links, points.T.copy().T, [1, 0]), found[:, :, [1, 0]], 1e-15)
        origins = [robot.GetLinks()[link].GetTransform()[:3, 3] for link in links]
        close(robot.jacobians(links), robot.jacobians(links, origins), 1e-15)
        assert robot.jacobians([], base=True).shape == (0, 6, robot.GetDOF() + 6)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([99],), "linkindex"),
        (([1], [[0, 0, 0], [0, 0, 1]]), "points: are 2, and should be 1"),
        (([1], [[0, np.nan, 0]]), "finite"),
        (([1], None, [7]), "indices"),
    ],
)
def test_stacked_jacobians_refuse(robot, arguments, message):
    with pytest.raises((ravemj.openrave_exception, IndexError), match=message):
        robot.jacobians(*arguments)


class TestAccelerations:
    @examples(60)
    @given(scenes(SMOOTH), choices())
    def test_they_are_the_derivatives_of_the_velocities(self, scene, choices):
        body, values, rates = smooth_body(scene, choices)
        growths = np.array([number(choices, -1, 1) for _ in values])

        def velocities(time):
            body.SetDOFValues(values + time * rates + time**2 / 2 * growths)
            body.SetDOFVelocities(rates + time * growths, [0, 0, 0], [0, 0, 0], Nothing)
            return body.GetLinkVelocities()

        expected = (velocities(STEP) - velocities(-STEP)) / (2 * STEP)
        velocities(0)
        close(body.GetLinkAccelerations(growths), expected, 1e-6)

    def test_a_turning_base_pulls_inwards(self, robot):
        robot.SetVelocity([0.5, 0, 0], [0, 0, 2.0])
        origins = robot.link_transforms()[:, :3, 3] - robot.GetTransform()[:3, 3]
        expected = np.array([0, 1.0, 0]) - 4 * origins * [1, 1, 0]
        np.testing.assert_allclose(robot.GetLinkAccelerations(None)[:, :3], expected, atol=1e-12)
        pushed = robot.GetLinkAccelerations(None, {0: [1, 2, 3, 0, 0, 0]})
        np.testing.assert_allclose(pushed[:, :3], expected + np.array([1, 2, 3]), atol=1e-12)

    @examples(40)
    @given(scenes(SMOOTH), choices())
    def test_hessians_are_their_velocity_part(self, scene, choices):
        body, _, rates = smooth_body(scene, choices)
        body.SetDOFVelocities(rates, [0, 0, 0], [0, 0, 0], Nothing)
        accelerations = body.GetLinkAccelerations(None)
        for link, transform in enumerate(body.link_transforms()):
            moving = body.ComputeHessianTranslation(link, transform[:3, 3])
            close(np.einsum("i,ijk,k", rates, moving, rates), accelerations[link, :3], 1e-9)
            turning = body.ComputeHessianAxisAngle(link)
            close(np.einsum("i,ijk,k", rates, turning, rates), 2 * accelerations[link, 3:], 1e-9)


PLAIN = Taste(bodies=1, trees=True, mimics=False, kinds=("hinge", "slider", "hinge2"))
"""Bodies whose DOFs are MuJoCo's."""


class TestInverseDynamics:
    @examples(60)
    @given(scenes(PLAIN), choices())
    def test_mujoco_says_the_same(self, scene, choices):
        body, values, rates = smooth_body(scene, choices)
        assume(is_determined(body))
        growths = np.array([number(choices, -1, 1) for _ in values])
        body.SetDOFVelocities(rates, 0)
        model, data = body.GetEnv().model, mujoco.MjData(body.GetEnv().model)
        places = body.qpos_indices
        data.qpos[places], data.qvel[places], data.qacc[places] = values, rates, growths
        for stage in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_comVel):
            stage(model, data)
        forces = np.zeros(model.nv)
        mujoco.mj_rne(model, data, 1, forces)
        expected = (forces + model.dof_armature * data.qacc)[places]
        close(body.ComputeInverseDynamics(growths), expected, 1e-9)

    @examples(60)
    @given(scenes(SMOOTH), choices())
    def test_power_becomes_energy(self, scene, choices):
        body, values, rates = smooth_body(scene, choices)
        assume(is_determined(body))
        growths = np.array([number(choices, -1, 1) for _ in values])
        gravity = body.GetEnv().GetPhysicsEngine().GetGravity()

        def energy(time):
            body.SetDOFValues(values + time * rates + time**2 / 2 * growths)
            body.SetDOFVelocities(rates + time * growths, [0, 0, 0], [0, 0, 0], Nothing)
            total = 0.0
            for link, velocity in zip(body.GetLinks(), body.GetLinkVelocities(), strict=True):
                rotation = link.GetTransform()[:3, :3]
                com = link.GetGlobalCOM()
                moved = velocity[:3] + np.cross(velocity[3:], com - link.GetTransform()[:3, 3])
                turned = rotation.T @ velocity[3:]
                total += link.GetMass() * (moved @ moved / 2 - gravity @ com)
                total += turned @ link.GetLocalInertia() @ turned / 2
            return total

        power = (energy(1e-4) - energy(-1e-4)) / 2e-4
        size = abs(energy(0)) + 1
        torques = body.ComputeInverseDynamics(growths)
        assert torques @ rates == pytest.approx(power, abs=1e-5 * size)

    @examples(60)
    @given(scenes(SMOOTH), choices())
    def test_components_and_pushes(self, scene, choices):
        body, _, rates = smooth_body(scene, choices)
        assume(is_determined(body))
        growths = np.array([number(choices, -1, 1) for _ in rates])
        base = [number(choices, -1, 1) for _ in range(6)]
        body.SetDOFVelocities(rates, base[:3], base[3:], Nothing)
        link = choices.integer(0, len(body.GetLinks()) - 1)
        push = np.array([number(choices, -5, 5) for _ in range(6)])
        plain = body.ComputeInverseDynamics(growths)
        pushed = body.ComputeInverseDynamics(growths, {link: push})
        com = body.GetLinks()[link].GetGlobalCOM()
        moving, turning = body.ComputeJacobianTranslation(link, com), body.ComputeJacobianAxisAngle(link)
        close(pushed - plain, moving.T @ push[:3] + turning.T @ push[3:], 1e-9 * max(1, np.abs(plain).max()))
        parts = body.ComputeInverseDynamics(growths, {link: push}, True)
        close(np.sum(parts, axis=0), pushed, 1e-9)
        body.SetVelocity([0, 0, 0], [0, 0, 0])
        resting = body.ComputeInverseDynamics(None)
        close(body.ComputeInverseDynamics(growths) - resting, parts[0], 1e-9 * max(1, np.abs(resting).max()))
        body.GetEnv().GetPhysicsEngine().SetGravity([0, 0, 0])
        body.SetDOFVelocities(rates, [0, 0, 0], [0, 0, 0], Nothing)
        close(body.ComputeInverseDynamics(None), parts[1], 1e-9 * max(1, np.abs(resting).max()))

    def test_mass_set_later_counts(self, robot):
        before = robot.ComputeInverseDynamics([1, 0], None, True)[0]
        inertial = robot.simulation_state.scene.links[2].inertial
        heavy = type(inertial)(
            2 * inertial.mass, inertial.com, tuple(tuple(2 * x for x in row) for row in inertial.inertia)
        )
        robot.simulation_state.edit_link(2, inertial=heavy)
        after = robot.ComputeInverseDynamics([1, 0], None, True)[0]
        assert after[1] == pytest.approx(2 * before[1])


class TestBatch:
    @examples(80)
    @given(scenes(Taste(bodies=2)), choices())
    def test_many_are_one_after_the_other(self, scene, choices):
        bodies = load(scene)
        body, kinematics = bodies[-1], Kinematics(scene.bodies[-1])
        body.SetTransform(ravemj.matrixFromPose([0.5, 0.5, -0.5, 0.5, 1, -2, 3]))
        values, rates, growths = (np.array([draw_values(body, kinematics, choices) for _ in range(3)]) for _ in "qvw")
        values = values.reshape(3, body.GetDOF())
        before, stamp = body.link_transforms(), body.GetUpdateStamp()
        transforms = body.batch_link_transforms(values)
        torques = body.batch_inverse_dynamics(values, rates, growths)
        link = len(body.GetLinks()) - 1
        jacobians = body.batch_jacobians(values, link, [0.1, 0.2, 0.3])
        np.testing.assert_array_equal(body.link_transforms(), before)
        assert body.GetUpdateStamp() == stamp
        for index in range(3):
            body.SetDOFValues(values[index])
            np.testing.assert_allclose(transforms[index], body.link_transforms(), rtol=0, atol=1e-11)
            point = (body.link_transforms()[link] @ [0.1, 0.2, 0.3, 1])[:3]
            close(jacobians[index, :3], body.ComputeJacobianTranslation(link, point), 1e-10)
            close(jacobians[index, 3:], body.ComputeJacobianAxisAngle(link), 1e-10)
            body.SetDOFVelocities(rates[index], [0, 0, 0], [0, 0, 0], Nothing)
            if is_determined(body):
                close(torques[index], body.ComputeInverseDynamics(growths[index]), 1e-9)

    def test_bodies_of_many_links_go_another_way(self, robot, monkeypatch):
        robot.SetTransform(ravemj.matrixFromPose([0.5, 0.5, -0.5, 0.5, 1, -2, 3]))
        values, rates, changes = np.random.default_rng(0).uniform(-1, 1, (3, 20, 2))
        by_numpy = robot.batch_inverse_dynamics(values, rates, changes)
        monkeypatch.setattr(batch, "FEW_LINKS", 0)
        by_mujoco = robot.batch_inverse_dynamics(values, rates, changes)
        assert np.abs(by_numpy).max() > 1
        close(by_mujoco, by_numpy, 1e-9)

    def test_velocities_are_read_off_where_the_links_are_now(self, robot):
        """The links keep their velocities when they move; what these show of the joints is another thing then."""
        robot.SetDOFVelocities([0.5, 0])
        torques = robot.ComputeInverseDynamics([0, 0])
        robot.SetDOFValues([1.2, -0.7])
        kept, rates = robot.GetLinkVelocities(), robot.GetDOFVelocities()
        moved = robot.ComputeInverseDynamics([0, 0])
        fresh = robot.GetEnv().CloneSelf(1).GetRobots()[0]
        fresh.SetLinkVelocities(kept)
        close(fresh.GetDOFVelocities(), rates, 1e-12)
        close(fresh.ComputeInverseDynamics([0, 0]), moved, 1e-9)
        assert np.abs(moved - torques).max() > 1e-3

    def test_chunks_join(self, robot):
        values = np.linspace(-1, 1, 2 * 2503).reshape(-1, 2)
        out = np.empty((2503, 3, 4, 4))
        assert robot.batch_link_transforms(values, out) is out
        for index in (0, 999, 1000, 1001, 2502):
            robot.SetDOFValues(values[index])
            np.testing.assert_allclose(out[index], robot.link_transforms(), rtol=0, atol=1e-13)
        assert robot.batch_link_transforms(np.zeros((0, 2))).shape == (0, 3, 4, 4)

    def test_nonsense_is_refused(self, robot):
        with pytest.raises(ravemj.openrave_exception, match="shape"):
            robot.batch_link_transforms([0.1, 0.2])
        with pytest.raises(ravemj.openrave_exception, match="finite"):
            robot.batch_link_transforms([[0.1, np.nan]])
        with pytest.raises(ravemj.openrave_exception, match="out"):
            robot.batch_link_transforms([[0.1, 0.2]], np.empty((1, 3, 4, 4), dtype=np.float32))
        with pytest.raises(ravemj.openrave_exception, match="same number"):
            robot.batch_inverse_dynamics(np.zeros((2, 2)), np.zeros((2, 2)), np.zeros((3, 2)))


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-3, 0.0999, 0.1001, 1.0, 3.0, 6.0])
def test_rate_of_a_rotation_vector(size):
    """Against quaternions, and the derivative against difference quotients."""
    vector = size * np.array([2, -1, 2]) / 3
    rate, changes = rotation_rate(vector)
    np.testing.assert_allclose(left_jacobian(vector.tolist()), rate.T, atol=1e-14)
    now = ravemj.quatFromAxisAngle(vector)
    for column, d in zip(rate.T, np.eye(3) * 1e-6, strict=True):
        after, before = ravemj.quatFromAxisAngle(vector + d), ravemj.quatFromAxisAngle(vector - d)
        turned = 2 * ravemj.quatMult(ravemj.quatInverse(now), (after - before) / 2e-6)
        np.testing.assert_allclose(turned[1:], column, atol=1e-8)
    for change, d in zip(changes, np.eye(3) * 1e-5, strict=True):
        by_hand = (rotation_rate(vector + d)[0] - rotation_rate(vector - d)[0]) / 2e-5
        np.testing.assert_allclose(change, by_hand, atol=1e-9)
