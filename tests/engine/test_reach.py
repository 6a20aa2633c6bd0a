"""How far points travel when a DOF moves, and the weights and resolutions that ``LinkStatisticsModel`` makes of it."""

import warnings

import numpy as np
import pytest
import strategies
from hypothesis import given
from hypothesis import strategies as st
from ravemj.databases.linkstatistics import LinkStatisticsModel

import ravemj
from ravemj.model.motion_bounds import motion_bounds
from ravemj.model.scene import Mesh

MECHANISM = """<Robot name="m"><KinBody>
  <Body name="a"><Geom type="box"><extents>0.1 0.1 0.1</extents></Geom></Body>
  <Body name="b"><Translation>0 0 1</Translation><Geom type="box"><extents>0.3 0.4 5</extents></Geom></Body>
  <Body name="c"><Translation>0 0 1</Translation><Geom type="sphere"><radius>0.2</radius></Geom></Body>
  <Body name="d"/><Body name="e"/>
  <Joint name="turn" type="hinge"><Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint>
  <Joint name="slide" type="slider"><Body>b</Body><Body>c</Body><axis>1 0 0</axis><limits>-1 2</limits></Joint>
  <Joint name="lift" type="slider" enable="false" mimic_pos="-3*idle">
    <Body>a</Body><Body>d</Body><axis>0 0 1</axis></Joint>
  <Joint name="idle" type="hinge"><Body>d</Body><Body>e</Body><axis>1 0 0</axis></Joint>
</KinBody></Robot>"""


def vertices(body) -> list[np.ndarray]:
    """The corners of each link's shapes in the world."""
    shapes = [
        Mesh.merged(one.shape.triangulated().moved(one.T_link_geometry.matrix()) for one in link.geometries).vertices
        for link in body.simulation_state.scene.links
    ]
    poses = body.GetLinkTransformations()
    return [points @ T[:3, :3].T + T[:3, 3] for points, T in zip(shapes, poses, strict=True)]


def test_a_pendulum(robot):
    forearm = [0.2, 0.01, 0.01]
    expected = [0.2 + np.linalg.norm(forearm), np.linalg.norm(forearm[:2])]
    np.testing.assert_allclose(motion_bounds(robot.simulation_state.scene), expected)


def test_turning_counts_across_the_axis_and_sliders_reach_further():
    env = ravemj.Environment()
    assert env.LoadData(MECHANISM)
    found = motion_bounds(env.GetRobot("m").simulation_state.scene)
    np.testing.assert_allclose(found, [max(0.5, 2 + 0.2 * 2**0.5), 1, 0])


@given(strategies.scenes(), st.integers(0, 100))
@strategies.examples(40)
def test_no_point_travels_further(scene, seed):
    env, numbers = ravemj.Environment(), np.random.default_rng(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        env.LoadData(strategies.xml(strategies.scene_node(scene)))
        for robot in env.GetRobots():
            LinkStatisticsModel(robot).setRobotResolutions(xyzdelta=0.01)
            lower, upper = (np.clip(limits, -10, 10) for limits in robot.GetDOFLimits())
            for dof, step in enumerate(robot.GetDOFResolutions()):
                values = numbers.uniform(lower, upper)
                robot.SetDOFValues(values)
                before = vertices(robot)
                values[dof] -= np.sign(values[dof] - (lower + upper)[dof] / 2) * min(step, (upper - lower)[dof] / 2)
                robot.SetDOFValues(values)
                for now, then in zip(vertices(robot), before, strict=True):
                    assert np.linalg.norm(now - then, axis=1).max(initial=0.0) <= 0.01 + 1e-9


def test_weights_and_resolutions(robot):
    model = LinkStatisticsModel(robot)
    assert model.load()
    model.autogenerate()
    model.save()
    model.setRobotWeights(weightmult=3)
    first, second = robot.GetDOFWeights()
    assert (first + second) / 2 == pytest.approx(3)
    assert first / second == pytest.approx(2, rel=1e-2)
    model.setRobotResolutions()
    np.testing.assert_allclose(robot.GetDOFResolutions(), 0.005 / motion_bounds(robot.simulation_state.scene))
    model.setRobotResolutions(0.01)
    np.testing.assert_allclose(robot.GetDOFResolutions(), 0.01 / motion_bounds(robot.simulation_state.scene))
    with pytest.raises(ravemj.ArgumentError, match="type is 5"):
        model.setRobotWeights(5)


def test_what_moves_nothing_still_gets_numbers():
    env = ravemj.Environment()
    env.LoadData(MECHANISM)
    model = LinkStatisticsModel(env.GetRobot("m"))
    model.setRobotWeights()
    model.setRobotResolutions(0.01)
    assert model.robot.GetDOFResolutions()[1:].tolist() == [0.01, 0.01]
    assert model.robot.GetDOFWeights()[1] == model.robot.GetDOFWeights()[2]
