"""Collision checking: against independent tests of shapes, and the rules of who takes part."""

import itertools
import math

import mujoco
import numpy as np
import pytest
from conftest import MODELS
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples

import ravemj
from ravemj import CollisionOptions, CollisionReport, KinBody, Ray
from ravemj.engine.collision import pairs
from ravemj.engine.collision.moving import moving_test
from ravemj.geometry_functions import CheckOBBCollision, OrientedBox

pytestmark = pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")

ARM = """<Environment><Robot name="arm"><KinBody>
<Body name="base"><Geom type="box"><extents>.2 .2 .1</extents></Geom></Body>
<Body name="upper"><offsetfrom>base</offsetfrom><Translation>0 0 .3</Translation>
<Geom type="box"><Translation>.5 0 0</Translation><extents>.5 .05 .05</extents></Geom></Body>
<Body name="fore"><offsetfrom>upper</offsetfrom><Translation>1.1 0 0</Translation>
<Geom type="box"><Translation>.4 0 0</Translation><extents>.3 .05 .05</extents></Geom></Body>
<Body name="finger"><offsetfrom>fore</offsetfrom><Translation>.8 0 0</Translation>
<Geom type="box"><Translation>.1 0 0</Translation><extents>.05 .02 .02</extents></Geom></Body>
<Joint name="j0" type="hinge"><Body>base</Body><Body>upper</Body><offsetfrom>upper</offsetfrom><axis>0 0 1</axis>
<limitsrad>-3 3</limitsrad></Joint>
<Joint name="j1" type="hinge"><Body>upper</Body><Body>fore</Body><offsetfrom>fore</offsetfrom><axis>0 0 1</axis>
<limitsrad>-3.1 3.1</limitsrad></Joint>
<Joint name="j2" type="hinge"><Body>fore</Body><Body>finger</Body><offsetfrom>finger</offsetfrom><axis>0 0 1</axis>
<limitsrad>-1 1</limitsrad></Joint>
</KinBody><Manipulator name="hand"><base>base</base><effector>fore</effector><joints>j2</joints>
<closingdirection>1</closingdirection></Manipulator></Robot></Environment>"""

THING = """<KinBody name="thing">
<Body name="handle"><Geom type="box"><extents>.1 .03 .03</extents></Geom></Body>
<Body name="tip"><offsetfrom>handle</offsetfrom><Translation>0 0 .2</Translation>
<Geom type="box"><Translation>.05 0 0</Translation><extents>.1 .02 .02</extents></Geom></Body>
<Body name="rim"><offsetfrom>handle</offsetfrom><Translation>0 .1 0</Translation>
<Geom type="sphere"><radius>.02</radius></Geom></Body>
<Joint name="swivel" type="hinge"><Body>handle</Body><Body>tip</Body><offsetfrom>tip</offsetfrom><axis>0 1 0</axis>
</Joint><Joint name="weld" type="hinge" enable="false"><Body>handle</Body><Body>rim</Body><offsetfrom>rim</offsetfrom>
<axis>0 1 0</axis><limits>0 0</limits></Joint></KinBody>"""
"""What an arm may hold: links before and behind a joint, and one that is welded on."""

BOX = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
BOX_TRIANGLES = np.array([0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4])
BOX_TRIANGLES = np.append(BOX_TRIANGLES, [1, 5, 7, 1, 7, 3]).reshape(12, 3)


@pytest.fixture
def env():
    return ravemj.Environment()


@pytest.fixture
def arm(env):
    env.LoadData(ARM)
    return env.GetRobot("arm")


def added(env, name, fill, position=(0.0, 0.0, 0.0)):
    body = ravemj.RaveCreateKinBody(env, "")
    fill(body)
    body.SetName(name)
    env.Add(body)
    place(body, position)
    return body


def box(env, name, position=(0.0, 0.0, 0.0), half=(0.5, 0.5, 0.5)):
    return added(env, name, lambda body: body.InitFromBoxes([[0, 0, 0, *half]]), position)


def sphere(env, name, position=(0.0, 0.0, 0.0), radius=0.5):
    return added(env, name, lambda body: body.InitFromSpheres([[0, 0, 0, radius]]), position)


def mesh(env, name, vertices, triangles, position=(0.0, 0.0, 0.0)):
    return added(env, name, lambda body: body.InitFromTrimesh(ravemj.TriMesh(vertices, triangles)), position)


def u_shape():
    """Return two legs and a floor, around the gap |x| < 0.9, z > -0.9."""
    boxes = [((-1, 0, 0), (0.1, 0.5, 1)), ((1, 0, 0), (0.1, 0.5, 1)), ((0, 0, -1), (1, 0.5, 0.1))]
    vertices = np.vstack([BOX * half + centre for centre, half in boxes])
    return vertices, np.vstack([BOX_TRIANGLES + 8 * number for number in range(3)])


def place(body, position, turn=(0.0, 0.0, 0.0)):
    T = ravemj.matrixFromAxisAngle(turn)
    T[:3, 3] = position
    body.SetTransform(T)


def colliding(report):
    return {
        frozenset((info.bodyLinkGeom1Name.split()[0], info.bodyLinkGeom2Name.split()[0]))
        for info in report.collisionInfos
    }


turns = st.tuples(*[st.floats(-3, 3)] * 3)
positions = st.tuples(*[st.floats(-2, 2)] * 3)


@examples(60)
@given(st.lists(st.tuples(positions, turns, st.tuples(*[st.floats(0.05, 1.0)] * 3)), min_size=2, max_size=7))
def test_all_pairs_of_boxes_are_found(boxes):
    """Against separating axes, for every pair of bodies, none of which ever moves by a joint."""
    env = ravemj.Environment()
    bodies = [box(env, f"b{number}", half=half) for number, (_, _, half) in enumerate(boxes)]
    for body, (position, turn, _) in zip(bodies, boxes, strict=True):
        place(body, position, turn)
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.AllLinkCollisions)
    solids = [OrientedBox(body.GetTransform(), half) for body, (_, _, half) in zip(bodies, boxes, strict=True)]
    expected = {
        frozenset((f"b{i}", f"b{j}"))
        for i, j in itertools.combinations(range(len(boxes)), 2)
        if CheckOBBCollision(solids[i], solids[j])
    }
    found = set()
    for body in bodies:
        report = CollisionReport()
        assert env.CheckCollision(body, report) == bool(report.collisionInfos)
        assert all(info.bodyLinkGeom1Name.split()[0] == body.GetName() for info in report.collisionInfos)
        found |= colliding(report)
    assert found == expected
    for one, other in itertools.permutations(bodies, 2):
        assert env.CheckCollision(one, other) == (frozenset((one.GetName(), other.GetName())) in expected)


