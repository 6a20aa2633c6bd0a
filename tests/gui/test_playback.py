"""Playing motions, and the other controls of a view, without a window: each with what it should do to the bodies."""

import functools
import itertools
import math
import threading
import time
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_interaction import SIZE, Hand
from waiting import PATIENCE

import ravemj
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import (
    Control,
    ControlLayout,
    Interaction,
    Key,
    Leave,
    Mode,
    Move,
    Operate,
    Request,
    Resize,
    Wheel,
    button_rects,
)
from ravemj.gui.interaction.control_layout import shortened
from ravemj.gui.interaction.viewpoint import camera_line

SWING = ravemj.Motion([1.0, 2.0, 5.0], [[0.0, 0.0], [1.0, 0.5], [2.5, -1.0]])
"""Four seconds; times of motions need not start at 0."""


def chain(joints: int, kind: str = "hinge") -> str:
    """A robot with so many joints in a row."""
    bodies = "".join(f'<Body name="b{i}" type="dynamic"/>' for i in range(joints + 1))
    between = "".join(
        f'<Joint name="a_joint_with_a_long_name_{i}" type="{kind}"><Body>b{i}</Body><Body>b{i + 1}</Body></Joint>'
        for i in range(joints)
    )
    return f'<Robot name="chain"><KinBody>{bodies}{between}</KinBody></Robot>'


@pytest.fixture
def viewer(env):
    env.SetViewer("offscreen")
    return env.GetViewer()


class Panel(Hand):
    """Uses the controls with the mouse, where a window has them."""

    @property
    def layout(self) -> ControlLayout:
        self.gui._controller.update_layout()
        return self.gui._controller.layout

    def control(self, name) -> Control:
        return next(control for control in self.gui.overlay().controls if control.name == name)

    def rect(self, name):
        return next(rect for control, rect in self.layout.places.items() if control.name == name)

    def middle(self, name) -> tuple[float, float]:
        x, y, width, height = self.rect(name)
        return x + width / 2, y + height / 2

    def press(self, name):
        self.click(self.middle(name))

    def along(self, name, part) -> tuple[float, float]:
        """Where the knob of a slider is at a part of its range."""
        x, y, width, height = self.rect(name)
        return x + 4 + part * (width - 8), y + height / 2

    @property
    def names(self) -> list[str]:
        return [control.name for control in self.gui.overlay().controls]


@pytest.fixture
def panel(env, viewer):
    panel = Panel(env)
    panel.gui = viewer.interaction
    panel.gui.handle(Resize(*SIZE))
    return panel


# --- the motion


def test_a_motion_plays_in_real_time_and_ends(viewer, robot):
    playback = viewer.play(SWING)
    assert playback is viewer.playback
    assert (playback.duration, playback.time, playback.playing) == (4.0, 0.0, True)
    playback.advance(100.0)  # the clock may start anywhere
    assert playback.time == 0
    for now in (100.25, 100.5, 100.9):
        playback.advance(now)
        assert playback.time == pytest.approx(now - 100)
        np.testing.assert_allclose(robot.GetDOFValues(), SWING.sample(1 + now - 100), atol=1e-12)
    for step in range(20):
        playback.advance(101 + step / 4)
    assert (playback.time, playback.playing) == (4.0, False)
    np.testing.assert_array_equal(robot.GetDOFValues(), [2.5, -1.0])
    robot.SetDOFValues([0.1, 0.2])
    playback.advance(120.0)
    np.testing.assert_array_equal(robot.GetDOFValues(), [0.1, 0.2])  # a motion that is over moves nothing


def test_a_motion_waits_while_nobody_looks(viewer):
    playback = viewer.play(SWING)
    playback.advance(10.0)
    playback.advance(1000.0)
    assert playback.time == 0.5
    playback.pause()
    playback.advance(1001.0)
    assert playback.time == 0.5
    playback.play()
    playback.advance(2000.0)
    assert playback.time == 0.5
    playback.advance(2000.25)
    assert playback.time == 0.75
    playback.advance(1990.0)
    assert playback.time == 0.75


