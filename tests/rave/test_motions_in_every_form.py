"""``record``, ``env.animation``, ``env.save_html`` and ``viewer.play`` take motions in the same forms."""

import numpy as np
import pytest
from conftest import MODELS, one_in
from PIL import Image

import ravemj
from ravemj.errors import ArgumentError, RavemjError, SourceError

TIMES, VALUES = [0.0, 1.0, 3.0], [[0.0, 0.5], [1.0, 0.5], [1.0, -0.5]]
END = VALUES[-1]
NAMES = ["Joint0", "Joint1"]


@pytest.fixture
def env():
    env = ravemj.load(MODELS / "env.xml")
    env.SetViewer("offscreen")
    yield env
    env.Destroy()


def trajectory(env):
    spec = env.GetRobots()[0].GetActiveConfigurationSpecification("linear")
    spec.AddDeltaTimeGroup()
    made = ravemj.RaveCreateTrajectory(env, "")
    made.Init(spec)
    for row, step in zip(VALUES, np.diff(TIMES, prepend=0.0), strict=True):
        made.Insert(made.GetNumWaypoints(), [*row, step])
    return made


def file_of(name, env, folder):
    path = folder / name
    if name.endswith((".csv", ".npz")):
        return ravemj.write_motion(path, ravemj.Motion(TIMES, VALUES), NAMES)
    trajectory(env).SaveToFile(path, 0x8000 if name.endswith(".xml") else 0)
    return path


FORMS = {
    "motion": lambda env, folder: ravemj.Motion(TIMES, VALUES),
    "trajectory": lambda env, folder: trajectory(env),
    "pair": lambda env, folder: (TIMES, VALUES),
    "pair of arrays": lambda env, folder: (np.array(TIMES), np.array(VALUES)),
    "table": lambda env, folder: np.column_stack([TIMES, VALUES]),
    "rows": lambda env, folder: [[time, *row] for time, row in zip(TIMES, VALUES, strict=True)],
    "rows of two": lambda env, folder: list(zip(TIMES, VALUES, strict=True)),
    "iterator": lambda env, folder: zip(TIMES, VALUES, strict=True),
    "csv": lambda env, folder: file_of("a.csv", env, folder),
    "csv as text": lambda env, folder: str(file_of("a.csv", env, folder)),
    "npz": lambda env, folder: file_of("a.npz", env, folder),
    "xml": lambda env, folder: file_of("a.xml", env, folder),
    "binary": lambda env, folder: file_of("a.traj", env, folder),
}


@pytest.mark.parametrize("form", one_in(4, list(FORMS)))
def test_each_form_is_played_recorded_and_shown(env, tmp_path, form):
    robot = env.GetRobots()[0]
    playback = env.GetViewer().play(FORMS[form](env, tmp_path))
    assert playback.duration == 3
    for time, row in ((0.5, [0.5, 0.5]), (2.0, [1.0, 0.0]), (3.0, END)):
        playback.seek(time)
        assert robot.GetDOFValues() == pytest.approx(row)
    robot.SetDOFValues([0, 0])
    ravemj.record(env, tmp_path / "frames", FORMS[form](env, tmp_path), width=64, height=48, fps=1)
    assert robot.GetDOFValues() == pytest.approx(END)
    frames = [np.asarray(Image.open(path)) for path in sorted((tmp_path / "frames").iterdir())]
    assert len(frames) == 4
    robot.SetDOFValues(VALUES[1])
    shadowless = ravemj.record(env, tmp_path / "still", ravemj.Motion([0], [VALUES[1]]), width=64, height=48)
    assert np.array_equal(frames[1], np.asarray(Image.open(next(shadowless.iterdir()))))
    robot.SetDOFValues([0, 0])
    page = env.animation(FORMS[form](env, tmp_path)).html
    assert robot.GetDOFValues() == pytest.approx(END)
    assert page == env.animation(ravemj.Motion(TIMES, VALUES)).html
    assert env.save_html(tmp_path / "a.html", FORMS[form](env, tmp_path)).read_text(encoding="utf-8") == page


