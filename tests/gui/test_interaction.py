"""The mouse and the keys without a window: every gesture, with the poses that it should lead to."""

import math

import numpy as np
import pytest

import ravemj
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import (
    Button,
    Fingers,
    Interaction,
    Key,
    Leave,
    Mode,
    Move,
    Press,
    Release,
    Resize,
    Use,
    ViewButton,
    Viewpoint,
    Wheel,
    button_rects,
    pick,
)
from ravemj.gui.interaction.cube import Cube
from ravemj.gui.interaction.joint_handle import JointHandle
from ravemj.gui.interaction.shortcuts import KEYS
from ravemj.model import drawing

SIZE = 800, 600
FROM_FRONT = np.array([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
ASLANT = np.array(
    [[-0.643, 0.324, -0.694, 0.943], [0.766, 0.272, -0.583, 0.792], [0, -0.906, -0.423, 0.474], [0, 0, 0, 1]]
)


class Hand:
    """Moves the mouse over a view, in the world's terms where it helps."""

    def __init__(self, env, T_world_camera=FROM_FRONT, **more):
        self.env = env
        self.gui = Interaction.first_view(env.simulation, Camera(T_world_camera), SIZE, **more)

    @property
    def view(self) -> Viewpoint:
        return self.gui.view

    @property
    def selection(self):
        return self.gui.selection

    def at(self, point) -> tuple[float, float]:
        """Where a point of the world is on the screen."""
        ((x, y),), _ = self.view.camera.project([point], *self.view.size)
        return float(x), float(y)

    def drag(self, start, *stops, button=Button.LEFT, **modifiers):
        self.gui.handle(Press(*start, button, **modifiers))
        for stop in stops:
            self.gui.handle(Move(*stop))
        self.gui.handle(Release(*stops[-1], button))

    def click(self, at, **modifiers):
        self.drag(at, at, **modifiers)

    def press_key(self, name):
        self.gui.handle(Key(name))
        self.gui.handle(Key(name, False))

    def in_interaction(self) -> "Hand":
        self.press_key("escape")
        return self

    def lines(self, at=None):
        self.gui.handle(Leave() if at is None else Move(*at))
        return self.gui.overlay().lines


@pytest.fixture
def hand(env):
    return Hand(env)


@pytest.fixture
def boxes():
    """Two boxes beside each other, the second one turned, and a robot with a slider."""
    env = ravemj.Environment()
    for name, y in (("left", -0.3), ("right", 0.3)):
        body = ravemj.RaveCreateKinBody(env, "")
        body.InitFromBoxes(np.array([[0, 0, 0, 0.1, 0.05, 0.15]]), True)
        body.SetName(name)
        env.Add(body)
        body.SetTransform([1, 0, 0, 0, 0, y, 0])
    return env


def about(point, axis, angle):
    turn = ravemj.matrixFromAxisAngle(axis, angle)
    turn[:3, 3] = point - turn[:3, :3] @ point
    return turn


# --- camera mode


def test_rays_go_through_the_points_that_project_there(hand):
    rng = np.random.default_rng(1)
    view = Viewpoint(Camera(ravemj.matrixFromPose([0.5, 0.5, 0.5, 0.5, 1, 2, 3])), 1.0, SIZE)
    for x, y in rng.uniform([0, 0], SIZE, (20, 2)):
        ray = view.ray(x, y)
        assert np.linalg.norm(ray.direction) == pytest.approx(1)
        projected, _ = view.camera.project([ray.start + 3 * ray.direction], *SIZE)
        assert projected[0] == pytest.approx([x, y])


def test_left_drag_turns_about_the_focus(hand):
    hand.gui.look_from(Camera(FROM_FRONT), 1.0)
    hand.drag((400, 300), (450, 300), (550, 300))
    expected = about(np.zeros(3), [0, 0, 1], -math.pi * 150 / 600) @ FROM_FRONT
    np.testing.assert_allclose(hand.view.camera.T_world_camera, expected, atol=1e-12)
    hand.gui.look_from(Camera(FROM_FRONT))
    hand.drag((400, 300), (400, 200))
    expected = about(np.zeros(3), [0, 1, 0], math.pi * 100 / 600) @ FROM_FRONT
    np.testing.assert_allclose(hand.view.camera.T_world_camera, expected, atol=1e-12)
    assert hand.view.distance == 1.0


def test_a_surface_before_the_focus_follows_the_pointer_when_the_view_turns(hand):
    hand.gui.look_from(Camera(FROM_FRONT), 1.0)
    for way in ((10, 0), (0, 10), (-7, 3)):
        before = np.array(hand.at([0.01, 0, 0]))
        hand.drag((400, 300), (400 + way[0], 300 + way[1]))
        assert (np.array(hand.at([0.01, 0, 0])) - before) @ way > 0
        hand.gui.look_from(Camera(FROM_FRONT))


def test_a_drag_back_to_its_start_brings_the_old_view_back(hand):
    hand.drag((400, 300), (600, 100), (20, 500), (400, 300))
    np.testing.assert_allclose(hand.view.camera.T_world_camera, FROM_FRONT, atol=1e-12)


@pytest.mark.parametrize("how", [{"shift": True}, {"button": Button.MIDDLE}])
def test_shift_or_the_middle_button_translate_with_the_focus_under_the_pointer(hand, how):
    hand.gui.look_from(Camera(ASLANT), 0.8)
    focus, rotation = hand.view.focus, hand.view.camera.rotation
    start = hand.at(focus)
    hand.drag(start, (500, 200), (430, 350), **how)
    assert hand.at(focus) == pytest.approx((430, 350))
    np.testing.assert_allclose(hand.view.camera.rotation, rotation, atol=1e-12)
    assert np.linalg.norm(hand.view.focus - hand.view.camera.position) == pytest.approx(0.8)


def test_the_wheel_zooms(hand):
    hand.gui.look_from(Camera(FROM_FRONT), 1.0)
    hand.gui.handle(Wheel(2))
    np.testing.assert_allclose(hand.view.camera.position, [0.81, 0, 0], atol=1e-12)
    hand.gui.handle(Wheel(-2))
    np.testing.assert_allclose(hand.view.camera.position, [1, 0, 0], atol=1e-12)
    for _ in range(100):
        hand.gui.handle(Wheel(-1e9))
    assert np.isfinite(hand.view.camera.T_world_camera).all()


def test_s_and_a_click_centre_on_the_surface_and_later_turns_are_about_it(hand):
    target = np.array([0.01, 0, -0.35])  # on the front of the second arm
    hand.gui.handle(Key("s"))
    hand.click(hand.at(target))
    hand.gui.handle(Key("s", False))
    np.testing.assert_allclose(hand.view.focus, target, atol=1e-9)
    assert hand.at(target) == pytest.approx((400, 300))
    assert hand.view.distance == pytest.approx(np.linalg.norm(target - [1, 0, 0]) / 2)
    hand.drag((400, 300), (100, 20))
    assert hand.at(target) == pytest.approx((400, 300))
    assert np.linalg.norm(hand.view.camera.position - target) == pytest.approx(hand.view.distance)
    before = hand.view
    hand.gui.handle(Key("s"))
    hand.click((10, 10))
    assert hand.view is before, "there is nothing to centre on"


def test_the_first_turn_is_about_the_middle_of_the_scene_in_depth(env):
    hand = Hand(env, ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, -2.0]))
    hand.drag((0, 300), (600, 300))
    middle = -0.4 / 2 + 0.015  # the base reaches 3 cm above the origin
    np.testing.assert_allclose(hand.view.focus, [0, 0, middle], atol=1e-9)


