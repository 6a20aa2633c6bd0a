"""Every type of goal: what OpenRAVE means by it, by hand; reductions to closed forms, and the search."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import one_in
from ik_arms import PANDA, PUMA, arm, pose

from ravemj.ik import Chain, NumericSolver, Task, make_solver
from ravemj.ik.derive import random_values
from ravemj.ik.reductions import ReducedForm
from ravemj.ik.residuals import ToolState, residual_and_jacobian
from ravemj.ik.tasks import goal_poses

LOCAL = np.array([0.1, -0.2, 0.05])
HEADINGS = (Task.PLACE_XY_HEADING, Task.PLACE_YZ_HEADING, Task.PLACE_ZX_HEADING)
REDUCED = [
    (Task.ROTATION, "S", "one point"),
    (Task.ROTATION, "RRR", "one point"),
    (Task.DIRECTION, "RR", "slide"),
    (Task.DIRECTION, "X", "slide"),
    (Task.LOOK_AT, "RR", "slide"),
    (Task.LOOK_AT, "RP", "slide"),
    (Task.RAY, "SR", "roll"),
    (Task.RAY, "LR", "roll"),
    (Task.PLACE_DIRECTION, "RRRX", "roll"),
    (Task.PLACE_DIRECTION, "LX", "roll"),
    (Task.PLACE_DIRECTION, "LPR", "roll"),
]


def quaternion(R):
    """wxyz of a rotation, by its axis and angle."""
    angle = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    return np.append(np.cos(angle / 2), np.sin(angle / 2) * axis / np.linalg.norm(axis))


def goal_of(chain, task, values):
    """The goal that a configuration reaches."""
    T = chain.forward(np.array(values))
    p, (x, y, z) = T[:3, 3], T[:3, :3] @ chain.direction
    u = np.array([x, y, z])
    angles = {
        Task.PLACE_X_ANGLE: np.arccos(x),
        Task.PLACE_Y_ANGLE: np.arccos(y),
        Task.PLACE_Z_ANGLE: np.arccos(z),
        Task.PLACE_XY_HEADING: np.arctan2(y, x),
        Task.PLACE_YZ_HEADING: np.arctan2(z, y),
        Task.PLACE_ZX_HEADING: np.arctan2(x, z),
    }
    if task in angles:
        return np.append(angles[task], p)
    return {
        Task.TRANSFORM: T,
        Task.ROTATION: quaternion(T[:3, :3]),
        Task.PLACE: p,
        Task.DIRECTION: u,
        Task.RAY: np.append(u, p + 0.3 * u),
        Task.LOOK_AT: p + 0.7 * u,
        Task.PLACE_DIRECTION: np.append(u, p),
        Task.PLACE_XY: p[:2],
        Task.PLANAR: np.append(p[:2], np.arctan2(y, x)),
        Task.LOCAL_PLACE: np.append(LOCAL, p + T[:3, :3] @ LOCAL),
    }[task]


def reaches(chain, task, goal, values):
    """Whether a configuration reaches a goal."""
    T = chain.forward(np.array(values))
    u = T[:3, :3] @ chain.direction
    if task is Task.LOOK_AT:
        away = goal - T[:3, 3]
        return np.abs(u - away / np.linalg.norm(away)).max() < 1e-7
    if task is Task.RAY:
        return np.abs(np.append(u - goal[:3], np.cross(u, goal[3:] - T[:3, 3]))).max() < 1e-7
    away = goal_of(chain, task, values) - goal
    if task is Task.ROTATION:
        return min(np.abs(away).max(), np.abs(away + 2 * goal).max()) < 1e-7
    if task is Task.PLANAR or task.value.endswith("4D"):
        angle = 2 if task is Task.PLANAR else 0
        away[angle] = np.sin(away[angle] / 2)
    return np.abs(away).max() < 1e-7


def same(chain, rows, values):
    """Which rows are a configuration, up to whole turns."""
    away = np.where(chain.prismatic, rows - values, 2 * np.sin((rows - values) / 2))
    return np.abs(away).max(axis=-1, initial=0.0) < 1e-5


@pytest.mark.parametrize(("task", "kind", "how"), REDUCED)
def test_reductions_find_all_configurations(task, kind, how):
    chain = arm(np.random.default_rng(4), kind)
    solver = make_solver(chain, task)
    assert isinstance(solver.closed, ReducedForm)
    assert solver.certificate.holds
    assert "by reduction" in solver.describe()
    assert how in solver.describe()
    search = NumericSolver(chain, task, starts=40)
    for number, values in enumerate(random_values(chain, 15, np.random.default_rng(6))):
        goal = goal_of(chain, task, values)
        rows = solver.solve_one(goal, limits=False)
        assert all(reaches(chain, task, goal, row) for row in rows)
        assert same(chain, rows, values).any()
        if number < 3:
            for row in search.solve_all(goal_poses(chain, task, goal)):
                assert same(chain, rows, row).any()


@pytest.mark.parametrize("task", one_in(2, list(Task)))
@pytest.mark.parametrize("chain", [PUMA, PANDA], ids=["puma", "panda"])
def test_every_type_on_arms_with_more_joints_than_it_needs(task, chain):
    solver = make_solver(chain, task)
    assert solver.describe().startswith("closed form" if solver.complete else "numeric")
    assert ("not complete" in solver.describe()) == (not solver.complete)
    for values in np.random.default_rng(2).uniform(-1, 1, (6, chain.dof)):
        if task in HEADINGS:  # a direction in the plane is wanted, and random configurations have none
            goal = np.append(0.4, chain.forward(values)[:3, 3] * 0.8)
            both = np.append(np.roll([np.cos(0.4), np.sin(0.4), 0], HEADINGS.index(task)), goal[1:])
            row = solver.nearest(goal, np.zeros(chain.dof))
            found = make_solver(chain, Task.PLACE_DIRECTION).nearest(both, np.zeros(chain.dof))
            assert (row is None) == (found is None)
            assert row is None or reaches(chain, Task.PLACE_DIRECTION, both, row)
            continue
        goal = goal_of(chain, task, values)
        row = solver.nearest(goal, np.zeros(chain.dof))
        assert reaches(chain, task, goal, row)
        if solver.closed is not None:
            free = list(solver.free)
            assert same(chain, solver.solve_one(goal, free=values[free][None], limits=False), values).any()


@pytest.mark.parametrize("task", HEADINGS)
def test_headings_of_an_arm_that_has_no_other_directions(task):
    """Three turns about parallel axes and a slide along them: the tool points at right angles to these."""
    x, y, z = np.roll(np.eye(3), HEADINGS.index(task), axis=1)
    chain = Chain.of(
        [z, z, z, z],
        [0 * x, x, 0 * x, 1.7 * x],
        prismatic=[False, False, True, False],
        T_base_tool=_at(2 * x),
        direction=0.6 * x + 0.8 * y,
    )
    solver = make_solver(chain, task)
    assert solver.complete
    for values in random_values(chain, 10, np.random.default_rng(1)):
        goal = goal_of(chain, task, values)
        rows = solver.solve_one(goal)
        assert all(reaches(chain, task, goal, row) for row in rows)
        assert same(chain, rows, values).any()


def _at(place):
    T = np.eye(4)
    T[:3, 3] = place
    return T


def test_the_tool_looks_at_places_in_front_of_it():
    chain = arm(np.random.default_rng(4), "RR")
    solver = make_solver(chain, Task.LOOK_AT)
    T = chain.forward(np.array([0.3, 0.4]))
    behind = T[:3, 3] - 0.7 * T[:3, :3] @ chain.direction
    rows = solver.solve_one(behind)
    assert all(reaches(chain, Task.LOOK_AT, behind, row) for row in rows)
    assert not same(chain, rows, np.array([0.3, 0.4])).any()


def test_a_roll_may_be_locked_before_the_virtual_one():
    """The last joint of a PUMA turns about its direction: with it locked, joints 4, 5 and the roll are its wrist."""
    solver = make_solver(PUMA, Task.PLACE_DIRECTION, free=[5])
    assert solver.free == (5,)
    values = np.array([0.3, -0.8, 0.9, 0.4, -0.5, 0.6])
    rows = solver.solve_one(goal_of(PUMA, Task.PLACE_DIRECTION, values), free=np.array([[0.2]]))
    assert len(rows) == 8
    assert (rows[:, 5] == 0.2).all()
    assert np.abs(rows[:, :5] - values[:5]).max(axis=1).min() < 1e-6


@pytest.mark.parametrize("task", list(Task))
def test_jacobians_of_tasks_are_derivatives(task):
    chain = arm(np.random.default_rng(3), "RPRRRR")
    wanted, values = random_values(chain, 2, np.random.default_rng(1)) * 0.3
    goal = goal_poses(chain, task, goal_of(chain, task, wanted))
    scale = np.array([0.5, 0.6, 0.7, 1.1, 1.2, 1.3])

    def missing(at):
        T, jacobian = chain.forward(at), chain.forward_and_jacobian(at[None])[1][0]
        return residual_and_jacobian(chain, task, goal, ToolState(T[:3, :3], T[:3, 3], jacobian), scale)

    if task in (Task.TRANSFORM, Task.ROTATION, Task.RAY, Task.LOOK_AT):
        values = wanted + 1e-9  # Jacobians of rotation vectors and projections are exact where nothing is missing
    slope, step = missing(values)[1], 1e-6
    for joint, ahead in enumerate(np.eye(chain.dof) * step):
        change = (missing(values + ahead)[0] - missing(values - ahead)[0]) / (2 * step)
        np.testing.assert_allclose(-change, slope[:, joint], atol=2e-6)


@pytest.mark.parametrize("task", [task for task in Task if task is not Task.TRANSFORM])
def test_goals_of_wrong_shapes(task):
    solver = make_solver(PUMA, task)
    with pytest.raises(ValueError, match=task.value):
        solver.solve_one(np.zeros(task.size + 1))
    with pytest.raises(ValueError, match="not finite"):
        solver.solve_one(np.full(task.size, np.nan))


@pytest.mark.parametrize(("task", "what"), [(Task.ROTATION, "quaternion"), (Task.DIRECTION, "direction")])
def test_goals_without_a_direction(task, what):
    with pytest.raises(ValueError, match=what):
        make_solver(PUMA, task).solve_one(np.zeros(task.size))


def test_many_free_joints_are_sampled_coarsely():
    solver = make_solver(PANDA, Task.DIRECTION)
    assert len(solver.free) == 5
    assert 100 < len(solver.free_samples()) <= 4096
    assert 100 < len(replace(solver, steps=(0.1,) * 5).free_samples()) <= 4096
    assert "every 0.1 rad" not in solver.describe()


def test_poses_point_where_directions_say():
    chain = Chain.of([[0, 0, 1]], [[0, 0, 0]], T_base_tool=pose(np.random.default_rng(0)), direction=(0.6, 0, -0.8))
    directions = np.vstack([np.eye(3), -np.eye(3), [[0.6, 0, 0.8]]])
    poses = goal_poses(chain, Task.DIRECTION, directions)
    np.testing.assert_allclose(poses[:, :3, :3] @ chain.direction, directions, atol=1e-15)
    np.testing.assert_allclose(np.linalg.det(poses[:, :3, :3]), 1)
