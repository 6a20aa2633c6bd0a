"""Ctrl + Shift + drag: a link follows the pointer, and the joints above it come along."""

import itertools

import numpy as np
import pytest
from test_interaction import FROM_FRONT, Hand

import ravemj
from ravemj.formats.shipped import model_path
from ravemj.gui.interaction import Move, Operate, Press, Release, Wheel, pick

PULL = {"ctrl": True, "shift": True}


def pull(hand, point, target):
    """Drag a point of the world to where another one is seen; both are as deep in the view."""
    hand.drag(hand.at(point), hand.at((np.array(point) + target) / 2), hand.at(target), **PULL)


@pytest.fixture
def arm():
    env = ravemj.load(model_path("puma560"))
    hand = Hand(env)
    robot = env.GetRobots()[0]
    robot.SetDOFValues([0.1, -0.5, -1.2, 0.3, 0.6, 0.2])
    T_world_hand = robot.GetLinks()[-1].GetTransform()
    place = T_world_hand[:3, 3]
    camera = ravemj.transformLookat(lookat=place, camerapos=place + np.array([1.5, 1.0, 0.3]), cameraup=[0, 0, -1])
    hand.gui.look_from(ravemj.graphics.rendering.Camera(camera), 1.8)
    return hand.in_interaction()


def surface(hand, robot):
    """A place on the hand of the robot that is seen, and the link that it is on."""
    hit_at = hand.at(robot.GetLinks()[-1].GetTransform()[:3, 3])
    hand.lines(hit_at)
    hit = hand.gui.hover
    return hit.position, robot.GetLinks()[hit.link]


def test_the_hand_follows_the_pointer_and_hardly_turns(arm):
    robot = arm.env.GetRobots()[0]
    point, link = surface(arm, robot)
    before = link.GetTransform()
    local = np.linalg.inv(before) @ [*point, 1]
    right, down = arm.view.camera.rotation[:, 0], arm.view.camera.rotation[:, 1]
    target = point + 0.06 * right - 0.04 * down
    pull(arm, point, target)
    after = link.GetTransform()
    np.testing.assert_allclose((after @ local)[:3], target, atol=2e-3)
    np.testing.assert_allclose(after[:3, :3], before[:3, :3], atol=0.25)


def test_limits_hold_and_what_is_out_of_reach_is_come_near_to(arm):
    robot = arm.env.GetRobots()[0]
    point, link = surface(arm, robot)
    local = np.linalg.inv(link.GetTransform()) @ [*point, 1]
    for way in ([3, 0], [-3, 1], [0, -4], [1, 4]):
        aside = way[0] * arm.view.camera.rotation[:, 0] + way[1] * arm.view.camera.rotation[:, 1]
        held = (link.GetTransform() @ local)[:3]
        arm.drag(arm.at(held), arm.at(held + 0.5 * aside), arm.at(held + aside), **PULL)
        lower, upper = robot.GetDOFLimits()
        assert (robot.GetDOFValues() >= lower - 1e-9).all()
        assert (robot.GetDOFValues() <= upper + 1e-9).all()
        assert np.isfinite(robot.GetDOFValues()).all()


def test_the_pendulum_swings_to_the_pointer(env):
    hand = Hand(env, FROM_FRONT).in_interaction()
    robot = env.GetRobots()[0]
    held = np.array([0.03, 0, -0.35])
    link = robot.GetLinks()[2]
    local = np.linalg.inv(link.GetTransform()) @ [*held, 1]
    ((x, y),), _ = hand.view.camera.project([held], *hand.view.size)
    hand.lines((x, y))
    hit = hand.gui.hover
    assert hit.link == 2
    local = np.linalg.inv(link.GetTransform()) @ [*hit.position, 1]
    target = hit.position + np.array([0, 0.1, 0.08])
    pull(hand, hit.position, target)
    np.testing.assert_allclose((link.GetTransform() @ local)[1:3], target[1:], atol=3e-3)


def test_what_no_joint_moves_says_so(env):
    hand = Hand(env, FROM_FRONT).in_interaction()
    robot = env.GetRobots()[0]
    seen = ((at, pick(env.simulation, hand.view.ray(*at))) for at in itertools.product(range(300, 500, 8), repeat=2))
    at = next(at for at, hit in seen if hit is not None and hit.link == 0)
    hand.drag(at, (at[0] + 40, at[1] + 10), **PULL)
    assert not robot.GetDOFValues().any()
    assert any("no joint moves" in line for line in hand.gui.overlay().lines)


def test_beside_bodies_and_in_camera_mode_nothing_is_pulled(env):
    hand = Hand(env, FROM_FRONT)
    before = hand.view
    hand.drag((400, 330), (450, 350), **PULL)
    assert hand.view is not before, "Shift translates the view"
    hand.in_interaction().drag((5, 5), (60, 60), **PULL)
    assert not env.GetRobots()[0].GetDOFValues().any()


# --- other configurations, redundant arms, the button


