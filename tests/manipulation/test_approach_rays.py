"""Grids of approach rays, and directions on the unit sphere."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravemj.errors import ArgumentError
from ravemj.manipulation.grasping import rays

HALF = np.array([0.02, 0.03, 0.02])


@pytest.mark.parametrize(("delta", "lines"), [(0.01, (5, 7, 5)), (0.02, (3, 3, 3)), (0.04, (1, 1, 1))])
def test_lines_that_meet_a_box(delta, lines):
    a, b, c = (int((np.abs(rays.grid_lines(half + 0.01, delta)) < half + 1e-9).sum()) for half in HALF)
    assert (a, b, c) == lines
    around = rays.box_rays(np.zeros(3), HALF, delta)
    met = 0
    for axis in range(3):
        others = [i for i in range(3) if i != axis]
        along = np.abs(around.ways[:, axis]) > 0
        met += int((np.abs(around.origins[along][:, others]) < HALF[others] + 1e-9).all(axis=1).sum())
    assert met == 2 * (a * b + b * c + a * c)


@given(st.tuples(*[st.floats(0.01, 0.2)] * 3), st.tuples(*[st.floats(-1, 1)] * 3))
def test_rays_of_a_box_cross_it(half, center):
    half, center = np.array(half), np.array(center)
    around = rays.box_rays(center, half, 0.03)
    assert np.abs((around.origins - center) / (half + 0.01)).max() <= 1 + 1e-9
    axis = np.abs(around.ways).argmax(axis=1)
    rows = np.arange(len(axis))
    assert (np.sign((around.origins - center)[rows, axis]) == -np.sign(around.ways[rows, axis])).all()


@pytest.mark.parametrize("level", [0, 1, 2, 3])
def test_directions_are_spread_evenly(level):
    found = rays.directions(level)
    assert found.shape == (12 * 4**level, 3)
    assert np.linalg.norm(found, axis=1) == pytest.approx(np.ones(len(found)))
    assert found.mean(axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    assert found.T @ found / len(found) == pytest.approx(np.eye(3) / 3, abs=0.04)
    cosines = found @ found.T - 2 * np.eye(len(found))
    assert np.arccos(cosines.max(axis=1)).min() > 0.5 * np.sqrt(4 * np.pi / len(found))


def test_levels():
    assert [rays.level_of(delta) for delta in (2, 0.5, 0.4, 0.1)] == [0, 1, 1, 3]
    with pytest.raises(ArgumentError, match="above 0"):
        rays.level_of(0)


def test_directions_around_normals():
    hits = np.array([[0, 0, 0, 0, 0, 1], [1, 2, 3, 1, 0, 0], [0, 1, 0, 0, 0, -1.0]])
    around = rays.spread(hits, 0.5, 0.4)
    assert around.shape == (12, 6)
    cosines = np.einsum("ij,ij->i", around[:, 3:], np.repeat(hits[:, 3:], 4, axis=0))
    assert (cosines > np.cos(0.5)).all()
    assert around[:, :3] == pytest.approx(np.repeat(hits[:, :3], 4, axis=0))
    assert rays.spread(hits, 0, 0.4) is hits
    assert rays.spread(hits, 0.1, 0.4) is hits


def test_circles_lie_in_their_plane():
    axis = np.array([1, 2, -2]) / 3
    around = rays.circle_rays([1, 0, 0], 5 * axis, 0.3, 0.1)
    assert len(around.origins) == 63
    assert np.abs((around.origins - [1, 0, 0]) @ axis).max() < 1e-12
    assert around.origins + around.ways == pytest.approx(np.tile([1.0, 0, 0], (63, 1)))


@pytest.mark.parametrize(
    "call",
    [
        lambda: rays.box_rays(np.zeros(3), HALF, 0),
        lambda: rays.box_rays(np.zeros(3), HALF, 1e-5),
        lambda: rays.plane_rays([0, 0, 1], [1, 0, 0], [2, 0, 0], 0.1),
        lambda: rays.plane_rays([0, 0, 1], [1, 0, 0], [0, 0, 0], 0.1),
        lambda: rays.circle_rays([0, 0, 1], [1, 0, 0], 1, 0),
    ],
)
def test_bad_grids(call):
    with pytest.raises(ArgumentError, match="expected"):
        call()