class Trajectory:
    """That of the tutorial, which is a function of time."""

    T = 1.0

    def q(self, t):
        return [t, 0]


def not_initialized(env):
    return ravemj.RaveCreateTrajectory(env, "")


WRONG = {
    "a function": (lambda env: Trajectory().q, "found a method, expected a Motion, a trajectory of OpenRAVE, rows of"),
    "a class of one's own": (lambda env: Trajectory(), rf"found a {__name__}\.Trajectory, expected a Motion"),
    "nothing": (lambda env: None, "found None, expected a Motion"),
    "a number": (lambda env: 3.5, "found 3.5, expected a Motion"),
    "a dict": (lambda env: {"Joint0": 1.0}, "found a dict, expected a Motion"),
    "rows without times": (lambda env: [[0, 1], [1, 1]], "found rows of 2 numbers, expected the time and then 2 joint"),
    "one row without a time": (lambda env: [0, 1], "found a list, expected a Motion"),
    "rows of other lengths": (lambda env: [[0, 1, 1], [1, 1]], "found a list, expected"),
    "too many joints": (lambda env: [[0, 1, 1, 1]], "the motion has 3 joints, and 'Pendulum' has 2 DOFs"),
    "times that go back": (lambda env: ([1, 0], [[0, 0], [0, 0]]), "times must increase"),
    "text": (lambda env: [["a", "b", "c"]], "found a list, expected"),
    "other texts": (lambda env: "nowhere.csv", "nowhere.csv: error: cannot read the file: no such file"),
    "no trajectory": (lambda env: str(MODELS / "env.xml"), r"env\.xml: error: "),
    "no waypoints": (not_initialized, "call Init"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_no_motion_is_said_and_writes_nothing(env, tmp_path, name):
    make, words = WRONG[name]
    calls = [
        lambda: env.GetViewer().play(make(env)),
        lambda: ravemj.record(env, tmp_path / "a.mp4", make(env)),
        lambda: env.save_html(tmp_path / "a.html", make(env)),
        lambda: env.animation(make(env)),
    ]
    for call in calls[:2] if name == "nothing" else calls:  # a page without a motion shows the scene
        with pytest.raises(RavemjError, match=words):
            call()
    assert list(tmp_path.iterdir()) == []
    assert env.GetRobots()[0].GetDOFValues().tolist() == [0, 0]


def test_a_trajectory_moves_the_base_in_videos_and_pages_too(env, tmp_path):
    robot = env.GetRobots()[0]
    spec = robot.GetConfigurationSpecificationIndices([1], "linear")
    spec.AddGroup("affine_transform Pendulum 7", 3, "linear")
    spec.AddDeltaTimeGroup()
    path = ravemj.RaveCreateTrajectory(env, "")
    path.Init(spec)
    places = {group.name.split()[0]: group.offset for group in path.GetConfigurationSpecification().GetGroups()}
    last = np.zeros(5)
    last[places["joint_values"]], last[places["affine_transform"]], last[places["deltatime"]] = 0.8, 2.0, 1.0
    path.Insert(0, [*np.zeros(5), *last])
    for show in (lambda: ravemj.record(env, tmp_path / "a", path, width=16, height=12), lambda: env.animation(path)):
        robot.SetTransform(np.eye(4))
        show()
        assert robot.GetTransform()[:3, 3].tolist() == [2, 0, 0]
        assert robot.GetDOFValues().tolist() == [0, 0.8]


def test_the_view_is_chosen_without_moving_anything(env):
    env.SetViewer("")
    robot = env.GetRobots()[0]
    robot.SetDOFValues([0.25, 0.5])
    from ravemj.rave.recording import camera_for_motion, followed_motion

    before = robot.GetTransform()
    camera_for_motion(env, followed_motion(env, trajectory(env)), 1.0)
    assert robot.GetDOFValues().tolist() == [0.25, 0.5]
    assert np.array_equal(robot.GetTransform(), before)


@pytest.fixture
def workshop():
    env = ravemj.load(ravemj.model_path("workshop"))
    env.SetViewer("offscreen")
    yield env
    env.Destroy()


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_a_table_moves_the_robot_whose_joints_it_names(workshop, tmp_path, suffix):
    scara = workshop.GetRobot("scara")
    names = [joint.GetName() for joint in scara.GetJoints()]
    motion = ravemj.Motion.line(scara.GetDOFValues(), [1, -1, 0.1, 0])
    path = ravemj.write_motion(tmp_path / f"a{suffix}", motion, names)
    playback = workshop.GetViewer().play(path)
    playback.seek(1)
    assert scara.GetDOFValues() == pytest.approx([1, -1, 0.1, 0])
    workshop.GetViewer().play(path, robot=scara)
    with pytest.raises(SourceError, match="'scara_joint1', which is a joint of 'scara', not of 'puma'"):
        workshop.GetViewer().play(path, robot=workshop.GetRobot("puma"))
    with pytest.raises(ArgumentError, match="the motion has 4 joints, and 'puma' has 6 DOFs"):
        workshop.GetViewer().play(motion)


def test_a_trajectory_does_not_move_another_robot(workshop):
    scara = workshop.GetRobot("scara")
    spec = scara.GetActiveConfigurationSpecification("linear")
    spec.AddDeltaTimeGroup()
    path = ravemj.RaveCreateTrajectory(workshop, "")
    path.Init(spec)
    path.Insert(0, [0, 0, 0.1, 0, 0, 1, 0, 0.1, 0, 1])
    workshop.GetViewer().play(path, robot=scara)
    with pytest.raises(ArgumentError, match="the trajectory does not move 'puma', but scara"):
        workshop.GetViewer().play(path, robot=workshop.GetRobot("puma"))
    with pytest.raises(ArgumentError, match="robot: 'Pendulum' is not in this environment"):
        workshop.GetViewer().play(path, robot=ravemj.load(MODELS / "env.xml").GetRobots()[0])


def test_joints_with_several_axes_have_a_column_for_each(tmp_path):
    env = ravemj.Environment()
    env.LoadData(
        '<Robot name="R"><KinBody><Body name="a"/><Body name="b"><Geom type="sphere"><radius>0.1</radius></Geom></Body>'
        '<Joint name="J" type="hinge2"><Body>a</Body><Body>b</Body></Joint>'
        "</KinBody></Robot>"
    )
    robot = env.GetRobots()[0]
    assert robot.GetDOF() == 2
    path = ravemj.write_motion(tmp_path / "a.csv", ravemj.Motion.line([0, 0], [0.1, 0.2]), ["J, axis 0", "J, axis 1"])
    env.animation(path)
    assert robot.GetDOFValues() == pytest.approx([0.1, 0.2])


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_notes_are_kept_and_left_out_when_read(tmp_path, suffix):
    motion = ravemj.Motion([0.0, 1.0], [[0.0, 0.5], [1.0, -0.5]])
    path = ravemj.write_motion(tmp_path / f"a{suffix}", motion, ["one", "two"], ["certified: by\nnobody", "scene 1"])
    np.testing.assert_array_equal(ravemj.read_motion(path, ["one", "two"], [0, 0]).values, motion.values)
    if suffix == ".csv":
        assert path.read_text().splitlines()[0] == "time,one,two"
        assert path.read_text().splitlines()[3:] == ["# certified: by", "# nobody", "# scene 1"]
        assert len(np.loadtxt(path, delimiter=",", skiprows=1)) == 2
    else:
        assert np.load(path)["notes"].tolist() == ["certified: by\nnobody", "scene 1"]