def test_the_other_branches_show_as_ghosts_while_a_hand_is_pulled(arm):
    robot = arm.env.GetRobots()[0]
    robot.SetDOFValues([0.1, -0.5, -1.2, 0.3, 0.6, 0.2])
    flange = robot.GetLinks()[6]
    x, y = arm.at(flange.GetTransform()[:3, 3])
    at = next(
        (x + i, y + j)
        for i in range(-60, 61, 4)
        for j in range(-60, 61, 4)
        if (arm.lines((x + i, y + j)), arm.gui.hover)[1] is not None and arm.gui.hover.link == 6
    )
    held = np.linalg.inv(flange.GetTransform()) @ [*arm.gui.hover.position, 1]
    arm.gui.handle(Press(*at, **PULL))
    arm.gui.handle(Move(at[0] + 20, at[1]))
    joints = arm.gui.overlay().primitives.points.corners[:, 0]
    assert len(joints) > 0
    assert len(joints) % 7 == 0  # six joints and the tool
    shoulder = robot.GetJoints()[0].GetAnchor()
    for ghost in joints.reshape(-1, 7, 3):
        np.testing.assert_allclose(ghost[-1], (flange.GetTransform() @ held)[:3], atol=1e-6)
        np.testing.assert_allclose(ghost[0], shoulder, atol=1e-9)
        assert np.abs(ghost - joints[:7]).max() == 0 or np.abs(ghost - joints[:7]).max() > 0.01
    arm.gui.handle(Release(*at))
    assert not len(arm.gui.overlay().primitives.points.corners)


def test_the_wheel_moves_a_redundant_arm_while_its_hand_stays():
    env = ravemj.load(model_path("panda"))
    robot = env.GetRobots()[0]
    robot.SetDOFValues([0.1, -0.5, 0.2, -1.8, 0.1, 1.6, 0.7], range(7))
    grip = robot.GetLink("hand")
    place = grip.GetTransform()[:3, 3]
    camera = ravemj.transformLookat(lookat=place, camerapos=place + np.array([1.5, 1.0, 0.3]), cameraup=[0, 0, -1])
    hand = Hand(env, camera).in_interaction()
    at = hand.at(place)
    hand.gui.handle(Press(*at, **PULL))
    hand.gui.handle(Move(at[0] + 10, at[1]))
    assert hand.selection.link == grip.GetIndex()
    values, T_world_hand = robot.GetDOFValues(), grip.GetTransform()
    view = hand.view
    for _ in range(3):
        hand.gui.handle(Wheel(1))
    np.testing.assert_allclose(grip.GetTransform(), T_world_hand, atol=1e-6)
    assert robot.GetDOFValues()[6] - values[6] > 0.05
    hand.gui.handle(Wheel(-3))
    np.testing.assert_allclose(robot.GetDOFValues(), values, atol=0.02)
    assert hand.view == view
    hand.gui.handle(Release(at[0] + 10, at[1]))
    hand.gui.handle(Wheel(1))
    np.testing.assert_allclose(robot.GetDOFValues(), values, atol=0.02)  # nothing is held any more


def test_a_slider_sweeps_the_free_joint_of_a_redundant_arm_while_its_hand_stays():
    env = ravemj.load(model_path("panda"))
    robot = env.GetRobots()[0]
    robot.SetDOFValues([0.1, -0.5, 0.2, -1.8, 0.1, 1.6, 0.7], range(7))
    grip = robot.GetLink("hand")
    place = grip.GetTransform()[:3, 3]
    camera = ravemj.transformLookat(lookat=place, camerapos=place + np.array([1.5, 1.0, 0.3]), cameraup=[0, 0, -1])
    hand = Hand(env, camera).in_interaction()
    assert slider(hand) is None
    at = hand.at(place)
    hand.drag(at, (at[0] + 10, at[1]), **PULL)
    shown = slider(hand)
    lower, upper = robot.GetDOFLimits([6])
    assert (shown.label, shown.lower, shown.upper) == ("joint7, hand stays", lower[0], upper[0])
    T_world_hand = grip.GetTransform()
    for value in (0.2, 1.1, 0.6):
        hand.gui.handle(Operate("sweep", value))
        assert robot.GetDOFValues()[6] == pytest.approx(value, abs=1e-3)
        assert slider(hand).value == robot.GetDOFValues()[6]
        np.testing.assert_allclose(grip.GetTransform(), T_world_hand, atol=1e-6)
    hand.gui.handle(Operate("sweep", lower[0]))  # limits of other joints come first
    values = robot.GetDOFValues()
    assert lower[0] + 0.1 < values[6] < 0.2
    assert (values >= robot.GetDOFLimits()[0]).all()
    np.testing.assert_allclose(grip.GetTransform(), T_world_hand, atol=1e-6)
    robot.SetDOFValues([0.4], [0])  # somebody else moves it: it stays where it is now
    T_world_hand = grip.GetTransform()
    hand.gui.handle(Operate("sweep", 0.5))
    np.testing.assert_allclose(grip.GetTransform(), T_world_hand, atol=1e-6)
    hand.gui.handle(Operate("tree"))
    assert slider(hand) is None
    hand.gui.handle(Operate("tree"))
    assert slider(hand) is not None
    hand.click((5, 5))
    assert slider(hand) is None