@functools.cache
def one_joint() -> ravemj.Environment:
    env = ravemj.Environment()
    env.LoadData(chain(1))
    env.SetViewer("offscreen")
    return env


@given(
    speed=st.floats(0.01, 100),
    ticks=st.lists(st.floats(0, 0.5), max_size=20),
)
def test_time_passes_at_the_speed_and_never_leaves_the_motion(speed, ticks):
    env = one_joint()
    playback = env.GetViewer().play(ravemj.Motion.line([0], [1], 3.0), speed=speed)
    for now in itertools.accumulate([0.0, *ticks]):
        playback.advance(now)
    assert playback.time == pytest.approx(min(speed * sum(ticks), 3.0))
    assert playback.playing == (playback.time < 3.0)
    assert env.GetRobots()[0].GetDOFValues() == pytest.approx([playback.time / 3])


def test_play_pause_seek_and_step(viewer, robot):
    playback = viewer.play(SWING)
    playback.seek(2.0)
    np.testing.assert_allclose(robot.GetDOFValues(), SWING.sample(3.0))
    assert playback.playing
    playback.step()
    assert not playback.playing
    assert playback.time == pytest.approx(2 + 1 / 30)
    playback.step(-2)
    assert playback.time == pytest.approx(2 - 1 / 30)
    for time_, expected in ((-5, 0.0), (99, 4.0), (math.inf, 4.0)):
        playback.seek(time_)
        assert playback.time == expected
    with pytest.raises(ArgumentError, match="nan"):
        playback.seek(math.nan)
    playback.play()  # from the end, it starts again
    assert (playback.time, playback.playing) == (0.0, True)
    for speed in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ArgumentError, match="speed"):
            playback.speed = speed
    assert playback.speed == 1


def test_play_refuses_what_does_not_fit_and_goes_on(env, viewer):
    playback = viewer.play(SWING, speed=2.0)
    playback.seek(1.0)
    for wrong in (ravemj.Motion([0, 1], [[0.0], [1.0]]), ravemj.RaveCreateTrajectory(env, "")):
        with pytest.raises(ravemj.openrave_exception):
            viewer.play(wrong)
    with pytest.raises(ArgumentError, match="speed"):
        viewer.play(SWING, speed=0)
    assert (playback.time, playback.duration, playback.speed) == (1.0, 4.0, 2.0)
    empty = ravemj.Environment()
    empty.SetViewer("offscreen")
    with pytest.raises(ArgumentError, match="no robot"):
        empty.GetViewer().play(SWING)


def test_joints_stop_at_their_limits_and_circular_ones_do_not(viewer, robot):
    playback = viewer.play(ravemj.Motion.line([0, -1], [9, 1], 2.0))
    playback.seek(2)
    np.testing.assert_allclose(robot.GetDOFValues(), [9, 1])
    env = ravemj.Environment()
    env.LoadData(chain(2))
    env.SetViewer("offscreen")
    robot = env.GetRobots()[0]
    robot.GetJoints()[1].SetLimits([-0.25], [0.3])
    playback = env.GetViewer().play(ravemj.Motion.line([0, -1], [0.5, 1], 2.0))
    np.testing.assert_allclose(robot.GetDOFValues(), [0, -0.25])
    playback.seek(2)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.5, 0.3])


