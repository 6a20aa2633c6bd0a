"""Groups of geometries that collision checkers look at in place of those of the links."""

import numpy as np
import pytest

import ravemj
from ravemj import KinBody


def ball(radius, name=""):
    info = KinBody.GeometryInfo()
    info._type, info._vGeomData, info._name = ravemj.GeometryType.Sphere, [radius], name
    return info


def body(env, name, x, group=0.0):
    """A ball of radius 0.1 at x, with a group ``padded`` of another radius where one is given."""
    made = ravemj.RaveCreateKinBody(env, "")
    made.InitFromGeometries([ball(0.1, "own")])
    made.SetName(name)
    if group:
        made.GetLinks()[0].SetGroupGeometries("padded", [ball(group, "wide")])
    env.Add(made)
    made.SetTransform([1, 0, 0, 0, x, 0, 0])
    return made


@pytest.fixture
def scene():
    env = ravemj.Environment()
    yield env, body(env, "left", 0.0, 0.4), body(env, "right", 0.5, 0.2)
    env.Destroy()


def test_a_checker_looks_at_a_group(scene):
    env, left, right = scene
    checker, report = env.GetCollisionChecker(), ravemj.CollisionReport()
    assert not env.CheckCollision(left)
    checker.SetGeometryGroup("padded")  # radii 0.4 and 0.2 at a distance of 0.5
    assert checker.GetGeometryGroup() == checker.GetBodyGeometryGroup(right) == "padded"
    assert env.CheckCollision(left, report)
    assert {report.pgeom1.GetName(), report.pgeom2.GetName()} == {"wide"}
    assert [len(each.GetLinks()[0].GetGeometries()) for each in (left, right)] == [1, 1]
    assert left.GetLinks()[0].GetGeometries()[0].GetSphereRadius() == 0.1
    right.SetTransform([1, 0, 0, 0, 0.61, 0, 0])
    assert not env.CheckCollision(left)
    right.SetTransform([1, 0, 0, 0, 0.59, 0, 0])
    assert env.CheckCollision(left, right)
    checker.SetGeometryGroup("")
    assert not env.CheckCollision(left)


def test_a_group_of_one_body(scene):
    env, left, right = scene
    checker = env.GetCollisionChecker()
    assert checker.SetBodyGeometryGroup(left, "padded")
    assert not checker.SetBodyGeometryGroup(right, "nosuch")
    assert (checker.GetBodyGeometryGroup(left), checker.GetBodyGeometryGroup(right)) == ("padded", "")
    right.SetTransform([1, 0, 0, 0, 0.51, 0, 0])  # 0.4 and 0.1
    assert not env.CheckCollision(left)
    right.SetTransform([1, 0, 0, 0, 0.49, 0, 0])
    assert env.CheckCollision(right)
    checker.SetGeometryGroup("self")  # sets it for all bodies again
    assert not env.CheckCollision(right)


def test_links_without_the_group_keep_their_geometries(scene):
    env, left, _ = scene
    plain = body(env, "plain", -0.45)
    env.GetCollisionChecker().SetGeometryGroup("padded")
    assert env.CheckCollision(left, plain)
    plain.SetTransform([1, 0, 0, 0, -0.51, 0, 0])
    assert not env.CheckCollision(left, plain)


def test_groups_that_change_and_bodies_that_come_and_go(scene):
    env, left, right = scene
    checker = env.GetCollisionChecker()
    checker.SetGeometryGroup("padded")
    assert env.CheckCollision(left)
    left.GetLinks()[0].SetGroupGeometries("padded", [ball(0.2)])
    assert not env.CheckCollision(left)
    near = body(env, "near", 0.25, 0.1)
    assert env.CheckCollision(left, near)
    left.Enable(False)
    assert not env.CheckCollision(near, left)
    left.Enable(True)
    env.Remove(near)
    assert not env.CheckCollision(left)
    assert env.GetBodies() == [left, right]


def test_rays_and_other_checkers(scene):
    env, left, _ = scene
    checker, other = env.GetCollisionChecker(), ravemj.RaveCreateCollisionChecker(env, "ode")
    checker.SetGeometryGroup("padded")
    report = ravemj.CollisionReport()
    assert env.CheckCollision(ravemj.Ray([0, 0, 2], [0, 0, -3]), report)
    assert report.minDistance == pytest.approx(1.6)
    hits, points = env.CheckCollisionRays([[0, 0, 2, 0, 0, -3]])
    assert hits.all()
    np.testing.assert_allclose(points[0, :3], [0, 0, 0.4], atol=1e-9)
    assert not other.CheckCollision(left)
    assert checker.CheckCollision(left)
    other.Clone(checker)
    assert other.CheckCollision(left)


def test_bodies_that_callbacks_move_stay_there(scene):
    env, left, right = scene
    env.GetCollisionChecker().SetGeometryGroup("padded")

    def move(report, physics):
        right.SetTransform([1, 0, 0, 0, 3, 0, 0])
        return ravemj.CollisionAction.DefaultAction

    handle = env.RegisterCollisionCallback(move)
    assert env.CheckCollision(left)
    handle.Close()
    assert right.GetTransform()[0, 3] == 3
    assert not env.CheckCollision(left)
    env.GetCollisionChecker().SetGeometryGroup("")
    right.SetTransform([1, 0, 0, 0, 0.15, 0, 0])
    assert env.CheckCollision(left)


def test_callbacks_see_the_geometries_that_links_have(scene):
    env, left, _ = scene
    env.GetCollisionChecker().SetGeometryGroup("padded")
    seen = []

    def look(report, physics):
        seen.append(left.GetLinks()[0].GetGeometries()[0].GetSphereRadius())
        return ravemj.CollisionAction.DefaultAction

    handle = env.RegisterCollisionCallback(look)
    assert env.CheckCollision(left)
    handle.Close()
    assert seen == [0.1]


def test_links_are_disabled_without_another_model(scene):
    env, left, right = scene
    checker = env.GetCollisionChecker()
    checker.SetGeometryGroup("padded")
    assert env.CheckCollision(left)
    model = checker.world().model
    right.Enable(False)
    assert not env.CheckCollision(left)
    right.Enable(True)
    assert env.CheckCollision(left)
    assert checker.world().model is model
