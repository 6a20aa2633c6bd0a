"""Force closure against known answers, properties and qhull (where SciPy is installed)."""

import itertools
import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import examples

from ravemj.manipulation.grasping import wrenches
from ravemj.manipulation.grasping.hulls import hull, nearest_facet
from ravemj.manipulation.grasping.wrenches import epsilon, friction_cones, quality, resistance, volume

CUBE = np.vstack([np.eye(3), -np.eye(3)])
CORNERS = np.array([(s * 0.02, y, z) for s in (-1, 1) for y in (-0.01, 0.01) for z in (-0.02, 0.02)])
SIDES = np.array([(math.copysign(1, x), 0, 0) for x, _, _ in CORNERS])


def points_of(positions, normals, friction, edges=8):
    return wrenches.wrenches(np.asarray(positions, float), friction_cones(np.asarray(normals, float), friction, edges))


def random_contacts(seed, count):
    random = np.random.default_rng(seed)
    normals = random.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return 0.05 * normals + 0.01 * random.normal(size=(count, 3)), normals


def test_box_between_two_fingers_and_the_palm():
    palm = np.array([(x, y, -0.02) for x in (-0.02, 0.02) for y in (-0.01, 0.01)])
    fingers = epsilon(CORNERS, SIDES, 0.4)
    assert fingers == pytest.approx(0.007878, abs=5e-7)
    both = epsilon(np.vstack([CORNERS, palm]), np.vstack([SIDES, [(0, 0, -1)] * 4]), 0.4)
    assert both > fingers


def test_two_opposite_points_are_never_closed():
    for friction in (0.2, 1.0, 10.0):
        two = resistance([(0, 0, 0.02), (0, 0, -0.02)], [(0, 0, 1), (0, 0, -1)], friction)
        assert not two.closed
        assert two.epsilon == 0
        assert np.abs(two.direction) == pytest.approx([0, 0, 0, 0, 0, 1], abs=1e-9)  # turns about the line


def test_three_points_on_a_great_circle():
    R = 0.02
    positions, normals = [(0, 0, -R), (-R, 0, 0), (R, 0, 0)], [(0, 0, -1), (-1, 0, 0), (1, 0, 0)]
    assert epsilon(positions, normals, 0.4) == pytest.approx(0.00182898, abs=5e-9)
    assert epsilon(positions, normals, 0.4, edges=16) == pytest.approx(0.001936, abs=5e-7)
    assert epsilon(positions, normals, 0.4, edges=32) == pytest.approx(0.001959, abs=5e-7)
    assert volume(np.array(positions), np.array(normals, float), 0.4) == pytest.approx(9.208e-8, rel=1e-4)


@pytest.mark.parametrize("friction", [0.2, 0.4, 0.5, 1.0, 0.05])
def test_centers_of_the_faces_of_a_cube(friction):
    expected = math.sqrt(2 / 3) * friction / math.sqrt(1 + friction**2)
    assert epsilon(CUBE, CUBE, friction) == pytest.approx(expected, rel=1e-9)


def test_without_friction():
    assert epsilon(CUBE, CUBE, 0) == 0
    normals = np.repeat(CUBE, 4, axis=0)
    spread = [np.roll((0, a, b), axis) for axis in range(3) for a in (-0.5, 0.5) for b in (-0.5, 0.5)]
    positions = normals + np.array(spread + spread)
    assert epsilon(positions, normals, 0) == pytest.approx(1 / math.sqrt(5), rel=1e-9)
    assert volume(positions, normals, 0) == pytest.approx(23 / 45, rel=1e-9)


def test_few_contacts():
    assert resistance(np.zeros((0, 3)), np.zeros((0, 3)), 0.4).contacts == ()
    assert epsilon([(0, 0, 1)], [(0, 0, 1)], 0.4) == 0
    assert epsilon(CUBE[:3], CUBE[:3], 0.4) == 0  # pushes from one side only
    assert volume(CUBE[:1], CUBE[:1], 0.4) == 0