def test_a_trajectory_plays_with_its_own_interpolation_and_poses(env, viewer, robot):
    spec = robot.GetConfigurationSpecificationIndices([1], "linear")
    spec.AddGroup("affine_transform Pendulum 7", 3, "linear")
    spec.AddDeltaTimeGroup()
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    first, last = np.zeros(5), np.zeros(5)
    order = {group.name.split()[0]: group.offset for group in trajectory.GetConfigurationSpecification().GetGroups()}
    last[order["joint_values"]], last[order["affine_transform"]], last[order["deltatime"]] = 0.8, 2.0, 4.0
    trajectory.Insert(0, [*first, *last])
    robot.SetDOFValues([0.3, 0])
    rotation = robot.GetTransform()[:3, :3]
    playback = viewer.play(trajectory)
    trajectory.Remove(0, 2)  # what plays is a copy
    playback.seek(1.0)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.3, 0.2])
    np.testing.assert_allclose(robot.GetTransform()[:3, 3], [0.5, 0, 0])
    np.testing.assert_allclose(robot.GetTransform()[:3, :3], rotation)
    assert playback.duration == 4


def test_a_body_that_goes_takes_its_motion_along(env, viewer, robot):
    playback = viewer.play(SWING)
    env.Remove(robot)
    playback.advance(0.0)
    playback.advance(1.0)
    assert (playback.motion, playback.duration, playback.playing) == (None, 0.0, False)
    playback.seek(1.0)
    playback.step()
    playback.play()
    assert not playback.playing


def test_a_motion_that_fails_stops_once(viewer, robot):
    playback = viewer.play(SWING)
    playback._motion = replace(playback.motion, place=lambda time: 1 / 0)
    playback.advance(0.0)
    with pytest.raises(ZeroDivisionError):
        playback.advance(0.1)
    playback.advance(0.2)
    assert not playback.playing


def test_scripts_and_the_viewer_share_the_playback(viewer):
    """Threads that advance, seek and step leave time in the motion, and nothing hangs."""
    playback = viewer.play(SWING)
    end = time.monotonic() + 0.5
    wrong = []

    def advance():
        while time.monotonic() < end:
            playback.advance(time.monotonic())
            if not 0 <= playback.time <= 4:
                wrong.append(playback.time)

    threads = [threading.Thread(target=advance) for _ in range(3)]
    for thread in threads:
        thread.start()
    while time.monotonic() < end:
        playback.seek(np.random.default_rng(0).uniform(0, 4))
        playback.step(-3)
        playback.play()
    for thread in threads:
        thread.join(PATIENCE)
        assert not thread.is_alive()
    assert not wrong


# --- the controls


def test_the_motions_controls_are_there_while_there_is_a_motion(panel, viewer, env, robot):
    always = ["picture", "video", "camera", "view", "display", "tree", "help", "pull", "joints"]
    assert panel.names == always
    viewer.play(SWING)
    assert panel.names == ["back", "play", "forward", "seek", "speed", *always]
    viewer.playback.clear()
    assert panel.names == always
    viewer.play(ravemj.Motion([0.0], [[1.0, 0.0]]))  # a single pose has nothing to go through
    assert panel.names == always
    env.Remove(robot)
    assert panel.names == always[:-2]


def test_the_mouse_plays_pauses_steps_and_changes_the_speed(panel, viewer):
    playback = viewer.play(SWING)
    panel.press("play")
    assert not playback.playing
    panel.press("play")
    assert playback.playing
    panel.press("forward")
    panel.press("forward")
    panel.press("back")
    assert not playback.playing
    assert playback.time == pytest.approx(1 / 30)
    speeds = []
    for _ in range(6):
        panel.press("speed")
        speeds.append(playback.speed)
    assert speeds == [2, 4, 0.1, 0.25, 0.5, 1]
    playback.speed = 0.3
    assert panel.control("speed").text == "0.3x"
    panel.press("speed")
    assert playback.speed == 0.5


def test_the_mouse_goes_through_the_time(panel, viewer, robot):
    playback = viewer.play(SWING)
    ends = [panel.along("seek", part) for part in (0, 0.25, 0.75)]
    panel.drag(*ends)
    assert playback.time == pytest.approx(3.0)
    np.testing.assert_allclose(robot.GetDOFValues(), SWING.sample(4.0), atol=1e-9)
    assert not playback.playing
    panel.drag(ends[1], (-300, 0))
    assert playback.time == 0
    panel.drag(ends[1], (5000, 300))
    assert playback.time == 4
    assert panel.control("seek").text == "4.00 / 4.00 s"
    assert panel.along("seek", 1.0)[0] == pytest.approx(panel.rect("seek").x + panel.rect("seek").width - 4)


