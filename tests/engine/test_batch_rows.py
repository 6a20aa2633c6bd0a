"""A row of a batch does not depend on the other rows, to the last bit."""

import numpy as np
import pytest
from conftest import MODELS
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples

import ravemj

COUNT = 70
NAMES = ["panda.xml", "puma560.xml", "env.xml", "biped.robot.xml"]
ROBOTS = {name: ravemj.load(MODELS / name).GetRobots()[0] for name in NAMES}

SPHERICAL = """<KinBody name="arm">
  <Body name="base"><Geom type="box"><extents>0.1 0.1 0.1</extents></Geom></Body>
  <Body name="ball" type="dynamic"><Translation>0 0 1</Translation>
    <Geom type="sphere"><radius>0.1</radius></Geom></Body>
  <Body name="end" type="dynamic"><Translation>0 0.3 1.2</Translation>
    <Geom type="sphere"><radius>0.1</radius></Geom></Body>
  <Joint name="s" type="spherical"><Body>base</Body><Body>ball</Body><offsetfrom>base</offsetfrom></Joint>
  <Joint name="j" type="hinge"><Body>ball</Body><Body>end</Body><offsetfrom>end</offsetfrom><axis>1 1 0</axis></Joint>
</KinBody>"""


def configurations(body):
    lower, upper = np.clip(body.GetDOFLimits(), -3, 3)
    return np.random.default_rng(7).uniform(lower, upper, (COUNT, body.GetDOF()))


def answers(body, values):
    """Yield what each batch call says of some configurations."""
    link = len(body.GetLinks()) - 1
    yield body.batch_link_transforms(values)
    yield body.batch_jacobians(values, link, [0.1, 0.2, 0.3])
    yield body.batch_inverse_dynamics(values, 0.5 * values, 2.0 * values)
    yield body.batch_collides(values)
    yield body.batch_self_collides(values)
    yield body.batch_distances(values, True)


@pytest.mark.parametrize("name", [*NAMES, "spherical"])
def test_a_row_alone_is_that_of_the_batch(name):
    body = ROBOTS.get(name)
    if body is None:
        env = ravemj.Environment()
        env.LoadData(SPHERICAL)
        (body,) = env.GetBodies()
    values = configurations(body)
    whole = list(answers(body, values))
    for row in (0, 1, 2):
        for alone, together in zip(answers(body, values[row : row + 1]), whole, strict=True):
            np.testing.assert_array_equal(alone[0], together[row])


@examples(30)
@given(st.sampled_from(NAMES), st.integers(0, COUNT - 1), st.integers(1, COUNT))
def test_rows_of_a_part_are_those_of_the_whole(name, first, count):
    values = configurations(ROBOTS[name])
    part = slice(first, first + count)
    for some, together in zip(answers(ROBOTS[name], values[part]), answers(ROBOTS[name], values), strict=True):
        np.testing.assert_array_equal(some, together[part])


@pytest.mark.parametrize("count", [-1, 1.5, None, 1025, 10**400], ids=lambda count: str(count)[:9])
def test_wrong_numbers_of_threads(count):
    with pytest.raises(ravemj.openrave_exception, match="set_batch_threads: count"):
        ravemj.set_batch_threads(count)