def test_the_wheels_on_the_screen_turn_and_zoom_in_both_modes(hand):
    for _ in range(2):
        hand.gui.look_from(Camera(FROM_FRONT), 1.0)
        for tool, way, expected in (
            (ViewButton.ROT_X, (30, 60), about(np.zeros(3), [0, 1, 0], -math.pi / 10)),
            (ViewButton.ROT_Y, (60, 30), about(np.zeros(3), [0, 0, 1], -math.pi / 10)),
            (ViewButton.DOLLY, (0, 60), np.diag([math.exp(-0.4), 1, 1, 1])),
        ):
            hand.gui.look_from(Camera(FROM_FRONT))
            rect = button_rects(SIZE)[tool]
            start = rect.x + 5, rect.y + 5
            hand.drag(start, (start[0] + way[0], start[1] + way[1]))
            position = expected @ FROM_FRONT[:, 3]
            np.testing.assert_allclose(hand.view.camera.position, position[:3], atol=1e-12)
            hand.gui.look_from(Camera(FROM_FRONT), 1.0)
        hand.press_key("escape")


def test_keys_and_buttons_do_nothing_else(hand, robot):
    before = hand.view
    for name in {*"abcdefghijklmnopqrtuvwxyz"} - KEYS.keys():
        hand.press_key(name)
    hand.drag((400, 300), (420, 350), button=Button.RIGHT)
    hand.gui.handle(Move(300, 300))
    assert hand.view is before
    hand.in_interaction()
    hand.gui.handle(Wheel(3))
    hand.drag((10, 200), (60, 250))
    hand.drag((400, 330), (450, 350), shift=True)
    hand.drag((400, 330), (450, 350), button=Button.MIDDLE)
    hand.drag((400, 330), (450, 350), button=Button.RIGHT)
    assert hand.view is before
    assert hand.selection is None
    assert not robot.GetDOFValues().any()