def test_an_arm_that_is_not_redundant_has_no_such_slider(arm):
    point, _ = surface(arm, arm.env.GetRobots()[0])
    arm.drag(arm.at(point), arm.at(point + 0.02 * arm.view.camera.rotation[:, 0]), **PULL)
    assert slider(arm) is None, "six joints leave nothing free"


def slider(hand):
    """Return the slider that sweeps an arm, or None."""
    return next((control for control in hand.gui.overlay().controls if control.name == "sweep"), None)


def test_the_wheel_leaves_an_arm_without_free_joints_where_it_is(arm):
    robot = arm.env.GetRobots()[0]
    point, _ = surface(arm, robot)
    arm.gui.handle(Press(*arm.at(point), **PULL))
    arm.gui.handle(Move(*arm.at(point + 0.03 * arm.view.camera.rotation[:, 0])))
    before = robot.GetDOFValues()
    arm.gui.handle(Wheel(5))
    np.testing.assert_array_equal(robot.GetDOFValues(), before)


def test_with_the_button_a_plain_drag_pulls(arm):
    robot = arm.env.GetRobots()[0]
    point, link = surface(arm, robot)
    before, base = link.GetTransform(), robot.GetTransform()
    arm.gui.handle(Operate("pull"))
    target = point + 0.05 * arm.view.camera.rotation[:, 0]
    arm.drag(arm.at(point), arm.at((point + target) / 2), arm.at(target))
    assert np.linalg.norm(link.GetTransform()[:3, 3] - before[:3, 3]) > 0.02
    np.testing.assert_array_equal(robot.GetTransform(), base)
    arm.gui.handle(Operate("pull"))
    after = robot.GetDOFValues()
    arm.drag(arm.at(target), arm.at(point))
    np.testing.assert_array_equal(robot.GetDOFValues(), after)


@pytest.fixture
def biped():
    env = ravemj.load(model_path("biped"))
    hand = Hand(env)
    camera = ravemj.transformLookat(lookat=[0, 0, 0.5], camerapos=[1.6, -1.2, 0.9], cameraup=[0, 0, -1])
    hand.gui.look_from(ravemj.graphics.rendering.Camera(camera), 2.0)
    return hand.in_interaction()


def pin(hand, robot, name):
    """Press K over a link."""
    hand.lines(hand.at(robot.GetLink(name).ComputeAABB().pos()))
    assert hand.gui.hover.link == robot.GetLink(name).GetIndex()
    hand.press_key("p")


def test_pinned_feet_stay_and_the_base_moves(biped):
    robot = biped.env.GetRobots()[0]
    without = len(biped.gui.overlay().primitives.spheres.sizes)
    for foot in ("LFoot", "RFoot"):
        pin(biped, robot, foot)
    assert len(biped.gui.overlay().primitives.spheres.sizes) == without + 2, "pins are shown"
    feet = [robot.GetLink(name).GetTransform() for name in ("LFoot", "RFoot")]
    base = robot.GetTransform()
    point = robot.GetLink("RHand").ComputeAABB().pos()
    target = point + 0.1 * biped.view.camera.rotation[:, 0] + 0.1 * biped.view.camera.rotation[:, 1]
    pull(biped, point, target)
    for name, before in zip(("LFoot", "RFoot"), feet, strict=True):
        np.testing.assert_allclose(robot.GetLink(name).GetTransform(), before, atol=1e-6)
    now = robot.GetLink("RHand").ComputeAABB().pos()
    assert np.linalg.norm(now - target) < 0.05
    assert np.abs(robot.GetTransform() - base).max() > 1e-3
    pull(biped, now, now + 1.5 * biped.view.camera.rotation[:, 0])
    assert any("RHand gives in" in line for line in biped.gui.overlay().lines)


def test_without_pins_the_base_stays(biped):
    robot = biped.env.GetRobots()[0]
    base = robot.GetTransform()
    pin(biped, robot, "LFoot")
    pin(biped, robot, "LFoot")
    point = robot.GetLink("RHand").ComputeAABB().pos()
    pull(biped, point, point + 0.1 * biped.view.camera.rotation[:, 1])
    np.testing.assert_array_equal(robot.GetTransform(), base)


def test_the_button_pins_what_is_selected(biped):
    robot = biped.env.GetRobots()[0]
    assert "pin" not in [control.name for control in biped.gui.overlay().controls]
    biped.click(biped.at(robot.GetLink("LFoot").ComputeAABB().pos()))
    for is_on in (False, True, False):
        (button,) = [control for control in biped.gui.overlay().controls if control.name == "pin"]
        assert button.is_on is is_on
        biped.gui.handle(Operate("pin"))