def test_keys_play_and_step_only_while_there_is_a_motion(panel, viewer):
    for key in (" ", "ArrowLeft", "ArrowRight"):
        panel.press_key(key)
    assert panel.gui.mode is Mode.CAMERA
    playback = viewer.play(SWING)
    panel.gui.handle(Key(" "))
    panel.gui.handle(Key(" "))  # it repeats while it is held
    assert not playback.playing
    panel.press_key("ArrowRight")
    panel.press_key("ArrowRight")
    panel.press_key("ArrowLeft")
    assert playback.time == pytest.approx(1 / 30)


def test_sliders_turn_joints(panel, robot):
    assert not any(name.startswith("dof") for name in panel.names)
    panel.press("joints")
    assert panel.names[-2:] == ["dof 0", "dof 1"]
    circular = panel.control("dof 0")
    assert (circular.label, circular.lower, circular.upper) == ("Joint0", -math.pi, math.pi)
    panel.drag(panel.along("dof 0", 0.5), panel.along("dof 0", 0.75))
    np.testing.assert_allclose(robot.GetDOFValues(), [math.pi / 2, 0], atol=1e-9)
    assert panel.control("dof 0").text == "1.571 rad"
    panel.drag(panel.along("dof 1", 0.75), (2000, 0))
    np.testing.assert_allclose(robot.GetDOFValues(), [math.pi / 2, math.pi], atol=1e-9)
    robot.SetDOFValues([2 * math.pi + 0.5, 0])
    assert panel.control("dof 0").value == pytest.approx(0.5)
    panel.press("joints")
    assert panel.names[-1] == "joints"


def test_sliders_stop_at_limits():
    env = ravemj.Environment()
    env.LoadData(chain(2))
    robot, panel = env.GetRobots()[0], Panel(env)
    robot.GetJoints()[1].SetLimits([-0.25], [0.75])
    panel.press("joints")
    panel.drag(panel.along("dof 1", 0.25), panel.along("dof 1", 0.5))
    np.testing.assert_allclose(robot.GetDOFValues(), [0, 0.25], atol=1e-9)
    panel.drag(panel.along("dof 1", 0.5), (2000, 0))
    np.testing.assert_allclose(robot.GetDOFValues(), [0, 0.75], atol=1e-9)
    panel.gui.handle(Operate("dof 1", -9.0))
    np.testing.assert_allclose(robot.GetDOFValues(), [0, -0.25], atol=1e-9)


def test_mimic_joints_follow_a_slider():
    env = ravemj.Environment()
    env.LoadData("""<Robot name="r"><KinBody>
      <Body name="a" type="dynamic"/><Body name="b" type="dynamic"/><Body name="c" type="dynamic"/>
      <Joint name="j" type="slider"><Body>a</Body><Body>b</Body><axis>1 0 0</axis><limits>0 0.5</limits></Joint>
      <Joint name="k" type="slider" mimic_pos="2*j" mimic_vel="|j 2" mimic_accel="|j 0" enable="false">
        <Body>b</Body><Body>c</Body><axis>1 0 0</axis><limits>0 1</limits></Joint></KinBody></Robot>""")
    gui = Interaction.first_view(env.simulation, Camera(np.eye(4)), SIZE)
    gui.handle(Operate("joints"))
    assert [control.name for control in gui.overlay().controls][-1] == "dof 0"
    gui.handle(Operate("dof 0", 0.2))
    robot = env.GetRobots()[0]
    assert robot.GetDOFValues() == pytest.approx([0.2])
    assert robot.GetPassiveJoints()[0].GetValue(0) == pytest.approx(0.4)
    gui.handle(Operate("dof 0", 7.0))
    assert robot.GetDOFValues() == pytest.approx([0.5])