# --- modes and the layout


def test_escape_and_the_buttons_switch_modes(hand):
    assert hand.gui.mode is Mode.CAMERA
    hand.gui.handle(Key("Escape"))
    hand.gui.handle(Key("escape"))  # it repeats while it is held
    assert hand.gui.mode is Mode.INTERACTION
    hand.gui.handle(Key("escape", False))
    hand.press_key("escape")
    assert hand.gui.mode is Mode.CAMERA
    rects = button_rects(SIZE)
    for tool, mode in ((ViewButton.INTERACT, Mode.INTERACTION), (ViewButton.CAMERA, Mode.CAMERA)):
        hand.click((rects[tool].x + 3, rects[tool].y + 3))
        assert hand.gui.mode is mode


def test_buttons_and_wheels_are_on_the_view_apart_from_each_other():
    for size in ((400, 300), (1920, 1080)):
        rects = list(button_rects(size).values())
        assert len(rects) == 5
        for rect in rects:
            assert rect.x >= 0
            assert rect.y >= 0
            assert rect.x + rect.width <= size[0]
            assert rect.y + rect.height <= size[1]
            centre = rect.x + rect.width / 2, rect.y + rect.height / 2
            assert sum(other.contains(*centre) for other in rects) == 1
    assert button_rects((200, 150)) == {}
    hand = Hand(ravemj.Environment())
    hand.gui.handle(Resize(1920, 1080))
    labels = [panel.text for panel in hand.gui.overlay().panels if panel.text]
    assert labels[:3] == ["RotX", "RotY", "Dolly"]


# --- picking and text


def test_the_text_is_about_what_is_under_the_pointer(hand):
    assert hand.lines(hand.at([0.01, 0, -0.3])) == (
        "Arm1: (x, y, z) = (0.010, 0.000, -0.300), n = (1.000, 0.000, 0.000)",
    )
    assert hand.lines(hand.at([0.01, 0, -0.1]))[0].startswith("Arm0: ")
    assert hand.lines((5, 300)) == ()
    assert hand.lines() == ()


def test_the_text_stays_true_when_the_scene_moves_under_the_pointer(hand, robot):
    hand.gui.handle(Move(*hand.at([0.01, 0, -0.3])))
    robot.SetDOFValues([math.pi, 0])
    assert hand.gui.overlay().lines == ()


