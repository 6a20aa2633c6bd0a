"""Antipodal points on shapes with known answers: boxes, cylinders, wedges, tubes."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import ravemj
from ravemj.manipulation.grasping.antipodal import Jaws, Pair, is_antipodal, pairs, tool_poses


def on_surface(body, rays):
    """Return the first hits of rays as rows of points and normals."""
    hit, rows = body.GetEnv().CheckCollisionRays(rays, body)
    assert hit.all()
    return rows


def cast_at(body):
    return lambda rays: body.GetEnv().CheckCollisionRays(rays, body)


def added(make):
    env = ravemj.Environment()
    body = ravemj.RaveCreateKinBody(env, "")
    body.SetName("target")
    make(body)
    env.Add(body)
    return body


def box(*half):
    return added(lambda body: body.InitFromBoxes([[0, 0, 0, *half]], True))


def prism(angle, top=0.01, height=0.04, depth=0.03):
    """Return a wedge: its sides at +x and -x lean by an angle, so that it is wider below."""
    low = top + height * math.tan(angle)
    corners = [(s * x, y, z) for z, x in ((0, low), (height, top)) for s in (-1, 1) for y in (-depth, depth)]
    faces = [
        (0, 1, 3),
        (0, 3, 2),
        (4, 6, 7),
        (4, 7, 5),
        (0, 4, 5),
        (0, 5, 1),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
    ]
    faces += [(1, 5, 7), (1, 7, 3)]
    mesh = ravemj.TriMesh(np.array(corners), np.array(faces))
    return added(lambda body: body.InitFromTrimesh(mesh, True))


@settings(deadline=None, max_examples=15)
@given(st.lists(st.floats(0.005, 0.06), min_size=3, max_size=3), st.floats(0.05, 0.95))
def test_a_box_is_held_across_each_side_that_fits(half, friction):
    body, width = box(*half), 0.08
    rows = on_surface(body, [[*(-0.2 * axis), *(0.4 * axis)] for axis in np.eye(3)])
    for row, side in zip(rows, half, strict=True):
        assume(abs(2 * side - width) > 1e-4)
        (pair,) = pairs(row, cast_at(body), friction, width)
        assert (pair.reason == "") == (2 * side < width)
        if not pair.reason:
            np.testing.assert_allclose(pair.second, -pair.first, atol=1e-9)
        else:
            assert pair.reason == "too wide"


@settings(deadline=None, max_examples=15)
@given(st.floats(0.02, 0.6), st.floats(0.05, 0.8))
def test_a_wedge_is_held_if_the_tangent_of_its_half_angle_is_below_the_friction(angle, friction):
    assume(abs(math.tan(angle) - friction) > 0.01)
    body = prism(angle)
    rows = on_surface(body, [[0.2, 0, 0.02, -0.4, 0, 0]])
    found = pairs(rows, cast_at(body), friction, 0.2)
    held = [pair for pair in found if not pair.reason]
    assert bool(held) == (math.tan(angle) < friction)
    assert all(pair.reason == "not closed" for pair in found if pair.reason)


@pytest.mark.parametrize("offset", [0.0, 0.01, 0.015, 0.019])
def test_chords_of_a_cylinder_through_its_axis_are_held(offset):
    """The line along the normal goes through the axis, wherever the ray hits."""
    body = added(lambda body: body.InitFromGeometries([cylinder(0.02, 0.1)]))
    rows = on_surface(body, [[0.2, offset, 0.01, -0.4, 0, 0]])
    (pair,) = pairs(rows, cast_at(body), 0.1, 0.08)
    assert pair.reason == ""
    np.testing.assert_allclose(pair.first[:2], -pair.second[:2], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(pair.second - pair.first), 0.04, atol=1e-6)


def cylinder(radius, height):
    info = ravemj.KinBody.GeometryInfo()
    info._type = ravemj.GeometryType.Cylinder
    info._vGeomData = [radius, height]
    return info


def test_a_tube_is_held_by_its_wall_and_from_both_sides():
    walls = [[s * 0.03, 0, 0, 0.002, 0.03, 0.05] for s in (-1, 1)]
    body = added(lambda body: body.InitFromBoxes(walls, True))
    rows = on_surface(body, [[0.2, 0, 0, -0.4, 0, 0]])
    found = pairs(rows, cast_at(body), 0.4, 0.08)
    assert [pair.reason for pair in found] == ["", ""]
    widths = [np.linalg.norm(pair.second - pair.first) for pair in found]
    np.testing.assert_allclose(sorted(widths), [0.004, 0.064], atol=1e-9)


@given(st.floats(-1.4, 1.4), st.floats(-1.4, 1.4), st.floats(0.01, 2.0))
def test_both_cones_have_to_hold_the_line(first, second, friction):
    limit = math.atan(friction)
    assume(abs(abs(first) - limit) > 1e-6 and abs(abs(second) - limit) > 1e-6)
    one = np.array([[0, 0, 0, -math.cos(first), math.sin(first), 0]])
    other = np.array([[0.05, 0, 0, math.cos(second), 0, math.sin(second)]])
    assert is_antipodal(one, other, friction)[0] == (abs(first) < limit and abs(second) < limit)


@pytest.mark.parametrize("middle", [0.0, 0.003])
def test_the_jaws_are_around_the_middle(middle):
    pair = Pair(np.array([0.1, 0.02, 0.03]), np.array([0.1, -0.02, 0.03]), "")
    jaws = Jaws(axis=np.array([0.0, 1, 0]), approach=np.array([0.0, 0, 1]), middle=middle, width=0.08)
    poses = tool_poses(pair, jaws, rolls=6)
    assert len({tuple((T[:3, 2]).round(9)) for T in poses}) == 6
    for T in poses:
        np.testing.assert_allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3), atol=1e-12)
        assert np.linalg.det(T[:3, :3]) == pytest.approx(1)
        np.testing.assert_allclose((T @ [0, middle, 0, 1])[:3], [0.1, 0, 0.03], atol=1e-12)
        assert abs(T[:3, 1] @ [0, 1, 0]) == pytest.approx(1)