@examples(60)
@given(st.lists(st.tuples(positions, st.floats(0.05, 1.0)), min_size=2, max_size=7))
def test_distances_and_contacts_of_spheres(spheres):
    env = ravemj.Environment()
    bodies = [sphere(env, f"s{i}", position, radius) for i, (position, radius) in enumerate(spheres)]
    checker = env.GetCollisionChecker()
    checker.SetCollisionOptions(CollisionOptions.Distance | CollisionOptions.Contacts)
    for (one, (p, r)), (other, (q, s)) in itertools.permutations(zip(bodies, spheres, strict=True), 2):
        report = CollisionReport()
        apart = math.dist(p, q) - r - s
        assert env.CheckCollision(one, other, report) == (apart <= 0)
        assert report.minDistance == pytest.approx(max(apart, 0.0), abs=1e-9)
        if apart < -1e-3 and math.dist(p, q) > 1e-3:
            (contact,) = report.contacts
            assert contact.depth == pytest.approx(-apart, abs=1e-9)
            np.testing.assert_allclose(contact.norm, np.subtract(p, q) / math.dist(p, q), atol=1e-6)


class TestReportsOfDistances:
    """Who is nearest, and how near."""

    @pytest.fixture
    def checker(self, env):
        checker = env.GetCollisionChecker()
        checker.SetCollisionOptions(CollisionOptions.Distance)
        return checker

    def test_name_the_nearest_links(self, env, arm, checker):
        box(env, "far", (0, 5, 0.3), (0.1, 0.1, 0.1))
        near = box(env, "near", (2.2, 0, 0.3), (0.05, 0.05, 0.05))
        report = CollisionReport()
        assert not env.CheckCollision(arm, report)
        assert report.minDistance == pytest.approx(2.15 - (1.1 + 0.8 + 0.15), abs=1e-9)
        assert (report.plink1, report.plink2) == (arm.GetLink("finger"), near.GetLinks()[0])
        assert (report.pgeom1, report.pgeom2) == (report.plink1.GetGeometries()[0], report.plink2.GetGeometries()[0])
        (info,) = report.collisionInfos
        assert info.ExtractFirstBodyLinkGeomNames()[:2] == ("arm", "finger")
        assert info.ExtractSecondBodyLinkGeomNames()[:2] == ("near", "base")
        assert (report.numCols, report.vLinkColliding, report.contacts) == (0, [], [])

    def test_name_the_first_argument_first(self, env, arm, checker):
        thing = box(env, "thing", (2.5, 0, 0.3), (0.05, 0.05, 0.05))
        report = CollisionReport()
        for one, other in ((arm, thing), (thing, arm), (arm.GetLink("fore"), thing), (thing, arm.GetLink("upper"))):
            assert not env.CheckCollision(one, other, report)
            names = [getattr(part, "GetParent", lambda part=part: part)().GetName() for part in (one, other)]
            assert [link.GetParent().GetName() for link in (report.plink1, report.plink2)] == names
            assert 0 < report.minDistance < 3

    def test_of_a_body_to_itself(self, arm, checker):
        report = CollisionReport()
        arm.SetDOFValues([0, 2.6, 0])
        assert not arm.CheckSelfCollision(report)
        assert {report.plink1.GetName(), report.plink2.GetName()} == {"base", "finger"}
        assert 0 < report.minDistance < 1

    def test_are_those_of_collisions_where_there_is_one(self, env, arm, checker):
        wall = box(env, "wall", (1.5, 0, 0.3), (0.1, 0.1, 0.1))
        report = CollisionReport()
        assert env.CheckCollision(arm, report)
        assert (report.minDistance, report.numCols) == (0, 1)
        assert report.vLinkColliding == [(arm.GetLink("fore"), wall.GetLinks()[0])]

    def test_keep_the_nearest_of_several_questions(self, env, arm, checker):
        one, other = (box(env, name, (x, 0, 0.3), (0.1, 0.1, 0.1)) for name, x in (("one", 4), ("other", 3)))
        for order in ([one, other], [other, one]):
            report = CollisionReport()
            report.nKeepPrevious = 1
            for body in order:
                env.CheckCollision(arm, body, report)
            assert report.plink2.GetParent() == other
            assert report.minDistance == pytest.approx(2.9 - 2.05)
            assert len(report.collisionInfos) == 1

    def test_are_empty_where_there_is_nothing_else(self, env, arm, checker):
        report = CollisionReport()
        assert not env.CheckCollision(arm, report)
        assert (report.minDistance, report.collisionInfos, report.plink1) == (1e20, [], None)


@examples(40)
@given(positions, turns, st.tuples(*[st.floats(0.15, 1.0)] * 3))  # too thick to be inside of a leg
def test_meshes_are_their_triangles(position, turn, half):
    """A box against a U of three boxes, whose hull is no answer."""
    env = ravemj.Environment()
    u = mesh(env, "u", *u_shape())
    other = box(env, "box", half=half)
    place(other, position, turn)
    parts = [
        OrientedBox([1, 0, 0, 0, *centre], extents)
        for centre, extents in [((-1, 0, 0), (0.1, 0.5, 1)), ((1, 0, 0), (0.1, 0.5, 1)), ((0, 0, -1), (1, 0.5, 0.1))]
    ]
    solid = OrientedBox(other.GetTransform(), half)
    expected = any(CheckOBBCollision(part, solid) for part in parts)
    assert env.CheckCollision(u, other) == expected
    assert env.CheckCollision(other, u) == expected


def test_mesh_against_mesh(env):
    one = mesh(env, "one", *u_shape())
    other = mesh(env, "other", *u_shape())
    assert env.CheckCollision(one, other)
    place(other, [0, 0, 1.25], [0, math.pi, 0])  # turned over, its legs beside those of the first, its floor above
    assert env.CheckCollision(one, other)
    place(other, [1.0, 0, 1.25], [0, math.pi, 0])  # each has a leg in the gap of the other
    assert not env.CheckCollision(one, other)
    checker = env.GetCollisionChecker()
    checker.SetCollisionOptions(CollisionOptions.Distance)
    report = CollisionReport()
    env.CheckCollision(one, other, report)
    assert report.minDistance == pytest.approx(0.8, abs=1e-6)


def test_meshes_report_where_they_are_deepest_in_each_other(env):
    one = mesh(env, "one", *u_shape())
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.Contacts)
    # Two open wedges above the floor of the U, whose edges along y are 0.02 and 0.06 deep in it.
    wedge = np.array([[0, y, 0] for y in (-1.0, 1.0)] + [[x, y, 1] for x in (-0.1, 0.1) for y in (-1.0, 1.0)])
    faces = np.array([[0, 1, 3], [0, 3, 2], [0, 5, 1], [0, 4, 5]])
    both = np.vstack([wedge + np.array([-0.4, 0, -0.92]), wedge + np.array([0.4, 0, -0.96])])
    wedges = mesh(env, "wedges", both, np.vstack([faces, faces + 6]))
    report = CollisionReport()
    assert env.CheckCollision(wedges, one, report)
    contact, *others = report.contacts
    assert contact.depth == pytest.approx(0.06, abs=1e-6)
    np.testing.assert_allclose(contact.pos[[0, 2]], [0.4, -0.93], atol=1e-6)
    assert all(other.depth <= contact.depth for other in others)
    assert any(other.pos[0] < 0 and other.depth == pytest.approx(0.02, abs=1e-6) for other in others)