def test_the_version_tells_when_to_draw_again(hand):
    hand.gui.handle(Move(5, 300))
    before = hand.gui.appearance
    hand.gui.handle(Move(6, 300))
    assert hand.gui.appearance == before, "nothing is under the pointer"
    for event in (Move(*hand.at([0, 0, -0.3])), Move(6, 300), Press(6, 300), Move(7, 300), Key("escape"), Resize(9, 9)):
        before = hand.gui.appearance
        hand.gui.handle(event)
        assert hand.gui.appearance != before, event


def test_what_is_invisible_is_not_picked(boxes):
    ray = Viewpoint(Camera(FROM_FRONT), 1.0, SIZE).ray(*Hand(boxes).at([0, 0.3, 0]))
    assert pick(boxes.simulation, ray).body.scene.name == "right"
    boxes.GetKinBody("right").GetLinks()[0].SetVisible(False)
    assert pick(boxes.simulation, ray) is None


# --- selecting bodies


def test_a_click_selects_and_a_second_one_hides_the_cube(boxes):
    hand = Hand(boxes).in_interaction()
    left, right = (hand.at([0.1, y, 0]) for y in (-0.3, 0.3))
    hand.click(left)
    assert hand.selection.body.scene.name == "left"
    assert len(hand.gui.overlay().primitives) > 0
    assert hand.lines()[1:] == ("Body left",)
    hand.drag(right, (right[0] + 2, right[1] + 1))  # a hand that trembles
    assert hand.selection.body.scene.name == "right"
    hand.click(right)
    assert hand.selection is None
    assert hand.gui.overlay().primitives is drawing.NOTHING
    hand.click(left)
    hand.click((400, 590))
    assert hand.selection is None, "a click on nothing"
    hand.press_key("escape")
    hand.click(left)
    assert hand.selection is None, "camera mode selects nothing"


def test_the_robot_is_told_by_its_name(hand):
    hand.in_interaction().click(hand.at([0.01, 0, -0.3]))
    assert hand.lines() == (
        "Arm1: (x, y, z) = (0.010, 0.000, -0.300), n = (1.000, 0.000, 0.000)",
        "Robot Pendulum",
    )


def test_callbacks_are_asked_before_something_is_selected(boxes):
    asked = []

    def refuse_left(hit, ray):
        asked.append((hit.body.scene.name, hit.position.round(9).tolist(), ray.direction))
        return hit.body.scene.name != "left"

    hand = Hand(boxes, on_select=refuse_left).in_interaction()
    hand.click(hand.at([0.1, 0.3, 0]))
    assert hand.selection.body.scene.name == "right"
    hand.click(hand.at([0.1, -0.3, 0]))
    assert hand.selection is None
    assert [(name, position) for name, position, _ in asked] == [("right", [0.1, 0.3, 0]), ("left", [0.1, -0.3, 0])]
    np.testing.assert_allclose(asked[0][2], np.array([-0.9, 0.3, 0]) / math.hypot(0.9, 0.3), atol=1e-12)


def test_the_cube_is_around_what_is_seen(boxes):
    body = boxes.GetKinBody("left")
    body.SetTransform([math.cos(0.4), math.sin(0.4), 0, 0, 1, 2, 3])
    cube = Cube.around(body.simulation_state)
    np.testing.assert_allclose(cube.T_world_cube, body.GetTransform(), atol=1e-12)
    np.testing.assert_allclose(cube.half, [0.115, 0.065, 0.165], atol=1e-9)
    assert np.abs(cube.primitives().placed(np.linalg.inv(cube.T_world_cube)).triangles.corners).max() == pytest.approx(
        0.165
    )


