"""Poses as tuples, against numpy."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravemj.core.transforms import (
    Pose,
    conjugate,
    multiply,
    normalize,
    rows_from_wxyz,
    wxyz_from_axis_angle,
    wxyz_from_rows,
)

parts = st.floats(-1, 1)
vectors = st.tuples(parts, parts, parts)
rotations = st.builds(wxyz_from_axis_angle, vectors, st.floats(-7, 7))
poses = st.builds(Pose, vectors, rotations)


@given(poses, poses, vectors)
def test_composition_is_matrix_product(a, b, point):
    np.testing.assert_allclose((a @ b).matrix(), a.matrix() @ b.matrix(), atol=1e-14)
    np.testing.assert_allclose(a.apply(point), (a.matrix() @ [*point, 1])[:3], atol=1e-14)


@given(poses)
def test_inverse(pose):
    np.testing.assert_allclose((pose @ pose.inverse()).matrix(), np.eye(4), atol=1e-14)


@given(st.floats(0, 1e-150), st.floats(-7, 7))
def test_short_axes_are_axes(length, angle):
    expected = wxyz_from_axis_angle((0, 1, 0), angle) if length else (1, 0, 0, 0)
    np.testing.assert_allclose(wxyz_from_axis_angle((0, length, 0), angle), expected, atol=1e-15)


@given(rotations)
def test_matrix_and_back(wxyz):
    back = wxyz_from_rows(rows_from_wxyz(wxyz))
    assert abs(sum(p * q for p, q in zip(wxyz, back, strict=True))) == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("axis", np.eye(3).tolist())
def test_half_turns_back_from_their_matrix(axis):
    wxyz = wxyz_from_axis_angle(axis, math.pi)
    assert wxyz_from_rows(rows_from_wxyz(wxyz)) == pytest.approx(wxyz)


def test_axes_of_subnormal_length_turn_as_longer_ones():
    short, long = (wxyz_from_axis_angle((0.0, size, size), 1.0) for size in (5e-324, 1.0))
    np.testing.assert_allclose(short, long, rtol=1e-15)


@given(rotations, rotations)
def test_multiply_is_matrix_product(a, b):
    product = np.array(rows_from_wxyz(a)) @ rows_from_wxyz(b)
    np.testing.assert_allclose(rows_from_wxyz(multiply(a, b)), product, atol=1e-14)
    np.testing.assert_allclose(multiply(a, conjugate(a)), (1, 0, 0, 0), atol=1e-14)


def test_right_handed():
    quarter = Pose((0, 0, 0), wxyz_from_axis_angle((0, 0, 2), math.pi / 2))
    assert quarter.apply((1, 0, 0)) == pytest.approx((0, 1, 0))


def test_quarter_and_half_turns_have_no_rounding():
    quarter = wxyz_from_axis_angle((1, 0, 0), math.pi / 2)
    assert quarter[0] == quarter[1]
    assert multiply(quarter, quarter)[0] == 0
    assert wxyz_from_axis_angle((0, 1, 0), math.pi) == (0, 0, 1, 0)


def test_no_axis_no_rotation():
    assert wxyz_from_axis_angle((0, 0, 0), 1.0) == (1, 0, 0, 0)
    with pytest.raises(ZeroDivisionError):
        normalize((0, 0, 0, 0))