@pytest.mark.parametrize(
    ("kind", "limits", "expected"),
    [
        ("hinge", "-1 2", (-1, 2)),
        ("hinge", "-1e10 1e10", (-math.pi, math.pi)),
        ("hinge", "5 100", (5, 5 + 2 * math.pi)),
        ("slider", "-50 -20", (-22, -20)),
        ("slider", "0 3", (0, 3)),
        ("slider", "-1e300 1e300", (-1, 1)),
    ],
)
def test_sliders_of_joints_that_go_far_cover_a_part(kind, limits, expected):
    env = ravemj.Environment()
    env.LoadData(chain(1, kind))
    joint = env.GetRobots()[0].GetJoints()[0]
    lower, upper = map(float, limits.split())
    joint.SetLimits([lower], [upper])
    gui = Interaction.first_view(env.simulation, Camera(np.eye(4)), SIZE)
    gui.handle(Operate("joints"))
    control = gui.overlay().controls[-1]
    assert (control.lower, control.upper) == pytest.approx(expected)
    assert control.text.endswith(" m" if kind == "slider" else " rad")


def test_the_sliders_are_those_of_the_selected_body_else_of_one_that_plays_else_of_the_first_robot(env):
    for name, dof in (("long", 3), ("longer", 4)):
        env.LoadData(chain(dof).replace("chain", name))
        env.GetRobot(name).SetTransform([1, 0, 0, 0, 50, 50, 50])
    env.SetViewer("offscreen")
    panel, viewer = Panel(env), env.GetViewer()
    panel.gui = viewer.interaction
    viewer.SetCamera([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    assert panel.control("joints").label == "DOFs of Pendulum: a slider for each"
    viewer.play(ravemj.Motion.line([0] * 4, [1] * 4), robot=env.GetRobot("longer"))
    assert panel.control("joints").label == "DOFs of longer: a slider for each"
    panel.in_interaction().click(panel.at([0.01, 0, -0.3]))
    assert viewer.GetSelectedBody() is not None
    assert panel.control("joints").label == "DOFs of Pendulum: a slider for each"


def test_a_hand_on_what_plays_pauses_it(panel, viewer):
    playback = viewer.play(SWING)
    panel.press("joints")
    assert playback.playing
    panel.drag(panel.along("dof 1", 0.5), panel.along("dof 1", 0.6))
    assert not playback.playing


def test_what_only_a_window_can_do_is_left_to_it(panel):
    for name in ("picture", "video", "camera", "picture"):
        panel.press(name)
    line = camera_line(panel.view.camera)
    assert panel.gui.controls.pop_requests() == [Request.PICTURE, Request.VIDEO, line, Request.PICTURE]
    assert panel.gui.controls.pop_requests() == []


def test_controls_that_are_not_there_do_nothing(panel, viewer, robot):
    before = panel.gui.overlay()
    for name in ("play", "seek", "dof 0", "dof 7", "dof x", "", "nonsense", "joints x"):
        panel.gui.handle(Operate(name, 1.0))
    assert panel.gui.overlay().controls == before.controls
    assert not robot.GetDOFValues().any()
    assert not panel.gui.controls.requests


def test_other_buttons_and_misses_press_nothing_and_reach_nothing_behind(panel, viewer):
    viewer.play(SWING).pause()
    panel.press("joints")
    camera = panel.view.camera
    panel.drag(panel.middle("play"), (100, 100), button=ravemj.gui.interaction.Button.RIGHT)
    panel.drag(panel.middle("play"), (100, 100), button=ravemj.gui.interaction.Button.MIDDLE)
    x, y, _, height = panel.rect("dof 0")
    panel.drag((x - 20, y + height / 2), (100, 300))  # on the joint's name
    assert not viewer.playback.playing
    assert panel.view.camera is camera


def test_views_share_the_motion_and_unfold_their_own_sliders(panel, viewer):
    other = panel.gui.another_view()
    viewer.play(SWING)
    other.handle(Operate("joints"))
    other.handle(Operate("seek", 1.5))
    assert viewer.playback.time == 1.5
    assert "dof 0" in [control.name for control in other.overlay().controls]
    assert "dof 0" not in panel.names
    before = panel.gui.appearance
    other.handle(Operate("seek", 1.0))
    assert panel.gui.appearance != before


def test_only_what_changes_is_drawn_again(panel, viewer):
    playback = viewer.play(SWING)
    panel.gui.advance(1.0)
    before = panel.gui.appearance
    panel.gui.advance(1.1)
    assert panel.gui.appearance != before
    playback.pause()
    before = panel.gui.appearance
    panel.gui.advance(1.2)
    assert panel.gui.appearance == before


def test_the_label_of_a_control_is_shown_under_the_pointer(panel):
    assert panel.lines(panel.middle("camera")) == ("Copy the camera as a line of Python",)
    before = panel.gui.appearance
    panel.gui.handle(Move(*panel.middle("picture")))
    assert panel.gui.appearance != before
    assert panel.gui.overlay().lines == ("Save a picture (PNG)",)
    panel.gui.handle(Leave())
    assert panel.gui.overlay().lines == ()


def test_notices_go_away_by_themselves(panel):
    notices = panel.gui.controls.notices
    notices.say("Saved a.png", 500)
    notices.say("Saved b.png", 5000)
    now = time.monotonic()
    assert panel.lines() == ("Saved a.png", "Saved b.png")
    before = panel.gui.appearance
    panel.gui.advance(now + 1)
    assert panel.gui.appearance == before
    panel.gui.advance(now + 600)
    assert panel.gui.appearance != before
    assert panel.gui.overlay().lines == ("Saved b.png",)


def test_the_copied_line_sets_the_same_camera(env, viewer):
    T_world_camera = ravemj.matrixFromPose([0.5, 0.5, -0.5, 0.5, 1, -2, 3e-12])
    line = camera_line(Camera(T_world_camera))
    assert line.startswith("viewer.SetCamera([[")
    assert "-0.0" not in line.replace("-0.0,", "")
    viewer.SetCamera(np.eye(4))
    eval(line, {"viewer": viewer})
    np.testing.assert_allclose(viewer.GetCameraTransform(), T_world_camera, atol=1e-8)


# --- where a window has them


@pytest.mark.parametrize("size", [(400, 300), (320, 480), (480, 430), (640, 480), (960, 720), (1920, 1080)])
@pytest.mark.parametrize("joints", [0, 2, 100])
def test_controls_are_on_the_view_apart_from_each_other_and_from_the_wheels(size, joints):
    sliders = [Control(f"dof {i}", f"Joint{i}", "0 rad", 0, -1, 1, group="joints") for i in range(joints)]
    playing = [Control(name, name, group="playing") for name in ("back", "play", "forward")]
    playing += [Control("seek", "Time", "0", 0.0, 0.0, 1.0, group="playing")]
    playing += [Control("speed", "Speed", "1x", group="playing")]
    others = [Control(name, name, name) for name in ("picture", "video", "camera", "view", "display", "help", "joints")]
    layout = ControlLayout.arrange((*playing, *others, *sliders), size)
    rects = [*layout.places.values(), *button_rects(size).values()]
    for rect in rects:
        assert rect.width > 0
        assert rect.height > 0
        assert rect.x >= 0
        assert rect.y >= 0
        assert rect.x + rect.width <= size[0]
        assert rect.y + rect.height <= size[1]
    for one, two in itertools.combinations(rects, 2):
        assert one.x + one.width <= two.x or two.x + two.width <= one.x or (
            one.y + one.height <= two.y or two.y + two.height <= one.y
        )  # fmt: skip
    for panel in layout.panels():
        assert panel.rect.x >= 0
        assert panel.rect.x + panel.rect.width <= size[0]
    assert len(layout.places) > 7 or size[1] < 430 or size[0] < 400


def test_many_joints_scroll():
    long = ravemj.Environment()
    long.LoadData(chain(60))
    panel = Panel(long)
    panel.press("joints")
    seen = [control.name for control in panel.layout.places if control.name.startswith("dof")]
    assert seen == [f"dof {i}" for i in range(len(seen))]
    assert 10 < len(seen) < 30
    camera, top = panel.view.camera, panel.rect("dof 0").y
    panel.gui.handle(Move(*panel.middle("dof 3")))
    panel.gui.handle(Wheel(-5))
    assert panel.rect("dof 5").y == pytest.approx(top)
    panel.gui.handle(Wheel(-500))
    panel.press("dof 59")
    panel.gui.handle(Wheel(500))
    panel.press("dof 0")
    assert panel.view.camera is camera
    tops = []
    for steps in (500, -500):
        panel.gui.handle(Wheel(steps))
        (mark,) = (rect for rect, *_ in panel.layout.panels() if rect.width == 4 and rect.height > 22)
        tops.append(mark.y)
        bottom = mark.y + mark.height
    assert tops[0] == pytest.approx(top)
    assert bottom == pytest.approx(top + 22 * len(seen))  # the mark shows which part is seen
    assert all(len(part.text) <= 26 for part in panel.layout.panels())


def test_a_narrow_view_has_whole_sliders_with_shorter_names():
    sliders = [Control(f"dof {i}", f"a_joint_with_a_name_{i}", "0 rad", 0, -1, 1, group="joints") for i in range(3)]
    for size, longest in (((320, 480), 15), ((960, 720), 26)):
        layout = ControlLayout.arrange((Control("joints", "DOFs", "DOFs"), *sliders), size)
        names = [panel.text for panel in layout.panels() if "joint" in panel.text or ".." in panel.text]
        assert len(set(names)) == 3
        assert max(map(len, names)) <= longest
        assert all(panel.rect.x >= 0 for panel in layout.panels())


def test_long_names_are_cut_so_that_they_differ():
    sides = [
        f"{side}_{part}_joint"
        for side in ("bl_caster_l", "bl_caster_r", "br_caster_l")
        for part in ("wheel_of_the_base", "wheel_of_the_bass", "rotation_about_z")
    ]
    cut = shortened(["short", *sides], 26)
    assert cut["short"] == "short"
    assert len(set(cut.values())) == len(sides) + 1
    assert max(map(len, cut.values())) <= 26
    assert shortened([], 26) == {}
    same = shortened(["x" * 50 + "a" + "x" * 50, "x" * 50 + "b" + "x" * 50], 26)
    assert max(map(len, same.values())) <= 26, "there is no such place"


# --- all joints at once


def test_joints_go_to_zero_to_random_values_and_are_copied(panel, robot):
    panel.press("joints")
    robot.SetDOFValues([0.5, -0.25])
    panel.press("values")
    (line,) = panel.gui.controls.pop_requests()
    robot.SetDOFValues([0, 0])
    eval(line, {"env": panel.env})
    np.testing.assert_allclose(robot.GetDOFValues(), [0.5, -0.25])
    panel.press("random")
    first = robot.GetDOFValues()
    panel.press("random")
    assert not np.allclose(robot.GetDOFValues(), first)
    lower, upper = robot.GetDOFLimits()
    assert (robot.GetDOFValues() >= lower).all()
    assert (robot.GetDOFValues() <= upper).all()
    panel.press("zero")
    assert not robot.GetDOFValues().any()
    assert panel.gui.controls.pop_requests() == []


def test_angles_are_shown_in_degrees_if_wanted(panel, robot):
    robot.SetDOFValues([0.5, 0])
    panel.press("joints")
    assert panel.control("dof 0").text == "0.500 rad"
    panel.press("units")
    assert panel.control("dof 0").text == "28.6 deg"
    assert panel.control("dof 0").value == pytest.approx(0.5)
    panel.press("units")
    assert panel.control("dof 0").text == "0.500 rad"