@given(st.integers(0, 10**6), st.tuples(*[st.floats(-1, 1)] * 3))
@settings(max_examples=10, deadline=None)
def test_a_moved_target_changes_epsilon_only(seed, offset):
    positions, normals = random_contacts(seed, 4)
    moved = positions + np.array(offset)
    assert volume(moved, normals, 0.4) == pytest.approx(volume(positions, normals, 0.4), rel=1e-6)
    assert (epsilon(moved, normals, 0.4) > 0) == (epsilon(positions, normals, 0.4) > 0)
    center = positions.mean(axis=0)
    here, there = quality(positions, normals, 0.4, center, 0.05), quality(moved, normals, 0.4, center + offset, 0.05)
    assert there.epsilon == pytest.approx(here.epsilon, rel=1e-6, abs=1e-10)
    scaled = quality(3 * positions, normals, 0.4, 3 * center, 0.15)
    assert scaled.epsilon == pytest.approx(here.epsilon, rel=1e-6, abs=1e-10)


@given(st.integers(0, 10**6), st.integers(3, 12), st.floats(0.1, 1.0))
@settings(max_examples=25, deadline=None)
def test_epsilon_is_the_least_support_of_the_hull(seed, count, friction):
    """No direction has a smaller support than epsilon, and the stated one has exactly that; its contacts are on it."""
    positions, normals = random_contacts(seed, count)
    points = points_of(positions, normals, friction)
    found = resistance(positions, normals, friction)
    support = points @ found.direction
    assert max(support.max(), 0) == pytest.approx(found.epsilon, abs=1e-12)
    assert set(found.contacts) == {i // 8 for i in np.flatnonzero(support > support.max() - 1e-10)}
    directions = np.random.default_rng(seed).normal(size=(2000, 6))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    if found.closed:
        assert (points @ directions.T).max(axis=0).min() >= found.epsilon - 1e-12


@given(st.integers(0, 10**6))
@settings(max_examples=15, deadline=None)
def test_closure_agrees_with_the_full_hull(seed):
    positions, normals = random_contacts(seed, 4)
    points = points_of(positions, normals, 0.4)
    planes = hull(points).planes
    nearest = -planes[:, -1].max()
    assert (nearest > 1e-12) == (epsilon(positions, normals, 0.4) > 0)
    if nearest > 1e-12:
        assert epsilon(positions, normals, 0.4) == pytest.approx(nearest, rel=1e-9)


def test_cones_have_unit_edges_at_the_angle_of_friction():
    _, normals = random_contacts(3, 20)
    normals = np.vstack([normals, CUBE])
    cones = friction_cones(normals, 0.4)
    assert np.linalg.norm(cones, axis=2) == pytest.approx(np.ones((26, 8)))
    assert np.einsum("nej,nj->ne", cones, normals) == pytest.approx(np.full((26, 8), math.cos(math.atan(0.4))))
    assert cones.mean(axis=1) == pytest.approx(normals * math.cos(math.atan(0.4)))


def test_hull_of_a_box_with_points_inside_and_on_it():
    box = np.array(list(itertools.product((-1, 1), (-2, 2), (-3, 3))), float)
    inside = [(0, 0, 0), (1, 0, 0), (1, 2, 0), (0, -2, 3), (-1, 0, 1)]
    found = hull(np.vstack([box, inside]))
    expected = [(-1, 0, 0, -1), (0, -1, 0, -2), (0, 0, -1, -3), (0, 0, 1, -3), (0, 1, 0, -2), (1, 0, 0, -1)]
    assert sorted(map(tuple, np.round(found.planes, 12) + 0)) == expected
    assert sorted(found.faces)[0] == (0, 1, 2, 3)
    assert sorted(map(len, found.faces)) == [4] * 6
    assert found.triangles.shape == (12, 3)
    corners = np.vstack([box, inside])[found.triangles]
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ij,ij->i", outward, corners.mean(axis=1)) > 0).all()
    assert found.volume == pytest.approx(48)


@pytest.mark.parametrize("flat", [[(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 0, 1)] * 5, [(1.0, 2, 3)]])
def test_flat_points_have_no_hull(flat):
    assert hull(np.array(flat, float)) is None
    assert nearest_facet(np.array(flat, float)) is None


@given(st.integers(0, 10**6), st.integers(2, 5), st.integers(3, 40))
@examples(40)
def test_hull_contains_its_points(seed, dimension, count):
    """Points of a coarse grid, so that many are on common planes or equal."""
    points = np.random.default_rng(seed).integers(0, 4, (count, dimension)).astype(float)
    found = hull(points)
    if found is None:
        assert np.linalg.matrix_rank(points - points[0]) < dimension
        return
    heights = points @ found.planes[:, :-1].T + found.planes[:, -1]
    assert heights.max() < 1e-8
    for face, height in zip(found.faces, heights.T, strict=True):
        assert np.linalg.matrix_rank(points[list(face)] - points[face[0]]) == dimension - 1
        assert np.abs(height[list(face)]).max() < 1e-8
    assert len({tuple(np.round(plane, 6)) for plane in found.planes}) == len(found.planes)


@given(st.integers(0, 10**6), st.integers(3, 16), st.floats(0.1, 1.0))
@settings(max_examples=15, deadline=None)
def test_agrees_with_qhull(seed, count, friction):
    spatial = pytest.importorskip("scipy.spatial")
    positions, normals = random_contacts(seed, count)
    other = spatial.ConvexHull(points_of(positions, normals, friction))
    nearest = -other.equations[:, -1].max()
    assert epsilon(positions, normals, friction) == pytest.approx(max(nearest, 0), abs=1e-14)
    if count < 8:
        assert volume(positions, normals, friction) == pytest.approx(other.volume, rel=1e-9)


def test_large_hulls_are_the_same_with_qhull(monkeypatch):
    pytest.importorskip("scipy.spatial")
    for points in (np.random.default_rng(5).normal(size=(400, 3)), points_of(*random_contacts(5, 14), 0.4)):
        with_qhull = hull(points)
        with monkeypatch.context() as patch:
            patch.setattr("ravemj.manipulation.grasping.hulls._SMALL", 10**9)
            alone = hull(points)
        assert with_qhull.volume == pytest.approx(alone.volume, rel=1e-9)
        assert sorted(with_qhull.faces) == sorted(alone.faces)
        if points.shape[1] == 3:
            corners = points[with_qhull.triangles]
            outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            assert (np.einsum("ij,ij->i", outward, corners.mean(axis=1)) > 0).all()


def test_eight_corners_cost_less_than_qhull():
    spatial = pytest.importorskip("scipy.spatial")

    def seconds(call):
        started = time.perf_counter()
        call()
        return time.perf_counter() - started

    points = points_of(CORNERS, SIDES, 0.4)
    ours = min(seconds(lambda: epsilon(CORNERS, SIDES, 0.4)) for _ in range(5))
    assert ours < min(seconds(lambda: spatial.ConvexHull(points)) for _ in range(5))


@given(st.integers(0, 10**6), st.sampled_from([1e-14, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7]), st.booleans())
@examples(40)
def test_nearly_coplanar_contacts(seed, noise, turned):
    """Points and normals as simulations give them: rounded anywhere, epsilon is that of the exact ones."""
    random = np.random.default_rng(seed)
    palm = np.array([(x, y, -0.02) for x in (-0.02, 0.02) for y in (-0.01, 0.01)])
    positions = np.vstack([CORNERS, palm])
    normals = np.vstack([SIDES, [(0, 0, -1)] * 4])
    if turned:
        R = np.linalg.qr(random.normal(size=(3, 3)))[0]
        positions, normals = positions @ R.T, normals @ R.T
    exact = epsilon(positions, normals, 0.4)
    near = epsilon(positions + noise * random.normal(size=(12, 3)), normals + noise * random.normal(size=(12, 3)), 0.4)
    assert near == pytest.approx(exact, abs=1e-5)