@pytest.mark.parametrize("T_camera", [FROM_FRONT, ASLANT])
def test_dragging_a_face_moves_in_its_two_directions(boxes, T_camera):
    body = boxes.GetKinBody("right")
    body.SetTransform([math.cos(0.1), 0, 0, math.sin(0.1), 0, 0.1, 0])
    hand = Hand(boxes, T_camera).in_interaction()
    hand.click(hand.at(body.GetTransform()[:3, 3]))
    T = body.GetTransform()
    held = T @ [0.115, 0.01, 0.02, 1]  # on the face across the body's own x
    way = T[:3, :3] @ [0, 0.07, -0.12]
    halfway, end = held[:3] + way / 2, held[:3] + way
    hand.drag(hand.at(held[:3]), hand.at(halfway), hand.at(end))
    expected = T.copy()
    expected[:3, 3] += way
    np.testing.assert_allclose(body.GetTransform(), expected, atol=1e-9)
    assert hand.selection is not None, "a drag is no click"
    np.testing.assert_allclose(boxes.GetKinBody("left").GetTransform()[:3, 3], [0, -0.3, 0])


@pytest.mark.parametrize(
    ("edge", "axis"),
    [([0.115, 0.02, 0.165], 1), ([0.115, 0.065, 0.03], 2), ([0.02, 0.065, 0.165], 0)],
)
@pytest.mark.parametrize("angle", [0.5, -1.2, 7.5])
def test_dragging_an_edge_turns_about_its_axis_through_the_centre(boxes, edge, axis, angle):
    body = boxes.GetKinBody("right")
    body.SetTransform([1, 0, 0, 0, 0.1, 0.05, 0.02])
    T_camera = ravemj.transformLookat(lookat=[0.1, 0.05, 0.02], camerapos=[0.9, 0.7, 0.8], cameraup=[0, 0, -1])
    hand = Hand(boxes, T_camera).in_interaction()
    hand.click(hand.at(body.GetTransform()[:3, 3]))
    T = body.GetTransform()
    held, centre, direction = (T @ [*edge, 1])[:3], T[:3, 3], np.eye(3)[axis]
    stops = [about(centre, direction, part * angle) @ [*held, 1] for part in np.linspace(0, 1, 17)]
    hand.drag(hand.at(held), *(hand.at(stop[:3]) for stop in stops))
    np.testing.assert_allclose(body.GetTransform(), about(centre, direction, angle) @ T, atol=1e-6)


def test_a_cube_behind_another_body_is_not_held(boxes):
    left = boxes.GetKinBody("left")
    hand = Hand(boxes).in_interaction()
    hand.click(hand.at([0.1, -0.3, 0]))
    boxes.GetKinBody("right").SetTransform([1, 0, 0, 0, 0.4, -0.18, 0])
    T = left.GetTransform()
    hand.drag(hand.at([0.5, -0.18, 0]), (300, 100))
    assert np.array_equal(left.GetTransform(), T)
    hand.click(hand.at([0.5, -0.18, 0]))
    assert hand.selection.body.scene.name == "right"


def test_a_body_that_is_removed_is_selected_no_more(boxes):
    hand = Hand(boxes).in_interaction()
    at = hand.at([0.1, 0.3, 0])
    hand.click(at)
    hand.gui.handle(Press(*at))
    hand.gui.handle(Move(at[0] + 20, at[1]))
    body = boxes.GetKinBody("right")
    T = body.GetTransform()
    boxes.Remove(body)
    hand.gui.handle(Move(at[0] + 40, at[1]))
    assert hand.gui.overlay().lines == ()
    assert hand.selection is None
    assert np.array_equal(body.GetTransform(), T)
    boxes.Remove(boxes.GetKinBody("left"))
    hand.gui.handle(Release(*at))
    hand.click(at)
    assert hand.selection is None


# --- joints


def on_cylinder(handle, x, y, z):
    """A point of a handle's frame in the world."""
    return (handle.T_world_handle @ [x, y, z, 1])[:3]


def test_ctrl_and_a_click_select_the_parent_joint(hand, robot):
    hand.in_interaction()
    for z, lines in (
        (-0.3, ("Robot Pendulum", "Joint Joint1, DOF 1: 0.785 rad, 45.0 deg")),
        (-0.1, ("Robot Pendulum", "Joint Joint0, DOF 0: 0.000 rad, 0.0 deg")),
    ):
        robot.SetDOFValues([0, 0])
        hand.click(hand.at([0.01, 0, z]), ctrl=True)
        robot.SetDOFValues([0, math.pi / 4])
        assert hand.lines()[1:] == lines
    handle = JointHandle.at(robot.simulation_state, 1)
    np.testing.assert_allclose(handle.center, robot.GetJoints()[1].GetAnchor(), atol=1e-12)
    np.testing.assert_allclose(handle.axis, robot.GetJoints()[1].GetAxis(), atol=1e-12)


