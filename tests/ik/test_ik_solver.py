"""The solver in front: limits and turns, free joints, tasks, singular configurations, searches, bad input, scenes."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from conftest import MODELS
from hypothesis import given
from hypothesis import strategies as st
from ik_arms import PANDA, PANDA_LIMITED, PUMA, UR5, WAM, arm
from strategies import examples

from ravemj import ik
from ravemj.formats.readers import read_file
from ravemj.ik import Chain, NumericSolver, Task, make_solver
from ravemj.ik.arms import chain_of
from ravemj.ik.candidates import nearest_first
from ravemj.ik.derive import random_values
from ravemj.ik.limits import all_turns, distances, nearest_turns
from ravemj.ik.numeric import CompiledKinematics
from ravemj.ik.redundancy import samples
from ravemj.ik.tasks import goal_poses

DEGREES = np.pi / 180
LIMITED = replace(
    PUMA,
    lower=np.array([-160, -225, -45, -110, -100, -266.0]) * DEGREES,
    upper=np.array([160, 45, 225, 170, 100, 266.0]) * DEGREES,
)


def inside(chain, rows):
    return bool(((rows >= chain.lower) & (rows <= chain.upper)).all())


def worst(chain, rows, T):
    return np.abs(chain.forward(rows) - T).max(initial=0.0)


def limited_values(chain, count, seed=0):
    return np.random.default_rng(seed).uniform(chain.lower, chain.upper, (count, chain.dof))


class TestLimits:
    def test_solutions_are_within_limits_and_contain_the_configuration(self):
        solver = make_solver(LIMITED)
        for values in limited_values(LIMITED, 30):
            T = LIMITED.forward(values)
            rows = solver.solve_one(T)
            assert inside(LIMITED, rows)
            assert worst(LIMITED, rows, T) < 1e-9
            assert np.abs(rows - values).max(axis=1).min() < 1e-6

    def test_a_wide_joint_gives_every_turn(self):
        wide = replace(PUMA, lower=PUMA.lower * 1.0, upper=PUMA.upper * 1.0)
        wide.lower[5], wide.upper[5] = -3 * np.pi, 3 * np.pi
        values = np.array([0.3, -0.8, 0.9, 0.4, -0.5, 0.6])
        rows = make_solver(wide).solve_one(wide.forward(values))
        assert len(rows) == 24
        assert inside(wide, rows)
        assert worst(wide, rows, wide.forward(values)) < 1e-9
        assert len(np.unique(rows.round(6), axis=0)) == 24

    def test_both_ends_of_a_whole_turn(self):
        chain = Chain.of([[0, 0, 1]], [[0, 0, 0]])
        np.testing.assert_allclose(np.sort(all_turns(chain, np.array([[np.pi]]))[:, 0]), [-np.pi, np.pi])
        np.testing.assert_allclose(all_turns(chain, np.array([[0.5]])), [[0.5]])

    def test_without_an_end_every_configuration_comes_once(self):
        chain = Chain.of([[0, 0, 1]], [[0, 0, 0]], lower=[-np.inf], upper=[np.inf])
        np.testing.assert_allclose(all_turns(chain, np.array([[0.5], [-3.0]])), [[0.5], [-3.0]])

    def test_limits_far_from_zero(self):
        chain = Chain.of([[0, 0, 1]], [[0, 0, 0]], lower=[7.0], upper=[9.0])
        np.testing.assert_allclose(all_turns(chain, np.array([[1.0]])), [[1 + 2 * np.pi]])
        assert len(all_turns(chain, np.array([[3.0]]))) == 0

    @pytest.mark.parametrize(("beyond", "number"), [(0.0, 1), (5e-11, 1), (1e-9, 0), (1e-3, 0)])
    def test_tolerance(self, beyond, number):
        chain = Chain.of([[0, 0, 1]], [[0, 0, 0]], lower=[-1.0], upper=[1.0])
        rows = all_turns(chain, np.array([[1 + beyond]]))
        assert len(rows) == number
        assert inside(chain, rows)

    def test_circular_joints_have_no_limits(self):
        chain = Chain.of(
            [[0, 0, 1]] * 2, [[0, 0, 0], [1, 0, 0]], lower=[0, 0], upper=[0.1, 0.1], circular=[True, False]
        )
        rows, good = nearest_turns(chain, np.array([[3.0, 0.05], [0.0, 3.0]]), np.array([9.0, 0.0]))
        assert good.tolist() == [True, False]
        np.testing.assert_allclose(rows[0], [3.0, 0.05])

    def test_distances_of_circular_joints_go_the_short_way(self):
        chain = Chain.of([[0, 0, 1]] * 2, [[0, 0, 0], [1, 0, 0]], circular=[True, False])
        found = distances(chain, np.array([[3.1, 3.1]]), np.array([-3.1, -3.1]), np.array([1.0, 2.0]))
        np.testing.assert_allclose(found, np.hypot(2 * np.pi - 6.2, 12.4))

    @examples(50)
    @given(st.floats(-3.14, 3.14), st.floats(-9, 9), st.floats(0, 12), st.floats(-9, 9))
    def test_turns_are_within_limits_and_nearest(self, value, lower, span, near):
        chain = Chain.of([[0, 0, 1]], [[0, 0, 0]], lower=[lower], upper=[lower + span])
        every = all_turns(chain, np.array([[value]]))
        expected = value + 2 * np.pi * np.arange(-5, 6)
        expected = expected[(expected >= lower - 1e-10) & (expected <= lower + span + 1e-10)]
        np.testing.assert_allclose(np.sort(every[:, 0]), expected, atol=1e-9)
        best, good = nearest_turns(chain, np.array([value]), np.array([near]))
        assert bool(good) == (len(expected) > 0)
        if good:
            assert abs(best[0] - near) <= np.abs(expected - near).min() + 1e-9


class TestNearest:
    @pytest.mark.parametrize("chain", [LIMITED, PANDA_LIMITED])
    def test_a_configuration_is_nearest_to_itself(self, chain):
        solver = make_solver(chain)
        for values in limited_values(chain, 20):
            found = solver.nearest(chain.forward(values), values)
            np.testing.assert_allclose(found, values, atol=1e-6)

    def test_it_is_the_nearest(self):
        solver = make_solver(LIMITED)
        weights = np.array([4, 3, 2, 1.5, 1, 0.5])
        for values, seed in zip(limited_values(LIMITED, 20), limited_values(LIMITED, 20, 1), strict=True):
            T = LIMITED.forward(values)
            found = solver.nearest(T, seed, weights=weights)
            every = distances(LIMITED, solver.solve_one(T), seed, weights)
            assert distances(LIMITED, found, seed, weights) == pytest.approx(every.min(), abs=1e-9)

    def test_all_come_the_nearest_first(self):
        solver, seed = make_solver(LIMITED), np.zeros(6)
        T = LIMITED.forward(limited_values(LIMITED, 1)[0])
        order = distances(LIMITED, solver.solve_one(T), seed)
        found = [distances(LIMITED, row, seed) for row in nearest_first(solver, T, seed)]
        assert found == pytest.approx(np.sort(order))

    def test_a_panda_finds_a_solution_for_nearly_every_pose(self):
        solver = make_solver(PANDA_LIMITED)
        found = 0
        for T in PANDA_LIMITED.forward(limited_values(PANDA_LIMITED, 200, 7)):
            row = solver.nearest(T, np.zeros(7))
            found += row is not None
            if row is not None:
                assert inside(PANDA_LIMITED, row)
                assert worst(PANDA_LIMITED, row, T) < 1e-8
        assert found >= 199


class TestSingular:
    def test_a_stretched_wrist_is_shown_at_every_eighth_of_a_half_turn(self):
        values = np.array([0.3, 0.4, 0.5, 0.6, 0.0, 0.8])
        T = PUMA.forward(values)
        rows = make_solver(PUMA).solve_one(T)
        assert worst(PUMA, rows, T) < 1e-9
        same = rows[(np.abs(rows[:, :3] - values[:3]).max(axis=1) < 1e-6) & (np.abs(rows[:, 4]) < 1e-6)]
        for step in range(-7, 9):
            assert np.abs(same[:, 3] - step * np.pi / 8).min() < 1e-9

    def test_the_nearest_one_starts_at_the_present_value(self):
        values = np.array([0.3, 0.4, 0.5, 0.63, 0.0, 0.81])
        found = make_solver(PUMA).nearest(PUMA.forward(values), values)
        np.testing.assert_allclose(found, values, atol=1e-9)

    @pytest.mark.parametrize("bend", [0.0, np.pi, 1e-9])
    def test_four_parallel_axes(self, bend):
        solver = make_solver(UR5)
        for values in random_values(UR5, 20, np.random.default_rng(3)) * 0.8:
            values[4] = bend
            T = UR5.forward(values)
            found = solver.nearest(T, values)
            assert worst(UR5, found, T) < 1e-8
            if bend == 0:
                np.testing.assert_allclose(found, values, atol=1e-6)


class TestFreeJoints:
    def test_samples_go_outwards_from_a_start(self):
        rows = samples(PANDA_LIMITED, (6,), (0.5,), np.array([0.2]))[:, 0]
        np.testing.assert_allclose(rows[:5], [0.2, 0.7, -0.3, 1.2, -0.8])
        assert rows.min() >= PANDA_LIMITED.lower[6]
        assert rows.max() <= PANDA_LIMITED.upper[6]

    def test_samples_of_two_joints(self):
        rows = samples(PANDA_LIMITED, (2, 6), (2.0, 1.0))
        assert len(rows) == 3 * 5
        np.testing.assert_allclose(rows[:3], [[0, 0], [0, 1], [0, -1]])

    def test_given_values(self):
        solver = make_solver(PANDA, free=[6])
        values = random_values(PANDA, 5, np.random.default_rng(0))
        for row in values:
            found = solver.solve_one(PANDA.forward(row), free=row[6:])
            assert (found[:, 6] == row[6]).all()
            assert np.abs(found - row).max(axis=1).min() < 1e-6

    @pytest.mark.parametrize("free", [[0], [2], [4], [6]])
    def test_any_choice(self, free):
        solver = make_solver(WAM, free=free)
        assert solver.free == tuple(free)
        values = np.array([0.3, -0.5, 0.7, 1.2, 0.4, 1.1, -0.2])
        found = solver.solve_one(WAM.forward(values), free=values[free])
        assert np.abs(found - values).max(axis=1).min() < 1e-6

    def test_a_batch_tries_every_sample_for_every_pose(self):
        solver = make_solver(PANDA_LIMITED, steps=[1.0])
        values = limited_values(PANDA_LIMITED, 4)
        T = PANDA_LIMITED.forward(values)
        batch = solver.solve(T)
        for index, pose in enumerate(T):
            one = solver.solve(pose[None])
            np.testing.assert_array_equal(batch.valid[index], one.valid[0])
            np.testing.assert_allclose(batch.of(index), one.of(0), atol=1e-9)
            assert worst(PANDA_LIMITED, batch.of(index), pose) < 1e-9

    def test_two_free_joints(self):
        chain = arm(np.random.default_rng(1), "RRRRR")
        solver = make_solver(chain, Task.PLACE, steps=[1.0, 1.0])
        assert len(solver.free) == 2
        T = chain.forward(np.full(5, 0.3))
        rows = solver.solve_one(T[:3, 3])
        assert len(rows)
        assert np.abs(chain.forward(rows)[:, :3, 3] - T[:3, 3]).max() < 1e-8


class TestTasks:
    def test_two_joints_in_a_plane(self):
        chain = Chain.of([[0, 0, 1]] * 2, [[0, 0, 0], [0.5, 0, 0]], T_base_tool=_at(0.9, 0, 0.1))
        solver = make_solver(chain, Task.PLACE_XY)
        for values in ([0.5, 0.8], [-2.5, -2.0], [0.0, 0.3]):
            T = chain.forward(np.array(values))
            rows = solver.solve_one(T[:2, 3])
            assert len(rows) == 2
            assert np.abs(rows - values).max(axis=1).min() < 1e-9

    def test_three_joints_in_a_plane_with_an_angle(self):
        chain = Chain.of(
            [[0, 0, 1]] * 3, [[0, 0, 0], [0.4, 0, 0.1], [0.7, 0, 0]], T_base_tool=_at(0.8, 0, 0.3), direction=(1, 0, 0)
        )
        solver = make_solver(chain, Task.PLANAR)
        T = chain.forward(np.array([0.5, 0.8, 0.3]))
        expected = [[0.5, 0.8, 0.3], [1.17934851, -0.8, 1.22065149]]
        for turn in (0, 2 * np.pi):
            rows = solver.solve_one([T[0, 3], T[1, 3], 1.6 + turn])
            np.testing.assert_allclose(rows[np.argsort(rows[:, 0])], expected, atol=1e-8)
        assert solver.nearest([0.9, 0, 0], np.zeros(3)) is None

    @pytest.mark.parametrize("kind", ["RRR", "PRR", "RPR", "RRP", "PPR", "PRP", "RPP", "PPP", "XR", "=R", "R="])
    def test_places(self, kind):
        chain = arm(np.random.default_rng(2), kind)
        solver = make_solver(chain, Task.PLACE)
        assert solver.complete
        assert "position" in solver.describe()
        for values in random_values(chain, 20, np.random.default_rng(3)):
            place = chain.forward(values)[:3, 3]
            rows = solver.solve_one(place, limits=False)
            assert np.abs(chain.forward(rows)[:, :3, 3] - place).max() < 1e-8
            assert np.abs(np.sin((rows - values) / 2)).max(axis=1).min() < 1e-5


def _at(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


class TestNumeric:
    @pytest.mark.parametrize("chain", [LIMITED, PANDA_LIMITED])
    def test_it_finds_nearly_every_pose(self, chain):
        solver = NumericSolver(chain)
        found = 0
        for T in chain.forward(limited_values(chain, 100, 7)):
            row = solver.solve(T)
            if row is not None:
                found += 1
                assert inside(chain, row)
                assert worst(chain, row, T) < 1e-8
        assert found == 100

    def test_it_starts_at_the_seed(self):
        solver = NumericSolver(LIMITED)
        for values in limited_values(LIMITED, 10):
            np.testing.assert_allclose(solver.solve(LIMITED.forward(values), values), values, atol=1e-9)

    def test_out_of_reach_it_comes_as_near_as_it_can(self):
        chain = Chain.of([[0, 0, 1]] * 2, [[0, 0, 0], [0.5, 0, 0]], T_base_tool=_at(1, 0, 0))
        solver = make_solver(chain, Task.PLACE_XY)
        found = solver.numeric.nearest(goal_poses(chain, Task.PLACE_XY, [0.0, 3.0]), np.array([0.3, 0.4]))
        np.testing.assert_allclose(chain.forward(found.values)[:2, 3], [0, 1], atol=1e-3)
        assert found.error * chain.reach == pytest.approx(2, abs=1e-3)

    def test_weights_say_what_counts(self):
        T = UR5.forward(np.array([0.3, -1, 1, 0.5, 0.6, 0.7]))
        far = T.copy()
        far[:3, 3] *= 3
        solver = NumericSolver(UR5)
        start = np.array([0.3, -1, 1, 0.5, 0.6, 0.7])
        turned = solver.nearest(far, start, np.array([1, 1, 1, 100, 100, 100.0]))
        assert np.abs(UR5.forward(turned.values)[:3, :3] - far[:3, :3]).max() < 0.02

    @pytest.mark.parametrize("chain", [LIMITED, PANDA_LIMITED])
    def test_it_comes_nearer_to_goals_out_of_reach_wherever_they_are(self, chain):
        """Among them configurations in which the arm is stretched, where seven joints have one motion less."""
        solver, rng = NumericSolver(chain), np.random.default_rng(3)
        for _ in range(150):
            values = rng.uniform(chain.lower, chain.upper)
            far, weights = chain.forward(values), rng.uniform(0.2, 3, 6)
            far[:3, 3] *= rng.choice([1, 1.3, 2])
            seed = np.clip(values + rng.uniform(-0.5, 0.5, chain.dof), chain.lower, chain.upper)
            found = solver.nearest(far, seed, weights)
            assert inside(chain, found.values)
            again = solver.nearest(far, found.values, weights)
            assert found.error < 1e-9 or again.error > 0.98 * found.error

    @pytest.mark.parametrize("seed", [48, 127, 214])
    def test_nothing_missing_and_a_joint_too_many(self, seed):
        """Where damping vanishes with the error, the equations of seven joints would be singular."""
        rng = np.random.default_rng(seed)
        values = rng.uniform(PANDA_LIMITED.lower, PANDA_LIMITED.upper)
        start = np.clip(values + rng.uniform(-0.5, 0.5, 7), PANDA_LIMITED.lower, PANDA_LIMITED.upper)
        assert NumericSolver(PANDA_LIMITED).nearest(PANDA_LIMITED.forward(values), start).error < 1e-9

    @pytest.mark.parametrize("kind", ["RPRRRR", "PRRRR", "RRPRPRR"])
    def test_arms_without_a_closed_form(self, kind):
        chain = arm(np.random.default_rng(0), kind)
        solver = make_solver(chain)
        assert not solver.complete
        assert "numeric" in solver.describe()
        assert "not complete" in solver.describe()
        T = chain.forward(random_values(chain, 2, np.random.default_rng(1)))
        for index, pose in enumerate(T):
            assert worst(chain, solver.nearest(pose, np.zeros(chain.dof)), pose) < 1e-8
            rows = solver.solve(T).of(index)
            assert len(rows)
            assert worst(chain, rows, pose) < 1e-8

    def test_c_code_and_numpy_agree(self):
        chain = arm(np.random.default_rng(5), "RPRXRR")
        compiled = pickle.loads(pickle.dumps(CompiledKinematics(chain)))
        for values in random_values(chain, 5, np.random.default_rng(1)):
            rotation, place, jacobian = compiled(values)
            T, (_, numpys) = chain.forward(values), chain.forward_and_jacobian(values[None])
            np.testing.assert_allclose(rotation, T[:3, :3], atol=1e-14)
            np.testing.assert_allclose(place, T[:3, 3], atol=1e-14)
            np.testing.assert_allclose(jacobian, numpys[0], atol=1e-14)

    @pytest.mark.parametrize("kind", ["RRRXRR", "RPRXRR"])
    def test_few_and_many_configurations_are_computed_alike(self, kind):
        chain = arm(np.random.default_rng(5), kind)
        values = random_values(chain, 200, np.random.default_rng(1))
        tools, jacobians = chain.forward_and_jacobian(values)
        for index in range(0, 200, 20):
            tool, jacobian = chain.forward_and_jacobian(values[index : index + 2])
            np.testing.assert_allclose(tool, tools[:, :, index : index + 2], atol=1e-14)
            np.testing.assert_allclose(jacobian, jacobians[index : index + 2], atol=1e-14)

    def test_jacobians_are_derivatives(self):
        chain = arm(np.random.default_rng(6), "RPRXRR")
        values, step = np.full(7, 0.3), 1e-6
        jacobian = chain.forward_and_jacobian(values[None])[1][0]
        ahead, behind = (chain.forward(values + sign * step * np.eye(7)) for sign in (1, -1))
        np.testing.assert_allclose(((ahead - behind)[:, :3, 3] / (2 * step)).T, jacobian[:3], atol=1e-8)
        spin = (ahead - behind)[:, :3, :3] / (2 * step) @ chain.forward(values)[:3, :3].T
        np.testing.assert_allclose(np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]]), jacobian[3:], atol=1e-8)


class TestBadInput:
    @pytest.mark.parametrize(
        ("T", "what"),
        [
            (np.eye(3), "expected"),
            (np.full((4, 4), np.nan), "finite"),
            (np.diag([2.0, 2, 2, 1]), "rigid"),
            (np.diag([1.0, 1, -1, 1]), "rigid"),
            (np.eye(4) + np.eye(4, k=-3), "rigid"),
        ],
    )
    def test_poses(self, T, what):
        solver = make_solver(PUMA)
        for ask in (solver.solve_one, lambda pose: solver.nearest(pose, np.zeros(6))):
            with pytest.raises(ValueError, match=what):
                ask(T)

    def test_goals_of_another_task(self):
        chain = arm(np.random.default_rng(2), "RRR")
        solver = make_solver(chain, Task.PLACE)
        with pytest.raises(ValueError, match="Translation3D"):
            solver.solve_one(np.eye(4))
        with pytest.raises(ValueError, match="finite"):
            solver.solve_one([0, 0, np.inf])

    @pytest.mark.parametrize(
        ("more", "what"),
        [
            ({"axes": [[0, 0, 0]]}, "not a direction"),
            ({"points": [[0, 0]]}, "reshape"),
            ({"points": [[0, 0, 0], [0, 0, 0]]}, "points of shape"),
            ({"lower": [1.0], "upper": [0.0]}, "limit"),
            ({"lower": [np.nan]}, "limit"),
            ({"lower": [0.0, 1.0]}, "lower of shape"),
            ({"axes": [[0, np.nan, 0]]}, "finite"),
            ({"T_base_tool": np.zeros((4, 4))}, "rigid"),
        ],
    )
    def test_chains(self, more, what):
        with pytest.raises(ValueError, match=what):
            Chain.of(**{"axes": [[0, 0, 1]], "points": [[0, 0, 0]], **more})

    def test_free_joints(self):
        with pytest.raises(ValueError, match="joints 0 to 6"):
            make_solver(PANDA, free=[7])
        with pytest.raises(ValueError, match="steps"):
            make_solver(PANDA, free=[6], steps=[0.0])
        with pytest.raises(ValueError, match="steps"):
            make_solver(PANDA, free=[6], steps=[0.1, 0.1])

    def test_limits_that_exclude_everything(self):
        chain = replace(PUMA, lower=np.full(6, 0.1), upper=np.full(6, 0.1 + 1e-9))
        solver = make_solver(chain)
        T = chain.forward(np.zeros(6))
        assert solver.solve_one(T).shape == (0, 6)
        assert solver.nearest(T, np.zeros(6)) is None
        assert len(solver.solve_one(T, limits=False)) > 0


class TestScenes:
    @pytest.mark.parametrize(("file", "dof"), [("panda.xml", 7), ("puma560.xml", 6), ("scara.dae", 4)])
    def test_models(self, file, dof):
        import ravemj

        body = next(body for body in read_file(MODELS / file).scene.bodies if body.manipulators)
        manipulator = body.manipulators[0]
        chain = chain_of(body, manipulator)
        assert chain.dof == dof == len(manipulator.arm_dofs)
        solver = make_solver(chain)
        assert solver.complete
        robot = ravemj.load(MODELS / file).GetRobots()[0]
        placed = robot.GetManipulator(manipulator.name)
        for values in limited_values(chain, 5):
            robot.SetDOFValues(values, manipulator.arm_dofs)
            T = np.linalg.inv(placed.GetBase().GetTransform()) @ placed.GetTransform()
            np.testing.assert_allclose(chain.forward(values), T, atol=1e-12)
            np.testing.assert_allclose(solver.nearest(T, values), values, atol=1e-6)

    def test_what_is_no_arm(self):
        body = next(body for body in read_file(MODELS / "panda.xml").scene.bodies if body.manipulators)
        with pytest.raises(ValueError, match="no base"):
            chain_of(body, replace(body.manipulators[0], base=None))
        with pytest.raises(ValueError, match="no joint"):
            chain_of(body, replace(body.manipulators[0], effector=body.manipulators[0].base))


def test_old_names_warn():
    with pytest.warns(DeprecationWarning, match=r"now called ravemj\.ik\.ArmSolutions"):
        assert ik.IKSolver is ik.ArmSolutions
    with pytest.warns(DeprecationWarning, match=r"now called ravemj\.ik\.Validation"):
        assert ik.Certificate is ik.Validation
    with pytest.raises(AttributeError, match="no attribute 'IkSolver'"):
        _ = ik.IkSolver
