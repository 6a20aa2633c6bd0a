"""Contact points of pairs: corners of faces, ends of lines, points; for all shapes and whatever moves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ravemj
from ravemj import CollisionOptions, CollisionReport, matrixFromAxisAngle, matrixFromPose
from ravemj.engine.collision.patches import spread
from ravemj.engine.collision.shapes import Contact

CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
TRIANGLE_CORNERS = ["013", "032", "467", "475", "045", "051", "237", "276", "026", "064", "157", "173"]
CUBE_TRIANGLES = np.array([[int(corner) for corner in triangle] for triangle in TRIANGLE_CORNERS])
DEPTH = 1e-5


@pytest.fixture
def env():
    env = ravemj.Environment()
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.Contacts)
    return env


def body(env, xml, *, joint=False):
    name = f"body{len(env.GetBodies())}"
    more = (
        ""
        if not joint
        else (
            "<Body name='rest'/><Joint name='j' type='slider'><Body>rest</Body><Body>b</Body><axis>0 0 1</axis></Joint>"
        )
    )
    env.LoadData(f"<KinBody name='{name}'><Body name='b'>{xml}</Body>{more}</KinBody>")
    return env.GetKinBody(name)


def box(env, half, **named):
    return body(env, f"<Geom type='box'><extents>{half[0]} {half[1]} {half[2]}</extents></Geom>", **named)


def mesh_box(env, half):
    made = ravemj.RaveCreateKinBody(env, "")
    made.InitFromTrimesh(ravemj.TriMesh(CUBE * half, CUBE_TRIANGLES), True)
    made.SetName(f"body{len(env.GetBodies())}")
    env.Add(made)
    return made


def contacts(env, one, other):
    report = CollisionReport()
    assert env.CheckCollision(one, other, report)
    points = [contact.pos for contact in report.contacts]
    return np.array(points), np.array([contact.norm for contact in report.contacts]), report


def place(one, *position):
    one.SetTransform(matrixFromPose([1, 0, 0, 0, *position]))


def corners(points):
    return sorted({tuple((np.round(point, 4) + 0.0).tolist()) for point in points})


FACES = [(0.02, y, z) for y in (-0.01, 0.01) for z in (-0.02, 0.02)]


@pytest.mark.parametrize("first", [box, mesh_box])
@pytest.mark.parametrize("second", [box, mesh_box])
def test_two_faces_give_the_corners_of_their_overlap(env, first, second):
    one, other = first(env, (0.02, 0.03, 0.02)), second(env, (0.005, 0.01, 0.03))
    place(other, 0.025 - DEPTH, 0, 0)
    points, normals, report = contacts(env, one, other)
    assert corners(points) == FACES
    np.testing.assert_allclose(normals, [[-1, 0, 0]] * 4, atol=1e-6)  # from the second to the first
    assert [contact.depth for contact in report.contacts] == pytest.approx([DEPTH] * 4, abs=1e-7)
    points, normals, _ = contacts(env, other, one)
    assert corners(points) == FACES
    np.testing.assert_allclose(normals, [[1, 0, 0]] * 4, atol=1e-6)


@pytest.mark.parametrize("moves", [(False, False), (True, False), (False, True), (True, True)])
def test_it_does_not_matter_whether_joints_move_the_bodies(env, moves):
    one, other = box(env, (0.02, 0.03, 0.02), joint=moves[0]), box(env, (0.005, 0.01, 0.03), joint=moves[1])
    place(other, 0.025 - DEPTH, 0, 0)
    assert corners(contacts(env, one, other)[0]) == FACES
    assert env.CheckCollision(one, other)
    place(other, 0.025 + DEPTH, 0, 0)
    assert not env.CheckCollision(one, other)


@pytest.mark.parametrize("moves", [(False, False), (True, False), (True, True)])
def test_contacts_are_those_of_the_present_poses(env, moves):
    one, other = box(env, (0.02, 0.03, 0.02), joint=moves[0]), box(env, (0.005, 0.01, 0.03), joint=moves[1])
    for depth in (DEPTH, 3 * DEPTH, 2 * DEPTH):
        place(other, 0.025 - depth, 0, 0)
        for _ in range(2):
            report = contacts(env, one, other)[2]
            assert [contact.depth for contact in report.contacts] == pytest.approx([depth] * 4, abs=1e-7)
        assert env.CheckCollision(other)


def test_a_cylinder_on_its_side_touches_along_a_line_and_a_sphere_in_a_point(env):
    floor = box(env, (0.1, 0.1, 0.1))
    rod = body(env, "<Geom type='cylinder'><radius>.02</radius><height>.08</height></Geom>")  # along y
    place(rod, 0, 0, 0.12 - DEPTH)
    points, normals, _ = contacts(env, rod, floor)
    np.testing.assert_allclose(sorted(points[:, 1].tolist()), [-0.04, 0.04], atol=1e-4)
    np.testing.assert_allclose(normals, [[0, 0, 1]] * 2, atol=1e-6)
    place(rod, 0, 0, 1)
    ball = body(env, "<Geom type='sphere'><radius>.02</radius></Geom>")
    place(ball, 0.03, 0, 0.12 - DEPTH)
    points, normals, _ = contacts(env, ball, floor)
    np.testing.assert_allclose(points, [[0.03, 0, 0.1]], atol=1e-4)
    np.testing.assert_allclose(normals, [[0, 0, 1]], atol=1e-6)


@settings(max_examples=20)
@given(st.lists(st.floats(-3, 3), min_size=6, max_size=6))
def test_contacts_turn_with_the_world(numbers):
    env = ravemj.Environment()
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.Contacts)
    one, other = box(env, (0.02, 0.03, 0.02)), box(env, (0.005, 0.01, 0.03))
    T = matrixFromAxisAngle(numbers[:3])
    T[:3, 3] = numbers[3:]
    one.SetTransform(T)
    other.SetTransform(T @ matrixFromPose([1, 0, 0, 0, 0.025 - DEPTH, 0, 0]))
    points, normals, _ = contacts(env, one, other)
    back = (points - T[:3, 3]) @ T[:3, :3]
    assert corners(np.round(back, 3)) == FACES
    np.testing.assert_allclose(normals @ T[:3, :3], [[-1, 0, 0]] * len(points), atol=1e-3)


def test_concave_meshes_have_a_contact_for_each_pair_of_triangles(env):
    floor = box(env, (0.5, 0.5, 0.1))
    table = ravemj.RaveCreateKinBody(env, "")
    legs = [CUBE * 0.05 + [x, y, -0.15] for x in (-0.3, 0.3) for y in (-0.3, 0.3)]
    vertices = np.vstack([CUBE * [0.4, 0.4, 0.1], *legs])
    table.InitFromTrimesh(ravemj.TriMesh(vertices, np.vstack([CUBE_TRIANGLES + 8 * leg for leg in range(5)])), True)
    table.SetName("table")
    env.Add(table)
    place(table, 0, 0, 0.3 - DEPTH)
    points, normals, _ = contacts(env, table, floor)
    assert len({(x > 0, y > 0) for x, y, _ in points.tolist()}) == 4  # all legs
    np.testing.assert_allclose(points[:, 2], 0.1, atol=1e-4)
    np.testing.assert_allclose(normals, [[0, 0, 1]] * len(points), atol=1e-3)


def test_of_many_contacts_the_farthest_apart_stay_deepest_first():
    angles = np.linspace(0, 2 * np.pi, 50, endpoint=False)
    ring = [Contact(np.array([np.cos(a), np.sin(a), 0]), np.array([0, 0, 1.0]), a) for a in angles.tolist()]
    chosen = spread(ring + ring)
    assert len(chosen) == 8
    assert chosen[0].depth == ring[-1].depth
    assert [contact.depth for contact in chosen] == sorted((contact.depth for contact in chosen), reverse=True)
    assert np.diff(np.sort([contact.depth for contact in chosen])).max() < 1.6
    assert spread([]) == []


def test_one_point_for_pairs_that_are_deep_in_each_other_without_a_direction(env):
    one, other = box(env, (1, 1, 1)), box(env, (1, 1, 1))
    points, normals, _ = contacts(env, one, other)
    assert np.isfinite(points).all()
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1)


def test_contacts_of_an_end_effector_are_those_of_the_given_pose(env):
    env.LoadData(
        "<Robot name='arm'><KinBody><Body name='base'/><Body name='hand'><offsetfrom>base</offsetfrom>"
        "<Geom type='box'><extents>.02 .03 .02</extents></Geom></Body><Joint name='j' type='slider'><Body>base</Body>"
        "<Body>hand</Body><axis>1 0 0</axis></Joint></KinBody><Manipulator name='m'><base>base</base>"
        "<effector>hand</effector></Manipulator></Robot>"
    )
    wall, arm = box(env, (0.005, 0.01, 0.03)), env.GetRobot("arm")
    place(wall, 0.025 - DEPTH, 0, 0)
    report = CollisionReport()
    assert env.CheckCollision(arm, report)
    assert report.contacts[0].depth == pytest.approx(DEPTH, abs=1e-7)
    T = matrixFromPose([1, 0, 0, 0, 2 * DEPTH, 0, 0])
    assert arm.GetActiveManipulator().CheckEndEffectorCollision(T, report)
    assert report.contacts[0].depth == pytest.approx(3 * DEPTH, abs=1e-7)