def test_a_link_that_no_joint_moves_says_so(boxes):
    hand = Hand(boxes).in_interaction()
    hand.click(hand.at([0.1, 0.3, 0]), ctrl=True)
    assert hand.selection is None
    assert hand.lines() == ("No joint moves base",)


@pytest.mark.parametrize("T_camera", [FROM_FRONT, ASLANT])
@pytest.mark.parametrize("angles", [[0.9], [-0.5, -1.4], np.arange(0.25, 7.1, 0.25)])
def test_dragging_the_cylinder_turns_the_joint(env, robot, T_camera, angles):
    robot.SetDOFValues([0.3, 0.2])
    hand = Hand(env, T_camera).in_interaction()
    link = robot.GetLinks()[2].GetTransform()
    hand.click(hand.at((link @ [0.15, 0, 0, 1])[:3]), ctrl=True)
    assert hand.selection.dof == 1
    handle = JointHandle.at(robot.simulation_state, 1)
    ray = hand.view.ray(*hand.at(handle.center + 0.02 * handle.T_world_handle[:3, 0]))
    held = handle.hit(ray)
    stops = [(about(handle.center, handle.axis, angle) @ [*held, 1])[:3] for angle in angles]
    hand.drag(hand.at(held), *map(hand.at, stops))
    np.testing.assert_allclose(robot.GetDOFValues(), [0.3, 0.2 + angles[-1]], atol=1e-6)


@pytest.mark.parametrize("is_mirror", [False, True])
def test_nothing_is_dragged_where_that_is_forbidden(boxes, is_mirror):
    body = boxes.GetKinBody("right")
    hand = Hand(boxes).in_interaction()
    if is_mirror:
        hand.gui.forbid_drags()
    hand.gui = hand.gui.another_view()
    hand.click(hand.at(body.GetTransform()[:3, 3]))
    before = body.GetTransform()
    face = hand.at((before @ [0.115, 0.01, 0.02, 1])[:3])
    hand.drag(face, (face[0] + 20, face[1]), (face[0] + 60, face[1] + 30))
    assert np.array_equal(body.GetTransform(), before) == is_mirror
    assert hand.selection is not None


@pytest.mark.parametrize("is_mirror", [False, True])
def test_no_slider_moves_a_joint_where_that_is_forbidden(hand, robot, is_mirror):
    if is_mirror:
        hand.gui.forbid_drags()
    hand.gui.controls.operate("joints")
    for name, value in (("dof 0", 0.5), ("random", 0.0), ("zero", 0.0), ("dof 1", 0.25)):
        hand.gui.controls.operate(name, value)
    np.testing.assert_array_equal(robot.GetDOFValues(), [0, 0] if is_mirror else [0, 0.25])


def test_ctrl_and_a_click_on_the_cylinder_change_its_size(hand, robot):
    hand.in_interaction().click(hand.at([0.01, 0, -0.3]), ctrl=True)
    widths = []
    for _ in range(5):
        hand.gui.handle(Leave())
        widths.append(np.ptp(hand.gui.overlay().primitives.triangles.corners[..., 2]))
        hand.click(hand.at(JointHandle.at(robot.simulation_state, 1).center), ctrl=True)
    np.testing.assert_allclose(np.array(widths) / widths[0], [1, 2, 4, 0.5, 1])
    assert hand.selection.dof == 1