def test_meshes_that_stand_on_each_other_touch(env):
    for position, turn in [((0, 0, 0), (0, 0, 0)), ((0.3, -2.1, 0.7), (0.3, 0.5, -0.9)), ((7, 5, 3), (1, 2, -0.5))]:
        T = ravemj.matrixFromAxisAngle(turn)
        lower, upper = mesh(env, "lower", *u_shape()), mesh(env, "upper", *u_shape())
        place(lower, position, turn)
        place(upper, position + T[:3, 2] * 2.1, turn)
        assert env.CheckCollision(upper, lower)
        place(upper, position + T[:3, 2] * (2.1 + 1e-6), turn)
        assert not env.CheckCollision(upper, lower)
        env.Remove(lower)
        env.Remove(upper)


def test_convex_meshes_are_solid(env):
    mesh(env, "cube", BOX, BOX_TRIANGLES)
    assert env.CheckCollision(box(env, "inside", half=(0.1, 0.1, 0.1)))


def test_open_meshes_are_hollow(env):
    mesh(env, "open", BOX, BOX_TRIANGLES[2:])
    assert not env.CheckCollision(box(env, "inside", half=(0.1, 0.1, 0.1)))
    assert env.CheckCollision(box(env, "across", (0, 1, 0), half=(0.1, 0.1, 0.1)))


def test_reports_are_symmetric(env):
    one, other = box(env, "one"), sphere(env, "other", (0.7, 0.1, 0.2))
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.Contacts)
    here, there = CollisionReport(), CollisionReport()
    assert env.CheckCollision(one, other, here)
    assert env.CheckCollision(other, one, report=there)
    assert (here.plink1, here.plink2) == (there.plink2, there.plink1)
    assert here.plink1.GetParent() == one
    assert here.vLinkColliding == [(here.plink1, here.plink2)]
    assert here.numCols == 1
    (contact,), (mirrored,) = here.contacts, there.contacts
    np.testing.assert_allclose(contact.norm, -mirrored.norm, atol=1e-9)
    np.testing.assert_allclose(contact.pos, mirrored.pos, atol=1e-9)
    assert contact.depth == pytest.approx(mirrored.depth, abs=1e-9)
    assert contact.depth > 0


def test_a_geometry_of_a_link_is_named(env):
    boxes = [[0, 0, 0, 0.1, 0.1, 0.1], [1, 0, 0, 0.1, 0.1, 0.1], [2, 0, 0, 0.1, 0.1, 0.1]]
    row = added(env, "row", lambda body: body.InitFromBoxes(boxes))
    box(env, "other", (1.15, 0, 0), (0.1, 0.1, 0.1))
    report = CollisionReport()
    assert env.CheckCollision(row, report)
    np.testing.assert_allclose(report.pgeom1.GetTransform()[:3, 3], [1, 0, 0])
    box(env, "plate", (1, 0, 0.1), (2, 0.1, 0.05))
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.AllLinkCollisions)
    assert env.CheckCollision(row, report)
    assert report.numCols == 2
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.AllGeometryCollisions)
    assert env.CheckCollision(row, report)
    assert report.numCols == 4


def test_touching_collides(env):
    one = box(env, "one")
    other = box(env, "other", (1, 0, 0))
    assert env.CheckCollision(one, other)
    place(other, (1 + 1e-6, 0, 0))
    assert not env.CheckCollision(one, other)


def test_excluded_bodies_and_links(env, arm):
    box(env, "near", (0, 0, 0), (0.1, 0.1, 0.1))
    near = env.GetKinBody("near")
    assert env.CheckCollision(near)
    assert not env.CheckCollision(near, [arm], [])
    assert not env.CheckCollision(near, [], [arm.GetLink("base")])
    assert env.CheckCollision(near, [], [arm.GetLink("upper")])
    assert env.CheckCollision(arm.GetLink("base"), [], [])
    assert not env.CheckCollision(arm.GetLink("base"), [near], [])


def test_links(env, arm):
    wall = box(env, "wall", (1.9, 0, 0.3), (0.2, 0.2, 0.2))
    fore, upper, base = (arm.GetLink(name) for name in ("fore", "upper", "base"))
    assert env.CheckCollision(fore)
    assert env.CheckCollision(fore, wall)
    assert env.CheckCollision(wall, fore)
    assert not env.CheckCollision(upper, wall)
    assert env.CheckCollision(fore, wall.GetLinks()[0])
    assert not env.CheckCollision(fore, arm)
    fore.SetTransform(np.eye(4))
    assert env.CheckCollision(fore, base)
    assert not env.CheckCollision(fore, fore)


@pytest.mark.parametrize(
    ("arguments", "code"),
    [((), "InvalidArguments"), ((None,), "Assert"), ((3,), "InvalidArguments"), ((np.eye(4),), "InvalidArguments")],
)
def test_nonsense_is_refused(env, arguments, code):
    with pytest.raises(ravemj.openrave_exception) as error:
        env.CheckCollision(*arguments)
    assert error.value.GetCode() == code
    with pytest.raises(TypeError, match="has no argument thing"):
        env.CheckCollision(thing=1)


def test_disabling_counts_at_once(env, arm):
    wall = box(env, "wall", (1.9, 0, 0.3), (0.2, 0.2, 0.2))
    assert env.CheckCollision(arm)
    arm.GetLink("fore").Enable(False)
    arm.GetLink("finger").Enable(False)
    assert not env.CheckCollision(arm)
    assert list(arm.GetLinkEnableStates()) == [1, 1, 0, 0]
    assert list(arm.GetLinkEnableStatesMasks()) == [3]
    arm.SetLinkEnableStatesMasks([0b0111])
    assert env.CheckCollision(arm)
    with env:
        with arm:
            arm.Enable(False)
            assert not arm.IsEnabled()
            assert not env.CheckCollision(wall)
        assert env.CheckCollision(wall)
    with pytest.raises(ravemj.openrave_exception):
        arm.SetLinkEnableStates([1])


def test_held_bodies_take_part(env, arm):
    thing = box(env, "thing", (2.2, 0, 0.3), (0.2, 0.03, 0.03))
    arm.Grab(thing)
    assert not env.CheckCollision(arm)
    assert not env.CheckCollision(thing)
    box(env, "wall", (2.35, 0, 0.3), (0.05, 0.5, 0.5))
    report = CollisionReport()
    assert env.CheckCollision(arm, report)
    assert report.plink1.GetParent() == thing
    assert env.CheckCollision(thing)
    arm.Release(thing)
    assert env.CheckCollision(arm, thing)
    place(thing, (5, 0, 0))
    assert not env.CheckCollision(arm)


