"""Rays of the pointer against every shape, placed anyhow: where they meet it, by marching along them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from strategies import examples

import ravemj
from ravemj.gui.interaction import pick
from ravemj.gui.interaction.viewpoint import ViewRay

HALF = np.array([0.1, 0.2, 0.3])
RADIUS, HEIGHT = 0.15, 0.5
CORNERS = np.array([[0.3, 0, -0.1], [-0.2, 0.3, -0.1], [-0.2, -0.3, -0.1], [0, 0, 0.4]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
PLACE = ravemj.matrixFromPose([0.5, 0.1, -0.7, 0.5, 0.2, -0.3, 0.4])


def in_box(points):
    return (np.abs(points) <= HALF).all(axis=-1)


def in_sphere(points):
    return np.linalg.norm(points, axis=-1) <= RADIUS


def in_cylinder(points):
    return (np.hypot(points[..., 0], points[..., 1]) <= RADIUS) & (np.abs(points[..., 2]) <= HEIGHT / 2)


def in_capsule(points):
    beyond = np.maximum(np.abs(points[..., 2]) - HEIGHT / 2, 0)
    return np.linalg.norm(np.stack([points[..., 0], points[..., 1], beyond], axis=-1), axis=-1) <= RADIUS


def in_mesh(points):
    inside = np.ones(points.shape[:-1], dtype=bool)
    for first, second, third in CORNERS[FACES]:
        inside &= (points - first) @ np.cross(second - first, third - first) <= 0
    return inside


def of_kind(kind, *sizes):
    def fill(body):
        info = ravemj.KinBody.GeometryInfo()
        info._type, info._vGeomData = kind, list(sizes)
        body.InitFromGeometries([info])

    return fill


SHAPES = {
    "box": (in_box, lambda body: body.InitFromBoxes([[0, 0, 0, *HALF]])),
    "sphere": (in_sphere, lambda body: body.InitFromSpheres([[0, 0, 0, RADIUS]])),
    "cylinder": (in_cylinder, of_kind(ravemj.GeometryType.Cylinder, RADIUS, HEIGHT)),
    "capsule": (in_capsule, of_kind(ravemj.GeometryType.Capsule, RADIUS, HEIGHT)),
    "mesh": (in_mesh, lambda body: body.InitFromTrimesh(ravemj.TriMesh(CORNERS, FACES))),
}
WORLDS = {}


def world(kind):
    """An environment with one body of that kind, elsewhere and turned."""
    if kind not in WORLDS:
        env = WORLDS[kind] = ravemj.Environment()
        body = ravemj.RaveCreateKinBody(env, "")
        SHAPES[kind][1](body)
        body.SetName("one")
        env.Add(body)
        body.SetTransform(PLACE)
    return WORLDS[kind]


def passage(inside, start, direction) -> tuple[float, float]:
    """How far along a ray it is inside a shape first, and for how long: by steps of 1 mm, and halving the first one."""
    T = np.linalg.inv(PLACE)
    start, direction = T[:3, :3] @ start + T[:3, 3], T[:3, :3] @ direction
    ways = np.arange(0, 6, 1e-3)
    hits = np.flatnonzero(inside(start + ways[:, None] * direction))
    if not len(hits):
        return np.inf, 0.0
    low, high = ways[hits[0]] - 1e-3, ways[hits[0]]
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if inside(start + middle * direction) else (middle, high)
    return high, 1e-3 * len(hits)


numbers = st.floats(-1, 1, allow_subnormal=False)


@pytest.mark.parametrize("kind", SHAPES)
@examples(60)
@given(arrays(float, 3, elements=numbers), arrays(float, 3, elements=numbers))
def test_rays_meet_every_shape_where_it_begins(kind, aside, towards):
    away = np.linalg.norm(aside)
    if away < 0.1:
        return
    start = PLACE[:3, 3] + 2 * aside / away
    target = PLACE[:3, 3] + 0.5 * towards
    direction = (target - start) / np.linalg.norm(target - start)
    inside = SHAPES[kind][0]
    expected, length = passage(inside, start, direction)
    hit = pick(world(kind).simulation, ViewRay(start, direction))
    if hit is None or length == 0:
        assert length < 3e-3, "only a ray that hardly touches it may miss it"
        return
    assert hit.distance == pytest.approx(expected, abs=1e-6)
    np.testing.assert_allclose(hit.position, start + hit.distance * direction, atol=1e-9)
    assert np.linalg.norm(hit.normal) == pytest.approx(1)
    assert hit.normal @ direction <= 1e-9
    T = np.linalg.inv(PLACE)
    assert not inside(T[:3, :3] @ (hit.position + 1e-5 * hit.normal) + T[:3, 3])
    if length > 0.02:
        assert inside(T[:3, :3] @ (hit.position - 1e-5 * hit.normal + 1e-5 * direction) + T[:3, 3])


def test_the_nearest_of_several_bodies_is_hit_and_nothing_behind_the_eye():
    env = ravemj.Environment()
    for number in range(3):
        body = ravemj.RaveCreateKinBody(env, "")
        body.InitFromSpheres([[0, 0, 0, 0.1]])
        body.SetName(f"at {number}")
        env.Add(body)
        body.SetTransform([1, 0, 0, 0, number, 0, 0])
    for start, direction, name, x in ((-1, 1, "at 0", -0.1), (0.5, 1, "at 1", 0.9), (0.5, -1, "at 0", 0.1)):
        hit = pick(env.simulation, ViewRay(np.array([start, 0.0, 0]), np.array([direction, 0.0, 0])))
        assert hit.body.scene.name == name
        np.testing.assert_allclose(hit.position, [x, 0, 0], atol=1e-9)
        np.testing.assert_allclose(hit.normal, [-direction, 0, 0], atol=1e-9)
    assert pick(env.simulation, ViewRay(np.array([2.5, 0.0, 0]), np.array([1.0, 0, 0]))) is None
    assert pick(ravemj.Environment().simulation, ViewRay(np.zeros(3), np.array([1.0, 0, 0]))) is None
