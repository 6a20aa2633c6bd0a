"""Geometry functions against independent mathematics: series, matrices, definitions."""

import copy
import math
import pickle

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import ravemj as rave
from ravemj import misc

parts = st.floats(-1, 1).map(lambda x: round(x, 6))
vectors = st.tuples(parts, parts, parts).map(np.array)
turns = vectors.map(lambda v: 3 * v)
quaternions = turns.map(rave.quatFromAxisAngle)
positions = vectors.map(lambda v: 10 * v)
poses = st.tuples(quaternions, positions).map(np.concatenate)


def exponential(matrix):
    """The matrix exponential, by its series."""
    result, term = np.eye(len(matrix)), np.eye(len(matrix))
    for n in range(1, 60):
        term = term @ matrix / n
        result = result + term
    return result


def cross_matrix(v):
    """The matrix that maps x to v x x."""
    return np.cross(np.eye(3), v)


def angle_between(q, r):
    return 2 * math.acos(min(1.0, abs(np.dot(q, r))))


@given(turns)
def test_turns_are_exponentials(turn):
    matrix = exponential(cross_matrix(turn))
    np.testing.assert_allclose(rave.rotationMatrixFromAxisAngle(turn), matrix, atol=1e-12)
    np.testing.assert_allclose(rave.matrixFromAxisAngle(turn)[:3, :3], matrix, atol=1e-12)
    np.testing.assert_allclose(rave.rotationMatrixFromQuat(rave.quatFromAxisAngle(turn)), matrix, atol=1e-12)


@given(turns, st.floats(0.1, 9), st.floats(-7, 7))
def test_axis_and_angle(axis, length, angle):
    assume(np.linalg.norm(axis) > 1e-3)
    axis = axis / np.linalg.norm(axis)
    for function in (rave.quatFromAxisAngle, rave.matrixFromAxisAngle, rave.rotationMatrixFromAxisAngle):
        np.testing.assert_allclose(function(length * axis, angle), function(axis=axis, angle=angle), atol=1e-13)
    q = rave.quatFromAxisAngle(axis, angle)
    assert angle_between(q, rave.quatFromAxisAngle(angle * axis)) < 1e-6


@given(turns)
def test_there_and_back(turn):
    q = rave.quatFromAxisAngle(turn)
    R = rave.rotationMatrixFromQuat(q)
    for back in (rave.quatFromRotationMatrix(R), rave.quatFromAxisAngle(rave.axisAngleFromQuat(2 * q))):
        np.testing.assert_allclose(np.outer(back, back), np.outer(q, q), atol=1e-12)
    shortest = rave.axisAngleFromRotationMatrix(R)
    assert np.linalg.norm(shortest) <= math.pi + 1e-12
    np.testing.assert_allclose(rave.rotationMatrixFromAxisAngle(shortest), R, atol=1e-7)


@given(quaternions, quaternions, vectors)
def test_quaternion_algebra(q, r, v):
    matrix = rave.rotationMatrixFromQuat
    np.testing.assert_allclose(matrix(rave.quatMultiply(q, r)), matrix(q) @ matrix(r), atol=1e-13)
    np.testing.assert_allclose(rave.quatMultiply(q, rave.quatInverse(q)), [1, 0, 0, 0], atol=1e-14)
    np.testing.assert_allclose(rave.quatRotate(q, v), matrix(q) @ v, atol=1e-14)
    columns = [rave.ExtractAxisFromQuat(q, i) for i in range(3)]
    np.testing.assert_allclose(np.column_stack(columns), matrix(q), atol=1e-14)


@given(st.lists(quaternions, min_size=1, max_size=4), quaternions, st.lists(vectors, min_size=1, max_size=4))
def test_batches_are_the_single_functions(rows, q, points):
    rows, points = np.array(rows), np.array(points)
    for got, single in [
        (rave.quatArrayTMult(rows, q), [rave.quatMultiply(row, q) for row in rows]),
        (rave.quatMultArrayT(q, rows), [rave.quatMultiply(q, row) for row in rows]),
        (rave.quatArrayTRotate(rows, points[0]), [rave.quatRotate(row, points[0]) for row in rows]),
        (rave.quatArrayRotate(rows.T, points[0]).T, [rave.quatRotate(row, points[0]) for row in rows]),
        (rave.quatRotateArrayT(q, points), [rave.quatRotate(q, point) for point in points]),
        (rave.rotationMatrixFromQArray(rows), [rave.rotationMatrixFromQuat(row) for row in rows]),
    ]:
        np.testing.assert_allclose(got, single, atol=1e-14)
    np.testing.assert_allclose(2 * rave.quatArrayTDist(q, rows), [angle_between(q, r) for r in rows], atol=1e-7)