def test_held_bodies_collide_with_the_holder(env, arm):
    thing = box(env, "thing", (1.9, 0, 0.3), (0.4, 0.03, 0.03))
    arm.Grab(thing)
    assert not arm.CheckSelfCollision()  # touches finger and forearm
    arm.SetDOFValues([0, 2.95, 0])
    assert arm.CheckSelfCollision()  # reaches the upper arm
    arm.SetDOFValues([0, 0.5, 0])
    assert not arm.CheckSelfCollision()


@pytest.mark.parametrize("disabled", ["nothing", "the body", "the links", "both"])
def test_links_touched_when_grabbing_are_ignored_even_if_disabled(env, arm, disabled):
    """OpenRAVE's answers in the case ``name-26-grab-disabled-body``."""
    thing = box(env, "thing", (1.9, 0, 0.3), (0.4, 0.03, 0.03))
    thing.Enable(disabled not in {"the body", "both"})
    arm.Enable(disabled not in {"the links", "both"})
    arm.Grab(thing)
    thing.Enable(True)
    arm.Enable(True)
    (info,) = arm.GetGrabbedInfo()
    assert info._setIgnoreRobotLinkNames == ["finger", "fore"]
    assert not arm.CheckSelfCollision()
    arm.SetDOFValues([0, 2.95, 0])
    assert arm.CheckSelfCollision()  # reaches the upper arm
    thing.Enable(False)
    assert not arm.CheckSelfCollision()


def test_grab_takes_its_arguments_by_name(env, arm):
    thing = box(env, "thing", (0.5, 0, 0.4), (0.6, 0.05, 0.05))
    upper, fore = arm.GetLink("upper"), arm.GetLink("fore")
    for named, link in [
        ({"body": thing}, arm.GetActiveManipulator().GetEndEffector()),
        ({"body": thing, "grablink": upper}, upper),
        ({"body": thing, "grablink": fore, "linkstoignore": ["base"], "grabbedUserData": None}, fore),
    ]:
        assert arm.Grab(**named)
        assert arm.IsGrabbing(thing) == link
        (info,) = arm.GetGrabbedInfo()
        assert ("base" in info._setIgnoreRobotLinkNames) == ("linkstoignore" in named)
    arm.Grab(thing, fore, [0], None)
    assert "base" in arm.GetGrabbedInfo()[0]._setIgnoreRobotLinkNames
    for wrong in ([thing, fore, ["base"]], [thing, fore, [0]]):  # as in OpenRAVE: gap-20, random-api-71
        with pytest.raises(TypeError, match="grabbedUserData"):
            arm.Grab(*wrong)


def test_two_held_bodies(env, arm):
    one = box(env, "one", (1.5, 0, 0.4), (0.05, 0.05, 0.05))
    other = box(env, "other", (0.5, 0, 0.4), (0.6, 0.05, 0.05))
    arm.Grab(one, arm.GetLink("fore"))
    arm.Grab(other, arm.GetLink("upper"))
    assert not arm.CheckSelfCollision()
    arm.SetDOFValues([0, 3.1, 0])
    report = CollisionReport()
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.AllLinkCollisions)
    assert arm.CheckSelfCollision(report)
    assert {"one", "other"} in colliding(report)


def test_declared_pose_is_free_of_self_collision(arm):
    arm.GetLink("fore").SetTransform(np.eye(4))
    assert arm.CheckSelfCollision()
    arm.SetNonCollidingConfiguration()
    assert not arm.CheckSelfCollision()
    assert (0, 2) not in arm.GetNonAdjacentLinks()
    np.testing.assert_array_equal(arm.GetLink("fore").GetTransform(), np.eye(4))


def test_links_touching_when_added_are_looked_up_where_they_were(env, arm):
    """The pose of the time counts, not that of the first question."""
    arm.SetDOFValues([0, 3.05, 0])
    folded = arm.GetLink("finger").GetTransform()
    pairs = arm.GetNonAdjacentLinks()
    np.testing.assert_array_equal(arm.GetLink("finger").GetTransform(), folded)
    assert pairs == [(0, 2), (0, 3), (1, 3)]


def test_copies_touch_where_their_originals_touch(env, arm):
    """A copy that is made in a colliding configuration collides in it, too."""
    arm.SetDOFValues([0, 3.1, 0])
    assert arm.CheckSelfCollision()
    copy = ravemj.RaveCreateRobot(env, "")
    copy.Clone(arm, 0)
    env.Add(copy, True)
    assert copy.CheckSelfCollision()
    assert copy.GetNonAdjacentLinks() == arm.GetNonAdjacentLinks()


def test_end_effector(env, arm):
    hand = arm.GetActiveManipulator()
    box(env, "wall", (1.9, 0.6, 0.3), (0.1, 0.1, 0.1))
    assert not hand.CheckEndEffectorCollision(hand.GetTransform())
    assert not hand.CheckEndEffectorCollision(report=CollisionReport())
    with pytest.raises(TypeError, match="pose"):
        hand.CheckEndEffectorCollision()
    T = hand.GetTransform()
    T[1, 3] += 0.6
    before = arm.GetLinkTransformations()
    report = CollisionReport()
    assert hand.CheckEndEffectorCollision(T, report)
    assert report.plink1.GetName() in {"fore", "finger"}
    assert not hand.CheckEndEffectorSelfCollision(T)
    assert hand.CheckEndEffectorSelfCollision(np.eye(4))
    assert hand.CheckEndEffectorSelfCollision(np.eye(4), ignoreManipulatorLinks=True)
    over_upper = np.eye(4)
    over_upper[:3, 3] = [0.3, 0, 0.3]
    assert not hand.CheckEndEffectorSelfCollision(over_upper, ignoreManipulatorLinks=True)
    assert not hand.CheckIndependentCollision()
    box(env, "foot", (0, 0, -0.1), (0.1, 0.1, 0.1))
    assert hand.CheckIndependentCollision()
    np.testing.assert_array_equal(arm.GetLinkTransformations(), before)


def test_active_dofs_choose_what_is_tested(env, arm):
    """Pairs that they move against each other; links that they move against the world."""
    arm.SetDOFValues([0, 2.95, 1])
    checker = env.GetCollisionChecker()
    assert arm.CheckSelfCollision()
    checker.SetCollisionOptions(CollisionOptions.ActiveDOFs)
    assert arm.CheckSelfCollision()
    assert arm.GetNonAdjacentLinks(KinBody.AdjacentOptions.ActiveDOFs) == [(0, 2), (0, 3), (1, 3)]
    arm.SetActiveDOFs([0])  # turns all links but the base together
    assert not arm.CheckSelfCollision()
    assert arm.GetNonAdjacentLinks(KinBody.AdjacentOptions.ActiveDOFs) == [(0, 2), (0, 3)]
    box(env, "foot", (0, 0, -0.1), (0.1, 0.1, 0.1))
    assert not env.CheckCollision(arm)
    arm.SetActiveDOFs([0], ravemj.DOFAffine.X)
    assert env.CheckCollision(arm)


