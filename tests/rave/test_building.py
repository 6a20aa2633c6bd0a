"""Bodies made in code."""

import numpy as np
import pytest

import ravemj
from ravemj.errors import Source
from ravemj.model import scene

TURNED = [[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]


@pytest.fixture
def env():
    return ravemj.Environment()


@pytest.fixture
def body(env):
    empty = scene.KinBody(name="b", is_robot=False, links=(), joints=(), passive_joints=(), source=Source("test"))
    return env.wrap(env.simulation.create(empty))


def test_boxes_are_one_static_link(body):
    assert body.InitFromBoxes([[0, 0, 0, 0.1, 0.2, 0.3], [1, 2, 3, 1, 1, 1]], False) is True
    (link,) = body.GetLinks()
    assert (link.GetName(), link.GetMass(), link.IsStatic()) == ("base", 1e-10, True)
    first, second = link.GetGeometries()
    np.testing.assert_array_equal(first.GetBoxExtents(), [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(second.GetTransform()[:3, 3], [1, 2, 3])
    assert not first.IsVisible()


def test_turned_boxes_have_their_axes_as_columns(body):
    axes = np.array(TURNED).T.reshape(-1)
    assert body.InitFromBoxes([[1, 2, 3, *axes, 4, 5, 6]])
    (box,) = body.GetLinks()[0].GetGeometries()
    np.testing.assert_allclose(
        box.GetTransform(), [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], atol=1e-15
    )
    np.testing.assert_array_equal(box.GetBoxExtents(), [4, 5, 6])


def test_spheres(body):
    assert body.InitFromSpheres(np.array([[1, 2, 3, 0.5]]))
    (ball,) = body.GetLinks()[0].GetGeometries()
    assert ball.GetSphereRadius() == 0.5
    np.testing.assert_array_equal(ball.GetTransform()[:3, 3], [1, 2, 3])


def test_triangles_stay_as_they_are(body):
    mesh = ravemj.TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]], [[0, 1, 2]])
    assert body.InitFromTrimesh(mesh)
    mesh.vertices[:] = 7
    kept = body.GetLinks()[0].GetGeometries()[0].GetCollisionMesh()
    np.testing.assert_array_equal(kept.vertices, [[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]])
    np.testing.assert_array_equal(kept.indices, [[0, 1, 2]])


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda body: body.InitFromBoxes(np.zeros((1, 5))), ravemj.openrave_exception),
        (lambda body: body.InitFromBoxes([[np.nan] * 6]), ravemj.openrave_exception),
        (lambda body: body.InitFromBoxes(np.zeros(6)), TypeError),
        (lambda body: body.InitFromSpheres(np.zeros((1, 6))), ravemj.openrave_exception),
        (lambda body: body.InitFromTrimesh(np.zeros((1, 3))), ravemj.ArgumentError),
        (lambda body: body.InitFromTrimesh(ravemj.TriMesh([[0, 0, 0]], [[0, 0, 1]])), ravemj.ArgumentError),
        (lambda body: body.InitFromTrimesh(ravemj.TriMesh([[0, 0]], [[0, 0, 0]])), ravemj.ArgumentError),
    ],
)
def test_what_is_refused_changes_nothing(body, call, error):
    body.InitFromSpheres([[0, 0, 0, 1]])
    before = body.simulation_state.scene
    with pytest.raises(error):
        call(body)
    assert body.simulation_state.scene is before


def test_a_body_in_the_world_stays_as_it_is(env, body):
    body.InitFromSpheres([[0, 0, 0, 1]])
    env.simulation.insert(body.simulation_state)
    with pytest.raises(ravemj.openrave_exception, match="remove it first") as caught:
        body.InitFromBoxes([[0, 0, 0, 1, 1, 1]])
    assert caught.value.GetCode() == "Failed"
    assert body.GetLinks()[0].GetGeometries()[0].GetSphereRadius() == 1