@given(poses, poses, vectors)
def test_poses_are_matrices(p, r, point):
    matrix = rave.matrixFromPose
    np.testing.assert_allclose(matrix(rave.MultiplyPose(p, r)), matrix(p) @ matrix(r), atol=1e-12)
    np.testing.assert_allclose(matrix(rave.InvertPose(p)) @ matrix(p), np.eye(4), atol=1e-12)
    np.testing.assert_allclose(matrix(rave.poseFromMatrix(matrix(p))), matrix(p), atol=1e-12)
    np.testing.assert_allclose(rave.poseTransformPoint(p, point), (matrix(p) @ [*point, 1])[:3], atol=1e-12)
    np.testing.assert_allclose(rave.poseTransformPoints(p, [point]), [rave.poseTransformPoint(p, point)], atol=1e-12)
    np.testing.assert_allclose(rave.poseMultArrayT(p, [r]), [rave.MultiplyPose(p, r)], atol=1e-12)
    np.testing.assert_allclose(rave.InvertPoses([p, r]), [rave.InvertPose(p), rave.InvertPose(r)])
    moved = rave.transformPoints(matrix(p), [point])
    np.testing.assert_allclose(rave.transformInversePoints(matrix(p), moved), [point], atol=1e-12)


def test_no_poses():
    assert rave.matrixFromPoses([]) == []
    for function in (rave.poseFromMatrices, rave.InvertPoses):
        assert function([]).shape == (0, 7)


@given(quaternions, quaternions, st.floats(0, 1))
def test_slerp_turns_at_constant_velocity(q, r, t):
    whole = angle_between(q, r)
    between = rave.quatSlerp(q, r, t)
    assert np.linalg.norm(between) == pytest.approx(1)
    assert angle_between(q, between) == pytest.approx(t * whole, abs=1e-6)
    assert angle_between(between, r) == pytest.approx((1 - t) * whole, abs=1e-6)


@given(quaternions, quaternions, quaternions, quaternions)
def test_squad_starts_and_ends_at_the_outer_rotations(q0, q1, q2, q3):
    assert angle_between(rave.InterpolateQuatSquad(q0, q1, q2, q3, 0.0), q0) < 1e-6
    assert angle_between(rave.InterpolateQuatSquad(q0, q1, q2, q3, 1.0), q3) < 1e-6


def test_slerp_of_opposite_quaternions_the_long_way_is_the_same_rotation():
    q = rave.quatFromAxisAngle([0.3, 0.1, 0.2])
    assert angle_between(rave.quatSlerp(q, -q * (1 - 1e-16), 0.3, False), q) < 1e-6


@given(vectors, vectors)
def test_smallest_turn_between_directions(source, target):
    assume(np.linalg.norm(source) > 1e-2)
    assume(np.linalg.norm(target) > 1e-2)
    source, target = source / np.linalg.norm(source), target / np.linalg.norm(target)
    q = rave.quatRotateDirection(source, target)
    np.testing.assert_allclose(rave.quatRotate(q, source), target, atol=1e-9)
    assert np.linalg.norm(rave.axisAngleFromQuat(q)) == pytest.approx(
        math.atan2(np.linalg.norm(np.cross(source, target)), source @ target), abs=1e-9
    )


@pytest.mark.parametrize("direction", [(1, 0, 0), (-1, 0, 0), (0, 3, 0), (0, 0, -2), (1, 1, 1)])
def test_half_turn_between_opposite_directions(direction):
    q = rave.quatRotateDirection(direction, np.negative(direction))
    np.testing.assert_allclose(rave.quatRotate(q, direction), np.negative(direction), atol=1e-14)


@given(vectors, quaternions, st.floats(-3, 3))
def test_normalized_axis_rotation_is_the_closest_to_none(axis, q, other):
    assume(np.linalg.norm(axis) > 1e-2)
    angle, best = rave.normalizeAxisRotation(axis, q)
    np.testing.assert_allclose(best, rave.quatMultiply(rave.quatFromAxisAngle(axis, angle), q), atol=1e-14)
    assert abs(rave.quatMultiply(rave.quatFromAxisAngle(axis, other), q)[0]) <= best[0] + 1e-12


@given(st.lists(quaternions, min_size=1, max_size=4))
def test_normalized_z_rotations(rows):
    normalized, angles = rave.normalizeZRotation(rows)
    for row, best, angle in zip(rows, normalized, angles, strict=True):
        np.testing.assert_allclose(rave.quatMultiply(rave.quatFromAxisAngle([0, 0, angle]), best), row, atol=1e-14)
        assert best[0] == pytest.approx(rave.normalizeAxisRotation([0, 0, 1], row)[1][0], abs=1e-14)