def test_one_link_against_the_others(env, arm):
    checker = env.GetCollisionChecker()
    arm.GetLink("fore").SetTransform(np.eye(4))
    assert checker.CheckSelfCollision(arm.GetLink("fore"))
    assert checker.CheckSelfCollision(arm.GetLink("base"))
    assert not checker.CheckSelfCollision(arm.GetLink("upper"))
    assert checker.CheckSelfCollision(arm)


def test_callbacks_decide(env):
    one, other, third = box(env, "one"), box(env, "other", (0.5, 0, 0)), box(env, "third", (-0.5, 0, 0))
    seen = []

    def ignore_other(report, fromphysics):
        seen.append((report.plink2.GetParent().GetName(), fromphysics))
        return ravemj.CollisionAction.Ignore if report.plink2.GetParent() == other else 0

    handle = env.RegisterCollisionCallback(ignore_other)
    assert not env.CheckCollision(one, other)
    assert env.CheckCollision(one)
    assert env.CheckCollision(one, third)
    assert seen == [("other", False), ("other", False), ("third", False), ("third", False)]
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.IgnoreCallbacks)
    assert env.CheckCollision(one, other)
    env.GetCollisionChecker().SetCollisionOptions(0)
    handle.Close()
    handle.Close()
    assert env.CheckCollision(one, other)
    handle = env.RegisterCollisionCallback(ignore_other)
    del handle
    assert env.CheckCollision(one, other)


def test_options(env, caplog, monkeypatch):
    monkeypatch.setattr(ravemj.rave.collision, "_told", set())  # as if nobody had asked for one before
    checker = ravemj.RaveCreateCollisionChecker(env, "ODE")
    assert checker.GetXMLId() == "ODE"
    assert ravemj.RaveCreateCollisionChecker(env, "ode")
    assert [record.message for record in caplog.records if "'ODE'" in record.message or "'ode'" in record.message]
    assert ravemj.RaveCreateCollisionChecker(env, "nosuch") is None
    assert not checker.SetCollisionOptions(1 << 12)
    with pytest.raises(ravemj.openrave_exception), ravemj.CollisionOptionsStateSaver(checker, 1 << 12):
        pass
    with ravemj.CollisionOptionsStateSaver(checker, 1 << 12, required=False):
        assert checker.GetCollisionOptions() == 0


def test_tolerance(env):
    one = box(env, "one")
    box(env, "other", (1.1, 0, 0))
    box(env, "far", (-1.5, 0, 0))
    checker = env.GetCollisionChecker()
    checker.SetCollisionOptions(CollisionOptions.UseTolerance)
    report = CollisionReport()
    for tolerance, count in ((0.05, 0), (0.1 + 1e-9, 1), (0.6, 2)):
        checker.SetTolerance(tolerance)
        assert not env.CheckCollision(one, report)
        assert report.numWithinTol == count


@examples(100)
@given(positions, positions, turns, st.tuples(*[st.floats(0.1, 1.0)] * 3))
def test_rays_at_a_box(start, end, turn, half):
    """Against slabs."""
    env = ravemj.Environment()
    body = box(env, "box", half=half)
    place(body, (0, 0, 0), turn)
    rotation = body.GetTransform()[:3, :3]
    p, d = rotation.T @ start, rotation.T @ np.subtract(end, start)
    if np.abs(d).min() < 1e-6 or np.abs(np.abs(p) - half).min() < 1e-6:
        return
    a, b = (-np.array(half) - p) / d, (np.array(half) - p) / d
    enters, leaves = np.sort(np.minimum(a, b)), np.sort(np.maximum(a, b))
    if enters[2] - enters[1] < 1e-6 or leaves[1] - leaves[0] < 1e-6:
        return  # rounding lets MuJoCo's rays slip through an edge between two faces
    enter, leave = enters[2], leaves[0]
    first = enter if enter >= 0 else leave
    if abs(first - 1) < 1e-6 or abs(enter - leave) < 1e-6 or min(abs(enter), abs(leave)) < 1e-6:
        return
    hit = enter <= leave and 0 <= first <= 1
    report = CollisionReport()
    assert env.CheckCollision(Ray(start, np.subtract(end, start)), report) == hit
    flags, rows = env.CheckCollisionRays([[*start, *np.subtract(end, start)]])
    assert flags.tolist() == [hit]
    if hit:
        point = np.array(start) + first * np.subtract(end, start)
        np.testing.assert_allclose(report.contacts[0].pos, point, atol=1e-9)
        np.testing.assert_allclose(rows[0], [*point, *report.contacts[0].norm], atol=1e-9)
        assert report.minDistance == pytest.approx(first * math.dist(start, end), abs=1e-9)
    else:
        assert not rows.any()


def test_many_rays(env):
    wall, inside = box(env, "wall", (2, 0, 0)), sphere(env, "inside", (2, 0, 0), 0.2)
    rays = [[0, 0, 0, 4, 0, 0], [0, 0, 0, 1, 0, 0], [2, 0, 0, 4, 0, 0], [0, 0, 0, 0, 0, 0]]
    hits, points = env.CheckCollisionRays(rays)
    assert hits.tolist() == [True, False, True, False]
    np.testing.assert_allclose(points[0], [1.5, 0, 0, -1, 0, 0], atol=1e-9)
    from_outside = [True, False, False, False]
    assert env.CheckCollisionRays(rays, front_facing_only=True)[0].tolist() == from_outside
    for number, ray in enumerate(rays):  # one ray alone takes another way
        alone, point = env.CheckCollisionRays([ray])
        assert alone.tolist() == [hits[number]]
        np.testing.assert_allclose(point, points[[number]], rtol=0, atol=1e-12)
        assert env.CheckCollisionRays([ray], front_facing_only=True)[0].tolist() == [from_outside[number]]
    np.testing.assert_allclose(env.CheckCollisionRays(rays, inside)[1][0], [1.8, 0, 0, -1, 0, 0], atol=1e-9)
    wall.Enable(False)
    np.testing.assert_allclose(env.CheckCollisionRays(rays)[1][0], [1.8, 0, 0, -1, 0, 0], atol=1e-9)
    assert env.CheckCollisionRays(np.zeros((0, 6)))[1].shape == (0, 6)
    with pytest.raises(ravemj.openrave_exception, match="shape"):
        env.CheckCollisionRays([[1, 2, 3]])


