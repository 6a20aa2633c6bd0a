"""The search for joint values and the tests of configurations, on bodies of the engine alone."""

import numpy as np
import pytest

from ravemj.core.transforms import Pose
from ravemj.engine.collision.findings import Wanted, find
from ravemj.engine.simulation import Simulation
from ravemj.formats.readers import read_file
from ravemj.ik import Task
from ravemj.ik.arms import ArmSolver
from ravemj.manipulation.arm_search import ArmSearch, Checks, Reason
from ravemj.manipulation.bodies import ENV_COLLISION, FREE, USER, Bodies, Conditions, space_of
from ravemj.manipulation.refusals import RefusedError, allowed_ends
from ravemj.manipulation.tool import Tool
from ravemj.model import scene
from ravemj.model.shape_bodies import named_body, shape_geometry
from ravemj.trajectories.bodies import body_groups

ANGLES = np.array([0.3, -0.5, 0.4, 0.2, 0.5, 0.1])


class PlainChecker:
    """The engine's own answers."""

    is_plain = True

    def __init__(self, simulation):
        self.simulation = simulation

    def world(self):
        return self.simulation.collisions()

    def collides(self, world, pairs):
        return world.collide(pairs)

    def find(self, world, pairs):
        return find(world, pairs, Wanted(), np.inf, None)


@pytest.fixture
def simulation(models):
    simulation = Simulation()
    for body in read_file(models / "puma560.xml").scene.bodies:
        simulation.add(body)
    return simulation


@pytest.fixture
def puma(simulation):
    puma = next(body for body in simulation.bodies if body.scene.manipulators)
    full = puma.kinematics.values()
    full[list(puma.scene.manipulators[0].arm_dofs)] = ANGLES
    puma.set_values(full)
    return puma


class Noting(ArmSearch):
    explains = True
    rejected: list

    def reject(self, reason, row, findings):
        self.rejected.append((reason, row.tolist(), findings))


def search(puma, T_world_tool, **checks):
    arm = puma.scene.manipulators[0]
    solver = ArmSolver(Task.TRANSFORM).solver_for(puma.scene, arm)
    T_world_base = puma.link_transform(arm.base)
    goal = np.linalg.inv(T_world_base) @ T_world_tool
    made = Noting(puma, arm, solver, goal, Checks(**checks), PlainChecker(puma.simulation))
    made.explains, made.rejected = True, []
    return made


def obstacle(simulation, position):
    shape = shape_geometry(scene.Box((0.02, 0.02, 0.02)), Pose(tuple(position.tolist())), visible=True)
    return simulation.add(named_body("obstacle", [shape]))


def test_the_nearest_joint_values_reach_the_goal_and_nothing_moves(puma):
    tool = Tool.for_arm(puma.scene.manipulators[0])
    goal, before = tool.pose(puma), puma.kinematics.values()
    made = search(puma, goal, others=True)
    np.testing.assert_allclose(made.nearest(ANGLES + 0.05), ANGLES, atol=1e-6)
    np.testing.assert_array_equal(puma.kinematics.values(), before)
    assert made.near(ANGLES, 1e-6) is not None
    assert made.near(ANGLES + 0.3, 1e-6) is None
    for row in made.every():
        full = before.copy()
        full[list(tool.arm.arm_dofs)] = row
        puma.set_values(full)
        np.testing.assert_allclose(tool.pose(puma), goal, atol=1e-9)


def test_an_obstacle_at_the_tool_ends_the_search_and_names_both_geometries(simulation, puma):
    goal = Tool.for_arm(puma.scene.manipulators[0]).pose(puma)
    box = obstacle(simulation, goal[:3, 3])
    assert search(puma, goal).nearest() is not None
    made = search(puma, goal, others=True)
    assert made.nearest() is None
    ((reason, _, findings),) = made.rejected
    first, second, _ = findings.collisions[0]
    assert (made.ended, reason, first.body, second.body) == (True, Reason.END_COLLISION, puma, box)


def test_a_goal_out_of_reach_says_so(puma):
    far = np.eye(4)
    far[:3, 3] = 5.0
    made = search(puma, far)
    assert made.nearest() is None
    made.explain()
    assert [reason for reason, _, _ in made.rejected] == [Reason.OUT_OF_REACH]


def test_starts_and_goals_are_refused_with_the_reason(simulation, puma):
    arm = puma.scene.manipulators[0]
    bodies = Bodies(simulation, body_groups(puma.scene.name, arm.arm_dofs, 0, ""), lambda: PlainChecker(simulation))
    numbers = [bodies.numbers(name) for name in ("lower", "upper", "weight", "resolution")]
    space, conditions = space_of(bodies.coordinates(), *numbers), Conditions(bodies)
    assert conditions.violation(ANGLES) == FREE

    def refused(*goals):
        with conditions.kept(), pytest.raises(RefusedError) as caught:
            allowed_ends(conditions, space, conditions.allowed(), "goal", goals, needed=True)
        return caught.value

    name = puma.scene.joint_of_dof(arm.arm_dofs[0]).name
    assert str(refused()) == "there is no goal"
    assert str(refused(ANGLES + 10)).startswith(f"goal: joint '{name}' is 10.3, outside its limits [")
    obstacle(simulation, Tool.for_arm(arm).pose(puma)[:3, 3])
    error = refused(ANGLES)
    assert "of 'obstacle'" in str(error)
    assert error.findings.collisions
    assert conditions.violation(ANGLES) == ENV_COLLISION
    limited = Conditions(None, [lambda values: False])
    assert limited.violation(ANGLES) == FREE  # nothing moves
    assert Conditions(bodies, [lambda values: False]).violation(ANGLES + 0.6) in {ENV_COLLISION, USER}