@given(positions, positions, vectors)
def test_lookat(target, camera, up):
    T = rave.transformLookat(target, camera, up)
    np.testing.assert_allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3), atol=1e-7)
    assert np.linalg.det(T) == pytest.approx(1)
    np.testing.assert_array_equal(T[:3, 3], camera)
    forward = target - camera
    if np.linalg.norm(forward) > 1e-3:
        np.testing.assert_allclose(T[:3, 2], forward / np.linalg.norm(forward), atol=1e-9)
        if np.linalg.norm(np.cross(up, T[:3, 2])) > 1.01e-4:  # else another y axis is taken
            assert T[:3, 1] @ up >= -1e-9


def test_lookat_takes_another_axis_for_an_up_that_is_too_short():
    T = rave.transformLookat([0, 0, 0], [0, 10, 10], [0, 0, 1e-5])
    np.testing.assert_allclose(T[:3, 1], np.array([0, 1, -1]) / np.sqrt(2), atol=1e-12)


@given(poses, poses)
def test_distance_of_poses(p, r):
    here = (p[4:] - r[4:]) @ (p[4:] - r[4:])
    apart = 2 - 2 * abs(p[:4] @ r[:4])
    assert rave.ComputePoseDistSqr(p, r, 3.0) == pytest.approx(here + 3 * apart, abs=1e-12)


def test_texts_hold_all_digits():
    pose = np.array([0.6, 0, 0.8, 0, 1 / 3, -2e-7, 3e5])
    np.testing.assert_allclose([float(word) for word in rave.poseSerialization(pose).split()], pose, rtol=1e-15)
    columns = [float(word) for word in rave.matrixSerialization(pose).split()]
    np.testing.assert_allclose(np.reshape(columns, (4, 3)).T, rave.matrixFromPose(pose)[:3], rtol=1e-15)


@given(positions, st.floats(0.5, 5), quaternions)
def test_circle_and_sphere_through_points(centre, radius, q):
    angles = np.array([0, 1, 2.5, 4, 5])
    flat = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    found, found_radius, _ = rave.fitCircle(flat + centre[:2])
    np.testing.assert_allclose([*found, found_radius], [*centre[:2], radius], atol=1e-9)
    points = rave.quatRotateArrayT(q, np.column_stack([flat, np.zeros(5)])) + centre
    found, found_radius, _ = rave.fitCircle(points)
    np.testing.assert_allclose([*found, found_radius], [*centre, radius], atol=1e-9)
    found, found_radius, _ = rave.fitSphere(radius * np.vstack([np.eye(3), -np.eye(3)]) + centre)
    np.testing.assert_allclose([*found, found_radius], [*centre, radius], atol=1e-9)