def test_rays_see_the_gap_of_a_mesh(env):
    mesh(env, "u", *u_shape())
    assert not env.CheckCollision(Ray([0, -3, 0], [0, 6, 0]))
    assert env.CheckCollision(Ray([-1, -3, 0], [0, 6, 0]))


def test_nothing_collides_without_a_checker(env):
    one = box(env, "one")
    box(env, "other")
    env.SetCollisionChecker(None)
    report = CollisionReport()
    assert not env.CheckCollision(one, report)
    assert not one.CheckSelfCollision()
    assert not env.CheckCollision(Ray([-2, 0, 0], [4, 0, 0]))
    assert not env.CheckCollisionRays([[-2, 0, 0, 4, 0, 0]])[0].any()


SNAKE = "".join(
    f"""<Body name="l{n}"><offsetfrom>l{max(n - 1, 0)}</offsetfrom><Translation>{0.4 * (n > 0)} 0 0</Translation>
    <Geom type="box"><Translation>.2 0 0</Translation><extents>.15 .05 .04</extents></Geom></Body>"""
    for n in range(9)
) + "".join(
    f"""<Joint name="j{n}" type="hinge" enable="{"false" if n == 4 else "true"}"><Body>l{n}</Body><Body>l{n + 1}</Body>
    <offsetfrom>l{n + 1}</offsetfrom><axis>{("0 0 1", "0 1 0")[n % 2]}</axis><limitsrad>{limits}</limitsrad></Joint>"""
    for n in range(8)
    for limits in ["0 0" if n == 4 else "-3 3"]
)
"""Nine links, of which the fifth and the sixth are one."""


