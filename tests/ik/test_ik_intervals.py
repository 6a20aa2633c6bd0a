"""Poses that a redundant arm reaches only between the samples of its free joint."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ik_arms import IIWA, OFFSET_SHOULDER, PANDA_LIMITED, WAM_LIMITED
from strategies import examples

from ravemj.ik import Chain, Task, make_solver
from ravemj.ik.candidates import everything, nearest_first
from ravemj.ik.intervals import excess, intervals, rows_at
from ravemj.ik.limits import beyond_limits, clamped, nearest_turns
from ravemj.ik.redundancy import default_free, free_range

NARROW = [
    (PANDA_LIMITED, [-1.87, -1.69, -0.3, -0.75, 1.75, 1.79, 2.84]),
    (PANDA_LIMITED, [-2.23, -1.57, -2.32, -3.06, 1.55, 1.72, 2.45]),
    (PANDA_LIMITED, [-0.74, -1.6, 1.56, -0.6, -2.27, 1.69, -2.85]),
    (PANDA_LIMITED, [0.18, -1.49, 2.78, -1.05, 2.06, 1.79, 2.87]),
    (WAM_LIMITED, [-1.77, -0.53, 0.07, 1.52, -3.08, -1.42, -2.3]),
    (OFFSET_SHOULDER, [-1.32, 0.57, -0.41, 0.01, 1.56, -0.82, 1.23]),
    (OFFSET_SHOULDER, [0.28, 0.63, -0.4, -0.01, -2.47, 2.14, -2.08]),
    (OFFSET_SHOULDER, [-0.01, 1.29, 2.09, -0.02, -0.44, 1.39, 1.85]),
]
"""Configurations whose poses have no solution at any sample of the free joint from 0 outwards."""
CORNERS = [
    (PANDA_LIMITED, [1.0873, 1.0554, 2.8392, -3.0718, -0.1752, -0.0175, 1.5461]),
    (PANDA_LIMITED, [2.6943, 1.7628, -0.1067, -0.5511, 2.5187, -0.0175, 2.2481]),
    (PANDA_LIMITED, [-1.2976, -0.2012, 0.0551, -3.0718, -2.8973, 2.6636, -0.9557]),
    (WAM_LIMITED, [1.8313, 2.0, -0.4657, 1.0021, -1.4288, 1.6, 2.6712]),
    (OFFSET_SHOULDER, [-1.6056, -1.221, -2.1787, 1.6948, 1.1964, 1.057, 0.3745]),
    (OFFSET_SHOULDER, [-1.2534, -1.221, 0.9219, 0.5786, -3.1363, -2.16, 2.0241]),
    (OFFSET_SHOULDER, [0.5849, 1.518, 0.884, 1.2391, -2.0998, -2.16, -2.5047]),
    (OFFSET_SHOULDER, [1.2001, 0.0792, -0.6785, -2.251, -2.3021, 2.16, 1.1831]),
]
"""Configurations with two joints at limits, whose poses may have a solution at a single value of the free joint."""
ARMS = {"panda": PANDA_LIMITED, "iiwa": IIWA, "wam": WAM_LIMITED, "offset": OFFSET_SHOULDER}


def check(chain, rows, T):
    assert len(rows)
    assert (np.abs(chain.forward(rows) - T) < 1e-8).all()
    assert ((rows >= chain.bounds[0]) & (rows <= chain.bounds[1])).all()


@pytest.fixture(scope="module")
def solvers():
    return {id(chain): make_solver(chain) for chain in ARMS.values()}


@pytest.mark.parametrize(("chain", "values"), NARROW)
def test_a_pose_between_two_samples_is_reached(solvers, chain, values):
    solver, T = solvers[id(chain)], chain.forward(np.array(values))
    samples = solver.free_samples()
    assert excess(chain, solver.at(T, samples)).min() > 0
    check(chain, solver.solve_one(T), T)
    seed = np.zeros(7)
    check(chain, solver.nearest(T, seed)[None], T)
    check(chain, np.array(list(nearest_first(solver, T, seed))), T)


@pytest.mark.parametrize(("chain", "values"), NARROW[::3])
def test_without_limits_too(solvers, chain, values):
    solver, T = solvers[id(chain)], chain.forward(np.array(values))
    rows = solver.solve_one(T, limits=False)
    np.testing.assert_allclose(chain.forward(rows), np.broadcast_to(T, (len(rows), 4, 4)), atol=1e-8)


@pytest.mark.parametrize(("chain", "values"), CORNERS)
def test_a_pose_with_two_joints_at_their_limits_is_reached_by_every_question(solvers, chain, values):
    solver, T = solvers[id(chain)], chain.forward(np.array(values))
    check(chain, solver.solve_one(T), T)
    seed = np.zeros(7)
    check(chain, solver.nearest(T, seed)[None], T)
    check(chain, next(nearest_first(solver, T, seed))[None], T)


def test_descents_are_exact_at_limits(solvers):
    chain, values = CORNERS[1]
    numeric, T = solvers[id(chain)].numeric, chain.forward(np.array(values))
    inward = np.where(np.array(values) > 0, -0.01, 0.01)
    assert numeric.descend(T, np.array(values) + inward).error < 1e-12


@pytest.mark.parametrize("name", ARMS)
@examples(200)
@given(number=st.integers(0, 2**32))
def test_every_pose_of_a_configuration_within_limits_is_reached(solvers, name, number):
    chain, rng = ARMS[name], np.random.default_rng(number)
    solver = solvers[id(chain)]
    low, high = np.where(chain.circular, -np.pi, chain.lower), np.where(chain.circular, np.pi, chain.upper)
    T, seed = chain.forward(rng.uniform(low, high)), rng.uniform(low, high)
    check(chain, solver.nearest(T, seed)[None], T)
    check(chain, next(nearest_first(solver, T, seed))[None], T)
    check(chain, solver.solve_one(T), T)


@examples(40)
@given(number=st.integers(0, 2**32), wide=st.floats(0.005, 0.3))
def test_narrow_limits_are_met(number, wide):
    """Limits about a configuration leave an interval that hardly any sample is in."""
    values = np.random.default_rng(number).uniform(-2, 2, 7)
    lower, upper = values - wide, values + 2 * wide
    lower[2], upper[2] = -3, 3
    chain = replace(IIWA, lower=lower, upper=upper)
    T = chain.forward(values)
    check(chain, make_solver(chain, free=[2]).solve_one(T), T)


@pytest.mark.parametrize("name", ["panda", "iiwa", "wam"])
def test_intervals_end_where_solutions_do(solvers, name):
    chain = ARMS[name]
    solver, rng = solvers[id(chain)], np.random.default_rng(3)
    low, high = free_range(chain, solver.free[0])
    samples = np.linspace(low, high, 400)
    for T in chain.forward(rng.uniform(chain.lower, chain.upper, (2, 7))):
        found = intervals(solver, T, samples)
        assert found
        for branch, first, last in found:
            assert low <= first <= last <= high
            for end, outward in ((first, -1e-4), (last, 1e-4)):
                if low < end < high:
                    missed = excess(chain, solver.at(T, np.array([[end], [end + outward]])))[:, branch]
                    assert missed[0] <= 1e-9 < missed[1]
        rows = rows_at(solver, T, found, np.linspace(0, 1, 11))
        check(chain, nearest_turns(chain, rows)[0], T)
        assert len(rows) > 10 * len(found)
        dense = np.linspace(low, high, 3001)
        inside = [((dense >= one.low) & (dense <= one.high)).sum() for one in found]
        count = (excess(chain, solver.at(T, dense[:, None])) <= 1e-10).sum()
        assert abs(count - sum(inside)) <= 0.01 * count + 2


def test_no_interval_where_nothing_is_reached(solvers):
    solver, T = solvers[id(IIWA)], np.eye(4)
    T[0, 3] = 3.0
    assert intervals(solver, T, np.linspace(-1, 1, 20)) == []
    assert not len(solver.solve_one(T))
    assert solver.nearest(T, np.zeros(7)) is None
    assert list(nearest_first(solver, T, np.zeros(7))) == []
    assert sum(map(len, everything(solver, T))) == 0


def test_who_accepts_no_sample_is_offered_the_points_of_the_intervals(solvers):
    solver = solvers[id(IIWA)]
    T = IIWA.forward(np.array([0.3, 0.5, -0.4, 1.0, 0.2, -0.6, 0.1]))
    found = intervals(solver, T, np.union1d(solver.free_samples(), free_range(IIWA, 2)))
    wide = [one for one in found if one.high - one.low > 0.5]
    rough, fine = (list(everything(solver, T, fine=more)) for more in (False, True))
    np.testing.assert_array_equal(rough[0], solver.solve_one(T))
    rows = np.concatenate(rough[1:])
    check(IIWA, rows, T)
    free, own = rows[:, 2], wide[0]
    assert len(free) <= 12 * len(found)
    for one in wide:
        for value in np.linspace(one.low, one.high, 11):
            assert np.abs(free - value).min() < 1e-5
    inside = free[(free > own.low - 1e-9) & (free < own.high + 1e-9)]
    assert np.diff(np.unique(inside)).max() < 0.11 * (own.high - own.low)
    assert len(np.concatenate(fine)) >= len(np.concatenate(rough))


def test_values_of_the_free_joint_that_are_given_are_not_left(solvers):
    solver, (chain, values) = solvers[id(PANDA_LIMITED)], NARROW[0]
    T = chain.forward(np.array(values))
    assert not len(solver.solve_one(T, free=np.array([[0.1]])))
    assert not list(nearest_first(solver, T, np.zeros(7), free=np.array([0.1])))


def test_several_free_joints(solvers):
    chain = replace(IIWA, lower=np.full(7, -0.15), upper=np.full(7, 0.15))
    solver = make_solver(chain, Task.PLACE, steps=[0.4] * 4)
    assert len(solver.free_samples()) == 1
    rng, found = np.random.default_rng(1), 0
    for values in rng.uniform(-0.15, 0.15, (20, 7)):
        place = chain.forward(values)[:3, 3]
        rows = solver.solve_one(place)
        found += len(rows) > 0
        assert (np.abs(chain.forward(rows)[:, :3, 3] - place) < 1e-8).all()
    assert found >= 18


@pytest.mark.parametrize(
    ("values", "wanted"),
    [
        ([1.5, 0.05], 0),
        ([1.5 - 2 * np.pi, 0.05], 0),
        ([2.6, 0.05], 0.1),
        ([0.9, 0.05], 0.1),
        ([0.9 + 2 * np.pi, 0.05], 0.1),
        ([1.5, -0.01], 0.1),
        ([2.7, 0.12], 0.2),
    ],
)
def test_how_far_values_are_beyond_limits(values, wanted):
    """One joint may turn from 1 to 2.5, whatever the turn, and one may slide from 0 to 0.1, which is all the reach."""
    chain = Chain.of(np.eye(3)[:2], np.zeros((2, 3)), prismatic=[False, True], lower=[1, 0], upper=[2.5, 0.1])
    assert beyond_limits(chain, np.array(values)) == pytest.approx(wanted)


def test_values_beyond_limits_move_to_the_nearer_one():
    chain = Chain.of(np.eye(3)[:2], np.zeros((2, 3)), prismatic=[False, True], lower=[1, 0], upper=[5, 0.1])
    values = [[0.9, -0.1], [0.9 + 2 * np.pi, 0.2], [5.1 - 2 * np.pi, 0.05], [2 - 2 * np.pi, 0.0], [5.0, 0.1]]
    wanted = [[1, 0], [1, 0.1], [5, 0.05], [2, 0], [5, 0.1]]
    np.testing.assert_allclose(clamped(chain, np.array(values)), wanted)


class TestNearestReachable:
    @pytest.mark.parametrize("name", ARMS)
    def test_a_pose_that_is_reached_is_nearest_to_itself(self, solvers, name):
        chain = ARMS[name]
        solver, low, high = solvers[id(chain)], np.maximum(chain.lower, -3), np.minimum(chain.upper, 3)
        for values in np.random.default_rng(5).uniform(low, high, (5, 7)):
            near = solver.nearest_reachable(chain.forward(values))
            assert near.distance < 1e-6
            assert near.angle < 1e-6
            assert solver.nearest_reachable(chain.forward(values), values).values == pytest.approx(values, abs=1e-6)

    def test_a_planar_arm_stretches_out(self):
        """Two links of 1 m: the nearest point is 2 m from the base, in the direction of the goal."""
        T = np.eye(4)
        T[0, 3] = 2
        solver = make_solver(Chain.of([[0, 0, 1]] * 2, [[0, 0, 0], [1, 0, 0]], T_base_tool=T), Task.PLACE_XY)
        near = solver.nearest_reachable([3.0, 4.0])
        assert near.distance == pytest.approx(3.0)
        assert near.angle == 0
        assert near.T_base_tool[:2, 3] == pytest.approx([1.2, 1.6], abs=1e-4)
        assert str(near) == "the nearest that it reaches is 3 m away"

    def test_distance_and_angle_are_those_of_the_tool(self, solvers):
        rng, solver = np.random.default_rng(2), solvers[id(PANDA_LIMITED)]
        for _ in range(5):
            T = PANDA_LIMITED.forward(rng.uniform(-3, 3, 7))
            T[:3, 3] *= 1.6
            near = solver.nearest_reachable(T)
            tool = PANDA_LIMITED.forward(near.values)
            np.testing.assert_array_equal(near.T_base_tool, tool)
            assert near.distance == pytest.approx(np.linalg.norm(tool[:3, 3] - T[:3, 3]))
            assert np.cos(near.angle) == pytest.approx((np.trace(tool[:3, :3].T @ T[:3, :3]) - 1) / 2, abs=1e-9)
            assert ((near.values >= PANDA_LIMITED.lower) & (near.values <= PANDA_LIMITED.upper)).all()
            error = np.hypot(near.distance / PANDA_LIMITED.reach, near.angle)
            for step in rng.normal(size=(50, 7)) * 1e-3:  # nothing around it is nearer
                moved = np.clip(near.values + step, PANDA_LIMITED.lower, PANDA_LIMITED.upper)
                assert np.hypot(*np.divide(solver.numeric.shortfall(T, moved), [PANDA_LIMITED.reach, 1])) > error - 1e-6

    @pytest.mark.parametrize("task", [Task.DIRECTION, Task.PLACE_Z_ANGLE])
    def test_the_angle_of_a_direction_is_one(self, task):
        """A joint about z that may turn from 0 to 1 cannot turn its direction, x, to y, or from x to z."""
        chain = Chain.of([[0, 0, 1]], [[0, 0, 0]], lower=[0], upper=[1], direction=[1, 0, 0])
        near = make_solver(chain, task).nearest_reachable([0, 1, 0] if task is Task.DIRECTION else [0.4, 0, 0, 0])
        assert near.angle == pytest.approx(np.pi / 2 - (1 if task is Task.DIRECTION else 0.4), abs=1e-6)


class TestRotations:
    T = IIWA.forward(np.array([0.3, 0.5, -0.4, 1.0, 0.2, -0.6, 0.1]))

    def scaled(self, factor):
        T = self.T.copy()
        T[:3, :3] *= factor
        return T

    @pytest.mark.parametrize("factor", [1.1, 1.001, 0.9, -1])
    def test_what_is_no_rotation_is_refused(self, solvers, factor):
        for ask in (solvers[id(IIWA)].solve_one, solvers[id(IIWA)].nearest_reachable):
            with pytest.raises(ValueError, match="mirror" if factor < 0 else "scale or shear in it: R.T R differs"):
                ask(self.scaled(factor))

    def test_what_is_nearly_one_becomes_the_nearest_rotation(self, solvers):
        for near in (self.scaled(1.0003), np.round(self.T, 4)):
            rows = solvers[id(IIWA)].solve_one(near)
            assert len(rows)
            tool = IIWA.forward(rows)
            np.testing.assert_allclose(tool, np.broadcast_to(near, tool.shape), atol=5e-4)
            rotation = tool[0, :3, :3]
            np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
            for turn in np.random.default_rng(1).normal(size=(20, 3)) * 1e-3:  # no other rotation is nearer
                skewed = np.cross(np.eye(3), turn)
                other = rotation @ np.linalg.solve(np.eye(3) - skewed, np.eye(3) + skewed)
                assert np.linalg.norm(other - near[:3, :3]) > np.linalg.norm(rotation - near[:3, :3]) - 1e-9


@pytest.mark.parametrize(("joints", "free"), [(5, []), (6, [5]), (7, [6, 0])])
def test_default_free_joints_for_a_position_and_direction(joints, free):
    axes = np.array([[0, 0, 1], [0, 1, 0]] * 4)[7 - joints : 7]  # the last one is the tool's direction, z
    points = [[0, 0, 0.2 * joint] for joint in range(joints)]
    chain = Chain.of(axes, points, T_base_tool=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.2 * joints], [0, 0, 0, 1]])
    assert default_free(chain, "TranslationDirection5D", 5) == free