def test_crossing_lines():
    point, distance = rave.intersectSegments([[0, 0, 0], [1, 0, 0]], [[3, -1, 1], [3, 1, 1]])
    np.testing.assert_allclose(point, [3, 0, 0.5])
    assert abs(distance) == 1
    with pytest.raises(rave.ArgumentError, match="parallel"):
        rave.intersectSegments([[0, 0, 0], [1, 0, 0]], [[0, 1, 0], [2, 1, 0]])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rave.matrixFromQuat([2, 0, 0, 0]), "length 2"),
        (lambda: rave.matrixFromQuat([math.nan, 0, 0, 0]), "length nan"),
        (lambda: rave.matrixFromAxisAngle("abc"), "should be numbers"),
        (rave.quatFromAxisAngle, "is missing"),
        (lambda: rave.ExtractAxisFromQuat([1, 0, 0, 0], 3), "iaxis"),
        (lambda: rave.transformPoints(np.ones((2, 4)), []), "T: has shape"),
        (lambda: rave.fitCircle([[0, 0], [1, 1]]), "from 3 up"),
        (lambda: rave.OrientedBox([0, 0, 0, 0, 1, 2, 3]), "zero"),
        (lambda: rave.RaveGetAffineDOF(24), "more than one kind"),
        (lambda: rave.RaveGetAffineDOFFromIndex(3, 2), "has 2 values"),
        (lambda: rave.RaveGetIndexFromAffineDOF(3, 4), "not among"),
    ],
)
def test_wrong_arguments(call, message):
    with pytest.raises(rave.ArgumentError, match=message):
        call()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rave.quatMultiply([1, 0, 0], [1, 0, 0, 0]), r"quat0: has shape \(3,\)"),
        (lambda: rave.matrixFromQuat([-0.95, 0.19, 1.93]), r"quat: has shape \(3,\)"),
        (lambda: rave.matrixFromPose([[1, 0, 0, 0, 0, 0, 0]]), r"should have shape \(7,\)"),
        (lambda: rave.poseFromMatrix(np.eye(3)), r"should have shape \(4, 4\)"),
        (lambda: rave.poseTransformPoints([1, 0, 0, 0, 0, 0, 0], [1, 2, 3]), "points: has shape"),
        (lambda: rave.RaveGetTransformFromAffineDOFValues([1], 3), r"values: has shape \(1,\)"),
    ],
)
def test_wrong_shapes_raise_pythons_own_error(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_quaternions_of_other_lengths():  # as OpenRAVE answers: random-api-129, random-api-76
    one, other = [1.93, 0.97, 1.76, 1.43, -1.6, -1.65, 0.77], [1.59, -1.3, -0.35, -1.1, 0.57, 0.04, -0.64]
    product = [0.8834747841789625, -0.3255684609745355, 0.18037593235825877, 0.2845030860368598]
    np.testing.assert_allclose(rave.poseMult(one, other), [*product, -13.100058, 2.418414, 3.359334], atol=1e-12)
    between = rave.quatSlerp([-0.84, -1.81, 1.33, 0.99], [-1.53, 0.55, 1.6, -1.59], 0.3)
    expected = [-1.0867524539955749, -1.12932134983956, 1.4614683401334139, 0.21139370138780755]
    np.testing.assert_allclose(between, expected, atol=1e-12)
    with pytest.raises(rave.ArgumentError, match="zero"):
        rave.poseMult(np.zeros(7), other)


# ---------------------------------------------------------------------------------------------------- boxes


def test_values_pickle_copy_and_print():
    box = rave.OrientedBox([0.6, 0, 0.8, 0, 1, 2, 3], [0.5, 0.25, 0.125])
    for value in (rave.Ray([1, 2, 3], [0, 0, 2]), rave.AABB([1, 2, 3], [4, 5, 6]), box):
        for twin in (pickle.loads(pickle.dumps(value, 2)), copy.deepcopy(value)):
            assert repr(twin) == repr(value) != object.__repr__(value)
    aabb = rave.AABB([1, 2, 3], [4, 5, 6])
    assert repr(eval(repr(aabb), vars(rave))) == repr(aabb)
    assert repr(eval(repr(box), vars(rave))) == repr(box)
    assert {key: list(value) for key, value in aabb.toDict().items()} == {"pos": [1, 2, 3], "extents": [4, 5, 6]}
    assert str(rave.Ray([1, 2, 3], [0, 0, 2])).startswith("<1.000000000000000e+00 2.0")
    assert set(box.toDict()) == {"transform", "extents"}


def test_values_are_copies():
    given = np.array([1.0, 2, 3])
    ray = rave.Ray(given, given)
    given[0] = ray.pos()[1] = 9
    assert ray.pos().tolist() == ray.dir().tolist() == [1, 2, 3]


corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T


def corners_of(obb):
    return rave.transformPoints(obb.transform(), corners * obb.extents())


sizes = st.tuples(*[st.floats(0.1, 2)] * 3)
oriented = st.builds(rave.OrientedBox, poses.map(lambda p: np.concatenate([p[:4], p[4:] / 5])), sizes)


@given(oriented)
def test_box_around_a_turned_box(obb):
    around, points = rave.AABBFromOrientedBox(obb), corners_of(obb)
    np.testing.assert_allclose(around.pos() + around.extents(), points.max(axis=0), atol=1e-12)
    np.testing.assert_allclose(around.pos() - around.extents(), points.min(axis=0), atol=1e-12)


@given(oriented, oriented)
def test_boxes_collide_as_one_seen_from_the_other(first, second):
    together = rave.CheckOBBCollision(first, second)
    assert together == rave.CheckOBBCollision(second, first)
    inner = rave.transformInversePoints(first.transform(), corners_of(second))
    if (np.abs(inner) <= first.extents()).all(axis=1).any():
        assert together  # a corner of one in the other
    if not rave.CheckAABBCollision(rave.AABBFromOrientedBox(first), rave.AABBFromOrientedBox(second)):
        assert not together
    relative = np.linalg.inv(first.transform()) @ second.transform()
    moved = rave.OrientedBox(relative, second.extents())
    assert rave.CheckBoxAtOriginAndOBBCollision(first.extents(), moved) == together


def test_crossed_edges_separate_boxes():
    first = rave.OrientedBox(rave.matrixFromAxisAngle([0, 0, math.pi / 4]), [1, 1, 1])
    tilted = rave.matrixFromAxisAngle([math.pi / 4, 0, 0])
    tilted[:3, 3] = [0, 2.9, 0]
    assert not rave.CheckOBBCollision(first, rave.OrientedBox(tilted, [1, 1, 1]))
    tilted[:3, 3] = [0, 2.8, 0]
    assert rave.CheckOBBCollision(first, rave.OrientedBox(tilted, [1, 1, 1]))


def test_meshes_keep_copies():
    vertices = np.eye(3)
    mesh = rave.TriMesh(vertices, [[0, 1, 2]])
    vertices[0, 0] = 5
    assert mesh.vertices.tolist() == np.eye(3).tolist()
    assert mesh.indices.dtype.kind == "i"
    twin = pickle.loads(pickle.dumps(mesh, 2))
    assert repr(twin) == repr(mesh) == "TriMesh([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],[[0, 1, 2]])"
    assert (str(mesh), str(rave.TriMesh())) == ("<trimesh: verts 3, tris=1>", "<trimesh: verts 0, tris=0>")
    assert mesh.toDict()["indices"].tolist() == [[0, 1, 2]]


# ---------------------------------------------------------------------------------------------------- affine DOFs

masks = st.builds(lambda xyz, kind: xyz | kind, st.integers(0, 7), st.sampled_from([0, 8, 16, 32]))


@given(masks)
def test_parts_and_values_of_masks(mask):
    dof = rave.RaveGetAffineDOF(mask)
    owners = [rave.RaveGetAffineDOFFromIndex(mask, index) for index in range(dof)]
    assert sum(set(owners)) == mask
    for owner in owners:
        assert rave.RaveGetIndexFromAffineDOF(mask, owner) == owners.index(owner)


@given(poses, masks, vectors)
def test_affine_values_there_and_back(pose, mask, axis):
    assume(np.linalg.norm(axis) > 1e-2)
    values = rave.RaveGetAffineDOFValuesFromTransform(pose, mask, axis)
    back = rave.RaveGetTransformFromAffineDOFValues(values, mask, axis, pose)
    if mask & (16 | 32):
        np.testing.assert_allclose(back, rave.matrixFromPose(pose), atol=1e-12)
    np.testing.assert_allclose(back[:3, 3], pose[4:], atol=1e-12)
    again = rave.RaveGetAffineDOFValuesFromTransform(back, mask, axis)
    if not mask & 32:
        np.testing.assert_allclose(
            rave.RaveGetTransformFromAffineDOFValues(again, mask, axis),
            rave.RaveGetTransformFromAffineDOFValues(values, mask, axis),
            atol=1e-7,
        )


def test_affine_values_replace_their_parts_only():
    T = rave.matrixFromPose([0.6, 0.8, 0, 0, 1, 2, 3])
    moved = rave.RaveGetTransformFromAffineDOFValues([7], rave.DOFAffine.Y, transform=T)
    np.testing.assert_allclose(moved, rave.matrixFromPose([0.6, 0.8, 0, 0, 1, 7, 3]))
    turned = rave.RaveGetTransformFromAffineDOFValues([0.5], rave.DOFAffine.RotationAxis, [0, 2, 0], T)
    np.testing.assert_allclose(turned[:3, :3], rave.rotationMatrixFromAxisAngle([0, 0.5, 0]))
    np.testing.assert_allclose(turned[:3, 3], [1, 2, 3])


# ---------------------------------------------------------------------------------------------------- misc


def signed_volume(vertices, triangles):
    return sum(np.linalg.det(vertices[list(triangle)]) for triangle in triangles) / 6


def test_sphere_is_closed_and_seen_from_outside():
    vertices, triangles = misc.ComputeGeodesicSphereMesh(2.0, 3)
    assert (len(vertices), len(triangles)) == (2 + 10 * 4**3, 20 * 4**3)
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 2)
    assert signed_volume(vertices, triangles) == pytest.approx(4 / 3 * math.pi * 8, rel=0.02)
    edges = [tuple(edge) for a, b, c in triangles for edge in ((a, b), (b, c), (c, a))]
    assert len(set(edges)) == len(edges)
    assert {edge[::-1] for edge in edges} == set(edges)


def test_nearest_next():
    assert misc.TSP([[0.0], [5], [1], [4], [2]], lambda a, b: abs(a - b)[0]).ravel().tolist() == [0, 1, 2, 4, 5]
