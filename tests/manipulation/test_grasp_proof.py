"""A lift and a shake against what friction can carry by hand calculation."""

import numpy as np
import pytest
from conftest import one_in

import ravemj
from ravemj.engine.physics.grasp_proof import prove

GRAVITY, SHAKE, FORCE = 9.81, 5.0, 20.0  # m/s^2, m/s^2, N of both fingers of the Panda together


def held_box(closing=(0, 1, 0), mass=0.2):
    """Return a Panda with a box between its fingers; the world is turned so that they close along an axis."""
    env = ravemj.Environment()
    assert env.Load(ravemj.model_path("panda"))
    assert env.Load(ravemj.model_path("box"))
    robot, box = env.GetRobots()[0], env.GetKinBody("box")
    box.GetLinks()[0].SetMass(mass)
    arm = robot.GetActiveManipulator()
    robot.SetDOFValues([0.02], [7])
    T = arm.GetTransform()
    R = ravemj.rotationMatrixFromQuat(ravemj.quatRotateDirection(T[:3, 1], closing))
    turn = np.eye(4)
    turn[:3, :3] = R
    robot.SetTransform(turn @ robot.GetTransform())
    T = arm.GetTransform()
    T_box = np.eye(4)
    T_box[:3, :3] = np.column_stack([T[:3, 1], T[:3, 0], -T[:3, 2]])
    T_box[:3, 3] = T[:3, 3] - 0.05 * T_box[:3, 2]
    box.SetTransform(T_box)
    return robot, arm, box


def proof_of(robot, arm, box, friction):
    return prove(robot.simulation_state, arm.description, box.simulation_state, friction, np.array([0, 0, -GRAVITY]))


@pytest.mark.parametrize("closing", one_in(3, [(0.6, 0.8, 0), (0, 1, 0), (1, 0, 0)]))
@pytest.mark.parametrize("mass", [0.2, 0.5])
def test_a_box_is_held_if_friction_carries_its_weight(closing, mass):
    """Two contacts with half of the force each carry mu * force, and the shake upwards needs m (g + a)."""
    robot, arm, box = held_box(closing, mass)
    needed = mass * (GRAVITY + SHAKE) / FORCE
    strong, weak = proof_of(robot, arm, box, 1.15 * needed), proof_of(robot, arm, box, 0.9 * needed)
    assert (strong.held, weak.held) == (True, False)
    assert strong.moved < 0.005
    assert strong.seconds == pytest.approx(3.5)
    assert weak.seconds < 3.5
    assert strong.forces == (FORCE,)
    assert strong.mass == pytest.approx(mass, rel=1e-6)


def test_nothing_is_held_without_friction_or_between_open_fingers():
    robot, arm, box = held_box()
    assert not proof_of(robot, arm, box, 0.0).held
    box.SetTransform([1, 0, 0, 0, 3, 0, 0])  # far from the hand
    assert not proof_of(robot, arm, box, 0.8).held


def test_robot_and_box_stay_where_they_are():
    robot, arm, box = held_box()
    before = robot.GetTransform(), robot.GetDOFValues(), box.GetTransform()
    text = str(proof_of(robot, arm, box, 0.5))
    for old, new in zip(before, (robot.GetTransform(), robot.GetDOFValues(), box.GetTransform()), strict=True):
        np.testing.assert_array_equal(old, new)
    assert text.startswith("held: moved by ")
    assert "0.2 kg, friction 0.5, fingers press with 20 N" in text