class TestManyPairs:
    """Questions about so many pairs that MuJoCo's collision detection looks for those that touch."""

    @pytest.fixture
    def snake(self, env):
        return self.snake_among_boxes(env)

    @staticmethod
    def snake_among_boxes(env):
        env.LoadData(f'<Environment><Robot name="snake"><KinBody>{SNAKE}</KinBody></Robot></Environment>')
        random = np.random.default_rng(7)
        for number in range(12):
            box(env, f"box{number}", random.uniform(-2, 2, 3) * (1, 1, 0.5), random.uniform(0.05, 0.3, 3))
        return env.GetRobot("snake")

    @staticmethod
    def solids(body, links=None):
        chosen = body.GetLinks() if links is None else [body.GetLinks()[link] for link in links]
        return [
            OrientedBox(link.GetTransform() @ geometry.GetTransform(), geometry.GetBoxExtents())
            for link in chosen
            if link.IsEnabled()
            for geometry in link.GetGeometries()
        ]

    def overlap(self, ones, others):
        return any(CheckOBBCollision(one, other) for one in ones for other in others)

    def check(self, env, snake):
        """Compare with separating axes, for each body among the others and for the snake itself."""
        held = snake.GetGrabbed()
        for body in env.GetBodies():
            group = [snake, *held] if body in (snake, *held) else [body]
            ours = [solid for one in group for solid in self.solids(one)]
            others = [solid for one in env.GetBodies() if one not in group for solid in self.solids(one)]
            assert env.CheckCollision(body) == self.overlap(ours, others)
            report = CollisionReport()
            assert env.CheckCollision(body, report) == bool(report.collisionInfos) == self.overlap(ours, others)
            if len(group) == 1 and body != snake:
                with_held = [solid for one in (snake, *held) for solid in self.solids(one)]
                assert env.CheckCollision(snake, body) == self.overlap(with_held, ours)
        for link in range(0, len(snake.GetLinks()), 3):
            others = [solid for one in env.GetBodies() if one not in (snake, *held) for solid in self.solids(one)]
            assert env.CheckCollision(snake.GetLinks()[link]) == self.overlap(self.solids(snake, [link]), others)
        if not held:
            tested = snake.GetNonAdjacentLinks()
            assert len(tested) > 16
            assert snake.CheckSelfCollision() == any(
                self.overlap(self.solids(snake, [one]), self.solids(snake, [other])) for one, other in tested
            )

    @pytest.mark.parametrize(
        ("seed", "count"), [(0, 10), *(pytest.param(seed, 40, marks=pytest.mark.stress) for seed in range(4))]
    )
    def test_everything_can_move(self, env, snake, seed, count):
        random = np.random.default_rng(seed)
        bodies = [body for body in env.GetBodies() if body != snake]
        steps = {
            "values": lambda: snake.SetDOFValues(random.uniform(-1.5, 1.5, snake.GetDOF())),
            "base": lambda: place(snake, random.uniform(-1, 1, 3), random.uniform(-1, 1, 3)),
            "body": lambda: place(random.choice(bodies), random.uniform(-1.5, 1.5, 3), random.uniform(-1, 1, 3)),
            "link": lambda: snake.GetLinks()[8].SetTransform(random.choice(bodies).GetTransform()),
            "enable": lambda: random.choice(snake.GetLinks()).Enable(bool(random.integers(2))),
            "grab": lambda: snake.Grab(random.choice(bodies), snake.GetLinks()[6]),
            "release": snake.ReleaseAllGrabbed,
        }
        for _ in range(count):
            steps[random.choice(list(steps))]()
            self.check(env, snake)

    @staticmethod
    def touching(env):
        """Return the pairs of links that a fresh MuJoCo model of all enabled boxes, each free to move, finds."""
        spec, links = mujoco.MjSpec(), []
        for body in env.GetBodies():
            for link in filter(KinBody.Link.IsEnabled, body.GetLinks()):
                part = spec.worldbody.add_body(pos=link.GetTransformPose()[4:], quat=link.GetTransformPose()[:4])
                part.add_freejoint()
                for geometry in link.GetGeometries():
                    wxyz, place = np.split(ravemj.poseFromMatrix(geometry.GetTransform()), [4])
                    size = geometry.GetBoxExtents()
                    part.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=size, pos=place, quat=wxyz)
                links.append(link)
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        owners = model.geom_bodyid[data.contact.geom] - 1
        return {frozenset((links[one], links[other])) for one, other in owners.tolist()}

    def compare(self, env, snake, random):
        """Compare a question, its report and the one about the snake itself with a fresh model."""
        touching = self.touching(env)
        group = [snake, *snake.GetGrabbed()]
        others = [body for body in env.GetBodies() if body not in group]
        left_out = [body for body in others if random.random() < 0.2]
        links = [link for link in snake.GetLinks() if random.random() < 0.2]
        hits = {pair for pair in touching if len({one.GetParent() in group for one in pair}) == 2}
        assert env.CheckCollision(snake) == bool(hits)
        report = CollisionReport()
        assert env.CheckCollision(snake, report) == bool(hits)
        options = env.GetCollisionChecker().GetCollisionOptions()
        assert hits or options & CollisionOptions.Distance or not report.collisionInfos
        if hits and options & CollisionOptions.AllLinkCollisions:
            assert {frozenset(pair) for pair in report.vLinkColliding} == hits
        counted = [pair for pair in hits if not any(one in links or one.GetParent() in left_out for one in pair)]
        assert env.CheckCollision(snake, left_out, links) == bool(counted)
        one = random.choice(others)
        assert env.CheckCollision(snake, one) == any(one in {link.GetParent() for link in pair} for pair in hits)
        bodies = [{link.GetParent() for link in pair} for pair in touching]
        assert env.CheckCollision(one) == any(one in pair and len(pair) == 2 for pair in bodies)
        assert env.CheckCollision(snake) == bool(hits)  # as before other questions came between
        if len(group) == 1:
            tested = {frozenset(snake.GetLinks()[index] for index in pair) for pair in snake.GetNonAdjacentLinks()}
            assert snake.CheckSelfCollision() == bool(tested & touching)
            assert snake.CheckSelfCollision(report) == bool(tested & touching)

    @examples(40)
    @given(seed=st.integers(0, 2**32), count=st.integers(5, 25))
    def test_answers_in_any_order_are_those_of_a_fresh_model(self, seed, count):
        env = ravemj.Environment()
        snake, random = self.snake_among_boxes(env), np.random.default_rng(seed)
        bodies, checker = [body for body in env.GetBodies() if body != snake], env.GetCollisionChecker()
        options = [CollisionOptions.Contacts, CollisionOptions.Distance, CollisionOptions.AllLinkCollisions, 0]
        steps = [
            lambda: snake.SetDOFValues(random.uniform(-1.5, 1.5, snake.GetDOF())),
            lambda: place(snake, random.uniform(-1, 1, 3), random.uniform(-1, 1, 3)),
            lambda: place(random.choice(bodies), random.uniform(-1.5, 1.5, 3), random.uniform(-1, 1, 3)),
            lambda: snake.GetLinks()[8].SetTransform(random.choice(bodies).GetTransform()),
            lambda: random.choice(snake.GetLinks()).Enable(bool(random.integers(2))),
            lambda: random.choice(bodies).Enable(bool(random.integers(3))),
            lambda: snake.Grab(random.choice(bodies), snake.GetLinks()[6]),
            snake.ReleaseAllGrabbed,
            lambda: snake.SetAdjacentLinks(*(int(link) for link in random.choice(snake.GetNonAdjacentLinks()))),
            lambda: checker.SetCollisionOptions(int(random.choice(options[:3]) | random.choice(options))),
            lambda: snake.batch_collides(random.uniform(-1, 1, (60, snake.GetDOF())), bool(random.integers(2))),
            lambda: self.ask_as_planners(env, snake, random),
        ]
        for _ in range(count):
            random.choice(steps)()
            self.compare(env, snake, random)
        env.Destroy()

    @staticmethod
    def ask_as_planners(env, snake, random):
        with env, snake:
            collides = moving_test(snake.simulation_state, range(snake.GetDOF()))
            if collides is not None:
                collides(random.uniform(-1, 1, snake.GetDOF()))

    def test_as_planners_ask(self, env, snake):
        values = np.random.default_rng(3).uniform(-2.5, 2.5, (60, snake.GetDOF()))
        before = snake.GetLinkTransformations()
        with env, snake:
            collides = moving_test(snake.simulation_state, range(snake.GetDOF()))
            found = [collides(one) for one in values]
        np.testing.assert_array_equal(snake.GetLinkTransformations(), before)
        for one, answer in zip(values, found, strict=True):
            snake.SetDOFValues(one)
            assert answer == (env.CheckCollision(snake) or snake.CheckSelfCollision())
        assert 0 < sum(found) < len(found)

    def test_with_clearance_hulls_that_nearly_touch_count_unless_they_do_at_an_end(self, env, snake):
        values, options = np.random.default_rng(4).uniform(-2.5, 2.5, (400, snake.GetDOF())), CollisionOptions.Distance
        with env, snake:
            collides = moving_test(snake.simulation_state, range(snake.GetDOF()))
            is_clear = collides.with_clearance([])
            free = [not collides(one) for one in values]
            clear = [is_clear(one) for one in values]
            close = values[np.array(free) & ~np.array(clear)]
            assert all(collides.with_clearance([one])(one) for one in close)
            assert [not collides(one) for one in values] == free, "the margin is used by no other test"
        assert not any(clear[row] and not free[row] for row in range(len(values)))
        assert len(close) > 2
        env.GetCollisionChecker().SetCollisionOptions(options)
        report, size = CollisionReport(), 2 * np.linalg.norm(snake.ComputeAABB().extents())
        for one in close:
            snake.SetDOFValues(one)
            gaps = []
            for ask in (env.CheckCollision, lambda body, report: body.CheckSelfCollision(report)):
                assert not ask(snake, report=report)
                gaps.append(report.minDistance)
            assert 0 < min(gaps) < 0.01 * size

    def test_the_masks_of_the_model_are_back(self, env, snake):
        """A user may step the model, in which everything collides."""
        before, flags = [env.model.body_contype.copy(), env.model.body_conaffinity.copy()], env.model.opt.disableflags
        self.check(env, snake)
        snake.batch_collides(np.zeros((60, snake.GetDOF())))
        np.testing.assert_array_equal([env.model.body_contype, env.model.body_conaffinity], before)
        assert env.model.opt.disableflags == flags
        assert (env.model.body_contype[1:] > 0).all()

    def test_more_contacts_than_fit_into_memory(self, env, snake, monkeypatch):
        monkeypatch.setattr(pairs, "_MOST_CONTACTS", 0.0)
        for number in range(5):
            snake.SetDOFValues(np.full(snake.GetDOF(), 0.3 * number))
            self.check(env, snake)


@pytest.mark.parametrize("place", [(0.45, 0.1, 0.5), (0, 0, -0.05)], ids=["before it", "under its base"])
def test_batch_follows_mimic_and_displaced_joints(place):
    env = ravemj.load(MODELS / "panda.xml")
    panda = env.GetRobots()[0]
    box(env, "box", place, (0.15, 0.15, 0.15))
    finger = panda.GetLinks()[-1]
    finger.SetTransform(finger.GetTransform() @ ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, 0.3]))
    displaced = finger.GetTransform()
    values = np.random.default_rng(5).uniform(*panda.GetDOFLimits(), (60, panda.GetDOF()))
    found = {itself: panda.batch_collides(values, itself).tolist() for itself in (False, True)}
    np.testing.assert_array_equal(finger.GetTransform(), displaced)
    for row, *answers in zip(values, *found.values(), strict=True):
        panda.SetDOFValues(row)
        others = env.CheckCollision(panda)
        assert answers == [others, others or panda.CheckSelfCollision()]
    assert sum(found[False]) == len(values) if place[0] == 0 else 0 < sum(found[False]) < len(values)
    for threads in (1, 2, 0):
        ravemj.set_batch_threads(threads)
        assert panda.batch_collides(values).tolist() == found[True]
    env.GetKinBody("box").SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, 9, 9, 9]))
    assert not panda.batch_collides(values, itself_too=False).any()


