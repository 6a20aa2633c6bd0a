"""Motions that leave the goal reached: null spaces, paths, sweeps of the free joint."""

from dataclasses import replace

import numpy as np
import pytest
from ik_arms import PANDA, PUMA, WAM

from ravemj.ik import Task, make_solver, null_space, null_space_path, sweep

VALUES = np.array([0.3, -0.5, 0.7, -1.2, 0.4, 1.1, -0.2])
LIMITED = replace(PANDA, lower=np.full(7, -1.5), upper=np.full(7, 1.5))


@pytest.mark.parametrize("chain", [PANDA, WAM])
def test_seven_joints_have_one_motion_that_leaves_the_tool_where_it_is(chain):
    basis = null_space(chain, VALUES)
    assert basis.shape == (7, 1)
    assert np.linalg.norm(basis) == pytest.approx(1)
    step = 1e-5 * basis[:, 0]
    np.testing.assert_allclose(chain.forward(VALUES + step), chain.forward(VALUES - step), atol=1e-9)


def test_six_joints_have_none_but_where_they_are_singular():
    assert null_space(PUMA, VALUES[:6]).shape == (6, 0)
    straight = VALUES[:6].copy()
    straight[4] = 0
    basis = null_space(PUMA, straight)
    np.testing.assert_allclose(np.abs(basis[:, 0]), [0, 0, 0, np.sqrt(0.5), 0, np.sqrt(0.5)], atol=1e-12)


@pytest.mark.parametrize(
    ("task", "count"),
    [(Task.PLACE, 4), (Task.ROTATION, 4), (Task.PLACE_DIRECTION, 2), (Task.RAY, 3), (Task.DIRECTION, 5)],
)
def test_what_does_not_count_is_free(task, count):
    basis = null_space(PANDA, VALUES, task)
    assert basis.shape == (7, count)
    np.testing.assert_allclose(basis.T @ basis, np.eye(count), atol=1e-12)


def test_looking_at_a_place_depends_on_the_place():
    T = PANDA.forward(VALUES)
    near, far = T[:3, 3] + 0.1 * T[:3, 2], T[:3, 3] + 5 * T[:3, 2]
    for place in (near, far):
        basis = null_space(PANDA, VALUES, Task.LOOK_AT, place)
        assert basis.shape == (7, 5)
        for column in basis.T:
            moved = PANDA.forward(VALUES + 1e-6 * column)
            assert np.linalg.norm(np.cross(moved[:3, 2], place - moved[:3, 3])) < 1e-10


def test_a_path_through_the_null_space():
    solver = make_solver(PANDA)
    T = PANDA.forward(VALUES)
    rows = null_space_path(solver, T, VALUES, np.eye(7)[0], step=0.05, length=1.0)
    assert len(rows) == 21
    np.testing.assert_array_equal(rows[0], VALUES)
    assert rows[1, 0] > VALUES[0]
    np.testing.assert_allclose(np.linalg.norm(np.diff(rows, axis=0), axis=1), 0.05, rtol=0.05)
    np.testing.assert_allclose(PANDA.forward(rows), np.broadcast_to(T, (21, 4, 4)), atol=1e-8)


def test_a_path_ends_at_a_limit():
    rows = null_space_path(make_solver(LIMITED), LIMITED.forward(VALUES), VALUES, np.eye(7)[0], length=20)
    assert 2 < len(rows) < 400
    assert (np.abs(rows) <= 1.5).all()
    assert np.abs(rows[-1]).max() > 1.4


def test_a_path_that_closes():
    """The elbow of an arm with spherical shoulder and wrist goes round."""
    rows = null_space_path(
        make_solver(replace(WAM, circular=np.full(7, True))), WAM.forward(VALUES), VALUES, VALUES, length=99
    )
    assert len(rows) < 99 / 0.05
    np.testing.assert_allclose(np.exp(1j * rows[-1]), np.exp(1j * VALUES), atol=0.05)


def test_a_path_that_cannot_begin():
    with pytest.raises(ValueError, match="cannot move along"):
        null_space_path(make_solver(PUMA), PUMA.forward(VALUES[:6]), VALUES[:6], np.eye(6)[0])


@pytest.mark.parametrize("chain", [LIMITED, WAM])
def test_a_sweep_is_continuous_and_goes_through_the_seed(chain):
    solver = make_solver(chain)
    T = chain.forward(VALUES)
    rows = sweep(solver, T, VALUES, step=0.01)
    assert len(rows) > 20
    free = rows[:, solver.free[0]]
    assert (np.diff(free) > 0).all()
    assert np.abs(rows - VALUES).max(axis=1).min() < 1e-6
    assert (rows >= chain.lower).all()
    assert (rows <= chain.upper).all()
    assert np.abs(np.diff(rows, axis=0)).max() < 0.5
    np.testing.assert_allclose(chain.forward(rows), np.broadcast_to(T, (len(rows), 4, 4)), atol=1e-8)


def test_a_sweep_out_of_reach_is_empty():
    T = PANDA.forward(VALUES)
    T[:3, 3] *= 10
    assert sweep(make_solver(PANDA), T, VALUES).shape == (0, 7)


def test_a_sweep_needs_a_free_joint():
    with pytest.raises(ValueError, match="one free joint"):
        sweep(make_solver(PUMA), PUMA.forward(VALUES[:6]), VALUES[:6])