def test_joint_limits_hold_and_the_pointer_takes_the_joint_up_again():
    env = ravemj.Environment()
    env.LoadData(SLIDING)
    slider = env.GetRobots()[0]
    hand = Hand(env).in_interaction()
    hand.click(hand.at([0.05, 0.2, 0]), ctrl=True)
    assert hand.lines()[1:] == ("Robot Sliding", "Joint Slide, DOF 0: 0.000 m")
    handle = JointHandle.at(slider.simulation_state, 0)
    held = handle.hit(hand.view.ray(*hand.at(handle.center)))
    hand.gui.handle(Press(*hand.at(held)))
    for way, expected in ((0.1, 0.1), (0.5, 0.25), (0.2, 0.2), (-0.5, -0.05)):
        hand.gui.handle(Move(*hand.at(held + np.array([0, way, 0]))))
        assert slider.GetDOFValues()[0] == pytest.approx(expected)
        follower = slider.GetLink("Follower").GetTransform()
        assert follower[2, 3] == pytest.approx(0.3 + 2 * expected), "mimic joints follow"
    assert hand.lines()[-1] == "Joint Slide, DOF 0: -0.050 m"
    np.testing.assert_allclose(
        JointHandle.at(slider.simulation_state, 0).center - handle.center, [0, -0.05, 0], atol=1e-12
    )


SLIDING = """<Robot name="Sliding"><KinBody>
<Body name="Base"><Geom type="box"><extents>0.02 0.02 0.02</extents></Geom></Body>
<Body name="Block"><Translation>0 0.2 0</Translation>
  <Geom type="box"><extents>0.05 0.05 0.05</extents></Geom></Body>
<Body name="Follower"><Translation>0 0 0.3</Translation>
  <Geom type="box"><extents>0.05 0.05 0.05</extents></Geom></Body>
<Joint name="Slide" type="slider"><Body>Base</Body><Body>Block</Body><axis>0 1 0</axis>
  <limits>-0.05 0.25</limits></Joint>
<Joint name="Follow" type="slider" enable="false" mimic_pos="2*Slide" mimic_vel="|Slide 2">
  <Body>Base</Body><Body>Follower</Body><axis>0 0 1</axis><limits>-1 1</limits></Joint>
</KinBody></Robot>"""


def test_a_follower_stands_for_the_joint_that_it_follows():
    env = ravemj.Environment()
    env.LoadData(SLIDING)
    hand = Hand(env).in_interaction()
    hand.click(hand.at([0.05, 0, 0.3]), ctrl=True)
    assert hand.lines()[-1] == "Joint Slide, DOF 0: 0.000 m"


def test_what_a_robot_holds_follows_the_joint(env, robot):
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes(np.array([[0, 0, 0, 0.02, 0.02, 0.02]]), True)
    box.SetName("held")
    env.Add(box)
    box.SetTransform([1, 0, 0, 0, 0, 0.0, -0.45])
    robot.Grab(box, robot.GetLinks()[2])
    T_link_box = np.linalg.inv(robot.GetLinks()[2].GetTransform()) @ box.GetTransform()
    hand = Hand(env).in_interaction()
    hand.click(hand.at([0.01, 0, -0.3]), ctrl=True)
    handle = JointHandle.at(robot.simulation_state, 1)
    held = handle.hit(hand.view.ray(*hand.at(handle.center + np.array([0, 0.02, 0]))))
    hand.drag(hand.at(held), hand.at((about(handle.center, handle.axis, 0.6) @ [*held, 1])[:3]))
    assert robot.GetDOFValues()[1] == pytest.approx(0.6)
    np.testing.assert_allclose(box.GetTransform(), robot.GetLinks()[2].GetTransform() @ T_link_box, atol=1e-9)


