"""Closed forms: arms of each family, their certificates, completeness, singular and unreachable poses."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import one_in
from hypothesis import given
from hypothesis import strategies as st
from ik_arms import KINDS, PANDA, PUMA, RIGHT, UR5, WAM, arm, from_dh, pose
from strategies import examples

from ravemj.ik import Chain, NumericSolver, Task, derive, make_solver
from ravemj.ik.derive import certify, random_values

GENERAL = ("RRRRRR", "XRRRR", "RX=R", "XRXR", "==RR", "XXX", "RRRRR", "R=R=")
COMPLETE = ("RRRS", "RSRR", "RRSR", "SRRP", "PRRS", "RPPS", "RRLR", "LRX", "RllpRR", "RLPR", "PRPRPR", "RRRRRR", "XRXR")


def same(chain, one, other):
    """Whether rows show the same configuration, shape (...)."""
    away = np.where(chain.prismatic, one - other, 2 * np.sin((one - other) / 2))
    return np.abs(away).max(axis=-1) < 1e-5


def worst(chain, rows, T):
    return np.abs(chain.forward(rows) - T).max(initial=0.0)


@pytest.mark.parametrize("kind", one_in(2, [*KINDS, *GENERAL]))
def test_families_solve_random_arms(kind):
    chain = arm(np.random.default_rng(len(kind)), kind)
    solver, certificate = derive(chain) or derive(chain, general=True)
    assert certificate.holds
    values = random_values(chain, 40, np.random.default_rng(5))
    T = chain.forward(values)
    solutions = solver.solve(T)
    rows, index, branch = solutions.rows
    assert worst(chain, rows, T[index]) < 1e-8
    for number in range(len(T)):
        found = solutions.of(number)
        assert same(chain, found, values[number]).any()
        assert not any(same(chain, row, found[:place]).any() for place, row in enumerate(found))
    assert set(branch) <= set(range(len(solver.branch_names)))
    assert len(set(solver.branch_names)) == len(solver.branch_names)


@pytest.mark.parametrize("kind", one_in(3, COMPLETE))
def test_no_search_finds_what_the_closed_form_misses(kind):
    chain = arm(np.random.default_rng(3), kind)
    solver = (derive(chain) or derive(chain, general=True))[0]
    T = chain.forward(random_values(chain, 6, np.random.default_rng(8)))
    search = NumericSolver(chain, starts=80)
    searched = 0
    for T_base_tool, number in zip(T, range(len(T)), strict=True):
        found = solver.solve(T).of(number)
        for row in search.solve_all(T_base_tool):
            searched += 1
            assert same(chain, found, row).any()
    assert searched >= len(T)


@pytest.mark.parametrize("seed", range(20))
def test_general_arms_of_six_joints(seed):
    chain = arm(np.random.default_rng(1000 + seed), "RRRRRR")
    assert derive(chain) is None
    solver, certificate = derive(chain, general=True)
    assert certificate.holds
    values = random_values(chain, 30, np.random.default_rng(1))
    T = chain.forward(values)
    found = solver.solve(T)
    assert (same(chain, found.values, values[:, None]) & found.valid).any(axis=1).all()
    for row in NumericSolver(chain, starts=25).solve_all(T[0]):
        assert same(chain, found.of(0), row).any()


@pytest.mark.parametrize(
    ("chain", "free", "family"),
    [(PUMA, (), "wrist"), (UR5, (), "parallel"), (PANDA, (6,), "wrist"), (WAM, (2,), "wrist")],
)
def test_known_arms(chain, free, family):
    solver = make_solver(chain)
    assert solver.free == free
    assert family in solver.closed.family.name
    assert solver.certificate.holds
    assert solver.complete


def test_the_puma_has_eight_solutions():
    values = random_values(PUMA, 200, np.random.default_rng(0))
    found = derive(PUMA)[0].solve(PUMA.forward(values))
    assert (found.valid.sum(axis=1) == 8).all()


@pytest.mark.parametrize("joint", range(7))
@pytest.mark.parametrize("chain", [PANDA, WAM])
def test_any_joint_of_seven_can_be_given(chain, joint):
    derived = derive(chain, locked=[joint])
    if chain is WAM and joint == 3:  # its value is the distance between shoulder and wrist
        assert derived is None
        return
    derived = derived or derive(chain.locked(joint, 0.3), general=True)
    assert derived[1].holds


def test_a_locked_joint_is_that_of_the_shorter_chain():
    values = np.array([0.3, -0.5, 0.7, -1.2, 0.4, 1.1, -0.2])
    for joint in range(7):
        rest = np.delete(values, joint)
        short = PANDA.locked(joint, values[joint])
        np.testing.assert_allclose(short.forward(rest), PANDA.forward(values), atol=1e-14)


@pytest.mark.parametrize("chain", [PUMA, UR5])
def test_a_batch_is_a_loop(chain):
    solver = derive(chain)[0]
    T = chain.forward(random_values(chain, 30, np.random.default_rng(1)))
    whole = solver.solve(T)
    for number in range(30):
        one = solver.solve(T[number : number + 1])
        np.testing.assert_array_equal(one.valid[0], whole.valid[number])
        np.testing.assert_allclose(one.values[0], whole.values[number], atol=1e-9)


def test_no_poses():
    found = derive(PUMA)[0].solve(np.zeros((0, 4, 4)))
    assert found.values.shape == (0, 8, 6)
    assert make_solver(PUMA).solve(np.zeros((0, 4, 4))).values.shape == (0, 8, 6)
    assert make_solver(PANDA).solve(np.zeros((0, 4, 4))).values.shape[0] == 0


@pytest.mark.parametrize(
    "tilt", [0.0, 1e-14, 1e-11, 3e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3, np.pi, 3.14159265]
)
def test_singular_wrists(tilt):
    values = np.array([0.3, -0.8, 0.9, 0.4, tilt, 0.6])
    T = PUMA.forward(values)
    found = derive(PUMA)[0].solve(T[None]).of(0)
    assert worst(PUMA, found, T) < 1e-9
    near = np.abs(found[:, :3] - values[:3]).max(axis=1) < 1e-6
    assert near.any()
    if tilt < 1e-8:
        assert np.abs(np.sin(found[near, 3] + found[near, 5] - 1.0)).max() < 1e-6


def test_singular_shoulder_and_elbow():
    solver = derive(PUMA)[0]
    straight = np.arctan2(0.0203, 0.4318)
    for values in ([0.3, -0.8, -RIGHT + straight, 0.4, 0.7, 0.6], [0.3, -0.8, RIGHT + straight, 0.4, 0.7, 0.6]):
        T = PUMA.forward(np.array(values))
        found = solver.solve(T[None]).of(0)
        assert len(found) >= 1
        assert worst(PUMA, found, T) < 1e-9


def test_stretched_is_solved_and_further_is_not():
    chain = Chain.of([[0, 0, 1]] * 3, [[0, 0, 0], [0.5, 0, 0], [0.9, 0, 0]])
    far = replace(chain, T_base_tool=np.array([[1, 0, 0, 0.9], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]))
    solver = derive(far, Task.PLANAR)[0]
    for x, number in ((0.9, 1), (0.9 + 1e-5, 0), (0.1, 1), (0.1 - 1e-5, 0), (0.5, 2)):
        T = far.T_base_tool.copy()
        T[0, 3] = x
        assert len(solver.solve(T[None]).of(0)) == number, x


def test_unreachable_poses():
    T = PUMA.forward(np.zeros(6))
    T[:3, 3] *= 10
    assert len(derive(PUMA)[0].solve(T[None]).of(0)) == 0
    solver = make_solver(PUMA)
    assert solver.solve_one(T).shape == (0, 6)
    assert solver.nearest(T, np.zeros(6)) is None
    assert make_solver(PANDA).nearest(T, np.zeros(7)) is None


@pytest.mark.parametrize("digits", [4, 5, 6])
@pytest.mark.parametrize("base", [PUMA, UR5])
def test_numbers_of_few_digits(base, digits):
    rng = np.random.default_rng(2)
    turned = pose(rng)
    axes = base.axes @ turned[:3, :3].T
    points = base.points @ turned[:3, :3].T + turned[:3, 3]
    sharp = 10.0**-digits
    chain = Chain.of(
        axes + rng.uniform(-sharp, sharp, axes.shape) / 20,
        points + rng.uniform(-sharp, sharp, points.shape) / 20,
        T_base_tool=turned @ base.T_base_tool,
    )
    derived = derive(chain)
    assert derived is not None
    solver, certificate = derived
    assert certificate.holds
    values = random_values(chain, 300, np.random.default_rng(5))
    T = chain.forward(values)
    found = solver.solve(T)
    rows, index, _ = found.rows
    assert worst(chain, rows, T[index]) < 1e-8
    assert same(chain, found.values, values[:, None])[found.valid].sum() >= 298


def test_redundant_and_wrong_arms_have_no_closed_form():
    rng = np.random.default_rng(0)
    assert derive(arm(rng, "llll")) is None
    assert derive(Chain.of([[0, 0, 1], [0, 0, 1]], [[0, 0, 0], [0, 0, 0.3]])) is None
    assert derive(arm(rng, "RRRRRRR")) is None
    assert derive(Chain.of([], [])) is None
    assert make_solver(arm(rng, "llll")).free == (3,)


def test_a_certificate_tells_a_wrong_solver():
    solver = derive(PUMA)[0]
    solver.chain = from_dh(
        [(0.6, 0, RIGHT), (0, 0.4, 0), (0.15005, 0.0203, -RIGHT), (0.4318, 0, RIGHT), (0, 0, -RIGHT), (0.1, 0, 0)]
    )
    assert not certify(solver).holds


@examples(60)
@given(st.sampled_from(KINDS), st.integers(0, 2**32 - 1))
def test_every_configuration_is_among_the_solutions_of_its_pose(kind, seed):
    rng = np.random.default_rng(seed)
    chain = arm(rng, kind)
    derived = derive(chain)
    if derived is None:  # by chance nearly special in another way; then it says so
        return
    values = random_values(chain, 20, rng)
    found = derived[0].solve(chain.forward(values))
    near = (same(chain, found.values, values[:, None]) & found.valid).any(axis=1)
    assert near.sum() >= 19