@pytest.mark.parametrize("texts", [(ARM, THING), (THING, ARM)], ids=["the arm first", "what it holds first"])
def test_batch_agrees_with_single_questions(env, texts):
    for text in texts:
        env.LoadData(text)
    arm, thing = env.GetRobot("arm"), env.GetKinBody("thing")
    far = [(2.4 * np.cos(angle), 2.4 * np.sin(angle), 0.3) for angle in (0.5, 1.5, 2.5, 4)]  # what is held gets there
    for number, position in enumerate([(1.2, 0.7, 0.3), (-0.5, 1.0, 0.3), (0.3, -1.2, 0.3), *far]):
        box(env, f"box{number}", position, (0.2, 0.2, 0.1))
    place(thing, (2.2, 0, 0.3), (0.3, 0, 0))
    box(env, "on thing", (2.2, 0, 0.6), (0.1, 0.02, 0.02))
    thing.SetDOFValues([0.4])
    thing.Grab(env.GetKinBody("on thing"), thing.GetLinks()[1])
    arm.Grab(thing)
    values = np.random.default_rng(4).uniform(*arm.GetDOFLimits(), (60, arm.GetDOF()))
    values[::2, 1] *= 0.2  # stretched out
    arm.SetDOFValues([0.1, 0.2, 0.3])
    before, held = arm.GetLinkTransformations(), thing.GetTransform()
    with_itself, without = arm.batch_collides(values), arm.batch_collides(values, itself_too=False)
    itself, gaps = arm.batch_self_collides(values), [arm.batch_distances(values, both) for both in (False, True)]
    np.testing.assert_array_equal(arm.GetLinkTransformations(), before)
    np.testing.assert_array_equal(arm.GetDOFValues(), [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(thing.GetTransform(), held)
    for row, all_hits, hits in zip(values, with_itself, without, strict=True):
        arm.SetDOFValues(row)
        assert env.CheckCollision(arm) == hits
        assert (env.CheckCollision(arm) or arm.CheckSelfCollision()) == all_hits
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.Distance)
    for row, hits, *near in zip(values, itself, *gaps, strict=True):
        arm.SetDOFValues(row)
        reports = CollisionReport(), CollisionReport()
        env.CheckCollision(arm, reports[0])
        assert arm.CheckSelfCollision(reports[1]) == hits
        distances = [report.minDistance for report in reports]
        np.testing.assert_allclose(np.maximum(near, 0), [distances[0], min(distances)], atol=1e-12)
    np.testing.assert_array_equal(np.array(gaps) <= 1e-9, [without, with_itself])
    assert 0 < itself.sum() < len(values)
    assert 0 < without.sum() < with_itself.sum() < len(values)
    assert arm.batch_collides(np.zeros((0, 3))).shape == (0,)
    with pytest.raises(ravemj.openrave_exception, match="shape"):
        arm.batch_collides([0, 0, 0])


@pytest.mark.stress
def test_thousands_of_bodies(env):
    """A grid in which each body touches none, and one across two of them."""
    for number in range(1500):
        x, y = divmod(number, 50)
        sphere(env, f"s{number}", (x, y, 0), 0.3)
    probe = box(env, "probe", (10.5, 20, 0), (0.4, 0.1, 0.1))
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.AllLinkCollisions)
    report = CollisionReport()
    assert env.CheckCollision(probe, report)
    assert colliding(report) == {frozenset(("probe", f"s{x * 50 + 20}")) for x in (10, 11)}
    place(probe, (10.5, 20.5, 0))
    assert not env.CheckCollision(probe)
    assert not any(env.CheckCollision(env.GetKinBody(f"s{number}")) for number in range(0, 1500, 100))


SHAPES = st.sampled_from(["box", "sphere", "cylinder", "capsule", "trimesh"])


@examples(60)
@given(SHAPES, positions, turns, st.tuples(*[st.floats(0.1, 1.0)] * 3))
def test_bounds_hold_the_shape_tightly(kind, position, turn, sizes):
    """Against many points of the surface."""
    env = ravemj.Environment()
    points = added(env, "shape", lambda body: body.InitFromGeometries([geometry_info(kind, sizes)]))
    place(points, position, turn)
    bounds = points.ComputeAABB()
    surface = surface_points(kind, sizes) @ points.GetTransform()[:3, :3].T + position
    low, high = surface.min(axis=0), surface.max(axis=0)
    slack = 1e-9 if kind in {"box", "trimesh"} else 0.01
    assert (bounds.pos() - bounds.extents() <= low + 1e-9).all()
    assert (bounds.pos() + bounds.extents() >= high - 1e-9).all()
    np.testing.assert_allclose(bounds.pos() - bounds.extents(), low, atol=slack)
    np.testing.assert_allclose(bounds.pos() + bounds.extents(), high, atol=slack)
    local = points.ComputeLocalAABB()
    link = points.GetLinks()[0]
    np.testing.assert_allclose(link.ComputeLocalAABB().extents(), local.extents(), atol=1e-12)
    np.testing.assert_allclose(link.ComputeAABB().extents(), bounds.extents(), atol=1e-12)
    np.testing.assert_allclose(
        link.GetGeometries()[0].ComputeAABB(points.GetTransform()).pos(), bounds.pos(), atol=1e-12
    )


def geometry_info(kind, sizes):
    info = KinBody.GeometryInfo()
    info._type = getattr(ravemj.GeometryType, kind.capitalize())
    info._vGeomData = {"sphere": sizes[:1], "box": sizes}.get(kind, sizes[:2])
    if kind == "trimesh":
        info._meshcollision = ravemj.TriMesh(BOX * sizes, BOX_TRIANGLES)
    return info


def surface_points(kind, sizes):
    if kind in {"box", "trimesh"}:
        return BOX * sizes
    angle, height = np.meshgrid(np.linspace(0, 2 * np.pi, 200), np.linspace(-np.pi / 2, np.pi / 2, 101))
    ball = np.stack([np.cos(height) * np.cos(angle), np.cos(height) * np.sin(angle), np.sin(height)], -1).reshape(-1, 3)
    radius, half_height = sizes[0], sizes[1] / 2
    if kind == "sphere":
        return ball * radius
    if kind == "capsule":
        return ball * radius + np.sign(np.round(ball[:, 2:], 9)) * [0, 0, half_height]
    rim = ball / np.maximum(np.linalg.norm(ball[:, :2], axis=1, keepdims=True), 1e-9) * radius
    return np.column_stack([rim[:, :2], np.where(ball[:, 2] < 0, -half_height, half_height)])