def test_each_click_takes_the_next_axis_of_a_joint_with_several():
    env = ravemj.Environment()
    env.LoadData("""<Robot name="Two"><KinBody>
    <Body name="Base"><Geom type="box"><extents>0.02 0.02 0.02</extents></Geom></Body>
    <Body name="Arm"><Geom type="box"><Translation>0 0.2 0</Translation><extents>0.02 0.1 0.02</extents></Geom></Body>
    <Joint name="Wrist" type="hinge2"><Body>Base</Body><Body>Arm</Body><anchor>0 0 0</anchor>
      <axis1>1 0 0</axis1><axis2>0 0 1</axis2></Joint></KinBody></Robot>""")
    robot = env.GetRobots()[0]
    hand = Hand(env).in_interaction()
    for axis in (0, 1, 0):
        hand.click(hand.at([0.02, 0.25, 0]), ctrl=True)
        assert hand.lines()[-1] == f"Joint Wrist, axis {axis}, DOF {axis}: 0.000 rad, 0.0 deg"
        np.testing.assert_allclose(
            JointHandle.at(robot.simulation_state, axis).axis, robot.GetJoints()[0].GetAxis(axis)
        )


# --- fingers, and buttons of the shell's own


def test_one_finger_turns_the_view_and_a_tap_selects(hand, robot):
    hand.drag((400, 300), (450, 320), touch=True)
    turned = hand.view
    other = Hand(hand.env)
    other.drag((400, 300), (450, 320))
    np.testing.assert_allclose(turned.camera.T_world_camera, other.view.camera.T_world_camera)
    hand.click((5, 5), touch=True)
    assert (hand.selection, hand.gui.mode) == (None, Mode.CAMERA)
    hand.click(hand.at([0, 0, -0.3]), touch=True)
    assert hand.selection.body is robot.simulation_state
    assert hand.gui.mode is Mode.INTERACTION
    before = hand.view
    cube = Cube.around(robot.simulation_state)
    hand.drag(hand.at(cube.T_world_cube[:3, 3]), hand.at(cube.T_world_cube[:3, 3] + [0, 0.1, 0]), touch=True)
    assert hand.view is before
    assert np.linalg.norm(robot.GetTransform()[:3, 3]) > 0.05
    hand.drag((5, 5), (60, 5), touch=True)
    assert hand.view is not before
    hand.press_key("escape")
    placed = robot.GetTransform()
    hand.drag(hand.at(placed[:3, 3]), (300, 200), touch=True)
    assert np.array_equal(robot.GetTransform(), placed), "in camera mode nothing is dragged"


def test_two_fingers_keep_what_is_under_them(hand):
    """Two points as deep as the focus, under two fingers that go elsewhere without turning."""
    hand.gui.look_from(hand.view.camera, 1.0)
    held = np.array([[0, 0.05, 0.1], [0, 0.2, -0.1]])
    before = np.array([hand.at(point) for point in held])
    after = before.mean(axis=0) + [70, -40] + 1.5 * (before - before.mean(axis=0))
    rotation = hand.view.camera.rotation
    hand.gui.handle(Fingers(*after.mean(axis=0), 70, -40, 1.5))
    np.testing.assert_allclose([hand.at(point) for point in held], after, atol=1e-6)
    np.testing.assert_allclose(hand.view.camera.rotation, rotation, atol=1e-12)


def test_shells_with_buttons_of_their_own_use_the_same_tools(hand):
    other = hand.gui.another_view(has_tools=False)
    assert hand.gui.overlay().panels
    assert other.overlay().panels == ()
    rect = button_rects(SIZE)[ViewButton.ROT_X]
    at = rect.x + 5, rect.y + 5
    other.handle(Use(ViewButton.INTERACT))
    assert other.mode is Mode.INTERACTION
    other.handle(Use(ViewButton.CAMERA))
    assert other.mode is Mode.CAMERA
    for tool in (ViewButton.ROT_X, ViewButton.ROT_Y, ViewButton.DOLLY):
        rect = button_rects(SIZE)[tool]
        at = rect.x + 5, rect.y + 5
        hand.drag(at, (at[0] + 30, at[1] + 30))
        other.handle(Use(tool, 30))
        np.testing.assert_allclose(other.view.camera.T_world_camera, hand.view.camera.T_world_camera, atol=1e-12)
    before = other.view
    other.handle(Press(*at))
    other.handle(Move(at[0], at[1] + 30))
    assert not np.allclose(other.view.camera.rotation, before.camera.rotation), (
        "where others have a wheel, the view turns"
    )
